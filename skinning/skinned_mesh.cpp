#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>

#include "core/internal/out_of_memory.h"
#include "skinning/block_builder.h"
#include "skinning/block_room.h"
#include "skinning/blocks_to_write.h"
#include "skinning/displace.h"
#include "skinning/identity.h"
#include "skinning/released.h"
#include "skinning/skin_work.h"

namespace sunder {
namespace skinning {
namespace {

/// Minimum blocks per task: about 4 microseconds; for less work a second thread starts too late.
constexpr std::uint32_t kBlocksPerTask = 256;
/// Minimum displaced vertices per task.
constexpr std::uint32_t kVerticesPerTask = 4096;
/// Several, so that an interrupted thread does not delay the others.
constexpr std::uint32_t kTasksPerThread = 4;
/// Bytes read and written that fill most of a last-level cache.
constexpr std::size_t kBeyondCache = 24u << 20u;

/// Removes the blocks from `first` on, and all data of theirs.
void truncate(Blocks& blocks, std::uint32_t first) {
  if (first >= blocks.block_count()) return;
  const Block& block = blocks.blocks[first];
  blocks.vertex_count = blocks.window(block);
  blocks.stream.resize(block.numbers);
  const Block* before = first > 0 ? &blocks.blocks[first - 1] : nullptr;
  blocks.slots.resize(before != nullptr ? before->slots + before->slot_count : 0);
  for (std::uint32_t b = first; b < blocks.block_count(); ++b) {
    if (blocks.blocks[b].kind == 0) continue;
    const BlockExtra extra = blocks.extras[blocks.blocks[b].extra];
    blocks.extras.resize(blocks.blocks[b].extra);
    blocks.scattered.places.resize(extra.places);
    blocks.sparse.influences.resize(extra.influences);
    blocks.sparse.lane_ends.resize(extra.lane_ends);
    if (extra.morphs < blocks.morphs.parts.size())
      blocks.morphs.stream.resize(blocks.morphs.parts[extra.morphs].numbers);
    blocks.morphs.parts.resize(extra.morphs);
    if (extra.exact_lanes < blocks.exact.lanes.size()) {
      blocks.exact.stream.resize(blocks.exact.lanes[extra.exact_lanes].numbers);
      blocks.exact.influences.resize(blocks.exact.lanes[extra.exact_lanes].influences);
    }
    blocks.exact.lanes.resize(extra.exact_lanes);
    break;  // the data of later blocks follows
  }
  blocks.blocks.resize(first);
  blocks.revisions.resize(first);
  blocks.movers.truncate(first);
  blocks.scattered.end = std::min(blocks.scattered.end, first);
}

/// The first block that holds a vertex from `first_changed` on, or shares a window with one that
/// does.
std::uint32_t first_block_to_replace(const Blocks& blocks, std::uint32_t first_changed) {
  std::uint32_t kept = blocks.block_count();
  while (kept > 0) {
    // The blocks of a window are not ordered by their vertices, so the end of the window decides.
    const std::uint32_t window = blocks.window(blocks.blocks[kept - 1]);
    std::uint32_t first = kept - 1, last_vertex = 0;
    for (;; --first) {
      last_vertex = std::max(last_vertex, blocks.last_vertex(blocks.blocks[first]));
      if (first == 0 || blocks.window(blocks.blocks[first - 1]) != window) break;
    }
    if (last_vertex < first_changed) break;
    kept = first;
  }
  return kept;
}

template <class Float>
StridedFloats<Float> with_stride(const StridedFloats<Float>& array, std::size_t components) {
  return {array.data, array.stride != 0 ? array.stride : components * sizeof(float)};
}

Status check_target(const Blocks& blocks, const PaletteData& palette, const VertexTarget& target) {
  if (palette.slots != blocks.layout.slot_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the palette has %zu slots, the mesh was created for %zu", palette.slots,
                           blocks.layout.slot_count);
  const std::uint64_t last_weight =
      std::uint64_t{blocks.layout.first_morph_weight} + blocks.layout.morph_count;
  if (palette.morph_weights.size() < last_weight)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the mesh uses morph weights up to %llu; the palette has %zu",
                           static_cast<unsigned long long>(last_weight),
                           palette.morph_weights.size());
  if (palette.revision == 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the palette has no pose yet; call BonePalette::set() first");
  if (target.vertex_count != blocks.vertex_count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the buffer holds %u vertices, the mesh has %u", target.vertex_count,
                           blocks.vertex_count);
  if (target.positions.data == nullptr && blocks.vertex_count > 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the buffer has no memory for positions");
  if ((target.normals.data != nullptr && !blocks.layout.has_normals) ||
      (target.tangents.data != nullptr && !blocks.layout.has_tangents))
    return Status::failure(
        StatusCode::invalid_argument, kNone, "the buffer requests %s, the mesh has none",
        target.normals.data != nullptr && !blocks.layout.has_normals ? "normals" : "tangents");
  const auto is_bad = [](const StridedFloats<float>& array, std::size_t packed) {
    return array.stride != 0 && (array.stride < packed || array.stride % sizeof(float) != 0);
  };
  if (is_bad(target.positions, 12) || is_bad(target.normals, 12) || is_bad(target.tangents, 16))
    return Status::failure(
        StatusCode::invalid_argument, kNone,
        "a stride of the buffer is shorter than the numbers of a vertex, or not a multiple of 4");
  return {};
}

/// Ranges of blocks or vertices, divided into tasks of about the same size.
struct Tasks {
  SkinWork work;
  const VertexDisplacements* displacements = nullptr;
  std::span<const IndexRange> ranges;
  std::uint32_t total = 0, count = 0;

  /// Poses the blocks of one task.
  static void pose(const void* tasks, std::uint32_t index) {
    const Tasks& all = *static_cast<const Tasks*>(tasks);
    all.for_each_range(
        index, [&](std::uint32_t first, std::uint32_t end) { skin_blocks(all.work, first, end); });
  }

  /// Displaces the vertices of one task.
  static void displace(const void* tasks, std::uint32_t index) {
    const Tasks& all = *static_cast<const Tasks*>(tasks);
    DisplacedLanes lanes;
    all.for_each_range(index, [&](std::uint32_t first, std::uint32_t end) {
      displace_vertices(*all.displacements, all.work.target, first, end, lanes);
    });
    turn_displaced(all.work.target, lanes);
  }

  /// Runs `task` over all of `these`. @param least  minimum number of elements per task.
  void run(std::span<const IndexRange> these, std::uint32_t least, ParallelFor::Task task,
           const ParallelFor& parallel_for) {
    ranges = these;
    total = 0;
    for (const IndexRange& range : these) total += range.count;
    const std::uint32_t threads = std::max(1u, parallel_for.threads), most = total / least;
    count =
        std::clamp(most / threads, 1u, kTasksPerThread) * threads;  // the same number per thread
    if (most < threads) count = std::max(1u, most);
    if (parallel_for.run != nullptr && count > 1) {
      parallel_for.run(parallel_for.context, count, task, this);
    } else {
      count = 1;
      task(this, 0);
    }
  }

 private:
  /// Visits the parts of the ranges that belong to one task.
  template <class Visit>
  void for_each_range(std::uint32_t index, Visit visit) const {
    const auto boundary = [&](std::uint32_t i) {
      return static_cast<std::uint32_t>(std::uint64_t{total} * i / count);
    };
    const std::uint32_t first = boundary(index), end = boundary(index + 1);
    std::uint32_t before = 0;  // number of elements in earlier ranges
    for (const IndexRange& range : ranges) {
      const std::uint32_t from = std::max(first, before), to = std::min(end, before + range.count);
      if (from < to) visit(range.first + from - before, range.first + to - before);
      before += range.count;
      if (before >= end) break;
    }
  }
};

/// Merges adjacent ranges.
void join(std::vector<IndexRange>& ranges) {
  std::size_t kept = 0;
  for (const IndexRange& range : ranges) {
    if (kept > 0 && ranges[kept - 1].first + ranges[kept - 1].count == range.first)
      ranges[kept - 1].count += range.count;
    else
      ranges[kept++] = range;
  }
  ranges.resize(kept);
}

/// The vertices of some ranges of blocks, ascending.
void list_vertices(const Blocks& blocks, std::span<const IndexRange> ranges,
                   std::vector<IndexRange>& vertices) {
  std::uint32_t window = kNone;
  for (const IndexRange& range : ranges) {
    const std::uint32_t end = range.first + range.count;
    std::uint32_t b = range.first;
    if (range.count == blocks.block_count()) {
      vertices.push_back({0, blocks.vertex_count});
      return;
    }
    for (; b < std::min(end, blocks.scattered.end); ++b) {
      const Block& block = blocks.blocks[b];
      const std::uint32_t first_vertex = block.first_vertex,
                          end_vertex = blocks.last_vertex(block) + 1;
      if (blocks.window(block) == window) {  // blocks of a window are ordered by their bones
        IndexRange& last = vertices.back();
        const std::uint32_t last_end = std::max(last.first + last.count, end_vertex);
        last.first = std::min(last.first, first_vertex);
        last.count = last_end - last.first;
        continue;
      }
      vertices.push_back({first_vertex, end_vertex - first_vertex});
      window = (block.kind & kScattered) != 0 ? blocks.window(block) : kNone;
    }
    if (b == end) continue;
    const std::uint32_t first_vertex = blocks.blocks[b].first_vertex;
    vertices.push_back(
        {first_vertex, blocks.last_vertex(blocks.blocks[end - 1]) + 1 - first_vertex});
  }
  join(vertices);
}

}  // namespace
}  // namespace skinning

void PosedBuffer::set_target(const VertexTarget& target) {
  target_ = target;
  palette_ = mesh_ = 0;
}

SkinnedMesh::SkinnedMesh(std::unique_ptr<skinning::Blocks> blocks) : blocks_(std::move(blocks)) {}
SkinnedMesh::~SkinnedMesh() = default;
SkinnedMesh::SkinnedMesh(SkinnedMesh&&) noexcept = default;
SkinnedMesh& SkinnedMesh::operator=(SkinnedMesh&&) noexcept = default;

Result<SkinnedMesh> SkinnedMesh::create(const VertexSource& source, std::size_t slots,
                                        VertexGathering gathering) {
  if (const Status status = skinning::check_source(source, slots, 0); !status) return status;
  return or_out_of_memory([&]() -> Result<SkinnedMesh> {
    auto blocks = std::make_unique<skinning::Blocks>();
    blocks->id = skinning::new_identity();
    blocks->layout.slot_count = slots;
    blocks->layout.has_normals = source.normals.data != nullptr;
    blocks->layout.has_tangents = source.tangents.data != nullptr;
    blocks->layout.first_morph_weight = source.first_morph_weight;
    blocks->layout.morph_count = static_cast<std::uint32_t>(source.morph_targets.size());
    blocks->scratch.make_room(slots);
    blocks->movers.resize(slots + source.morph_targets.size());
    skinning::BlockBuilder builder(source, *blocks);
    blocks->vertex_count = source.vertex_count;
    if (gathering == VertexGathering::none) {
      builder.append_in_order(0, source.vertex_count);
      return SkinnedMesh(std::move(blocks));
    }
    for (std::uint32_t v = 0; v < source.vertex_count; v += skinning::kWindow)
      builder.append_gathered(v, std::min(source.vertex_count, v + skinning::kWindow));
    blocks->stream.shrink_to_fit();
    blocks->morphs.stream.shrink_to_fit();
    return SkinnedMesh(std::move(blocks));
  });
}

std::uint32_t SkinnedMesh::vertex_count() const { return blocks_->vertex_count; }

std::size_t SkinnedMesh::stream_bytes() const {
  const skinning::Blocks& b = *blocks_;
  return b.stream.size() * sizeof(float) + b.blocks.size() * sizeof(skinning::Block) +
         b.slots.size() * sizeof(b.slots[0]) + b.extras.size() * sizeof(skinning::BlockExtra) +
         b.scattered.places.size() * sizeof(b.scattered.places[0]) +
         b.sparse.influences.size() * sizeof(Influence) +
         b.sparse.lane_ends.size() * sizeof(b.sparse.lane_ends[0]);
}

Status SkinnedMesh::update(const VertexSource& source, std::uint32_t first_changed) {
  skinning::Blocks& blocks = *blocks_;
  if ((source.normals.data != nullptr) != blocks.layout.has_normals ||
      (source.tangents.data != nullptr) != blocks.layout.has_tangents ||
      source.morph_targets.size() != blocks.layout.morph_count ||
      source.first_morph_weight != blocks.layout.first_morph_weight)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the source has other attributes or morph targets than before");
  if (first_changed > std::min(source.vertex_count, blocks.vertex_count))
    return Status::failure(StatusCode::index_out_of_range, first_changed,
                           "the first changed vertex is %u, beyond the %u vertices of the mesh or "
                           "the %u of the source",
                           first_changed, blocks.vertex_count, source.vertex_count);
  if (const Status status = skinning::check_source(source, blocks.layout.slot_count, first_changed);
      !status)
    return status;
  if (first_changed == source.vertex_count && first_changed == blocks.vertex_count) return {};
  const std::uint32_t first_block = skinning::first_block_to_replace(blocks, first_changed),
                      first_vertex = first_block < blocks.block_count()
                                         ? blocks.window(blocks.blocks[first_block])
                                         : blocks.vertex_count;
  return or_out_of_memory([&]() -> Status {
    skinning::make_room(source, first_vertex, source.vertex_count, blocks);
    skinning::BlockBuilder builder(source, blocks);
    ++blocks.revision;  // from here on nothing allocates
    skinning::truncate(blocks, first_block);
    builder.append_in_order(first_vertex, source.vertex_count);
    blocks.vertex_count = source.vertex_count;
    return {};
  });
}

Status SkinnedMesh::reserve(std::uint32_t more_vertices, std::uint32_t influences) {
  return or_out_of_memory([&]() -> Status {
    skinning::Blocks& b = *blocks_;
    const auto add = [](auto& array, std::size_t more) { array.reserve(array.size() + more); };
    const std::size_t blocks = more_vertices / skinning::kLanes + 2;
    // Neighbours along a tear share most of their bones: a quarter of the slots that they would
    // need otherwise.
    const std::size_t slots = blocks * influences * skinning::kLanes / 4;
    add(b.stream,
        blocks * skinning::kLanes * b.layout.attribute_floats() + slots * skinning::kLanes);
    add(b.blocks, blocks);
    add(b.revisions, blocks);
    add(b.slots, slots);
    add(b.extras, blocks);
    add(b.sparse.influences, std::size_t{more_vertices} * influences);
    add(b.sparse.lane_ends, blocks * skinning::kLanes);
    add(b.morphs.parts, blocks * b.layout.morph_count);
    add(b.morphs.stream,
        blocks * b.layout.morph_count * skinning::kLanes * b.layout.displacement_floats());
    b.movers.make_room(slots + blocks * b.layout.morph_count);
    return {};
  });
}

Status SkinnedMesh::release(std::span<const std::uint32_t> vertices, PosedBuffer& buffer) const {
  return set_released(vertices, true, buffer);
}

Status SkinnedMesh::take_back(std::span<const std::uint32_t> vertices, PosedBuffer& buffer) const {
  return set_released(vertices, false, buffer);
}

Status SkinnedMesh::set_released(std::span<const std::uint32_t> vertices, bool is_released,
                                 PosedBuffer& buffer) const {
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (vertices[i] >= blocks_->vertex_count)
      return Status::failure(StatusCode::index_out_of_range, static_cast<std::uint32_t>(i),
                             "vertex %u does not exist; the mesh has %u", vertices[i],
                             blocks_->vertex_count);
  return or_out_of_memory([&]() -> Status {
    skinning::set_released(vertices, is_released, *blocks_, buffer.released_);
    return {};
  });
}

namespace {

std::uint32_t count_of(std::span<const IndexRange> ranges) {
  std::uint32_t count = 0;
  for (const IndexRange& range : ranges) count += range.count;
  return count;
}

/// Bytes that posing all vertices reads and writes.
std::size_t bytes_of_all(const skinning::Blocks& blocks) {
  const std::size_t written = blocks.layout.has_tangents ? 40 : 24;
  return blocks.stream.size() * sizeof(float) + written * blocks.vertex_count;
}

}  // namespace

Status SkinnedMesh::deform(const BonePalette& palette, PosedBuffer& buffer,
                           const ParallelFor& parallel_for,
                           const VertexDisplacements* displacements) const {
  using namespace skinning;
  const Blocks& blocks = *blocks_;
  const PaletteData& data = *palette.data_;
  if (const Status status = check_target(blocks, data, buffer.target_); !status) return status;
  if (displacements != nullptr)
    if (const Status status = check_displacements(*displacements, blocks.vertex_count); !status)
      return status;
  const std::span<const IndexRange> moved =
      displacements != nullptr ? displacements->moved : std::span<const IndexRange>();
  const bool is_known = buffer.palette_ == data.id && buffer.mesh_ == blocks.id;
  buffer.dirty_.clear();
  if (is_known && buffer.palette_revision_ == data.revision &&
      buffer.mesh_revision_ == blocks.revision && moved.empty() && buffer.displaced_.empty() &&
      buffer.released_.returned.empty())
    return {};

  try {
    buffer.marks_.assign((blocks.block_count() + 63) / 64, 0);
    is_known
        ? mark_changed(blocks, data, buffer.palette_revision_, buffer.mesh_revision_, buffer.marks_)
        : mark({0, blocks.block_count()}, buffer.marks_);
    mark_released(blocks, is_known, buffer.released_, buffer.marks_);
    mark_displaced(blocks, moved, buffer.displaced_, buffer.marks_);
    list_runs(blocks, buffer.marks_, buffer.blocks_to_write_);
    if (!buffer.blocks_to_write_.empty())
      list_vertices(blocks, buffer.blocks_to_write_, buffer.dirty_);
  } catch (const std::bad_alloc&) {
    buffer.dirty_.clear();
    buffer.palette_ = buffer.mesh_ = 0;  // which blocks were displaced is lost: write all next time
    return out_of_memory();
  }
  if (!buffer.blocks_to_write_.empty()) {
    const std::uint32_t block_count = count_of(buffer.blocks_to_write_);
    const std::size_t bytes = bytes_of_all(blocks);
    Tasks tasks;
    tasks.work.mesh = &blocks;
    tasks.work.palette = &data;
    tasks.work.morph_weights = data.morph_weights.data() + blocks.layout.first_morph_weight;
    tasks.work.target = buffer.target_;
    tasks.work.target.positions = with_stride(buffer.target_.positions, 3);
    tasks.work.target.normals = with_stride(buffer.target_.normals, 3);
    tasks.work.target.tangents = with_stride(buffer.target_.tangents, 4);
    tasks.work.attribute_floats = blocks.layout.attribute_floats();
    tasks.work.is_common =
        data.method == SkinningMethod::linear && buffer.target_.tangents.data == nullptr;
    tasks.work.is_beyond_cache = bytes / blocks.block_count() * block_count > kBeyondCache;
    tasks.displacements = displacements;
    tasks.run(buffer.blocks_to_write_, kBlocksPerTask, &Tasks::pose, parallel_for);
    if (!moved.empty()) tasks.run(moved, kVerticesPerTask, &Tasks::displace, parallel_for);
  }
  buffer.palette_ = data.id;
  buffer.mesh_ = blocks.id;
  buffer.palette_revision_ = data.revision;
  buffer.mesh_revision_ = blocks.revision;
  buffer.released_.returned.clear();
  return {};
}

}  // namespace sunder
