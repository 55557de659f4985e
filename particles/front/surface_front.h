#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "particles/front/ring_lanes.h"

namespace sunder::particles {

/// Distances along a surface, from near to far. Points are visited in the order of Dijkstra's paths
/// along edges. Each gets the distance of a source unfolded into the plane of the face through
/// which the shortest path arrives (Novotni and Klein 2002, for the fast marching of Kimmel and
/// Sethian 1998). Exact where the surface is flat, faces are not obtuse, and paths do not bend
/// around borders. Paths do not cross tears. Memory is reused.
class SurfaceFront {
 public:
  /// Clears all distances.
  /// @param limit  largest distance.
  /// @param edge  typical length of edges.
  void begin(std::size_t point_count, float limit, float edge) {
    for (const Entry& entry : entries_) known_[entry.point] = kUnknown;
    entries_.clear();
    grow(point_count);
    limit_ = limit;
    // A path along edges is longer than the straight path through a face: by up to 0.6 of an edge
    // next to the source, and 0.3 farther away.
    const float beside = std::min(1.0f, 1.5f * edge / limit);
    path_limit_ = limit + (0.3f + 0.3f * beside * beside) * std::min(edge, limit);
    const float wanted = kBucketsAnEdge * limit / std::max(edge, 1e-3f * limit);
    const auto count = static_cast<std::size_t>(std::clamp(wanted, 32.0f, kMostBuckets)) + 1;
    per_bucket_ = static_cast<float>(count - 1) / path_limit_;
    buckets_.assign(count, kNone);
    bucket_ = 0;
    next_ = kNone;
  }

  /// Makes room for a number of points, and an eighth more.
  void grow(std::size_t point_count) {
    if (known_.size() < point_count) known_.resize(point_count + point_count / 8 + 1024, kUnknown);
  }

  /// Starts the front at a point, or lets it reach a point, with some distance.
  void add(Index point, float distance) {
    if (distance < path_limit_ && distance < -known_[point]) put(point, distance, kNone);
  }

  [[nodiscard]] std::size_t memory_bytes() const {
    return known_.capacity() * sizeof(Known) + buckets_.capacity() * sizeof(Index) +
           entries_.capacity() * sizeof(Entry) + around_.capacity() * sizeof(KnownBlock);
  }
  /// Passes its state to a tape. @param points  below which all of its points are.
  template <class Tape>
  void describe(Tape& tape, Index points) {
    tape(limit_);
    tape(path_limit_);
    tape(per_bucket_);
    tape.each(entries_, [&](Entry& entry) {
      tape(entry.point);
      tape(entry.path);
      tape(entry.from);
      tape(entry.next);
      tape.require(entry.point < points && (entry.from == kNone || entry.from < points),
                   "a point of a front does not exist");
      if (entry.point >= points) entry.point = 0;
      if (entry.from >= points) entry.from = kNone;
    });
    if (tape.is_reading()) {
      std::fill(known_.begin(), known_.end(), kUnknown);
      grow(points);
    }
    for (const Entry& entry : entries_) tape.any(known_[entry.point]);
    tape.all(buckets_);
    auto bucket = std::uint64_t{bucket_};
    tape(bucket);
    bucket_ = static_cast<std::size_t>(bucket);
    tape(next_);
    check_entries(tape);
  }
  /// Calls visit(point) for each point that it has met; some are repeated.
  template <class Visit>
  void for_each_met(Visit visit) const {
    for (const Entry& entry : entries_) visit(entry.point);
  }
  /// Calls visit(point) for each point at which it starts; some are repeated.
  template <class Visit>
  void for_each_start(Visit visit) const {
    for (const Entry& entry : entries_)
      if (entry.from == kNone) visit(entry.point);
  }
  /// Whether run() has visited a point. It knows a distance of some points beyond the limit too.
  [[nodiscard]] bool has_visited(Index point) const { return distance(point) < limit_; }
  /// Whether no point is left to reach.
  [[nodiscard]] bool is_done() const { return bucket_ >= buckets_.size(); }
  /// The distance of a point; infinite if the front has not reached it.
  [[nodiscard]] float distance(Index point) const { return distance_of(known_[point]); }

