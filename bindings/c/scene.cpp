#include "bindings/c/scene.h"

#include <algorithm>
#include <utility>

#include "bindings/c/structs.h"

namespace sunder::c {

// 0 is none, so generations are counted from one.
sunder_instance handle_of(const InstanceId& id) {
  return (std::uint64_t{id.generation} + 1) << 32u | id.slot;
}

InstanceId instance_of(sunder_instance instance) {
  if (instance >> 32u == 0) return {};
  return {static_cast<std::uint32_t>(instance), static_cast<std::uint32_t>((instance >> 32u) - 1)};
}

sunder_status find_instance(sunder_scene scene, sunder_instance instance, Found& found) {
  found.scene = find<SceneObject>(scene);
  if (found.scene == nullptr) return SUNDER_INVALID_HANDLE;
  found.instance = found.scene->scene.find(instance_of(instance));
  if (found.instance != nullptr) return SUNDER_OK;
  return fail(SUNDER_NOT_FOUND, kNone, "the scene has no such instance");
}

sunder_status find_mesh(sunder_scene scene, sunder_instance instance, std::uint32_t mesh,
                        Found& found) {
  SUNDER_C_TRY(find_instance(scene, instance, found));
  const std::size_t count = found.instance->asset()->character()->meshes.size();
  if (mesh < count) return SUNDER_OK;
  return fail(SUNDER_INDEX_OUT_OF_RANGE, mesh, "mesh %u of %zu", mesh, count);
}

namespace {

SceneOptions options_of(const sunder_scene_options& from) {
  SceneOptions options;
  options.parallel_for = {from.parallel_for, from.parallel_context, from.parallel_threads};
  options.threads = from.threads;
  options.background = {from.background, from.background_context};
  options.background_updates = from.background_updates;
  options.memory = allocator();
  options.slower_below = {from.slower_below[0], from.slower_below[1]};
  return options;
}

SpawnOptions options_of(const sunder_spawn_options& from) {
  return {{from.vertices, from.triangles, from.operations}, from.is_visible != 0};
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_scene_options sunder_default_scene_options(void) {
  sunder_scene_options options = {};
  options.struct_size = sizeof options;
  options.parallel_threads = 1;
  return options;
}

sunder_spawn_options sunder_default_spawn_options(void) {
  return {sizeof(sunder_spawn_options), 1, 0, 0, 0};
}

sunder_status sunder_create_scene(const sunder_scene_options* options, sunder_scene* scene) {
  return guarded([&]() -> sunder_status {
    SUNDER_C_TRY(check_options(options, "options"));
    if (scene == nullptr) return null_pointer("scene");
    auto created = sunder::Scene::create(
        options_of(options == nullptr ? sunder_default_scene_options() : *options));
    if (!created) return report(created.error());
    auto object = std::make_unique<SceneObject>(std::move(*created));
    object->wants_changes = options != nullptr && options->wants_changes != 0;
    return add(std::move(object), scene);
  });
}

sunder_status sunder_destroy_scene(sunder_scene scene) {
  return destroy_object(scene, Kind::scene);
}

sunder_status sunder_spawn(sunder_scene scene, sunder_asset asset,
                           const sunder_spawn_options* options, sunder_instance* instance) {
  return guarded([&]() -> sunder_status {
    SceneObject* const object = find<SceneObject>(scene);
    const AssetObject* const of = find<AssetObject>(asset);
    if (object == nullptr || of == nullptr) return SUNDER_INVALID_HANDLE;
    SUNDER_C_TRY(check_options(options, "options"));
    if (instance == nullptr) return null_pointer("instance");
    auto& assets = object->assets;
    const bool is_known = std::find(assets.begin(), assets.end(), of->parts) != assets.end();
    if (!is_known) assets.reserve(assets.size() + 1);
    const auto id = object->scene.spawn(
        of->parts->asset,
        options_of(options == nullptr ? sunder_default_spawn_options() : *options));
    if (!id) return report(id.error());
    if (!is_known) assets.push_back(of->parts);
    *instance = handle_of(*id);
    return SUNDER_OK;
  });
}

sunder_status sunder_destroy_instance(sunder_scene scene, sunder_instance instance) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    found.scene->queries.erase(instance);
    return report(found.scene->scene.destroy(instance_of(instance)));
  });
}

