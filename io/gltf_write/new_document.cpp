#include "io/gltf_write/new_document.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "io/gltf/cursor.h"
#include "io/gltf/glb.h"
#include "io/gltf/refusal.h"
#include "io/gltf_write/appended_materials.h"
#include "io/gltf_write/clip_writer.h"
#include "io/gltf_write/copied_materials.h"
#include "io/gltf_write/lists.h"
#include "io/gltf_write/mesh_writer.h"
#include "io/gltf_write/rig_writer.h"

namespace sunder::gltf {
namespace {

/// Linear RGB colours for successive submeshes: leaf, blossom, clay, earth, sky, sand, plum, moss.
constexpr std::array<std::array<double, 3>, 8> kColors = {{{0.30, 0.62, 0.22},
                                                           {0.92, 0.38, 0.52},
                                                           {0.78, 0.36, 0.20},
                                                           {0.22, 0.14, 0.09},
                                                           {0.28, 0.52, 0.80},
                                                           {0.82, 0.68, 0.42},
                                                           {0.52, 0.28, 0.62},
                                                           {0.55, 0.66, 0.24}}};

class NewDocument {
 public:
  /// @param copied     a document whose materials are taken; null: none.
  /// @param materials  null: plain ones.
  NewDocument(const Character& character, const SaveOptions& options, const SourceDocument* copied,
              const NewMaterials* materials)
      : character_(character),
        options_(options),
        copied_(copied),
        materials_(materials),
        draft_(nothing_),
        meshes_(draft_) {}

  std::vector<std::byte> write() {
    draft_.json = {{"asset", {{"version", "2.0"}, {"generator", "Sunder"}}},
                   {"scene", 0},
                   {"scenes", Json::array({Json::object()})}};
    if (!character_.name.empty()) draft_.json["scenes"][0]["name"] = character_.name;
    if (copied_ != nullptr) {
      copy_materials(*copied_, draft_);
      append_materials(character_, options_, draft_);
      material_count_ = static_cast<Index>(count_of(draft_.json, "materials"));
    }
    if (materials_ != nullptr) add_materials();
    add_bones();
    for (Index mesh = 0; mesh < character_.meshes.size(); ++mesh) add_mesh(mesh);
    draft_.json["scenes"][0]["nodes"] = roots_;
    for (Index clip = 0; clip < character_.clips.size(); ++clip) add_clip(clip);
    return draft_.finish();
  }

 private:
  void add_bones() {
    std::vector<Json> children(character_.skeleton.bones.size());
    Json roots = Json::array();
    for (Index bone = 0; bone < children.size(); ++bone) {
      const Index parent = character_.skeleton.bones[bone].parent;
      (parent == kNone ? roots : children[parent]).push_back(bone);
    }
    for (Index bone = 0; bone < children.size(); ++bone) {
      Json node = bone_node(character_.skeleton.bones[bone]);
      if (!children[bone].empty()) node["children"] = children[bone];
      node_of_bone_.push_back(bone);
      append(draft_.json, "nodes", std::move(node));
    }
    // glTF requires that the joints of a skin have a common root.
    if (roots.size() > 1)
      roots =
          Json::array({append(draft_.json, "nodes", {{"name", "Skeleton"}, {"children", roots}})});
    roots_ = std::move(roots);
  }

  /// All its vertices follow one bone, in the same way as a child of that bone's node.
  [[nodiscard]] bool hangs_on_its_bone(const Mesh& mesh) const {
    const Skin& skin = character_.skins[mesh.skin];
    if (skin.bones.size() != 1 || skin.bone_from_bind[0].matrix() != Affine3f::Identity().matrix())
      return false;
    return std::all_of(mesh.weights.influences.begin(), mesh.weights.influences.end(),
                       [](const Influence& influence) { return influence.weight == 1.0f; });
  }

  void add_mesh(Index index) {
    const Mesh& mesh = character_.meshes[index];
    if (!MeshWriter::has_triangles(mesh)) return;
    const bool rigid = hangs_on_its_bone(mesh);
    SourceDocument::MeshOrigin form;
    form.skinned = !rigid;
    const MeshWriter::Vertices vertices =
        meshes_.add_vertices(mesh, form, influence_form(options_, index, 0));

    Json gltf_mesh = {{"name", mesh.name}, {"primitives", Json::array()}};
    for (Index submesh = 0; submesh < mesh.submeshes.size(); ++submesh) {
      const Index indices = meshes_.add_indices(mesh, submesh);
      if (indices == kNone) continue;
      Json primitive = {{"attributes", vertices.attributes},
                        {"indices", indices},
                        {"material", add_material(mesh, submesh)}};
      if (!vertices.targets.is_null()) primitive["targets"] = vertices.targets;
      gltf_mesh["primitives"].push_back(std::move(primitive));
    }
    if (!mesh.morph_targets.empty()) {
      gltf_mesh["weights"] =
          numbers_of({character_.rest_morph_weights.data() + mesh.first_morph_weight,
                      mesh.morph_targets.size()});
      Json names = Json::array();
      for (const MorphTarget& target : mesh.morph_targets) names.push_back(target.name);
      gltf_mesh["extras"]["targetNames"] = std::move(names);
    }
    const Index gltf_index = append(draft_.json, "meshes", std::move(gltf_mesh));
    node_of_mesh_[index] = rigid ? hang(mesh, gltf_index) : add_skinned_node(mesh, gltf_index);
  }

