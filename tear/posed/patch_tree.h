#pragma once

#include <sunder/core/mesh.h>

#include <array>
#include <span>
#include <vector>

#include "tear/geometry/box.h"
#include "tear/posed/posed_bones.h"

namespace sunder::tear {

/// What a mesh is posed by.
struct MeshPose {
  PosedBones& bones;                     ///< Of the mesh's skin.
  std::span<const float> morph_weights;  ///< Of the mesh's targets.
};

/// Triangles of one mesh in patches that lie together in bind space, some patches in a group, and
/// above the groups a tree of nodes. Each knows where a pose may put what its triangles hold: not
/// only their corners but every point between them, stored as rounded as it may be.
///
/// A posed point is the sum of w_i M_i v. Where bone i moves it, v lies in B_i, the bind-space box
/// of those triangles of the node that bone i moves a corner of. So the point lies in the hull of
/// the boxes M_i B_i, and the nearer the range of each weight is known the nearer it lies to a
/// certain mean of them. The first is loose where a far bone has a tiny weight, the second where
/// the weights differ much; a node's bound is what both leave.
class PatchTree {
 public:
  static constexpr Index kPatchSize = 8;        ///< Triangles a patch, but for the last one.
  static constexpr Index kPatchesPerGroup = 4;  ///< Which share the ranges of weights.
  static constexpr Index kFanOut = 4;           ///< Nodes a node, above.
  static constexpr Index kGroupSize = kPatchSize * kPatchesPerGroup;

  /// @param triangles     of the mesh's vertices; not empty.
  /// @param first_origin  number of triangle 0; the others follow.
  PatchTree(const Mesh& mesh, std::span<const Triangle> triangles, Index first_origin);

  /// Level 0 are the groups, the last level is the root. The children of node n are the nodes from
  /// kFanOut n on of the level below.
  [[nodiscard]] Index level_count() const { return static_cast<Index>(first_of_level_.size()) - 1; }
  [[nodiscard]] Index node_count(Index level) const {
    return first_of_level_[level + 1] - first_of_level_[level];
  }
  [[nodiscard]] Index triangle_count() const { return static_cast<Index>(origins_.size()); }
  /// The patches of group g are those from kPatchesPerGroup g on.
  [[nodiscard]] Index patch_count() const { return static_cast<Index>(patches_.size()); }
  /// The triangles of a patch, by their numbers as origins.
  [[nodiscard]] std::span<const Index> origins(Index patch) const {
    return part_of(origins_, patch, kPatchSize);
  }

  /// Where the pose may put a node, in the frame of the pose's bones. Computed once in an epoch.
  [[nodiscard]] Box posed_box(Index level, Index number, const MeshPose& pose,
                              std::uint32_t epoch) {
    const Index node = first_of_level_[level] + number;
    if (posed_since_[node] != epoch) {
      posed_[node] = compute_posed_box(node, pose);
      posed_since_[node] = epoch;
    }
    const auto corner = [](const std::array<float, 4>& of) -> Vec3d {
      return {static_cast<double>(of[0]), static_cast<double>(of[1]), static_cast<double>(of[2])};
    };
    return {corner(posed_[node].low), corner(posed_[node].high)};
  }
  /// The same of the patches of a group. @return how many there are.
  Index compute_posed_patches(Index group, const MeshPose& pose,
                              std::array<Box, kPatchesPerGroup>& boxes) const;
  Index compute_posed_patches(Index group, const MeshPose& pose,
                              std::array<Shadow, kPatchesPerGroup>& shadows) const;
  /// Makes epoch numbers free to be used again; 0 is never one.
  void forget_epochs() { posed_since_.assign(posed_since_.size(), 0); }

  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Corners in lanes of four, which are read at once; the last lane is 0.
  struct FloatBox {
    std::array<float, 4> low{}, high{};
  };

  struct Node {
    FloatBox bind;     ///< Of all corners.
    Index first_bone;  ///< In bones_; up to that of the next node. The one that moves the node most
                       ///< comes first.
  };
  /// A box within a node's: how far from its sides, in parts of kBoxParts of its size.
  struct InnerBox {
    std::array<std::uint8_t, 4> low, high;  ///< The fourth is 0.
  };
  /// A bone that moves something of a node.
  struct NodeBone {
    std::uint16_t slot;
    std::uint16_t least_weight,
        greatest_weight;  ///< Over the node's corners, in parts of kWeightParts.
    InnerBox box;         ///< Of what it moves.
  };
  /// What a morph target that moves something of a node displaces it by.
  struct NodeMorph {
    Index target;
    FloatBox displacement;
  };
  class Builder;
  class Bound;

  [[nodiscard]] FloatBox compute_posed_box(Index node, const MeshPose& pose) const;
  static std::span<const Index> part_of(std::span<const Index> numbers, std::size_t part,
                                        std::size_t size) {
    return numbers.subspan(size * part, std::min(size, numbers.size() - size * part));
  }
  [[nodiscard]] std::span<const NodeBone> bones_of(Index node) const {
    return std::span(bones_).subspan(nodes_[node].first_bone,
                                     nodes_[node + 1].first_bone - nodes_[node].first_bone);
  }

  std::vector<Index> origins_;         ///< Patch after patch.
  std::vector<InnerBox> patches_;      ///< Within their groups.
  std::vector<Index> first_of_level_;  ///< In nodes_.
  std::vector<Node> nodes_;            ///< And one that ends the last one's bones.
  std::vector<NodeBone> bones_;
  std::vector<NodeMorph> morphs_;
  std::vector<Index>
      first_morph_;         ///< Of each node in morphs_, and the end; empty where there are none.
  float weight_slack_ = 0;  ///< What a vertex' weights may add up to besides 1.
  bool is_bounded_ = true;
  std::vector<FloatBox> posed_;
  std::vector<std::uint32_t> posed_since_;
};

}  // namespace sunder::tear