sunder_status sunder_has_instance(sunder_scene scene, sunder_instance instance, uint32_t* exists) {
  const SceneObject* const object = find<SceneObject>(scene);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (exists == nullptr) return null_pointer("exists");
  *exists = object->scene.contains(instance_of(instance)) ? 1 : 0;
  return SUNDER_OK;
}

sunder_status sunder_get_instance_count(sunder_scene scene, uint32_t* count) {
  const SceneObject* const object = find<SceneObject>(scene);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (count == nullptr) return null_pointer("count");
  *count = object->scene.instance_count();
  return SUNDER_OK;
}

sunder_status sunder_set_visible(sunder_scene scene, sunder_instance instance,
                                 uint32_t is_visible) {
  return call_scene(scene, [&](sunder::Scene& of) {
    return of.set_visible(instance_of(instance), is_visible != 0);
  });
}

sunder_status sunder_set_screen_height(sunder_scene scene, sunder_instance instance,
                                       double pixels) {
  return call_scene(scene, [&](sunder::Scene& of) {
    return of.set_screen_height(instance_of(instance), pixels);
  });
}

sunder_status sunder_prepare_to_tear(sunder_scene scene, sunder_instance instance) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    ++found.scene->change;
    return report(found.instance->prepare_to_tear());
  });
}

sunder_status sunder_update(sunder_scene scene, double seconds) {
  return guarded([&]() -> sunder_status {
    SceneObject* const object = find<SceneObject>(scene);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    ++object->change;
    return report(object->scene.update(seconds));
  });
}

sunder_status sunder_set_budget(sunder_scene scene, uint32_t settled_points, uint32_t model_work) {
  SceneObject* const object = find<SceneObject>(scene);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  object->scene.set_budget({settled_points, model_work});
  return SUNDER_OK;
}

sunder_status sunder_get_frame_stats(sunder_scene scene, sunder_frame_stats* stats) {
  const SceneObject* const object = find<SceneObject>(scene);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  SUNDER_C_TRY(check_struct(stats, "stats"));
  const sunder::FrameStats& from = object->scene.stats();
  *stats = {sizeof(sunder_frame_stats),
            from.instances,
            from.sampled,
            from.advanced,
            from.drawn,
            from.commands,
            from.failed,
            from.settled_points,
            from.model_work,
            from.idle,
            from.unseen,
            from.waiting,
            from.in_background,
            from.unchanged,
            from.unsettled,
            0,
            from.frame,
            from.vertices,
            from.total,
            from.animation,
            from.operations,
            from.settling,
            from.tissue,
            from.drawing};
  return SUNDER_OK;
}

sunder_status sunder_get_drawn(sunder_scene scene, const sunder_instance** instances,
                               uint32_t* count) {
  return guarded([&]() -> sunder_status {
    SceneObject* const object = find<SceneObject>(scene);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (instances == nullptr) return null_pointer("instances");
    if (count == nullptr) return null_pointer("count");
    const auto drawn = object->scene.drawn();
    object->drawn.resize(drawn.size());
    std::transform(drawn.begin(), drawn.end(), object->drawn.begin(),
                   [](const sunder::InstanceId& id) { return handle_of(id); });
    *instances = object->drawn.data();
    *count = static_cast<uint32_t>(drawn.size());
    return SUNDER_OK;
  });
}

sunder_status sunder_get_shown_level(sunder_scene scene, sunder_instance instance,
                                     uint32_t* level) {
  Found found;
  SUNDER_C_TRY(find_instance(scene, instance, found));
  if (level == nullptr) return null_pointer("level");
  *level = found.scene->scene.shown_level(instance_of(instance));
  return SUNDER_OK;
}

}  // extern "C"