  Index hang(const Mesh& mesh, Index gltf_mesh) {
    const Index bone = character_.skins[mesh.skin].bones[0];
    if (!draft_.json["nodes"][bone].contains("mesh")) {
      draft_.json["nodes"][bone]["mesh"] = gltf_mesh;
      return bone;
    }
    const Index node = append(draft_.json, "nodes", {{"name", mesh.name}, {"mesh", gltf_mesh}});
    list_of(draft_.json["nodes"][bone], "children").push_back(node);
    return node;
  }

  Index add_skinned_node(const Mesh& mesh, Index gltf_mesh) {
    const Index node =
        append(draft_.json, "nodes",
               {{"name", mesh.name}, {"mesh", gltf_mesh}, {"skin", skin_of(mesh.skin)}});
    roots_.push_back(node);
    return node;
  }

  Index skin_of(Index index) {
    const auto [entry, is_new] = gltf_skin_of_.try_emplace(index, 0);
    if (is_new) entry->second = add_skin(draft_, character_.skins[index], node_of_bone_);
    return entry->second;
  }

  // ---- Materials

  void add_materials() {
    const BaseColours& colours = materials_->colours;
    std::vector<Index> image_of;
    for (const BaseColours::Image& image : colours.images) {
      // Core glTF knows no other kinds.
      const bool is_known = image.type == "image/png" || image.type == "image/jpeg";
      image_of.push_back(
          is_known
              ? append(draft_.json, "images",
                       {{"bufferView", draft_.add_view(image.bytes, GlbDraft::ViewTarget::none)},
                        {"mimeType", image.type}})
              : kNone);
    }
    for (std::size_t i = 0; i < colours.materials.size(); ++i)
      add_material(colours.materials[i], materials_->names[i], image_of);
  }

  void add_material(const BaseColour& colour, const std::string& name,
                    const std::vector<Index>& image_of) {
    Json pbr = {{"baseColorFactor", numbers_of({colour.factor.data(), 4})},
                {"metallicFactor", 0.0},
                {"roughnessFactor", 0.8}};
    const bool has_image = colour.image < image_of.size() && image_of[colour.image] != kNone;
    if (has_image) {
      constexpr std::array<Index, 3> kWraps = {10497, 33071, 33648};
      const Index sampler = append(draft_.json, "samplers",
                                   {{"wrapS", kWraps[static_cast<std::size_t>(colour.wrap_u)]},
                                    {"wrapT", kWraps[static_cast<std::size_t>(colour.wrap_v)]}});
      const Index texture = append(draft_.json, "textures",
                                   {{"source", image_of[colour.image]}, {"sampler", sampler}});
      pbr["baseColorTexture"] = {{"index", texture}, {"texCoord", colour.uv_set}};
    }
    Json material = {{"pbrMetallicRoughness", std::move(pbr)}, {"doubleSided", true}};
    if (!name.empty()) material["name"] = name;
    if (colour.cutoff > 0) {
      material["alphaMode"] = "MASK";
      material["alphaCutoff"] = static_cast<double>(colour.cutoff);
    } else if (colour.factor.w() < 1) {
      material["alphaMode"] = "BLEND";
    }
    append(draft_.json, "materials", std::move(material));
  }

  Index add_material(const Mesh& mesh, Index submesh) {
    const Index own = mesh.submeshes[submesh].material;
    if (copied_ != nullptr && own != kNone) {
      if (own < material_count_) return own;
      refuse(StatusCode::index_out_of_range, own,
             "mesh '%.60s': material %u does not exist; the document has %u", mesh.name.c_str(),
             own, material_count_);
    }
    if (materials_ != nullptr && own < materials_->names.size()) return own;
    const auto& color = kColors[list_of(draft_.json, "materials").size() % kColors.size()];
    // Vertex colours are multiplied by the material's colour, so that is white.
    const Json base_color = mesh.color_sets.empty() ? Json{color[0], color[1], color[2], 1.0}
                                                    : Json{1.0, 1.0, 1.0, 1.0};
    const std::string& name = mesh.submeshes[submesh].name;
    return append(
        draft_.json, "materials",
        {{"name", name.empty() ? mesh.name : name},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", base_color}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}},
         {"doubleSided", true}});
  }

