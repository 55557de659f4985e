#include "io/usd_write/meshes.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <map>
#include <span>

#include "io/gltf/refusal.h"
#include "io/gltf_write/influence_sets.h"
#include "io/usd_write/blend_shapes.h"
#include "io/usd_write/identifiers.h"

namespace sunder::usd {
namespace {

/// "type[] name = values (interpolation = …)", and further metadata.
void write_primvar(UsdText& text, const std::string& declaration, const std::string& values,
                   std::uint32_t element_size = 0) {
  text.open(declaration + " = " + values, '(');
  if (element_size != 0) text.line("elementSize = " + std::to_string(element_size));
  text.line("interpolation = \"vertex\"");
  text.close(')');
}

void write_faces(UsdText& text, const Mesh& mesh) {
  std::vector<std::uint32_t> counts, corners;
  for (const Triangle& triangle : mesh.triangles) {
    if (is_retired(triangle)) continue;
    counts.push_back(3);
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  text.line("int[] faceVertexCounts = " + array_of(counts));
  text.line("int[] faceVertexIndices = " + array_of(corners));
}

void write_extent(UsdText& text, const Mesh& mesh) {
  Vec3f least = mesh.positions[0], most = least;
  for (const Vec3f& position : mesh.positions) {
    least = least.cwiseMin(position);
    most = most.cwiseMax(position);
  }
  text.line("float3[] extent = " + array_of(std::vector<Vec3f>{least, most}));
}

/// The faces of each submesh, by their numbers in the file; empty for submeshes without any.
std::vector<std::vector<std::uint32_t>> faces_of_submeshes(const Mesh& mesh) {
  std::vector<std::vector<std::uint32_t>> faces(mesh.submeshes.size());
  std::uint32_t face = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (!is_retired(mesh.triangles[t])) faces[mesh.triangle_submesh[t]].push_back(face++);
  return faces;
}

/// Of one submesh with faces, the mesh itself has the material.
void write_material_binding(UsdText& text, const std::string& path) {
  if (!path.empty()) text.line("rel material:binding = <" + path + ">");
}

void write_subsets(UsdText& text, const Mesh& mesh,
                   const std::vector<std::vector<std::uint32_t>>& faces, const Materials& materials,
                   Identifiers& children) {
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].empty()) continue;
    const std::string& name = mesh.submeshes[i].name;
    const std::string identifier = children.add(name, "Subset");
    const std::string material = materials.path_of(mesh.submeshes[i]);
    std::vector<std::string> metadata = display_name(name, identifier);
    if (!material.empty()) metadata.emplace_back("prepend apiSchemas = [\"MaterialBindingAPI\"]");
    text.line("");
    text.open_prim("GeomSubset", identifier, metadata);
    text.line("uniform token elementType = \"face\"");
    text.line("uniform token familyName = \"materialBind\"");
    text.line("int[] indices = " + array_of(faces[i]));
    write_material_binding(text, material);
    text.close('}');
  }
}

void write_coordinates(UsdText& text, const std::vector<Vec2f>& uvs, std::size_t set) {
  std::vector<Vec2f> upwards;
  upwards.reserve(uvs.size());
  for (const Vec2f& uv : uvs) upwards.emplace_back(uv.x(), 1.0f - uv.y());
  write_primvar(text, "texCoord2f[] primvars:st" + (set == 0 ? std::string() : std::to_string(set)),
                array_of(upwards));
}

void write_colours(UsdText& text, const std::vector<Vec4f>& colours, std::size_t set) {
  std::vector<Vec3f> rgb;
  std::vector<float> alpha;
  for (const Vec4f& colour : colours) {
    rgb.emplace_back(colour.x(), colour.y(), colour.z());
    alpha.push_back(colour.w());
  }
  const std::string number = set == 0 ? std::string() : std::to_string(set);
  write_primvar(text, "color3f[] primvars:displayColor" + number, array_of(rgb));
  if (std::any_of(alpha.begin(), alpha.end(), [](float share) { return share != 1; }))
    write_primvar(text, "float[] primvars:displayOpacity" + number, array_of(alpha, 1));
}

void write_custom_attribute(UsdText& text, const CustomAttribute& attribute,
                            Identifiers& primvars) {
  constexpr const char* kTypes[] = {"float[]", "float2[]", "float3[]", "float4[]"};
  write_primvar(text,
                std::string(kTypes[attribute.components - 1]) +
                    " primvars:" + primvars.add(attribute.name, "attribute"),
                array_of(attribute.values, attribute.components));
}

/// Joints of a mesh: those of its skin's slots, each once.
struct LocalJoints {
  explicit LocalJoints(const SkinJoints& skin) {
    std::map<std::uint32_t, std::uint32_t> local_of;
    for (const std::uint32_t joint : skin.joint_of_slot) {
      const auto [known, is_new] =
          local_of.try_emplace(joint, static_cast<std::uint32_t>(joints.size()));
      if (is_new) joints.push_back(joint);
      local_of_slot.push_back(known->second);
    }
  }
  std::vector<std::uint32_t> joints;
  std::vector<std::uint32_t> local_of_slot;
};

}  // namespace

