#pragma once

#include <limits>
#include <memory>
#include <type_traits>

#include "skinning/internal/character_pose.h"
#include "tear/posed/patch_tree.h"
#include "tear/posed/source_trees.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// How a query looks at walls and caps that are not in trees yet: it puts them there, or visits
/// them all if they are few, as pays if the query is not followed by others.
enum class NewFillings : std::uint8_t { in_trees, one_by_one };

/// Finds faces of the posed surface without posing all of it, by trees of patches over the source
/// triangles of all meshes. A tear changes no tree, because the parts of a source triangle lie
/// within it, so that models share the trees of their source. Walls and caps get trees of their own
/// at the first query after them; adjacent trees of similar size are merged, so that a mesh has few
/// (Bentley and Saxe 1980).
class PatchForest {
 public:
  /// Uses these trees, which it does not keep, instead of trees of its own. To be called before
  /// the first query.
  void share(const SourceTrees& trees) { shared_ = &trees; }

  /// Call it when the pose changes. O(1).
  void forget_pose();

  /// Visits the live faces of the patches in which something may be found, roughly the nearest
  /// first. Boxes are cached until the pose or the frame changes.
  /// @param frame   axes of the boxes; fewer boxes are met if the axes are aligned with the query.
  /// @param bound   bound(const FrameBox&): a lower bound, over the box, of what is minimised,
  ///         such as a distance; infinity if nothing can be found there. A query along the first
  ///         axis may also accept (const FrameBox&, const Shadow&), for objects inside both.
  /// @param expect  expect(mesh, origins): faces of these source triangles will be visited next.
  /// @param visit   visit(face): returns the greatest value still of interest. It must not call
  ///         this function.
  template <class Bound, class Expect, class Visit>
  void visit_faces(const SurfaceEditor& editor, const CharacterPose& pose, const Frame& frame,
                   Bound bound, Expect expect, Visit visit,
                   NewFillings fillings = NewFillings::in_trees);

  /// Calls visit(tree, group, end) for the groups of patches of a mesh that may_hold(tree, level,
  /// number of a node) accepts, with all nodes above them, in no particular order. Origins from
  /// `end` on were undone.
  template <class MayHold, class Visit>
  void for_each_group(const SurfaceEditor& editor, Index mesh, MayHold may_hold, Visit visit);

  [[nodiscard]] std::size_t bytes() const;
  /// The number of trees over the walls and caps of a mesh.
  [[nodiscard]] std::size_t filling_tree_count(Index mesh) const {
    return mesh < fillings_.size() ? fillings_[mesh].size() : 0;
  }

  /// A tree and the triangles that it covers.
  struct Covered {
    std::shared_ptr<const PatchTree> tree;
    PatchTree::PosedBoxes boxes;
    Index mesh;
    Index first, end;  ///< Source triangles. Those of the tree from `end` on were undone since.
    std::uint64_t serials_from;  ///< Fillings made after the tree have serials from here on.
  };
  /// All trees, up to date.
  [[nodiscard]] std::vector<Covered*> trees(const SurfaceEditor& editor);

  /// Sets the pose and the frame of the boxes.
  void stand_in(const SurfaceEditor& editor, const CharacterPose& pose, const Frame& frame,
                NewFillings fillings = NewFillings::in_trees);
  [[nodiscard]] MeshPose pose_of(const Mesh& mesh, const CharacterPose& pose) {
    return {bones_[mesh.skin],
            pose.morph_weights().subspan(mesh.first_morph_weight, mesh.morph_targets.size())};
  }
  [[nodiscard]] std::uint32_t epoch() const { return epoch_; }

 private:
  struct Waiting {
    double bound;
    Covered* covered;
    Index height;  ///< 0: a patch; otherwise the level of the node plus 1.
    Index number;
  };

  /// Memory for the bounds of the patches of a group.
  struct GroupBounds {
    std::array<FrameBox, PatchTree::kPatchesPerGroup> boxes;
    std::array<Shadow, PatchTree::kPatchesPerGroup> shadows;
  };

  [[nodiscard]] std::size_t tree_count() const;
  template <class Visit>
  void for_each_tree(Visit visit) {
    for (Covered& covered : sources_) visit(covered);
    for (auto& of_mesh : fillings_)
      for (Covered& covered : of_mesh) visit(covered);
  }
  /// Calls visit(face) for the faces of a patch.
  template <class Visit>
  static void for_each_face(const SurfaceEditor& editor, const Covered& covered, Index patch,
                            Visit visit);
  /// Calls visit(bound, patch) for the patches of a group.
  template <class Bound, class Visit>
  void for_each_patch(Covered& covered, Index group, const MeshPose& pose, Bound& bound,
                      GroupBounds& patches, Visit visit) const {
    const PatchTree& tree = *covered.tree;
    const Index first = PatchTree::kPatchesPerGroup * group;
    if constexpr (std::is_invocable_v<Bound&, const FrameBox&, const Shadow&>) {
      const FrameBox box = tree.posed_box(0, group, pose, epoch_, covered.boxes);
      const Index count = tree.compute_posed_patches(group, pose, patches.shadows);
      for (Index i = 0; i < count; ++i) visit(bound(box, patches.shadows[i]), first + i);
    } else {
      const Index count = tree.compute_posed_patches(group, pose, patches.boxes);
      for (Index i = 0; i < count; ++i) visit(bound(patches.boxes[i]), first + i);
    }
  }
  void cover(const SurfaceEditor& editor, NewFillings fillings = NewFillings::in_trees);
  void cover_fillings(const SurfaceEditor& editor, Index mesh, NewFillings fillings);
  /// Calls visit(face) for the walls and caps that are in no tree.
  template <class Visit>
  void for_each_new_filling(const SurfaceEditor& editor, Visit visit) const;
  /// Puts a node on the stack, before the nodes down to `first` that are farther away.
  void push(const Waiting& node, std::size_t first);

