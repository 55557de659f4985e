#include "io/gltf_read/skins.h"

#include <cmath>

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

// The tolerance for the last row of a matrix. Files of double products and inverses that were
// stored as floats are off by this at most.
constexpr float kWeightRounding = 1e-6f, kLargestWeightRounding = 1e-3f;

struct BindMatrix {
  Affine3f bone_from_bind;
  float last_row_error = 0;
};

BindMatrix read_bind(const Accessor& accessor, std::uint32_t slot, const float* numbers) {
  const Eigen::Matrix4f matrix = Eigen::Map<const Eigen::Matrix4f>(numbers);
  if (!matrix.allFinite())
    refuse(StatusCode::non_finite_value, slot,
           "/accessors/%u: inverse bind matrix %u is not finite", accessor.index, slot);
  const float error = (matrix.row(3) - Eigen::RowVector4f(0, 0, 0, 1)).cwiseAbs().maxCoeff();
  if (error > kLargestWeightRounding)
    refuse(StatusCode::malformed_file, slot,
           "/accessors/%u: inverse bind matrix %u: its last row is not 0 0 0 1", accessor.index,
           slot);
  Affine3f bind;
  bind.matrix() = matrix.topRows<3>();
  return {bind, error};
}

bool is_singular(const Affine3f& bind) {
  const Eigen::Matrix3d linear = bind.linear().cast<double>();
  const double largest = linear.cwiseAbs().maxCoeff();
  return !(std::abs(linear.determinant()) > 1e-12 * largest * largest * largest);
}

}  // namespace

SkinReader::SkinReader(Reading& reading, const NodeSkeleton& nodes, std::vector<Skin>& skins)
    : reading_(reading),
      nodes_(nodes),
      skins_(skins),
      from_gltf_skin_(count_of(reading.json(), "skins"), kNone),
      from_node_(nodes.bone_from_node.size(), kNone) {}

std::uint32_t SkinReader::of_skin(std::uint32_t gltf_skin) {
  std::uint32_t& skin = from_gltf_skin_[gltf_skin];
  if (skin == kNone) {
    skin = static_cast<std::uint32_t>(skins_.size());
    skins_.push_back(read_skin(entry(reading_.json(), "skins", gltf_skin), gltf_skin));
  }
  return skin;
}

std::uint32_t SkinReader::of_node(std::uint32_t node) {
  std::uint32_t& skin = from_node_[node];
  if (skin == kNone) {
    skin = static_cast<std::uint32_t>(skins_.size());
    const std::uint32_t bone = nodes_.bone_from_node[node];
    skins_.push_back({nodes_.skeleton.bones[bone].name, {bone}, {Affine3f::Identity()}});
  }
  return skin;
}

std::uint32_t SkinReader::root_slot(std::uint32_t gltf_skin) const {
  const Cursor at = entry(reading_.json(), "skins", gltf_skin);
  const auto root = at.find("skeleton");
  if (!root) return 0;
  const std::uint32_t node = root->to_index(nodes_.bone_from_node.size(), "node");
  const Cursor joints = at.member("joints");
  for (std::uint32_t slot = 0; slot < joints.size(); ++slot)
    if (joints.element(slot).to_unsigned() == node) return slot;
  return 0;
}

Skin SkinReader::read_skin(const Cursor& at, std::uint32_t gltf_skin) {
  Skin skin;
  skin.name = at.name();
  const Cursor joints = at.member("joints");
  if (joints.size() == 0)
    refuse(StatusCode::malformed_file, kNone, "%s: the skin has no joints",
           joints.pointer().c_str());
  reading_.accessors.charge(joints.size() * (sizeof(std::uint32_t) + sizeof(Affine3f)),
                            joints.pointer());
  for (std::size_t i = 0; i < joints.size(); ++i)
    skin.bones.push_back(
        nodes_.bone_from_node[joints.element(i).to_index(nodes_.bone_from_node.size(), "node")]);
  skin.bone_from_bind.assign(skin.bones.size(), Affine3f::Identity());

  const auto binds = at.find("inverseBindMatrices");
  if (!binds) return skin;
  const Accessor accessor = reading_.accessors.open(*binds);
  if (accessor.components != 16 || accessor.is_integer())
    refuse(StatusCode::malformed_file, accessor.index, "%s: expected MAT4 of floats",
           binds->pointer().c_str());
  if (accessor.count < skin.bones.size())
    refuse(StatusCode::size_mismatch, accessor.index, "%s: %u matrices for %zu joints",
           binds->pointer().c_str(), accessor.count, skin.bones.size());
  const std::vector<float> numbers = reading_.accessors.read_floats(accessor);
  std::uint32_t singular = 0, rounded = 0;
  bool differs = false;
  for (std::uint32_t slot = 0; slot < skin.bones.size(); ++slot) {
    const BindMatrix read = read_bind(accessor, slot, numbers.data() + std::size_t{slot} * 16);
    skin.bone_from_bind[slot] = read.bone_from_bind;
    differs |= read.last_row_error != 0.0f;
    if (read.last_row_error > kWeightRounding) ++rounded;
    if (is_singular(skin.bone_from_bind[slot])) ++singular;
  }
  if (singular > 0)
    reading_.notes.inform(at.pointer(), "inverse bind matrices that are not invertible", singular);
  if (rounded > 0)
    reading_.notes.repaired(StatusCode::malformed_file, kNone, at.pointer(),
                            "inverse bind matrices whose last row was not 0 0 0 1 were corrected",
                            rounded);
  if (differs) repaired_.push_back({gltf_skin, static_cast<std::uint32_t>(skins_.size())});
  return skin;
}

}  // namespace sunder::gltf
