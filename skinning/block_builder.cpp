#include "skinning/block_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <type_traits>

#include "skinning/source_influences.h"

namespace sunder::skinning {
namespace {

// Measured cycles per slot, per block and per scattered block; only their ratios matter.
constexpr double kSlotWork = 6, kBlockWork = 20, kScatterWork = 40;
/// Influences are stored per vertex if storing weights per slot would take more than this many
/// numbers per influence.
constexpr std::uint32_t kSparseFrom = 8;

Status check_strides(const VertexSource& source) {
  const auto is_odd = [](std::size_t stride, std::size_t packed, std::size_t unit) {
    return stride != 0 && (stride < packed || stride % unit != 0);
  };
  const InfluenceArrays& arrays = source.influences;
  const std::size_t weight_size = arrays.weights != nullptr ? sizeof(float) : sizeof(std::uint16_t);
  const bool is_bad = is_odd(source.positions.stride, 12, 4) ||
                      is_odd(source.normals.stride, 12, 4) ||
                      is_odd(source.tangents.stride, 16, 4) ||
                      is_odd(arrays.slot_stride, 2 * arrays.per_vertex, 2) ||
                      is_odd(arrays.weight_stride, weight_size * arrays.per_vertex, weight_size);
  if (!is_bad) return {};
  return Status::failure(
      StatusCode::invalid_argument, kNone,
      "a stride is shorter than the numbers of a vertex, or not a multiple of their size");
}

Status check_sizes(const VertexSource& source) {
  if (source.positions.data == nullptr && source.vertex_count > 0)
    return Status::failure(StatusCode::empty_input, kNone,
                           "the source has %u vertices, but no positions", source.vertex_count);
  if (source.weights != nullptr) {
    if (source.weights->vertex_count() != source.vertex_count)
      return Status::failure(StatusCode::size_mismatch, kNone,
                             "there are weights for %u vertices, but positions for %u",
                             source.weights->vertex_count(), source.vertex_count);
  } else if (source.vertex_count > 0) {
    const InfluenceArrays& arrays = source.influences;
    if (arrays.per_vertex == 0 || arrays.slots == nullptr ||
        (arrays.weights == nullptr) == (arrays.weights16 == nullptr))
      return Status::failure(StatusCode::empty_input, kNone,
                             "influences need slots, and weights as floats or 16-bit integers");
  }
  for (std::size_t i = 0; i < source.morph_targets.size(); ++i)
    for (const auto* deltas :
         {&source.morph_targets[i].position_deltas, &source.morph_targets[i].normal_deltas,
          &source.morph_targets[i].tangent_deltas})
      if (!deltas->empty() && deltas->size() != source.vertex_count)
        return Status::failure(StatusCode::size_mismatch, static_cast<std::uint32_t>(i),
                               "morph target %zu: displacements of %zu vertices, the mesh has %u",
                               i, deltas->size(), source.vertex_count);
  return {};
}

Status check_per_influence(const VertexSource& source) {
  const InfluencePositions& exact = *source.per_influence;
  if (source.weights == nullptr)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "positions per influence need weights given as SkinWeights");
  std::size_t influences = 0;
  for (std::size_t i = 0; i < exact.vertices.size(); ++i) {
    const std::uint32_t vertex = exact.vertices[i];
    if (vertex >= source.vertex_count || (i > 0 && exact.vertices[i - 1] >= vertex))
      return Status::failure(
          StatusCode::index_out_of_range, static_cast<std::uint32_t>(i),
          "positions per influence: vertex %u is not in ascending order or not below %u", vertex,
          source.vertex_count);
    influences += source.weights->of(vertex).size();
  }
  const auto fits = [&](const std::vector<Vec3f>& values, bool wanted) {
    return values.size() == influences || (values.empty() && !wanted);
  };
  bool all_fit =
      fits(exact.positions, true) && fits(exact.normals, source.normals.data != nullptr) &&
      fits(exact.tangents, source.tangents.data != nullptr) &&
      (exact.morph_targets.empty() || exact.morph_targets.size() == source.morph_targets.size());
  for (const InfluencePositions::Deltas& target : exact.morph_targets)
    all_fit = all_fit && fits(target.positions, false) && fits(target.normals, false) &&
              fits(target.tangents, false);
  if (!all_fit)
    return Status::failure(
        StatusCode::size_mismatch, kNone,
        "positions per influence: an array does not have %zu entries, one per influence",
        influences);
  return {};
}

Status check_vertex(const VertexSource& source, std::size_t slot_count, std::uint32_t vertex) {
  const auto is_finite = [vertex](const StridedFloats<const float>& array, std::size_t components) {
    if (array.data == nullptr) return true;
    const float* values = at(array, vertex, components);
    return std::all_of(values, values + components,
                       [](float value) { return std::isfinite(value); });
  };
  if (!is_finite(source.positions, 3) || !is_finite(source.normals, 3) ||
      !is_finite(source.tangents, 4))
    return Status::failure(StatusCode::non_finite_value, vertex,
                           "vertex %u: an attribute is not finite", vertex);
  std::uint32_t beyond = kNone;
  bool is_weight = true;
  double sum = 0;
  for_each_influence(source, vertex, [&](std::uint32_t slot, float weight) {
    if (slot >= slot_count) beyond = slot;
    is_weight = is_weight && weight >= 0.0f;  // false for NaN
    sum += static_cast<double>(weight);
  });
  if (beyond != kNone)
    return Status::failure(StatusCode::index_out_of_range, vertex,
                           "vertex %u: slot %u does not exist; the skin has %zu slots", vertex,
                           beyond, slot_count);
  if (!is_weight || !(std::abs(sum - 1) <= 0.01))
    return Status::failure(StatusCode::weights_not_normalized, vertex,
                           "vertex %u: weights are negative or sum to %g", vertex, sum);
  return {};
}

bool is_zero(const Vec3f& value) { return value == Vec3f::Zero(); }

/// The slots of a vertex as one number, so that most pairs of vertices are compared at once.
struct FirstSlots {
  std::uint64_t slots = 0;  ///< Up to four numbers of 16 bits, 0 beyond the last slot.
  std::uint32_t vertex = 0;
  bool are_all = true;
};

/// @param slots  ascending.
FirstSlots first_slots(std::span<const std::uint32_t> slots, std::uint32_t vertex) {
  constexpr std::size_t kMost = 4, kBits = 16;
  constexpr std::uint32_t kLarge = (1u << kBits) - 1;
  FirstSlots of{0, vertex, slots.size() <= kMost};
  for (std::size_t i = 0; i < std::min(kMost, slots.size()); ++i) {
    const bool is_large = slots[i] >= kLarge - 1;
    const std::uint64_t number = is_large ? kLarge : slots[i] + 1;
    of.slots |= number << (kBits * (kMost - 1 - i));
    if (!is_large) continue;
    of.are_all = false;  // nor does what follows count
    break;
  }
  return of;
}

}  // namespace

