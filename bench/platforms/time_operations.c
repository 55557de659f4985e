/* Times on this platform what a frame consists of, for scripts/bench_platforms: posing, a tear, a
 * step of tissue, medians in microseconds. time_operations MODEL.glb */

#include <stdio.h>
#include <stdlib.h>
#include <sunder_c.h>
#include <time.h>

static const double kFrame = 1.0 / 90;
enum { kFrames = 201 };

static void check(sunder_status status) {
  if (status == SUNDER_OK) return;
  fprintf(stderr, "%s: %s\n", sunder_status_name(status), sunder_last_error());
  exit(1);
}

static double now_us(void) {
  struct timespec now;
  timespec_get(&now, TIME_UTC);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static sunder_character load(const char* file) {
  sunder_character character;
  FILE* stream = fopen(file, "rb");
  if (stream == NULL) {
    fprintf(stderr, "%s cannot be read\n", file);
    exit(1);
  }
  char* bytes = (char*)malloc(64u << 20);
  const uint64_t size = fread(bytes, 1, 64u << 20, stream);
  fclose(stream);
  check(sunder_load_glb(bytes, size, NULL, &character));
  free(bytes);
  return character;
}

/* A scene of one thread with an instance that plays its clip. */
static sunder_instance spawn(sunder_character character, int is_soft, sunder_scene* scene) {
  sunder_asset asset;
  sunder_instance who;
  sunder_asset_options options = sunder_default_asset_options();
  sunder_scene_options of_scene = sunder_default_scene_options();
  sunder_layer_options playing = sunder_default_layer_options();
  options.is_soft = (uint32_t)is_soft;
  options.tension = 2.0;
  of_scene.threads = 1;
  check(sunder_create_asset(character, &options, &asset));
  check(sunder_create_scene(&of_scene, scene));
  check(sunder_spawn(*scene, asset, NULL, &who));
  check(sunder_prepare_to_tear(*scene, who));
  playing.speed = 0.02; /* all vertices are posed anew, and the blade still meets them */
  check(sunder_play(*scene, who, 0, &playing, NULL));
  check(sunder_update(*scene, 0.25));
  return who;
}

/* Through the front of the model, across a tenth of its width, at a height between 0 and 1. */
static void submit_tear(sunder_scene scene, sunder_instance who, double height) {
  enum { kBlades = 9 };
  sunder_blade blades[kBlades];
  float low[3], high[3];
  sunder_posed_mesh mesh;
  mesh.struct_size = sizeof mesh;
  check(sunder_get_posed_mesh(scene, who, 0, 0, &mesh));
  for (int i = 0; i < 3; ++i) low[i] = high[i] = mesh.positions[i];
  for (uint32_t v = 1; v < mesh.vertex_count; ++v)
    for (int i = 0; i < 3; ++i) {
      const float at = mesh.positions[3 * v + (uint32_t)i];
      if (at < low[i]) low[i] = at;
      if (at > high[i]) high[i] = at;
    }
  for (int b = 0; b < kBlades; ++b) {
    const double along = 0.45 + 0.1 * b / (kBlades - 1);
    blades[b].base[0] = blades[b].tip[0] = low[0] + along * (high[0] - low[0]);
    blades[b].base[1] = blades[b].tip[1] = low[1] + height * (high[1] - low[1]);
    blades[b].base[2] = high[2] + 0.1 * (high[2] - low[2]);
    blades[b].tip[2] = 0.5 * (low[2] + high[2]);
  }
  check(sunder_submit_tear(scene, who, blades, kBlades, NULL, 0, NULL));
}

static double time_update(sunder_scene scene, double seconds) {
  const double start = now_us();
  check(sunder_update(scene, seconds));
  return now_us() - start;
}

static void expect_success(sunder_scene scene) {
  const sunder_result* results;
  uint32_t count = 0;
  check(sunder_get_results(scene, &results, &count));
  if (count == 1 && results[0].status == SUNDER_OK && results[0].runs > 0) return;
  fprintf(stderr, "the tear failed or missed\n");
  exit(1);
}

static int compare(const void* a, const void* b) {
  const double first = *(const double*)a, second = *(const double*)b;
  return (first > second) - (first < second);
}

static double median(double* times) {
  qsort(times, kFrames, sizeof *times, compare);
  return times[kFrames / 2];
}

int main(int argc, char** argv) {
  double posing[kFrames], with_tear[kFrames], with_tissue[kFrames];
  sunder_scene scene;
  if (argc != 2) return fprintf(stderr, "usage: time_operations MODEL.glb\n"), 2;
  const sunder_character character = load(argv[1]);

  sunder_instance who = spawn(character, 0, &scene);
  for (int i = 0; i < kFrames; ++i) {
    posing[i] = time_update(scene, kFrame);
    submit_tear(scene, who, 0.5);
    with_tear[i] = time_update(scene, kFrame);
    expect_success(scene);
    check(sunder_submit_undo(scene, who, NULL));
    check(sunder_update(scene, kFrame));
  }

  who = spawn(character, 1, &scene);
  submit_tear(scene, who, 0.5);
  check(sunder_update(scene, kFrame));
  expect_success(scene);
  for (int i = 0; i < kFrames; ++i) with_tissue[i] = time_update(scene, kFrame);
  const double alone = median(posing);
  printf("%.2f %.2f %.2f\n", alone, median(with_tear) - alone, median(with_tissue) - alone);
  return 0;
}
