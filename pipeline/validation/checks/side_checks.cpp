#include "pipeline/validation/checks/side_checks.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "core/internal/bone_sides.h"
#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "pipeline/validation/checks/inherited.h"
#include "pipeline/validation/match/position_table.h"

namespace sunder::validation {
namespace {

constexpr double kBeyond = 0.05;  ///< Of the diagonal, from the mirror plane.

/// A name without what tells its side, so that both bones of a pair have the same: small letters
/// only, "left", "right" and single l and r at the borders of words removed.
std::string name_without_side(const std::string& name) {
  std::string words;  // small letters; a space where a word begins
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool is_word = std::isalnum(c) != 0;
    const bool begins = is_word && std::isupper(c) != 0 && i > 0 &&
                        std::islower(static_cast<unsigned char>(name[i - 1])) != 0;
    if (!is_word || begins) words += ' ';
    if (is_word) words += static_cast<char>(std::tolower(c));
  }
  std::string rest, word;
  const auto finish = [&] {
    for (const char* const side : {"left", "right"})
      if (const auto at = word.find(side); at != std::string::npos)
        word.erase(at, std::string(side).size());
    if (word != "l" && word != "r") rest += word + ' ';
    word.clear();
  };
  for (const char c : words)
    if (c == ' ')
      finish();
    else
      word += c;
  finish();
  return rest;
}

/// Pairs of bones whose names differ only in their side.
std::vector<std::pair<Index, Index>> find_pairs(const Skeleton& skeleton) {
  std::map<std::string, std::array<Index, 2>> by_name;
  for (Index bone = 0; bone < skeleton.bones.size(); ++bone) {
    const std::string& name = skeleton.bones[bone].name;
    const int side = side_of_name(name);
    if (side == 0) continue;
    auto& pair =
        by_name.try_emplace(name_without_side(name), std::array{kNone, kNone}).first->second;
    pair[side < 0 ? 0 : 1] = bone;
  }
  std::vector<std::pair<Index, Index>> pairs;
  for (const auto& [name, pair] : by_name)
    if (pair[0] != kNone && pair[1] != kNone) pairs.emplace_back(pair[0], pair[1]);
  return pairs;
}

}  // namespace

MirrorPlane find_mirror_plane(const Skinned& skin) {
  const Skeleton& skeleton = skin.character.skeleton;
  const auto pairs = find_pairs(skeleton);
  const ModelPose bind = or_throw(bind_pose(skin.character));
  MirrorPlane plane;
  plane.side_of_bone.assign(skeleton.bones.size(), 0);
  for (Index bone = 0; bone < skeleton.bones.size(); ++bone) plane.mirrored_bone.push_back(bone);
  Vec3d across = Vec3d::Zero(), middle = Vec3d::Zero();
  for (const auto& [left, right] : pairs) {
    const Vec3d l = bind.model_from_bone[left].translation(),
                r = bind.model_from_bone[right].translation();
    across += l - r;
    middle += 0.5 * (l + r);
    plane.side_of_bone[left] = -1;
    plane.side_of_bone[right] = 1;
    plane.mirrored_bone[left] = right;
    plane.mirrored_bone[right] = left;
  }
  if (!(norm(across) > 1e-3 * skin.surface.diagonal)) return plane;
  plane.point = middle / static_cast<double>(pairs.size());
  const Vec3d normal = normalized(across);
  for (const auto& [left, right] : pairs) {
    const Vec3d l = bind.model_from_bone[left].translation(),
                r = bind.model_from_bone[right].translation();
    const double off = std::abs(dot(0.5 * (l + r) - plane.point, normal));
    if (off > kBeyond * skin.surface.diagonal) return plane;  // not symmetric
  }
  plane.normal = normal;
  return plane;
}

