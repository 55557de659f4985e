#pragma once

#include <sunder/core/character.h>

#include <memory>
#include <vector>

#include "core/internal/threads.h"
#include "tear/posed/patch_tree.h"

namespace sunder::tear {

/// The trees of patches over the meshes of a source. They are built at the first use. Several
/// threads may use them at the same time.
class SourceTrees {
 public:
  /// @param source  kept by reference.
  explicit SourceTrees(const Character& source) : source_(source) {}

  /// One per mesh; null for a mesh without triangles. @throws std::bad_alloc: none are built
  [[nodiscard]] const std::vector<std::shared_ptr<const PatchTree>>& of_meshes() const;
  /// 0 before they are built.
  [[nodiscard]] std::size_t bytes() const;

 private:
  const Character& source_;
  mutable Mutex building_;
  mutable std::vector<std::shared_ptr<const PatchTree>> trees_;
  mutable bool is_built_ = false;
};

}  // namespace sunder::tear
