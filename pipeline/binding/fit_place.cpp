#include <sunder/binding/binding.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "core/internal/out_of_memory.h"
#include "pipeline/binding/bone_pairs.h"
#include "pipeline/binding/joined.h"

namespace sunder {
namespace {

Result<Affine3d> fit(const Character& model, const Character& rig, std::span<const BonePair> pairs,
                     const BindingPlace& place) {
  const Result<binding::Joined> joined =
      binding::join(model, rig, {place.rig_from_bone, Affine3d::Identity()});
  if (!joined) return joined.error();
  const Result<std::vector<Index>> paired = binding::rig_bones(model.skeleton, rig.skeleton, pairs);
  if (!paired) return paired.error();
  std::vector<Index> bones;
  for (Index i = 0; i < paired->size(); ++i)
    if ((*paired)[i] != kNone) bones.push_back(i);
  const auto count = static_cast<Eigen::Index>(bones.size());
  Eigen::Matrix3Xd of_model(3, count), of_rig(3, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const Index bone = bones[static_cast<std::size_t>(c)];
    of_model.col(c) = joined->rig_from_model_bone[bone].translation();
    of_rig.col(c) = joined->rig_from_bone[(*paired)[bone]].translation();
  }
  // Joints on a line leave the turn about it open.
  const auto second_axis = [](const Eigen::Matrix3Xd& joints) {
    if (joints.cols() < 3) return 0.0;
    const Vec3d middle = joints.rowwise().mean();
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (Eigen::Index c = 0; c < joints.cols(); ++c)
      spread += (joints.col(c) - middle) * (joints.col(c) - middle).transpose();
    const Eigen::Vector3d squares =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return squares[2] > 0 ? std::sqrt(std::max(squares[1], 0.0) / squares[2]) : 0.0;
  };
  if (second_axis(of_model) < 1e-3 || second_axis(of_rig) < 1e-3)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%zu paired joints do not fix a place: expected three or more, not on "
                           "a line",
                           bones.size());
  Affine3d fitted;
  fitted.matrix() = Eigen::umeyama(of_model, of_rig).topRows<3>();
  return fitted;
}

}  // namespace

Result<Affine3d> fit_place(const Character& model, const Character& rig,
                           std::span<const BonePair> pairs, const BindingPlace& place) {
  return or_out_of_memory([&] { return fit(model, rig, pairs, place); });
}

}  // namespace sunder
