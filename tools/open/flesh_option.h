#pragma once

#include <sunder/io/character_file.h>

#include <string>

namespace sunder::tools {

/// How `--open` writes what is seen between lips.
struct FleshOption {
  enum class Use : std::uint8_t {
    flesh,   ///< Walls of `material`; of the lips' material where the surface has no flesh.
    source,  ///< Walls of the lips' material.
    none,    ///< No walls.
  };
  Use use = Use::flesh;
  /// A colour between the muscle and the fibres of the pictures.
  AppendedMaterial material = {"Wound", {0.34f, 0.036f, 0.028f, 1.0f}, 0.0f, 0.4f, true};
};

/// Reads the value of `--flesh`: "none", "source", or fields separated by commas: "#8a2b22" (sRGB),
/// "roughness=0.3", "name=Meat".
/// @return invalid_argument: what is wrong.
[[nodiscard]] Result<FleshOption> parse_flesh(const std::string& text);

}  // namespace sunder::tools
