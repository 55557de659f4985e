#pragma once

#include <sunder/core/mesh.h>

#include <array>
#include <span>
#include <vector>

#include "tear/box.h"

namespace sunder::tear {

using Index = std::uint32_t;

/// What a mesh is posed by.
struct MeshPose {
  std::span<const Affine3d> palette;     ///< Of the mesh's skin.
  std::span<const float> morph_weights;  ///< Of the mesh's targets.
};

/// Triangles of one mesh in patches that lie together in bind space, and above the patches a tree of nodes. Each node knows where a
/// pose may put what its triangles hold: not only their corners but every point between them, stored as rounded as it may be.
///
/// A posed point is a mean of M_i v, weighted by its weights, so it lies in the hull of the boxes M_i B_i, B_i the bind-space box
/// of the node's triangles that bone i moves a corner of. It is also M_r v + sum of w_i (M_i - M_r) v for any bone r, so with the
/// range of each bone's weight it lies in a sum of intervals. The first is loose where a far bone has a tiny weight, the second
/// where the weights differ much; a node's bound is what both leave.
class PatchTree {
 public:
  static constexpr Index kPatchSize = 32;  ///< Triangles a patch, but for the last one.
  static constexpr Index kFanOut = 4;

  /// @param triangles     of the mesh's vertices; not empty.
  /// @param first_origin  number of triangle 0; the others follow.
  PatchTree(const Mesh& mesh, std::span<const Triangle> triangles, Index first_origin);

  /// Level 0 are the patches, the last level is the root. The children of node n are the nodes from kFanOut n on of the level
  /// below.
  [[nodiscard]] Index level_count() const { return static_cast<Index>(first_of_level_.size()) - 1; }
  [[nodiscard]] Index node_count(Index level) const { return first_of_level_[level + 1] - first_of_level_[level]; }
  /// The triangles of a patch, by their numbers as origins.
  [[nodiscard]] std::span<const Index> origins(Index patch) const {
    return std::span(origins_).subspan(kPatchSize * std::size_t{patch},
                                       std::min<std::size_t>(kPatchSize, origins_.size() - kPatchSize * std::size_t{patch}));
  }

  /// Where the pose may put a node. Computed once in an epoch.
  [[nodiscard]] const Box& posed_box(Index level, Index number, const MeshPose& pose, std::uint32_t epoch) {
    const Index node = first_of_level_[level] + number;
    if (posed_since_[node] != epoch) {
      posed_[node] = compute_posed_box(node, pose);
      posed_since_[node] = epoch;
    }
    return posed_[node];
  }
  /// Makes epoch numbers free to be used again; 0 is never one.
  void forget_epochs() { posed_since_.assign(posed_since_.size(), 0); }

  [[nodiscard]] std::size_t bytes() const;

 private:
  using FloatBox = std::array<std::array<float, 3>, 2>;  ///< Low, high.

  struct Node {
    FloatBox bind;     ///< Of all corners.
    Index first_bone;  ///< In bones_; up to that of the next node. The one that moves the node most comes first.
  };
  /// A bone that moves something of a node.
  struct NodeBone {
    std::uint16_t slot;
    std::uint16_t least_weight, greatest_weight;  ///< Over the node's corners, in parts of kWeightParts.
    std::array<std::uint8_t, 3> low, high;        ///< Its box: how far within the node's, in parts of kBoxParts of that.
  };
  /// What a morph target that moves something of a node displaces it by.
  struct NodeMorph {
    Index target;
    FloatBox displacement;
  };
  class Builder;

  [[nodiscard]] Box compute_posed_box(Index node, const MeshPose& pose) const;
  [[nodiscard]] std::span<const NodeBone> bones_of(Index node) const {
    return std::span(bones_).subspan(nodes_[node].first_bone, nodes_[node + 1].first_bone - nodes_[node].first_bone);
  }

  std::vector<Index> origins_;         ///< Patch after patch.
  std::vector<Index> first_of_level_;  ///< In nodes_.
  std::vector<Node> nodes_;            ///< And one that ends the last one's bones.
  std::vector<NodeBone> bones_;
  std::vector<NodeMorph> morphs_;
  std::vector<Index> first_morph_;  ///< Of each node in morphs_, and the end; empty where there are none.
  double weight_slack_ = 0;         ///< What a vertex' weights may add up to besides 1.
  bool is_bounded_ = true;
  std::vector<Box> posed_;
  std::vector<std::uint32_t> posed_since_;
};

}  // namespace sunder::tear