  // ---- Clips

  struct GltfTarget {
    Index node;
    const char* path;
  };

  void add_clip(Index index) {
    const Clip& clip = character_.clips[index];
    Json animation = {{"channels", Json::array()}, {"samplers", Json::array()}};
    if (!clip.name.empty()) animation["name"] = clip.name;
    std::map<std::pair<Index, std::string>, Index> channel_of;
    for (const Channel& channel : clip.channels) {
      if (channel.target == ChannelTarget::morph_weights) {
        for (const auto& [mesh, node] : node_of_mesh_) {
          const std::vector<float> values = weights_of_mesh(channel, character_.meshes[mesh]);
          if (!values.empty())
            add_channel(animation, channel_of, {node, "weights"}, channel, values, 1);
        }
      } else if (channel.target == ChannelTarget::rotation) {
        add_channel(animation, channel_of, {channel.index, "rotation"}, channel,
                    unit_rotations(channel), 4);
      } else {
        const char* const path = channel.target == ChannelTarget::scale ? "scale" : "translation";
        add_channel(animation, channel_of, {channel.index, path}, channel, channel.values, 3);
      }
    }
    if (!animation["channels"].empty()) append(draft_.json, "animations", std::move(animation));
  }

  void add_channel(Json& animation, std::map<std::pair<Index, std::string>, Index>& channel_of,
                   const GltfTarget& target, const Channel& channel, std::span<const float> values,
                   std::uint32_t components) {
    animation["samplers"].push_back(add_sampler(draft_, channel, values, components));
    Json entry = {{"sampler", animation["samplers"].size() - 1},
                  {"target", {{"node", target.node}, {"path", target.path}}}};
    // Of several channels with the same target the last one applies, as in a pose; glTF allows only
    // one.
    const auto [found, is_new] = channel_of.try_emplace(
        {target.node, target.path}, static_cast<Index>(animation["channels"].size()));
    if (is_new)
      animation["channels"].push_back(std::move(entry));
    else
      animation["channels"][found->second] = std::move(entry);
  }

  /// A channel's values for all weights of one mesh, as glTF requires; empty if it drives none of
  /// them. Other weights keep their rest value.
  [[nodiscard]] std::vector<float> weights_of_mesh(const Channel& channel, const Mesh& mesh) const {
    const std::size_t first = mesh.first_morph_weight, count = mesh.morph_targets.size();
    if (first >= std::size_t{channel.index} + channel.width || first + count <= channel.index ||
        count == 0)
      return {};
    const bool is_spline = channel.interpolation == Interpolation::cubic_spline;
    std::vector<float> values;
    const std::size_t rows = channel.values.size() / channel.width;
    for (std::size_t row = 0; row < rows; ++row) {
      const bool is_tangent = is_spline && row % 3 != 1;
      for (std::size_t i = first; i < first + count; ++i) {
        const bool driven = i >= channel.index && i < std::size_t{channel.index} + channel.width;
        const float otherwise = is_tangent ? 0.0f : character_.rest_morph_weights[i];
        values.push_back(driven ? channel.values[row * channel.width + i - channel.index]
                                : otherwise);
      }
    }
    return values;
  }

  const Character& character_;
  const SaveOptions& options_;
  const SourceDocument* copied_;
  const NewMaterials* materials_;  ///< Null: plain ones.
  const SourceDocument nothing_;
  GlbDraft draft_;
  MeshWriter meshes_;
  Index material_count_ = 0;
  Json roots_;
  std::vector<Index> node_of_bone_;
  std::map<Index, Index> gltf_skin_of_;
  std::map<Index, Index> node_of_mesh_;
};

void check_character(const Character& character) {
  if (const Status status = validate_character(character); !status) throw Refusal{status};
}

}  // namespace

std::vector<std::byte> new_document(const Character& character, const SaveOptions& options,
                                    const SourceDocument* materials) {
  check_options(options, character.meshes.size());
  if ((!options.materials.empty() || !options.painted.empty()) && materials == nullptr)
    refuse(StatusCode::invalid_argument, kNone,
           "save_glb: materials are appended to those of a source document; this has none");
  check_character(character);
  return NewDocument(character, options, materials, nullptr).write();
}

std::vector<std::byte> new_document(const Character& character, const NewMaterials& materials) {
  check_character(character);
  const SaveOptions all_defaults;
  return NewDocument(character, all_defaults, nullptr, &materials).write();
}

}  // namespace sunder::gltf
