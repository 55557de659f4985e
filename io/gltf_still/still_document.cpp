#include "io/gltf_still/still_document.h"

#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "io/gltf/refusal.h"
#include "io/gltf_still/still_materials.h"
#include "io/gltf_write/mesh_writer.h"
#include "io/internal/staged_file.h"

namespace sunder::gltf {
namespace {

std::uint32_t append(Json& document, const char* list_name, Json entry) {
  Json& list = list_of(document, list_name);
  list.push_back(std::move(entry));
  return static_cast<std::uint32_t>(list.size() - 1);
}

/// The sRGB value of a linear one.
float srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

class StillDocument {
 public:
  StillDocument(const StillScene& scene, const SourceDocument& materials)
      : scene_(scene), draft_(materials), meshes_(draft_) {}

  std::vector<std::byte> write() {
    keep_materials();
    for (const Mesh& surface : scene_.surfaces) add_surface(surface);
    for (const StillScene::Mark& mark : scene_.marks) add_mark(mark);
    for (const StillScene::Light& light : scene_.lights) add_light(light);
    draft_.json["scenes"][0]["nodes"] = nodes_;
    return draft_.finish();
  }

  [[nodiscard]] std::uint32_t materials_without_texture() const { return without_texture_; }

 private:
  void keep_materials() {
    draft_.embed_images();
    embed_data_uris(draft_);
    Json kept = {{"asset", {{"version", "2.0"}, {"generator", "Sunder"}}},
                 {"extensionsUsed", {"KHR_lights_punctual", "KHR_materials_unlit"}},
                 {"scene", 0},
                 {"scenes", Json::array({Json::object()})},
                 {"materials", Json::array()}};
    for (const char* const list :
         {"materials", "textures", "samplers", "images", "buffers", "bufferViews"})
      if (draft_.json.contains(list) && draft_.json[list].is_array())
        kept[list] = std::move(draft_.json[list]);
    draft_.json = std::move(kept);
    material_count_ = static_cast<std::uint32_t>(draft_.json["materials"].size());
    std::set<std::uint32_t> colored;
    for (const Mesh& surface : scene_.surfaces)
      for (const Submesh& submesh : surface.submeshes)
        if (!surface.color_sets.empty()) colored.insert(submesh.material);
    without_texture_ = simplify_materials(draft_.json, colored);
  }

  void add_surface(const Mesh& surface) {
    if (!MeshWriter::has_triangles(surface)) return;
    Mesh still = surface;
    still.morph_targets.clear();
    still.custom_attributes.clear();
    still.tangents.clear();
    const Json attributes = meshes_.add_vertices(still, {}, {}).attributes;
    Json primitives = Json::array();
    for (std::uint32_t submesh = 0; submesh < still.submeshes.size(); ++submesh) {
      const std::uint32_t indices = meshes_.add_indices(still, submesh);
      if (indices == kNone) continue;
      const std::uint32_t material = material_of(still.submeshes[submesh]);
      const Tint tint = tint_of(material);
      const bool is_tinted = !still.color_sets.empty() || tint.color.w() < 1.0f;
      primitives.push_back({{"attributes", is_tinted ? tinted(still, tint) : attributes},
                            {"indices", indices},
                            {"material", material}});
    }
    add_node({{"mesh", append(draft_.json, "meshes",
                              {{"name", still.name}, {"primitives", std::move(primitives)}})}});
  }

  struct Tint {
    Vec4f color = Vec4f::Ones();  ///< The base colour; alpha 1 if it is not blended.
    bool is_blended = false;
  };
  [[nodiscard]] Tint tint_of(std::uint32_t index) const {
    const Json& material = draft_.json["materials"][index];
    const Json& factor = material["pbrMetallicRoughness"]["baseColorFactor"];
    Tint tint;
    tint.is_blended = material.contains("alphaMode") && material["alphaMode"] == "BLEND";
    for (std::size_t i = 0; i < 4 && factor.size() == 4; ++i)
      if (factor[i].is_number()) tint.color[static_cast<int>(i)] = factor[i].get<float>();
    if (!tint.is_blended) tint.color.w() = 1.0f;
    return tint;
  }

