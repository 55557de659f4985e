#include "io/gltf_patch/repair_document.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "io/gltf_patch/clip_patch.h"
#include "io/gltf_patch/document_rules.h"
#include "io/gltf_patch/draft_source.h"
#include "io/gltf_patch/repair_images.h"
#include "io/gltf_patch/repair_meshes.h"
#include "io/gltf_patch/repair_nodes.h"
#include "io/gltf_patch/separate_views.h"
#include "io/gltf_patch/sound_animations.h"
#include "io/gltf_patch/sound_primitives.h"
#include "io/gltf_write/rig_writer.h"

namespace sunder::gltf {
namespace {

/// The last row of inverse bind matrices must be exact.
bool are_binds_sound(const Json& skin, SoundAccessors& accessors) {
  const auto accessor = accessors.open(skin["inverseBindMatrices"]);
  if (!accessor || accessors.type(*accessor) != "MAT4" || accessor->is_integer() ||
      accessors.has_stride(*accessor) || accessor->count < skin["joints"].size())
    return false;
  const auto numbers = accessors.floats(*accessor);
  if (!numbers) return false;
  for (std::size_t first = 0; first < numbers->size(); first += 16)
    if ((*numbers)[first + 3] != 0.0f || (*numbers)[first + 7] != 0.0f ||
        (*numbers)[first + 11] != 0.0f || (*numbers)[first + 15] != 1.0f)
      return false;
  accessors.correct_bounds(accessor->index, false);
  return true;
}

}  // namespace

std::vector<std::uint32_t> uses_of_meshes(const Json& document) {
  std::vector<std::uint32_t> uses(count_of(document, "meshes"), 0);
  const auto nodes = document.find("nodes");
  if (nodes == document.end()) return uses;
  for (const Json& node : *nodes)
    if (const auto mesh = node.find("mesh"); mesh != node.end()) ++uses[mesh->get<std::size_t>()];
  return uses;
}

DocumentRepair::DocumentRepair(GlbDraft& draft, const Character& character,
                               const SourceDocument& source)
    : draft_(draft), character_(character), source_(source) {}

std::vector<bool> DocumentRepair::prepare(const std::vector<bool>& are_new) {
  std::vector<bool> unsound(character_.meshes.size(), false);
  enforce_schema(draft_.json);
  separate_views(draft_.json);
  check_primitives(&are_new, unsound);
  return unsound;
}

/// Per mesh of the document, the number of joints of the smallest skin with which a node uses it.
std::vector<std::uint32_t> DocumentRepair::least_joints() {
  std::vector<std::uint32_t> least(count_of(draft_.json, "meshes"), kNone);
  if (!draft_.json.contains("nodes")) return least;
  for (const Json& node : draft_.json["nodes"]) {
    if (!node.contains("mesh") || !node.contains("skin")) continue;
    std::uint32_t& count = least[node["mesh"].get<std::size_t>()];
    const Json& skin = draft_.json["skins"][node["skin"].get<std::size_t>()];
    count = std::min(count, static_cast<std::uint32_t>(skin["joints"].size()));
  }
  return least;
}

/// Flags meshes of the character whose primitives have faults, and removes other primitives that
/// do.
/// @param are_new  as for prepare(); null: the character's meshes are written already.
void DocumentRepair::check_primitives(const std::vector<bool>* are_new,
                                      std::vector<bool>& unsound_meshes) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> owners;
  for (std::size_t mesh = 0; are_new != nullptr && mesh < source_.mesh_origins.size(); ++mesh)
    for (const std::uint32_t primitive : source_.mesh_origins[mesh].primitives)
      owners[{source_.mesh_origins[mesh].mesh, primitive}].push_back(mesh);
  const std::vector<std::uint32_t> least = least_joints(), uses = uses_of_meshes(draft_.json);
  // Each owner is the mesh of another node.
  const auto is_replaced = [&](const std::vector<std::size_t>& meshes, std::size_t mesh) {
    return meshes.size() == uses[mesh] &&
           std::all_of(meshes.begin(), meshes.end(), [&](auto one) { return (*are_new)[one]; });
  };
  DraftSource draft(draft_);
  SoundAccessors accessors(draft.document());
  SoundPrimitives primitives(draft.json(), accessors);
  for (std::size_t mesh = 0; mesh < least.size(); ++mesh) {
    Json& at = draft.json()["meshes"][mesh];
    if (!at.contains("primitives")) continue;
    for (std::size_t i = 0; i < at["primitives"].size(); ++i) {
      Json& primitive = at["primitives"][i];
      const auto of_character = owners.find({mesh, i});
      if (of_character != owners.end() && is_replaced(of_character->second, mesh)) continue;
      if (primitives.is_sound(primitive, least[mesh])) continue;
      has_unsound_primitives_ = true;
      if (of_character == owners.end())
        primitive = nullptr;
      else
        for (const std::size_t owner : of_character->second) unsound_meshes[owner] = true;
    }
  }
}

