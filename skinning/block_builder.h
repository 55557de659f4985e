#pragma once

#include <sunder/skinning/vertex_arrays.h>

#include <vector>

#include "skinning/blocks.h"

namespace sunder::skinning {

/// Checks the vertices from `first` on. @return the failures that SkinnedMesh::create() documents.
[[nodiscard]] Status check_source(const VertexSource& source, std::size_t slot_count,
                                  std::uint32_t first);

/// The largest number of weights that blocks may store.
[[nodiscard]] std::size_t most_weights(std::size_t blocks, std::size_t influences);

/// Makes blocks of checked vertices and appends them.
class BlockBuilder {
 public:
  BlockBuilder(const VertexSource& source, Blocks& blocks);

  /// Appends vertices [first, end) in their own order.
  void append_in_order(std::uint32_t first, std::uint32_t end);
  /// Appends vertices [first, end), gathered by their bones if that makes less work.
  void append_gathered(std::uint32_t first, std::uint32_t end);

 private:
  void gather_by_slots(std::uint32_t first);
  void append_block(const std::uint32_t* vertices, std::uint32_t count, std::uint32_t window);
  void find_slots(const std::uint32_t* vertices, std::uint32_t count);
  void append_attributes(const std::uint32_t* vertices, std::uint32_t count);
  void append_weights(const std::uint32_t* vertices, std::uint32_t count, Block& block,
                      BlockExtra& extra);
  void append_morphs(const std::uint32_t* vertices, std::uint32_t count, Block& block,
                     BlockExtra& extra);
  void append_exact(const std::uint32_t* vertices, std::uint32_t count, Block& block,
                    BlockExtra& extra);
  [[nodiscard]] double work(const std::vector<std::uint32_t>& order, bool scattered);

  const VertexSource& source_;
  Blocks& blocks_;
  SlotSet& slots_;                     // of the current block
  std::uint32_t influence_count_ = 0;  // of the current block
  std::vector<std::uint32_t> order_, gathered_;
  std::vector<std::uint32_t>
      exact_first_;  // per vertex of source_.per_influence: where its positions begin
};

}  // namespace sunder::skinning
