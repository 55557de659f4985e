#include "io/gltf_patch/write.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <map>
#include <set>

#include "io/gltf/container.h"
#include "io/gltf/glb.h"
#include "io/gltf/refusal.h"
#include "io/gltf_patch/clip_patch.h"
#include "io/gltf_patch/leave_out_unused.h"
#include "io/gltf_patch/repair_document.h"
#include "io/gltf_write/appended_materials.h"
#include "io/gltf_write/lists.h"
#include "io/gltf_write/mesh_writer.h"
#include "io/gltf_write/rig_writer.h"
#include "io/gltf_write/torn_record.h"

namespace sunder::gltf {
namespace {

using Origin = SourceDocument::MeshOrigin;

template <class T>
bool begins_with(const std::vector<T>& list, const std::vector<T>& beginning) {
  return list.size() >= beginning.size() &&
         std::equal(beginning.begin(), beginning.end(), list.begin());
}

/// A node has one skin, also where its primitives became several meshes.
void check_skins_of_nodes(const Character& character, const Character& before,
                          const SourceDocument& source) {
  std::map<std::uint32_t, std::uint32_t> first_on_node;
  for (std::uint32_t i = 0; i < character.meshes.size(); ++i) {
    const auto [first, is_new] = first_on_node.try_emplace(source.mesh_origins[i].node, i);
    const bool has_changed =
        character.meshes[i].skin != before.meshes[i].skin ||
        character.meshes[first->second].skin != before.meshes[first->second].skin;
    if (has_changed && character.meshes[i].skin != character.meshes[first->second].skin)
      refuse(StatusCode::invalid_argument, i,
             "save_glb: meshes %u and %u are of one node, but have different skins", first->second,
             i);
  }
}

/// Morph targets may be appended to a mesh. Its weights may then be elsewhere, and are those of all
/// meshes of its node.
void check_morph_targets(const Character& character, const Character& before,
                         const SourceDocument& source) {
  std::map<std::uint32_t, std::uint32_t> first_on_node;
  for (std::uint32_t i = 0; i < character.meshes.size(); ++i) {
    const Mesh &mesh = character.meshes[i], &old = before.meshes[i];
    const bool has_more = mesh.morph_targets.size() > old.morph_targets.size();
    if (mesh.morph_targets.size() < old.morph_targets.size() ||
        (!has_more && mesh.first_morph_weight != old.first_morph_weight))
      refuse(StatusCode::invalid_argument, i,
             "save_glb: mesh %u: its morph targets do not begin with the source's", i);
    const std::uint32_t first =
        first_on_node.try_emplace(source.mesh_origins[i].node, i).first->second;
    const Mesh& other = character.meshes[first];
    const bool is_any_appended =
        has_more || other.morph_targets.size() > before.meshes[first].morph_targets.size();
    if (is_any_appended && (mesh.morph_targets.size() != other.morph_targets.size() ||
                            mesh.first_morph_weight != other.first_morph_weight))
      refuse(StatusCode::invalid_argument, i,
             "save_glb: meshes %u and %u are of one node, but have different morph weights", first,
             i);
  }
}

/// Whether a channel drives some of `count` weights from `first` on.
bool drives(const Channel& channel, std::size_t first, std::size_t count) {
  return channel.target == ChannelTarget::morph_weights && channel.index < first + count &&
         first < std::size_t{channel.index} + channel.width;
}

/// Clips must drive all weights of a mesh with appended targets, where they are now.
void check_channels_of_appended(const Character& character, const Character& before) {
  for (std::uint32_t i = 0; i < character.meshes.size(); ++i) {
    const Mesh &mesh = character.meshes[i], &old = before.meshes[i];
    const std::size_t count = mesh.morph_targets.size();
    if (count == old.morph_targets.size()) continue;
    for (const Clip& clip : character.clips)
      for (const Channel& channel : clip.channels) {
        const bool is_whole =
            channel.index == mesh.first_morph_weight && std::size_t{channel.width} == count;
        const bool drives_some = drives(channel, mesh.first_morph_weight, count) ||
                                 drives(channel, old.first_morph_weight, old.morph_targets.size());
        if (drives_some && !is_whole)
          refuse(StatusCode::invalid_argument, i,
                 "save_glb: clip '%.60s' drives some of the morph weights of mesh %u, which has "
                 "%zu now",
                 clip.name.c_str(), i, count);
      }
  }
}

void check_materials(const Character& character, std::size_t of_source, std::size_t appended) {
  for (std::uint32_t i = 0; i < character.meshes.size(); ++i)
    for (const Submesh& submesh : character.meshes[i].submeshes)
      if (submesh.material != kNone && submesh.material >= of_source + appended)
        refuse(StatusCode::index_out_of_range, i,
               "save_glb: mesh %u: material %u does not exist; the source has %zu", i,
               submesh.material, of_source);
}

void check_same_character(const Character& character, const LoadedCharacter& loaded,
                          const SaveOptions& options) {
  if (loaded.character == nullptr || loaded.source == nullptr)
    refuse(StatusCode::invalid_argument, kNone,
           "save_glb: `loaded` has no character or no source document");
  const Character& source = *loaded.character;
  if (character.meshes.size() != source.meshes.size())
    refuse(StatusCode::size_mismatch, kNone,
           "save_glb: the character has %zu meshes, the source has %zu", character.meshes.size(),
           source.meshes.size());
  if (&character == &source) return;
  if (!begins_with(character.skeleton.bones, source.skeleton.bones))
    refuse(StatusCode::invalid_argument, kNone,
           "save_glb: the skeleton does not begin with the source's");
  if (!begins_with(character.skins, source.skins))
    refuse(StatusCode::invalid_argument, kNone,
           "save_glb: the skins do not begin with the source's");
  if (character.clips.size() < source.clips.size())
    refuse(StatusCode::invalid_argument, kNone,
           "save_glb: the character has %zu clips, the source has %zu", character.clips.size(),
           source.clips.size());
  for (std::uint32_t i = 0; i < character.meshes.size(); ++i) {
    const Mesh &mesh = character.meshes[i], &before = source.meshes[i];
    if (mesh.skin != before.skin && mesh.skin < source.skins.size())
      refuse(StatusCode::invalid_argument, i,
             "save_glb: mesh %u: its skin differs from the source's", i);
  }
  check_materials(character, count_of(loaded.source->json, "materials"),
                  options.materials.size() + options.painted.size());
  if (const Status status = validate_character(character); !status) throw Refusal{status};
  check_skins_of_nodes(character, source, *loaded.source);
  check_morph_targets(character, source, *loaded.source);
  check_channels_of_appended(character, source);
}

/// Flags torn meshes, and meshes that loading repaired.
std::vector<bool> changed_meshes(const Character& character, const LoadedCharacter& loaded) {
  std::vector<bool> are_new(character.meshes.size());
  for (std::uint32_t i = 0; i < character.meshes.size(); ++i)
    are_new[i] = loaded.source->mesh_origins[i].repaired ||
                 (&character != loaded.character.get() &&
                  !(character.meshes[i] == loaded.character->meshes[i]));
  return are_new;
}

/// Meshes that must be written: changed ones, and those whose source has faults.
std::vector<std::uint32_t> meshes_to_write(const std::vector<bool>& changed,
                                           const std::vector<bool>& unsound) {
  std::vector<std::uint32_t> meshes;
  for (std::uint32_t i = 0; i < changed.size(); ++i)
    if (changed[i] || unsound[i]) meshes.push_back(i);
  return meshes;
}

/// One flag per mesh: the source has faults in it, so it must be written. Changed meshes need no
/// flag.
std::vector<bool> find_unsound(const Character& character, const LoadedCharacter& loaded,
                               const std::vector<bool>& changed) {
  if (std::find(changed.begin(), changed.end(), false) == changed.end()) return changed;
  GlbDraft draft(*loaded.source);
  return DocumentRepair(draft, character, *loaded.source).prepare(changed);
}

class Patch {
 public:
  Patch(GlbDraft& draft, const Character& character, const LoadedCharacter& loaded,
        const SaveOptions& options)
      : draft_(draft),
        character_(character),
        loaded_(loaded),
        before_(*loaded.character),
        source_(*loaded.source),
        options_(options),
        most_of_source_(most_influences(before_)),
        writer_(draft),
        rig_(draft, character, source_, static_cast<std::uint32_t>(before_.skeleton.bones.size())) {
  }

