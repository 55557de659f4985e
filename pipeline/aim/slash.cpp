#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/internal/ordered.h"
#include "core/operation/internal/check_ranges.h"
#include "core/operation/internal/describe_aimed.h"
#include "pipeline/aim/limb_rays.h"
#include "pipeline/aim/operations.h"

namespace sunder::aim {
namespace {

/// Blades per width of the limb, and their least and greatest number.
constexpr double kBladesPerWidth = 32;
constexpr double kLeastBlades = 17;
constexpr std::size_t kMostBlades = 129;
/// Steps in which the outline is looked for, at most: so many blades, 128 widths.
constexpr double kMostSteps = 128 * kBladesPerWidth;
/// Near its outline the limb is thin; the blade still passes the near surface by this many widths,
/// and by the width of the gap, whose sides lie deeper there.
constexpr double kLeastDepthWidths = 0.02;
/// What the limb, and the limb with its parent, move of the surface along a stroke, at least.
constexpr double kLeastOfStroke = 0.3, kLeastOfStrokeWithParent = 0.6;

/// The rays of the blades that hit the limb, from the middle of the stroke to both sides without a
/// gap. Where the stroke reaches beyond the limb, it ends at the outline.
struct SeenStroke {
  std::vector<Vec3d> offsets;
  std::vector<RayHit> hits;
};

/// The rays at even steps from the middle that hit the limb, up to a number on each side.
SeenStroke march(const LimbRays& rays, const RayHit& middle, const Vec3d& step, int most) {
  SeenStroke seen;
  const auto look_to = [&](int direction) {
    RayHit last = middle;
    for (int i = direction; std::abs(i) <= most; i += direction) {
      const Vec3d offset = static_cast<double>(i) * step;
      const std::optional<RayHit> hit = rays.cast(offset, last);
      if (!hit) return;
      seen.offsets.push_back(offset);
      seen.hits.push_back(*hit);
      last = *hit;
    }
  };
  look_to(-1);
  std::reverse(seen.offsets.begin(), seen.offsets.end());
  std::reverse(seen.hits.begin(), seen.hits.end());
  seen.offsets.push_back(Vec3d::Zero());
  seen.hits.push_back(middle);
  look_to(1);
  return seen;
}

/// As many rays as there may be blades, evenly chosen; the first and the last one stay.
SeenStroke thinned(const SeenStroke& all) {
  if (all.hits.size() <= kMostBlades) return all;
  SeenStroke some;
  for (std::size_t i = 0; i < kMostBlades; ++i) {
    const std::size_t from = i * (all.hits.size() - 1) / (kMostBlades - 1);
    some.offsets.push_back(all.offsets[from]);
    some.hits.push_back(all.hits[from]);
  }
  return some;
}

SeenStroke look_along(const LimbRays& rays, const Vec3d& way, double length) {
  const std::optional<RayHit> middle = rays.cast_at_middle();
  if (!middle) return {};
  // A stroke may be longer than the limb is wide by any factor: the steps must not grow with it,
  // or it would end far inside the outline.
  const double wanted = std::min(std::ceil(length / rays.width() * kBladesPerWidth), kMostSteps);
  const int half = static_cast<int>(std::max(wanted, kLeastBlades)) / 2;
  const double step = wanted < kMostSteps ? 0.5 * length / half : rays.width() / kBladesPerWidth;
  return thinned(march(rays, *middle, step * way, half));
}

/// Replaces the lengths of a tear that are in widths of the limb.
struct InMetres {
  double width;  ///< Of the limb.

  template <class Widths>
  void operator()(const Field&, double& length, const TearLength<Widths>& kind) const {
    if (*kind.in_widths) length = **kind.in_widths * width;
  }
  void operator()(const Field&, const auto&...) const {}
};

/// The options of the tear, all in metres.
TearOptions options_in_metres(const SlashOperation& slash, double width) {
  TearOptions options = slash.options;
  const InMetres in_metres{width};
  describe_options(in_metres, options, &slash.in_widths);
  return options;
}

/// Checks the lengths of a tear by the size of the limb, metres.
struct LimbSizeCheck {
  const Limb& limb;
  double width, most_deep;
  Status status;

