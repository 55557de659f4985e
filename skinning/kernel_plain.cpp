// The scalar kernel, for builds without Highway.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/internal/prefetch.h"
#include "skinning/displace.h"
#include "skinning/skin_work.h"

#define SUNDER_INLINE inline

namespace sunder::skinning {
namespace {

using V = float;
constexpr std::uint32_t kVectorLanes = 1;

V zero() { return 0.0f; }
V set(float value) { return value; }
V load(const float* numbers) { return *numbers; }
void store(V v, float* numbers) { *numbers = v; }
V add(V a, V b) { return a + b; }
V sub(V a, V b) { return a - b; }
V mul(V a, V b) { return a * b; }
V div(V a, V b) { return a / b; }
V sqrt(V a) { return std::sqrt(a); }
V abs(V a) { return std::abs(a); }
V max(V a, V b) { return std::max(a, b); }
bool are_all_positive(V a) { return a > 0.0f; }
V negate_where_negative(V sign, V value) { return sign < 0.0f ? -value : value; }
V if_between(V least, V value, V most, V inside, V outside) {
  return least < value && value < most ? inside : outside;
}

void load_interleaved(const float* numbers, V& x, V& y, V& z) {
  x = numbers[0];
  y = numbers[1];
  z = numbers[2];
}
void load_interleaved4(const float* numbers, V& x, V& y, V& z, V& w) {
  x = numbers[0];
  y = numbers[1];
  z = numbers[2];
  w = numbers[3];
}
template <bool kStream>
void store_interleaved(V x, V y, V z, float* numbers) {
  numbers[0] = x;
  numbers[1] = y;
  numbers[2] = z;
}
void store_interleaved4(V x, V y, V z, V w, float* numbers) {
  store_interleaved<false>(x, y, z, numbers);
  numbers[3] = w;
}
void prefetch_block(const float*, std::uint32_t) {}
void finish_streaming() {}

#define SUNDER_WIDE_SUMS 0
#include "skinning/kernel-inl.h"
#include "skinning/kernel_displace-inl.h"

}  // namespace

void skin_blocks(const SkinWork& work, std::uint32_t first, std::uint32_t end) {
  run_kernel(work, first, end);
}

void displace_vertices(const VertexDisplacements& displacements, const VertexTarget& target,
                       std::uint32_t first, std::uint32_t end, DisplacedLanes& lanes) {
  run_displacements(displacements, target, first, end, lanes);
}

void turn_displaced(const VertexTarget& target, DisplacedLanes& lanes) {
  turn_lanes(target, lanes);
}

}  // namespace sunder::skinning
