#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "particles/front/rings.h"

namespace sunder::particles {

/// The state of a point in a front. Not negative: its distance, once the front has reached it.
/// Negative: minus the length of the shortest path to it so far (-0 for length zero).
using Known = float;

inline constexpr Known kUnknown = -std::numeric_limits<float>::infinity();

inline bool is_reached(Known known) { return !std::signbit(known); }
/// The distance of a point; infinite if it is not reached.
inline float distance_of(Known known) {
  return is_reached(known) ? known : std::numeric_limits<float>::infinity();
}

/// The same for the points of a RingBlock.
struct alignas(16) KnownBlock {
  std::array<Known, kRingLanes> lanes;
};

namespace one_by_one {

inline KnownBlock gather(const Known* known, const RingBlock& block) {
  KnownBlock gathered;
  for (std::size_t i = 0; i < kRingLanes; ++i) gathered.lanes[i] = known[block.points[i]];
  return gathered;
}

/// The squared distance of a face's corner, from the distances of the other two: the distance of a
/// source unfolded into the plane of the face, on the other side of the edge between those two.
/// Infinite if the straight line from the source does not cross that edge, and for NaN.
/// @param between, to_first, to_second  lengths of the face's edges.
/// @param first, second  distances of its corners.
inline float square_across(float between, float to_first, float to_second, float first,
                           float second) {
  const float scale = 0.5f / between, squared = between * between;
  // Positions of the corner and the source along the edge, and their distances from it.
  const float along = scale * (squared + (to_first - to_second) * (to_first + to_second));
  const float source_along = scale * (squared + (first - second) * (first + second));
  const float height_squared = to_first * to_first - along * along,
              beyond_squared = first * first - source_along * source_along;
  const float product = std::sqrt(std::max(0.0f, height_squared) * std::max(0.0f, beyond_squared));
  // both multiplied by the height
  const float left = source_along * height_squared + along * product;
  const float right = (between - source_along) * height_squared + (between - along) * product;
  if (!(height_squared > 0 && beyond_squared >= 0 && left >= 0 && right >= 0))
    return std::numeric_limits<float>::infinity();
  const float across = along - source_along;
  return across * across + (height_squared + beyond_squared + (product + product));
}

/// The smallest distance of the point in the middle through any of the faces.
inline float shortest_across(const KnownBlock& known, const RingBlock& block) {
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < kRingFaces; ++i)
    least = std::min(least,
                     square_across(block.opposite[i], block.lengths[i], block.lengths[i + 1],
                                   distance_of(known.lanes[i]), distance_of(known.lanes[i + 1])));
  return std::sqrt(least);
}

/// The lanes to which the path through the point in the middle is shorter than the known one, and
/// below a limit; one bit per lane.
/// @param distance  of the point in the middle.
inline unsigned nearer_lanes(const KnownBlock& known, const RingBlock& block, float distance,
                             float limit) {
  unsigned lanes = 0;
  for (std::size_t i = 0; i < kRingLanes; ++i) {
    const float path = distance + block.lengths[i];
    if (path < -known.lanes[i] && path < limit) lanes |= 1u << i;
  }
  return lanes;
}

}  // namespace one_by_one

// The work of a front at each point, for all points around it at once. It is unpredictable which of
// them the front has reached, and mispredicted branches would take most of its time.
#if defined(EIGEN_VECTORIZE_SSE2)  // Eigen has then included the intrinsics

inline KnownBlock gather(const Known* known, const RingBlock& block) {
  const auto four = [&](std::size_t i) {
    return _mm_setr_ps(known[block.points[i]], known[block.points[i + 1]],
                       known[block.points[i + 2]], known[block.points[i + 3]]);
  };
  KnownBlock gathered;
  _mm_store_ps(gathered.lanes.data(), four(0));
  _mm_store_ps(gathered.lanes.data() + 4, four(4));
  return gathered;
}

/// The four lanes after the first of these.
inline __m128 next_lanes(__m128 lanes, __m128 following) {
  const __m128 moved = _mm_move_ss(lanes, following);  // 4, 1, 2, 3
  return _mm_shuffle_ps(moved, moved, _MM_SHUFFLE(0, 3, 2, 1));
}