Status check_source(const VertexSource& source, std::size_t slot_count, std::uint32_t first) {
  if (slot_count > 65536)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "the skin has %zu slots; the maximum is 65536", slot_count);
  if (const Status status = check_sizes(source); !status) return status;
  if (const Status status = check_strides(source); !status) return status;
  if (source.per_influence != nullptr)
    if (const Status status = check_per_influence(source); !status) return status;
  for (std::uint32_t v = first; v < source.vertex_count; ++v)
    if (const Status status = check_vertex(source, slot_count, v); !status) return status;
  for (std::size_t i = 0; i < source.morph_targets.size(); ++i)
    for (const auto* deltas :
         {&source.morph_targets[i].position_deltas, &source.morph_targets[i].normal_deltas,
          &source.morph_targets[i].tangent_deltas})
      for (std::size_t v = first; v < deltas->size(); ++v)
        if (!(*deltas)[v].allFinite())
          return Status::failure(StatusCode::non_finite_value, static_cast<std::uint32_t>(v),
                                 "morph target %zu: vertex %zu: a displacement is not finite", i,
                                 v);
  return {};
}

std::size_t most_weights(std::size_t blocks, std::size_t influences) {
  return kSparseFrom * (blocks * kLanes + influences);
}

BlockBuilder::BlockBuilder(const VertexSource& source, Blocks& blocks)
    : source_(source), blocks_(blocks), slots_(blocks.scratch) {
  if (source.per_influence == nullptr) return;
  std::uint32_t first = 0;
  for (const std::uint32_t vertex : source.per_influence->vertices) {
    exact_first_.push_back(first);
    first += static_cast<std::uint32_t>(source.weights->of(vertex).size());
  }
}

