#pragma once

#include <sunder/tear/surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace sunder::particles {

using tear::Index;
using tear::Surface;

/// A point beside another, and how long the edge to it is.
struct RingPoint {
  Index point = 0;
  float length = 0;
};

/// The points around each point of a surface, counter-clockwise; where they close a circle the first one comes again at the end. So
/// each two that follow one another are of one face. Points that have no position yet are left out.
class Rings {
 public:
  Rings(const Surface& surface, std::span<const Vec3f> positions);
  [[nodiscard]] std::span<const RingPoint> operator()(Index point) const {
    return {points_.data() + first_[point], first_[point + 1] - first_[point]};
  }

 private:
  std::vector<Index> first_;
  std::vector<RingPoint> points_;
};

/// The same, looked up one after the other.
class RingWalk {
 public:
  /// @param positions  may grow meanwhile.
  RingWalk(const Surface& surface, const std::vector<Vec3f>& positions) : surface_(surface), positions_(positions) {}
  /// Good until the next call.
  [[nodiscard]] std::span<const RingPoint> operator()(Index point) {
    ring_.clear();
    append_ring(surface_, positions_, point, ring_);
    return ring_;
  }
  static void append_ring(const Surface& surface, std::span<const Vec3f> positions, Index point, std::vector<RingPoint>& ring);

 private:
  const Surface& surface_;
  const std::vector<Vec3f>& positions_;
  std::vector<RingPoint> ring_;
};

/// Distances along a surface, from near to far. Points come in the order of Dijkstra's paths along edges, but each from the
/// accurate distances around it, and is given one itself when it is reached: that of a source which is unfolded into the plane of
/// the face through which the shortest path arrives (Novotni and Klein 2002, for the fast marching of Kimmel and Sethian 1998).
/// Exact where the surface is flat and paths do not bend around borders, but for faces that are obtuse. Only the surface is walked,
/// so a tear is in the way. Memory is kept from one use to the next.
class SurfaceFront {
 public:
  /// Forgets all distances. @param limit  how far the front goes; @param edge  how long edges about are.
  void begin(std::size_t point_count, float limit, float edge) {
    for (const Entry& entry : entries_) labels_[entry.point] = distances_[entry.point] = kUnknown;
    entries_.clear();
    grow(point_count);
    limit_ = limit;
    path_limit_ = limit + 0.2f * std::min(edge, limit);
    const float wanted = kBucketsAnEdge * limit / std::max(edge, 1e-3f * limit);
    const auto count = static_cast<std::size_t>(std::clamp(wanted, 32.0f, kMostBuckets)) + 1;
    per_bucket_ = static_cast<float>(count - 1) / path_limit_;
    buckets_.assign(count, kNone);
    bucket_ = 0;
  }

  /// Room for so many points, and for an eighth more.
  void grow(std::size_t point_count) {
    if (labels_.size() >= point_count) return;
    labels_.resize(point_count + point_count / 8 + 1024, kUnknown);
    distances_.resize(labels_.size(), kUnknown);
  }

  /// Lets the front start at a point, or reach it, at a distance.
  void add(Index point, float distance) {
    if (distance < path_limit_ && distance < labels_[point]) put(point, distance, kNone);
  }

  /// Whether there is nothing left to reach.
  [[nodiscard]] bool is_done() const { return bucket_ >= buckets_.size(); }
  /// Of a point that the front has reached; infinite for others.
  [[nodiscard]] float distance(Index point) const { return distances_[point]; }

  /// Calls visit(point, distance, the point from which it was reached) for each point nearer than the limit, from near to far,
  /// until it returns false or none is left. May be called again to go on. @param ring  Rings or RingWalk.
  template <class Ring, class Visit>
  void run(Ring& ring, std::span<const Vec3f> positions, Visit visit) {
    for (; bucket_ < buckets_.size(); ++bucket_)
      while (buckets_[bucket_] != kNone) {
        const Entry entry = entries_[buckets_[bucket_]];
        buckets_[bucket_] = entry.next;
        if (labels_[entry.point] != entry.distance || distances_[entry.point] != kUnknown) continue;
        const std::span<const RingPoint> around = ring(entry.point);
        const float distance = std::min(entry.distance, accurate(positions.data(), entry.point, around));
        distances_[entry.point] = labels_[entry.point] = distance;
        if (!(distance < limit_)) continue;
        const bool goes_on = visit(entry.point, distance, entry.from);
        const std::size_t room = entries_.size() + around.size();
        if (entries_.capacity() < room) entries_.reserve(2 * room);
        const float* const labels = labels_.data();
        for (const RingPoint& other : around) {
          const float path = distance + other.length;
          if (path < labels[other.point] && path < path_limit_) put(other.point, path, entry.point);
        }
        if (!goes_on) return;
      }
  }

