#pragma once

#include <sunder/core/math.h>

#include <cstdint>
#include <random>

namespace sunder::test {

/// Seeded, and the same with every standard library: it uses only the engine of <random>, not its
/// distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  std::uint32_t index(std::uint32_t count) { return static_cast<std::uint32_t>(engine_() % count); }
  Vec3d direction() {
    for (;;) {
      const Vec3d v{uniform(-1, 1), uniform(-1, 1),
                    uniform(-1, 1)};  // Braces evaluate in this order with every compiler.
      if (v.norm() > 0.1 && v.norm() < 1) return v / v.norm();
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace sunder::test
