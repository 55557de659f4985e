#include "io/gltf_read/meshes.h"

#include <algorithm>
#include <string>
#include <utility>

#include "io/gltf/refusal.h"
#include "io/gltf/rigid_weights.h"
#include "io/gltf_read/attributes.h"
#include "io/gltf_read/primitives.h"
#include "io/gltf_read/skins.h"

namespace sunder::gltf {
namespace {

std::vector<std::string> target_names(const Cursor& mesh) {
  std::vector<std::string> names;
  const auto extras = mesh.find("extras");
  if (!extras || !extras->json().is_object()) return names;
  const auto list = extras->find("targetNames");
  if (!list || !list->json().is_array()) return names;
  for (const Json& name : list->json())
    names.push_back(name.is_string() ? name.get<std::string>() : std::string());
  return names;
}

/// The field in which saving stores the name of a primitive, if it is not the material's.
std::string name_in_extras(const Cursor& primitive) {
  const auto extras = primitive.find("extras");
  return extras && extras->json().is_object() ? extras->name() : std::string();
}

std::uint32_t target_count(const Cursor& mesh) {
  std::size_t count = 0;
  const Cursor primitives = mesh.member("primitives");
  for (std::size_t i = 0; i < primitives.size(); ++i)
    if (const auto targets = primitives.element(i).find("targets"))
      count = std::max(count, targets->size());
  return static_cast<std::uint32_t>(count);
}

class MeshBuilder {
 public:
  MeshBuilder(Reading& reading, const NodeSkeleton& nodes, Character& character)
      : reading_(reading),
        nodes_(nodes),
        character_(character),
        skins_(reading, nodes, character.skins) {
    result_.morphs_of_node.resize(nodes.bone_from_node.size());
  }

  void add_node(std::uint32_t node) {
    const Cursor at = entry(reading_.json(), "nodes", node);
    const auto mesh_at = at.find("mesh");
    if (!mesh_at) return;
    const std::uint32_t mesh_index = mesh_at->to_index(count_of(reading_.json(), "meshes"), "mesh");
    const Cursor mesh = entry(reading_.json(), "meshes", mesh_index);
    note_instances(at);
    const MorphRange morphs = add_morph_weights(at, mesh);
    result_.morphs_of_node[node] = morphs;
    const auto groups = group_primitives(reading_, mesh);
    for (const PrimitiveGroup& group : groups) {
      std::string name = mesh.name().empty()
                             ? nodes_.skeleton.bones[nodes_.bone_from_node[node]].name
                             : mesh.name();
      if (groups.size() > 1) name.append(".").append(std::to_string(group.primitives.front()));
      add_mesh(at, node, mesh, mesh_index, group, name, morphs.first);
    }
  }

  ReadMeshes finish() {
    result_.repaired_skins = skins_.repaired();
    return std::move(result_);
  }

 private:
  void note_instances(const Cursor& node) {
    const auto extensions = node.find("extensions");
    if (extensions && extensions->json().is_object() && extensions->find("EXT_mesh_gpu_instancing"))
      reading_.notes.dropped(StatusCode::unsupported_feature, kNone, node.pointer(),
                             "copies of the mesh by EXT_mesh_gpu_instancing are not loaded; the "
                             "mesh is loaded once, where the node is, and torn in all of them");
  }

  MorphRange add_morph_weights(const Cursor& node, const Cursor& mesh) {
    auto& all = character_.rest_morph_weights;
    const MorphRange range{static_cast<std::uint32_t>(all.size()), target_count(mesh)};
    if (range.count == 0) return range;
    auto weights = node.find("weights");
    if (!weights) weights = mesh.find("weights");
    if (weights && weights->size() != range.count)
      reading_.notes.repaired(StatusCode::size_mismatch, kNone, weights->pointer(),
                              "the number of weights differs from the number of morph targets");
    for (std::uint32_t i = 0; i < range.count; ++i)
      all.push_back(weights && i < weights->size() ? weights->element(i).to_float() : 0.0f);
    return range;
  }

