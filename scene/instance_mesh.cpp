#include "scene/instance_mesh.h"

#include <algorithm>
#include <new>

namespace sunder::scene {
namespace {

constexpr Index kInfluencesPerVertex =
    8;  ///< For which memory is reserved where the capacity is fixed.

/// The first vertex whose bind position or weights changed. Operations append vertices and undo
/// removes them from the end; vertices before `first_vertex` are dirty because of their tear side,
/// which is not skinned. Only a change of weights affects existing vertices, and it changes no
/// triangle.
Index first_changed_vertex(const MeshChange& change) {
  const bool is_of_weights =
      change.vertex_count == 0 && change.triangle_count == 0 && change.rewritten.empty();
  if (!is_of_weights || change.dirty_vertices.empty()) return change.first_vertex;
  return std::min(change.first_vertex, change.dirty_vertices.begin()->first);
}

template <class Vector>
StridedFloats<float> floats_of(std::vector<Vector>& values) {
  return {values.empty() ? nullptr : values[0].data()};
}

}  // namespace

void PendingRanges::add(const IndexRange& range) noexcept {
  try {
    pending_.push_back(range);
  } catch (const std::bad_alloc&) {
    Index first = range.first, end = range.first + range.count;
    for (const IndexRange& pending : pending_) {
      first = std::min(first, pending.first);
      end = std::max(end, pending.first + pending.count);
    }
    pending_.assign(1, {first, end - first});
  }
}

void PendingRanges::publish(Index count) noexcept {
  published_.clear();
  std::sort(pending_.begin(), pending_.end(),
            [](const IndexRange& a, const IndexRange& b) { return a.first < b.first; });
  for (const IndexRange& range : pending_) {
    const Index end = std::min(range.first + range.count, count);
    if (range.first >= end) continue;
    if (published_.empty() || range.first > published_.back().first + published_.back().count)
      published_.push_back({range.first, end - range.first});
    else
      published_.back().count = std::max(published_.back().count, end - published_.back().first);
  }
  pending_.clear();
}

Result<InstanceMesh> InstanceMesh::create(const Mesh& mesh, std::size_t slots,
                                          const CharacterInstanceOptions& options) {
  Result<SkinnedMesh> skinned = SkinnedMesh::create(source_of(mesh), slots);
  if (!skinned) return skinned.error();
  InstanceMesh made(std::move(*skinned));
  made.has_normals_ = options.has_normals && !mesh.normals.empty();
  made.has_tangents_ = options.has_tangents && !mesh.tangents.empty();
  made.unit_length_ = options.unit_length;
  const std::size_t most = std::size_t{mesh.vertex_count()} + options.capacity.vertices;
  made.positions_.reserve(most);
  if (made.has_normals_) made.normals_.reserve(most);
  if (made.has_tangents_) made.tangents_.reserve(most);
  if (options.capacity.vertices > 0)
    if (Status status = made.skinned_.reserve(options.capacity.vertices, kInfluencesPerVertex);
        !status)
      return status;
  made.resize(mesh.vertex_count());
  // The first frame draws everything.
  made.triangles_.add(IndexRange{0, mesh.triangle_count()});
  made.attributes_.add(IndexRange{0, mesh.vertex_count()});
  return made;
}

void InstanceMesh::note(const MeshChange& change) noexcept {
  triangles_.add(change.dirty_triangles);
  attributes_.add(change.dirty_vertices);
  first_changed_ = std::min(first_changed_, first_changed_vertex(change));
  try {
    if (!change.released.empty()) releases_.push_back({true, change.released});
    if (!change.returned.empty()) releases_.push_back({false, change.returned});
  } catch (const std::bad_alloc&) {
    has_lost_releases_ = true;
  }
}

/// Follows detachments. @throws std::bad_alloc; the next call tries again.
void InstanceMesh::apply_releases() {
  if (has_lost_releases_) {
    std::vector<Index> all(buffer_.target().vertex_count);
    for (Index v = 0; v < all.size(); ++v) all[v] = v;
    releases_.assign(1, {false, std::move(all)});  // posing what nobody draws does no harm
    has_lost_releases_ = false;
  }
  for (Release& release : releases_) {
    // Vertices that an undo removed in the same frame.
    std::erase_if(release.vertices,
                  [&](Index vertex) { return vertex >= skinned_.vertex_count(); });
    const Status status = release.is_released ? skinned_.release(release.vertices)
                                              : skinned_.take_back(release.vertices);
    if (!status) throw std::bad_alloc();
  }
  releases_.clear();
}

void InstanceMesh::resize(Index vertex_count) {
  positions_.resize(vertex_count);
  if (has_normals_) normals_.resize(vertex_count);
  if (has_tangents_) tangents_.resize(vertex_count);
  const VertexTarget target = {vertex_count, floats_of(positions_), floats_of(normals_),
                               floats_of(tangents_), unit_length_};
  const VertexTarget& now = buffer_.target();
  if (target.positions.data != now.positions.data || target.normals.data != now.normals.data ||
      target.tangents.data != now.tangents.data)
    buffer_.set_target(target);  // it grew into other memory, which is written as a whole
  else
    buffer_.set_vertex_count(vertex_count);
}

Status InstanceMesh::update(const Mesh& mesh, const InfluencePositions& exact) {
  triangles_.prepare();
  attributes_.prepare();
  if (first_changed_ == kNone) return {};
  VertexSource source = source_of(mesh);
  if (!exact.vertices.empty()) source.per_influence = &exact;
  if (Status status = skinned_.update(source, first_changed_); !status) return status;
  resize(mesh.vertex_count());
  apply_releases();
  first_changed_ = kNone;
  return {};
}

Status InstanceMesh::deform(const BonePalette& palette, const ParallelFor& parallel_for,
                            const VertexDisplacements* displacements) {
  return skinned_.deform(palette, buffer_, parallel_for, displacements);
}

void InstanceMesh::publish(const Mesh& mesh) noexcept {
  triangles_.publish(mesh.triangle_count());
  attributes_.publish(mesh.vertex_count());
}

PosedMesh InstanceMesh::posed(const Mesh& mesh) const {
  if (triangles_.has_pending()) return {};
  return {positions_,
          normals_,
          tangents_,
          mesh.triangles,
          buffer_.dirty_vertices(),
          triangles_.published(),
          attributes_.published()};
}

}  // namespace sunder::scene
