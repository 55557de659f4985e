#include <sunder/binding/binding.h>

#include <algorithm>
#include <utility>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "pipeline/binding/attach.h"
#include "pipeline/binding/bone_pairs.h"
#include "pipeline/binding/joined.h"

namespace sunder {
namespace {

using binding::BoneWeight;
using binding::Joined;
using binding::WeightRow;

/// Per bone of a model: the number of its influences.
std::vector<std::uint32_t> count_influences(const Character& model) {
  std::vector<std::uint32_t> counts(model.skeleton.bones.size(), 0);
  for (const Mesh& mesh : model.meshes)
    for (const Influence& influence : mesh.weights.influences)
      ++counts[model.skins[mesh.skin].bones[influence.slot]];
  return counts;
}

/// Gives bones with weight but without a pair that of their nearest ancestor.
Status use_ancestors(const Joined& joined, const std::vector<std::uint32_t>& counts,
                     bool refuse_unmapped, std::vector<Index>& paired, MappedBinding& report) {
  const auto& bones = joined.model.skeleton.bones;
  const std::vector<Index> own = paired;
  for (Index i = 0; i < bones.size(); ++i) {  // parents come first
    if (own[i] == kNone && bones[i].parent != kNone) paired[i] = paired[bones[i].parent];
    if (counts[i] == 0 || own[i] != kNone) continue;
    if (refuse_unmapped || paired[i] == kNone)
      return Status::failure(StatusCode::not_found, i,
                             "bone %u '%.80s' has %u influences but no bone of the rig%s", i,
                             bones[i].name.c_str(), counts[i],
                             refuse_unmapped ? "" : ", nor has any of its ancestors");
    report.taken_by_ancestor.push_back({bones[i].name, joined.rig.skeleton.bones[paired[i]].name});
  }
  return {};
}

/// The weights of a vertex, those that go to one bone added up.
WeightRow mapped_row(std::span<const Influence> influences, const Skin& skin,
                     const std::vector<Index>& paired) {
  WeightRow row;
  for (const Influence& influence : influences) {
    const Index bone = paired[skin.bones[influence.slot]];
    const auto known = std::ranges::find(row, bone, &BoneWeight::bone);
    if (known == row.end())
      row.push_back({bone, static_cast<double>(influence.weight)});
    else
      known->weight += static_cast<double>(influence.weight);
  }
  return row;
}

void measure_pairs(const Joined& joined, const std::vector<std::uint32_t>& counts,
                   const std::vector<Index>& paired, MappedBinding& report) {
  for (Index i = 0; i < paired.size(); ++i) {
    if (counts[i] == 0 || paired[i] == kNone) continue;
    ++report.mapped_bones;
    const double distance = norm(Vec3d(joined.rig_from_model_bone[i].translation() -
                                       joined.rig_from_bone[paired[i]].translation()));
    if (distance <= report.farthest_distance && report.mapped_bones > 1) continue;
    report.farthest_distance = distance;
    report.farthest_pair = {joined.model.skeleton.bones[i].name,
                            joined.rig.skeleton.bones[paired[i]].name};
  }
}

Result<MappedBinding> map(const Character& model, const Character& rig,
                          std::span<const BonePair> pairs, const MappingOptions& options) {
  const Result<Joined> joined = binding::join(model, rig, options.place);
  if (!joined) return joined.error();
  Result<std::vector<Index>> paired = binding::rig_bones(model.skeleton, rig.skeleton, pairs);
  if (!paired) return paired.error();
  const std::vector<std::uint32_t> counts = count_influences(model);
  MappedBinding report;
  measure_pairs(*joined, counts, *paired, report);
  for (const BonePair& pair : pairs) {
    const auto bone = std::ranges::find(model.skeleton.bones, pair.model, &Bone::name);
    if (counts[static_cast<std::size_t>(bone - model.skeleton.bones.begin())] == 0)
      report.unused.push_back(pair.model);
  }
  if (const Status status =
          use_ancestors(*joined, counts, options.refuse_unmapped, *paired, report);
      !status)
    return status;
  std::vector<std::vector<WeightRow>> rows;
  for (const Mesh& mesh : model.meshes) {
    auto& of_mesh = rows.emplace_back();
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      of_mesh.push_back(mapped_row(mesh.weights.of(v), model.skins[mesh.skin], *paired));
  }
  Result<Binding> attached = binding::attach(*joined, rows, false);
  if (!attached) return attached.error();
  static_cast<Binding&>(report) = std::move(*attached);
  return report;
}

}  // namespace

Result<MappedBinding> bind_by_mapping(const Character& model, const Character& rig,
                                      std::span<const BonePair> pairs,
                                      const MappingOptions& options) {
  return or_out_of_memory([&] { return map(model, rig, pairs, options); });
}

}  // namespace sunder
