#pragma once

#include <sunder/plan/plan.h>

#include <filesystem>
#include <memory>

namespace sunder::tools {

/// Reads a curve on a character: docs/command/plan.md describes the file.
/// @param pose  in which places that are given as points are looked up.
/// @return as read_json_object(); malformed_file, not_found or invalid_argument, which name the
///         member.
[[nodiscard]] Result<WoundTarget> read_curve(const std::filesystem::path& file,
                                             const std::shared_ptr<const Character>& character,
                                             const ModelPose& pose);

}  // namespace sunder::tools
