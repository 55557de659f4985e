#include "scene/drawing/instance_mesh.h"

#include <algorithm>
#include <new>
#include <numeric>

namespace sunder::scene {
namespace {

template <class Vector>
StridedFloats<float> floats_of(std::vector<Vector>& values) {
  return {values.empty() ? nullptr : values[0].data(), 0};
}

/// Grows by a little, because tears append few vertices to many. New values are 0: vertices that a
/// detachment released before they were posed stay so, and Eigen's vectors begin with any bits.
template <class Vector>
void resize_within(std::size_t room, Index count, std::vector<Vector>& values) {
  if (values.capacity() < count)
    values.reserve(std::max(
        room, std::size_t{count} + (values.empty() ? 0 : InstanceMesh::room_for_tears(count))));
  values.resize(count, Vector::Zero());
}

/// The attribute from a vertex on. @param width  floats per vertex of a packed one.
StridedFloats<float> from_vertex(const StridedFloats<float>& of, Index vertex, std::size_t width) {
  if (of.data == nullptr) return of;
  const std::size_t stride = of.stride == 0 ? width * sizeof(float) : of.stride;
  return {of.data + vertex * (stride / sizeof(float)), of.stride};
}

bool is_same_memory(const VertexTarget& a, const VertexTarget& b) {
  return a.positions.data == b.positions.data && a.normals.data == b.normals.data &&
         a.tangents.data == b.tangents.data;
}

/// The first vertex whose skinning data a change may have changed.
Index first_changed_vertex(const MeshChange& change) {
  Index first = change.first_vertex;
  if (change.rewritten.empty() && !change.dirty_vertices.empty())
    first = std::min(first, change.dirty_vertices.begin()->first);
  return first;
}

}  // namespace

void InstanceMesh::note(const MeshChange& change, std::uint64_t epoch) noexcept {
  triangles_.note(change);
  attributes_.add(epoch, change.dirty_vertices);
  first_changed_ = std::min(first_changed_, first_changed_vertex(change));
  needs_update_ = true;
  try {
    if (!change.released.empty()) releases_.push_back({true, change.released});
    if (!change.returned.empty()) releases_.push_back({false, change.returned});
  } catch (const std::bad_alloc&) {
    has_lost_releases_ = true;
  }
}

Status InstanceMesh::set_released(const Release& release, bool is_tail) {
  const Index first = is_tail ? source_count_ : 0;
  const Index end = is_tail ? (tail_ ? source_count_ + tail_->vertex_count() : 0) : source_count_;
  std::vector<Index> vertices;
  for (const Index vertex : release.vertices)  // undo may have removed some of them since
    if (vertex >= first && vertex < end) vertices.push_back(vertex - first);
  if (vertices.empty()) return {};
  const SkinnedMesh& skinned = is_tail ? *tail_ : asset_->skinned;
  PosedBuffer& buffer = is_tail ? tail_buffer_ : buffer_;
  return release.is_released ? skinned.release(vertices, buffer)
                             : skinned.take_back(vertices, buffer);
}

/// Follows detachments. If it fails, the next call tries again.
Status InstanceMesh::apply_releases() {
  if (has_lost_releases_) {
    Release all{false, std::vector<Index>(source_count_ + (tail_ ? tail_->vertex_count() : 0))};
    std::iota(all.vertices.begin(), all.vertices.end(), 0u);
    releases_.assign(1, std::move(all));  // to pose what nobody draws does no harm
    has_lost_releases_ = false;
  }
  for (const Release& release : releases_)
    for (const bool is_tail : {false, true})
      if (Status status = set_released(release, is_tail); !status) return status;
  releases_.clear();
  return {};
}

void InstanceMesh::note_all(const Mesh& source, const Mesh& mesh, std::uint64_t epoch) {
  MeshChange change;
  change.first_triangle = source.triangle_count();
  for (Index t = 0; t < source.triangle_count(); ++t)
    if (!is_same(source.triangles[t], mesh.triangles[t]))
      change.rewritten.push_back({t, source.triangles[t]});
  if (change.rewritten.empty() && mesh.vertex_count() == source.vertex_count()) return;
  triangles_.note(change);
  attributes_.add(epoch, IndexRange{source_count_, mesh.vertex_count() - source_count_});
  first_changed_ = source_count_;
  needs_update_ = true;
}

void InstanceMesh::set_target(const VertexTarget& target) {
  has_target_ = target.positions.data != nullptr || target.normals.data != nullptr ||
                target.tangents.data != nullptr;
  target_ = has_target_ ? target : VertexTarget();
  if (has_target_) {
    positions_ = {};
    normals_ = {};
    tangents_ = {};
  }
  needs_update_ = true;
  writes_all_ = true;
}

Result<PreparedTail> PreparedTail::create(const AssetMesh& asset, Index source_count,
                                          const Mesh& mesh, const InfluencePositions& exact) {
  TornTail source(source_count);
  source.update(mesh, exact, source_count);
  Result<SkinnedMesh> skinned = SkinnedMesh::create(source.source(mesh), asset.slots);
  if (!skinned) return skinned.error();
  return PreparedTail{std::move(source), std::move(*skinned)};
}

void InstanceMesh::adopt(PreparedTail&& tail) noexcept {
  tail_source_ = std::move(tail.source);
  set_tail(std::move(tail.skinned));
  first_changed_ = kNone;
}

/// Vertices that a detachment released stay released.
void InstanceMesh::set_tail(SkinnedMesh&& tail) noexcept {
  if (tail_) {
    *tail_ = std::move(tail);
    return;
  }
  tail_.emplace(std::move(tail));
  tail_buffer_ = PosedBuffer(VertexTarget());
  writes_all_ = true;
}

Status InstanceMesh::resize(Index vertex_count) {
  const VertexTarget before = target_;
  if (has_target_) {
    if (vertex_count > target_.vertex_count)
      return Status::failure(StatusCode::capacity_exceeded, target_.vertex_count,
                             "the mesh has %u vertices; the target has room for %u", vertex_count,
                             target_.vertex_count);
  } else {
    const std::size_t room = std::size_t{source_count_} + room_;
    resize_within(room, vertex_count, positions_);
    if (asset_->has_normals) resize_within(room, vertex_count, normals_);
    if (asset_->has_tangents) resize_within(room, vertex_count, tangents_);
    target_ = {vertex_count, floats_of(positions_), floats_of(normals_), floats_of(tangents_),
               unit_length_};
  }
  VertexTarget of_source = target_, of_tail = target_;
  of_source.vertex_count = source_count_;
  of_tail.vertex_count = vertex_count - source_count_;
  of_tail.positions = from_vertex(target_.positions, source_count_, 3);
  of_tail.normals = from_vertex(target_.normals, source_count_, 3);
  of_tail.tangents = from_vertex(target_.tangents, source_count_, 4);
  if (writes_all_ || !is_same_memory(before, target_)) {
    writes_all_ = true;  // it grew into other memory, which is written as a whole
    buffer_.set_target(of_source);
    tail_buffer_.set_target(of_tail);
  } else {
    tail_buffer_.set_vertex_count(of_tail.vertex_count);
  }
  return {};
}

Status InstanceMesh::update_vertices(const Mesh& mesh, const InfluencePositions* exact) {
  if (first_changed_ != kNone) {
    const Index count = mesh.vertex_count();
    const Index before = tail_ ? source_count_ + tail_->vertex_count() : source_count_;
    const Index from = std::max(source_count_, std::min({first_changed_, before, count}));
    tail_source_.update(mesh, *exact, from);
    if (count == source_count_) {
      tail_.reset();
    } else if (tail_) {
      if (Status status = tail_->update(tail_source_.source(mesh), from - source_count_); !status)
        return status;
    } else {
      Result<SkinnedMesh> made = SkinnedMesh::create(tail_source_.source(mesh), asset_->slots);
      if (!made) return made.error();
      set_tail(std::move(*made));
    }
  }
  if (Status status = resize(mesh.vertex_count()); !status) return status;
  first_changed_ = kNone;
  return apply_releases();
}

Status InstanceMesh::deform_part(const Input& input, const SkinnedMesh& skinned,
                                 PosedBuffer& buffer, Index first, Index count) {
  if (input.displaced == nullptr)
    return skinned.deform(input.palette, buffer, input.parallel_for, nullptr);
  VertexDisplacements part = *input.displaced;
  part.vertex_rows = part.vertex_rows.subspan(first, count);
  moved_.clear();
  for (const IndexRange& range : input.displaced->moved) {
    const Index from = std::max(range.first, first);
    const Index end = std::min(range.first + range.count, first + count);
    if (from < end) moved_.push_back({from - first, end - from});
  }
  part.moved = moved_;
  return skinned.deform(input.palette, buffer, input.parallel_for,
                        moved_.empty() ? nullptr : &part);
}

Status InstanceMesh::deform(const Input& input) {
  if (Status status = deform_part(input, asset_->skinned, buffer_, 0, source_count_); !status)
    return status;
  return tail_ ? deform_part(input, *tail_, tail_buffer_, source_count_, tail_->vertex_count())
               : Status();
}

void InstanceMesh::list_written(std::uint64_t epoch) {
  const auto tail = tail_ ? tail_buffer_.dirty_vertices() : std::span<const IndexRange>();
  const auto source = buffer_.dirty_vertices();
  drawn_vertices_ = 0;
  if (source.empty() && tail.empty()) return;
  before_drawn_ = writes_all_ ? epoch : drawn_epoch_;
  drawn_epoch_ = epoch;
  writes_all_ = false;
  written_.assign(source.begin(), source.end());
  for (const IndexRange& range : tail)
    written_.push_back({range.first + source_count_, range.count});
  for (const IndexRange& range : written_) drawn_vertices_ += range.count;
}

Status InstanceMesh::update(const Mesh& mesh, const InfluencePositions* exact,
                            std::uint64_t epoch) {
  if (asset_->poses_vertices)
    if (Status status = update_vertices(mesh, exact); !status) return status;
  triangles_.update(mesh, epoch);
  vertex_count_ = mesh.vertex_count();
  needs_update_ = false;
  return {};
}

Status InstanceMesh::draw(const Input& input) {
  SUNDER_ASSERT(!needs_update_);
  if (asset_->poses_vertices)
    if (Status status = deform(input); !status) return status;
  is_drawn_ = true;
  list_written(input.epoch);
  return {};
}

void InstanceMesh::forget() noexcept {
  writes_all_ = true;
  needs_update_ = true;
}

void InstanceMesh::list_dirty_vertices(std::uint64_t seen, Index count) {
  dirty_vertices_.clear();
  if (!asset_->poses_vertices || (seen >= drawn_epoch_ && seen != 0)) return;
  if (seen < before_drawn_ || seen == 0) {
    dirty_vertices_.push_back({0, count});
    return;
  }
  for (const IndexRange& range : written_)  // undo may have removed some of them since
    if (range.first < count)
      dirty_vertices_.push_back({range.first, std::min(range.count, count - range.first)});
}

PosedMesh InstanceMesh::posed(std::uint64_t seen) {
  if (needs_update_ || !is_drawn_) return {};
  const Index count = vertex_count_;
  list_dirty_vertices(seen, count);
  attributes_.collect(seen, count, dirty_attributes_);
  triangles_.collect(seen, writes_);
  PosedMesh posed;
  posed.positions = {reinterpret_cast<const Vec3f*>(target_.positions.data),
                     target_.positions.stride == 0 && target_.positions.data ? count : 0};
  posed.normals = {reinterpret_cast<const Vec3f*>(target_.normals.data),
                   target_.normals.stride == 0 && target_.normals.data ? count : 0};
  posed.tangents = {reinterpret_cast<const Vec4f*>(target_.tangents.data),
                    target_.tangents.stride == 0 && target_.tangents.data ? count : 0};
  posed.ranges = triangles_.ranges();
  posed.triangle_capacity = triangles_.capacity();
  posed.dirty_vertices = dirty_vertices_;
  posed.dirty_attributes = dirty_attributes_;
  posed.triangle_writes = writes_;
  return posed;
}

std::size_t InstanceMesh::memory_bytes() const {
  return (tail_ ? tail_->stream_bytes() : 0) + positions_.capacity() * sizeof(Vec3f) +
         normals_.capacity() * sizeof(Vec3f) + tangents_.capacity() * sizeof(Vec4f) +
         triangles_.memory_bytes();
}

}  // namespace sunder::scene
