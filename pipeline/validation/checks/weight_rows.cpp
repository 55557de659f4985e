#include "pipeline/validation/checks/weight_rows.h"

#include <algorithm>

namespace sunder::validation {
namespace {

constexpr double kRounding = 1e-6;
constexpr double kCorner = 1 - 1e-5;

void add(WeightRow& row, Index bone, double weight) {
  const auto at =
      std::lower_bound(row.begin(), row.end(), bone,
                       [](const BoneWeight& entry, Index of) { return entry.bone < of; });
  if (at != row.end() && at->bone == bone)
    at->weight += weight;
  else
    row.insert(at, {bone, weight});
}

}  // namespace

double weight_of(const WeightRow& row, Index bone) {
  const auto at =
      std::lower_bound(row.begin(), row.end(), bone,
                       [](const BoneWeight& entry, Index of) { return entry.bone < of; });
  return at != row.end() && at->bone == bone ? at->weight : 0.0;
}

std::size_t corner_of(const SurfaceMatch& match) {
  for (std::size_t k = 0; k < 3; ++k)
    if (match.barycentric[k] >= kCorner) return k;
  return 3;
}

RowReader::RowReader(const Skinned& source, const Skinned& target, const SurfaceMatches& matches,
                     const BoneMatch& bones, const Character* replayed)
    : source_(source), target_(target), matches_(matches), bones_(bones), replayed_(replayed) {
  for (const Skin& of_target : target.character.skins) {
    auto& row = same_slots_.emplace_back();
    for (const Skin& of_source : source.character.skins) {
      bool same = of_target.bones.size() == of_source.bones.size();
      for (std::size_t slot = 0; same && slot < of_target.bones.size(); ++slot)
        same = bones.source_of_target[of_target.bones[slot]] == of_source.bones[slot];
      row.push_back(same);
    }
  }
}

void RowReader::actual(Index mesh, Index vertex, WeightRow& row) const {
  row.clear();
  for (const Influence& influence : target_.influences(mesh, vertex)) {
    const Index bone = target_.bone(mesh, influence.slot);
    const Index in_source = bones_.source_of_target[bone];
    add(row, in_source != kNone ? in_source : source_bone_count() + bone,
        static_cast<double>(influence.weight));
  }
}

void RowReader::expected(const SurfaceMatch& match, const std::array<double, 3>& barycentric,
                         WeightRow& row) const {
  row.clear();
  const Triangle& triangle = source_.character.meshes[match.mesh].triangles[match.triangle];
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(barycentric[k] > 0)) continue;
    for (const Influence& influence : source_.influences(match.mesh, triangle[k]))
      add(row, source_.bone(match.mesh, influence.slot),
          barycentric[k] * static_cast<double>(influence.weight));
  }
}

bool RowReader::expected_at(Index mesh, Index vertex, WeightRow& row) const {
  const SurfaceMatch& of = match(mesh, vertex);
  if (of.is_accepted) {
    expected(of, of.barycentric, row);
    return true;
  }
  if (replayed_ == nullptr) return false;
  row.clear();
  const Mesh& played = replayed_->meshes[mesh];
  for (const Influence& influence : played.weights.of(vertex))
    add(row, replayed_->skins[played.skin].bones[influence.slot],
        static_cast<double>(influence.weight));
  return true;
}

bool RowReader::is_same(Index mesh, Index vertex) const {
  const SurfaceMatch& of = match(mesh, vertex);
  std::size_t corner = 0;
  while (corner < 3 && of.barycentric[corner] != 1.0) ++corner;
  if (corner == 3) return false;
  const Mesh& source_mesh = source_.character.meshes[of.mesh];
  if (!same_slots_[target_.character.meshes[mesh].skin][source_mesh.skin]) return false;
  const auto a = target_.influences(mesh, vertex),
             b = source_.influences(of.mesh, source_mesh.triangles[of.triangle][corner]);
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

Index RowReader::target_bone(Index number) const {
  return number >= source_bone_count() ? number - source_bone_count()
                                       : bones_.target_of_source[number];
}

std::vector<DifferentRow> find_different_rows(const RowReader& reader) {
  std::vector<DifferentRow> rows;
  WeightRow actual, expected;
  const auto& meshes = reader.target().character.meshes;
  for (Index mesh = 0; mesh < meshes.size(); ++mesh)
    for (Index v = 0; v < meshes[mesh].vertex_count(); ++v) {
      const SurfaceMatch& match = reader.match(mesh, v);
      if (!match.is_accepted || reader.is_same(mesh, v)) continue;
      reader.actual(mesh, v, actual);
      reader.expected(match, match.barycentric, expected);
      const double l1 = distance(actual, expected);
      if (l1 > kRounding) rows.push_back({mesh, v, l1});
    }
  return rows;
}

}  // namespace sunder::validation
