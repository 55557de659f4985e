#include "tear/posed/patch_forest.h"

#include <algorithm>

namespace sunder::tear {
namespace {

/// Most walls and caps of a mesh that queries visit one by one.
constexpr Index kMostOneByOne = 512;

}  // namespace

void PatchForest::forget_pose() {
  if (++epoch_ != 0) return;
  for (Covered& covered : sources_) covered.boxes.forget_epochs();  // once in 2^32 poses
  for (auto& of_mesh : fillings_)
    for (Covered& covered : of_mesh) covered.boxes.forget_epochs();
  for (PosedBones& bones : bones_) bones.forget_epochs();
  epoch_ = 1;
}

void PatchForest::stand_in(const SurfaceEditor& editor, const CharacterPose& pose,
                           const Frame& frame, NewFillings fillings) {
  cover(editor, fillings);
  if (frame.axes != frame_.axes || frame.origin != frame_.origin) forget_pose();
  frame_ = frame;
  for (std::size_t skin = 0; skin < bones_.size(); ++skin)
    bones_[skin].stand_in(pose.palette(skin), frame, epoch_);
}

std::size_t PatchForest::tree_count() const {
  std::size_t count = sources_.size();
  for (const auto& of_mesh : fillings_) count += of_mesh.size();
  return count;
}

void PatchForest::cover(const SurfaceEditor& editor, NewFillings fillings) {
  const auto& meshes = editor.source().meshes;
  if (!is_built_) {
    if (shared_ == nullptr && own_ == nullptr)
      own_ = std::make_unique<SourceTrees>(editor.source());
    const auto& trees = (shared_ != nullptr ? *shared_ : *own_).of_meshes();
    sources_.clear();
    sources_.reserve(meshes.size());
    for (Index m = 0; m < meshes.size(); ++m)
      if (trees[m] != nullptr)
        sources_.push_back(
            {trees[m], PatchTree::PosedBoxes(*trees[m]), m, 0, meshes[m].triangle_count(), 0});
    fillings_.resize(meshes.size());
    bones_.resize(editor.source().skins.size());
    for (std::size_t skin = 0; skin < bones_.size(); ++skin)
      bones_[skin].resize(editor.source().skins[skin].bones.size());
    is_built_ = true;
  }
  for (Index m = 0; m < meshes.size(); ++m) cover_fillings(editor, m, fillings);

  // The search is depth-first: in addition to the other roots, the stack holds at most the siblings
  // of each node on the way down the current tree.
  std::size_t roots = sources_.size(), levels = 0;
  for (const Covered& covered : sources_)
    levels = std::max<std::size_t>(levels, covered.tree->level_count());
  for (const auto& of_mesh : fillings_) {
    roots += of_mesh.size();
    for (const Covered& covered : of_mesh)
      levels = std::max<std::size_t>(levels, covered.tree->level_count());
  }
  stack_.reserve(roots + std::max(PatchTree::kFanOut, PatchTree::kPatchesPerGroup) * (levels + 1));
}

void PatchForest::cover_fillings(const SurfaceEditor& editor, Index mesh, NewFillings fillings) {
  const std::vector<Triangle>& all = editor.fillings.of(mesh);
  std::vector<Covered>& trees = fillings_[mesh];
  const Index source_count = editor.source().meshes[mesh].triangle_count();
  const Index end = source_count + static_cast<Index>(all.size());
  // Fillings are added and removed last in, first out, and their serials ascend. A tree that has
  // lost most of its fillings is rebuilt.
  while (!trees.empty()) {
    Covered& last = trees.back();
    while (last.end > last.first &&
           (last.end > end || editor.fillings.serial(mesh, last.end - 1) >= last.serials_from))
      --last.end;
    if (2 * (last.end - last.first) > last.tree->triangle_count()) break;
    trees.pop_back();
  }
  Index first = trees.empty() ? source_count : trees.back().end;
  if (first == end) return;
  if (fillings == NewFillings::one_by_one && end - first <= kMostOneByOne) return;
  while (!trees.empty() && trees.back().end - trees.back().first < 2 * (end - first)) {
    first = trees.back().first;
    trees.pop_back();
  }
  const auto triangles = std::span(all).subspan(first - source_count);
  auto tree = std::make_shared<const PatchTree>(editor.character().meshes[mesh], triangles, first);
  PatchTree::PosedBoxes boxes(*tree);
  trees.push_back(
      {std::move(tree), std::move(boxes), mesh, first, end, editor.fillings.next_serial()});
}

void PatchForest::push(const Waiting& node, std::size_t first) {
  stack_.push_back(node);
  for (std::size_t i = stack_.size() - 1; i > first && stack_[i - 1].bound < stack_[i].bound; --i)
    std::swap(stack_[i - 1], stack_[i]);
}

std::vector<PatchForest::Covered*> PatchForest::trees(const SurfaceEditor& editor) {
  cover(editor);
  std::vector<Covered*> trees;
  for_each_tree([&](Covered& covered) { trees.push_back(&covered); });
  return trees;
}

std::size_t PatchForest::bytes() const {
  std::size_t bytes = 0;
  for (const Covered& covered : sources_) bytes += covered.boxes.bytes();
  for (const auto& of_mesh : fillings_)
    for (const Covered& covered : of_mesh) bytes += covered.tree->bytes() + covered.boxes.bytes();
  return bytes + (own_ != nullptr ? own_->bytes() : 0);
}

}  // namespace sunder::tear
