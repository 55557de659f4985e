#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <vector>

#include "io/fbx/scene.h"

namespace sunder::fbx {

/// A node's transform in its parent, as `translation * rotation * scale`.
struct Place {
  Vec3d translation = Vec3d::Zero();
  Quatd rotation = Quatd::Identity();
  Vec3d scale = Vec3d::Ones();
};

/// Keys of one model, between which translation and scale are linear and the rotation is a slerp.
struct Track {
  std::uint32_t model = kNone;
  std::vector<double> seconds;  ///< From the take's start, ascending.
  std::vector<Place> places;    ///< One per key.
};

/// The nodes of a scene as glTF can have them: all places without shear.
struct NodeTree {
  std::vector<std::uint32_t> parents;  ///< Per model; kNone for the scene's root.
  std::vector<Place> rest;             ///< Per model.
  std::uint32_t sheared = 0;           ///< Models whose shear no parent avoids; it is left out.
};

/// Chooses the parent of each node. It is the model's own parent, unless scales that are not
/// inherited as by a product of matrices leave shear between the two, in the rest pose or in a
/// take: then it is the nearest ancestor, or the root, without.
[[nodiscard]] NodeTree make_tree(const Scene& scene);

/// Samples a take: at its keys, and between them until interpolation is off by less than 1e-4 rad,
/// 1e-5 of the scene's size and 1e-5 of a scale.
///
/// @return one track per model that the take moves. Cost: O(keys × depth of the tree).
[[nodiscard]] std::vector<Track> make_tracks(const Scene& scene, const NodeTree& tree,
                                             const Take& take);

/// The span of a take in ticks: that of the file or, if it gives none, that of all keys.
struct TakeSpan {
  double start = 0.0, stop = 0.0;
};
[[nodiscard]] TakeSpan span_of(const Take& take);

}  // namespace sunder::fbx
