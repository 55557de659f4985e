/* Sunder for C: rigged characters that are torn while they move. docs/c.md has a frame loop.
 *
 * Objects are named by numbers; 0 is none. A number that was destroyed, or that names an object of
 * another kind, is refused: SUNDER_INVALID_HANDLE. Every object has one destroy function; objects
 * that others need live on until those are destroyed. Calls return a status; sunder_last_error()
 * has the text and sunder_last_error_index() the index of the last failure of the thread. A failing
 * call changes nothing, and writes nothing through its output pointers; only sunder_apply_log()
 * keeps what came before the failure.
 *
 * Structs that have a `struct_size` are made by sunder_default_...(), or, for outputs, get
 * `x.struct_size = sizeof x` before the call; any other size is refused: SUNDER_INVALID_STRUCT. A
 * null pointer to options means the defaults. Arrays that are handed in are read until the call
 * returns. Pointers that a call gives ("views") are valid as their comment says. Texts are UTF-8.
 * Units are metres, kilograms, seconds, radians; model space is right-handed. Matrices are 3 x 4,
 * column after column, the translation last. Bits of results do not depend on the number of
 * threads.
 *
 * Threads: different scenes are independent; one thread at a time per scene, but
 * sunder_submit_...() may be called from any thread at any time. Characters, assets, pieces and
 * bytes are immutable: any thread may use them, until one destroys them.
 */
#ifndef SUNDER_C_H
#define SUNDER_C_H

#include <stdint.h>

#if defined(SUNDER_C_STATIC)
#define SUNDER_C_API
#elif defined(_WIN32) && defined(SUNDER_C_BUILDING)
#define SUNDER_C_API __declspec(dllexport)
#elif defined(_WIN32)
#define SUNDER_C_API __declspec(dllimport)
#elif defined(SUNDER_C_BUILDING)
#define SUNDER_C_API [[gnu::visibility("default")]]
#else
#define SUNDER_C_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Status ---- */

typedef int32_t sunder_status;

enum {
  SUNDER_OK = 0,
  SUNDER_EMPTY_INPUT = 1,            /* nothing to work on */
  SUNDER_SIZE_MISMATCH = 2,          /* two arrays that must agree in length do not */
  SUNDER_INDEX_OUT_OF_RANGE = 3,     /* a bone, vertex, mesh, ... beyond its array */
  SUNDER_NON_FINITE_VALUE = 4,       /* NaN or infinity */
  SUNDER_WEIGHTS_NOT_NORMALIZED = 5, /* negative weights, or a sum that is not one */
  SUNDER_NOT_A_TREE = 6,             /* a cycle, or a node with two parents */
  SUNDER_INVALID_ARGUMENT = 7,       /* outside the documented range */
  SUNDER_NOT_FOUND = 8,              /* no clip, bone, instance ... of that name */
  SUNDER_FILE_NOT_FOUND = 9,
  SUNDER_FILE_UNREADABLE = 10,
  SUNDER_PATH_NOT_ALLOWED = 11, /* a model refers to another file, and there is no resolver */
  SUNDER_UNSUPPORTED_FORMAT = 12,
  SUNDER_UNSUPPORTED_FEATURE = 13,
  SUNDER_MALFORMED_FILE = 14,
  SUNDER_LIMIT_EXCEEDED = 15,    /* size, depth, memory or time */
  SUNDER_CAPACITY_EXCEEDED = 16, /* a buffer of fixed capacity is full */
  SUNDER_INTERNAL_ERROR = 17,    /* a bug in Sunder */
  SUNDER_INVALID_HANDLE = 100,   /* none, destroyed, or of another kind */
  SUNDER_INVALID_STRUCT = 101,   /* struct_size was not set, or is of another version */
  SUNDER_NULL_POINTER = 102      /* a pointer that must not be null */
};

#define SUNDER_NONE 0xFFFFFFFFu /* no such index */

/* Version of this header: major, minor, patch. */
#define SUNDER_C_VERSION 0x000100u

/* Parts that a build may lack. */
enum {
  SUNDER_FEATURE_THREADS = 1,    /* scenes may have threads of their own */
  SUNDER_FEATURE_HULLS = 2,      /* sunder_get_piece_hulls() */
  SUNDER_FEATURE_VALIDATION = 4, /* sunder_validate(), sunder_validate_instance() */
  SUNDER_FEATURE_ALLOCATOR = 8   /* sunder_set_allocator() */
};

/* Version of the library, as SUNDER_C_VERSION. */
SUNDER_C_API uint32_t sunder_version(void);
/* SUNDER_FEATURE_... of the library. */
SUNDER_C_API uint32_t sunder_features(void);
/* Call it first, with SUNDER_C_VERSION and the features that the program needs.
 * Fails: SUNDER_UNSUPPORTED_FEATURE, if the library is of another version or lacks a feature. */
SUNDER_C_API sunder_status sunder_check_abi(uint32_t version, uint32_t features);
/* "index_out_of_range"; never null. */
SUNDER_C_API const char* sunder_status_name(sunder_status status);
/* The text of the last failure of this thread, until its next failure; never null. At most 255
 * bytes. */
SUNDER_C_API const char* sunder_last_error(void);
/* The element of which it speaks, or SUNDER_NONE. */
SUNDER_C_API uint32_t sunder_last_error_index(void);

/* ---- Memory ---- */

/* Memory for `bytes`, which any thread may ask for; null: there is none, and the call that needs it
 * fails by SUNDER_LIMIT_EXCEEDED. alignment: a power of two. */
typedef void* (*sunder_allocate)(void* context, uint64_t bytes, uint64_t alignment);
/* Takes it back, on any thread, with the same numbers. */
typedef void (*sunder_release)(void* context, void* memory, uint64_t bytes, uint64_t alignment);

/* What later calls allocate comes from the caller; a scene keeps the allocator with which it was
 * created. Memory goes back to where it came from, so that the functions and their context are
 * needed until the process ends. allocate and release null: the heap again. Qhull, and
 * the table of all objects, allocate from the heap. Fails: SUNDER_UNSUPPORTED_FEATURE without
 * SUNDER_FEATURE_ALLOCATOR; SUNDER_NULL_POINTER if one of the functions is null. */
SUNDER_C_API sunder_status sunder_set_allocator(sunder_allocate allocate, sunder_release release,
                                                void* context);

/* ---- Bytes ---- */

typedef uint32_t sunder_bytes; /* a file, a snapshot or a text that a call has made */

/* A view, valid until the bytes are destroyed. `size` may be null: texts end with a zero that does
 * not count. */
SUNDER_C_API sunder_status sunder_get_bytes(sunder_bytes bytes, const uint8_t** data,
                                            uint64_t* size);
SUNDER_C_API sunder_status sunder_destroy_bytes(sunder_bytes bytes);

/* ---- Characters ---- */

typedef uint32_t
    sunder_character; /* a rigged model: meshes and skins on one skeleton, with its clips */

/* The transform of a bone, relative to its parent: translation * rotation * scale. */
typedef struct sunder_transform {
  float translation[3];
  float rotation[4]; /* x y z w, unit length */
  float scale[3];
} sunder_transform;

typedef struct sunder_bone {
  const char* name; /* unique, not empty */
  uint32_t parent;  /* less than the bone's own index, or SUNDER_NONE */
  sunder_transform rest;
  uint32_t reserved;
} sunder_bone;

typedef struct sunder_skin {
  const char* name;
  const uint32_t* bones;       /* per slot: a bone of the skeleton */
  const float* bone_from_bind; /* per slot: 12 numbers, the inverse of the bone's bind transform */
  uint32_t slot_count;
  uint32_t reserved;
} sunder_skin;

typedef struct sunder_influence {
  uint32_t slot; /* of the skin */
  float weight;  /* in (0, 1] */
} sunder_influence;

/* Arrays have 3 numbers per vertex, or are null. */
typedef struct sunder_morph_target {
  const char* name;
  const float* position_deltas;
  const float* normal_deltas;
  const float* tangent_deltas;
} sunder_morph_target;

typedef struct sunder_attribute {
  const char* name;    /* "_FEATURE_ID_0" */
  const float* values; /* per vertex: `components` numbers */
  uint32_t components; /* 1 to 4 */
  uint32_t is_label;   /* 1: copied from a vertex, not interpolated */
} sunder_attribute;

typedef struct sunder_submesh {
  const char* name;
  uint32_t material; /* index in the source file, or SUNDER_NONE */
  uint32_t reserved;
} sunder_submesh;

/* A triangle mesh in bind space with one skin. */
typedef struct sunder_mesh {
  const char* name;
  const float* positions;         /* 3 per vertex */
  const float* normals;           /* 3 per vertex, or null */
  const float* tangents;          /* 4 per vertex, or null; the last is the sign of the bitangent */
  const float* const* uv_sets;    /* each 2 per vertex */
  const float* const* color_sets; /* each 4 per vertex, linear */
  const sunder_attribute* attributes;
  const uint32_t* first_influence; /* vertex_count + 1 offsets into `influences` */
  const sunder_influence* influences;
  const sunder_morph_target* morph_targets;
  const uint32_t*
      triangles; /* 3 per triangle, counter-clockwise; one vertex three times: removed */
  const uint32_t* triangle_submesh; /* per triangle */
  const sunder_submesh* submeshes;
  uint32_t skin;
  uint32_t vertex_count;
  uint32_t triangle_count;
  uint32_t uv_set_count;
  uint32_t color_set_count;
  uint32_t attribute_count;
  uint32_t morph_target_count;
  uint32_t first_morph_weight; /* of target 0, in the weights of a pose */
  uint32_t submesh_count;
  uint32_t reserved;
} sunder_mesh;

