#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace sunder::tools {

/// The blood on skin near the lips of wounds, where no texture shows it. Immutable; any number of
/// threads may ask.
class LipBlood {
 public:
  using Segment = std::array<Vec3f, 2>;

  /// @param lips   outlive this object.
  /// @param reach  BloodPlace::reach; 0: there is none.
  LipBlood(std::span<const Segment> lips, float reach);

  /// A colour, linear RGB, as skin of this colour looks at a place. O(lips nearby).
  /// @param rest  BloodPlace::rest.
  [[nodiscard]] Vec3f bloodied(const Vec3f& color, const Vec3f& place, const Vec3f& rest) const;

 private:
  /// Enters a piece of a lip in the cells around it.
  void add(std::uint32_t lip, const Vec3f& begin, const Vec3f& end);
  [[nodiscard]] std::array<std::int64_t, 3> cell_of(const Vec3f& place) const;

  std::span<const Segment> lips_;
  float reach_ = 0;
  /// Cells of space with the lips that may be near places in them.
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> near_;
};

}  // namespace sunder::tools
