#pragma once

#include <sunder/scene/scene.h>
#include <sunder/tear/contact.h>

#include <map>
#include <memory>
#include <vector>

#include "bindings/c/asset.h"

namespace sunder::c {

/// A query of the surface of an instance, and what it was set up for.
struct InstanceQuery {
  SurfaceQuery query;
  std::vector<VertexDisplacements> displacements;  ///< The query reads them.
  const TornModel* model = nullptr;
  std::uint64_t change = 0;  ///< SceneObject::change.
};

struct SceneObject : Object {
  static constexpr Kind kKind = Kind::scene;
  explicit SceneObject(Scene of) : scene(std::move(of)) {}

  Scene scene;
  bool wants_changes = false;  ///< CommandOptions of all commands.
  /// The assets of all instances that were spawned or restored.
  std::vector<std::shared_ptr<const AssetParts>> assets;
  std::uint64_t change = 0;  ///< Counts the calls that may change an instance.
  std::map<sunder_instance, InstanceQuery> queries;
  // Memory of views.
  std::vector<sunder_result> results;
  std::vector<sunder_instance> drawn;
  std::vector<sunder_suture_thread> threads;
  MeshView mesh_view;
  std::vector<float> texels;
};

[[nodiscard]] sunder_instance handle_of(const InstanceId& id);
[[nodiscard]] InstanceId instance_of(sunder_instance instance);

/// A scene and one of its instances.
struct Found {
  SceneObject* scene = nullptr;
  CharacterInstance* instance = nullptr;
};

/// Keeps the failure. @return SUNDER_OK; SUNDER_INVALID_HANDLE; SUNDER_NOT_FOUND.
[[nodiscard]] sunder_status find_instance(sunder_scene scene, sunder_instance instance,
                                          Found& found);
/// The same for a mesh of the instance. @return also SUNDER_INDEX_OUT_OF_RANGE.
[[nodiscard]] sunder_status find_mesh(sunder_scene scene, sunder_instance instance,
                                      std::uint32_t mesh, Found& found);

/// Calls `call` with a Scene; its Status is reported.
template <class Call>
sunder_status call_scene(sunder_scene scene, Call&& call) {
  return guarded([&]() -> sunder_status {
    SceneObject* const object = find<SceneObject>(scene);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    return report(call(object->scene));
  });
}

}  // namespace sunder::c
