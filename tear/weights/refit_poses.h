#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/weight_options.h>
#include <sunder/skinning/pose.h>

#include <memory>
#include <vector>

namespace sunder::tear {

/// The poses of a refit in groups over which a point is judged: the rest pose, each clip by itself,
/// the range of motion, poses with all joints turned at random, the given poses. Besides those over
/// which errors are reduced these are all clips and the range of motion, because no fit may be
/// worse there either.
class RefitPoses {
 public:
  struct Group {
    /// How much its errors count; 0: the group is only a bound. All together are 1, unless no group
    /// that was asked for has a pose.
    double importance = 0;
    std::vector<std::size_t> poses;  ///< Numbers for compute().
  };

  /// Checks what create() would refuse. @return the failures of PoseSet::check(); not_found for the
  /// importance of a clip that does not exist; invalid_argument for one that is negative or not
  /// finite, or if nothing counts.
  [[nodiscard]] static Status check(const Character& character, const RefitOptions& options);
  /// @param moves_points  per bone: whether it moves any of the points. Range-of-motion poses in
  ///         which these bones keep their places relative to each other are left out: all points
  ///         are as exact there as at rest.
  [[nodiscard]] static Result<RefitPoses> create(std::shared_ptr<const Character> character,
                                                 const RefitOptions& options,
                                                 const std::vector<bool>& moves_points);

  /// The rest pose is the first group.
  [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
  /// How much a pose counts in its group; the mean is 1.
  [[nodiscard]] double weight_of(std::size_t pose) const;
  /// Computes a pose. @return limit_exceeded: out of memory.
  Status compute(std::size_t pose, ModelPose& result) const;

 private:
  RefitPoses(std::shared_ptr<const Character> character, PoseSet set);
  void add_groups(const RefitOptions& options, const std::vector<bool>& moves_points);
  void add_random_poses(const RefitOptions& options, const std::vector<bool>& bends);
  [[nodiscard]] std::vector<bool> bending_bones(const std::vector<bool>& moves_points) const;

  std::shared_ptr<const Character> character_;
  PoseSet set_;
  std::vector<Pose> random_;  ///< Numbered after those of the set; the rest pose is the first.
  std::vector<Group> groups_;
};

}  // namespace sunder::tear
