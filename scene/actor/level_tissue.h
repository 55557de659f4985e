#pragma once

#include <sunder/scene/character_instance.h>

#include <vector>

namespace sunder::scene {

/// The motion of an instance's tissue, from which the tissue of another level of detail starts.
struct LevelTissue {
  std::vector<Vec3d> places;  ///< Of particles, by the pose alone.
  std::vector<PointMotion> motions;

  /// Empty without a soft body. O(particles x bones). @throws std::bad_alloc
  [[nodiscard]] static LevelTissue of(const CharacterInstance& instance, const ModelPose& pose);
  /// Each particle of the other instance moves like those at its place. Without memory the tissue
  /// stays at rest.
  void give_to(CharacterInstance& instance, const ModelPose& pose) const;

 private:
  [[nodiscard]] PointMotion at(const Vec3d& place) const;
};

}  // namespace sunder::scene
