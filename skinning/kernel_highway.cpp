// The kernel for each vector extension of a CPU; the best one is selected at run time.

#include <cmath>
#include <cstring>

#include "core/internal/prefetch.h"
#include "skinning/displace.h"
#include "skinning/skin_work.h"

// SSSE3 without later extensions is too rare to support, and AVX3_DL adds nothing that is used here
// (with it, Highway 1.0 does not compile for -march=native of a CPU that the compiler knows only in
// part). SVE vectors cannot be members of structs.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skinning/kernel_highway.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // before highway.h: it includes this file once for each target
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sunder::skinning {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
#undef SUNDER_INLINE
#define SUNDER_INLINE HWY_INLINE

using Lanes = hn::CappedTag<float, kLanes>;
using V = hn::Vec<Lanes>;
constexpr Lanes kTag;
constexpr std::uint32_t kVectorLanes = static_cast<std::uint32_t>(hn::MaxLanes(Lanes()));

SUNDER_INLINE V zero() { return hn::Zero(kTag); }
SUNDER_INLINE V set(float value) { return hn::Set(kTag, value); }
SUNDER_INLINE V load(const float* numbers) { return hn::LoadU(kTag, numbers); }
SUNDER_INLINE void store(V v, float* numbers) { hn::StoreU(v, kTag, numbers); }
SUNDER_INLINE V add(V a, V b) { return hn::Add(a, b); }
SUNDER_INLINE V sub(V a, V b) { return hn::Sub(a, b); }
SUNDER_INLINE V mul(V a, V b) { return hn::Mul(a, b); }
SUNDER_INLINE V div(V a, V b) { return hn::Div(a, b); }
SUNDER_INLINE V sqrt(V a) { return hn::Sqrt(a); }
SUNDER_INLINE V abs(V a) { return hn::Abs(a); }
SUNDER_INLINE V max(V a, V b) { return hn::Max(a, b); }
SUNDER_INLINE bool are_all_positive(V a) { return hn::AllTrue(kTag, hn::Gt(a, zero())); }
SUNDER_INLINE V negate_where_negative(V sign, V value) {
  return hn::IfThenElse(hn::Lt(sign, zero()), hn::Neg(value), value);
}
SUNDER_INLINE V if_between(V least, V value, V most, V inside, V outside) {
  return hn::IfThenElse(hn::And(hn::Lt(least, value), hn::Lt(value, most)), inside, outside);
}

/// Three numbers per lane.
SUNDER_INLINE void load_interleaved(const float* numbers, V& x, V& y, V& z) {
#if HWY_TARGET == HWY_SCALAR
  x = set(numbers[0]);
  y = set(numbers[1]);
  z = set(numbers[2]);
#else
  hn::LoadInterleaved3(kTag, numbers, x, y, z);
#endif
}

/// Four numbers per lane.
SUNDER_INLINE void load_interleaved4(const float* numbers, V& x, V& y, V& z, V& w) {
#if HWY_TARGET == HWY_SCALAR
  x = set(numbers[0]);
  y = set(numbers[1]);
  z = set(numbers[2]);
  w = set(numbers[3]);
#else
  hn::LoadInterleaved4(kTag, numbers, x, y, z, w);
#endif
}

template <bool kStream>
SUNDER_INLINE void store_part(V v, float* numbers) {
  if constexpr (kStream)
    hn::Stream(v, kTag, numbers);
  else
    hn::StoreU(v, kTag, numbers);
}

/// x y z x y z ...
template <bool kStream>
SUNDER_INLINE void store_interleaved(V x, V y, V z, float* numbers) {
#if HWY_TARGET == HWY_AVX3
  // One permutation moves each x to its lane in whichever of the three vectors it belongs to; no
  // two need the same lane. The same is done for y and z, followed by blends. (Highway interleaves
  // within 128 bits first, which takes more instructions.)
  alignas(64) static constexpr std::int32_t kX[16] = {0, 11, 6,  1, 12, 7,  2,  13,
                                                      8, 3,  14, 9, 4,  15, 10, 5};
  alignas(64) static constexpr std::int32_t kY[16] = {5,  0, 11, 6,  1, 12, 7,  2,
                                                      13, 8, 3,  14, 9, 4,  15, 10};
  alignas(64) static constexpr std::int32_t kZ[16] = {10, 5,  0, 11, 6,  1, 12, 7,
                                                      2,  13, 8, 3,  14, 9, 4,  15};
  constexpr __mmask16 kFirst = 0x9249, kSecond = 0x2492,
                      kThird = 0x4924;  // lanes 0 3 6 ..., 1 4 7 ..., 2 5 8 ...
  const __m512 px = _mm512_permutexvar_ps(_mm512_load_si512(kX), x.raw),
               py = _mm512_permutexvar_ps(_mm512_load_si512(kY), y.raw),
               pz = _mm512_permutexvar_ps(_mm512_load_si512(kZ), z.raw);
  store_part<kStream>(V{_mm512_mask_mov_ps(_mm512_mask_mov_ps(px, kSecond, py), kThird, pz)},
                      numbers);
  store_part<kStream>(V{_mm512_mask_mov_ps(_mm512_mask_mov_ps(py, kSecond, pz), kThird, px)},
                      numbers + 16);
  store_part<kStream>(V{_mm512_mask_mov_ps(_mm512_mask_mov_ps(pz, kSecond, px), kThird, py)},
                      numbers + 32);
#elif HWY_TARGET == HWY_SCALAR
  numbers[0] = hn::GetLane(x);
  numbers[1] = hn::GetLane(y);
  numbers[2] = hn::GetLane(z);
#else
  if constexpr (kStream) {
    alignas(64) float together[3 * kVectorLanes];
    hn::StoreInterleaved3(x, y, z, kTag, together);
    for (std::uint32_t i = 0; i < 3; ++i)
      hn::Stream(hn::Load(kTag, together + i * kVectorLanes), kTag, numbers + i * kVectorLanes);
  } else {
    hn::StoreInterleaved3(x, y, z, kTag, numbers);
  }
#endif
}

/// x y z w x y z w ...
SUNDER_INLINE void store_interleaved4(V x, V y, V z, V w, float* numbers) {
#if HWY_TARGET == HWY_SCALAR
  numbers[0] = hn::GetLane(x);
  numbers[1] = hn::GetLane(y);
  numbers[2] = hn::GetLane(z);
  numbers[3] = hn::GetLane(w);
#else
  hn::StoreInterleaved4(x, y, z, w, kTag, numbers);
#endif
}

/// Prefetches a later block: hardware prefetches at most 2 KB ahead, which is too late for main
/// memory.
SUNDER_INLINE void prefetch_block(const float* numbers, std::uint32_t vectors) {
  constexpr std::uint32_t kAhead = 8192 / sizeof(float);
  for (std::uint32_t i = 0; i < vectors; ++i) hwy::Prefetch(numbers + kAhead + kLanes * i);
}
SUNDER_INLINE void finish_streaming() { hwy::FlushStream(); }

#undef SUNDER_WIDE_SUMS
#if HWY_TARGET == HWY_AVX3
// What a displaced vertex needs of its particles, with vectors of sixteen numbers: the same
// products and sums per number as with narrower ones.
#define SUNDER_WIDE_SUMS 1

/// sum_k w_k of nine numbers each, to places for four, four, and one.
SUNDER_INLINE void sum_nine(const float* w, const float* a, const float* b, const float* c,
                            const float* d, float* first, float* second, float* last) {
  constexpr __mmask16 kNine = 0x1FF;
  const auto part = [&](std::size_t k, const float* numbers) {
    return mul(set(w[k]), V{_mm512_maskz_loadu_ps(kNine, numbers)});
  };
  const V sum = add(add(add(part(0, a), part(1, b)), part(2, c)), part(3, d));
  _mm_storeu_ps(first, _mm512_castps512_ps128(sum.raw));
  _mm_storeu_ps(second, _mm512_extractf32x4_ps(sum.raw, 1));
  _mm_store_ss(last, _mm512_extractf32x4_ps(sum.raw, 2));
}

/// The columns of sum_k u_k s_k^T, of which s has three numbers for each k and u four.
SUNDER_INLINE void sum_columns(const float* s, const float* u0, const float* u1, const float* u2,
                               const float* u3, float* x, float* y, float* z) {
  constexpr __mmask16 kTwelve = 0xFFF;
  alignas(64) static constexpr std::int32_t kFirst[16] = {0, 0, 0, 0, 1,  1,  1,  1,
                                                          2, 2, 2, 2, 15, 15, 15, 15};
  const __m512 all = _mm512_maskz_loadu_ps(kTwelve, s);
  const auto part = [&](std::int32_t k, const float* u) {
    const __m512i places = _mm512_add_epi32(_mm512_load_si512(kFirst), _mm512_set1_epi32(3 * k));
    return mul(V{_mm512_permutexvar_ps(places, all)}, V{_mm512_broadcast_f32x4(_mm_loadu_ps(u))});
  };
  const V sum = add(add(add(part(0, u0), part(1, u1)), part(2, u2)), part(3, u3));
  _mm_storeu_ps(x, _mm512_castps512_ps128(sum.raw));
  _mm_storeu_ps(y, _mm512_extractf32x4_ps(sum.raw, 1));
  _mm_storeu_ps(z, _mm512_extractf32x4_ps(sum.raw, 2));
}
#else
#define SUNDER_WIDE_SUMS 0
#endif

#include "skinning/kernel-inl.h"
#include "skinning/kernel_displace-inl.h"

}  // namespace HWY_NAMESPACE
}  // namespace sunder::skinning
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sunder::skinning {

HWY_EXPORT(run_kernel);
HWY_EXPORT(run_displacements);
HWY_EXPORT(turn_lanes);

void skin_blocks(const SkinWork& work, std::uint32_t first, std::uint32_t end) {
  HWY_DYNAMIC_DISPATCH(run_kernel)(work, first, end);
}

void displace_vertices(const VertexDisplacements& displacements, const VertexTarget& target,
                       std::uint32_t first, std::uint32_t end, DisplacedLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(run_displacements)(displacements, target, first, end, lanes);
}

void turn_displaced(const VertexTarget& target, DisplacedLanes& lanes) {
  HWY_DYNAMIC_DISPATCH(turn_lanes)(target, lanes);
}

}  // namespace sunder::skinning
#endif