  /// The vertices with the base colour of their material in their own colours. VTK 9.1 ignores the
  /// alpha of a material, all of its base colour where there are vertex colours, and the alpha mode
  /// where these have an alpha.
  Json tinted(Mesh mesh, const Tint& tint) {
    mesh.color_sets.resize(1);
    mesh.color_sets[0].resize(mesh.positions.size(), Vec4f::Ones());
    for (Vec4f& color : mesh.color_sets[0]) color = color.cwiseProduct(tint.color);
    SourceDocument::MeshOrigin form;
    form.color_components = {tint.is_blended ? 4u : 3u};
    return meshes_.add_vertices(mesh, form, {}).attributes;
  }

  std::uint32_t material_of(const Submesh& submesh) {
    if (submesh.material != kNone && submesh.material >= material_count_)
      refuse(StatusCode::index_out_of_range, submesh.material,
             "save_still: material %u does not exist; the document has %u", submesh.material,
             material_count_);
    if (submesh.material != kNone) return submesh.material;
    if (plain_material_ == kNone)
      plain_material_ = append(draft_.json, "materials",
                               {{"pbrMetallicRoughness",
                                 {{"baseColorFactor", {0.75, 0.73, 0.7, 1.0}},
                                  {"metallicFactor", 0.0},
                                  {"roughnessFactor", 1.0}}},
                                {"doubleSided", true}});
    return plain_material_;
  }

  /// Unlit and white: the colour is that of the vertices, for its alpha's sake, as in tinted().
  std::uint32_t add_flat_material(const Vec4f& color) {
    Json material = {{"pbrMetallicRoughness",
                      {{"baseColorFactor", {1.0, 1.0, 1.0, 1.0}}, {"metallicFactor", 0.0}}},
                     {"extensions", {{"KHR_materials_unlit", Json::object()}}},
                     {"doubleSided", true}};
    if (color.w() < 1.0f) material["alphaMode"] = "BLEND";
    return append(draft_.json, "materials", std::move(material));
  }

  void add_mark(const StillScene::Mark& mark) {
    Mesh mesh;
    mesh.name = mark.name;
    mesh.positions = mark.positions;
    // VTK 9.1 shows the vertex colours of unlit materials as they are.
    const Vec4f shown(srgb(mark.color[0]), srgb(mark.color[1]), srgb(mark.color[2]), mark.color[3]);
    mesh.color_sets.assign(1, std::vector<Vec4f>(mark.positions.size(), shown));
    mesh.triangles = mark.triangles;
    mesh.triangle_submesh.assign(mark.triangles.size(), 0);
    mesh.submeshes.resize(1);
    if (!MeshWriter::has_triangles(mesh)) return;
    const MeshWriter::Vertices vertices = meshes_.add_vertices(mesh, {}, {});
    const std::uint32_t indices = meshes_.add_indices(mesh, 0);
    const Json primitive = {{"attributes", vertices.attributes},
                            {"indices", indices},
                            {"material", add_flat_material(mark.color)}};
    add_node({{"mesh", append(draft_.json, "meshes",
                              {{"name", mark.name}, {"primitives", Json::array({primitive})}})}});
  }

  void add_light(const StillScene::Light& light) {
    Json& extension = draft_.json["extensions"]["KHR_lights_punctual"];
    const std::uint32_t index =
        append(extension, "lights", {{"type", "directional"}, {"intensity", light.intensity}});
    // It shines along its node's -Z.
    const Quatd rotation = Quatd::FromTwoVectors(Vec3d(Vec3d::UnitZ()), light.towards);
    add_node({{"rotation", {rotation.x(), rotation.y(), rotation.z(), rotation.w()}},
              {"extensions", {{"KHR_lights_punctual", {{"light", index}}}}}});
  }

  void add_node(Json node) { nodes_.push_back(append(draft_.json, "nodes", std::move(node))); }

  const StillScene& scene_;
  GlbDraft draft_;
  MeshWriter meshes_;
  Json nodes_ = Json::array();
  std::uint32_t material_count_ = 0, plain_material_ = kNone, without_texture_ = 0;
};

}  // namespace

Result<std::uint32_t> write_still(const std::filesystem::path& file, const StillScene& scene,
                                  const SourceDocument& materials) {
  return without_exceptions<std::uint32_t>([&]() -> Result<std::uint32_t> {
    StillDocument document(scene, materials);
    const std::vector<std::byte> bytes = document.write();
    if (const Status status = write_file(file, bytes); !status) return status;
    return document.materials_without_texture();
  });
}

}  // namespace sunder::gltf
