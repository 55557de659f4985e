#include "tools/page_parts/model_section.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sunder::tools {
namespace {

/// The vertices of all meshes, back to back.
struct ModelSurface {
  std::vector<float> positions;                ///< 3 V, bind space.
  std::vector<std::int16_t> normals;           ///< 3 V, normalised; zeros: the page makes its own.
  std::vector<std::uint32_t> indices;          ///< 3 per triangle.
  std::vector<std::uint8_t> influence_counts;  ///< V.
  std::vector<std::uint16_t> influence_slots;  ///< Of all slots of the character.
  std::vector<float> influence_weights;
};

void append_vertices(const Mesh& mesh, ModelSurface& surface) {
  for (const Vec3f& position : mesh.positions)
    surface.positions.insert(surface.positions.end(), position.data(), position.data() + 3);
  const float unit = std::numeric_limits<std::int16_t>::max();
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    for (int axis = 0; axis < 3; ++axis) {
      const float value = mesh.normals.empty() ? 0.0f : mesh.normals[v][axis];
      surface.normals.push_back(
          static_cast<std::int16_t>(std::lround(unit * std::clamp(value, -1.0f, 1.0f))));
    }
}

void append_triangles(const Mesh& mesh, Index first_vertex, ModelSurface& surface) {
  for (const Triangle& triangle : mesh.triangles)
    if (!is_retired(triangle))
      for (const Index vertex : triangle) surface.indices.push_back(first_vertex + vertex);
}

Status append_influences(const Mesh& mesh, Index first_slot, ModelSurface& surface) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const auto influences = mesh.weights.of(v);
    if (influences.size() > std::numeric_limits<std::uint8_t>::max())
      return Status::failure(StatusCode::limit_exceeded, v,
                             "the page shows at most 255 influences per vertex, this has %zu",
                             influences.size());
    surface.influence_counts.push_back(static_cast<std::uint8_t>(influences.size()));
    for (const Influence& influence : influences) {
      surface.influence_slots.push_back(static_cast<std::uint16_t>(first_slot + influence.slot));
      surface.influence_weights.push_back(influence.weight);
    }
  }
  return {};
}

/// The morph targets of a mesh: the vertices that they move, and by how much.
void append_morphs(const Mesh& mesh, Index first_vertex, DataArrays& arrays, Json& morphs) {
  for (std::size_t target = 0; target < mesh.morph_targets.size(); ++target) {
    const std::vector<Vec3f>& all = mesh.morph_targets[target].position_deltas;
    std::vector<std::uint32_t> vertices;
    std::vector<float> deltas;
    for (Index v = 0; v < all.size(); ++v) {
      if (all[v] == Vec3f::Zero()) continue;
      vertices.push_back(first_vertex + v);
      deltas.insert(deltas.end(), all[v].data(), all[v].data() + 3);
    }
    if (!vertices.empty())
      morphs.push_back({{"weight", mesh.first_morph_weight + target},
                        {"vertices", arrays.add(vertices)},
                        {"deltas", arrays.add(deltas)}});
  }
}

Json bone_names(const Skeleton& skeleton) {
  Json names = Json::array();
  for (const Bone& bone : skeleton.bones) names.push_back(bone.name);
  return names;
}

Status add_slots(const Character& character, const std::vector<Index>& source_bone,
                 DataArrays& arrays, Json& section) {
  const Result<std::vector<DrivenSlot>> slots = driven_slots(character, source_bone);
  if (!slots) return slots.error();
  std::vector<std::uint32_t> bones, source_bones;
  for (const Skin& skin : character.skins)
    bones.insert(bones.end(), skin.bones.begin(), skin.bones.end());
  std::vector<Affine3d> matrices;
  for (const DrivenSlot& slot : *slots) {
    source_bones.push_back(slot.source_bone);
    matrices.push_back(slot.bone_from_bind);
  }
  section["slot_bones"] = arrays.add(bones);
  section["slot_source_bones"] = arrays.add(source_bones);
  section["slot_matrices"] = matrices_json(matrices, arrays);
  return {};
}

}  // namespace

std::vector<Index> own_bones(const Skeleton& skeleton) {
  std::vector<Index> bones(skeleton.bones.size());
  std::iota(bones.begin(), bones.end(), Index{0});
  return bones;
}

Json matrices_json(std::span<const Affine3d> matrices, DataArrays& arrays) {
  std::vector<double> numbers;
  for (const Affine3d& matrix : matrices)
    numbers.insert(numbers.end(), matrix.data(), matrix.data() + 12);
  return arrays.add(numbers);
}

Result<std::vector<DrivenSlot>> driven_slots(const Character& character,
                                             const std::vector<Index>& source_bone) {
  const Result<ModelPose> bind = bind_pose(character);
  if (!bind) return bind.error();
  std::vector<DrivenSlot> slots;
  for (const Skin& skin : character.skins)
    for (std::size_t slot = 0; slot < skin.bones.size(); ++slot) {
      const Index bone = skin.bones[slot];
      Index ancestor = bone;
      while (ancestor != kNone && source_bone[ancestor] == kNone)
        ancestor = character.skeleton.bones[ancestor].parent;
      DrivenSlot driven;
      driven.bone_from_bind = skin.bone_from_bind[slot].cast<double>();
      if (ancestor != bone)  // rigid with its ancestor, or where it stands
        driven.bone_from_bind = bind->model_from_bone[bone] * driven.bone_from_bind;
      if (ancestor != kNone) {
        driven.source_bone = source_bone[ancestor];
        if (ancestor != bone)
          driven.bone_from_bind = bind->model_from_bone[ancestor].inverse() * driven.bone_from_bind;
      }
      slots.push_back(driven);
    }
  return slots;
}

Result<Json> model_section(const Character& character, const std::string& title,
                           const std::vector<Index>& source_bone, DataArrays& arrays) {
  std::vector<Index> first_slot;
  std::size_t slots = 0;
  for (const Skin& skin : character.skins) {
    first_slot.push_back(static_cast<Index>(slots));
    slots += skin.bones.size();
  }
  if (slots > std::numeric_limits<std::uint16_t>::max())
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "the page shows at most 65535 slots of skins, these are %zu", slots);
  ModelSurface surface;
  Json meshes = Json::array(), morphs = Json::array();
  for (const Mesh& mesh : character.meshes) {
    const auto first_vertex = static_cast<Index>(surface.influence_counts.size());
    append_vertices(mesh, surface);
    append_triangles(mesh, first_vertex, surface);
    if (Status status = append_influences(mesh, first_slot[mesh.skin], surface); !status)
      return status;
    append_morphs(mesh, first_vertex, arrays, morphs);
    meshes.push_back({{"name", mesh.name},
                      {"first_vertex", first_vertex},
                      {"vertex_count", mesh.vertex_count()}});
  }
  Json section = {{"title", title},
                  {"meshes", std::move(meshes)},
                  {"bones", bone_names(character.skeleton)},
                  {"source_bones", arrays.add(source_bone)},
                  {"positions", arrays.add(surface.positions)},
                  {"normals", arrays.add(surface.normals)},
                  {"indices", arrays.add(surface.indices)},
                  {"influence_counts", arrays.add(surface.influence_counts)},
                  {"influence_slots", arrays.add(surface.influence_slots)},
                  {"influence_weights", arrays.add(surface.influence_weights)},
                  {"morphs", std::move(morphs)},
                  {"morph_weights", arrays.add(character.rest_morph_weights)}};
  if (const Status status = add_slots(character, source_bone, arrays, section); !status)
    return status;
  return section;
}

}  // namespace sunder::tools
