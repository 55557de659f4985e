#pragma once

#include <sunder/core/pose.h>
#include <sunder/core/status.h>
#include <sunder/core/stroke.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sunder {

/// "rest": the file's own bone transforms.
struct RestPose {};
/// "bind": the pose in which the skins were attached.
struct BindPose {};
/// A clip at a time; clip by name or by index.
struct ClipPose {
  std::variant<std::string, std::uint32_t> clip;
  double time = 0.0;  ///< Seconds.
};
/// Bone transforms over rest. A part that the log does not give keeps its rest value.
struct BonesPose {
  struct Bone {
    std::string name;
    std::optional<Vec3f> translation;
    std::optional<Quatf> rotation;  ///< x y z w; normalised when read.
    std::optional<Vec3f> scale;
  };
  std::vector<Bone> bones;
};
using PoseSpec = std::variant<RestPose, BindPose, ClipPose, BonesPose>;

/// {"op": "tear"}: a zero-width tear of the nearest layer along a stroke.
struct TearOperation {
  PoseSpec pose;  ///< Default: rest.
  Stroke stroke;  ///< Model space, metres. At least two blades.
};

using Operation = std::variant<TearOperation>;

/// Reads an operation log (docs/operation_log.md). Unknown fields, wrong types, other versions and values that are not finite are
/// refused; the text names the JSON path ("/operations/0/stroke/1/tip").
/// @return malformed_file, unsupported_feature, limit_exceeded.
[[nodiscard]] SUNDER_API Result<std::vector<Operation>> parse_operations(std::string_view json);

/// parse_operations() of a file's content; also file_not_found, file_unreadable.
[[nodiscard]] SUNDER_API Result<std::vector<Operation>> load_operations(const std::filesystem::path& file);

}  // namespace sunder
