#pragma once

#include <sunder/core/character.h>

#include <string>
#include <vector>

namespace sunder::bench {

/// The kinds of frames of a 20-second loop.
enum class LoopFrame { untorn, stroke, gape, still, cut, drill, undo, redo };

/// Seconds of the stages of a frame.
struct LoopTimes {
  LoopFrame kind = LoopFrame::untorn;
  double operate = 0;  ///< The call of TornModel.
  double follow = 0;   ///< ParticleSet::follow().
  double settle = 0;
  double step = 0;  ///< SoftBody::step() without settle().
  double moved = 0;
  double gradients = 0;
  double update = 0;  ///< SkinnedMesh::update().
  double deform = 0;

  [[nodiscard]] double after_tear() const { return follow + settle + moved + gradients + update; }
  [[nodiscard]] double frame() const { return operate + step + after_tear() + deform; }
};

struct LoopFigures {
  std::string name;
  std::size_t vertices = 0, points = 0, particles = 0, bones = 0;
  std::vector<LoopTimes> frames;
};

/// Plays one soft character for 20 seconds at 90 frames per second, every particle pushed in turns:
/// untorn, then again and again a stroke of half a second, a gape, a capped cut of a limb, a bore
/// with a wall, undos and redos.
/// @param divisions  of each triangle's edges.
[[nodiscard]] LoopFigures play_loop(int divisions);

[[nodiscard]] const char* name_of(LoopFrame kind);

}  // namespace sunder::bench
