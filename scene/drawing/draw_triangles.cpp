#include "scene/drawing/draw_triangles.h"

#include <algorithm>
#include <new>
#include <numeric>
#include <span>

#include "core/internal/index_set.h"

namespace sunder::scene {
namespace {

void make_room_for_one(std::vector<Index>& values) {
  if (values.size() == values.capacity()) values.reserve(2 * values.size() + 32);
}

/// A frame that tears adds little to what earlier ones logged, which must not be copied each time.
template <class T>
void make_room(std::size_t more, std::vector<T>& values) {
  const std::size_t count = values.size() + more;
  if (values.capacity() < count) values.reserve(count + count / 2);
}

}  // namespace

void DrawTriangles::note(const MeshChange& change) noexcept {
  first_appended_ = std::min(first_appended_, change.first_triangle);
  try {
    for (const RewrittenTriangle& rewritten : change.rewritten)
      noted_.push_back(rewritten.triangle);
  } catch (const std::bad_alloc&) {
    lost_count_ = true;
  }
}

void DrawTriangles::shrink(const Mesh& mesh) {
  const Index source_count = order_->triangle_count();
  const Index kept = std::min(std::max(first_appended_, source_count), mesh.triangle_count());
  while (source_count + places_.size() > kept) {
    chunks_[submesh_.back()].triangles.pop_back();
    places_.pop_back();
    submesh_.pop_back();
  }
}

void DrawTriangles::grow(Chunk& chunk, const Mesh& mesh) {
  make_room(chunk.triangles.size(), log_);  // nothing fails below
  chunk.capacity = std::max<Index>(32, 2 * chunk.capacity);
  chunk.first = end_;
  end_ += chunk.capacity;
  Index at = chunk.first;
  for (const Index triangle : chunk.triangles) {
    places_[triangle - order_->triangle_count()] = at++;
    log(triangle, mesh);
  }
}

void DrawTriangles::append(const Mesh& mesh) {
  chunks_.resize(std::max(chunks_.size(), mesh.submeshes.size()));
  const Index source_count = order_->triangle_count();
  for (Index t = source_count + static_cast<Index>(places_.size()); t < mesh.triangle_count();
       ++t) {
    Chunk& chunk = chunks_[mesh.triangle_submesh[t]];
    if (chunk.triangles.size() == chunk.capacity) grow(chunk, mesh);
    make_room_for_one(places_);  // so that the three lists stay equally long
    make_room_for_one(submesh_);
    chunk.triangles.push_back(t);
    places_.push_back(chunk.first + static_cast<Index>(chunk.triangles.size()) - 1);
    submesh_.push_back(mesh.triangle_submesh[t]);
    log(t, mesh);
  }
}

void DrawTriangles::update(const Mesh& mesh, std::uint64_t epoch) {
  if (first_appended_ == kNone && noted_.empty() && !lost_count_) return;
  is_torn_ = true;
  shorten_log();
  make_room(1, epochs_);
  const std::size_t first = log_.size();
  if (epochs_.empty() || epochs_.back().epoch != epoch) epochs_.push_back({epoch, first});
  shrink(mesh);
  append(mesh);
  if (lost_count_) {
    noted_.resize(mesh.triangle_count());
    std::iota(noted_.begin(), noted_.end(), 0u);
  }
  make_room(noted_.size(), log_);
  for (const Index triangle : noted_)
    if (triangle < mesh.triangle_count()) log(triangle, mesh);
  list_ranges(mesh);
  noted_.clear();
  lost_count_ = false;
  first_appended_ = kNone;
}

void DrawTriangles::list_ranges(const Mesh& mesh) {
  ranges_.assign(order_->ranges().begin(), order_->ranges().end());
  for (Index s = 0; s < mesh.submeshes.size() && s < chunks_.size(); ++s)
    if (!chunks_[s].triangles.empty())
      ranges_.push_back({s, chunks_[s].first, static_cast<Index>(chunks_[s].triangles.size())});
}

void DrawTriangles::shorten_log() {
  if (log_.size() < next_shortening_) return;
  // The last one of several writes to a place counts. A reader who saw only a part of them is told
  // of all places again.
  IndexSet written(end_);
  std::size_t first = log_.size();
  for (std::size_t i = log_.size(); i-- > 0;)
    if (written.insert(log_[i].place)) log_[--first] = log_[i];
  log_.erase(log_.begin(), log_.begin() + static_cast<std::ptrdiff_t>(first));
  if (!epochs_.empty()) {
    epochs_.front() = {epochs_.back().epoch, 0};
    epochs_.resize(1);
  }
  next_shortening_ = 2 * log_.size() + 4096;
}

void DrawTriangles::collect(std::uint64_t seen, std::vector<TriangleWrite>& writes) const {
  writes.clear();
  const auto unseen =
      std::find_if(epochs_.begin(), epochs_.end(), [&](const Epoch& e) { return e.epoch > seen; });
  if (unseen == epochs_.end()) return;
  writes.assign(log_.begin() + static_cast<std::ptrdiff_t>(unseen->first), log_.end());
}

std::size_t DrawTriangles::memory_bytes() const {
  std::size_t bytes = log_.capacity() * sizeof(TriangleWrite) + noted_.capacity() * sizeof(Index) +
                      (places_.capacity() + submesh_.capacity()) * sizeof(Index) +
                      epochs_.capacity() * sizeof(Epoch) + ranges_.capacity() * sizeof(DrawRange);
  for (const Chunk& chunk : chunks_)
    bytes += sizeof(chunk) + chunk.triangles.capacity() * sizeof(Index);
  return bytes;
}

}  // namespace sunder::scene