void BlockBuilder::append_in_order(std::uint32_t first, std::uint32_t end) {
  std::uint32_t vertices[kLanes];
  for (std::uint32_t v = first; v < end; v += kLanes) {
    const std::uint32_t count = std::min(kLanes, end - v);
    std::iota(vertices, vertices + count, v);
    append_block(vertices, count, v);
  }
}

/// Sets gathered_ to the vertices from `first` on, sorted by their slots, then by the vertex.
void BlockBuilder::gather_by_slots(std::uint32_t first) {
  std::vector<std::uint32_t> keys, key_first;
  keys.reserve(4 * order_.size());
  key_first.reserve(order_.size() + 1);
  std::vector<FirstSlots> vertices;
  vertices.reserve(order_.size());
  for (const std::uint32_t v : order_) {
    key_first.push_back(static_cast<std::uint32_t>(keys.size()));
    for_each_influence(source_, v, [&](std::uint32_t slot, float) { keys.push_back(slot); });
    const auto begin = keys.begin() + key_first.back();
    std::sort(begin, keys.end());
    vertices.push_back(first_slots(std::span<const std::uint32_t>(begin, keys.end()), v));
  }
  key_first.push_back(static_cast<std::uint32_t>(keys.size()));
  const auto slots_of = [&](std::uint32_t v) {
    return std::span<const std::uint32_t>(keys.data() + key_first[v - first],
                                          keys.data() + key_first[v - first + 1]);
  };
  std::sort(vertices.begin(), vertices.end(), [&](const FirstSlots& a, const FirstSlots& b) {
    if (a.slots != b.slots) return a.slots < b.slots;
    if (a.are_all && b.are_all) return a.vertex < b.vertex;
    const auto of_a = slots_of(a.vertex), of_b = slots_of(b.vertex);
    const auto order =
        std::lexicographical_compare_three_way(of_a.begin(), of_a.end(), of_b.begin(), of_b.end());
    return order != 0 ? order < 0 : a.vertex < b.vertex;
  });
  gathered_.clear();
  for (const FirstSlots& of : vertices) gathered_.push_back(of.vertex);
}

void BlockBuilder::append_gathered(std::uint32_t first, std::uint32_t end) {
  order_.resize(end - first);
  std::iota(order_.begin(), order_.end(), first);
  gather_by_slots(first);
  if (work(order_, false) <= work(gathered_, true)) {
    append_in_order(first, end);
    return;
  }
  for (std::uint32_t i = 0; i < gathered_.size(); i += kLanes) {
    const std::uint32_t count = std::min(kLanes, static_cast<std::uint32_t>(gathered_.size()) - i);
    std::sort(gathered_.begin() + i, gathered_.begin() + i + count);  // so that writes ascend
    append_block(gathered_.data() + i, count, first);
  }
  // Includes a last block whose vertices happen to be consecutive.
  blocks_.scattered.end = blocks_.block_count();
}

double BlockBuilder::work(const std::vector<std::uint32_t>& order, bool scattered) {
  double sum = 0;
  for (std::uint32_t i = 0; i < order.size(); i += kLanes) {
    find_slots(order.data() + i, std::min(kLanes, static_cast<std::uint32_t>(order.size()) - i));
    sum += kBlockWork + kSlotWork * static_cast<double>(slots_.slots().size()) +
           (scattered ? kScatterWork : 0);
  }
  return sum;
}

void BlockBuilder::find_slots(const std::uint32_t* vertices, std::uint32_t count) {
  slots_.clear();
  influence_count_ = 0;
  for (std::uint32_t lane = 0; lane < count; ++lane)
    for_each_influence(source_, vertices[lane], [&](std::uint32_t slot, float) {
      slots_.insert(slot);
      ++influence_count_;
    });
  slots_.finish();
}

