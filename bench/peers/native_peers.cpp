#include "bench/peers/native_peers.h"

#include <cstring>

#include <Eigen/Core>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace sunder::bench {

void skin_by_eigen(std::size_t vertices, const float* positions, const float* normals,
                   const std::uint16_t* slots, const float* weights, const float* matrices,
                   float* posed_positions, float* posed_normals) {
  using Matrix = Eigen::Matrix<float, 3, 4>;
  for (std::size_t v = 0; v < vertices; ++v) {
    Matrix blended = Matrix::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      blended += weights[4 * v + k] * Eigen::Map<const Matrix>(matrices + 12 * slots[4 * v + k]);
    Eigen::Map<Eigen::Vector3f>(posed_positions + 3 * v) =
        blended.leftCols<3>() * Eigen::Map<const Eigen::Vector3f>(positions + 3 * v) +
        blended.col(3);
    Eigen::Map<Eigen::Vector3f>(posed_normals + 3 * v) =
        blended.leftCols<3>() * Eigen::Map<const Eigen::Vector3f>(normals + 3 * v);
  }
}

namespace {

struct Line {
  typedef std::uint64_t Words [[gnu::vector_size(64)]];
  Words words;
};

template <Stores kStores>
void store(const Line& line, float* to) {
#if defined(__AVX512F__)
  if constexpr (kStores == Stores::around_caches) {
    _mm512_stream_si512(reinterpret_cast<__m512i*>(to),
                        reinterpret_cast<const __m512i&>(line.words));
    return;
  }
#elif defined(__SSE2__)
  if constexpr (kStores == Stores::around_caches) {
    __m128i parts[4];
    std::memcpy(parts, &line.words, 64);
    for (int i = 0; i < 4; ++i) _mm_stream_si128(reinterpret_cast<__m128i*>(to) + i, parts[i]);
    return;
  }
#endif
  std::memcpy(to, &line.words, 64);
}

template <Stores kStores>
void touch_by(const float* in, std::size_t in_floats, float* out_a, float* out_b,
              std::size_t out_floats, std::size_t ahead) {
  const std::size_t reads = in_floats / 16, writes = 2 * (out_floats / 16);
  Line sums[4] = {};
  std::size_t written = 0;
  for (std::size_t i = 0; i + 4 <= reads; i += 4) {
    for (std::size_t j = 0; j < 4; ++j) {
      Line line;
      std::memcpy(&line.words, in + 16 * (i + j), 64);
      sums[j].words |= line.words;
      if (ahead != 0) __builtin_prefetch(in + 16 * (i + j) + ahead / sizeof(float));
    }
    for (const std::size_t due = writes * (i + 4) / reads; written < due; ++written)
      store<kStores>(sums[0], ((written & 1u) != 0 ? out_b : out_a) + 16 * (written / 2));
  }
  for (int j = 1; j < 4; ++j) sums[0].words |= sums[j].words;
  for (; written < writes; ++written)
    store<kStores>(sums[0], ((written & 1u) != 0 ? out_b : out_a) + 16 * (written / 2));
  std::memcpy(out_a, &sums[0].words, 64);  // so that all reads count
#if defined(__SSE2__)
  if constexpr (kStores == Stores::around_caches) _mm_sfence();
#endif
}

}  // namespace

void touch(const float* in, std::size_t in_floats, float* out_a, float* out_b,
           std::size_t out_floats, Stores stores, std::size_t ahead) {
  if (stores == Stores::plain)
    touch_by<Stores::plain>(in, in_floats, out_a, out_b, out_floats, ahead);
  else
    touch_by<Stores::around_caches>(in, in_floats, out_a, out_b, out_floats, ahead);
}

}  // namespace sunder::bench
