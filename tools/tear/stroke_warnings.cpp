#include "tools/tear/stroke_warnings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "core/internal/find_named.h"
#include "tools/messages/printed.h"
#include "tools/model/history.h"

namespace sunder::tools {
namespace {

const Clip* playing_clip(const ClipPose& pose, const Character& character) {
  const std::optional<std::uint32_t> found = find_named_clip(character, pose.clip);
  return found ? &character.clips[*found] : nullptr;
}

Vec3d mean_direction(const Stroke& stroke) {
  Vec3d sum = Vec3d::Zero();
  for (const Blade& blade : stroke) sum += (blade.tip - blade.base).normalized();
  return sum;
}

bool has_swapped_blades(const PosedSurface& surface, const Stroke& stroke) {
  std::size_t swapped = 0;
  for (const Blade& blade : stroke)
    if (is_inside(surface, blade.base) && !is_inside(surface, blade.tip)) ++swapped;
  return 2 * swapped > stroke.size();
}

/// The width of the body across the sweep at one blade.
std::optional<double> width_at(const PosedSurface& surface, const Stroke& stroke, std::size_t i) {
  const Blade& blade = stroke[i];
  const Blade& before = stroke[i == 0 ? 0 : i - 1];
  const Blade& after = stroke[std::min(i + 1, stroke.size() - 1)];
  const Vec3d along = blade.tip - blade.base;
  const Vec3d travel = after.base - before.base + after.tip - before.tip;
  const Vec3d across = along.cross(travel);
  if (!(across.norm() > 0)) return {};
  const std::optional<double> entry = first_hit(surface, blade.base, along);
  if (!entry) return {};
  const std::optional<double> exit = first_hit(surface, blade.base, along, *entry + 1e-9);
  if (!exit) return {};
  const Vec3d middle = blade.base + (*entry + *exit) / 2 * along;
  const Vec3d unit = across.normalized();
  const std::optional<double> left = first_hit(surface, middle, unit),
                              right = first_hit(surface, middle, -unit);
  if (!left || !right) return {};
  return *left + *right;
}

}  // namespace

std::vector<std::string> time_warnings(const Operation& operation, const Character& character) {
  std::vector<std::string> warnings;
  for (const PoseSpec& spec : pose_specs_of(operation)) {
    const auto* const pose = std::get_if<ClipPose>(&spec);
    const Clip* const clip = pose != nullptr ? playing_clip(*pose, character) : nullptr;
    if (clip == nullptr) continue;
    const double duration = static_cast<double>(clip->duration);
    if (pose->time > duration * (1 + 1e-6))
      warnings.push_back(
          printed("the time %.4g s is beyond the end of clip '%s', which lasts %.4g "
                  "s; its last pose is used",
                  pose->time, clip->name.c_str(), duration));
    else if (pose->time < 0)
      warnings.push_back(
          printed("the time %.4g s is before the start of clip '%s'; its first pose is "
                  "used",
                  pose->time, clip->name.c_str()));
  }
  return warnings;
}

Result<std::vector<std::string>> stroke_warnings(const TearOperation& tear, const ModelPose& pose,
                                                 const TornPlace& place, PosedSource& source) {
  std::vector<std::string> warnings;
  const bool faces_point_along = place.normal.dot(mean_direction(tear.stroke)) > 0;
  const double width = tear.options.width;
  if (!faces_point_along && !(width > 0)) return warnings;
  const Result<const PosedSurface*> surface = source.in(pose);
  if (!surface) return surface.error();
  if (faces_point_along && has_swapped_blades(**surface, tear.stroke))
    warnings.emplace_back(
        "the blade starts inside the surface and ends outside: are base and tip swapped? It tore "
        "the first surface from its base on");
  if (!(width > 0)) return warnings;
  const std::optional<double> body = body_width(**surface, tear.stroke);
  const double limit = body.value_or((*surface)->bounds.size().norm());
  if (width > limit)
    warnings.push_back(printed("the gap is %.4g m wide, but the %s only %.4g m%s", width,
                               body ? "body there is" : "model measures", limit,
                               body ? " wide; widths are in metres" : "; widths are in metres"));
  return warnings;
}

std::optional<double> body_width(const PosedSurface& surface, const Stroke& stroke) {
  const std::size_t count = stroke.size(), middle = count / 2;
  for (std::size_t away = 0; away < count; ++away) {
    if (middle + away < count)
      if (const auto width = width_at(surface, stroke, middle + away)) return width;
    if (away > 0 && away <= middle)
      if (const auto width = width_at(surface, stroke, middle - away)) return width;
  }
  return {};
}

}  // namespace sunder::tools
