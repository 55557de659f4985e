#include "pipeline/validation/transfer/target_bones.h"

#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "pipeline/validation/match/bind_surface.h"

namespace sunder::validation {
namespace {

/// Per bone: whether it has weight in any vertex.
std::vector<bool> weighted_bones(const Character& character) {
  std::vector<bool> is_weighted(character.skeleton.bones.size(), false);
  for (const Mesh& mesh : character.meshes)
    for (const Influence& influence : mesh.weights.influences)
      is_weighted[character.skins[mesh.skin].bones[influence.slot]] = true;
  return is_weighted;
}

/// Per bone: whether a skin names it or a descendant of it.
std::vector<bool> skinned_trees(const Character& character) {
  std::vector<bool> is_needed(character.skeleton.bones.size(), false);
  for (const Skin& skin : character.skins)
    for (const Index bone : skin.bones) is_needed[bone] = true;
  for (Index bone = static_cast<Index>(is_needed.size()); bone-- > 0;)
    if (const Index parent = character.skeleton.bones[bone].parent;
        is_needed[bone] && parent != kNone)
      is_needed[parent] = true;
  return is_needed;
}

void adopt(const Character& source, TargetBones& bones) {
  std::set<std::string> names;
  for (const Bone& bone : bones.skeleton.bones) names.insert(bone.name);
  const std::vector<bool> is_needed = skinned_trees(source);
  const ModelPose bind = or_throw(bind_pose(source));
  bones.has_adopted = true;
  for (Index i = 0; i < source.skeleton.bones.size(); ++i) {
    if (!is_needed[i]) continue;
    Bone bone = source.skeleton.bones[i];
    if (bone.parent != kNone) bone.parent = bones.of_source[bone.parent];
    for (int n = 2; !names.insert(bone.name).second; ++n)
      bone.name = source.skeleton.bones[i].name + "." + std::to_string(n);
    bones.of_source[i] = bones.counterparts[i] = static_cast<Index>(bones.skeleton.bones.size());
    bones.skeleton.bones.push_back(std::move(bone));
    bones.model_from_bone.push_back(bind.model_from_bone[i]);
  }
}

void use_counterparts(const Character& source, const BoneMatch& match,
                      const std::vector<bool>& is_weighted, TargetBones& bones) {
  bones.counterparts = match.target_of_source;
  Index first = kNone;
  for (const Index counterpart : match.target_of_source)
    if (first == kNone) first = counterpart;
  for (Index i = 0; i < source.skeleton.bones.size(); ++i) {
    const Index parent = source.skeleton.bones[i].parent;
    bones.of_source[i] = match.target_of_source[i];
    if (bones.of_source[i] != kNone) continue;
    if (is_weighted[i]) bones.lost.push_back(i);
    bones.of_source[i] = parent == kNone ? first : bones.of_source[parent];
  }
}

/// The matrix by which a skin carries a mesh into model space at bind: that of its first slot.
Affine3d model_from_mesh(const Skin& skin, const TargetBones& bones) {
  return multiply(bones.model_from_bone[skin.bones[0]],
                  Affine3d(skin.bone_from_bind[0].cast<double>()));
}

/// The bones that move the vertices of a mesh after a transfer.
void add_wanted(const Mesh& mesh, const Skin& skin, const std::vector<WeightRow>& rows,
                std::set<Index>& wanted) {
  for (Index v = 0; v < rows.size(); ++v) {
    for (const BoneWeight& entry : rows[v])
      if (static_cast<float>(entry.weight) > 0.0f) wanted.insert(entry.bone);
    if (rows[v].empty())
      for (const Influence& influence : mesh.weights.of(v))
        wanted.insert(skin.bones[influence.slot]);
  }
}

/// The skin with slots for all bones wanted. A skin of one bone, that of a rigid mesh, loses it
/// where it is no longer needed, because it may stand in another tree.
Skin extended_skin(const Skin& skin, const TargetBones& bones, std::set<Index> wanted) {
  Skin extended = skin;
  for (const Index bone : skin.bones)
    if (wanted.erase(bone) == 0 && skin.bones.size() == 1 && !wanted.empty())
      extended = {skin.name, {}, {}};
  const Affine3d of_mesh = model_from_mesh(skin, bones);
  for (const Index bone : wanted) {
    extended.bones.push_back(bone);
    const Affine3d bone_from_bind = multiply(inverse(bones.model_from_bone[bone]), of_mesh);
    extended.bone_from_bind.push_back(Affine3f(bone_from_bind.cast<float>()));
  }
  return extended;
}

void write_mesh(const Skin& skin, const std::vector<WeightRow>& rows, Mesh& mesh) {
  std::map<Index, Index> slot_of;
  for (Index slot = 0; slot < skin.bones.size(); ++slot)
    slot_of.try_emplace(skin.bones[slot], slot);
  SkinWeights written;
  std::vector<Influence> influences;
  for (Index v = 0; v < rows.size(); ++v) {
    influences.clear();
    for (const BoneWeight& entry : rows[v])
      if (const auto weight = static_cast<float>(entry.weight); weight > 0.0f)
        influences.push_back({slot_of.at(entry.bone), weight});
    (void)sort_influences(influences);
    written.append(influences.empty() ? mesh.weights.of(v) : influences);
  }
  mesh.weights = std::move(written);
}

}  // namespace

TargetBones choose_bones(const Character& source, const Character& target, const BoneMatch& match) {
  TargetBones bones{target.skeleton, or_throw(bind_pose(target)).model_from_bone, {}, {}, {}};
  bones.of_source.assign(source.skeleton.bones.size(), kNone);
  bones.counterparts = bones.of_source;
  const std::vector<bool> in_source = weighted_bones(source), in_target = weighted_bones(target);
  // The skeleton is the source's if it has all bones that the source's weights need, or if its own
  // weights are on some of them; one bone of the same name is not enough.
  bool keeps = true;
  for (Index i = 0; i < in_source.size(); ++i)
    keeps = keeps && (!in_source[i] || match.target_of_source[i] != kNone);
  for (Index i = 0; i < in_target.size(); ++i)
    keeps |=
        in_target[i] && match.source_of_target[i] != kNone && in_source[match.source_of_target[i]];
  if (keeps)
    use_counterparts(source, match, in_source, bones);
  else
    adopt(source, bones);
  return bones;
}

std::vector<WeightRow> rows_of(const Character& character, Index mesh,
                               const std::vector<Index>& bone_of) {
  const Mesh& of = character.meshes[mesh];
  const Skin& skin = character.skins[of.skin];
  std::vector<WeightRow> rows(of.vertex_count());
  for (Index v = 0; v < of.vertex_count(); ++v) {
    WeightRow& row = rows[v];
    for (const Influence& influence : of.weights.of(v)) {
      const Index bone = skin.bones[influence.slot];
      row.push_back(
          {bone_of.empty() ? bone : bone_of[bone], static_cast<double>(influence.weight)});
    }
    std::ranges::stable_sort(row, {}, &BoneWeight::bone);
    std::size_t last = 0;
    for (std::size_t i = 1; i < row.size(); ++i) {
      if (row[i].bone == row[last].bone)
        row[last].weight += row[i].weight;
      else
        row[++last] = row[i];
    }
    if (!row.empty()) row.resize(last + 1);
    normalise(row);
  }
  return rows;
}

void write_rows(const TargetBones& bones, const std::vector<std::vector<WeightRow>>& rows,
                Character& character) {
  const auto skin_count = static_cast<Index>(character.skins.size());
  std::vector<std::set<Index>> wanted(skin_count);
  for (Index m = 0; m < character.meshes.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    add_wanted(mesh, character.skins[mesh.skin], rows[m], wanted[mesh.skin]);
  }
  std::vector<Index> new_skin;
  for (Index i = 0; i < skin_count; ++i) {
    new_skin.push_back(i);
    Skin skin = extended_skin(character.skins[i], bones, wanted[i]);
    if (skin == character.skins[i]) continue;
    new_skin[i] = static_cast<Index>(character.skins.size());
    character.skins.push_back(std::move(skin));
  }
  for (Index m = 0; m < character.meshes.size(); ++m) {
    Mesh& mesh = character.meshes[m];
    mesh.skin = new_skin[mesh.skin];
    write_mesh(character.skins[mesh.skin], rows[m], mesh);
  }
}

}  // namespace sunder::validation
