#include "pipeline/aim/limb_sections.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>

#include "core/internal/ordered.h"
#include "pipeline/aim/joined_sets.h"
#include "pipeline/aim/surface_parts.h"

namespace sunder::aim {
namespace {

using tear::Surface;

/// A loop round the bone belongs to the limb if the limb moves at least half of it.
constexpr double kLeastLimb = 0.5;
/// Near its joint the limb shares its surface with the parent: it moves at least so much, and bones
/// other than the parent no more.
constexpr double kLeastLimbAtJoint = 0.2;
constexpr double kMostOtherAtJoint = 0.2;
/// A run that winds round the bone by more than half a turn goes round it: it may have been torn.
constexpr double kRoundBone = 0.5;
/// Sections that do not go round the bone belong to the limb up to this multiple of its radius.
constexpr double kReachRadii = 1.25;

/// Where a plane crosses the faces: the first and last half-edge of each line, and its ends.
struct CrossedFace {
  Index face = 0;
  std::array<Index, 2> half_edges = {kNone, kNone};
  std::array<Vec3d, 2> ends = {Vec3d(Vec3d::Zero()), Vec3d(Vec3d::Zero())};
};

std::vector<CrossedFace> crossed_faces(const PosedSurface& surface, const LimbPlane& plane) {
  std::vector<double> values(surface.surface().point_count());
  for (Index point = 0; point < values.size(); ++point)
    values[point] = dot(plane.normal, surface.position(point)) - plane.offset;
  std::vector<CrossedFace> crossed;
  for (Index face = 0; face < surface.face_count(); ++face) {
    if (!surface.is_live(face)) continue;
    CrossedFace found;
    found.face = face;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index from = surface.point(h), to = surface.point(Surface::next(h));
      const bool is_from_inside = values[from] >= 0, is_to_inside = values[to] >= 0;
      if (is_from_inside == is_to_inside) continue;
      const double fraction = values[from] / (values[from] - values[to]);
      const std::size_t end = is_from_inside ? 1 : 0;
      found.half_edges[end] = h;
      found.ends[end] =
          surface.position(from) + fraction * (surface.position(to) - surface.position(from));
    }
    if (found.half_edges[0] != kNone && found.half_edges[1] != kNone) crossed.push_back(found);
  }
  return crossed;
}

/// Signed angle at `centre` under which a line is seen in the plane, in turns.
double turns_of(const Section::Line& line, const Vec3d& centre, const Vec3d& normal) {
  const Vec3d a = line.ends[0] - centre, b = line.ends[1] - centre;
  const Vec3d flat_a = a - dot(a, normal) * normal, flat_b = b - dot(b, normal) * normal;
  return std::atan2(dot(normal, flat_a.cross(flat_b)), dot(flat_a, flat_b)) /
         (2 * std::numbers::pi);
}

double distance_to_line(const Vec3d& place, const Section::Line& line) {
  const Vec3d along = line.ends[1] - line.ends[0], way = place - line.ends[0];
  const double squared = squared_norm(along);
  const double part = squared > 0 ? std::clamp(dot(way, along) / squared, 0.0, 1.0) : 0.0;
  return norm(way - part * along);
}

/// The largest distance of a section's ends from a place.
double radius(const Vec3d& place, const Section& section) {
  double largest = 0;
  for (const Section::Line& line : section.lines)
    for (const Vec3d& end : line.ends) largest = std::max(largest, norm(end - place));
  return largest;
}

/// Whether the bone, its subtree and, near the joint, its parent move a section.
bool is_moved_by_limb(const Limb& limb, const Section& section) {
  const LimbShares& shares = section.shares;
  return shares.limb() >= kLeastLimb ||
         (is_near_joint(limb) && shares.limb() >= kLeastLimbAtJoint &&
          shares.other() <= kMostOtherAtJoint);
}

/// Whether the bone itself moves a section: a club that its hand holds is not on the arm.
bool is_moved_by_bone(const Limb& limb, const Section& section) {
  const LimbShares& shares = section.shares;
  return shares.own() >= kLeastLimb || (is_near_joint(limb) && shares.own() >= kLeastLimbAtJoint &&
                                        shares.own() + shares.parent() >= 1 - kMostOtherAtJoint);
}

/// "45 % 'Hips' and 30 % 'RightLeg'": the bones that move most of a section.
std::string movers_of(const Limb& limb, const Section& section) {
  const auto& bones = limb.surface.character().skeleton.bones;
  std::vector<double> weights(bones.size(), 0.0);
  for (const Section::Line& line : section.lines)
    for (Index corner = 3 * line.face; corner < 3 * line.face + 3; ++corner)
      for_each_influence(limb.surface, limb.surface.point(corner), [&](Index bone, double weight) {
        weights[bone] += weight * norm(line.ends[1] - line.ends[0]);
      });
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::string text;
  for (int i = 0; i < 2; ++i) {
    const auto largest = std::max_element(weights.begin(), weights.end());
    if (!(*largest > 0)) break;
    text += (i == 0 ? "" : " and ") + std::to_string(std::lround(100 * *largest / sum)) + " % '" +
            bones[static_cast<std::size_t>(largest - weights.begin())].name.substr(0, 40) + "'";
    *largest = 0;
  }
  return text;
}

}  // namespace

