#include "skinning/clip_motion.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/internal/elementary.h"
#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"

namespace sunder::skinning {
namespace {

/// The path between two poses to fit, radians. Skinning errors of a joint vary with the sine of its
/// angle, so between poses this far apart they are known within some percent.
constexpr double kStep = 15.0 * std::numbers::pi / 180.0;
/// A bone that is shifted by the size of the skeleton, or scaled by e, counts like one that is
/// turned by this angle, radians.
constexpr double kTurnPerSize = 5.0, kTurnPerScale = 2.0;
/// A shorter path is rounding.
constexpr double kNoMotion = 1e-4;
/// The path is measured along chords between this many frames.
constexpr double kFramesPerSecond = 30.0;
constexpr int kFewestFrames = 32, kMostFrames = 256;
/// Times of a clip that moves at all: gentle motion to and fro needs them too.
constexpr double kFewest = 16;
/// All clips together give at most this many times, unless each gives only kFewestOfMany.
constexpr double kMostTimes = 768;
constexpr double kFewestOfMany = 2;

/// The length of the bones of a skeleton along its longest chain at rest.
double size_of(const Skeleton& skeleton) {
  std::vector<double> reach(skeleton.bones.size(), 0.0);
  double size = 0;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    const Bone& bone = skeleton.bones[i];
    if (bone.parent == kNone) continue;  // where a root stands has nothing to do with its size
    reach[i] = reach[bone.parent] + norm(bone.rest.translation.cast<double>());
    size = std::max(size, reach[i]);
  }
  return size;
}

/// How far a bone moved, in radians.
double distance(const BoneTransform& a, const BoneTransform& b, double size) {
  // From the chord between the quaternions, because the cosine of a small angle has no digits left.
  const Eigen::Vector4d from = a.rotation.coeffs().cast<double>(),
                        to = b.rotation.coeffs().cast<double>();
  const double chord = std::min(norm(from - to), norm(from + to));
  const double shift = norm((a.translation - b.translation).cast<double>());
  double scale = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double ratio = static_cast<double>(a.scale[axis]) / static_cast<double>(b.scale[axis]);
    scale =
        std::max(scale, ratio > 0 && std::isfinite(ratio) ? std::abs(elementary::log(ratio)) : 1.0);
  }
  if (a.scale == b.scale) scale = 0;  // zeros too
  return 4 * elementary::asin(std::min(0.5 * chord, 1.0)) +
         (size > 0 ? kTurnPerSize * shift / size : 0.0) + kTurnPerScale * scale;
}

/// The lengths of a clip's path at equally spaced frames, from its beginning. Roots do not count:
/// what they do to a character as a whole changes no shape.
class ClipPath {
 public:
  ClipPath(const Character& character, const Clip& clip, double size)
      : duration_(static_cast<double>(clip.duration)) {
    const int frames = std::clamp(static_cast<int>(std::min(duration_, 1e6) * kFramesPerSecond),
                                  kFewestFrames, kMostFrames);
    Pose before = or_throw(local_rest_pose(character)), now = before;
    or_throw(sample_clip(clip, 0, before));
    lengths_.push_back(0);
    for (int frame = 1; frame <= frames; ++frame) {
      or_throw(sample_clip(clip, duration_ * frame / frames, now));
      double most = 0;
      for (std::size_t bone = 0; bone < now.parent_from_bone.size(); ++bone)
        if (character.skeleton.bones[bone].parent != kNone)
          most = std::max(
              most, distance(before.parent_from_bone[bone], now.parent_from_bone[bone], size));
      lengths_.push_back(lengths_.back() + most);
      std::swap(before, now);
    }
  }

  [[nodiscard]] double length() const { return lengths_.back(); }
  /// The time at which a share of the path is covered.
  [[nodiscard]] double time_at(double share) const {
    const double wanted = share * length();
    std::size_t frame = 1;
    while (frame + 1 < lengths_.size() && lengths_[frame] < wanted) ++frame;
    const double step = lengths_[frame] - lengths_[frame - 1];
    const double part = step > 0 ? (wanted - lengths_[frame - 1]) / step : 0.0;
    return duration_ * (static_cast<double>(frame - 1) + part) /
           static_cast<double>(lengths_.size() - 1);
  }

 private:
  double duration_;
  std::vector<double> lengths_;
};

}  // namespace

std::vector<ClipTimes> times_of_clips(const Character& character, std::uint32_t most) {
  const double size = size_of(character.skeleton);
  std::vector<ClipPath> paths;
  std::vector<double> counts;
  double sum = 0;
  for (const Clip& clip : character.clips) {
    const double length = paths.emplace_back(character, clip, size).length();
    const double count = std::max(std::ceil(length / kStep), kFewest);
    counts.push_back(length > kNoMotion ? std::min<double>(count, most) : 1.0);
    sum += counts.back();
  }
  std::vector<ClipTimes> times(paths.size());
  for (std::size_t clip = 0; clip < paths.size(); ++clip) {
    if (!(paths[clip].length() > kNoMotion)) {
      times[clip].fit = {0.0};
      times[clip].durations = {1.0};
      continue;
    }
    double count = counts[clip];
    if (sum > kMostTimes)
      count = std::max(std::floor(count * kMostTimes / sum), std::min(count, kFewestOfMany));
    for (double i = 0; i < count; ++i) {
      times[clip].fit.push_back(paths[clip].time_at((i + 0.5) / count));
      times[clip].held_out.push_back(paths[clip].time_at(i / count));
      times[clip].durations.push_back(
          count * (paths[clip].time_at((i + 1) / count) - paths[clip].time_at(i / count)) /
          static_cast<double>(character.clips[clip].duration));
    }
  }
  return times;
}

}  // namespace sunder::skinning