  void apply(const std::vector<std::uint32_t>& meshes) {
    if (!meshes.empty()) remove_torn_record(draft_.json);  // of an earlier tear of another source
    append_materials(character_, options_, draft_);
    nodes_of_mesh_ = uses_of_meshes(draft_.json);
    std::map<std::uint32_t, std::vector<std::uint32_t>> meshes_of_node;
    for (const std::uint32_t mesh : meshes)
      meshes_of_node[source_.mesh_origins[mesh].node].push_back(mesh);
    for (const auto& [node, on_node] : meshes_of_node) patch_node(node, on_node);
    correct_skins();
    ClipPatch(draft_, character_, source_, rig_.node_of_bone()).write_changed(before_);
    remove_unusable_channels();
    if (has_origins_) add_source_of_record(loaded_, options_, gone_, draft_.json);
  }

 private:
  void correct_skins() {
    for (const SourceDocument::RepairedSkin& repaired : source_.repaired_skins)
      draft_.json["skins"][repaired.gltf_skin]["inverseBindMatrices"] =
          add_bind_matrices(draft_, before_.skins[repaired.skin]);
  }

  void patch_node(std::uint32_t node_index, const std::vector<std::uint32_t>& meshes) {
    if (has_new_skin(meshes.front())) {
      const std::uint32_t skin = rig_.skin(character_.meshes[meshes.front()].skin);
      draft_.json["nodes"][node_index]["skin"] = skin;
    }
    Json& node = draft_.json["nodes"][node_index];
    const auto mesh_index = node["mesh"].get<std::size_t>();
    const Json& old_mesh = draft_.json["meshes"][mesh_index];
    const Json& old_primitives = old_mesh["primitives"];

    // A new primitive per old primitive of a written mesh; null if it has no triangle left.
    std::map<std::uint32_t, Json> rewritten;
    Json additional = Json::array();
    for (const std::uint32_t mesh : meshes)
      rewrite_primitives(mesh, old_primitives, rewritten, additional);
    Json primitives = Json::array();
    for (std::uint32_t i = 0; i < old_primitives.size(); ++i) {
      const auto found = rewritten.find(i);
      const Json& primitive = found == rewritten.end() ? old_primitives[i] : found->second;
      if (!primitive.is_null()) primitives.push_back(primitive);
    }
    for (Json& primitive : additional) primitives.push_back(std::move(primitive));
    const Mesh& first = character_.meshes[meshes.front()];
    const bool has_more_targets =
        first.morph_targets.size() > before_.meshes[meshes.front()].morph_targets.size();
    if (has_more_targets)
      for (Json& primitive : primitives)
        writer_.fill_targets(primitive, first.morph_targets.size());

    if (primitives.empty()) {
      // The mesh has no triangle left. The node must not refer to a mesh any more.
      for (const char* const key : {"mesh", "skin", "weights"}) node.erase(key);
      --nodes_of_mesh_[mesh_index];
      without_mesh_.insert(node_index);
      return;
    }
    Json& all = draft_.json["meshes"];
    std::size_t written = mesh_index;
    if (nodes_of_mesh_[mesh_index] > 1) {
      --nodes_of_mesh_[mesh_index];
      nodes_of_mesh_.push_back(1);
      Json copy = old_mesh;  // Other nodes use this mesh too, and are not torn.
      all.push_back(std::move(copy));
      written = all.size() - 1;
      node["mesh"] = written;
    }
    all[written]["primitives"] = std::move(primitives);
    if (has_more_targets) write_morph_weights(first, all[written], node);
  }

