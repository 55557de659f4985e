#pragma once

#include <sunder/io/usd_file.h>

#include <string>

namespace sunder::usd {

/// As usd_layer(). @throws gltf::Refusal
[[nodiscard]] UsdLayer layer_of(const Character& character, const LoadedCharacter& loaded,
                                const SaveOptions& options, const std::string& textures_folder);

}  // namespace sunder::usd