namespace {

/// Vertices clearly on one side that follow a bone of the other side.
Places find_wrong_sides(const Skinned& skin, const MirrorPlane& plane) {
  const double beyond = kBeyond * skin.surface.diagonal,
               least = kind_of(Code::wrong_side).threshold;
  Places places;
  for (Index mesh = 0; mesh < skin.character.meshes.size(); ++mesh)
    for (Index v = 0; v < skin.character.meshes[mesh].vertex_count(); ++v) {
      const Vec3d& place = skin.surface.positions[skin.surface.first_vertex[mesh] + v];
      const double height = dot(place - plane.point, plane.normal);
      if (std::abs(height) < beyond) continue;
      FindingPlace worst = skin.place(mesh, v, kNone, 0.0);
      for (const Influence& influence : skin.influences(mesh, v)) {
        const Index bone = skin.bone(mesh, influence.slot);
        const auto weight = static_cast<double>(influence.weight);
        if (weight <= worst.value || plane.side_of_bone[bone] != (height > 0 ? 1 : -1)) continue;
        worst.bone = bone;
        worst.value = weight;
      }
      if (worst.value >= least) places.push_back(worst);
    }
  return places;
}

/// Vertices whose mirrored counterpart, if there is one at the very place, has other weights than
/// the mirrored ones.
Places find_asymmetry(const Skinned& skin, const MirrorPlane& plane) {
  const double grain = 1e-4 * skin.surface.diagonal;
  const auto rounded = [&](const Vec3d& place) {
    return Vec3d((place / grain).array().round().matrix());
  };
  PositionTable table(skin.surface.positions.size());
  for (Index v = 0; v < skin.surface.vertex_count(); ++v)
    table.insert(rounded(skin.surface.positions[v]), v);
  Places places;
  std::map<Index, double> row;
  for (Index v = 0; v < skin.surface.vertex_count(); ++v) {
    const Index mesh = skin.surface.mesh_of_vertex(v);
    const Vec3d& place = skin.surface.positions[v];
    const Vec3d image = place - 2.0 * dot(place - plane.point, plane.normal) * plane.normal;
    double least = 2.0;
    table.find(rounded(image), [&](Index other) {
      const Index of = skin.surface.mesh_of_vertex(other);
      row.clear();
      for (const Influence& in : skin.influences(mesh, v - skin.surface.first_vertex[mesh]))
        row[plane.mirrored_bone[skin.bone(mesh, in.slot)]] += static_cast<double>(in.weight);
      for (const Influence& in : skin.influences(of, other - skin.surface.first_vertex[of]))
        row[skin.bone(of, in.slot)] -= static_cast<double>(in.weight);
      double l1 = 0.0;
      for (const auto& [bone, weight] : row) l1 += std::abs(weight);
      least = std::min(least, l1);
      return false;
    });
    if (least < 2.0 && least > kind_of(Code::symmetry).threshold)
      places.push_back(skin.place(v, kNone, least));
  }
  return places;
}

/// Lips whose weights are those of the other lip's surroundings: the row of another vertex of the
/// source at the same place, with another tear side.
Places find_across_tears(const RowReader& reader) {
  const Skinned &source = reader.source(), &target = reader.target();
  PositionTable table(source.surface.positions.size());
  for (Index v = 0; v < source.surface.vertex_count(); ++v)
    if (source.surface.triangle_of_vertex[v] != kNone) table.insert(source.surface.positions[v], v);
  Places places;
  WeightRow actual, expected, other_row;
  for (Index v = 0; v < target.surface.vertex_count(); ++v) {
    if (target.surface.tear_side[v] == 0.0f) continue;
    const Index mesh = target.surface.mesh_of_vertex(v),
                own = v - target.surface.first_vertex[mesh];
    const SurfaceMatch& match = reader.match(mesh, own);
    if (!match.is_accepted) continue;
    reader.actual(mesh, own, actual);
    reader.expected(match, match.barycentric, expected);
    const double l1 = distance(actual, expected);
    if (l1 <= kind_of(Code::across_tear).threshold) continue;
    table.find(target.surface.positions[v], [&](Index other) {
      if (source.surface.tear_side[other] == target.surface.tear_side[v]) return false;
      const Index of = source.surface.mesh_of_vertex(other);
      other_row.clear();
      for (const Influence& in : source.influences(of, other - source.surface.first_vertex[of]))
        other_row.push_back({source.bone(of, in.slot), static_cast<double>(in.weight)});
      std::ranges::sort(other_row, {}, &BoneWeight::bone);
      const bool is_across = distance(actual, other_row) < 0.5 * l1;
      if (is_across) places.push_back(target.place(mesh, own, kNone, l1));
      return is_across;
    });
  }
  return places;
}

}  // namespace

void check_sides(const RowReader& reader, FindingList& findings) {
  const Skinned& target = reader.target();
  const MirrorPlane plane = find_mirror_plane(target);
  if (plane.normal.isZero(0)) {
    findings.not_tested(Code::wrong_side, "no symmetric pairs of left and right bones");
    findings.not_tested(Code::symmetry, "no symmetric pairs of left and right bones");
  } else {
    add_new_weights(reader, Code::wrong_side, find_wrong_sides(target, plane), findings);
    add_new_weights(reader, Code::symmetry, find_asymmetry(target, plane), findings);
  }
  if (std::ranges::all_of(reader.source().surface.tear_side, [](float side) { return side == 0; }))
    findings.not_tested(Code::across_tear, "the source has no tear");
  else
    findings.add(Code::across_tear, find_across_tears(reader));
}

}  // namespace sunder::validation
