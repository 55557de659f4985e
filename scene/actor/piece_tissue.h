#pragma once

#include <sunder/scene/scene_command.h>

namespace sunder::scene {

/// The motion of tissue at the points of a piece, which the particles have not followed yet.
/// @param particles  of the body. O(points of the piece + particles). @throws std::bad_alloc
[[nodiscard]] PieceTissue tissue_of(const DetachedPiece& piece, const ParticleSet& particles,
                                    const SoftBody& body);

/// That motion at the points of a soft instance of the piece. @throws std::bad_alloc
[[nodiscard]] std::vector<PointMotion> motions_of(const DetachedPiece& piece,
                                                  const PieceTissue& tissue,
                                                  const Character& character,
                                                  const ParticleSet& particles);

}  // namespace sunder::scene