  /// The rest weights and names of a mesh with appended targets.
  void write_morph_weights(const Mesh& mesh, Json& gltf_mesh, Json& node) const {
    Json weights = Json::array(), names = Json::array();
    for (std::size_t i = 0; i < mesh.morph_targets.size(); ++i) {
      const float weight = character_.rest_morph_weights[mesh.first_morph_weight + i];
      weights.push_back(static_cast<double>(weight));
      names.push_back(mesh.morph_targets[i].name);
    }
    gltf_mesh["weights"] = weights;
    if (node.contains("weights")) node["weights"] = std::move(weights);
    Json& extras = gltf_mesh["extras"];
    if (extras.is_object() || extras.is_null()) extras["targetNames"] = std::move(names);
  }

  void rewrite_primitives(std::uint32_t mesh_index, const Json& old_primitives,
                          std::map<std::uint32_t, Json>& rewritten, Json& additional) {
    const Mesh& mesh = character_.meshes[mesh_index];
    Origin origin = source_.mesh_origins[mesh_index];
    origin.skinned |= has_new_skin(mesh_index);
    for (const std::uint32_t primitive : origin.primitives) rewritten[primitive] = nullptr;
    if (!MeshWriter::has_triangles(mesh)) {
      gone_.push_back({{"node", origin.node}, {"primitives", origin.primitives}});
      return;
    }
    const InfluenceForm form = influence_form(options_, mesh_index, most_of_source_);
    const MeshWriter::Vertices vertices = writer_.add_vertices(mesh, origin, form);
    Json record;
    if (!options_.origins.empty())
      record = add_origins(
          options_.origins[mesh_index],
          {mesh, vertices, form.maximum, before_.meshes[mesh_index].morph_targets.size()}, draft_);
    has_origins_ |= !record.is_null();
    std::vector<std::uint32_t> indices_of;
    for (std::uint32_t submesh = 0; submesh < mesh.submeshes.size(); ++submesh)
      indices_of.push_back(writer_.add_indices(mesh, submesh));
    if (!record.is_null())
      record["primitives"] =
          indices_of.size() - std::count(indices_of.begin(), indices_of.end(), kNone);
    for (std::uint32_t submesh = 0; submesh < mesh.submeshes.size(); ++submesh) {
      const std::uint32_t indices = indices_of[submesh];
      if (indices == kNone) continue;
      const bool is_new = submesh >= origin.primitives.size();
      Json primitive = is_new ? Json::object() : old_primitives[origin.primitives[submesh]];
      primitive["attributes"] = vertices.attributes;
      primitive["indices"] = indices;
      primitive.erase("targets");
      if (!vertices.targets.is_null()) primitive["targets"] = vertices.targets;
      primitive.erase("mode");
      primitive.erase("material");
      if (mesh.submeshes[submesh].material != kNone)
        primitive["material"] = mesh.submeshes[submesh].material;
      remove_stale_extensions(primitive);
      if (!record.is_null())
        set_origins(record, origin, is_new ? kNone : origin.primitives[submesh], draft_, primitive);
      if (is_new) write_name(mesh.submeshes[submesh], primitive);
      if (is_new)
        additional.push_back(std::move(primitive));
      else
        rewritten[origin.primitives[submesh]] = std::move(primitive);
    }
  }

