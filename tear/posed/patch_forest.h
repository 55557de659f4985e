#pragma once

#include <limits>
#include <type_traits>

#include "skinning/internal/character_pose.h"
#include "tear/posed/patch_tree.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// Finds faces of the posed surface without posing it: trees of patches over the origins of all
/// meshes. A tear changes none of them, since the parts of an origin lie within it. Built at the
/// first query; walls and caps get trees of their own at the first query after them, and
/// neighbouring trees of one size are made one, so that a mesh has few (Bentley and Saxe 1980).
class PatchForest {
 public:
  /// To be called when the pose changes. O(1).
  void forget_pose();

  /// Visits the live faces of the patches in which something may be found, more or less the nearest
  /// first.
  /// @param frame  that boxes are in: the nearer its axes are to how the query lies, the fewer it
  /// meets. Boxes are remembered as
  ///               long as neither the pose nor the frame changes.
  /// @param bound  bound(const Box&): the least value, such as a distance, that what is looked for
  /// can have in a box; infinity where
  ///               it cannot be there. What looks along the first axis may offer bound(const Box&,
  ///               const Shadow&) too: of something that lies both in the box and in the shadow.
  /// @param expect expect(mesh, origins): some faces of these will be visited next.
  /// @param visit  visit(face): the greatest value that is of interest from now on. May not call
  /// this again.
  template <class Bound, class Expect, class Visit>
  void visit_faces(const SurfaceEditor& editor, const CharacterPose& pose, const Frame& frame,
                   Bound bound, Expect expect, Visit visit);

  [[nodiscard]] std::size_t bytes() const;
  /// Trees over the walls and caps of a mesh.
  [[nodiscard]] std::size_t filling_tree_count(Index mesh) const {
    return mesh < fillings_.size() ? fillings_[mesh].size() : 0;
  }

  /// A tree, and what it covers.
  struct Covered {
    PatchTree tree;
    Index mesh;
    Index first, end;  ///< Origins. Those of the tree from `end` up have been taken back since.
    std::uint64_t
        serials_from;  ///< Fillings that were made after the tree have serials from here on.
  };
  /// Every tree there is, up to date.
  [[nodiscard]] std::vector<Covered*> trees(const SurfaceEditor& editor);

  /// Makes a pose and a frame those that boxes are about.
  void stand_in(const SurfaceEditor& editor, const CharacterPose& pose, const Frame& frame);
  [[nodiscard]] MeshPose pose_of(const Mesh& mesh, const CharacterPose& pose) {
    return {bones_[mesh.skin],
            pose.morph_weights().subspan(mesh.first_morph_weight, mesh.morph_targets.size())};
  }
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }

 private:
  struct Waiting {
    double bound;
    Covered* covered;
    Index height;  ///< 0: a patch; above, the node's level and 1.
    Index number;
  };

  [[nodiscard]] std::size_t tree_count() const;
  void cover(const SurfaceEditor& editor);
  void cover_fillings(const SurfaceEditor& editor, Index mesh);
  /// Puts a node before those on the stack that are farther, down to `first`.
  void push(const Waiting& node, std::size_t first);

  std::vector<Covered> sources_;                ///< Of each mesh that has triangles.
  std::vector<std::vector<Covered>> fillings_;  ///< Of each mesh, in their order.
  std::vector<PosedBones> bones_;               ///< Of each skin.
  std::vector<Waiting> stack_;                  ///< The nearest last.
  Frame frame_;
  std::uint32_t epoch_ = 1;
  bool is_built_ = false;
};

template <class Bound, class Expect, class Visit>
void PatchForest::visit_faces(const SurfaceEditor& editor, const CharacterPose& pose,
                              const Frame& frame, Bound bound, Expect expect, Visit visit) {
  stand_in(editor, pose, frame);
  const auto& meshes = editor.character().meshes;
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  double limit = std::numeric_limits<double>::max();
  const auto add = [&](double least, Waiting node, std::size_t first) {
    node.bound = least;
    if (node.bound < kNowhere && !(node.bound > limit)) push(node, first);
  };
  stack_.clear();
  const bool is_one_tree = tree_count() == 1;  // whose box holds everything: not worth knowing
  const auto add_root = [&](Covered& covered) {
    const Index level = covered.tree.level_count() - 1;
    if (is_one_tree)
      push({std::numeric_limits<double>::lowest(), &covered, level + 1, 0}, 0);
    else
      add(bound(covered.tree.posed_box(level, 0, pose_of(meshes[covered.mesh], pose), epoch_)),
          {0, &covered, level + 1, 0}, 0);
  };
  for (Covered& covered : sources_) add_root(covered);
  for (auto& of_mesh : fillings_)
    for (Covered& covered : of_mesh) add_root(covered);
  std::array<Box, PatchTree::kPatchesPerGroup> boxes;
  [[maybe_unused]] std::array<Shadow, PatchTree::kPatchesPerGroup> shadows;
  while (!stack_.empty()) {
    const Waiting node = stack_.back();
    stack_.pop_back();
    if (node.bound > limit) continue;
    Covered& covered = *node.covered;
    if (node.height == 0) {
      const std::span<const Index> origins = covered.tree.origins(node.number);
      expect(covered.mesh, origins);
      for (const Index origin : origins)
        if (origin < covered.end)
          editor.for_each_part(covered.mesh, origin, [&](Index face) { limit = visit(face); });
      continue;
    }
    const MeshPose mesh_pose = pose_of(meshes[covered.mesh], pose);
    const std::size_t first = stack_.size();
    if (node.height == 1) {
      if constexpr (std::is_invocable_v<Bound&, const Box&, const Shadow&>) {
        const Box box = covered.tree.posed_box(0, node.number, mesh_pose, epoch_);
        const Index count = covered.tree.compute_posed_patches(node.number, mesh_pose, shadows);
        for (Index i = 0; i < count; ++i)
          add(bound(box, shadows[i]),
              {0, &covered, 0, PatchTree::kPatchesPerGroup * node.number + i}, first);
        continue;
      }
      const Index count = covered.tree.compute_posed_patches(node.number, mesh_pose, boxes);
      for (Index i = 0; i < count; ++i)
        add(bound(boxes[i]), {0, &covered, 0, PatchTree::kPatchesPerGroup * node.number + i},
            first);
      continue;
    }
    const Index level = node.height - 2;  // of the children
    const Index end =
        std::min(PatchTree::kFanOut * (node.number + 1), covered.tree.node_count(level));
    for (Index child = PatchTree::kFanOut * node.number; child < end; ++child)
      add(bound(covered.tree.posed_box(level, child, mesh_pose, epoch_)),
          {0, &covered, node.height - 1, child}, first);
  }
}

}  // namespace sunder::tear