inline float shortest_across(const KnownBlock& known, const RingBlock& block) {
  const __m128 infinite = _mm_set1_ps(std::numeric_limits<float>::infinity()),
               zero = _mm_setzero_ps();
  const auto distances = [&](std::size_t i) {
    const __m128 lanes = _mm_load_ps(known.lanes.data() + i);
    const __m128 is_unreached = _mm_castsi128_ps(_mm_srai_epi32(_mm_castps_si128(lanes), 31));
    return _mm_or_ps(_mm_and_ps(is_unreached, infinite), _mm_andnot_ps(is_unreached, lanes));
  };
  const auto squares_across = [&](std::size_t i, __m128 to_first, __m128 to_second, __m128 first,
                                  __m128 second) {
    const __m128 between = _mm_load_ps(block.opposite.data() + i);
    const __m128 scale = _mm_div_ps(_mm_set1_ps(0.5f), between),
                 squared = _mm_mul_ps(between, between);
    const auto foot = [&](__m128 a, __m128 b) {
      return _mm_mul_ps(scale, _mm_add_ps(squared, _mm_mul_ps(_mm_sub_ps(a, b), _mm_add_ps(a, b))));
    };
    const __m128 along = foot(to_first, to_second), source_along = foot(first, second);
    const __m128 height_squared =
        _mm_sub_ps(_mm_mul_ps(to_first, to_first), _mm_mul_ps(along, along));
    const __m128 beyond_squared =
        _mm_sub_ps(_mm_mul_ps(first, first), _mm_mul_ps(source_along, source_along));
    const __m128 product =
        _mm_sqrt_ps(_mm_mul_ps(_mm_max_ps(height_squared, zero), _mm_max_ps(beyond_squared, zero)));
    const __m128 left =
        _mm_add_ps(_mm_mul_ps(source_along, height_squared), _mm_mul_ps(along, product));
    const __m128 right = _mm_add_ps(_mm_mul_ps(_mm_sub_ps(between, source_along), height_squared),
                                    _mm_mul_ps(_mm_sub_ps(between, along), product));
    const __m128 across = _mm_sub_ps(along, source_along);
    const __m128 square = _mm_add_ps(
        _mm_mul_ps(across, across),
        _mm_add_ps(_mm_add_ps(height_squared, beyond_squared), _mm_add_ps(product, product)));
    const __m128 is_found = _mm_and_ps(
        _mm_and_ps(_mm_cmpgt_ps(height_squared, zero), _mm_cmpge_ps(beyond_squared, zero)),
        _mm_cmpge_ps(_mm_min_ps(left, right), zero));
    return _mm_or_ps(_mm_and_ps(is_found, square), _mm_andnot_ps(is_found, infinite));
  };
  const __m128 low = distances(0), high = distances(4);
  const __m128 low_length = _mm_load_ps(block.lengths.data()),
               high_length = _mm_load_ps(block.lengths.data() + 4);
  __m128 least = _mm_min_ps(squares_across(0, low_length, next_lanes(low_length, high_length), low,
                                           next_lanes(low, high)),
                            squares_across(4, high_length, next_lanes(high_length, high_length),
                                           high, next_lanes(high, high)));
  least = _mm_min_ps(least, _mm_shuffle_ps(least, least, _MM_SHUFFLE(1, 0, 3, 2)));
  return _mm_cvtss_f32(
      _mm_sqrt_ss(_mm_min_ss(least, _mm_shuffle_ps(least, least, _MM_SHUFFLE(2, 3, 0, 1)))));
}

inline unsigned nearer_lanes(const KnownBlock& known, const RingBlock& block, float distance,
                             float limit) {
  const __m128 sign = _mm_set1_ps(-0.0f), from = _mm_set1_ps(distance), most = _mm_set1_ps(limit);
  const auto four = [&](std::size_t i) {
    const __m128 path = _mm_add_ps(from, _mm_load_ps(block.lengths.data() + i));
    const __m128 label = _mm_xor_ps(_mm_load_ps(known.lanes.data() + i), sign);
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(path, _mm_min_ps(label, most))));
  };
  return four(0) | four(4) << 4;
}

#else

using one_by_one::gather, one_by_one::nearer_lanes, one_by_one::shortest_across;

#endif

}  // namespace sunder::particles