enum {
  SUNDER_TARGET_TRANSLATION = 0,
  SUNDER_TARGET_ROTATION = 1,
  SUNDER_TARGET_SCALE = 2,
  SUNDER_TARGET_MORPH_WEIGHTS = 3
};
enum { SUNDER_INTERPOLATE_LINEAR = 0, SUNDER_INTERPOLATE_STEP = 1, SUNDER_INTERPOLATE_CUBIC = 2 };

/* Keys of one animated value, as in glTF 2.0. */
typedef struct sunder_channel {
  const float* times;  /* seconds, ascending, >= 0 */
  const float* values; /* per key: `width` numbers; cubic: three times as many */
  uint32_t key_count;
  uint32_t target;        /* SUNDER_TARGET_... */
  uint32_t index;         /* the bone, or the first morph weight */
  uint32_t width;         /* 3, 4 for rotations, or the number of morph weights */
  uint32_t interpolation; /* SUNDER_INTERPOLATE_... */
  uint32_t reserved;
} sunder_channel;

typedef struct sunder_clip {
  const char* name;
  const sunder_channel* channels;
  uint32_t channel_count;
  float duration; /* seconds: the time of the last key */
} sunder_clip;

typedef struct sunder_character_data {
  uint32_t struct_size;
  uint32_t bone_count;
  uint32_t skin_count;
  uint32_t mesh_count;
  uint32_t clip_count;
  uint32_t morph_weight_count;
  const char* name;
  const sunder_bone* bones;
  const sunder_skin* skins;
  const sunder_mesh* meshes;
  const sunder_clip* clips;
  const float* rest_morph_weights;
} sunder_character_data;

/* Gives the bytes of another file to which a model refers: a buffer, or an image when a model is
 * saved. Sets `data` and `size`, which stay valid until `release` is called with the same `data`.
 * Returns SUNDER_OK, or a failure. */
typedef sunder_status (*sunder_read_file)(void* context, const char* uri, const uint8_t** data,
                                          uint64_t* size);
typedef void (*sunder_release_file)(void* context, const uint8_t* data);

typedef struct sunder_load_options {
  uint32_t struct_size;
  uint32_t is_strict;               /* 1: refuses what would otherwise be repaired or dropped */
  uint64_t maximum_bytes;           /* of the model and all files to which it refers */
  uint64_t maximum_memory;          /* 0: 20 times the bytes, at least 64 MiB */
  sunder_read_file read_file;       /* null: the model may refer to no other file. Kept and called
                                       until the character, and all assets and scenes that were made
                                       from it, are destroyed */
  sunder_release_file release_file; /* may be null */
  void* file_context;
} sunder_load_options;

/* One kind of thing that loading repaired, dropped or tells. */
enum {
  SUNDER_NOTE_INFORMATION = 0,
  SUNDER_NOTE_REPAIRED = 1,
  SUNDER_NOTE_DROPPED = 2,
  SUNDER_NOTE_WARNING = 3
};
typedef struct sunder_note {
  const char* place; /* "mesh 2 'Body'" */
  const char* text;
  uint32_t kind;  /* SUNDER_NOTE_... */
  uint32_t count; /* vertices, keys ... concerned */
} sunder_note;

typedef struct sunder_save_options {
  uint32_t struct_size;
  uint32_t maximum_influences; /* per vertex: 4, 8, SUNDER_NONE: all, 0: as many as the source has,
                                  at least 4 */
} sunder_save_options;

SUNDER_C_API sunder_character_data sunder_default_character_data(void);
SUNDER_C_API sunder_load_options sunder_default_load_options(void);
SUNDER_C_API sunder_save_options sunder_default_save_options(void);

/* Copies a character from arrays. Fails with the first fault: its text says where. */
SUNDER_C_API sunder_status sunder_create_character(const sunder_character_data* data,
                                                   sunder_character* character);
/* Reads a GLB, or glTF text, from memory, and copies it. Files compressed by Draco or meshopt are
 * refused. */
SUNDER_C_API sunder_status sunder_load_glb(const void* bytes, uint64_t size,
                                           const sunder_load_options* options,
                                           sunder_character* character);
/* A copy of a character in which a mesh has an attribute of one number per vertex, in place of one
 * of that name, which begins with '_'. Files that are saved of it have it too. */
SUNDER_C_API sunder_status sunder_add_attribute(sunder_character character, uint32_t mesh,
                                                const char* name, const float* values,
                                                uint32_t value_count,
                                                sunder_character* with_attribute);
SUNDER_C_API sunder_status sunder_destroy_character(sunder_character character);
/* A view of all arrays, valid until the character is destroyed. `data->struct_size` is set by the
 * caller. */
SUNDER_C_API sunder_status sunder_get_character(sunder_character character,
                                                sunder_character_data* data);
SUNDER_C_API sunder_status sunder_find_bone(sunder_character character, const char* name,
                                            uint32_t* bone);
SUNDER_C_API sunder_status sunder_find_clip(sunder_character character, const char* name,
                                            uint32_t* clip);
/* What loading noted. Views, valid until the character is destroyed. */
SUNDER_C_API sunder_status sunder_get_notes(sunder_character character, const sunder_note** notes,
                                            uint32_t* count);
/* The character as a GLB. */
SUNDER_C_API sunder_status sunder_save_glb(sunder_character character,
                                           const sunder_save_options* options, sunder_bytes* glb);

/* ---- Poses ---- */

/* The transforms of a clip at a time, on the rest pose.
 * transforms: one per bone, written; morph_weights: one per morph weight, written, or null. */
SUNDER_C_API sunder_status sunder_sample_clip(sunder_character character, uint32_t clip,
                                              double seconds, sunder_transform* transforms,
                                              float* morph_weights);
/* model_from_bone of each bone: 12 numbers per bone, written. transforms: one per bone; null: the
 * rest pose. */
SUNDER_C_API sunder_status sunder_compute_matrices(sunder_character character,
                                                   const sunder_transform* transforms,
                                                   double* model_from_bone);

/* ---- Materials of tissue ---- */

/* docs/particles.md explains the fields and has the sources of the presets. */
typedef struct sunder_material {
  uint32_t struct_size;
  uint32_t reserved;
  double return_frequency;   /* hertz, [0, 1.6e5] */
  double damping_ratio;      /* [0, 1e6] */
  double membrane_stiffness; /* N/m, [0, 1e12] */
  double membrane_damping;   /* N s/m, [0, 1e12] */
  double areal_density;      /* kg/m^2, [1e-12, 1e12] */
  double range;              /* suggested size of particles, fraction of the diagonal, (0, 1] */
  double stretch_limit;      /* >= 1, or 0: none */
  double strength;           /* stretch at which tissue tears, > 1, or 0: never */
  double toughness;          /* J/m, [0, 1e12] */
  double flaw_length;        /* metres, [1e-9, 1e12] */
  double yield_stretch;      /* beyond which tissue keeps its stretch, > 1, or 0: never */
  double plastic_limit;      /* greatest strain that it keeps, [0, 1e3] */
} sunder_material;

SUNDER_C_API sunder_material sunder_default_material(void);
/* "skin", "fat", "muscle", "liver", "rubber", "foam", "cloth", "jelly". Fails: SUNDER_NOT_FOUND. */
SUNDER_C_API sunder_status sunder_find_material(const char* name, sunder_material* material);
/* The tension, N/m, under which a straight wound of `length` opens by `gap` metres in its middle.
 */
SUNDER_C_API sunder_status sunder_tension_for_gap(const sunder_material* material, double length,
                                                  double gap, double* tension);

/* ---- Assets: what the instances of one character share ---- */

typedef uint32_t sunder_asset;

enum { SUNDER_SKIN_LINEAR = 0, SUNDER_SKIN_DUAL_QUATERNION = 1 };
enum {
  SUNDER_WEIGHTS_BARYCENTRIC = 0,
  SUNDER_WEIGHTS_POSE_EXACT = 1,
  SUNDER_WEIGHTS_REFIT = 2,
  SUNDER_WEIGHTS_EXACT = 3,
  SUNDER_WEIGHTS_OF_MODEL = -1 /* in operations: those of the asset */
};

/* Fields of tissue: factors of its material, per vertex. */
enum {
  SUNDER_FIELD_STRENGTH = 0,
  SUNDER_FIELD_TOUGHNESS = 1,
  SUNDER_FIELD_STIFFNESS = 2,
  SUNDER_FIELD_TENSION = 3,
  SUNDER_FIELD_THICKNESS = 4
};

/* One field of one mesh. Factors are from 0.001, of the tension from 0, to 1000. */
typedef struct sunder_tissue_field {
  uint32_t struct_size;
  uint32_t mesh;
  uint32_t field;       /* SUNDER_FIELD_... */
  uint32_t value_count; /* the vertices of the mesh */
  const float* values;
} sunder_tissue_field;

/* A place on the source's surface. */
typedef struct sunder_surface_place {
  uint32_t mesh;
  uint32_t triangle;
  double barycentric[3]; /* per corner; >= 0, sum 1 */
} sunder_surface_place;

/* A line along which tissue is weaker, as between stamps. */
typedef struct sunder_perforation {
  uint32_t struct_size;
  uint32_t place_count; /* at least two; straight in between; closed if the last is the first */
  const sunder_surface_place* places;
  double strength; /* of the toughness, and of the strain that is borne; [0.001, 1] */
} sunder_perforation;

