#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cstdint>
#include <cstring>

namespace sunder::tear {

/// Converts four bytes to floats at once; compilers do not find these instructions by themselves.
inline Eigen::Array<float, 4, 1> lanes_of(const std::array<std::uint8_t, 4>& bytes) {
#if defined(EIGEN_VECTORIZE_SSE2)  // then Eigen has included what this needs
  std::int32_t together;
  std::memcpy(&together, bytes.data(), 4);
  const __m128i zero = _mm_setzero_si128();
  const __m128i words =
      _mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_cvtsi32_si128(together), zero), zero);
  Eigen::Array<float, 4, 1> lanes;
  _mm_store_ps(lanes.data(), _mm_cvtepi32_ps(words));
  return lanes;
#else
  return {static_cast<float>(bytes[0]), static_cast<float>(bytes[1]), static_cast<float>(bytes[2]),
          static_cast<float>(bytes[3])};
#endif
}

}  // namespace sunder::tear