  /// Calls visit(point, distance, the point from which it was reached) for each point nearer than
  /// the limit, from near to far, until it returns false or none is left. May be called again to
  /// continue. @param ring_of  Rings or RingWalk.
  // Not inlined: within a large function its loop would have too few registers.
  template <class RingOf, class Visit>
  [[gnu::noinline]] void run(RingOf& ring_of, Visit visit) {
    for (; bucket_ < buckets_.size(); ++bucket_)
      while (next_ != kNone || buckets_[bucket_] != kNone) {
        if (next_ == kNone) next_ = std::exchange(buckets_[bucket_], kNone);
        const Entry entry = entries_[next_];
        next_ = entry.next;
        if (is_reached(known_[entry.point]) || known_[entry.point] != -entry.path) continue;
        const std::span<const RingBlock> around = ring_of(entry.point).blocks();
        if (around_.size() < around.size()) around_.resize(around.size());
        float distance = entry.path;
        for (std::size_t b = 0; b < around.size(); ++b) {
          around_[b] = gather(known_.data(), around[b]);
          distance = std::min(distance, shortest_across(around_[b], around[b]));
        }
        known_[entry.point] = distance;
        if (!(distance < limit_)) continue;
        const bool goes_on = visit(entry.point, distance, entry.from);
        const std::size_t before = entries_.size();
        put_around(entry.point, distance, around);
        for (std::size_t e = before; e < entries_.size(); ++e) ring_of.expect(entries_[e].point);
        if (!goes_on) return;
      }
  }

 private:
  /// Buckets are finer than edges by this factor, so that points in one bucket hardly depend on
  /// each other.
  static constexpr float kBucketsAnEdge = 6.0f, kMostBuckets = 4096.0f;

  struct Entry {
    Index point;
    float path;
    Index from;  ///< The point that it was reached from; kNone where the front starts.
    Index next;  ///< In its bucket.
  };

  /// Lists of buckets only lead to older entries, so that they end.
  template <class Tape>
  void check_entries(Tape& tape) const {
    const auto leads_to_entry = [&](Index entry) {
      return entry == kNone || entry < entries_.size();
    };
    bool fits = limit_ > 0 && path_limit_ > 0 && per_bucket_ > 0 && !buckets_.empty() &&
                per_bucket_ * path_limit_ < static_cast<float>(buckets_.size()) &&
                bucket_ <= buckets_.size() && leads_to_entry(next_);
    for (const Index first : buckets_) fits &= leads_to_entry(first);
    for (Index e = 0; e < entries_.size(); ++e)
      fits &= entries_[e].next == kNone || entries_[e].next < e;
    for (const Entry& entry : entries_) {
      const Known known = known_[entry.point];
      fits &= entry.path >= 0 && entry.path <= path_limit_ &&
              (entry.from == kNone || has_visited(entry.from)) &&
              (std::abs(known) <= path_limit_ || known == kUnknown);
    }
    tape.require(fits, "the state of a front is none");
  }

  void put(Index point, float path, Index from) {
    known_[point] = -path;
    const std::size_t bucket =
        std::max(bucket_, static_cast<std::size_t>(static_cast<std::int32_t>(path * per_bucket_)));
    entries_.push_back(
        {point, path, from, std::exchange(buckets_[bucket], static_cast<Index>(entries_.size()))});
  }

  /// Queues the neighbours of a point to which the path through it is shorter.
  void put_around(Index point, float distance, std::span<const RingBlock> around) {
    for (std::size_t b = 0; b < around.size(); ++b) {
      const RingBlock& block = around[b];
      for (unsigned lanes = nearer_lanes(around_[b], block, distance, path_limit_); lanes != 0;
           lanes &= lanes - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
        put(block.points[lane], distance + block.lengths[lane], point);
      }
    }
  }

  std::vector<Known> known_;        ///< Per point.
  std::vector<Index> buckets_;      ///< The newest entry of each bucket.
  std::vector<Entry> entries_;      ///< All queued entries, which begin() has to clear.
  std::vector<KnownBlock> around_;  ///< The known distances of the ring of the current point.
  std::size_t bucket_ = 0;          ///< Being emptied.
  Index next_ = kNone;              ///< Position in the current bucket.
  float limit_ = 0, path_limit_ = 0, per_bucket_ = 0;
};

}  // namespace sunder::particles
