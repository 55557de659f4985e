#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace sunder::tear {

/// Numbers the cells of a cube of 2^kBits cells a side along a Hilbert curve: cells that follow one
/// another are neighbours. Hamilton, "Compact Hilbert Indices", Dalhousie University CS-2006-07, as
/// a table of the 24 ways in which the curve can lie in an octant.
class HilbertCurve {
 public:
  static constexpr std::uint32_t kBits = 11;

  /// @param cell  coordinates below 2^kBits.
  [[nodiscard]] static constexpr std::uint64_t number_of(const std::array<std::uint32_t, 3>& cell) {
    std::uint64_t number = 0;
    std::uint32_t state = 0;
    for (std::uint32_t bit = kBits; bit-- > 0;) {
      const std::uint32_t octant =
          ((cell[0] >> bit) & 1u) | (((cell[1] >> bit) & 1u) << 1) | (((cell[2] >> bit) & 1u) << 2);
      const std::uint8_t step = kSteps[8 * state + octant];
      number = (number << 3) | (step & 7u);
      state = step >> 3;
    }
    return number;
  }

 private:
  static constexpr std::uint32_t rotate_left(std::uint32_t bits, std::uint32_t by) {
    by %= 3;
    return ((bits << by) | (bits >> (3 - by))) & 7u;
  }

  /// Per state and octant: the octant's index along the curve, plus 8 times the state in that
  /// octant. States are 3 x entry corner + direction.
  static constexpr std::array<std::uint8_t, std::size_t{24} * 8> make_steps() {
    std::array<std::uint8_t, std::size_t{24} * 8> steps{};
    for (std::uint32_t state = 0; state < 24; ++state)
      for (std::uint32_t octant = 0; octant < 8; ++octant) {
        const std::uint32_t entry = state / 3, direction = state % 3;
        const std::uint32_t gray = rotate_left(octant ^ entry, 3 - (direction + 1) % 3);
        const std::uint32_t number = gray ^ (gray >> 1) ^ (gray >> 2);
        const std::uint32_t before = number == 0 ? 0 : (number - 1) / 2 * 2;
        const std::uint32_t entry_of_octant = number == 0 ? 0 : before ^ (before >> 1);
        const auto turned = [](std::uint32_t i) {
          return static_cast<std::uint32_t>(std::countr_one(i)) % 3;
        };
        const std::uint32_t direction_of_octant = number == 0       ? 0
                                                  : number % 2 == 0 ? turned(number - 1)
                                                                    : turned(number);
        const std::uint32_t next = 3 * (entry ^ rotate_left(entry_of_octant, direction + 1)) +
                                   (direction + direction_of_octant + 1) % 3;
        steps[8 * state + octant] = static_cast<std::uint8_t>(8 * next + number);
      }
    return steps;
  }
  static const std::array<std::uint8_t, std::size_t{24} * 8> kSteps;
};

inline constexpr std::array<std::uint8_t, std::size_t{24}* 8> HilbertCurve::kSteps =
    HilbertCurve::make_steps();

}  // namespace sunder::tear
