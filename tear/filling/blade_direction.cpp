#include "tear/filling/blade_direction.h"

#include <algorithm>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/filling/wall_builder.h"

namespace sunder::tear {
namespace {

constexpr std::size_t kBladesPerRun = 32;
constexpr double kFarSquared = 64;

}  // namespace

double squared_distance(const Blade& blade, const Vec3d& point) {
  const Vec3d along = blade.tip - blade.base;
  const double at = std::clamp(dot(along, point - blade.base) / squared_norm(along), 0.0, 1.0);
  return squared_norm(point - blade.base - at * along);
}

BladeDirections::BladeDirections(const Stroke& stroke, ScratchMemory& scratch)
    : stroke_(stroke), runs_(&scratch), squared_(stroke.size(), &scratch) {
  runs_.resize((stroke.size() + kBladesPerRun - 1) / kBladesPerRun);
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    runs_[r].least = runs_[r].most = stroke[r * kBladesPerRun].base;
    for (const Blade& blade : blades_of(r))
      for (const Vec3d* end : {&blade.base, &blade.tip}) {
        runs_[r].least = runs_[r].least.cwiseMin(*end);
        runs_[r].most = runs_[r].most.cwiseMax(*end);
      }
  }
}

std::span<const Blade> BladeDirections::blades_of(std::size_t run) const {
  const std::size_t first = run * kBladesPerRun;
  return std::span(stroke_).subspan(first, std::min(kBladesPerRun, stroke_.size() - first));
}

Vec3d BladeDirections::at(const Vec3d& place) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t r = runs_.size(); r-- > 0;) {  // places are mostly near the newest blades
    runs_[r].is_measured = !(runs_[r].squared_distance(place) > nearest);
    if (runs_[r].is_measured) nearest = std::min(nearest, measure(r, place));
  }
  Vec3d sum = Vec3d::Zero();
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    if (runs_[r].squared_distance(place) > kFarSquared * nearest) continue;
    if (!runs_[r].is_measured) (void)measure(r, place);
    std::size_t i = r * kBladesPerRun;
    for (const Blade& blade : blades_of(r)) {
      const double squared = squared_[i++];
      const double ratio =
          squared > 0 ? nearest / squared : 1.0;  // 1 for the nearest blade, in any unit
      sum += ratio * ratio * normalized(blade.tip - blade.base);
    }
  }
  return unit_or(sum, normalized(stroke_.front().tip - stroke_.front().base));
}

/// Writes the squared distances of a run's blades. @return the least.
double BladeDirections::measure(std::size_t run, const Vec3d& place) {
  double nearest = std::numeric_limits<double>::infinity();
  std::size_t i = run * kBladesPerRun;
  for (const Blade& blade : blades_of(run)) {
    squared_[i] = squared_distance(blade, place);
    nearest = std::min(nearest, squared_[i++]);
  }
  return nearest;
}

}  // namespace sunder::tear