  /// Distance of p from that of a and b: of a source which is unfolded into the face's plane, beyond ab. Infinite where the
  /// straight line from there does not cross ab.
  static float across_face(const Vec3f& a, const Vec3f& b, const Vec3f& p, float at_a, float at_b) {
    const Vec3f ab = b - a, ap = p - a;
    const float length_squared = ab.squaredNorm(), along = ab.dot(ap);
    const float source_along = 0.5f * (at_a * at_a - at_b * at_b + length_squared);  // these four: times the length of ab
    const float source_beyond_squared = at_a * at_a * length_squared - source_along * source_along;
    const float height_squared = ap.squaredNorm() * length_squared - along * along;
    if (!(source_beyond_squared >= 0 && height_squared > 0)) return std::numeric_limits<float>::infinity();
    const float source_beyond = std::sqrt(source_beyond_squared), height = std::sqrt(height_squared), down = source_beyond + height;
    const float crossing = source_along * height + along * source_beyond;  // times `down`
    if (!(crossing >= 0 && crossing <= length_squared * down)) return std::numeric_limits<float>::infinity();
    const float across = along - source_along;
    return std::sqrt((across * across + down * down) / length_squared);
  }

 private:
  static constexpr float kUnknown = std::numeric_limits<float>::infinity();
  /// The queue sorts distances into buckets this much finer than edges: points in one can hardly be told of by one another.
  static constexpr float kBucketsAnEdge = 6.0f, kMostBuckets = 4096.0f;

  struct Entry {
    Index point;
    float distance;
    Index from;  ///< The point that it was reached from; kNone where the front starts.
    Index next;  ///< In its bucket.
  };

  void put(Index point, float distance, Index from) {
    labels_[point] = distance;
    const std::size_t bucket = std::max(bucket_, static_cast<std::size_t>(static_cast<std::int32_t>(distance * per_bucket_)));
    entries_.push_back({point, distance, from, std::exchange(buckets_[bucket], static_cast<Index>(entries_.size()))});
  }

  /// Distance of a point through the face whose other corners are nearest: the nearest point around it, and the nearer one beside
  /// that. Where the straight line does not come through that face, it may come through the one on the nearest point's other side.
  [[nodiscard]] float accurate(const Vec3f* positions, Index point, std::span<const RingPoint> around) const {
    const float* const distances = distances_.data();
    const std::size_t count = around.size();
    float nearest = kUnknown;
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const float distance = distances[around[i].point];
      at = distance < nearest ? i : at;
      nearest = std::min(nearest, distance);
    }
    if (nearest == kUnknown) return kUnknown;
    const bool is_closed = count > 2 && around.front().point == around.back().point;
    const std::size_t before = at > 0 ? at - 1 : count - 2, after = at + 1 < count ? at + 1 : 1;
    const float at_before = at > 0 || is_closed ? distances[around[before].point] : kUnknown;
    const float at_after = at + 1 < count || is_closed ? distances[around[after].point] : kUnknown;
    const auto across = [&](std::size_t other, float at_other) {
      if (at_other == kUnknown) return kUnknown;
      return across_face(positions[around[at].point], positions[around[other].point], positions[point], nearest, at_other);
    };
    const float distance = at_before < at_after ? across(before, at_before) : across(after, at_after);
    if (distance < kUnknown) return distance;
    return at_before < at_after ? across(after, at_after) : across(before, at_before);
  }

  std::vector<float> labels_;     ///< What is known of each point: at most so far.
  std::vector<float> distances_;  ///< Of those reached.
  std::vector<Index> buckets_;    ///< The newest entry of each.
  std::vector<Entry> entries_;    ///< All that were put in: what begin() has to clear.
  std::size_t bucket_ = 0;        ///< Being emptied.
  float limit_ = 0, path_limit_ = 0, per_bucket_ = 0;
};

}  // namespace sunder::particles