void MeshesWriter::write(UsdText& text, const Mesh& mesh, const std::string& path,
                         std::uint32_t maximum_influences) const {
  const std::string identifier = path.substr(path.rfind('/') + 1);
  const std::vector<std::vector<std::uint32_t>> faces = faces_of_submeshes(mesh);
  const auto is_shown = [](const std::vector<std::uint32_t>& of) { return !of.empty(); };
  const auto shown = std::find_if(faces.begin(), faces.end(), is_shown);
  const bool has_subsets = std::count_if(faces.begin(), faces.end(), is_shown) > 1;
  const Submesh& first = mesh.submeshes[static_cast<std::size_t>(shown - faces.begin())];
  const std::string material = has_subsets ? std::string() : materials_.path_of(first);

  std::vector<std::string> metadata = display_name(mesh.name, identifier);
  metadata.push_back(material.empty()
                         ? "prepend apiSchemas = [\"SkelBindingAPI\"]"
                         : "prepend apiSchemas = [\"SkelBindingAPI\", \"MaterialBindingAPI\"]");
  text.line("");
  text.open_prim("Mesh", identifier, metadata);
  const bool is_double_sided =
      std::any_of(mesh.submeshes.begin(), mesh.submeshes.end(),
                  [&](const Submesh& of) { return materials_.is_double_sided(of); });
  if (is_double_sided) text.line("uniform bool doubleSided = 1");
  write_extent(text, mesh);
  write_faces(text, mesh);
  write_attributes(text, mesh);
  write_material_binding(text, material);
  write_influences(text, mesh, maximum_influences);
  write_blend_shape_bindings(text, mesh, path, shapes_);
  text.line("uniform token subdivisionScheme = \"none\"");
  if (has_subsets) text.line("uniform token subsetFamily:materialBind:familyType = \"partition\"");
  Identifiers children;
  write_blend_shapes(text, mesh, shapes_, children);
  if (has_subsets) write_subsets(text, mesh, faces, materials_, children);
  text.close('}');
}

void MeshesWriter::write_attributes(UsdText& text, const Mesh& mesh) const {
  if (!mesh.normals.empty()) write_primvar(text, "normal3f[] normals", array_of(mesh.normals));
  text.line("point3f[] points = " + array_of(mesh.positions));
  Identifiers primvars;
  for (const char* const name : {"st", "displayColor", "displayOpacity", "tangents"})
    primvars.add(name, "");
  for (std::size_t set = 1; set < mesh.uv_sets.size(); ++set)
    primvars.add("st" + std::to_string(set), "");
  for (std::size_t set = 1; set < mesh.color_sets.size(); ++set) {
    primvars.add("displayColor" + std::to_string(set), "");
    primvars.add("displayOpacity" + std::to_string(set), "");
  }
  for (std::size_t set = 0; set < mesh.color_sets.size(); ++set)
    write_colours(text, mesh.color_sets[set], set);
  for (std::size_t set = 0; set < mesh.uv_sets.size(); ++set)
    write_coordinates(text, mesh.uv_sets[set], set);
  if (!mesh.tangents.empty())
    write_primvar(text, "float4[] primvars:tangents", array_of(mesh.tangents));
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    write_custom_attribute(text, attribute, primvars);
}

void MeshesWriter::write_influences(UsdText& text, const Mesh& mesh, std::uint32_t maximum) const {
  const LocalJoints local(joints_.skins()[mesh.skin]);
  std::uint32_t element_size = gltf::most_influences(mesh.weights);
  if (maximum != 0) element_size = std::min(element_size, maximum);
  std::vector<std::uint32_t> indices(std::size_t{mesh.vertex_count()} * element_size, 0);
  std::vector<float> weights(indices.size(), 0.0f);
  std::vector<Influence> influences;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::span<const Influence> all = mesh.weights.of(v);
    influences.assign(all.begin(), all.end());
    const std::size_t kept =
        prune_influences(influences, influences.size() > element_size ? element_size : 0);
    if (kept == 0)
      gltf::refuse(StatusCode::weights_not_normalized, v,
                   "mesh '%.60s': vertex %u: its weights do not have a positive, finite sum",
                   mesh.name.c_str(), v);
    for (std::size_t i = 0; i < kept; ++i) {
      indices[std::size_t{v} * element_size + i] = local.local_of_slot[influences[i].slot];
      weights[std::size_t{v} * element_size + i] = influences[i].weight;
    }
  }
  text.line("matrix4d primvars:skel:geomBindTransform = " +
            matrix(joints_.skins()[mesh.skin].joints_from_mesh));
  write_primvar(text, "int[] primvars:skel:jointIndices", array_of(indices), element_size);
  write_primvar(text, "float[] primvars:skel:jointWeights", array_of(weights, 1), element_size);
  write_binding(text, local.joints);
}

void MeshesWriter::write_binding(UsdText& text, const std::vector<std::uint32_t>& joints) const {
  std::vector<std::string> paths;
  for (const std::uint32_t joint : joints) paths.push_back(joints_.all()[joint].path);
  text.line("uniform token[] skel:joints = " + array_of(std::span<const std::string>(paths)));
  text.line("rel skel:skeleton = <" + skeleton_ + ">");
}

}  // namespace sunder::usd