void DocumentRepair::finish() {
  std::vector<bool> ignored;
  if (has_unsound_primitives_) check_primitives(nullptr, ignored);
  repair_meshes(draft_.json);
  repair_binds();
  repair_nodes(draft_.json);
  repair_animations();
  empty_unsound_accessors();
  remove_empty_animations();
  repair_images(draft_);
}

void DocumentRepair::repair_binds() {
  if (!draft_.json.contains("skins")) return;
  std::set<std::size_t> unsound;
  {
    DraftSource draft(draft_);
    SoundAccessors accessors(draft.document());
    const Json& skins = draft.json()["skins"];
    for (std::size_t i = 0; i < skins.size(); ++i)
      if (skins[i].contains("inverseBindMatrices") && !are_binds_sound(skins[i], accessors))
        unsound.insert(i);
  }
  if (unsound.empty()) return;
  for (const std::size_t skin : unsound) draft_.json["skins"][skin].erase("inverseBindMatrices");
  for (std::size_t mesh = 0; mesh < character_.meshes.size(); ++mesh) {
    const Json& node = draft_.json["nodes"][source_.mesh_origins[mesh].node];
    if (!source_.mesh_origins[mesh].skinned || !node.contains("skin")) continue;
    const auto skin = node["skin"].get<std::size_t>();
    if (unsound.erase(skin) != 0)
      draft_.json["skins"][skin]["inverseBindMatrices"] =
          add_bind_matrices(draft_, character_.skins[character_.meshes[mesh].skin]);
  }
}

void DocumentRepair::repair_animations() {
  if (!draft_.json.contains("animations")) return;
  std::vector<std::size_t> unsound;
  {
    DraftSource draft(draft_);
    SoundAccessors accessors(draft.document());
    const Json& animations = draft.json()["animations"];
    for (std::size_t i = 0; i < animations.size(); ++i)
      if (!animations[i].is_null() && !is_animation_sound(animations[i], draft.json(), accessors))
        unsound.push_back(i);
  }
  for (const std::size_t i : unsound) {
    Json rebuilt = ClipPatch(draft_, character_, source_, source_.node_of_bone)
                       .animation_of(character_.clips[i], draft_.json["animations"][i]);
    draft_.json["animations"][i] = std::move(rebuilt);
  }
}

void DocumentRepair::remove_empty_animations() {
  if (!draft_.json.contains("animations")) return;
  Json kept = Json::array();
  for (Json& animation : draft_.json["animations"])
    if (!animation.is_null()) kept.push_back(std::move(animation));
  if (kept.empty())
    draft_.json.erase("animations");
  else
    draft_.json["animations"] = std::move(kept);
}

/// Accessors that nothing uses any more must be valid all the same.
void DocumentRepair::empty_unsound_accessors() {
  const std::vector<bool> used = used_accessors(draft_.json);
  DraftSource draft(draft_);
  SoundAccessors accessors(draft.document());
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) continue;
    const auto accessor = accessors.open(Json(i));
    if (accessor && (accessor->is_integer() || accessors.is_finite(*accessor)))
      accessors.correct_bounds(static_cast<std::uint32_t>(i), false);
    else
      draft.json()["accessors"][i] = empty_entry("accessors");
  }
}

}  // namespace sunder::gltf
