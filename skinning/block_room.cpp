#include "skinning/block_room.h"

#include <algorithm>

#include "skinning/block_builder.h"
#include "skinning/source_influences.h"

namespace sunder::skinning {
namespace {

/// Numbers of influences among some vertices.
struct InfluenceCounts {
  std::size_t all = 0;
  std::size_t exact_vertices = 0, exact = 0;  ///< Of vertices with a position per influence.
};

InfluenceCounts count_influences(const VertexSource& source, std::uint32_t first,
                                 std::uint32_t end) {
  InfluenceCounts counts;
  for (std::uint32_t v = first; v < end; ++v) {
    for_each_influence(source, v, [&](std::uint32_t, float) { ++counts.all; });
  }
  if (source.per_influence == nullptr) return counts;
  const auto& exact = source.per_influence->vertices;
  for (auto v = std::lower_bound(exact.begin(), exact.end(), first); v != exact.end(); ++v) {
    ++counts.exact_vertices;
    counts.exact += source.weights->of(*v).size();
  }
  return counts;
}

/// An array that has to grow grows by an eighth at least.
template <class Values>
void make(std::size_t more, Values& values) {
  if (values.capacity() - values.size() < more)
    values.reserve(values.size() + std::max(more, values.size() / 8));
}

}  // namespace

void make_room(const VertexSource& source, std::uint32_t first, std::uint32_t end, Blocks& blocks) {
  const InfluenceCounts influences = count_influences(source, first, end);
  const VertexLayout& layout = blocks.layout;
  const std::size_t count = (end - first + kLanes - 1) / kLanes,
                    morphs = count * layout.morph_count,
                    displacement = layout.displacement_floats();
  make(count * kLanes * layout.attribute_floats() + most_weights(count, influences.all),
       blocks.stream);
  make(count, blocks.blocks);
  make(count, blocks.revisions);
  make(count, blocks.extras);
  make(influences.all, blocks.slots);
  make(influences.all, blocks.sparse.influences);
  make(count * kLanes, blocks.sparse.lane_ends);
  make(morphs, blocks.morphs.parts);
  make(morphs * kLanes * displacement, blocks.morphs.stream);
  make(influences.exact_vertices, blocks.exact.lanes);
  make(influences.exact, blocks.exact.influences);
  make(influences.exact * displacement * (1 + layout.morph_count), blocks.exact.stream);
  blocks.movers.make_room(influences.all + morphs);
}

}  // namespace sunder::skinning
