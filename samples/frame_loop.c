/* A character plays a clip, is torn on the way, and is drawn: frame_loop_c MODEL.glb */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunder_c.h>

/* Stands in for an engine's vertex and index buffers. */
typedef struct buffers {
  float* positions;
  uint32_t* triangles;
  uint64_t seen; /* the state of the scene that they hold */
} buffers;

static int check(sunder_status status) {
  if (status == SUNDER_OK) return 1;
  fprintf(stderr, "%s: %s\n", sunder_status_name(status), sunder_last_error());
  return 0;
}

static void upload(buffers* to, const sunder_posed_mesh* mesh) {
  to->positions = (float*)realloc(to->positions, mesh->vertex_count * 12u + 1);
  to->triangles = (uint32_t*)realloc(to->triangles, mesh->triangle_capacity * 12u + 1);
  for (uint32_t i = 0; i < mesh->dirty_vertex_count; ++i) {
    const sunder_range range = mesh->dirty_vertices[i];
    memcpy(to->positions + 3 * range.first, mesh->positions + 3 * range.first, range.count * 12u);
  }
  if (mesh->initial_triangle_count > 0)
    memcpy(to->triangles, mesh->initial_triangles, mesh->initial_triangle_count * 12u);
  for (uint32_t i = 0; i < mesh->triangle_write_count; ++i)
    memcpy(to->triangles + 3 * mesh->triangle_writes[i].place, mesh->triangle_writes[i].vertices,
           12);
  to->seen = mesh->epoch;
}

static int play(const void* model, uint64_t size) {
  sunder_character character = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance who = 0;
  sunder_character_data data = sunder_default_character_data();
  sunder_asset_options options = sunder_default_asset_options();
  const sunder_blade stroke[2] = {{{0, 1.5, 1}, {0, 1.5, -0.05}}, {{0, 1.1, 1}, {0, 1.1, -0.05}}};
  options.is_soft = 1;
  if (!check(sunder_check_abi(SUNDER_C_VERSION, 0)) ||
      !check(sunder_load_glb(model, size, NULL, &character)) ||
      !check(sunder_get_character(character, &data)) ||
      !check(sunder_create_asset(character, &options, &asset)) ||
      !check(sunder_create_scene(NULL, &scene)) || !check(sunder_spawn(scene, asset, NULL, &who)))
    return 0;
  if (data.clip_count > 0 && !check(sunder_play(scene, who, 0, NULL, NULL))) return 0;
  buffers* of_mesh = (buffers*)calloc(data.mesh_count, sizeof *of_mesh);
  for (int frame = 0; frame < 120; ++frame) {
    const sunder_result* results;
    uint32_t count;
    if (frame == 30 && !check(sunder_submit_tear(scene, who, stroke, 2, NULL, 0, NULL))) return 0;
    if (!check(sunder_update(scene, 1.0 / 60)) ||
        !check(sunder_get_results(scene, &results, &count)))
      return 0;
    for (uint32_t i = 0; i < count; ++i)
      printf("%u faces crossed, %.3f m torn\n", results[i].faces_crossed, results[i].length);
    for (uint32_t m = 0; m < data.mesh_count; ++m) {
      sunder_posed_mesh mesh;
      mesh.struct_size = sizeof mesh;
      if (!check(sunder_get_posed_mesh(scene, who, m, of_mesh[m].seen, &mesh))) return 0;
      upload(&of_mesh[m], &mesh);
    }
  }
  return check(sunder_destroy_scene(scene)) && check(sunder_destroy_asset(asset)) &&
         check(sunder_destroy_character(character));
}

int main(int argc, char** argv) {
  FILE* file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL) return 2;
  static char model[64 << 20];
  const size_t size = fread(model, 1, sizeof model, file);
  fclose(file);
  return play(model, size) ? 0 : 1;
}