  template <class Widths>
  void operator()(const Field& field, double length, const TearLength<Widths>& kind) {
    if (status)
      status = check_within_limb(limb, field.name, length, kind.is_depth ? most_deep : width,
                                 "the limb is not wider there");
  }
  void operator()(const Field&, const auto&...) const {}
};

/// Refuses lengths beyond what was seen of the limb: a stroke that was meant in other units would
/// silently become one to the outline, or through the whole limb.
Status check_sizes(const Limb& limb, const SlashOperation& slash, const TearOptions& options,
                   const SeenStroke& seen, double width) {
  const double reach = 2 * std::max(norm(seen.offsets.front()), norm(seen.offsets.back()));
  double thickness = 0;
  for (const RayHit& hit : seen.hits) thickness = std::max(thickness, hit.near - hit.far);
  const double most_deep = std::max(width, thickness);
  if (const Status status = check_within_limb(limb, "length", metres(slash.length, width),
                                              std::max(width, reach), "the limb ends there");
      !status)
    return status;
  if (slash.depth)
    if (const Status status = check_within_limb(limb, "depth", metres(*slash.depth, width),
                                                most_deep, "the limb is not thicker there");
        !status)
      return status;
  LimbSizeCheck check{limb, width, most_deep, {}};
  describe(check, options);
  return check.status;
}

/// Heights of a blade towards the viewer.
struct BladeEnds {
  double base = 0, tip = 0;
};

/// Blade `i` of a stroke. Where nothing is in the way, all blades begin at one height, and without
/// a depth they all reach down to one: the gap that a straight row of blades leaves is even.
BladeEnds ends_of(const SeenStroke& seen, std::size_t i, const SlashOperation& slash, double gap,
                  double width) {
  const double least_depth = std::max(kLeastDepthWidths * width, gap);
  double highest = seen.hits[i].near, lowest = seen.hits[i].near;
  for (const RayHit& hit : seen.hits) {
    highest = std::max(highest, hit.near);
    lowest = std::min(lowest, hit.near - std::max(0.5 * (hit.near - hit.far), least_depth));
  }
  const RayHit& hit = seen.hits[i];
  const double before =
      std::min(highest + kClearanceWidths * width - hit.near, 0.5 * hit.free_before);
  if (!slash.depth) return {hit.near + before, lowest};
  // However deep, what is behind the limb stays whole: also what begins before the next blade.
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = std::max<std::size_t>(i, 1) - 1; k < std::min(i + 2, seen.hits.size()); ++k)
    deepest = std::max(deepest, seen.hits[k].far - 0.5 * seen.hits[k].free_behind);
  return {hit.near + before, std::max(hit.near - metres(*slash.depth, width), deepest)};
}

/// The mean of what moves the near surface along a stroke.
LimbShares shares_along(const LimbRays& rays, const SeenStroke& seen) {
  LimbShares mean;
  const double count = static_cast<double>(seen.hits.size());
  for (std::size_t i = 0; i < seen.hits.size(); ++i)
    mean.add(rays.shares_at(seen.offsets[i], seen.hits[i]), 1 / count);
  return mean;
}

/// Refuses a stroke that lies on other limbs, or on hardly any of its own.
Status check_shares(const Limb& limb, const LimbShares& shares) {
  if (shares.limb() >= kLeastOfStroke &&
      shares.limb() + shares.parent() >= kLeastOfStrokeWithParent)
    return {};
  return Status::failure(StatusCode::not_found, limb.bones.bone(),
                         "%s: the limb moves %ld %% of what the stroke would lie on, and with its "
                         "parent %ld %%; at least %ld and %ld are wanted",
                         limb.label.c_str(), std::lround(100 * shares.limb()),
                         std::lround(100 * (shares.limb() + shares.parent())),
                         std::lround(100 * kLeastOfStroke),
                         std::lround(100 * kLeastOfStrokeWithParent));
}

}  // namespace

Result<Operation> resolve_slash(const PosedSurface& surface, const SlashOperation& slash) {
  const Result<Limb> limb = find_limb(surface, slash.place);
  if (!limb) return limb.error();
  if (const Status status = check_ranges(slash); !status) return status;
  const Result<ViewFrame> frame = view_frame(*limb, slash.from);
  if (!frame) return frame.error();
  const auto sections = limb_sections(*limb, {frame->along, dot(frame->along, limb->place)});
  if (!sections) return sections.error();

  LimbRays rays(*limb, *frame, *sections);
  const double width = rays.width(), length = metres(slash.length, width);
  rays.look_around(0.5 * length + width);
  const TearOptions options = options_in_metres(slash, width);
  const SeenStroke seen = look_along(rays, frame->turned(slash.turn), length);
  if (seen.hits.size() < 2)
    return Status::failure(StatusCode::not_found, limb->bones.bone(),
                           "%s: the limb has no surface there that is seen from this side",
                           limb->label.c_str());
  if (const Status status = check_shares(*limb, shares_along(rays, seen)); !status) return status;
  if (const Status status = check_sizes(*limb, slash, options, seen, width); !status) return status;
  TearOperation tear;
  tear.pose = slash.pose;
  tear.options = options;
  for (std::size_t i = 0; i < seen.hits.size(); ++i) {
    const BladeEnds ends = ends_of(seen, i, slash, options.width, width);
    const Vec3d place = rays.middle() + seen.offsets[i];
    tear.stroke.push_back(
        {place + ends.base * frame->towards_viewer, place + ends.tip * frame->towards_viewer});
  }
  return Operation(std::move(tear));
}

}  // namespace sunder::aim
