#include "weights/certificate/skin_rows.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "core/internal/ordered.h"

namespace sunder {
namespace certificate {

namespace {

double sum_of(std::span<const Influence> influences) {
  double sum = 0;
  for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
  return sum;
}

}  // namespace

void add_point(const Skin& skin, const ModelPose& bind, const Vec3d& position,
               std::span<const Influence> influences, double share, std::vector<SkinTerm>& terms) {
  const double sum = sum_of(influences);
  for (const Influence& influence : influences) {
    const double m = share * (static_cast<double>(influence.weight) / sum);
    const std::uint32_t bone = skin.bones[influence.slot];
    const Vec3d in_bone = transform(skin.bone_from_bind[influence.slot].cast<double>(), position);
    terms.push_back({bone, m, Vec3d(m * transform(bind.model_from_bone[bone], in_bone))});
  }
}

void merge_terms(std::vector<SkinTerm>& terms) {
  std::stable_sort(terms.begin(), terms.end(),
                   [](const SkinTerm& a, const SkinTerm& b) { return a.bone < b.bone; });
  std::size_t count = 0;
  for (std::size_t i = 0; i < terms.size();) {
    SkinTerm sum = terms[i];
    for (++i; i < terms.size() && terms[i].bone == sum.bone; ++i) {
      sum.m += terms[i].m;
      sum.x += terms[i].x;
    }
    if (sum.m != 0 || !sum.x.isZero(0)) terms[count++] = sum;
  }
  terms.resize(count);
}

Status check_vertex(const Character& character, std::uint32_t mesh, std::uint32_t vertex) {
  const Mesh& of = character.meshes[mesh];
  const Skin& skin = character.skins[of.skin];
  const std::size_t bones = character.skeleton.bones.size();
  if (vertex >= of.vertex_count() || vertex >= of.weights.vertex_count())
    return Status::failure(StatusCode::index_out_of_range, vertex, "vertex %u: the mesh has %u",
                           vertex, of.vertex_count());
  double sum = 0;
  for (const Influence& influence : of.weights.of(vertex)) {
    if (influence.slot >= skin.bones.size() || skin.bones[influence.slot] >= bones)
      return Status::failure(StatusCode::index_out_of_range, vertex,
                             "vertex %u: slot %u of %zu names no bone of %zu", vertex,
                             influence.slot, skin.bones.size(), bones);
    if (!(influence.weight >= 0)) sum = std::nan("");
    sum += static_cast<double>(influence.weight);
  }
  if (!(sum > 0) || !std::isfinite(sum))
    return Status::failure(StatusCode::weights_not_normalized, vertex,
                           "vertex %u: its weights sum to %g", vertex, sum);
  return {};
}

Status check_mesh(const Character& character, const ModelPose& bind, std::uint32_t mesh) {
  const std::size_t bones = character.skeleton.bones.size();
  if (bind.model_from_bone.size() != bones)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the bind pose has %zu bones, the skeleton %zu",
                           bind.model_from_bone.size(), bones);
  if (mesh >= character.meshes.size() || character.meshes[mesh].skin >= character.skins.size())
    return Status::failure(StatusCode::index_out_of_range, mesh,
                           "mesh %u: the model has %zu meshes and %zu skins", mesh,
                           character.meshes.size(), character.skins.size());
  const Skin& skin = character.skins[character.meshes[mesh].skin];
  if (skin.bone_from_bind.size() != skin.bones.size())
    return Status::failure(StatusCode::size_mismatch, mesh,
                           "mesh %u: its skin has %zu bones and %zu bind matrices", mesh,
                           skin.bones.size(), skin.bone_from_bind.size());
  return {};
}

}  // namespace certificate

Status append_difference(const Character& character, const ModelPose& bind, std::uint32_t mesh,
                         std::span<const VertexShare> shares, SkinDifferences& differences) {
  using namespace certificate;
  if (const Status status = check_mesh(character, bind, mesh); !status) return status;
  const Mesh& of = character.meshes[mesh];
  const Skin& skin = character.skins[of.skin];
  for (const VertexShare& share : shares)
    if (const Status status = check_vertex(character, mesh, share.vertex); !status) return status;
  try {
    std::vector<SkinTerm> terms;
    double divided = 0;
    for (const VertexShare& share : shares) {
      divided += share.share * (sum_of(of.weights.of(share.vertex)) - 1.0);
      add_point(skin, bind, of.positions[share.vertex].cast<double>(), of.weights.of(share.vertex),
                share.share, terms);
    }
    merge_terms(terms);
    differences.first.reserve(differences.first.size() + 1);
    differences.terms.insert(differences.terms.end(), terms.begin(), terms.end());
    differences.first.push_back(static_cast<std::uint32_t>(differences.terms.size()));
    differences.divided_sum = std::max(differences.divided_sum, std::abs(divided));
    return {};
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

}  // namespace sunder