typedef struct sunder_asset_options {
  uint32_t struct_size;
  uint32_t is_soft;        /* 1: soft tissue; the fields below that speak of it count */
  uint32_t poses_vertices; /* 0: a shader does; sunder_posed_mesh has no positions then */
  uint32_t has_normals;    /* 1: posed, if a mesh has them */
  uint32_t has_tangents;
  uint32_t unit_length;        /* 1: normals and tangents are normalised */
  uint32_t skinning;           /* SUNDER_SKIN_... */
  int32_t weight_policy;       /* SUNDER_WEIGHTS_... of new vertices */
  uint32_t maximum_influences; /* of new vertices; 0: all */
  sunder_asset coarser;        /* a coarser level with the same bones, or 0 */
  double coarser_below;        /* pixels: an instance less high shows the coarser level */
  double particle_range;       /* size of particles: fraction of the diagonal; 0: that of the first
                                  material */
  uint64_t particle_seed;
  double gravity[3];                /* m/s^2, on tissue */
  double tension;                   /* N/m, pulls lips apart */
  uint32_t adds_pose_strain;        /* 1: stretched tissue pulls more at its lips */
  uint32_t material_count;          /* 0: one material of the defaults */
  const sunder_material* materials; /* all particles start with the first */
  uint32_t field_count;             /* 0: all factors are 1 */
  uint32_t perforation_count;
  const sunder_tissue_field* fields;
  const sunder_perforation* perforations;
  double self_contact_thickness; /* metres; 0: lips and flaps pass through one another */
  double self_contact_friction;
} sunder_asset_options;

/* Triangles of an index buffer that one draw call draws. */
typedef struct sunder_draw_range {
  uint32_t submesh; /* which names the material */
  uint32_t first_triangle;
  uint32_t triangle_count;
} sunder_draw_range;

SUNDER_C_API sunder_asset_options sunder_default_asset_options(void);
/* O(size of the character). Do it on a loading thread. */
SUNDER_C_API sunder_status sunder_create_asset(sunder_character character,
                                               const sunder_asset_options* options,
                                               sunder_asset* asset);
SUNDER_C_API sunder_status sunder_destroy_asset(sunder_asset asset);
/* The index buffer of a mesh before any tear, 3 per triangle, and its draw calls: views, valid
 * until the asset is destroyed. */
SUNDER_C_API sunder_status sunder_get_asset_triangles(sunder_asset asset, uint32_t mesh,
                                                      const uint32_t** triangles,
                                                      uint32_t* triangle_count,
                                                      const sunder_draw_range** ranges,
                                                      uint32_t* range_count);

/* ---- Scenes ---- */

typedef uint32_t sunder_scene;
typedef uint64_t
    sunder_instance; /* of one scene; 0 is none. That of a destroyed one never names another */
typedef uint64_t sunder_layer;   /* of one instance; 0 is none */
typedef uint64_t sunder_command; /* ascending from 0 in the order in which commands are submitted */

typedef void (*sunder_task)(const void* work, uint32_t index);
/* Calls task(work, i) once for each i < count, on any threads, and returns when all have returned.
 */
typedef void (*sunder_parallel_for)(void* context, uint32_t count, sunder_task task,
                                    const void* work);
/* Calls task(data) once, on any thread, now or later. */
typedef void (*sunder_run_in_background)(void* context, void (*task)(void* data), void* data);

typedef struct sunder_scene_options {
  uint32_t struct_size;
  uint32_t threads;            /* of the scene: 0: one per core; 1: the calling thread does all */
  uint32_t background_updates; /* 0: background work takes effect when it is done; n: exactly n
                                  updates later */
  uint32_t parallel_threads;   /* behind parallel_for */
  double slower_below[2];      /* pixels: updated every second, every fourth frame */
  sunder_parallel_for parallel_for; /* the caller's job system; null: threads of the scene */
  void* parallel_context;
  sunder_run_in_background background; /* null: a thread of the scene */
  void* background_context;
  uint32_t wants_changes; /* 1: results keep lists of what they changed: sunder_get_change() */
  uint32_t reserved;
} sunder_scene_options;

typedef struct sunder_spawn_options {
  uint32_t struct_size;
  uint32_t is_visible;
  uint32_t vertices; /* fixed room for operations, per mesh; all three 0: it grows */
  uint32_t triangles;
  uint32_t operations;
} sunder_spawn_options;

enum { SUNDER_LAYER_WHOLE = 0, SUNDER_LAYER_ANIMATED = 1, SUNDER_LAYER_ADDITIVE = 2 };
enum { SUNDER_PLAY_LOOP = 0, SUNDER_PLAY_PING_PONG = 1, SUNDER_PLAY_ONCE = 2 };
enum { SUNDER_EASE_LINEAR = 0, SUNDER_EASE_SMOOTH = 1, SUNDER_EASE_IN = 2, SUNDER_EASE_OUT = 3 };

typedef struct sunder_layer_options {
  uint32_t struct_size;
  uint32_t kind;   /* SUNDER_LAYER_... */
  uint32_t mode;   /* SUNDER_PLAY_... */
  uint32_t easing; /* SUNDER_EASE_... */
  double time;     /* seconds into the clip */
  double speed;
  double fade_in;     /* seconds */
  double fade_out;    /* seconds; a clip played once ends with it */
  float weight;       /* in [0, 1] */
  uint32_t mask_bone; /* only this bone and those below it; SUNDER_NONE: all */
} sunder_layer_options;

typedef struct sunder_layer_state {
  uint32_t struct_size;
  uint32_t is_over;
  double time;
  float weight;
  uint32_t reserved;
} sunder_layer_state;

/* Figures of an update; times are wall time in microseconds, summed over threads but for `total`.
 */
typedef struct sunder_frame_stats {
  uint32_t struct_size;
  uint32_t instances, sampled, advanced, drawn, commands,
      failed; /* numbers of instances and commands */
  uint32_t settled_points, model_work;
  uint32_t idle, unseen, waiting, in_background, unchanged, unsettled;
  uint32_t reserved;
  uint64_t frame, vertices;
  double total, animation, operations, settling, tissue, drawing;
} sunder_frame_stats;

SUNDER_C_API sunder_scene_options sunder_default_scene_options(void);
SUNDER_C_API sunder_spawn_options sunder_default_spawn_options(void);
SUNDER_C_API sunder_layer_options sunder_default_layer_options(void);

SUNDER_C_API sunder_status sunder_create_scene(const sunder_scene_options* options,
                                               sunder_scene* scene);
SUNDER_C_API sunder_status sunder_destroy_scene(sunder_scene scene);
/* An instance in the rest pose. O(bones). */
SUNDER_C_API sunder_status sunder_spawn(sunder_scene scene, sunder_asset asset,
                                        const sunder_spawn_options* options,
                                        sunder_instance* instance);
SUNDER_C_API sunder_status sunder_destroy_instance(sunder_scene scene, sunder_instance instance);
SUNDER_C_API sunder_status sunder_has_instance(sunder_scene scene, sunder_instance instance,
                                               uint32_t* exists);
SUNDER_C_API sunder_status sunder_get_instance_count(sunder_scene scene, uint32_t* count);
SUNDER_C_API sunder_status sunder_set_visible(sunder_scene scene, sunder_instance instance,
                                              uint32_t is_visible);
/* Far instances are updated less often and show the coarser level. pixels: the height on the
 * screen, > 0. */
SUNDER_C_API sunder_status sunder_set_screen_height(sunder_scene scene, sunder_instance instance,
                                                    double pixels);
/* Takes now the memory that the first operation would take. O(size of the character). */
SUNDER_C_API sunder_status sunder_prepare_to_tear(sunder_scene scene, sunder_instance instance);

/* Plays a clip of the character. layer: written, or null. */
SUNDER_C_API sunder_status sunder_play(sunder_scene scene, sunder_instance instance, uint32_t clip,
                                       const sunder_layer_options* options, sunder_layer* layer);
/* Plays a clip that fades in over all others (options->fade_in) and then ends them. */
SUNDER_C_API sunder_status sunder_cross_fade(sunder_scene scene, sunder_instance instance,
                                             uint32_t clip, const sunder_layer_options* options,
                                             sunder_layer* layer);
SUNDER_C_API sunder_status sunder_fade_layer(sunder_scene scene, sunder_instance instance,
                                             sunder_layer layer, float weight, double seconds);
/* Fades a layer out and ends it. */
SUNDER_C_API sunder_status sunder_stop_layer(sunder_scene scene, sunder_instance instance,
                                             sunder_layer layer, double seconds);
SUNDER_C_API sunder_status sunder_seek_layer(sunder_scene scene, sunder_instance instance,
                                             sunder_layer layer, double time);
SUNDER_C_API sunder_status sunder_set_layer_speed(sunder_scene scene, sunder_instance instance,
                                                  sunder_layer layer, double speed);
SUNDER_C_API sunder_status sunder_get_layer(sunder_scene scene, sunder_instance instance,
                                            sunder_layer layer, sunder_layer_state* state);
/* Ends all that plays and holds the present pose. */
SUNDER_C_API sunder_status sunder_stop(sunder_scene scene, sunder_instance instance);
/* Sets the pose of the next update and ends what plays. model_from_bone: 12 numbers per bone;
 * transforms: one per bone. morph_weights: as many as the character's; null: those of rest. */
SUNDER_C_API sunder_status sunder_set_matrices(sunder_scene scene, sunder_instance instance,
                                               const double* model_from_bone, uint32_t bone_count,
                                               const float* morph_weights);
SUNDER_C_API sunder_status sunder_set_transforms(sunder_scene scene, sunder_instance instance,
                                                 const sunder_transform* transforms,
                                                 uint32_t bone_count, const float* morph_weights);
