#include "bindings/godot/skeleton.h"

#include <array>
#include <cmath>

namespace sunder::godot {
namespace {

/// Columns of the basis, then the origin.
template <class Number>
void append_columns(std::vector<Number>& numbers, const Transform& transform) {
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      numbers.push_back(static_cast<Number>(transform.basis[3 * row + column]));
  for (const float number : transform.origin) numbers.push_back(static_cast<Number>(number));
}

/// The quaternion x y z w of a rotation, by its largest component.
std::array<double, 4> quaternion_of(const std::array<std::array<double, 3>, 3>& r) {
  const double trace = r[0][0] + r[1][1] + r[2][2];
  if (trace > 0) {
    const double s = 2 * std::sqrt(1 + trace);
    return {(r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s, s / 4};
  }
  std::size_t i = r[1][1] > r[0][0] ? 1 : 0;
  if (r[2][2] > r[i][i]) i = 2;
  const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = 2 * std::sqrt(1 + r[i][i] - r[j][j] - r[k][k]);
  std::array<double, 4> q = {};
  q[i] = s / 4;
  q[j] = (r[j][i] + r[i][j]) / s;
  q[k] = (r[k][i] + r[i][k]) / s;
  q[3] = (r[k][j] - r[j][k]) / s;
  return q;
}

/// Shear is dropped: rests only say where a skeleton stands that nobody poses.
sunder_transform decomposed(const Transform& transform) {
  sunder_transform result = {};
  std::array<std::array<double, 3>, 3> m = {};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      m[row][column] = static_cast<double>(transform.basis[3 * row + column]);
  const double determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                             m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                             m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  bool is_flat = false;
  for (std::size_t column = 0; column < 3; ++column) {
    double scale = std::hypot(m[0][column], m[1][column], m[2][column]);
    is_flat |= scale == 0;
    if (column == 0 && determinant < 0) scale = -scale;
    for (std::size_t row = 0; row < 3; ++row) m[row][column] /= scale == 0 ? 1 : scale;
    result.scale[column] = static_cast<float>(scale);
    result.translation[column] = transform.origin[column];
  }
  std::array<double, 4> rotation = {0, 0, 0, 1};
  if (!is_flat) rotation = quaternion_of(m);
  const double length =
      std::hypot(std::hypot(rotation[0], rotation[1]), std::hypot(rotation[2], rotation[3]));
  for (std::size_t i = 0; i < 4; ++i) result.rotation[i] = static_cast<float>(rotation[i] / length);
  return result;
}

}  // namespace

std::string SkeletonReader::read(const Variant& skeleton, const Variant& skin) {
  if (skeleton.is_nil()) return "the mesh instance has no skeleton";
  if (skin.is_nil()) return "the mesh instance has no skin";
  std::string fault = read_bones(skeleton);
  return fault.empty() ? read_skin(skeleton, skin) : fault;
}

std::string SkeletonReader::read_bones(const Variant& skeleton) {
  const std::int64_t count = skeleton.call("get_bone_count").integer();
  if (count <= 0) return "the skeleton has no bone";
  bone_of_godot_.assign(static_cast<std::size_t>(count), SUNDER_NONE);
  std::vector<std::int64_t> parents;
  for (std::int64_t i = 0; i < count; ++i)
    parents.push_back(skeleton.call("get_bone_parent", Variant(i)).integer());
  for (std::size_t before = SUNDER_NONE; before != godot_of_bone_.size();) {
    before = godot_of_bone_.size();
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t parent = parents[static_cast<std::size_t>(i)];
      const bool is_known = bone_of_godot_[static_cast<std::size_t>(i)] != SUNDER_NONE;
      if (is_known ||
          (parent >= 0 && bone_of_godot_[static_cast<std::size_t>(parent)] == SUNDER_NONE))
        continue;
      bone_of_godot_[static_cast<std::size_t>(i)] =
          static_cast<std::uint32_t>(godot_of_bone_.size());
      godot_of_bone_.push_back(i);
    }
  }
  if (godot_of_bone_.size() != static_cast<std::size_t>(count))
    return "the bones of the skeleton are no tree";
  for (const std::int64_t i : godot_of_bone_)
    names_.push_back(skeleton.call("get_bone_name", Variant(i)).text());
  for (std::size_t b = 0; b < names_.size(); ++b) {
    const std::int64_t parent = parents[static_cast<std::size_t>(godot_of_bone_[b])];
    bones_.push_back(
        {names_[b].c_str(),
         parent < 0 ? SUNDER_NONE : bone_of_godot_[static_cast<std::size_t>(parent)],
         decomposed(skeleton.call("get_bone_rest", Variant(godot_of_bone_[b])).transform()), 0});
  }
  return {};
}

std::string SkeletonReader::read_skin(const Variant& skeleton, const Variant& skin) {
  const std::int64_t count = skin.call("get_bind_count").integer();
  for (std::int64_t i = 0; i < count; ++i) {
    std::int64_t bone = skin.call("get_bind_bone", Variant(i)).integer();
    if (const Variant name = skin.call("get_bind_name", Variant(i)); !name.text().empty())
      bone = skeleton.call("find_bone", name).integer();
    if (bone < 0 || static_cast<std::size_t>(bone) >= bone_of_godot_.size())
      return "bind " + std::to_string(i) + " of the skin names no bone of the skeleton";
    slots_.push_back(bone_of_godot_[static_cast<std::size_t>(bone)]);
    append_columns(bone_from_bind_, skin.call("get_bind_pose", Variant(i)).transform());
  }
  return slots_.empty() ? "the skin binds no bone" : std::string();
}

sunder_skin SkeletonReader::skin() const {
  return {"skin", slots_.data(), bone_from_bind_.data(), static_cast<std::uint32_t>(slots_.size()),
          0};
}

void SkeletonReader::read_pose(const Variant& skeleton,
                               std::vector<double>& model_from_bone) const {
  model_from_bone.clear();
  const Name method("get_bone_global_pose");
  for (const std::int64_t bone : godot_of_bone_)
    append_columns(model_from_bone, skeleton.call(method, Variant(bone)).transform());
}

}  // namespace sunder::godot