std::vector<Section> sections_of(const Limb& limb, const LimbPlane& plane) {
  const Surface& surface = limb.surface.surface();
  const std::vector<CrossedFace> crossed = crossed_faces(limb.surface, plane);
  JoinedSets joined(crossed.size());
  for (Index i = 0; i < crossed.size(); ++i)
    for (const Index h : crossed[i].half_edges) {
      if (surface.twin[h] == kNone) continue;
      const auto other = std::lower_bound(
          crossed.begin(), crossed.end(), surface.twin[h] / 3,
          [](const CrossedFace& face, Index wanted) { return face.face < wanted; });
      if (other != crossed.end() && other->face == surface.twin[h] / 3)
        joined.join(i, static_cast<Index>(other - crossed.begin()));
    }
  std::vector<Index> section_of(crossed.size(), kNone);
  std::vector<Section> sections;
  for (Index i = 0; i < crossed.size(); ++i) {
    Index& number = section_of[joined.set_of(i)];
    if (number == kNone) {
      number = static_cast<Index>(sections.size());
      sections.emplace_back();
    }
    Section& section = sections[number];
    const Section::Line line{crossed[i].face, crossed[i].ends};
    const double length = norm(line.ends[1] - line.ends[0]);
    section.lines.push_back(line);
    for (const Index h : crossed[i].half_edges)
      if (surface.twin[h] == kNone) section.is_closed = false;
    section.length += length;
    section.shares.add(limb.bones.shares_of_face(line.face), length);
    section.middle += 0.5 * length * (line.ends[0] + line.ends[1]);
    section.turns += turns_of(line, limb.place, plane.normal);
  }
  std::erase_if(sections, [](const Section& section) { return !(section.length > 0); });
  for (Section& section : sections) {
    section.middle /= section.length;
    for (double& share : section.shares.of_role) share /= section.length;
  }
  return sections;
}

double distance(const Vec3d& place, const Section& section) {
  double least = std::numeric_limits<double>::infinity();
  for (const Section::Line& line : section.lines)
    least = std::min(least, distance_to_line(place, line));
  return least;
}

bool is_round_bone(const Section& section) { return std::abs(section.turns) > kRoundBone; }

std::vector<Section> sections_of_limb(const Limb& limb, std::vector<Section> sections) {
  // The loops of the limb round its bone say how far it reaches. Where none goes round the bone,
  // because the surface is open or the bone outside of it, the nearest section of the limb does.
  std::vector<bool> is_chosen(sections.size(), false);
  Vec3d centre = limb.place;
  double reach = 0;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (!is_round_bone(sections[i]) || !is_moved_by_limb(limb, sections[i])) continue;
    is_chosen[i] = true;
    reach = std::max(reach, radius(centre, sections[i]));
  }
  if (reach == 0) {
    std::size_t nearest = sections.size();
    for (std::size_t i = 0; i < sections.size(); ++i)
      if (is_moved_by_bone(limb, sections[i]) &&
          (nearest == sections.size() ||
           distance(limb.place, sections[i]) < distance(limb.place, sections[nearest])))
        nearest = i;
    if (nearest == sections.size()) return {};
    is_chosen[nearest] = true;
    centre = sections[nearest].middle;
    reach = radius(centre, sections[nearest]);
  }
  for (std::size_t i = 0; i < sections.size(); ++i)
    if (is_moved_by_bone(limb, sections[i]) &&
        norm(sections[i].middle - centre) <= kReachRadii * reach)
      is_chosen[i] = true;
  std::vector<Section> chosen;
  for (std::size_t i = 0; i < sections.size(); ++i)
    if (is_chosen[i]) chosen.push_back(std::move(sections[i]));
  return chosen;
}

std::string other_movers(const Limb& limb, const std::vector<Section>& sections) {
  const Section* there = nullptr;
  for (const Section& section : sections)
    if (is_round_bone(section) &&
        (there == nullptr || distance(limb.place, section) < distance(limb.place, *there)))
      there = &section;
  if (there == nullptr) return "the limb has no surface there";
  return "the section there is not of the limb alone; it is moved by " + movers_of(limb, *there);
}

std::string proposal(const std::optional<double>& share) {
  if (!share) return {};
  char text[80];
  std::snprintf(text, sizeof text, "; at %.3g it has a section of its own", *share);
  return text;
}

namespace {

/// The sections of the limb; of those, or of the ones on its body, the first that has some on the
/// body. Where the body has none, those that go round the bone: an armour without a leg in it.
std::vector<Section> choose(const Limb& limb, const SurfaceParts& parts,
                            const std::vector<Section>& sections) {
  const auto is_on_body = [&](const Section& section) {
    return parts.is_of_body(section.lines.front().face);
  };
  std::vector<Section> chosen = sections_of_limb(limb, sections);
  if (std::ranges::any_of(chosen, is_on_body)) return chosen;
  std::vector<Section> of_body;
  std::ranges::copy_if(sections, std::back_inserter(of_body), is_on_body);
  of_body = sections_of_limb(limb, std::move(of_body));
  if (!of_body.empty()) return of_body;
  return std::ranges::any_of(chosen, is_round_bone) ? chosen : std::vector<Section>();
}

}  // namespace

Result<std::vector<Section>> limb_sections(const Limb& limb, const LimbPlane& plane) {
  const SurfaceParts parts(limb);
  const std::vector<Section> sections = sections_of(limb, plane);
  std::vector<Section> chosen = choose(limb, parts, sections);
  if (!chosen.empty()) return chosen;
  const auto has_sections = [&](double share) {
    const Limb other = limb_at(limb, share);
    const LimbPlane moved = {plane.normal, dot(plane.normal, other.place)};
    return !choose(other, parts, sections_of(other, moved)).empty();
  };
  return Status::failure(StatusCode::not_found, limb.bones.bone(), "%s: %s%s", limb.label.c_str(),
                         other_movers(limb, sections).c_str(),
                         proposal(nearest_share(limb.at, has_sections)).c_str());
}

}  // namespace sunder::aim
