#include "pipeline/aim/severing_sections.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sunder::aim {
namespace {

/// Other limbs move no more of such a section than this.
constexpr double kMostOfOtherLimbs = 0.1;
/// The bones below move a prop if they move at least so much of its section.
constexpr double kLeastBelow = 0.9;
/// Other sections that are tried, at most.
constexpr std::size_t kMostOthers = 8;

Index face_of(const Section& section) { return section.lines.front().face; }

template <class Accepts>
std::vector<Section> those(const std::vector<Section>& sections, Accepts accepts) {
  std::vector<Section> some;
  std::ranges::copy_if(sections, std::back_inserter(some), accepts);
  return some;
}

/// The sections of the limb. A separate part that moves with the limb alone goes along as a whole:
/// near the joint a tusk or a glove, further out what the bones below hold.
std::vector<Section> own_sections(const Limb& limb, const SurfaceParts& parts,
                                  const std::vector<Section>& sections) {
  return those(sections_of_limb(limb, sections), [&](const Section& section) {
    if (!parts.is_of_prop(face_of(section))) return true;
    return !is_near_joint(limb) && section.shares.below() < kLeastBelow;
  });
}

}  // namespace

Severing severing_sections(const Limb& limb, const SurfaceParts& parts, const LimbPlane& plane,
                           const SeverJudge& judge) {
  const std::vector<Section> all = sections_of(limb, plane);
  Severing severing;
  severing.own = own_sections(limb, parts, all);
  const auto severs = [&](std::vector<Section> sections) {
    if (sections.empty()) return false;
    std::string fault = TrialCut(limb, parts, plane, sections).fault(judge);
    if (fault.empty()) severing.sections = std::move(sections);
    if (severing.fault.empty()) severing.fault = std::move(fault);
    return !severing.sections.empty();
  };
  const auto is_severed = [&] {
    if (severs(severing.own)) return true;
    std::vector<Section> of_body =
        those(all, [&](const Section& section) { return parts.is_of_body(face_of(section)); });
    if (severs(sections_of_limb(limb, of_body))) return true;
    std::erase_if(of_body, [](const Section& section) {
      return !section.is_closed || section.shares.other_limbs() > kMostOfOtherLimbs;
    });
    std::ranges::stable_sort(of_body, [&](const Section& a, const Section& b) {
      if (is_round_bone(a) != is_round_bone(b)) return is_round_bone(a);
      return distance(limb.place, a) < distance(limb.place, b);
    });
    if (of_body.size() > kMostOthers) of_body.resize(kMostOthers);
    for (const Section& section : of_body)
      if (severs({section})) return true;
    return false;
  }();
  if (is_severed)
    severing.fault.clear();
  else if (severing.fault.empty())
    severing.fault = other_movers(limb, all);
  return severing;
}

}  // namespace sunder::aim