void BlockBuilder::append_block(const std::uint32_t* vertices, std::uint32_t count,
                                std::uint32_t window) {
  Block block;
  BlockExtra extra;
  const std::uint32_t number = blocks_.block_count();
  block.first_vertex = vertices[0];
  block.lane_count = static_cast<std::uint8_t>(count);
  block.numbers = blocks_.stream.size();
  extra.last_vertex = vertices[count - 1];
  extra.window = window;
  extra.places = static_cast<std::uint32_t>(blocks_.scattered.places.size());
  extra.influences = static_cast<std::uint32_t>(blocks_.sparse.influences.size());
  extra.lane_ends = static_cast<std::uint32_t>(blocks_.sparse.lane_ends.size());
  extra.morphs = static_cast<std::uint32_t>(blocks_.morphs.parts.size());
  extra.exact_lanes = static_cast<std::uint32_t>(blocks_.exact.lanes.size());
  if (extra.last_vertex - block.first_vertex != count - 1 || window != block.first_vertex) {
    block.kind |= kScattered;
    blocks_.scattered.end = number + 1;
    blocks_.scattered.places.insert(blocks_.scattered.places.end(), vertices, vertices + count);
    blocks_.scattered.places.resize(extra.places + kLanes);
  }

  find_slots(vertices, count);
  const Block* before = number > 0 ? &blocks_.blocks.back() : nullptr;
  const std::span<const std::uint16_t> slots = slots_.slots();
  if (before != nullptr && before->slot_count == slots.size() &&
      std::equal(slots.begin(), slots.end(), blocks_.slots.begin() + before->slots)) {
    block.slots = before->slots;
  } else {
    block.slots = static_cast<std::uint32_t>(blocks_.slots.size());
    blocks_.slots.insert(blocks_.slots.end(), slots.begin(), slots.end());
  }
  block.slot_count = static_cast<std::uint16_t>(slots.size());
  for (const std::uint16_t slot : slots) blocks_.movers.append(slot, number);

  append_attributes(vertices, count);
  append_weights(vertices, count, block, extra);
  append_morphs(vertices, count, block, extra);
  append_exact(vertices, count, block, extra);
  if (block.kind != 0) {
    block.extra = static_cast<std::uint32_t>(blocks_.extras.size());
    blocks_.extras.push_back(extra);
  }
  blocks_.blocks.push_back(block);
  blocks_.revisions.push_back(blocks_.revision);
}

void BlockBuilder::append_attributes(const std::uint32_t* vertices, std::uint32_t count) {
  AlignedVector<float>& stream = blocks_.stream;
  const auto append = [&](const StridedFloats<const float>& array, std::size_t components) {
    const std::size_t first = stream.size();
    stream.resize(first + components * kLanes);
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      const float* values = at(array, vertices[lane], components);
      for (std::size_t c = 0; c < components; ++c) stream[first + kLanes * c + lane] = values[c];
    }
  };
  append(source_.positions, 3);
  if (blocks_.layout.has_normals) append(source_.normals, 3);
  if (blocks_.layout.has_tangents) append(source_.tangents, 4);
}

void BlockBuilder::append_weights(const std::uint32_t* vertices, std::uint32_t count, Block& block,
                                  BlockExtra& extra) {
  const std::size_t slot_count = slots_.slots().size();
  if (slot_count * kLanes > kSparseFrom * influence_count_ && slot_count > kSparseFrom) {
    block.kind |= kSparse;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t first = blocks_.sparse.influences.size();
      if (lane < count)
        for_each_influence(source_, vertices[lane], [&](std::uint32_t slot, float weight) {
          blocks_.sparse.influences.push_back({slot, weight});
        });
      std::stable_sort(blocks_.sparse.influences.begin() + static_cast<std::ptrdiff_t>(first),
                       blocks_.sparse.influences.end(),
                       [](const Influence& a, const Influence& b) { return a.slot < b.slot; });
      std::size_t end = first;
      for (std::size_t i = first; i < blocks_.sparse.influences.size();
           ++i) {  // a slot that is named twice counts once
        if (end > first &&
            blocks_.sparse.influences[end - 1].slot == blocks_.sparse.influences[i].slot)
          blocks_.sparse.influences[end - 1].weight += blocks_.sparse.influences[i].weight;
        else
          blocks_.sparse.influences[end++] = blocks_.sparse.influences[i];
      }
      blocks_.sparse.influences.resize(end);
      blocks_.sparse.lane_ends.push_back(static_cast<std::uint32_t>(end) - extra.influences);
    }
    return;
  }
  const std::size_t first = blocks_.stream.size();
  blocks_.stream.resize(first + slot_count * kLanes);
  for (std::uint32_t lane = 0; lane < count; ++lane)
    for_each_influence(source_, vertices[lane], [&](std::uint32_t slot, float weight) {
      blocks_.stream[first + kLanes * slots_.place(slot) + lane] += weight;
    });
}