/* The pose of the last update: 12 numbers per bone, a view until the next update. */
SUNDER_C_API sunder_status sunder_get_pose(sunder_scene scene, sunder_instance instance,
                                           const double** model_from_bone, uint32_t* bone_count);

/* Advances by a frame: samples clips, applies commands, steps tissue, poses the vertices that
 * changed. seconds: >= 0. */
SUNDER_C_API sunder_status sunder_update(sunder_scene scene, double seconds);
/* Limits the optional work of the following updates; SUNDER_NONE: no limit. */
SUNDER_C_API sunder_status sunder_set_budget(sunder_scene scene, uint32_t settled_points,
                                             uint32_t model_work);
SUNDER_C_API sunder_status sunder_get_frame_stats(sunder_scene scene, sunder_frame_stats* stats);
/* The instances that the last update posed anew: a view until the next update. */
SUNDER_C_API sunder_status sunder_get_drawn(sunder_scene scene, const sunder_instance** instances,
                                            uint32_t* count);
/* The level of detail that is shown: 0: the asset of the instance, 1: its coarser level ... */
SUNDER_C_API sunder_status sunder_get_shown_level(sunder_scene scene, sunder_instance instance,
                                                  uint32_t* level);

/* ---- Meshes for drawing ---- */

typedef struct sunder_range {
  uint32_t first;
  uint32_t count;
} sunder_range;

/* A triangle to be written into an index buffer. */
typedef struct sunder_triangle_write {
  uint32_t place; /* in triangles */
  uint32_t vertices[3];
} sunder_triangle_write;

/* One mesh of an instance, and what changed in it since an epoch. Views, valid until the next
 * update or change of the instance. */
typedef struct sunder_posed_mesh {
  uint32_t struct_size;
  uint32_t vertex_count;
  uint32_t triangle_capacity; /* the size that the index buffer needs, in triangles */
  uint32_t range_count;
  uint32_t dirty_vertex_count; /* numbers of ranges */
  uint32_t dirty_attribute_count;
  uint32_t triangle_write_count;
  uint32_t initial_triangle_count;    /* not 0: the index buffer starts anew with these triangles */
  uint64_t epoch;                     /* to be passed as `seen` next time */
  const float* positions;             /* 3 per vertex, model space; null before an update */
  const float* normals;               /* 3 per vertex, or null */
  const float* tangents;              /* 4 per vertex, or null */
  const sunder_draw_range* ranges;    /* one draw call each */
  const sunder_range* dirty_vertices; /* to be uploaded */
  const sunder_range*
      dirty_attributes; /* vertices whose other attributes are new: sunder_get_instance_mesh() */
  const sunder_triangle_write* triangle_writes; /* in order */
  const uint32_t* initial_triangles;
} sunder_posed_mesh;

/* Memory of the caller into which vertices are posed, such as a mapped buffer. Strides in bytes,
 * multiples of 4; 0: packed. */
typedef struct sunder_vertex_target {
  uint32_t struct_size;
  uint32_t vertex_count; /* room */
  float* positions;      /* null: the instance has memory of its own again */
  float* normals;        /* or null */
  float* tangents;       /* or null */
  uint32_t position_stride;
  uint32_t normal_stride;
  uint32_t tangent_stride;
  uint32_t unit_length;
} sunder_vertex_target;

SUNDER_C_API sunder_vertex_target sunder_default_vertex_target(void);
/* seen: the epoch up to which the caller's buffers are up to date; 0: there are none yet. O(changes
 * since then). */
SUNDER_C_API sunder_status sunder_get_posed_mesh(sunder_scene scene, sunder_instance instance,
                                                 uint32_t mesh, uint64_t seen,
                                                 sunder_posed_mesh* posed);
SUNDER_C_API sunder_status sunder_set_vertex_target(sunder_scene scene, sunder_instance instance,
                                                    uint32_t mesh,
                                                    const sunder_vertex_target* target);
/* A mesh of the torn character in bind space, with all attributes and weights. A view, valid until
 * the next call that changes the instance, and the tables of pointers in it until the next call of
 * this function for the scene. */
SUNDER_C_API sunder_status sunder_get_instance_mesh(sunder_scene scene, sunder_instance instance,
                                                    uint32_t mesh, sunder_mesh* view);

/* Where a vertex that operations made comes from: what else a program keeps per vertex, it can give
 * to this one by interpolation over a triangle of the source. */
typedef struct sunder_vertex_origin {
  double barycentric[3]; /* per corner of the triangle; >= 0, sum 1 */
  uint32_t triangle;     /* of the source's mesh; SUNDER_NONE: inside of a wall or cap */
  uint32_t reserved;
} sunder_vertex_origin;
/* Where a triangle comes from, and how it hangs together with others: triangles that share two
 * points share an edge. */
typedef struct sunder_triangle_origin {
  uint32_t triangle;  /* of the source's mesh, of which it is a part; SUNDER_NONE: a wall or cap */
  uint32_t points[3]; /* of the surface, at its corners; SUNDER_NONE: the triangle was removed */
} sunder_triangle_origin;

/* The origins of the vertices from `first` on, which is at least the source's vertex count: the
 * vertices before are those of the source. At most `most` are written; count: how many there are
 * from `first` on. Fails: SUNDER_NOT_FOUND before the first operation and before
 * sunder_prepare_to_tear(), as the next. O(written). */
SUNDER_C_API sunder_status sunder_get_vertex_origins(sunder_scene scene, sunder_instance instance,
                                                     uint32_t mesh, uint32_t first,
                                                     sunder_vertex_origin* origins, uint32_t most,
                                                     uint32_t* count);
/* The origins of the triangles from `first` on, as for vertices. */
SUNDER_C_API sunder_status sunder_get_triangle_origins(sunder_scene scene, sunder_instance instance,
                                                       uint32_t mesh, uint32_t first,
                                                       sunder_triangle_origin* origins,
                                                       uint32_t most, uint32_t* count);
/* Edges that welds closed, 2 points of the surface each, in the order of the welds: a later tear
 * may have opened one again. A view, valid until the next call that changes the instance. Fails:
 * SUNDER_NOT_FOUND as the last. */
SUNDER_C_API sunder_status sunder_get_scars(sunder_scene scene, sunder_instance instance,
                                            const uint32_t** points, uint32_t* count);
/* The torn character as a GLB: the source document with the meshes that were torn. Pieces of
 * characters from arrays have plain materials. */
SUNDER_C_API sunder_status sunder_save_instance(sunder_scene scene, sunder_instance instance,
                                                const sunder_save_options* options,
                                                sunder_bytes* glb);

/* ---- Operations ---- */

/* One position of a blade: from outside the surface to how deep it reaches. Model space. */
typedef struct sunder_blade {
  double base[3];
  double tip[3];
} sunder_blade;

enum { SUNDER_LAYERS_NEAREST = 0, SUNDER_LAYERS_ALL = 1 };

typedef struct sunder_tear_options {
  uint32_t struct_size;
  uint32_t layers;             /* SUNDER_LAYERS_... that the blade tears */
  double width;                /* of the gap, >= 0; 0: the lips coincide */
  double wall_depth;           /* of the inner walls, >= 0; 0: none */
  double lip_roll;             /* radius of the rims of walls, >= 0 */
  uint32_t wall_material;      /* index in the source file; SUNDER_NONE: that of the lips */
  int32_t weight_policy;       /* SUNDER_WEIGHTS_... of new vertices */
  uint32_t maximum_influences; /* with a policy; 0: all */
  uint32_t reserved;
} sunder_tear_options;

/* A cut by a plane. */
typedef struct sunder_cut {
  uint32_t struct_size;
  uint32_t has_caps; /* 1: closes the opened sections */
  double point[3];
  double normal[3];     /* any length but zero */
  const double* bounds; /* corners of a convex polygon, 3 numbers each; null: the whole plane */
  const double*
      sections;     /* places, 3 numbers each: only the section nearest to each is cut; or null */
  const char* bone; /* only sections that this bone's branch moves; or null */
  uint32_t bound_count;
  uint32_t section_count;
  uint32_t cap_material; /* index in the source file; SUNDER_NONE: that of the rim */
  int32_t weight_policy;
  uint32_t maximum_influences;
  uint32_t has_first_hit; /* 1: only the section that this ray meets first is cut */
  double ray_origin[3];
  double ray_direction[3];
} sunder_cut;

/* A round hole. */
typedef struct sunder_bore {
  uint32_t struct_size;
  uint32_t has_wall;
  double origin[3];       /* outside the surface */
  double direction[3];    /* any length but zero */
  double radius;          /* > 0 */
  double depth;           /* from the origin, > 0 */
  double chord_tolerance; /* 0: 1 % of the radius */
  uint32_t wall_material;
  int32_t weight_policy;
  uint32_t maximum_influences;
  uint32_t reserved;
} sunder_bore;

/* Closes wounds whose lips lie on one another: those of tears without width, and of cuts. */
typedef struct sunder_weld {
  uint32_t struct_size;
  uint32_t place_count;
  const double* places; /* 3 numbers each: only the wound nearest to each is closed; or null: all */
  double reach;         /* how far from these places along the wound; 0: to its ends */
} sunder_weld;

/* Threads between lips that lie on one another. */
typedef struct sunder_suture {
  uint32_t struct_size;
  uint32_t place_count;
  const double* places; /* 3 numbers each: only the wound nearest to each is sewn; or null: all */
  double reach;         /* how far from these places along the wound; 0: to its ends */
  double spacing;       /* between threads along the wound, metres, > 0 */
  double stiffness;     /* of a thread, N/m, > 0 */
  double tension;       /* with which it was tied, newtons */
  double strength;      /* newtons at which it breaks; 0: it never does */
} sunder_suture;

