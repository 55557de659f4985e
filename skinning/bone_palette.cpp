#include <sunder/skinning/bone_palette.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include <Eigen/SVD>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "skinning/identity.h"
#include "skinning/internal/same_bits.h"
#include "skinning/normal_matrix.h"
#include "skinning/palette_data.h"

namespace sunder {
namespace skinning {

std::uint64_t new_identity() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

namespace {

/// Whether `linear` is a rotation, to the precision of floats in files.
bool is_rigid(const Mat3d& linear) {
  return (multiply(linear.transpose(), linear) - Mat3d::Identity()).cwiseAbs().maxCoeff() <
             kEvenScale &&
         determinant(linear) > 0;
}

/// Writes numbers in float, column by column.
template <class Matrix>
void put(const Matrix& matrix, float* to) {
  for (Eigen::Index i = 0; i < matrix.size(); ++i) to[i] = static_cast<float>(matrix.data()[i]);
}

/// Splits a matrix into a stretch followed by a rigid motion: M v = R S v + t.
void write_motion(PaletteData& data, std::size_t slot, const Affine3d& matrix) {
  Mat3d rotation = matrix.linear(), stretch = Mat3d::Identity();
  data.dual.is_stretched[slot] = !is_rigid(rotation);
  if (data.dual.is_stretched[slot]) {
    const Eigen::JacobiSVD<Eigen::Matrix3d, Eigen::FullPivHouseholderQRPreconditioner> svd(
        Eigen::Matrix3d(rotation), Eigen::ComputeFullU | Eigen::ComputeFullV);
    rotation = multiply(svd.matrixU(), svd.matrixV().transpose());
    if (determinant(rotation) < 0) rotation = -rotation;  // a mirror is part of the stretch
    stretch = multiply(rotation.transpose(), matrix.linear());
  }
  const Quatd real = normalized(Quatd(rotation));
  const Vec3d t = matrix.translation();
  const Quatd dual = multiply(Quatd(0, t.x(), t.y(), t.z()), real);
  put(real.coeffs(), data.dual.motions.data() + 8 * slot);
  put(Vec4d(0.5 * dual.coeffs()), data.dual.motions.data() + 8 * slot + 4);
  put(Mat3d(stretch - Mat3d::Identity()), data.dual.stretches.data() + 18 * slot);
  put(Mat3d(normal_matrix<double>(stretch) - Mat3d::Identity()),
      data.dual.stretches.data() + 18 * slot + 9);
}

void write_slot(PaletteData& data, std::size_t slot, const Affine3f& matrix) {
  std::memcpy(data.matrices.data() + 12 * slot, matrix.data(), 12 * sizeof(float));
  const Affine3d exact = matrix.cast<double>();
  data.is_uneven[slot] = !has_even_scale<double>(exact.linear());
  put(normal_matrix<double>(exact.linear()), data.normal_matrices.data() + 9 * slot);
  if (data.method == SkinningMethod::dual_quaternion) write_motion(data, slot, exact);
  data.revisions[slot] = data.revision;
}

/// Stores data.fresh and the morph weights, after checking all of them.
void take(PaletteData& data, std::span<const float> morph_weights) {
  const std::uint64_t before = data.revision;
  ++data.revision;
  bool changed = before == 0;
  for (std::size_t slot = 0; slot < data.slots; ++slot) {
    if (before != 0 && std::memcmp(data.matrices.data() + 12 * slot, data.fresh[slot].data(),
                                   12 * sizeof(float)) == 0)
      continue;
    write_slot(data, slot, data.fresh[slot]);
    changed = true;
  }
  for (std::size_t i = 0; i < morph_weights.size(); ++i) {
    if (before != 0 && std::memcmp(&data.morph_weights[i], &morph_weights[i], sizeof(float)) == 0)
      continue;
    data.morph_weights[i] = morph_weights[i];
    data.revisions[data.slots + i] = data.revision;
    changed = true;
  }
  if (!changed) {
    data.revision = before;
    return;
  }
  const auto any = [](const std::vector<std::uint8_t>& flags) {
    return std::find(flags.begin(), flags.end(), 1) != flags.end();
  };
  data.any_uneven = any(data.is_uneven);
}

Status check(const PaletteData& data, std::span<const float> morph_weights) {
  for (std::size_t slot = 0; slot < data.slots; ++slot)
    if (!data.fresh[slot].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, static_cast<std::uint32_t>(slot),
                             "slot %zu: its matrix is not finite in float", slot);
  for (std::size_t i = 0; i < morph_weights.size(); ++i)
    if (!std::isfinite(morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, static_cast<std::uint32_t>(i),
                             "morph weight %zu is not finite", i);
  return {};
}

Status check_sizes(const PaletteData& data, std::size_t slots, std::size_t morph_weights) {
  if (slots != data.slots)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the palette has %zu slots, the pose has %zu", data.slots, slots);
  if (morph_weights != data.morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the palette has %zu morph weights, the pose %zu",
                           data.morph_weights.size(), morph_weights);
  return {};
}

}  // namespace
}  // namespace skinning

BonePalette::BonePalette(std::unique_ptr<skinning::PaletteData> data) : data_(std::move(data)) {}

Result<BonePalette> BonePalette::create(std::size_t slots, std::size_t morph_weights,
                                        SkinningMethod method) {
  return or_out_of_memory([&]() -> Result<BonePalette> {
    auto data = std::make_unique<skinning::PaletteData>();
    data->method = method;
    data->id = skinning::new_identity();
    data->slots = slots;
    data->matrices.resize(12 * slots);
    data->normal_matrices.resize(9 * slots);
    data->is_uneven.resize(slots);
    data->morph_weights.resize(morph_weights);
    data->revisions.resize(slots + morph_weights);
    data->last.model_from_bone.resize(slots);
    data->fresh.resize(slots);
    if (method == SkinningMethod::dual_quaternion) {
      data->dual.motions.resize(8 * slots);
      data->dual.stretches.resize(18 * slots);
      data->dual.is_stretched.resize(slots);
    }
    return BonePalette(std::move(data));
  });
}

BonePalette::~BonePalette() = default;
BonePalette::BonePalette(BonePalette&&) noexcept = default;
BonePalette& BonePalette::operator=(BonePalette&&) noexcept = default;

Status BonePalette::set(const Skin& skin, const ModelPose& pose,
                        const Affine3d& model_from_character) {
  skinning::PaletteData& data = *data_;
  if (const Status status =
          skinning::check_sizes(data, skin.bones.size(), pose.morph_weights.size());
      !status)
    return status;
  for (std::uint32_t slot = 0; slot < skin.bones.size(); ++slot)
    if (skin.bones[slot] >= pose.model_from_bone.size())
      return Status::failure(StatusCode::index_out_of_range, slot,
                             "skin slot %u: bone %u does not exist; the pose has %zu bones", slot,
                             skin.bones[slot], pose.model_from_bone.size());

  const bool same_frame = data.last.skin == &skin &&
                          has_same_bits(data.last.model_from_character, model_from_character);
  bool is_unchanged = same_frame;
  for (std::size_t slot = 0; is_unchanged && slot < data.slots; ++slot)
    is_unchanged =
        has_same_bits(data.last.model_from_bone[slot], pose.model_from_bone[skin.bones[slot]]);
  if (is_unchanged &&
      std::equal(pose.morph_weights.begin(), pose.morph_weights.end(), data.morph_weights.begin()))
    return {};

  const Affine3d character_from_model = inverse(model_from_character);
  for (std::size_t slot = 0; slot < data.slots; ++slot) {
    const Affine3d& model_from_bone = pose.model_from_bone[skin.bones[slot]];
    const Affine3d bone_from_bind = skin.bone_from_bind[slot].cast<double>();
    data.fresh[slot] =
        multiply(multiply(character_from_model, model_from_bone), bone_from_bind).cast<float>();
  }
  if (const Status status = skinning::check(data, pose.morph_weights); !status) return status;
  for (std::size_t slot = 0; slot < data.slots; ++slot)
    data.last.model_from_bone[slot] = pose.model_from_bone[skin.bones[slot]];
  data.last.model_from_character = model_from_character;
  data.last.skin = &skin;
  skinning::take(data, pose.morph_weights);
  return {};
}

Status BonePalette::set(std::span<const Affine3f> character_from_bind,
                        std::span<const float> morph_weights) {
  skinning::PaletteData& data = *data_;
  if (const Status status =
          skinning::check_sizes(data, character_from_bind.size(), morph_weights.size());
      !status)
    return status;
  std::copy(character_from_bind.begin(), character_from_bind.end(), data.fresh.begin());
  if (const Status status = skinning::check(data, morph_weights); !status) return status;
  data.last.skin = nullptr;
  skinning::take(data, morph_weights);
  return {};
}

SkinningMethod BonePalette::method() const { return data_->method; }
std::uint64_t BonePalette::revision() const { return data_->revision; }
std::uint64_t BonePalette::revision_of(std::size_t slot) const {
  SUNDER_ASSERT(slot < data_->slots);
  return data_->revisions[slot];
}

}  // namespace sunder
