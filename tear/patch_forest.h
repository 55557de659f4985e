#pragma once

#include <limits>

#include "tear/patch_tree.h"
#include "tear/surface_editor.h"

namespace sunder::tear {

/// What the meshes of a character are posed by.
struct CharacterPose {
  std::span<const std::vector<Affine3d>> palettes;  ///< Of each skin.
  std::span<const float> morph_weights;

  [[nodiscard]] MeshPose of(const Mesh& mesh) const {
    return {palettes[mesh.skin], morph_weights.subspan(mesh.first_morph_weight, mesh.morph_targets.size())};
  }
};

/// Finds faces of the posed surface without posing it: trees of patches over the origins of all meshes. A tear changes none of
/// them, since the parts of an origin lie within it. Built at the first query; walls and caps get trees of their own at the first
/// query after them, and neighbouring trees of one size are made one, so that a mesh has few (Bentley and Saxe 1980).
class PatchForest {
 public:
  /// To be called when the pose changes. O(1).
  void forget_pose();

  /// Visits the patches in which something may be found, more or less the nearest first.
  /// @param bound  bound(const Box&): the least value, such as a distance, that what is looked for can have in a box; infinity
  /// where
  ///               it cannot be there.
  /// @param visit  visit(mesh, origins of a patch): the greatest value that is of interest from now on. May not call this again.
  template <class Bound, class Visit>
  void visit_patches(const SurfaceEditor& editor, const CharacterPose& pose, Bound bound, Visit visit);

  [[nodiscard]] std::size_t bytes() const;
  /// Trees over the walls and caps of a mesh.
  [[nodiscard]] std::size_t filling_tree_count(Index mesh) const { return mesh < fillings_.size() ? fillings_[mesh].size() : 0; }

  /// A tree, and what it covers.
  struct Covered {
    PatchTree tree;
    Index mesh;
    Index first, end;           ///< Origins.
    std::uint64_t last_serial;  ///< Of the last one, where they are fillings.
  };
  /// Every tree there is, up to date.
  [[nodiscard]] std::vector<Covered*> trees(const SurfaceEditor& editor);

 private:
  struct Waiting {
    double bound;
    Covered* covered;
    Index level, number;
  };

  void cover(const SurfaceEditor& editor);
  void cover_fillings(const SurfaceEditor& editor, Index mesh);
  /// Puts a node before those on the stack that are farther, down to `first`.
  void push(const Waiting& node, std::size_t first);

  std::vector<Covered> sources_;                ///< Of each mesh that has triangles.
  std::vector<std::vector<Covered>> fillings_;  ///< Of each mesh, in their order.
  std::vector<Waiting> stack_;                  ///< The nearest last.
  std::uint32_t epoch_ = 1;
  bool is_built_ = false;
};

template <class Bound, class Visit>
void PatchForest::visit_patches(const SurfaceEditor& editor, const CharacterPose& pose, Bound bound, Visit visit) {
  cover(editor);
  const auto& meshes = editor.character().meshes;
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  double limit = std::numeric_limits<double>::max();
  const auto add = [&](Covered& covered, Index level, Index number, std::size_t first) {
    const double nearest = bound(covered.tree.posed_box(level, number, pose.of(meshes[covered.mesh]), epoch_));
    if (nearest < kNowhere && !(nearest > limit)) push({nearest, &covered, level, number}, first);
  };
  stack_.clear();
  for (Covered& covered : sources_) add(covered, covered.tree.level_count() - 1, 0, 0);
  for (auto& of_mesh : fillings_)
    for (Covered& covered : of_mesh) add(covered, covered.tree.level_count() - 1, 0, 0);
  while (!stack_.empty()) {
    const Waiting node = stack_.back();
    stack_.pop_back();
    if (node.bound > limit) continue;
    const PatchTree& tree = node.covered->tree;
    if (node.level == 0) {
      limit = visit(node.covered->mesh, tree.origins(node.number));
      continue;
    }
    const std::size_t first = stack_.size();
    const Index end = std::min(PatchTree::kFanOut * (node.number + 1), tree.node_count(node.level - 1));
    for (Index child = PatchTree::kFanOut * node.number; child < end; ++child) add(*node.covered, node.level - 1, child, first);
  }
}

}  // namespace sunder::tear
