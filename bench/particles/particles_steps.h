#pragma once

#include <cstdint>

namespace sunder::bench {

/// A soft body on the bent bunny, at 60 steps per second; every bone moves between poses. Medians,
/// seconds.
struct StepFigures {
  std::uint32_t vertices = 0, particles = 0;
  double neighbours = 0;  ///< Mean per particle.
  double step = 0;        ///< Every particle awake, pushed at random now and then.
  /// Time added by displacing all vertices: moved_vertices(), and SkinnedMesh::deform() minus a
  /// plain one.
  double displace = 0;
  double frame = 0;          ///< Both.
  double plain_deform = 0;   ///< Positions and normals without displacements.
  double asleep = 0;         ///< A step in the same pose.
  double asleep_moving = 0;  ///< A step in another pose.
};

///
/// @param divisions  of the bunny, see tear_scene.h.
/// @param particles  requested number; the range is chosen accordingly.
/// @param frames     number of timed frames.
[[nodiscard]] StepFigures measure_steps(int divisions, std::uint32_t particles, int frames);

}  // namespace sunder::bench
