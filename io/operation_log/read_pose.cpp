#include "io/operation_log/read_pose.h"

#include <cmath>
#include <utility>

#include "operation/internal/field_ranges.h"

namespace sunder::operation_log {
namespace {

ClipPose read_clip_pose(const Place& place) {
  place.check_fields({"clip", "time"});
  ClipPose pose;
  const Place clip = place.at("clip");
  if (clip.value.is_number_unsigned()) {
    const auto index = clip.value.get<std::uint64_t>();
    if (index >= kNone) clip.malformed("the clip index is too large");
    pose.clip = static_cast<std::uint32_t>(index);
  } else if (clip.value.is_string()) {
    pose.clip = clip.value.get<std::string>();
  } else {
    clip.expected("a clip's name or index");
  }
  pose.time = NumberIn{field::kTime}(place.at("time"));
  return pose;
}

/// Normalises the rotation. Rotations of unit length keep their bits, so that logs are read back
/// exactly.
Quatf read_rotation(const Place& place) {
  const Quatd rotation(Vec4d(read_vector<4>(place)));
  if (rotation.norm() < 1e-9) place.malformed("rotation of zero length");
  const Quatf as_floats = rotation.cast<float>();
  const bool is_unit = std::abs(rotation.norm() - 1.0) < 1e-6 &&
                       as_floats.cast<double>().coeffs() == rotation.coeffs();
  return is_unit ? as_floats : Quatf(rotation.normalized().cast<float>());
}

BonesPose read_bones_pose(const Place& place) {
  place.check_fields({"bones"});
  const Place bones = place.at("bones");
  if (!bones.value.is_object()) bones.expected("an object");
  BonesPose pose;
  bones.for_each_field([&](const std::string& name, const Place& bone) {
    bone.check_fields({"translation", "rotation", "scale"});
    if (name.empty()) bone.malformed("a bone's name must not be empty");
    BonesPose::Bone read{.name = name, .translation = {}, .rotation = {}, .scale = {}};
    if (bone.has("translation"))
      read.translation = read_vector<3>(bone.at("translation")).cast<float>();
    if (bone.has("rotation")) read.rotation = read_rotation(bone.at("rotation"));
    if (bone.has("scale")) read.scale = read_vector<3>(bone.at("scale")).cast<float>();
    pose.bones.push_back(std::move(read));
  });
  return pose;
}

ModelPose read_model_pose(const Place& place) {
  place.check_fields({"matrices", "morph_weights"});
  ModelPose pose;
  const Place matrices = place.at("matrices");
  const std::size_t count = read_array(matrices, "an array of matrices").size();
  pose.model_from_bone.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor | Eigen::DontAlign> rows;
    read_numbers(matrices.at(i), {rows.data(), 12}, kLargestMatrixEntry);
    Affine3d matrix;
    matrix.matrix() = rows;
    pose.model_from_bone.push_back(matrix);
  }
  if (!place.has("morph_weights")) return pose;
  const Place weights = place.at("morph_weights");
  std::vector<double> read(read_array(weights, "an array of numbers").size());
  read_numbers(weights, read);
  for (const double weight : read) pose.morph_weights.push_back(static_cast<float>(weight));
  return pose;
}

}  // namespace

PoseSpec read_pose(const Place& place) {
  if (place.value.is_string()) {
    if (place.value == "rest") return RestPose{};
    if (place.value == "bind") return BindPose{};
    place.malformed("expected \"rest\" or \"bind\"");
  }
  if (!place.value.is_object()) place.expected("\"rest\", \"bind\" or an object");
  if (place.has("bones")) return read_bones_pose(place);
  if (place.has("matrices")) return read_model_pose(place);
  return read_clip_pose(place);
}

}  // namespace sunder::operation_log
