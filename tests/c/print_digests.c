/* Prints what the same operations make of a model, as hashes of all bits: the torn model, the posed
 * vertices, both after 100 frames in which clips play and tissue moves, and what a restored
 * snapshot is after a stroke over frames, an undo and tears by force. Programs of all platforms
 * print the same. print_digests FOLDER COUNT: FOLDER/0.glb with FOLDER/0.json, 1.glb ...
 */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunder_c.h>

static void check(sunder_status status) {
  if (status == SUNDER_OK) return;
  fprintf(stderr, "%s: %s\n", sunder_status_name(status), sunder_last_error());
  exit(1);
}

static char* read_file(const char* folder, int number, const char* ending, uint64_t* size) {
  char name[512];
  snprintf(name, sizeof name, "%s/%d.%s", folder, number, ending);
  FILE* file = fopen(name, "rb");
  if (file == NULL) {
    fprintf(stderr, "%s cannot be read\n", name);
    exit(1);
  }
  char* bytes = (char*)malloc(16u << 20);
  *size = fread(bytes, 1, 16u << 20, file);
  fclose(file);
  return bytes;
}

static uint64_t hash_bytes(uint64_t hash, const void* bytes, uint64_t size) {
  const unsigned char* at = (const unsigned char*)bytes;
  for (uint64_t i = 0; i < size; ++i) hash = (hash ^ at[i]) * 1099511628211ull;
  return hash;
}

static uint64_t hash_meshes(sunder_scene scene, sunder_instance who, uint32_t mesh_count) {
  uint64_t hash = 14695981039346656037ull;
  for (uint32_t m = 0; m < mesh_count; ++m) {
    sunder_posed_mesh mesh;
    mesh.struct_size = sizeof mesh;
    check(sunder_get_posed_mesh(scene, who, m, 0, &mesh));
    hash = hash_bytes(hash, mesh.positions, 12ull * mesh.vertex_count);
    if (mesh.normals != NULL) hash = hash_bytes(hash, mesh.normals, 12ull * mesh.vertex_count);
  }
  return hash;
}

static uint64_t digest_of(sunder_scene scene, sunder_instance who) {
  uint64_t digest = 0;
  check(sunder_get_digest(scene, who, &digest));
  return digest;
}

/* A stroke with walls over 8 frames, from side to side through the middle of the model, of which
 * the half is undone; then tissue tears by force. */
static void go_on(sunder_scene scene, sunder_instance who) {
  float low[3], high[3];
  sunder_posed_mesh mesh;
  sunder_blade blade;
  sunder_tear_options options = sunder_default_tear_options();
  sunder_force_tearing found = {sizeof found, 0, 0, 0, 0, 0, 0, {0, 0, 0}, {0, 0, 0}};
  mesh.struct_size = sizeof mesh;
  check(sunder_update(scene, 1.0 / 64));
  check(sunder_get_posed_mesh(scene, who, 0, 0, &mesh));
  for (int i = 0; i < 3; ++i) low[i] = high[i] = mesh.positions[i];
  for (uint32_t v = 1; v < mesh.vertex_count; ++v)
    for (uint32_t i = 0; i < 3; ++i) {
      const float at = mesh.positions[3 * v + i];
      if (at < low[i]) low[i] = at;
      if (at > high[i]) high[i] = at;
    }
  options.width = 0.01 * (high[0] - low[0]);
  options.wall_depth = 0.02 * (high[0] - low[0]);
  for (int frame = 0; frame < 16; ++frame) {
    const double along = frame % 8 / 7.0;
    for (int i = 0; i < 3; ++i) blade.base[i] = blade.tip[i] = 0.5 * (low[i] + high[i]);
    blade.base[0] = blade.tip[0] = low[0] + (0.2 + 0.6 * along) * (high[0] - low[0]);
    blade.base[1] += (frame / 8 - 0.5) * 0.3 * (high[1] - low[1]);
    blade.tip[1] = blade.base[1];
    blade.base[2] = high[2] + (high[2] - low[2]);
    if (frame % 8 == 0)
      check(sunder_submit_begin_stroke(scene, who, &blade, &options, NULL, NULL));
    else
      check(sunder_submit_extend_stroke(scene, who, &blade, 1.0 / 64, NULL));
    if (frame % 8 == 7) check(sunder_submit_end_stroke(scene, who, NULL));
    check(sunder_update(scene, 1.0 / 64));
  }
  check(sunder_submit_undo(scene, who, NULL));
  for (int frame = 0; frame < 8; ++frame) {
    check(sunder_update(scene, 1.0 / 64));
    check(sunder_tear_overstretched(scene, who, NULL, &found));
  }
  check(sunder_update(scene, 1.0 / 64));
}

static void print_case(const char* folder, int number) {
  sunder_character character;
  sunder_asset asset;
  sunder_scene scene, again;
  sunder_instance who;
  sunder_bytes snapshot;
  sunder_material weak = sunder_default_material();
  const uint8_t* bytes;
  uint64_t model_size, log_size, size;
  uint32_t applied = 0;
  sunder_character_data data = sunder_default_character_data();
  sunder_asset_options options = sunder_default_asset_options();
  char* model = read_file(folder, number, "glb", &model_size);
  char* log = read_file(folder, number, "json", &log_size);
  check(sunder_find_material("skin", &weak));
  weak.strength = 1.2;
  options.materials = &weak;
  options.material_count = 1;
  options.is_soft = 1;
  options.tension = 2.0;
  options.gravity[1] = -9.81;
  check(sunder_load_glb(model, model_size, NULL, &character));
  check(sunder_get_character(character, &data));
  check(sunder_create_asset(character, &options, &asset));
  check(sunder_create_scene(NULL, &scene));
  check(sunder_spawn(scene, asset, NULL, &who));
  if (data.clip_count > 0) check(sunder_play(scene, who, 0, NULL, NULL));
  check(sunder_update(scene, 0.25));
  const sunder_status status = sunder_apply_log(scene, who, log, log_size, &applied);
  check(sunder_update(scene, 1.0 / 64));
  printf("%d %d %u %016llx %016llx", number, (int)status, applied,
         (unsigned long long)digest_of(scene, who),
         (unsigned long long)hash_meshes(scene, who, data.mesh_count));
  for (int frame = 0; frame < 100; ++frame) check(sunder_update(scene, 1.0 / 64));
  check(sunder_save_scene(scene, &snapshot));
  check(sunder_get_bytes(snapshot, &bytes, &size));
  printf(" %016llx %016llx", (unsigned long long)hash_meshes(scene, who, data.mesh_count),
         (unsigned long long)hash_bytes(14695981039346656037ull, bytes, size));
  check(sunder_create_scene(NULL, &again));
  check(sunder_restore_scene(again, bytes, size, &asset, 1, NULL));
  go_on(again, who);
  const uint64_t torn = digest_of(again, who), posed = hash_meshes(again, who, data.mesh_count);
  printf(" %016llx\n", (unsigned long long)(torn ^ (posed * 0x9E3779B97F4A7C15ull)));
  check(sunder_destroy_scene(again));
  check(sunder_destroy_bytes(snapshot));
  check(sunder_destroy_scene(scene));
  check(sunder_destroy_asset(asset));
  check(sunder_destroy_character(character));
  free(model);
  free(log);
}

int main(int argc, char** argv) {
  if (argc != 3) return fprintf(stderr, "usage: print_digests FOLDER COUNT\n"), 2;
  for (int i = 0; i < atoi(argv[2]); ++i) print_case(argv[1], i);
  return 0;
}
