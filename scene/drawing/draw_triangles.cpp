#include "scene/drawing/draw_triangles.h"

#include <algorithm>
#include <new>
#include <numeric>

namespace sunder::scene {
namespace {

void make_room_for_one(std::vector<Index>& values) {
  if (values.size() == values.capacity()) values.reserve(2 * values.size() + 32);
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

void DrawTriangles::grow(Chunk& chunk) {
  changed_.reserve(changed_.size() + chunk.triangles.size());  // nothing fails below
  chunk.capacity = std::max<Index>(32, 2 * chunk.capacity);
  chunk.first = end_;
  end_ += chunk.capacity;
  Index at = chunk.first;
  for (const Index triangle : chunk.triangles) {
    places_[triangle - order_->triangle_count()] = at++;
    log(triangle);
  }
}

void DrawTriangles::append(const Mesh& mesh) {
  chunks_.resize(std::max(chunks_.size(), mesh.submeshes.size()));
  const Index source_count = order_->triangle_count();
  for (Index t = source_count + static_cast<Index>(places_.size()); t < mesh.triangle_count();
       ++t) {
    Chunk& chunk = chunks_[mesh.triangle_submesh[t]];
    if (chunk.triangles.size() == chunk.capacity) grow(chunk);
    make_room_for_one(places_);  // so that the three lists stay equally long
    make_room_for_one(submesh_);
    chunk.triangles.push_back(t);
    places_.push_back(chunk.first + static_cast<Index>(chunk.triangles.size()) - 1);
    submesh_.push_back(mesh.triangle_submesh[t]);
    log(t);
  }
}

void DrawTriangles::update(const Mesh& mesh, std::uint64_t epoch) {
  if (first_appended_ == kNone && noted_.empty() && !lost_count_) return;
  is_torn_ = true;
  shorten_log();
  epochs_.reserve(epochs_.size() + 1);
  const std::size_t first = changed_.size();
  if (epochs_.empty() || epochs_.back().epoch != epoch) epochs_.push_back({epoch, first});
  shrink(mesh);
  append(mesh);
  if (lost_count_) {
    noted_.resize(mesh.triangle_count());
    std::iota(noted_.begin(), noted_.end(), 0u);
  }
  changed_.insert(changed_.end(), noted_.begin(), noted_.end());
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
  if (changed_.size() < next_shortening_) return;
  // A reader who saw only a part of these changes is told of all of them again.
  std::sort(changed_.begin(), changed_.end());
  changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
  if (!epochs_.empty()) {
    epochs_.front() = {epochs_.back().epoch, 0};
    epochs_.resize(1);
  }
  next_shortening_ = 2 * changed_.size() + 4096;
}

void DrawTriangles::collect(const Mesh& mesh, std::uint64_t seen,
                            std::vector<TriangleWrite>& writes) const {
  writes.clear();
  const auto unseen =
      std::find_if(epochs_.begin(), epochs_.end(), [&](const Epoch& e) { return e.epoch > seen; });
  if (unseen == epochs_.end()) return;
  writes.reserve(changed_.size() - unseen->first);
  for (std::size_t i = unseen->first; i < changed_.size(); ++i)
    if (changed_[i] < mesh.triangle_count())
      writes.push_back({place(changed_[i]), mesh.triangles[changed_[i]]});
}

}  // namespace sunder::scene