  /// A primitive has no name in glTF: it is the material's name, or is stored in its extras.
  void write_name(const Submesh& submesh, Json& primitive) const {
    const bool has_material = submesh.material != kNone;
    const std::string of_material =
        has_material ? entry(draft_.json, "materials", submesh.material).name() : std::string();
    if (!submesh.name.empty() && submesh.name != of_material)
      primitive["extras"]["name"] = submesh.name;
  }

  /// Extensions that contain a second form of the replaced data.
  static void remove_stale_extensions(Json& primitive) {
    const auto extensions = primitive.find("extensions");
    if (extensions == primitive.end() || !extensions->is_object()) return;
    extensions->erase("KHR_draco_mesh_compression");
    if (extensions->empty()) primitive.erase("extensions");
  }

  [[nodiscard]] bool has_new_skin(std::uint32_t mesh) const {
    return character_.meshes[mesh].skin != before_.meshes[mesh].skin;
  }

  /// The morph weights of a node without a mesh can no longer be animated.
  void remove_unusable_channels() {
    if (without_mesh_.empty() || !draft_.json.contains("animations")) return;
    Json& animations = draft_.json["animations"];
    const auto is_unusable = [&](const Json& channel) {
      const Json& target = channel["target"];
      return target.contains("node") && target["node"].is_number() && target["path"] == "weights" &&
             without_mesh_.count(target["node"].get<std::uint32_t>()) != 0;
    };
    for (Json& animation : animations) {
      const auto channels = animation.find("channels");
      if (channels == animation.end()) continue;
      Json kept = Json::array();
      for (const Json& channel : *channels)
        if (!is_unusable(channel)) kept.push_back(channel);
      if (kept.size() == channels->size()) continue;
      if (kept.empty())
        animation = nullptr;  // DocumentRepair removes it; until then clips keep their indices.
      else
        *channels = std::move(kept);
    }
  }

