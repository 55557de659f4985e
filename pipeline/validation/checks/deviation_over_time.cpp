#include "pipeline/validation/checks/deviation_over_time.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::validation {
namespace {

constexpr double kTimesPerSecond = 30.0;

/// From 0 to the end of a clip.
std::vector<double> times_of(const Clip& clip, std::uint32_t most_times) {
  const auto duration = static_cast<double>(clip.duration);
  const double wanted = 1.0 + std::ceil(duration * kTimesPerSecond);
  const auto count =
      static_cast<std::uint32_t>(std::clamp(wanted, 2.0, static_cast<double>(most_times)));
  std::vector<double> times;
  for (std::uint32_t i = 0; i < count; ++i) times.push_back(duration * i / (count - 1));
  return times;
}

/// The difference of a row in a pose.
Vec3d posed(std::span<const SkinTerm> terms, const std::vector<Affine3d>& model_from_bind) {
  Vec3d sum = Vec3d::Zero();
  for (const SkinTerm& term : terms) {
    const Affine3d& bone = model_from_bind[term.bone];
    sum += multiply(bone.linear(), term.x) + term.m * Eigen::Vector3d(bone.translation());
  }
  return sum;
}

/// Adds the largest and the root mean square length of the rows in a pose.
void measure(const SkinDifferences& differences, const std::vector<std::uint32_t>& moved,
             const std::vector<Affine3d>& model_from_bind, std::size_t compared,
             ClipDeviation& deviation) {
  double maximum = 0.0, square = 0.0;
  for (const std::uint32_t row : moved) {
    const double of_row = squared_norm(posed(terms_of(differences, row), model_from_bind));
    maximum = std::max(maximum, of_row);
    square += of_row;
  }
  deviation.maximum.push_back(std::sqrt(maximum));
  deviation.rms.push_back(compared == 0 ? 0.0 : std::sqrt(square / static_cast<double>(compared)));
}

}  // namespace

std::vector<ClipDeviation> deviation_over_time(const Character& source, const ModelPose& bind,
                                               const SkinDifferences& differences,
                                               std::size_t compared, std::uint32_t most_times) {
  std::vector<Affine3d> bone_from_model;
  for (const Affine3d& model_from_bone : bind.model_from_bone)
    bone_from_model.push_back(model_from_bone.inverse(Eigen::Affine));
  std::vector<std::uint32_t> moved;
  for (std::uint32_t row = 0; row + 1 < differences.first.size(); ++row)
    if (!terms_of(differences, row).empty()) moved.push_back(row);
  std::vector<ClipDeviation> deviations;
  std::vector<Affine3d> model_from_bind(bone_from_model.size());
  ModelPose model_pose;
  for (std::uint32_t clip = 0; clip < source.clips.size(); ++clip) {
    if (!(source.clips[clip].duration > 0.0f)) continue;
    Pose pose = or_throw(local_rest_pose(source));
    ClipDeviation& deviation = deviations.emplace_back();
    deviation.clip = clip;
    deviation.times = times_of(source.clips[clip], most_times);
    for (const double time : deviation.times) {
      or_throw(sample_clip(source.clips[clip], time, pose));
      or_throw(compute_model_pose(source.skeleton, pose, model_pose));
      for (std::size_t bone = 0; bone < model_from_bind.size(); ++bone)
        model_from_bind[bone] = multiply(model_pose.model_from_bone[bone], bone_from_model[bone]);
      measure(differences, moved, model_from_bind, compared, deviation);
    }
  }
  return deviations;
}

}  // namespace sunder::validation