enum { SUNDER_PIECE_FROZEN = 0, SUNDER_PIECE_ANIMATED = 1, SUNDER_PIECE_VANISHES = 2 };
enum { SUNDER_AXES_PRINCIPAL = 0, SUNDER_AXES_MODEL = 1 };
enum { SUNDER_SOLID_CLOSED = 0, SUNDER_SOLID_FANS = 1, SUNDER_SOLID_SHELL = 2 };

/* A connected piece to be taken off. */
typedef struct sunder_detach {
  uint32_t struct_size;
  uint32_t mesh;          /* with `triangle`: one of its triangles */
  uint32_t triangle;      /* SUNDER_NONE: the piece nearest to `point` */
  uint32_t motion;        /* SUNDER_PIECE_... */
  uint32_t axes;          /* SUNDER_AXES_... of a frozen piece */
  uint32_t open_surfaces; /* SUNDER_SOLID_FANS or SUNDER_SOLID_SHELL */
  double point[3];
  const char* bone;       /* with `point`: only triangles that this bone moves most; or null */
  double density;         /* kg/m^3, > 0 */
  double shell_thickness; /* metres; 0: 1 % of the square root of the area */
} sunder_detach;

typedef struct sunder_stroke_sampling {
  uint32_t struct_size;
  uint32_t reserved;
  double minimum_distance; /* metres since the last blade that was used */
  double minimum_seconds;
} sunder_stroke_sampling;

SUNDER_C_API sunder_tear_options sunder_default_tear_options(void);
SUNDER_C_API sunder_cut sunder_default_cut(void);
SUNDER_C_API sunder_bore sunder_default_bore(void);
SUNDER_C_API sunder_weld sunder_default_weld(void);
SUNDER_C_API sunder_suture sunder_default_suture(void);
SUNDER_C_API sunder_detach sunder_default_detach(void);
SUNDER_C_API sunder_stroke_sampling sunder_default_stroke_sampling(void);

enum { SUNDER_IN_BACKGROUND = 1 }; /* flag: the operation takes effect in a later update */

/* Commands are queued, and applied by the next update in the pose that the instance then has. Their
 * outcomes: sunder_get_results(). command: written, or null. Any thread may call these at any time.
 */
