#pragma once

#include <cstdint>

namespace sunder::bench {

/// A soft body on the bunny in a bend, 60 steps a second, in poses in each of which every bone moved. Medians, seconds.
struct StepFigures {
  std::uint32_t vertices = 0, particles = 0;
  double neighbours = 0;     ///< Of a particle, on average.
  double step = 0;           ///< Every particle awake, pushed at random now and then.
  double displace = 0;       ///< What displacing all vertices adds: moved_vertices(), and SkinnedMesh::deform() less a plain one.
  double frame = 0;          ///< Both.
  double plain_deform = 0;   ///< Positions and normals without displacements.
  double asleep = 0;         ///< A step, the pose as before.
  double asleep_moving = 0;  ///< A step, the pose another.
};

/// @param divisions  of the bunny, see tear_scene.h.
/// @param particles  wanted: the range is chosen for about so many.
/// @param frames     that are timed.
[[nodiscard]] StepFigures measure_steps(int divisions, std::uint32_t particles, int frames);

}  // namespace sunder::bench
