#pragma once

#include <sunder/tear/surface.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace sunder::particles {

using tear::Index;
using tear::Surface;

/// Distances along a surface, from near to far: fast marching (Kimmel and Sethian 1998), with each face unfolded around the point
/// from which its two nearer corners are seen at their distances (Novotni and Klein 2002). Exact where the surface is flat and
/// paths do not bend around borders; else a little too long, never shorter than the straight line. Only the surface is walked, so a
/// tear is in the way. Memory is kept from one use to the next.
class SurfaceFront {
 public:
  /// Forgets all distances.
  void begin(std::size_t point_count) {
    if (states_.size() < point_count) states_.resize(point_count + point_count / 8);
    epoch_ += 2;
    if (epoch_ < 2) {  // once in two thousand million uses
      std::fill(states_.begin(), states_.end(), State{});
      epoch_ = 2;
    }
    heap_.clear();
  }

  /// Lets the front start at a point, or from a path that leads there. @param from  as in label().
  void add(Index point, float distance) {
    State& state = states_[point];
    if (state.epoch >= epoch_ && state.distance <= distance) return;
    state = {distance, epoch_};
    heap_.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32 |
                    point);  // distances are >= 0: bits ascend with them
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
  }

  /// Whether the front has passed a point, and at which distance.
  [[nodiscard]] bool has_passed(Index point) const { return states_[point].epoch == epoch_ + 1; }
  [[nodiscard]] float distance(Index point) const { return states_[point].distance; }

  /// Calls visit(point, distance) for points nearer than `limit`, by growing distance, until it returns false or none is left.
  template <class Visit>
  void run(const Surface& surface, std::span<const Vec3f> positions, float limit, Visit visit) {
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
      const auto point = static_cast<Index>(heap_.back());
      const auto distance = std::bit_cast<float>(static_cast<std::uint32_t>(heap_.back() >> 32));
      heap_.pop_back();
      State& state = states_[point];
      if (state.epoch != epoch_ || state.distance != distance) continue;
      state.epoch = epoch_ + 1;
      const bool goes_on = visit(point, distance);
      pass_on(surface, positions, limit, point);
      if (!goes_on) return;
    }
  }

 private:
  struct State {
    float distance = 0;
    std::uint32_t epoch = 0;  ///< epoch_: a distance is known; epoch_ + 1: it is final.
  };

  /// Tells the points around one that was passed.
  void pass_on(const Surface& surface, std::span<const Vec3f> positions, float limit, Index point) {
    const Vec3f& at = positions[point];
    const float distance = states_[point].distance;
    const Index start = surface.point_corner[point];
    if (start == kNone) return;
    Index corner = start;
    bool is_open = false;
    do {
      const Index to = Surface::next(corner), back = Surface::previous(corner);
      tell_face(positions, limit, at, distance, surface.corner_point[to], surface.corner_point[back]);
      const Index twin = surface.twin[back];
      if (twin == kNone) {
        is_open = true;
        break;
      }
      corner = twin;
    } while (corner != start);
    if (!is_open) return;
    for (Index c = surface.rotate_cw(start); c != kNone; c = surface.rotate_cw(c))
      tell_face(positions, limit, at, distance, surface.corner_point[Surface::next(c)], surface.corner_point[Surface::previous(c)]);
  }

  void tell_face(std::span<const Vec3f> positions, float limit, const Vec3f& at, float distance, Index a, Index b) {
    const bool has_a = has_passed(a), has_b = has_passed(b);
    if (has_a && has_b) return;
    if (has_a || has_b) {
      const Index known = has_a ? a : b, wanted = has_a ? b : a;
      const float found = across_face(at, positions[known], positions[wanted], distance, states_[known].distance);
      if (found < limit) add(wanted, found);
      return;
    }
    const float to_a = distance + (positions[a] - at).norm(), to_b = distance + (positions[b] - at).norm();
    if (to_a < limit) add(a, to_a);
    if (to_b < limit) add(b, to_b);
  }

  /// Distance of p, from the distances of a and b: that of a source which is unfolded into the face's plane, beyond ab; along an
  /// edge where the straight line from there does not cross ab.
  static float across_face(const Vec3f& a, const Vec3f& b, const Vec3f& p, float at_a, float at_b) {
    const Vec3f ab = b - a, ap = p - a;
    const float length_squared = ab.squaredNorm(), along = ab.dot(ap);
    const float source_along = 0.5f * (at_a * at_a - at_b * at_b + length_squared);  // these four: times the length of ab
    const float source_beyond_squared = at_a * at_a * length_squared - source_along * source_along;
    const float height_squared = ap.squaredNorm() * length_squared - along * along;
    if (source_beyond_squared > 0 && height_squared > 0) {
      const float source_beyond = std::sqrt(source_beyond_squared), height = std::sqrt(height_squared),
                  down = source_beyond + height;
      const float crossing = source_along * height + along * source_beyond;  // times `down`
      if (crossing >= 0 && crossing <= length_squared * down) {
        const float across = along - source_along;
        return std::sqrt((across * across + down * down) / length_squared);
      }
    }
    return std::min(at_a + ap.norm(), at_b + (p - b).norm());
  }

  std::vector<State> states_;
  std::uint32_t epoch_ = 0;
  std::vector<std::uint64_t> heap_;
};

}  // namespace sunder::particles