void BlockBuilder::append_morphs(const std::uint32_t* vertices, std::uint32_t count, Block& block,
                                 BlockExtra& extra) {
  for (std::uint32_t j = 0; j < source_.morph_targets.size(); ++j) {
    const MorphTarget& target = source_.morph_targets[j];
    const auto moves = [&](const std::vector<Vec3f>& deltas) {
      return !deltas.empty() && std::any_of(vertices, vertices + count,
                                            [&](std::uint32_t v) { return !is_zero(deltas[v]); });
    };
    if (!moves(target.position_deltas) &&
        !(blocks_.layout.has_normals && moves(target.normal_deltas)) &&
        !(blocks_.layout.has_tangents && moves(target.tangent_deltas)))
      continue;
    blocks_.morphs.parts.push_back({j, blocks_.morphs.stream.size()});
    const auto append = [&](const std::vector<Vec3f>& deltas) {
      const std::size_t first = blocks_.morphs.stream.size();
      blocks_.morphs.stream.resize(first + 3 * kLanes);
      for (std::uint32_t lane = 0; lane < count && !deltas.empty(); ++lane)
        for (std::size_t c = 0; c < 3; ++c)
          blocks_.morphs.stream[first + kLanes * c + lane] =
              deltas[vertices[lane]][static_cast<Eigen::Index>(c)];
    };
    append(target.position_deltas);
    if (blocks_.layout.has_normals) append(target.normal_deltas);
    if (blocks_.layout.has_tangents) append(target.tangent_deltas);
    blocks_.movers.append(static_cast<std::uint32_t>(blocks_.layout.slot_count) + j,
                          blocks_.block_count());
    ++extra.morph_count;
  }
  if (extra.morph_count > 0) block.kind |= kMorphed;
}

void BlockBuilder::append_exact(const std::uint32_t* vertices, std::uint32_t count, Block& block,
                                BlockExtra& extra) {
  if (source_.per_influence == nullptr) return;
  const InfluencePositions& exact = *source_.per_influence;
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    const auto known =
        std::lower_bound(exact.vertices.begin(), exact.vertices.end(), vertices[lane]);
    if (known == exact.vertices.end() || *known != vertices[lane]) continue;
    const std::uint32_t first =
        exact_first_[static_cast<std::size_t>(known - exact.vertices.begin())];
    const auto influences = source_.weights->of(vertices[lane]);
    blocks_.exact.lanes.push_back(
        {lane, static_cast<std::uint32_t>(blocks_.exact.influences.size()),
         static_cast<std::uint32_t>(influences.size()), blocks_.exact.stream.size()});
    blocks_.exact.influences.insert(blocks_.exact.influences.end(), influences.begin(),
                                    influences.end());
    const auto append = [&](const std::vector<Vec3f>& values, std::size_t i) {
      const Vec3f value = values.empty() ? Vec3f(Vec3f::Zero()) : values[first + i];
      blocks_.exact.stream.insert(blocks_.exact.stream.end(), value.data(), value.data() + 3);
    };
    const auto append_all = [&](const auto& of) {
      for (std::size_t i = 0; i < influences.size(); ++i) {
        append(of.positions, i);
        if (blocks_.layout.has_normals) append(of.normals, i);
        if (blocks_.layout.has_tangents) append(of.tangents, i);
      }
    };
    append_all(exact);
    for (std::uint32_t j = 0; j < source_.morph_targets.size(); ++j) {
      append_all(exact.morph_targets.empty() ? InfluencePositions::Deltas()
                                             : exact.morph_targets[j]);
      if (!exact.morph_targets.empty())
        blocks_.movers.append(static_cast<std::uint32_t>(blocks_.layout.slot_count) + j,
                              blocks_.block_count());
    }
    ++extra.exact_count;
  }
  if (extra.exact_count > 0) block.kind |= kExact;
}

}  // namespace sunder::skinning
