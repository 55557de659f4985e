#pragma once

#include <sunder/core/mesh.h>

#include <array>
#include <span>
#include <vector>

#include "tear/geometry/box.h"
#include "tear/posed/plane_distances.h"
#include "tear/posed/posed_bones.h"

namespace sunder::tear {

/// The pose of a mesh.
struct MeshPose {
  PosedBones& bones;                     ///< Of the skin of the mesh.
  std::span<const float> morph_weights;  ///< Of the morph targets of the mesh.
};

/// Triangles of one mesh in patches that are compact in bind space, several patches per group, and
/// a tree of nodes above the groups. Each node bounds where a pose may put its triangles: all their
/// points, including the rounding of stored vertices.
///
/// A posed point is sum w_i M_i v. If bone i moves it, v lies in B_i, the bind-space box of those
/// triangles of the node that have a corner moved by bone i. So the point lies in the hull of the
/// boxes M_i B_i, and, given the range of each weight over the node, near a certain weighted mean
/// of them. The first bound is loose if a distant bone has a tiny weight, the second if the weights
/// vary much; the bound of a node is their intersection.
class PatchTree {
  /// Triangles per patch, except for the last one.
 public:
  static constexpr Index kPatchSize = 8;
  static constexpr Index kPatchesPerGroup = 4;  ///< They share the ranges of weights.
  static constexpr Index kFanOut = 4;           ///< Children per node above the groups.
  static constexpr Index kGroupSize = kPatchSize * kPatchesPerGroup;

  /// @param triangles     of the mesh's vertices; not empty.
  /// @param first_origin  index of the first triangle among the source triangles and fillings of
  ///         the mesh; the others follow.
  PatchTree(const Mesh& mesh, std::span<const Triangle> triangles, Index first_origin);

  /// Level 0 consists of the groups, the last level of the root. The children of node n are the
  /// nodes from kFanOut n on of the level below.
  [[nodiscard]] Index level_count() const { return static_cast<Index>(first_of_level_.size()) - 1; }
  [[nodiscard]] Index node_count(Index level) const {
    return first_of_level_[level + 1] - first_of_level_[level];
  }
  [[nodiscard]] Index triangle_count() const { return static_cast<Index>(origins_.size()); }
  /// The patches of group g are those from kPatchesPerGroup g on.
  [[nodiscard]] Index patch_count() const { return static_cast<Index>(patches_.size()); }
  /// The triangles of a patch.
  [[nodiscard]] std::span<const Index> origins(Index patch) const {
    return part_of(origins_, patch, kPatchSize);
  }

  class PosedBoxes;
  /// The bound of a posed node, in the frame of the pose's bones. Cached per epoch.
  [[nodiscard]] inline FrameBox posed_box(Index level, Index number, const MeshPose& pose,
                                          std::uint32_t epoch, PosedBoxes& cache) const;
  /// The same for the patches of a group. @return their number.
  Index compute_posed_patches(Index group, const MeshPose& pose,
                              std::array<FrameBox, kPatchesPerGroup>& boxes) const;
  Index compute_posed_patches(Index group, const MeshPose& pose,
                              std::array<Shadow, kPatchesPerGroup>& shadows) const;

  /// The side of a plane on which all vertices of a node lie that are not on the plane, whatever
  /// rounding does, as PlaneDistances::side_of(); kAcross if it is not known.
  [[nodiscard]] std::uint8_t side_of(Index level, Index number,
                                     const PlaneDistances& distances) const;
  /// One bit per patch of a group: whether its side is not known.
  [[nodiscard]] std::uint32_t patches_across(Index group, const PlaneDistances& distances) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  /// Corners in four lanes, which are loaded at once; the last lane is 0.
  struct FloatBox {
    std::array<float, 4> low{}, high{};
  };

  static constexpr float kBoxParts = 255;
  static constexpr float kWeightParts = 65000;  // less than 2^16: weights may slightly exceed 1
  /// If more bones move a node, ranges of weights do not improve on the hull.
  static constexpr std::size_t kFewBones = 12;

  struct Node {
    FloatBox bind;  ///< Of all corners.
    /// In bones_; the bones end at those of the next node. The bone with most weight comes first.
    Index first_bone;
  };
  /// A box inside the box of a node, as distances from its sides in units of 1/kBoxParts of its
  /// size.
  struct InnerBox {
    std::array<std::uint8_t, 4> low, high;  ///< The fourth is 0.
  };
  /// A bone that moves a corner of a node.
  struct NodeBone {
    std::uint16_t slot;
    /// Over the corners of the node, in units of 1/kWeightParts.
    std::uint16_t least_weight, greatest_weight;
    InnerBox box;  ///< Of the triangles that it moves.
  };
  /// The bounds of the displacements of a morph target in a node.
  struct NodeMorph {
    Index target;
    FloatBox displacement;
  };
  class Builder;
  class Bound;
  struct ComparedNode;

  [[nodiscard]] FloatBox compute_posed_box(Index node, const MeshPose& pose) const;
  static std::span<const Index> part_of(std::span<const Index> numbers, std::size_t part,
                                        std::size_t size) {
    return numbers.subspan(size * part, std::min(size, numbers.size() - size * part));
  }
  [[nodiscard]] std::span<const NodeBone> bones_of(Index node) const {
    return std::span(bones_).subspan(nodes_[node].first_bone,
                                     nodes_[node + 1].first_bone - nodes_[node].first_bone);
  }

  std::vector<Index> origins_;         ///< Patch by patch.
  std::vector<InnerBox> patches_;      ///< Within the boxes of their groups.
  std::vector<Index> first_of_level_;  ///< In nodes_.
  std::vector<Node> nodes_;            ///< And a last one, which ends the bones of the one before.
  std::vector<NodeBone> bones_;
  std::vector<NodeMorph> morphs_;
  std::vector<Index> first_morph_;  ///< Per node in morphs_, and the end; empty if there are none.
  float weight_slack_ = 0;          ///< Maximum deviation from 1 of the sum of a vertex's weights.
  bool is_bounded_ = true;
};

/// The bounds of the nodes of a tree in one pose. The tree itself is immutable, so that models
/// share it; each has its own boxes.
class PatchTree::PosedBoxes {
 public:
  explicit PosedBoxes(const PatchTree& tree)
      : boxes_(tree.nodes_.size() - 1), since_(tree.nodes_.size() - 1, 0) {}

  /// Invalidates all boxes, so that epoch numbers can be reused; 0 is never used.
  void forget_epochs() { since_.assign(since_.size(), 0); }
  [[nodiscard]] std::size_t bytes() const {
    return boxes_.capacity() * sizeof(FloatBox) + since_.capacity() * sizeof(std::uint32_t);
  }

 private:
  friend class PatchTree;

  std::vector<FloatBox> boxes_;
  std::vector<std::uint32_t> since_;
};

inline FrameBox PatchTree::posed_box(Index level, Index number, const MeshPose& pose,
                                     std::uint32_t epoch, PosedBoxes& cache) const {
  const Index node = first_of_level_[level] + number;
  if (cache.since_[node] != epoch) {
    cache.boxes_[node] = compute_posed_box(node, pose);
    cache.since_[node] = epoch;
  }
  const auto corner = [](const std::array<float, 4>& of) -> Vec3d {
    return {static_cast<double>(of[0]), static_cast<double>(of[1]), static_cast<double>(of[2])};
  };
  return {corner(cache.boxes_[node].low), corner(cache.boxes_[node].high)};
}

}  // namespace sunder::tear
