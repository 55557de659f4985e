/* Godot 3: a GDNative library that tears a sheet on two bones by the C library, and returns the
 * digest of the torn model. Godot 3 calls it by name ("standard_varcall"), which needs no header of
 * Godot: a procedure takes an array and returns a variant. Compiled with SUNDER_SAMPLE_PROGRAM it
 * is a program that prints the same digest. */

#include <stdint.h>
#include <stdio.h>
#include <sunder_c.h>

#if defined(_WIN32)
#define SAMPLE_API __declspec(dllexport)
#else
#define SAMPLE_API __attribute__((visibility("default")))
#endif

enum { CELLS = 16, SIDE = CELLS + 1, VERTICES = SIDE * SIDE, TRIANGLES = 2 * CELLS * CELLS };

typedef struct sheet {
  float positions[3 * VERTICES];
  uint32_t first_influence[VERTICES + 1];
  sunder_influence influences[2 * VERTICES];
  uint32_t triangles[3 * TRIANGLES];
  uint32_t submesh_of[TRIANGLES];
} sheet;

static void make_sheet(sheet* to) {
  for (uint32_t v = 0; v < VERTICES; ++v) {
    const float x = (float)(v % SIDE) / CELLS, y = (float)(v / SIDE) / CELLS;
    const float share = 0.25f + 0.5f * x;
    const float position[3] = {x, y, 0};
    for (int i = 0; i < 3; ++i) to->positions[3 * v + (uint32_t)i] = position[i];
    to->first_influence[v] = 2 * v;
    to->influences[2 * v] = (sunder_influence){0, 1 - share};
    to->influences[2 * v + 1] = (sunder_influence){1, share};
  }
  to->first_influence[VERTICES] = 2 * VERTICES;
  for (uint32_t cell = 0; cell < CELLS * CELLS; ++cell) {
    const uint32_t a = cell / CELLS * SIDE + cell % CELLS, b = a + 1, c = a + SIDE, d = c + 1;
    const uint32_t corners[6] = {a, b, d, a, d, c};
    for (int i = 0; i < 6; ++i) to->triangles[6 * cell + (uint32_t)i] = corners[i];
    to->submesh_of[2 * cell] = to->submesh_of[2 * cell + 1] = 0;
  }
}

static sunder_status make_character(const sheet* of, sunder_character* character) {
  const sunder_transform rest = {{0, 0, 0}, {0, 0, 0, 1}, {1, 1, 1}};
  const sunder_bone bones[2] = {{"root", SUNDER_NONE, rest, 0}, {"tip", 0, rest, 0}};
  const uint32_t slots[2] = {0, 1};
  const float binds[24] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  const sunder_skin skin = {"skin", slots, binds, 2, 0};
  const sunder_submesh submesh = {"sheet", SUNDER_NONE, 0};
  sunder_mesh mesh = {0};
  sunder_character_data data = sunder_default_character_data();
  mesh.name = "sheet";
  mesh.positions = of->positions;
  mesh.first_influence = of->first_influence;
  mesh.influences = of->influences;
  mesh.triangles = of->triangles;
  mesh.triangle_submesh = of->submesh_of;
  mesh.submeshes = &submesh;
  mesh.vertex_count = VERTICES;
  mesh.triangle_count = TRIANGLES;
  mesh.submesh_count = 1;
  data.name = "sheet";
  data.bones = bones;
  data.bone_count = 2;
  data.skins = &skin;
  data.skin_count = 1;
  data.meshes = &mesh;
  data.mesh_count = 1;
  return sunder_create_character(&data, character);
}

/* The digest of the torn sheet; 0 after a failure, which is printed. */
static uint64_t tear(void) {
  static sheet of;
  const sunder_blade stroke[2] = {{{0.2, 0.3, 0.5}, {0.2, 0.3, -0.5}},
                                  {{0.8, 0.6, 0.5}, {0.8, 0.6, -0.5}}};
  const double turned[24] = {1, 0, 0, 0, 1,   0,   0, 0,    1,   0, 0,   0,
                             1, 0, 0, 0, 0.8, 0.6, 0, -0.6, 0.8, 0, 0.1, 0};
  sunder_character character = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance instance = 0;
  uint64_t digest = 0;
  make_sheet(&of);
  if (make_character(&of, &character) != SUNDER_OK ||
      sunder_create_asset(character, NULL, &asset) != SUNDER_OK ||
      sunder_create_scene(NULL, &scene) != SUNDER_OK ||
      sunder_spawn(scene, asset, NULL, &instance) != SUNDER_OK ||
      sunder_set_matrices(scene, instance, turned, 2, NULL) != SUNDER_OK ||
      sunder_submit_tear(scene, instance, stroke, 2, NULL, 0, NULL) != SUNDER_OK ||
      sunder_update(scene, 1.0 / 60) != SUNDER_OK ||
      sunder_get_digest(scene, instance, &digest) != SUNDER_OK)
    fprintf(stderr, "sunder: %s\n", sunder_last_error());
  if (scene != 0) sunder_destroy_scene(scene);
  if (asset != 0) sunder_destroy_asset(asset);
  if (character != 0) sunder_destroy_character(character);
  return digest;
}

#ifdef SUNDER_SAMPLE_PROGRAM

int main(void) {
  printf("%lld\n", (long long)tear());
  return 0;
}

#else

/* A variant of Godot 3 that holds an integer. */
typedef struct godot_variant {
  int32_t type;
  int32_t padding;
  int64_t value;
  int64_t rest;
} godot_variant;

SAMPLE_API void godot_gdnative_init(void* options) { (void)options; }
SAMPLE_API void godot_gdnative_terminate(void* options) { (void)options; }

SAMPLE_API godot_variant sunder_tear_sheet(void* arguments) {
  const godot_variant digest = {2, 0, (int64_t)tear(), 0};
  (void)arguments;
  return digest;
}

#endif