  GlbDraft& draft_;
  const Character& character_;
  const LoadedCharacter& loaded_;
  const Character& before_;
  const SourceDocument& source_;
  const SaveOptions& options_;
  const std::uint32_t most_of_source_;
  MeshWriter writer_;
  AppendedRig rig_;
  std::vector<std::uint32_t> nodes_of_mesh_;  ///< How many nodes use each mesh of the draft.
  std::set<std::uint32_t> without_mesh_;
  Json gone_ = Json::array();  ///< For the record: meshes of which no triangle is left.
  bool has_origins_ = false;   ///< Of some mesh that was written.
};

/// @param maximum  influences per vertex; 0: all.
WrittenInfluences written_of(const Mesh& mesh, std::uint32_t index, std::uint32_t maximum) {
  WrittenInfluences written;
  written.mesh = index;
  written.maximum = maximum;
  std::vector<Influence> influences;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto all = mesh.weights.of(v);
    const auto count = static_cast<std::uint32_t>(all.size());
    const bool is_pruned = written.maximum != 0 && count > written.maximum;
    written.most = std::max(written.most, is_pruned ? written.maximum : count);
    if (!is_pruned) continue;
    influences.assign(all.begin(), all.end());
    (void)sort_influences(influences);  // The weights of a valid character are valid.
    ++written.vertices_pruned;
    written.dropped_mass_max =
        std::max(written.dropped_mass_max, dropped_mass(influences, written.maximum));
  }
  return written;
}

}  // namespace

std::vector<std::byte> glb_of(const Character& character, const LoadedCharacter& loaded,
                              const SaveOptions& options) {
  check_options(options, character.meshes.size());
  check_same_character(character, loaded, options);
  check_origins(character, *loaded.character, options.origins);
  const SourceDocument& source = *loaded.source;
  GlbDraft draft(source);
  const Json before = draft.json;
  DocumentRepair repair(draft, character, source);
  const std::vector<bool> changed = changed_meshes(character, loaded);
  const std::vector<std::uint32_t> meshes = meshes_to_write(changed, repair.prepare(changed));
  Patch(draft, character, loaded, options).apply(meshes);
  repair.finish();
  const bool is_unchanged = meshes.empty() && draft.json == before;
  if (is_unchanged && source.is_glb && is_container_sound(source.content)) return source.content;
  draft.embed_images();
  if (!is_unchanged) leave_out_unused(draft, source);
  return draft.finish();
}

Result<std::vector<WrittenInfluences>> influences_of_written(const Character& character,
                                                             const LoadedCharacter& loaded,
                                                             const SaveOptions& options) {
  return without_exceptions<std::vector<WrittenInfluences>>([&] {
    check_options(options, character.meshes.size());
    check_same_character(character, loaded, options);
    const std::vector<bool> changed = changed_meshes(character, loaded);
    const std::uint32_t most_of_source = most_influences(*loaded.character);
    std::vector<WrittenInfluences> written;
    for (const std::uint32_t mesh :
         meshes_to_write(changed, find_unsound(character, loaded, changed))) {
      const Mesh &after = character.meshes[mesh], &before = loaded.character->meshes[mesh];
      if (loaded.source->mesh_origins[mesh].skinned || after.skin != before.skin)
        written.push_back(
            written_of(after, mesh, influence_form(options, mesh, most_of_source).maximum));
    }
    return written;
  });
}

}  // namespace sunder::gltf