  void add_mesh(const Cursor& node_at, std::uint32_t node, const Cursor& mesh_at,
                std::uint32_t mesh_index, const PrimitiveGroup& group, const std::string& name,
                std::uint32_t first_morph_weight) {
    const std::string place =
        "mesh " + std::to_string(character_.meshes.size()) + " '" + name + "'";
    const Cursor primitives = mesh_at.member("primitives");
    AttributeReader attributes(reading_, primitives.element(group.primitives.front()), place);
    Mesh mesh;
    mesh.name = name;
    mesh.first_morph_weight = first_morph_weight;
    attributes.read_streams(mesh);
    attributes.read_morph_targets(mesh, target_names(mesh_at));

    SourceDocument::MeshOrigin origin{
        node, mesh_index, group.primitives, attributes.color_components(), false, false};
    origin.repaired = read_faces(primitives, group, mesh);
    origin.repaired |= attributes.repaired();
    // Triangles of one vertex cannot be told from removed ones, which are not written.
    if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(), is_retired)) {
      reading_.notes.dropped(StatusCode::empty_input, kNone, place, "the mesh has no triangle");
      return;
    }
    read_skin(node_at, node, attributes, place, mesh, origin);
    character_.meshes.push_back(std::move(mesh));
    result_.origins.push_back(std::move(origin));
  }

  bool read_faces(const Cursor& primitives, const PrimitiveGroup& group, Mesh& mesh) {
    bool repaired = false;
    for (const std::uint32_t index : group.primitives) {
      const Cursor primitive = primitives.element(index);
      ReadTriangles read = read_triangles(reading_, primitive, mesh.vertex_count());
      repaired |= read.repaired;
      if (mesh.triangles.size() + read.triangles.size() >= kNone / 3)
        refuse(StatusCode::limit_exceeded, index, "%s: too many triangles for 32-bit indices",
               primitive.pointer().c_str());
      if (mesh.triangles.empty())
        mesh.triangles = std::move(read.triangles);
      else
        mesh.triangles.insert(mesh.triangles.end(), read.triangles.begin(), read.triangles.end());
      mesh.triangle_submesh.resize(mesh.triangles.size(),
                                   static_cast<std::uint32_t>(mesh.submeshes.size()));
      const auto material = primitive.find("material");
      Submesh submesh;
      if (material) {
        submesh.material = material->to_index(count_of(reading_.json(), "materials"), "material");
        submesh.name = entry(reading_.json(), "materials", submesh.material).name();
      }
      if (std::string name = name_in_extras(primitive); !name.empty())
        submesh.name = std::move(name);
      mesh.submeshes.push_back(std::move(submesh));
    }
    return repaired;
  }

  void read_skin(const Cursor& node_at, std::uint32_t node, AttributeReader& attributes,
                 const std::string& place, Mesh& mesh, SourceDocument::MeshOrigin& origin) {
    const auto skin_at = node_at.find("skin");
    const auto sets = skin_at ? attributes.read_influences(mesh) : std::vector<InfluenceSet>();
    const std::uint64_t influences = sets.empty() ? 1 : 4 * sets.size();
    reading_.accessors.charge(mesh.vertex_count() * (influences * sizeof(Influence) + 4), place);
    if (reading_.keep_stored_influences)
      result_.stored.push_back(stored_influences(sets, mesh.vertex_count(),
                                                 "/meshes/" + std::to_string(origin.mesh) +
                                                     "/primitives/" +
                                                     std::to_string(origin.primitives.front())));
    if (sets.empty()) {
      if (skin_at)
        reading_.notes.inform(
            place, "its node has a skin, but the mesh has no weights; it moves with the node");
      mesh.skin = skins_.of_node(node);
      mesh.weights = rigid_weights(mesh.vertex_count());
      return;
    }
    const std::uint32_t gltf_skin = skin_at->to_index(count_of(reading_.json(), "skins"), "skin");
    mesh.skin = skins_.of_skin(gltf_skin);
    const auto slot_count = static_cast<std::uint32_t>(character_.skins[mesh.skin].bones.size());
    ReadWeights read = make_weights(sets, mesh.vertex_count(), slot_count,
                                    skins_.root_slot(gltf_skin), place, reading_.notes);
    mesh.weights = std::move(read.weights);
    origin.skinned = true;
    origin.repaired |= read.repaired;
  }

  Reading& reading_;
  const NodeSkeleton& nodes_;
  Character& character_;
  SkinReader skins_;
  ReadMeshes result_;
};

}  // namespace

ReadMeshes read_meshes(Reading& reading, const NodeSkeleton& nodes, Character& character) {
  MeshBuilder builder(reading, nodes, character);
  for (const std::uint32_t node : nodes.scene_nodes) builder.add_node(node);
  return builder.finish();
}

}  // namespace sunder::gltf
