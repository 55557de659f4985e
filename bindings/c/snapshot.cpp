#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bindings/c/bytes.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

using namespace sunder::c;

extern "C" {

sunder_restore_options sunder_default_restore_options(void) {
  const sunder::RestoreOptions defaults;
  return {sizeof(sunder_restore_options), defaults.instances, defaults.operations, defaults.memory};
}

sunder_status sunder_save_scene(sunder_scene scene, sunder_bytes* snapshot) {
  return guarded([&]() -> sunder_status {
    const SceneObject* const object = find<SceneObject>(scene);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (snapshot == nullptr) return null_pointer("snapshot");
    auto bytes = object->scene.save();
    if (!bytes) return report(bytes.error());
    return add_bytes(std::move(*bytes), snapshot);
  });
}

sunder_status sunder_restore_scene(sunder_scene scene, const void* snapshot, uint64_t size,
                                   const sunder_asset* assets, uint32_t asset_count,
                                   const sunder_restore_options* options) {
  return guarded([&]() -> sunder_status {
    SceneObject* const object = find<SceneObject>(scene);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    SUNDER_C_TRY(check_options(options, "options"));
    if (snapshot == nullptr) return null_pointer("snapshot");
    SUNDER_C_TRY(check_size(size, "size"));
    if (assets == nullptr && asset_count > 0) return null_pointer("assets");
    std::vector<std::shared_ptr<const AssetParts>> parts;
    std::vector<std::shared_ptr<const sunder::CharacterAsset>> given;
    for (uint32_t i = 0; i < asset_count; ++i) {
      const AssetObject* const asset = find<AssetObject>(assets[i]);
      if (asset == nullptr) return SUNDER_INVALID_HANDLE;
      parts.push_back(asset->parts);
      given.push_back(asset->parts->asset);
    }
    sunder::RestoreOptions limits;
    if (options != nullptr) {
      limits.instances = options->instances;
      limits.operations = options->operations;
      limits.memory = static_cast<std::size_t>(
          std::min<uint64_t>(options->memory, std::numeric_limits<std::size_t>::max()));
    }
    const auto* const first = static_cast<const std::byte*>(snapshot);
    SUNDER_C_TRY(
        report(object->scene.restore({first, static_cast<std::size_t>(size)}, given, limits)));
    ++object->change;
    object->queries.clear();
    object->assets = std::move(parts);
    return SUNDER_OK;
  });
}

}  // extern "C"