  std::vector<Covered> sources_;                ///< One per mesh with triangles.
  std::vector<std::vector<Covered>> fillings_;  ///< Per mesh, in order.
  std::vector<PosedBones> bones_;               ///< One per skin.
  std::vector<Waiting> stack_;                  ///< The nearest node last.
  Frame frame_;
  const SourceTrees* shared_ = nullptr;
  std::unique_ptr<SourceTrees> own_;  ///< Used if none are shared.
  std::uint32_t epoch_ = 1;
  bool is_built_ = false;
};

template <class Visit>
void PatchForest::for_each_face(const SurfaceEditor& editor, const Covered& covered, Index patch,
                                Visit visit) {
  for (const Index origin : covered.tree->origins(patch))
    if (origin < covered.end) editor.origins.for_each_part(covered.mesh, origin, visit);
}

template <class Visit>
void PatchForest::for_each_new_filling(const SurfaceEditor& editor, Visit visit) const {
  for (Index mesh = 0; mesh < fillings_.size(); ++mesh) {
    const Index source_count = editor.source().meshes[mesh].triangle_count(),
                end = source_count + static_cast<Index>(editor.fillings.of(mesh).size());
    Index origin = fillings_[mesh].empty() ? source_count : fillings_[mesh].back().end;
    for (; origin < end; ++origin) editor.origins.for_each_part(mesh, origin, visit);
  }
}

template <class Bound, class Expect, class Visit>
void PatchForest::visit_faces(const SurfaceEditor& editor, const CharacterPose& pose,
                              const Frame& frame, Bound bound, Expect expect, Visit visit,
                              NewFillings fillings) {
  stand_in(editor, pose, frame, fillings);
  const auto& meshes = editor.character().meshes;
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  double limit = std::numeric_limits<double>::max();
  const auto add = [&](double least, Waiting node, std::size_t first) {
    node.bound = least;
    if (node.bound < kNowhere && !(node.bound > limit)) push(node, first);
  };
  if (fillings == NewFillings::one_by_one)
    for_each_new_filling(editor, [&](Index face) { limit = visit(face); });
  stack_.clear();
  const bool is_one_tree = tree_count() == 1;  // its box would exclude nothing
  for_each_tree([&](Covered& covered) {
    const Index level = covered.tree->level_count() - 1;
    if (is_one_tree)
      push({std::numeric_limits<double>::lowest(), &covered, level + 1, 0}, 0);
    else
      add(bound(covered.tree->posed_box(level, 0, pose_of(meshes[covered.mesh], pose), epoch_,
                                        covered.boxes)),
          {0, &covered, level + 1, 0}, 0);
  });
  GroupBounds patches;
  while (!stack_.empty()) {
    const Waiting node = stack_.back();
    stack_.pop_back();
    if (node.bound > limit) continue;
    Covered& covered = *node.covered;
    if (node.height == 0) {
      expect(covered.mesh, covered.tree->origins(node.number));
      for_each_face(editor, covered, node.number, [&](Index face) { limit = visit(face); });
      continue;
    }
    const MeshPose mesh_pose = pose_of(meshes[covered.mesh], pose);
    const std::size_t first = stack_.size();
    if (node.height == 1) {
      for_each_patch(covered, node.number, mesh_pose, bound, patches,
                     [&](double least, Index patch) {
                       add(least, {0, &covered, 0, patch}, first);
                     });
      continue;
    }
    const Index level = node.height - 2;  // of the children
    const Index end =
        std::min(PatchTree::kFanOut * (node.number + 1), covered.tree->node_count(level));
    for (Index child = PatchTree::kFanOut * node.number; child < end; ++child)
      add(bound(covered.tree->posed_box(level, child, mesh_pose, epoch_, covered.boxes)),
          {0, &covered, node.height - 1, child}, first);
  }
}

template <class MayHold, class Visit>
void PatchForest::for_each_group(const SurfaceEditor& editor, Index mesh, MayHold may_hold,
                                 Visit visit) {
  cover(editor);
  for_each_tree([&](Covered& covered) {
    if (covered.mesh != mesh) return;
    const PatchTree& tree = *covered.tree;
    stack_.clear();
    stack_.push_back({0, &covered, tree.level_count(), 0});
    while (!stack_.empty()) {
      const Index level = stack_.back().height - 1, number = stack_.back().number;
      stack_.pop_back();
      if (!may_hold(tree, level, number)) continue;
      if (level == 0) {
        visit(tree, number, covered.end);
        continue;
      }
      const Index end = std::min(PatchTree::kFanOut * (number + 1), tree.node_count(level - 1));
      for (Index child = PatchTree::kFanOut * number; child < end; ++child)
        stack_.push_back({0, &covered, level, child});
    }
  });
}

}  // namespace sunder::tear
