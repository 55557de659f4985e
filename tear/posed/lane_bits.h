#pragma once

#include <sunder/core/math.h>

#include <cstdint>

namespace sunder::tear {

/// One bit for each of four lanes: whether `a` is greater than `b` there. Compilers do not find
/// these instructions by themselves.
inline std::uint32_t lanes_greater(const Eigen::Array<float, 4, 1>& a,
                                   const Eigen::Array<float, 4, 1>& b) {
#if defined(EIGEN_VECTORIZE_SSE2)  // then Eigen has included what this needs
  return static_cast<std::uint32_t>(
      _mm_movemask_ps(_mm_cmpgt_ps(_mm_loadu_ps(a.data()), _mm_loadu_ps(b.data()))));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i) bits |= std::uint32_t{a[i] > b[i]} << i;
  return bits;
#endif
}

}  // namespace sunder::tear
