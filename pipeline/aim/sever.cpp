#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "core/internal/ordered.h"
#include "core/operation/internal/field_ranges.h"
#include "pipeline/aim/operations.h"
#include "pipeline/aim/severing_sections.h"
#include "pipeline/aim/view.h"

namespace sunder::aim {
namespace {

constexpr double kPi = std::numbers::pi;
/// A face lies in the plane if its corners are no farther from it than this share of the sections'
/// length, and its normal leans by no more than 18 degrees: caps are flat only up to the error of
/// their weights in the pose.
constexpr double kCapShare = 0.02, kLeastCapCosine = 0.95;
/// An edge without a neighbour lies in the plane if its ends are nearer than this share …
constexpr double kLipShare = 1e-5;
/// … and where more of the sections' length runs in such faces, another cut was made there.
constexpr double kMostFlat = 0.2;

/// Whether a face lies in the plane or ends there, without a neighbour.
bool is_flat(const Limb& limb, Index face, const LimbPlane& plane, double whole_length) {
  std::array<double, 3> heights;
  for (Index k = 0; k < 3; ++k)
    heights[k] = std::abs(
        dot(plane.normal, limb.surface.position(limb.surface.point(3 * face + k))) - plane.offset);
  for (Index k = 0; k < 3; ++k)
    if (limb.surface.surface().twin[3 * face + k] == kNone &&
        std::max(heights[k], heights[(k + 1) % 3]) <= kLipShare * whole_length)
      return true;
  const auto [a, b, c] = limb.surface.corners(face);
  const Vec3d across = (b - a).cross(c - a);
  return std::max({heights[0], heights[1], heights[2]}) <= kCapShare * whole_length &&
         std::abs(dot(across, plane.normal)) >= kLeastCapCosine * norm(across);
}

/// Whether the plane runs in the surface instead of across it.
bool was_cut(const Limb& limb, const std::vector<Section>& sections, const LimbPlane& plane) {
  double whole = 0, flat = 0;
  if (sections.empty()) return false;
  for (const Section& section : sections) whole += section.length;
  for (const Section& section : sections)
    for (const Section::Line& line : section.lines)
      if (is_flat(limb, line.face, plane, whole)) flat += norm(line.ends[1] - line.ends[0]);
  return flat > kMostFlat * whole;
}

/// The middle of the section's longest line: it lies on this section and, unless surfaces coincide,
/// on no other.
Vec3d place_on(const Section& section) {
  const auto longest = std::max_element(section.lines.begin(), section.lines.end(),
                                        [](const Section::Line& a, const Section::Line& b) {
                                          return squared_norm(a.ends[1] - a.ends[0]) <
                                                 squared_norm(b.ends[1] - b.ends[0]);
                                        });
  return 0.5 * (longest->ends[0] + longest->ends[1]);
}

/// The bone's direction, leaning towards the view by the tilt.
Result<Vec3d> normal_of(const Limb& limb, const SeverOperation& sever) {
  if (sever.tilt == 0) return limb.segment.direction();
  if (const Status status = field::kTiltDegrees.check_degrees(sever.tilt); !status) return status;
  const Result<ViewFrame> frame = view_frame(limb, sever.from);
  if (!frame) return frame.error();
  return Vec3d(std::cos(sever.tilt) * frame->along + std::sin(sever.tilt) * frame->towards_viewer);
}

/// A limb, the plane of a cut through it, and the sections that sever it.
struct AimedSever {
  Limb limb;
  LimbPlane plane;
  SurfaceParts parts;
  std::vector<Section> sections;
};

Result<AimedSever> aim_sever(const PosedSurface& surface, const SeverOperation& sever,
                             const SeverJudge& judge) {
  const Result<Limb> limb = find_limb(surface, sever.place);
  if (!limb) return limb.error();
  const Result<Vec3d> normal = normal_of(*limb, sever);
  if (!normal) return normal.error();
  const SurfaceParts parts(*limb);
  LimbPlane plane = {*normal, dot(*normal, limb->place)};
  Severing severing = severing_sections(*limb, parts, plane, judge);
  if (severing.sections.empty() && limb->segment.next == kNone) {
    // The last bone of a chain leads to no joint: a head whose joint lies in its middle may point
    // to the neck. Then the limb is what lies before the plane.
    const LimbPlane back = {-plane.normal, -plane.offset};
    if (Severing other = severing_sections(*limb, parts, back, judge); !other.sections.empty()) {
      severing = std::move(other);
      plane = back;
    }
  }
  if (was_cut(*limb, severing.own, plane))
    return Status::failure(StatusCode::invalid_argument, limb->bones.bone(),
                           "%s: the surface lies in the plane of the cut, as where the limb was "
                           "severed before; choose another share or a tilt",
                           limb->label.c_str());
  if (!severing.sections.empty())
    return AimedSever{*limb, plane, parts, std::move(severing.sections)};
  return Status::failure(StatusCode::not_found, limb->bones.bone(), "%s: %s", limb->label.c_str(),
                         severing.fault.c_str());
}

/// What lies beside the cut counts only where nothing else severs the limb. The failure proposes
/// the nearest share that works.
Result<AimedSever> aim_sever(const PosedSurface& surface, const SeverOperation& sever) {
  const Result<AimedSever> aimed = aim_sever(surface, sever, {false, false});
  if (aimed || aimed.error().code() != StatusCode::not_found) return aimed;
  const Result<AimedSever> with_props = aim_sever(surface, sever, {false, true});
  if (with_props) return with_props;
  SeverOperation other = sever;
  const auto share = nearest_share(sever.place.at, [&](double at) {
    other.place.at = at;
    return static_cast<bool>(severs(surface, other, {false, true}));
  });
  const Status& fault = aimed.error();
  return Status::failure(fault.code(), fault.index(), "%s%s", std::string(fault.text()).c_str(),
                         proposal(share).c_str());
}

}  // namespace

Status severs(const PosedSurface& surface, const SeverOperation& sever, const SeverJudge& judge) {
  const Result<AimedSever> aimed = aim_sever(surface, sever, judge);
  return aimed ? Status() : aimed.error();
}

Result<Operation> resolve_sever(const PosedSurface& surface, const SeverOperation& sever) {
  const Result<AimedSever> aimed = aim_sever(surface, sever);
  if (!aimed) return aimed.error();
  PlaneCut cut;
  cut.point = aimed->limb.place;
  cut.normal = aimed->plane.normal;
  cut.caps = sever.caps;
  cut.cap_material = sever.cap_material;
  for (const Section& section : aimed->sections) cut.sections.push_back(place_on(section));
  cut.weights = sever.weights;
  return Operation(CutOperation{sever.pose, cut});
}

Result<SeveredPieces> find_severed_pieces(const PosedSurface& surface,
                                          const SeverOperation& sever) {
  const Result<AimedSever> aimed = aim_sever(surface, sever);
  if (!aimed) return aimed.error();
  const TrialCut trial(aimed->limb, aimed->parts, aimed->plane, aimed->sections);
  return SeveredPieces{trial.severed(), trial.props()};
}

}  // namespace sunder::aim
