#include "pipeline/validation/checks/row_checks.h"

#include <algorithm>
#include <cmath>

#include "pipeline/validation/checks/stored_checks.h"

namespace sunder::validation {
namespace {

constexpr double kRowDiffers = 0.02;  ///< L1; below, rounding to bytes explains it.

/// How near weights have to be to a mistaken row to count as made by that mistake.
double tolerance_of(const Skinned& target, Index mesh) {
  return !target.stored.empty() && target.stored[mesh].format == WeightFormat::unorm8 ? 0.016
                                                                                      : 1e-3;
}

/// Rows of a vertex, reused between vertices.
struct Scratch {
  WeightRow actual, expected, mistaken;
};

/// A match between corners whose weights are those of one corner.
bool is_copied(const RowReader& reader, const SurfaceMatch& match, double tolerance, Scratch& s) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(match.barycentric[k] > 1e-4)) continue;
    std::array<double, 3> corner = {0, 0, 0};
    corner[k] = 1;
    reader.expected(match, corner, s.mistaken);
    if (distance(s.actual, s.mistaken) <= tolerance) return true;
  }
  return false;
}

/// A match on an edge whose weights are those at 1 - t. Inside a face: two coordinates exchanged.
bool is_swapped(const RowReader& reader, const SurfaceMatch& match, double tolerance, Scratch& s) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    if (!(match.barycentric[a] > 1e-6) || !(match.barycentric[b] > 1e-6)) continue;
    std::array<double, 3> exchanged = match.barycentric;
    std::swap(exchanged[a], exchanged[b]);
    reader.expected(match, exchanged, s.mistaken);
    if (distance(s.actual, s.mistaken) <= tolerance) return true;
  }
  return false;
}

/// The weight that a vertex lost although it kept smaller ones; 0: it kept the largest.
double mass_lost_to_smaller(const Scratch& s) {
  if (s.actual.size() >= s.expected.size()) return 0.0;
  double least_kept = 1.0, lost = 0.0;
  for (const auto& [bone, weight] : s.actual) {
    const double of_source = weight_of(s.expected, bone);
    if (of_source <= 0.0) return 0.0;
    least_kept = std::min(least_kept, of_source);
  }
  bool has_larger = false;
  for (const auto& [bone, weight] : s.expected) {
    if (weight_of(s.actual, bone) > 0.0) continue;
    lost += weight;
    has_larger |= weight > least_kept + 1e-3;
  }
  return has_larger ? lost : 0.0;
}

/// The bone that contributes most to the difference of two rows.
Index worst_bone(const RowReader& reader, const Scratch& s) {
  Index worst = kNone;
  double largest = 0.0;
  for (const auto* const row : {&s.actual, &s.expected})
    for (const auto& [bone, weight] : *row) {
      const double difference = std::abs(weight_of(s.actual, bone) - weight_of(s.expected, bone));
      if (difference <= largest || reader.target_bone(bone) == kNone) continue;
      largest = difference;
      worst = reader.target_bone(bone);
    }
  return worst;
}

/// Whether stored integers are the matched weights, each rounded alone.
bool is_rounded_alone(const RowReader& reader, const FindingPlace& place, WeightRow& expected) {
  const Skinned& target = reader.target();
  const StoredInfluences& stored = target.stored[place.mesh];
  const SurfaceMatch& match = reader.match(place.mesh, place.vertex);
  if (!match.is_accepted) return false;
  reader.expected(match, match.barycentric, expected);
  const double one = units_of_one(stored.format);
  std::size_t used = 0;
  for (std::size_t i = std::size_t{place.vertex} * stored.per_vertex;
       i < (std::size_t{place.vertex} + 1) * stored.per_vertex; ++i) {
    const std::uint32_t units = units_of(stored.weights[i], stored.format);
    if (units == 0) continue;
    ++used;
    const Skin& skin = target.character.skins[target.character.meshes[place.mesh].skin];
    if (stored.slots[i] >= skin.bones.size()) return false;
    const Index bone = reader.bones().source_of_target[skin.bones[stored.slots[i]]];
    if (bone == kNone) return false;
    const double exact = weight_of(expected, bone) * one;
    if (std::abs(exact - static_cast<double>(units)) > 0.5 + 1e-3) return false;
  }
  return used > 0;
}

}  // namespace

void check_rows(const RowReader& reader, std::span<const DifferentRow> rows,
                FindingList& findings) {
  Places copied, swapped, first_kept;
  Scratch s;
  for (const DifferentRow& row : rows) {
    if (row.l1 <= kRowDiffers) continue;
    const SurfaceMatch& match = reader.match(row.mesh, row.vertex);
    reader.actual(row.mesh, row.vertex, s.actual);
    reader.expected(match, match.barycentric, s.expected);
    const double tolerance = tolerance_of(reader.target(), row.mesh);
    const FindingPlace place =
        reader.target().place(row.mesh, row.vertex, worst_bone(reader, s), row.l1);
    if (corner_of(match) == 3 && is_copied(reader, match, tolerance, s))
      copied.push_back(place);
    else if (corner_of(match) == 3 && is_swapped(reader, match, tolerance, s))
      swapped.push_back(place);
    if (const double lost = mass_lost_to_smaller(s); lost > 0.0) {
      first_kept.push_back(place);
      first_kept.back().value = lost;
    }
  }
  findings.add(Code::copied, std::move(copied));
  findings.add(Code::swapped, std::move(swapped));
  findings.add(Code::first_kept, std::move(first_kept));
}

Places take_rounded_one_by_one(const RowReader& reader, Places& sum_faults) {
  const std::size_t mesh_count = reader.target().character.meshes.size();
  std::vector<bool> is_explained(mesh_count, true);
  WeightRow expected;
  for (const FindingPlace& place : sum_faults)
    if (is_explained[place.mesh])
      is_explained[place.mesh] = is_rounded_alone(reader, place, expected);
  Places rounded;
  std::erase_if(sum_faults, [&](const FindingPlace& place) {
    if (is_explained[place.mesh]) rounded.push_back(place);
    return is_explained[place.mesh];
  });
  return rounded;
}

}  // namespace sunder::validation
