#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "pipeline/validation/checks/row_checks.h"

namespace sunder::validation {
namespace {

constexpr double kDiffers = 0.02;

/// Weight of each bone in both models over all matched vertices, and how much of it lies on the
/// same vertices, for the bones of rows that differ.
class BoneMasses {
 public:
  explicit BoneMasses(const RowReader& reader) {
    const std::size_t count =
        reader.source_bone_count() + reader.target().character.skeleton.bones.size();
    source_.resize(count);
    target_.resize(count);
    overlap_.resize(count);
    gained_.resize(count);
  }

  void add(const WeightRow& expected, const WeightRow& actual) {
    for (const auto& [bone, weight] : expected) source_[bone] += weight;
    for (const auto& [bone, weight] : actual) target_[bone] += weight;
    for (const auto& [a, of_source] : expected)
      for (const auto& [b, of_target] : actual)
        sum_of(overlap_[a], b) += std::min(of_source, of_target);
    for (const auto& [a, of_source] : expected) {
      if (weight_of(actual, a) > 0.0) continue;
      for (const auto& [b, of_target] : actual)
        sum_of(gained_[a], b) += std::max(0.0, of_target - weight_of(expected, b));
    }
  }

  [[nodiscard]] double source(Index bone) const { return source_[bone]; }
  [[nodiscard]] double target(Index bone) const { return target_[bone]; }
  /// The share of the weight of a in the source that is b's weight in the target, both ways.
  [[nodiscard]] double agreement(Index a, Index b) const {
    const auto at = std::ranges::find(overlap_[a], b, &Sum::first);
    const double most = std::max(source_[a], target_[b]);
    return at == overlap_[a].end() || !(most > 0.0) ? 0.0 : at->second / most;
  }
  /// The bone that gained most where `a` lost its weight, and the share of that weight.
  [[nodiscard]] std::pair<Index, double> heir_of(Index a) const {
    Sum heir = {kNone, 0.0};
    for (const Sum& sum : gained_[a])
      if (sum.second > heir.second || (sum.second == heir.second && sum.first < heir.first))
        heir = sum;
    return {heir.first, source_[a] > 0.0 ? heir.second / source_[a] : 0.0};
  }
  [[nodiscard]] Index count() const { return static_cast<Index>(source_.size()); }

 private:
  /// A bone and a sum of weights. Few bones share vertices with one, so that a list is searched
  /// faster than a map.
  using Sum = std::pair<Index, double>;

  static double& sum_of(std::vector<Sum>& sums, Index bone) {
    const auto at = std::ranges::find(sums, bone, &Sum::first);
    return at != sums.end() ? at->second : sums.emplace_back(bone, 0.0).second;
  }

