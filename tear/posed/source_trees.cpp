#include "tear/posed/source_trees.h"

namespace sunder::tear {

const std::vector<std::shared_ptr<const PatchTree>>& SourceTrees::of_meshes() const {
  const std::lock_guard lock(building_);
  if (is_built_) return trees_;
  std::vector<std::shared_ptr<const PatchTree>> trees;
  for (const Mesh& mesh : source_.meshes)
    trees.push_back(mesh.triangles.empty()
                        ? nullptr
                        : std::make_shared<const PatchTree>(mesh, mesh.triangles, Index{0}));
  trees_ = std::move(trees);
  is_built_ = true;
  return trees_;
}

std::size_t SourceTrees::bytes() const {
  const std::lock_guard lock(building_);
  std::size_t bytes = 0;
  for (const auto& tree : trees_) bytes += tree == nullptr ? 0 : tree->bytes();
  return bytes;
}

}  // namespace sunder::tear