SUNDER_C_API sunder_status sunder_submit_tear(sunder_scene scene, sunder_instance instance,
                                              const sunder_blade* blades, uint32_t blade_count,
                                              const sunder_tear_options* options, uint32_t flags,
                                              sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_cut(sunder_scene scene, sunder_instance instance,
                                             const sunder_cut* cut, uint32_t flags,
                                             sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_drill(sunder_scene scene, sunder_instance instance,
                                               const sunder_bore* bore, uint32_t flags,
                                               sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_weld(sunder_scene scene, sunder_instance instance,
                                              const sunder_weld* weld, uint32_t flags,
                                              sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_suture(sunder_scene scene, sunder_instance instance,
                                                const sunder_suture* suture, uint32_t flags,
                                                sunder_command* command);
/* A stroke over several frames. */
SUNDER_C_API sunder_status sunder_submit_begin_stroke(sunder_scene scene, sunder_instance instance,
                                                      const sunder_blade* blade,
                                                      const sunder_tear_options* options,
                                                      const sunder_stroke_sampling* sampling,
                                                      sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_extend_stroke(sunder_scene scene, sunder_instance instance,
                                                       const sunder_blade* blade, double seconds,
                                                       sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_end_stroke(sunder_scene scene, sunder_instance instance,
                                                    sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_cancel_stroke(sunder_scene scene, sunder_instance instance,
                                                       sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_detach(sunder_scene scene, sunder_instance instance,
                                                const sunder_detach* detach,
                                                sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_undo(sunder_scene scene, sunder_instance instance,
                                              sunder_command* command);
SUNDER_C_API sunder_status sunder_submit_redo(sunder_scene scene, sunder_instance instance,
                                              sunder_command* command);

/* Applies an operation log (docs/operation_log.md) at once, in the poses that it names; tissue
 * follows. Stops at the first operation that fails: those before it stay, and operation_count, the
 * number of them, is written then too (or it is null). Fails: as reading the log, which applies
 * nothing (the text has the place in it), and as the operation (the index is its number). */
SUNDER_C_API sunder_status sunder_apply_log(sunder_scene scene, sunder_instance instance,
                                            const char* json, uint64_t size,
                                            uint32_t* operation_count);
/* The operations that are done and not undone, as a log that makes the same model again, bit for
 * bit. */
SUNDER_C_API sunder_status sunder_get_log(sunder_scene scene, sunder_instance instance,
                                          sunder_bytes* json);
/* A hash of all bits of the torn model: equal on every machine. 0: nothing was torn yet. O(size of
 * the model). */
SUNDER_C_API sunder_status sunder_get_digest(sunder_scene scene, sunder_instance instance,
                                             uint64_t* digest);
/* Numbers of operations that undo and redo can take. */
SUNDER_C_API sunder_status sunder_get_undo_counts(sunder_scene scene, sunder_instance instance,
                                                  uint32_t* undo, uint32_t* redo);

/* ---- Results ---- */

typedef uint32_t
    sunder_piece; /* a part that came off: a character of its own, with mass and inertia */

/* The outcome of a command in the last update. */
typedef struct sunder_result {
  sunder_command command;
  sunder_instance instance;
  const char* error;        /* empty if it succeeded */
  sunder_status status;     /* a command that failed changed nothing */
  uint32_t error_index;     /* SUNDER_NONE: none */
  uint32_t runs;            /* of torn surface; 0: it missed */
  uint32_t segments_missed; /* of the stroke, by the blade's reach */
  uint32_t faces_crossed;
  uint32_t vertices_added;
  uint32_t triangles_added;
  uint32_t triangles_retired;
  uint32_t blocked; /* places where the surface could not be torn */
  uint32_t caps;
  uint32_t open_sections;      /* rims that got no cap or wall */
  uint32_t separated_pieces;   /* parts that hang together with nothing else now */
  uint32_t has_piece;          /* 1: sunder_take_piece() */
  uint32_t advises_background; /* 1: it took long; use SUNDER_IN_BACKGROUND for one like it */
  double length;               /* of the tear on the posed surface */
  double area_removed;         /* by a gap or bore */
} sunder_result;

/* A view, valid until the next update. Ascending by command. */
SUNDER_C_API sunder_status sunder_get_results(sunder_scene scene, const sunder_result** results,
                                              uint32_t* count);

/* What one call changed in an instance, for programs that keep copies of its model or particles of
 * their own. Views, valid until the next update. */
typedef struct sunder_change {
  uint32_t struct_size;
  uint32_t first_point; /* surface points that were appended */
  uint32_t point_count;
  uint32_t mesh_count; /* that changed: sunder_get_mesh_change() */
  uint32_t lip_count;
  uint32_t left_count;
  uint32_t right_count;
  uint32_t weld_count;
  const uint32_t* lips;  /* 2 points each that were one: left and right of the stroke, along it */
  const uint32_t* left;  /* points on the left side of a gap, ascending */
  const uint32_t* right; /* on its right side */
  const uint32_t* welds; /* 2 points each that a weld made one: the one that is kept, and the other,
                            which has no face any more. The undo of a weld lists the same. */
} sunder_change;
/* The part of it in one mesh. Vertices and triangles are only appended, and removed from the end by
 * undo: the mesh now has first_vertex + vertex_count vertices, and as many triangles. Where new
 * vertices come from: sunder_get_vertex_origins(). */
typedef struct sunder_mesh_change {
  uint32_t struct_size;
  uint32_t mesh;
  uint32_t first_vertex;
  uint32_t vertex_count;
  uint32_t first_triangle;
  uint32_t triangle_count;
  uint32_t rewritten_count;
  uint32_t retired_count;
  uint32_t released_count;
  uint32_t returned_count;
  uint32_t dirty_vertex_count; /* numbers of ranges */
  uint32_t dirty_triangle_count;
  const sunder_triangle_write*
      rewritten;            /* triangles with other corners now, and those they had before */
  const uint32_t* retired;  /* triangles that are drawn no more, ascending; also in `rewritten` */
  const uint32_t* released; /* vertices that only a detached piece used, ascending */
  const uint32_t* returned; /* by an undo */
  const sunder_range* dirty_vertices;
  const sunder_range* dirty_triangles;
} sunder_mesh_change;

/* How many changes a command of the last update made: none if it failed; undo and redo of a stroke
 * make several. Fails: SUNDER_NOT_FOUND without sunder_scene_options.wants_changes, and for another
 * command. */
SUNDER_C_API sunder_status sunder_get_change_count(sunder_scene scene, sunder_command command,
                                                   uint32_t* count);
SUNDER_C_API sunder_status sunder_get_change(sunder_scene scene, sunder_command command,
                                             uint32_t which, sunder_change* change);
/* part: of sunder_change.mesh_count; ascending by mesh. */
SUNDER_C_API sunder_status sunder_get_mesh_change(sunder_scene scene, sunder_command command,
                                                  uint32_t which, uint32_t part,
                                                  sunder_mesh_change* change);
/* The piece of a detach in the last update. */
SUNDER_C_API sunder_status sunder_take_piece(sunder_scene scene, sunder_command command,
                                             sunder_piece* piece);
SUNDER_C_API sunder_status sunder_destroy_piece(sunder_piece piece);

typedef struct sunder_piece_info {
  uint32_t struct_size;
  uint32_t solid; /* SUNDER_SOLID_...: how its volume was found */
  uint32_t holes;
  uint32_t mesh_count;
  double model_from_piece[12]; /* the frame of a frozen piece where it came off */
  double centre[3];            /* of mass, model space */
  double inertia[9];           /* about the centre, along the axes of the model, kg m^2 */
  double inertia_piece[9];     /* along the axes of the piece */
  double mass;
  double volume;
  double area;
} sunder_piece_info;

typedef struct sunder_hull {
  const double* points;      /* 3 numbers each, in the frame of the piece */
  const uint32_t* triangles; /* 3 numbers each, counter-clockwise */
  uint32_t point_count;
  uint32_t triangle_count;
  uint32_t bone; /* whose part it is, or SUNDER_NONE */
  uint32_t reserved;
  double volume;
} sunder_hull;

SUNDER_C_API sunder_status sunder_get_piece(sunder_piece piece, sunder_piece_info* info);
/* The piece as a character, for an asset of its own. Fails: SUNDER_NOT_FOUND for
 * SUNDER_PIECE_VANISHES. */
SUNDER_C_API sunder_status sunder_get_piece_character(sunder_piece piece,
                                                      sunder_character* character);
/* For each vertex of a mesh of the piece: the vertex of the torn mesh that it was. A view, valid
 * until the piece is destroyed. */
SUNDER_C_API sunder_status sunder_get_piece_vertices(sunder_piece piece, uint32_t mesh,
                                                     uint32_t* torn_mesh,
                                                     const uint32_t** torn_vertices,
                                                     uint32_t* count);
/* Convex hulls of a frozen piece for a physics engine, computed at the first call: at most
 * `most_hulls` of at most `most_points` points. A view, valid until the next call for the piece.
 * One thread at a time per piece. Fails: SUNDER_UNSUPPORTED_FEATURE without SUNDER_FEATURE_HULLS.
 */
SUNDER_C_API sunder_status sunder_get_piece_hulls(sunder_piece piece, uint32_t most_hulls,
                                                  uint32_t most_points, const sunder_hull** hulls,
                                                  uint32_t* count);
/* Lets the soft instance of a piece, not updated yet, move on as the piece did. */
SUNDER_C_API sunder_status sunder_inherit_motion(sunder_scene scene, sunder_instance instance,
                                                 sunder_piece piece);

/* ---- The wounds in the texture ---- */

typedef struct sunder_wound_mask_options {
  uint32_t struct_size;
  uint32_t width; /* texels of the texture, 1 to 16384 */
  uint32_t height;
  uint32_t uv_set;
  uint32_t dilation; /* texels beyond the border of a chart, 1 to 64 */
  uint32_t reserved;
  double reach; /* metres along the surface; texels farther from a lip have this distance */
  uint32_t first_operation; /* whose lips and removed skin count, as the log numbers them */
  uint32_t operation_count; /* SUNDER_NONE: all further */
} sunder_wound_mask_options;

/* distances: width * height numbers, row by row from the top: metres along the surface from the
 * nearest lip, at most the reach; negative where operations removed the skin. */
typedef struct sunder_wound_mask {
  uint32_t struct_size;
  uint32_t width;
  uint32_t height;
  uint32_t left; /* the texels that may have changed since the last call; none: width 0 */
  uint32_t top;
  uint32_t changed_width;
  uint32_t changed_height;
  uint32_t overlapping_texels;  /* of mirrored or stacked charts */
  uint32_t unpainted_triangles; /* without area in the texture, or wider than it */
  uint32_t reserved;
  const float* distances;
} sunder_wound_mask;

SUNDER_C_API sunder_wound_mask_options sunder_default_wound_mask_options(void);
/* Keeps the wounds of a mesh in a texture from now on: every operation, undo and redo paints what
 * it changes; docs/wound_mask.md. Called again, it begins anew. Snapshots do not keep it. O(texels
 * + triangles), allocates. Fails: SUNDER_NOT_FOUND without the UV set; an option out of its range;
 * SUNDER_LIMIT_EXCEEDED. */
SUNDER_C_API sunder_status sunder_begin_wound_mask(sunder_scene scene, sunder_instance instance,
                                                   uint32_t mesh,
                                                   const sunder_wound_mask_options* options);
/* A view, valid until the next call that changes the instance: upload the rectangle of it. Fails:
 * SUNDER_NOT_FOUND without sunder_begin_wound_mask(). */
SUNDER_C_API sunder_status sunder_get_wound_mask(sunder_scene scene, sunder_instance instance,
                                                 uint32_t mesh, sunder_wound_mask* mask);
/* What sunder_get_wound_channel() tells of each texel. */
enum {
  SUNDER_WOUND_AGE = 0, /* operations since the one that made the nearest lip; -1: none in reach */
  SUNDER_WOUND_DEPTH = 1,  /* of the wall below the nearest lip, metres in bind space; 0: none */
  SUNDER_WOUND_STRETCH = 2 /* largest principal stretch of the skin that was drawn, within reach */
};
/* A number per texel of the mask, ordered as its distances. A view, valid until the next call of
 * this function or of sunder_flow_blood() for the scene. O(texels). Fails: SUNDER_NOT_FOUND without
 * sunder_begin_wound_mask(); SUNDER_SIZE_MISMATCH for the stretch of an instance that was not
 * updated since it was torn, or poses no vertices; SUNDER_LIMIT_EXCEEDED. */
SUNDER_C_API sunder_status sunder_get_wound_channel(sunder_scene scene, sunder_instance instance,
                                                    uint32_t mesh, uint32_t channel,
                                                    const float** texels, uint32_t* texel_count);

/* Rivulets of blood that run down from lips. */
typedef struct sunder_blood_flow_options {
  uint32_t struct_size;
  uint32_t reserved;
  double down[3]; /* in model space; any length but 0 */
  double length;  /* of the longest one along the surface in bind space, metres */
  double width;   /* of the widest one where it begins, metres */
  double spacing; /* along lips from one to the next, on the mean; metres */
  uint64_t seed;  /* chooses where they begin and how they wander */
} sunder_blood_flow_options;

SUNDER_C_API sunder_blood_flow_options sunder_default_blood_flow_options(void);
/* Lets blood run from the lips over the surface in the pose of the last update, once: how much of
 * it is on each texel of the mask, 0 to 1. A view, as that of sunder_get_wound_channel(). Fails:
 * SUNDER_NOT_FOUND; SUNDER_INVALID_ARGUMENT; SUNDER_SIZE_MISMATCH before the first update. */
SUNDER_C_API sunder_status sunder_flow_blood(sunder_scene scene, sunder_instance instance,
                                             uint32_t mesh,
                                             const sunder_blood_flow_options* options,
                                             const float** texels, uint32_t* texel_count);
/* Drops it, if there is one. */
SUNDER_C_API sunder_status sunder_end_wound_mask(sunder_scene scene, sunder_instance instance,
                                                 uint32_t mesh);

/* ---- Tissue ---- */

typedef struct sunder_tissue_info {
  uint32_t struct_size;
  uint32_t particle_count;
  uint32_t point_count; /* of the surface: vertices at one place are one point */
  uint32_t is_awake;    /* 0: nothing moves */
} sunder_tissue_info;

enum {
  SUNDER_COLLIDER_SPHERE = 0,
  SUNDER_COLLIDER_CAPSULE = 1,
  SUNDER_COLLIDER_BOX = 2,
  SUNDER_COLLIDER_HALF_SPACE = 3
};

/* A rigid shape that pushes tissue away, in its own frame: capsules lie along y, half-spaces below
 * y = 0. */
typedef struct sunder_collider {
  uint32_t shape; /* SUNDER_COLLIDER_... */
  uint32_t reserved;
  double size[3];     /* sphere: radius; capsule: radius, half length; box: half sizes */
  double place[3];    /* origin of the frame, model space */
  double rotation[4]; /* x y z w, unit length */
  double friction;    /* >= 0 */
} sunder_collider;

/* Limits of a tear by force: the smaller of the two lengths counts. */
typedef struct sunder_force_tearing_options {
  uint32_t struct_size;
  uint32_t reserved;
  double length;            /* as a fraction of the particles' range, in (0, 2] */
  double metres;            /* > 0; for instance a speed times the time since the last call */
  double metres_per_second; /* greatest speed; 0: any */
  double least_piece_area;  /* m^2 in the pose: tears that would cut off less are not made */
} sunder_force_tearing_options;

/* What the tissue bears, and where it gave way. */
typedef struct sunder_force_tearing {
  uint32_t struct_size;
  uint32_t has_torn;
  uint32_t is_from_tip; /* 1: it continues an older tear */
  uint32_t vertices_added;
  double greatest_stretch; /* around an awake particle whose material has a strength */
  double greatest_release; /* energy, J/m, that a tip would release by running on */
  double length;           /* of the tear on the posed surface */
  double place[3];         /* where it begins, model space */
  double direction[3];     /* of unit length */
} sunder_force_tearing;

/* A thread of a suture, between vertices of its two lips; SUNDER_NONE: an end holds nothing any
 * more. */
typedef struct sunder_suture_thread {
  uint32_t left_mesh;
  uint32_t left_vertex;
  uint32_t right_mesh;
  uint32_t right_vertex;
  double newtons; /* with which it pulled its lips together in the last update */
  uint32_t is_broken;
  uint32_t reserved;
} sunder_suture_thread;

SUNDER_C_API sunder_force_tearing_options sunder_default_force_tearing_options(void);
/* All threads, in the order in which they were tied; valid until the next call on the scene. */
SUNDER_C_API sunder_status sunder_get_threads(sunder_scene scene, sunder_instance instance,
                                              const sunder_suture_thread** threads,
                                              uint32_t* count);

/* These need a soft instance after sunder_prepare_to_tear() or its first operation: else
 * SUNDER_NOT_FOUND. */
SUNDER_C_API sunder_status sunder_get_tissue(sunder_scene scene, sunder_instance instance,
                                             sunder_tissue_info* info);
/* The point of the surface at a vertex, or SUNDER_NONE. */
SUNDER_C_API sunder_status sunder_get_point(sunder_scene scene, sunder_instance instance,
                                            uint32_t mesh, uint32_t vertex, uint32_t* point);
/* Changes a material wherever it is used. */
SUNDER_C_API sunder_status sunder_change_material(sunder_scene scene, sunder_instance instance,
                                                  uint32_t index, const sunder_material* material);
SUNDER_C_API sunder_status sunder_set_gravity(sunder_scene scene, sunder_instance instance,
                                              const double gravity[3]);
SUNDER_C_API sunder_status sunder_set_tension(sunder_scene scene, sunder_instance instance,
                                              double newtons_per_metre, uint32_t adds_pose_strain);
SUNDER_C_API sunder_status sunder_add_impulse(sunder_scene scene, sunder_instance instance,
                                              uint32_t point, const double newton_seconds[3]);
/* Pulls a point to a place in model space. stiffness: 1/s^2; 0: the default. */
SUNDER_C_API sunder_status sunder_hold_point(sunder_scene scene, sunder_instance instance,
                                             uint32_t point, const double target[3],
                                             double stiffness, uint64_t* hold);
SUNDER_C_API sunder_status sunder_move_hold(sunder_scene scene, sunder_instance instance,
                                            uint64_t hold, const double target[3]);
SUNDER_C_API sunder_status sunder_release_hold(sunder_scene scene, sunder_instance instance,
                                               uint64_t hold);
/* Tears at once, at one place at most, where tissue whose material has a strength or a toughness
 * gives way in the pose of the last update; call it after an update. The tear is an operation like
 * the others: the next update draws it, and it can be undone. */
SUNDER_C_API sunder_status sunder_tear_overstretched(sunder_scene scene, sunder_instance instance,
                                                     const sunder_force_tearing_options* options,
                                                     sunder_force_tearing* found);
/* Replaces all colliders. */
SUNDER_C_API sunder_status sunder_set_colliders(sunder_scene scene, sunder_instance instance,
                                                const sunder_collider* colliders, uint32_t count);
/* The position of a collider at the end of the next update; its velocity follows. */
SUNDER_C_API sunder_status sunder_move_collider(sunder_scene scene, sunder_instance instance,
                                                uint32_t collider, const double place[3],
                                                const double rotation[4]);

/* ---- Ragdolls ---- */

typedef uint32_t sunder_ragdoll; /* a character as rigid bodies and joints of a physics engine */

enum { SUNDER_JOINT_HINGE = 0, SUNDER_JOINT_CONE = 1 };

/* How far a bone may turn from its rest. A hinge turns about its axis alone; in a cone the axis
 * swings by at most `cone`, and the bone twists about it from `lower` to `upper`. */
typedef struct sunder_bone_limit {
  uint32_t bone;
  uint32_t kind;  /* SUNDER_JOINT_... */
  double axis[3]; /* in the bone's own frame; any length but zero */
  double lower;   /* radians */
  double upper;
  double cone;
} sunder_bone_limit;

typedef struct sunder_ragdoll_options {
  uint32_t struct_size;
  uint32_t maximum_bodies; /* 1 to 1024; the lightest join others */
  uint32_t open_surfaces;  /* SUNDER_SOLID_FANS or SUNDER_SOLID_SHELL */
  uint32_t limit_count;
  const sunder_bone_limit* limits; /* of joints, at most one per bone; of others: what clips show */
  double least_share;              /* of the mass; lighter bodies join others */
  double density;                  /* kg/m^3, > 0 */
  double shell_thickness;          /* metres; 0: 1 % of the square root of the area */
} sunder_ragdoll_options;

/* A rigid body, and its joint to the body above. Frames are rotations and translations. */
typedef struct sunder_ragdoll_body {
  uint32_t bone;                /* that moves its part of the surface */
  uint32_t parent;              /* body before it in the list; SUNDER_NONE: it has no joint */
  double mass;                  /* > 0 */
  double moments[3];            /* of inertia about the axes of the body, > 0 */
  double model_from_body[12];   /* where it starts; the origin is its centre of mass */
  double parent_from_joint[12]; /* the frame of the joint, fixed to the parent ... */
  double body_from_joint[12];   /* ... and to this body; x is the axis of the limit */
  sunder_collider shape;        /* ball, capsule or box around its part, in its frame */
  sunder_bone_limit limit;      /* of the turn about x, and of the swing of x */
} sunder_ragdoll_body;

SUNDER_C_API sunder_ragdoll_options sunder_default_ragdoll_options(void);
/* Makes a body of each bone that moves a part of a character most, for example of an animated piece
 * that came off (sunder_get_piece_character()), and ties it to the nearest one; docs/ragdoll.md.
 * model_from_bone: 12 numbers per bone, the pose in which it stands; morph_weights: of the
 * character, null: those of rest. Fails: SUNDER_EMPTY_INPUT without a surface; an option, limit or
 * number out of its range. */
SUNDER_C_API sunder_status sunder_create_ragdoll(sunder_character character,
                                                 const double* model_from_bone, uint32_t bone_count,
                                                 const float* morph_weights,
                                                 const sunder_ragdoll_options* options,
                                                 sunder_ragdoll* ragdoll);
SUNDER_C_API sunder_status sunder_destroy_ragdoll(sunder_ragdoll ragdoll);
/* A view, valid until the ragdoll is destroyed; parents come first. */
SUNDER_C_API sunder_status sunder_get_ragdoll_bodies(sunder_ragdoll ragdoll,
                                                     const sunder_ragdoll_body** bodies,
                                                     uint32_t* count);
/* The convex hull of each body's part, in its frame. A view, valid until the next call for the
 * ragdoll. One thread at a time per ragdoll. Fails: SUNDER_UNSUPPORTED_FEATURE without
 * SUNDER_FEATURE_HULLS. */
SUNDER_C_API sunder_status sunder_get_ragdoll_hulls(sunder_ragdoll ragdoll, uint32_t most_points,
                                                    const sunder_hull** hulls, uint32_t* count);
/* Where a pose puts the bodies: 12 numbers per body, written. Of two poses they give the velocities
 * with which the bodies start; of a pose of a clip, targets of motors. */
SUNDER_C_API sunder_status sunder_place_bodies(sunder_ragdoll ragdoll,
                                               const double* model_from_bone, uint32_t bone_count,
                                               double* model_from_body);
/* How bodies in these places turn their joints: quaternions x y z w, one per body, written: from
 * the frame fixed to the parent to that fixed to the body. */
SUNDER_C_API sunder_status sunder_get_joint_turns(sunder_ragdoll ragdoll,
                                                  const double* model_from_body,
                                                  uint32_t body_count, double* turns);
/* The pose in which bodies in these places hold the bones: 12 numbers per bone, written, for
 * sunder_set_matrices(). */
SUNDER_C_API sunder_status sunder_pose_of_bodies(sunder_ragdoll ragdoll,
                                                 const double* model_from_body, uint32_t body_count,
                                                 double* model_from_bone);

/* ---- Contact ---- */

typedef struct sunder_contact {
  double place[3];  /* on the drawn surface, model space */
  double normal[3]; /* of the triangle */
  double distance;  /* from the origin, base, axis or point of the query */
  double depth;     /* below the surface */
  double barycentric[3];
  uint32_t mesh;
  uint32_t triangle;
  uint32_t submesh;
  uint32_t material;
  uint32_t bone;   /* the one with most weight there */
  uint32_t enters; /* 1: from outside to inside */
} sunder_contact;

/* Where rays, blades and points meet the surface as it was drawn last. has_hit: 0: nowhere, and
 * nothing else is written. The first query after a change of the instance: O(faces that changed +
 * bones); others O(log faces). They need sunder_prepare_to_tear() or an operation before, and one
 * update. */
SUNDER_C_API sunder_status sunder_cast_ray(sunder_scene scene, sunder_instance instance,
                                           const double origin[3], const double direction[3],
                                           double length, sunder_contact* contact,
                                           uint32_t* has_hit);
SUNDER_C_API sunder_status sunder_find_nearest(sunder_scene scene, sunder_instance instance,
                                               const double point[3], double most_distance,
                                               sunder_contact* contact, uint32_t* has_hit);
/* All places where a blade crosses the surface, from base to tip; at most `capacity` are written.
 * count: of all. */
SUNDER_C_API sunder_status sunder_find_blade_contacts(sunder_scene scene, sunder_instance instance,
                                                      const sunder_blade* blade,
                                                      sunder_contact* contacts, uint32_t capacity,
                                                      uint32_t* count);

/* How tissue resists a blade. */
typedef struct sunder_cutting_resistance {
  uint32_t struct_size;
  uint32_t reserved;
  double toughness; /* energy per area of new section, J/m^2; >= 0 */
  double thickness; /* of the layer that is torn, metres; >= 0 */
  double friction;  /* drag inside the tissue, newtons per metre of depth; >= 0 */
  double greatest;  /* newtons, > 0: what the device can give */
} sunder_cutting_resistance;

SUNDER_C_API sunder_cutting_resistance sunder_default_cutting_resistance(void);
/* The force that a blade feels, for a haptic device; it needs no scene. length_torn: of the frame,
 * sunder_result.length; depth: of the tip below the surface, metres; motion: of the tip since the
 * last frame, model space, metres. force: newtons, written; it opposes the motion. */
SUNDER_C_API sunder_status sunder_blade_force(const sunder_cutting_resistance* tissue,
                                              double length_torn, double depth,
                                              const double motion[3], double force[3]);

/* ---- Validation of a skin against its source ---- */

typedef uint32_t sunder_report; /* what sunder_validate() found */

enum { SUNDER_SEVERITY_NOTE = 0, SUNDER_SEVERITY_WARNING = 1, SUNDER_SEVERITY_ERROR = 2 };
/* How a figure is known: from all data; as a bound for all poses; the largest over the poses that
 * were tried. */
enum {
  SUNDER_EVIDENCE_EXACT = 0,
  SUNDER_EVIDENCE_CERTIFIED = 1,
  SUNDER_EVIDENCE_SAMPLED = 2,
  SUNDER_EVIDENCE_NOT_TESTED = 3
};

/* docs/validation.md explains the fields. */
typedef struct sunder_validation_options {
  uint32_t struct_size;
  uint32_t random_poses;    /* at most 100,000 */
  uint32_t has_clip_limits; /* 1: certificates hold for the joints' reach in the source's clips */
  uint32_t reserved;
  uint64_t seed;
  double random_angle;      /* largest turn of a bone from rest, radians */
  double maximum_deviation; /* share of the diagonal; more is a warning */
  double error_deviation;   /* share of the diagonal; more is an error */
  double clip_margin;       /* radians beyond the reach in clips */
} sunder_validation_options;

/* One kind of fault, over all vertices that have it, and the worst place. */
typedef struct sunder_finding {
  const char* code;   /* "SUNDER_W_SUM" */
  const char* text;   /* what is wrong, where, how much */
  const char* advice; /* what to do about it */
  const char* unit;
  double value; /* the worst */
  double threshold;
  uint64_t count;    /* vertices, bones or edges concerned */
  uint32_t severity; /* SUNDER_SEVERITY_... */
  uint32_t evidence; /* SUNDER_EVIDENCE_... */
  uint32_t mesh;     /* of the target; SUNDER_NONE: none */
  uint32_t vertex;
  uint32_t bone;
  uint32_t reserved;
} sunder_finding;

typedef struct sunder_report_info {
  uint32_t struct_size;
  uint32_t error_count; /* findings of that severity */
  uint32_t warning_count;
  uint32_t note_count;
  uint32_t pose_count;    /* in which the two were compared */
  uint32_t vertex_count;  /* of the target, all meshes one after the other */
  uint32_t unmatched;     /* vertices without a place on the source */
  uint32_t uncertified;   /* matched vertices without a bound */
  double diagonal;        /* of the source, metres */
  double sampled;         /* the largest deviation in these poses, metres */
  double found;           /* the largest that a search found within the joint limits */
  double certified;       /* no certified vertex strays farther in any pose within the limits */
  double metres_per_unit; /* of the source's bind space */
  /* Of sunder_validate_instance(): the points that the newest operation made on the surface, and
   * the largest of their deviations and bounds, metres. */
  double newest_sampled;
  double newest_certified;
  uint32_t newest_points;
  uint32_t newest_uncertified; /* of these, without a bound */
} sunder_report_info;

SUNDER_C_API sunder_validation_options sunder_default_validation_options(void);
/* Compares the skin of a target with that of its source: rows of weights, deformation, and the
 * place of the weights. O(vertices x poses), allocates. Fails: SUNDER_UNSUPPORTED_FEATURE without
 * SUNDER_FEATURE_VALIDATION; SUNDER_INVALID_ARGUMENT, SUNDER_NON_FINITE_VALUE for an option. */
SUNDER_C_API sunder_status sunder_validate(sunder_character source, sunder_character target,
                                           const sunder_validation_options* options,
                                           sunder_report* report);
/* The same for the torn character of an instance and the one that its asset was made from. Vertices
 * are matched by where operations made them. Fails: as sunder_validate(); SUNDER_NOT_FOUND for the
 * instance. */
SUNDER_C_API sunder_status sunder_validate_instance(sunder_scene scene, sunder_instance instance,
                                                    const sunder_validation_options* options,
                                                    sunder_report* report);
SUNDER_C_API sunder_status sunder_destroy_report(sunder_report report);
SUNDER_C_API sunder_status sunder_get_report(sunder_report report, sunder_report_info* info);
/* By severity, errors first. A view, valid until the report is destroyed. */
SUNDER_C_API sunder_status sunder_get_findings(sunder_report report,
                                               const sunder_finding** findings, uint32_t* count);
/* Per vertex of the target: the largest deviation over the poses that were tried, and the bound for
 * all poses within the limits, metres; NaN: no match, or no bound. Views, valid until the report is
 * destroyed. */
SUNDER_C_API sunder_status sunder_get_vertex_deviations(sunder_report report,
                                                        const float** deviations,
                                                        const float** bounds, uint32_t* count);

/* ---- Transfer of a skin ---- */

enum { SUNDER_TRANSFER_CLOSEST_POINT = 0, SUNDER_TRANSFER_INPAINTING = 1 };
/* How a vertex got its weights: it stands on a vertex of the source; interpolated at an accepted
 * match; continued from such; interpolated at a place that was not accepted; kept. */
enum {
  SUNDER_TRANSFER_COINCIDENT = 0,
  SUNDER_TRANSFER_MATCHED = 1,
  SUNDER_TRANSFER_INPAINTED = 2,
  SUNDER_TRANSFER_NEAREST = 3,
  SUNDER_TRANSFER_LOCKED = 4
};

/* Bones of the target and of the source that are the same, though their names differ. */
typedef struct sunder_bone_names {
  const char* target;
  const char* source;
} sunder_bone_names;

/* docs/transfer.md explains the fields. */
typedef struct sunder_transfer_options {
  uint32_t struct_size;
  uint32_t method;             /* SUNDER_TRANSFER_CLOSEST_POINT or _INPAINTING */
  uint32_t flips_normals;      /* 1: normals that point the opposite way agree too */
  uint32_t isolates_parts;     /* 1: each connected part is matched to one of the source */
  uint32_t keeps_sides_apart;  /* 1: bones named left move only vertices on the left */
  uint32_t smoothing_sweeps;   /* after filling */
  uint32_t maximum_influences; /* per vertex; 0: all */
  uint32_t bone_name_count;
  uint32_t bone_count;
  uint32_t locked_count;
  double distance;           /* of an accepted match; share of the target's diagonal */
  double angle;              /* between its normals, radians */
  double smoothness;         /* of what is filled */
  double smoothing_strength; /* of a sweep, 0 to 1 */
  double mix;                /* share of the new weights, 0 to 1 */
  const sunder_bone_names* bone_names;
  const char* const* bones; /* of the source, whose weights are transferred; none: all */
  const uint8_t* locked;    /* per vertex of the target, all meshes one after the other: 1 keeps its
                               weights; null: none */
} sunder_transfer_options;

typedef struct sunder_transfer_info {
  uint32_t struct_size;
  uint32_t vertex_count; /* of the target, all meshes one after the other; as the next five */
  uint32_t coincident;
  uint32_t matched;
  uint32_t inpainted;
  uint32_t nearest;
  uint32_t locked;
  uint32_t too_far;              /* matches refused because of their distance */
  uint32_t turned_away;          /* matches refused because of their normals */
  uint32_t has_adopted_skeleton; /* 1: the target had none of the source's bones */
  double matched_share;          /* of the vertices that are not locked */
  double largest_distance;       /* of an accepted match, metres */
} sunder_transfer_info;

SUNDER_C_API sunder_transfer_options sunder_default_transfer_options(void);
/* Gives a target the skin of a source; both stand in their bind poses in the same place. result: a
 * new character, with the target's document, if it has one. info: what was done, or null.
 * outcomes: SUNDER_TRANSFER_..., one per vertex of the target, all meshes one after the other, or
 * null. O(vertices log triangles), allocates. Fails: SUNDER_NOT_FOUND if nothing matches, or for a
 * bone; SUNDER_SIZE_MISMATCH of `locked`; SUNDER_UNSUPPORTED_FEATURE without
 * SUNDER_FEATURE_VALIDATION; an option out of its range. */
SUNDER_C_API sunder_status sunder_transfer(sunder_character source, sunder_character target,
                                           const sunder_transfer_options* options,
                                           sunder_character* result, sunder_transfer_info* info,
                                           uint8_t* outcomes);

/* ---- Snapshots ---- */

typedef struct sunder_restore_options {
  uint32_t struct_size;
  uint32_t instances;  /* most instances */
  uint64_t operations; /* most operations, which are replayed */
  uint64_t memory;     /* most bytes */
} sunder_restore_options;

SUNDER_C_API sunder_restore_options sunder_default_restore_options(void);
/* The state of all instances, without their assets. Fails while a stroke or a background command is
 * in progress. */
SUNDER_C_API sunder_status sunder_save_scene(sunder_scene scene, sunder_bytes* snapshot);
/* Makes the scene one that was saved: it goes on with the same bits, and the same instances. The
 * bytes are not trusted. */
SUNDER_C_API sunder_status sunder_restore_scene(sunder_scene scene, const void* snapshot,
                                                uint64_t size, const sunder_asset* assets,
                                                uint32_t asset_count,
                                                const sunder_restore_options* options);

#ifdef __cplusplus
}
#endif

#endif /* SUNDER_C_H */
