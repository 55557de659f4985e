#pragma once

#include "io/internal/still_scene.h"

namespace sunder::gltf {

/// See save_still().
[[nodiscard]] Result<std::uint32_t> write_still(const std::filesystem::path& file,
                                                const StillScene& scene,
                                                const SourceDocument& materials);

}  // namespace sunder::gltf