  std::vector<double> source_, target_;
  std::vector<std::vector<Sum>> overlap_, gained_;  // per bone
};

BoneMasses weigh_bones(const RowReader& reader) {
  BoneMasses masses(reader);
  WeightRow expected, actual;
  const auto& meshes = reader.target().character.meshes;
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    for (Index v = 0; v < meshes[mesh].vertex_count(); ++v) {
      const SurfaceMatch& match = reader.match(mesh, v);
      if (!match.is_accepted) continue;
      reader.expected(match, match.barycentric, expected);
      reader.actual(mesh, v, actual);
      masses.add(expected, actual);
    }
  return masses;
}

/// Vertices whose rows differ and whose match has weight of one of these bones.
Places places_of_bones(const RowReader& reader, std::span<const DifferentRow> rows,
                       const std::vector<bool>& chosen) {
  Places places;
  WeightRow expected;
  for (const DifferentRow& row : rows) {
    if (row.l1 <= kDiffers) continue;
    const SurfaceMatch& match = reader.match(row.mesh, row.vertex);
    reader.expected(match, match.barycentric, expected);
    double most = 0.0;
    Index bone = kNone;
    for (const auto& [of, weight] : expected)
      if (chosen[of] && weight > most) {
        most = weight;
        bone = reader.target_bone(of);
      }
    if (most > 0.0) places.push_back(reader.target().place(row.mesh, row.vertex, bone, most));
  }
  return places;
}

std::string name_of(const RowReader& reader, Index bone) {
  const Index count = reader.source_bone_count();
  return "'" +
         (bone < count ? reader.source().character.skeleton.bones[bone].name
                       : reader.target().character.skeleton.bones[bone - count].name) +
         "'";
}

void check_swapped(const RowReader& reader, std::span<const DifferentRow> rows,
                   const BoneMasses& masses, FindingList& findings) {
  const double least = kind_of(Code::bones_swapped).threshold;
  std::vector<bool> is_swapped(masses.count(), false);
  std::string pairs;
  for (Index a = 0; a < reader.source_bone_count(); ++a)
    for (Index b = a + 1; b < reader.source_bone_count(); ++b) {
      const double exchanged = std::min(masses.agreement(a, b), masses.agreement(b, a));
      const double kept = std::max(masses.agreement(a, a), masses.agreement(b, b));
      if (exchanged < least || kept > exchanged - 0.02) continue;
      is_swapped[a] = is_swapped[b] = true;
      pairs += (pairs.empty() ? "Exchanged: " : ", ") + name_of(reader, a) + " and " +
               name_of(reader, b);
    }
  findings.add(Code::bones_swapped, places_of_bones(reader, rows, is_swapped),
               pairs.empty() ? pairs : pairs + ".");
}

/// Whether some skin of the target has this bone in its first slot.
bool is_first_bone(const RowReader& reader, Index number) {
  const Index bone = reader.target_bone(number);
  return std::ranges::any_of(reader.target().character.skins,
                             [&](const Skin& skin) { return skin.bones.front() == bone; });
}

void check_moved(const RowReader& reader, std::span<const DifferentRow> rows,
                 const BoneMasses& masses, FindingList& findings) {
  std::vector<bool> is_moved(masses.count(), false);
  std::string pairs;
  for (Index a = 0; a < reader.source_bone_count(); ++a) {
    if (masses.source(a) < 1e-3 || masses.target(a) > 0.02 * masses.source(a)) continue;
    const auto [heir, share] = masses.heir_of(a);
    if (heir == kNone || share < kind_of(Code::moved_to_first).threshold) continue;
    if (masses.agreement(heir, a) > 0.9 || !is_first_bone(reader, heir)) continue;
    is_moved[a] = true;
    pairs +=
        (pairs.empty() ? "From " : ", from ") + name_of(reader, a) + " to " + name_of(reader, heir);
  }
  findings.add(Code::moved_to_first, places_of_bones(reader, rows, is_moved),
               pairs.empty() ? pairs : pairs + ".");
}

/// Weighted bones without a counterpart, of either model.
void check_missing(const RowReader& reader, FindingList& findings) {
  Places of_target, unused, fuzzy;
  const Skinned& target = reader.target();
  const auto& meshes = target.character.meshes;
  std::vector<bool> is_weighted(target.character.skeleton.bones.size(), false);
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    for (Index v = 0; v < meshes[mesh].vertex_count(); ++v)
      for (const Influence& influence : target.influences(mesh, v)) {
        const Index bone = target.bone(mesh, influence.slot);
        is_weighted[bone] = true;
        if (reader.bones().source_of_target[bone] == kNone && influence.weight > 0.0f)
          of_target.push_back(target.place(mesh, v, bone, static_cast<double>(influence.weight)));
      }
  for (Index bone = 0; bone < is_weighted.size(); ++bone) {
    FindingPlace place;
    place.bone = bone;
    place.value = 1.0;
    if (reader.bones().kind[bone] == BoneMatchKind::fuzzy) fuzzy.push_back(place);
    if (reader.bones().source_of_target[bone] == kNone && !is_weighted[bone])
      unused.push_back(place);
  }
  findings.add(Code::bone_missing, std::move(of_target));
  findings.add(Code::bone_fuzzy, std::move(fuzzy));
  findings.add(Code::bone_unused, std::move(unused));
}

/// Weighted bones of the source that the target's skeleton does not have.
void check_lost(const RowReader& reader, FindingList& findings) {
  const Skinned& source = reader.source();
  std::vector<double> mass(reader.source_bone_count(), 0.0);
  for (Index mesh = 0; mesh < source.character.meshes.size(); ++mesh)
    for (Index v = 0; v < source.character.meshes[mesh].vertex_count(); ++v)
      for (const Influence& influence : source.influences(mesh, v))
        mass[source.bone(mesh, influence.slot)] += static_cast<double>(influence.weight);
  std::string names;
  std::size_t count = 0;
  for (Index bone = 0; bone < mass.size(); ++bone)
    if (mass[bone] > 0.0 && reader.bones().target_of_source[bone] == kNone && ++count <= 8)
      names += (names.empty() ? "" : ", ") + name_of(reader, bone);
  if (count == 0) return;
  findings.add_finding(Code::bone_missing, Severity::error, Evidence::exact,
                       std::to_string(count) +
                           ": weighted bones of the source that the target does not have: " +
                           names + (count > 8 ? ", …" : "") + ".",
                       {}, static_cast<double>(count));
}

}  // namespace

void check_bones(const RowReader& reader, std::span<const DifferentRow> rows,
                 FindingList& findings) {
  check_missing(reader, findings);
  check_lost(reader, findings);
  const bool differs =
      std::ranges::any_of(rows, [](const DifferentRow& row) { return row.l1 > kDiffers; });
  if (!differs) {
    findings.add(Code::bones_swapped, {});
    findings.add(Code::moved_to_first, {});
    return;
  }
  const BoneMasses masses = weigh_bones(reader);
  check_swapped(reader, rows, masses, findings);
  check_moved(reader, rows, masses, findings);
}

}  // namespace sunder::validation
