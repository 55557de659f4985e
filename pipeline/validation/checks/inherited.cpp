#include "pipeline/validation/checks/inherited.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

namespace sunder::validation {

Places take_inherited(const RowReader& reader, Places& of_target, const Places& of_source) {
  std::set<std::array<Index, 3>> corners_with_fault;  // mesh, vertex, bone
  // Faces without area are not matched, but stand where they stood.
  std::set<std::tuple<double, double, double, Index>> places_with_fault;
  const auto key = [](const FindingPlace& place, Index bone) {
    return std::tuple(place.position.x(), place.position.y(), place.position.z(), bone);
  };
  for (const FindingPlace& place : of_source) {
    corners_with_fault.insert({place.mesh, place.vertex, place.bone});
    places_with_fault.insert(key(place, place.bone));
  }
  const auto is_at_corner = [&](const FindingPlace& place, Index bone) {
    const SurfaceMatch& match = reader.match(place.mesh, place.vertex);
    if (match.mesh == kNone) return false;
    const Triangle& corners =
        reader.source().character.meshes[match.mesh].triangles[match.triangle];
    for (std::size_t k = 0; k < 3; ++k)
      if (match.barycentric[k] > 0 && corners_with_fault.contains({match.mesh, corners[k], bone}))
        return true;
    return false;
  };
  Places inherited;
  std::erase_if(of_target, [&](const FindingPlace& place) {
    const Index bone = place.bone == kNone ? kNone : reader.bones().source_of_target[place.bone];
    if (!places_with_fault.contains(key(place, bone)) && !is_at_corner(place, bone)) return false;
    inherited.push_back(place);
    return true;
  });
  return inherited;
}

Places take_inherited_weights(const RowReader& reader, Places& of_target) {
  constexpr double kSame = 0.02;  // what rounding to bytes explains
  WeightRow actual, expected;
  Places inherited;
  std::erase_if(of_target, [&](const FindingPlace& place) {
    if (!reader.expected_at(place.mesh, place.vertex, expected)) return false;
    reader.actual(place.mesh, place.vertex, actual);
    double difference = distance(actual, expected);
    if (place.bone != kNone) {
      const Index bone = reader.bones().source_of_target[place.bone];
      if (bone == kNone) return false;
      difference = std::abs(weight_of(actual, bone) - weight_of(expected, bone));
    }
    if (difference <= kSame) inherited.push_back(place);
    return difference <= kSame;
  });
  return inherited;
}

void add_new_weights(const RowReader& reader, Code code, Places places, FindingList& findings) {
  const Places inherited = take_inherited_weights(reader, places);
  findings.add_new(code, std::move(places), inherited);
}

}  // namespace sunder::validation
