#include <sunder/core/character.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <unordered_set>

#include "core/internal/all_finite.h"
#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "core/internal/validate_clip.h"

namespace sunder {
namespace {

bool is_finite(const BoneTransform& transform) {
  return transform.translation.allFinite() && transform.rotation.coeffs().allFinite() &&
         transform.scale.allFinite();
}

Status validate_skeleton(const Skeleton& skeleton) {
  std::unordered_set<std::string_view> names;
  for (Index i = 0; i < skeleton.bones.size(); ++i) {
    const Bone& bone = skeleton.bones[i];
    if (bone.name.empty())
      return Status::failure(StatusCode::invalid_argument, i, "bone %u has no name", i);
    if (!names.insert(bone.name).second)
      return Status::failure(StatusCode::invalid_argument, i,
                             "bone %u: an earlier bone is also named '%.80s'", i,
                             bone.name.c_str());
    if (bone.parent != kNone && bone.parent >= i)
      return Status::failure(StatusCode::not_a_tree, i,
                             "bone %u '%.80s': its parent %u must have a lower index", i,
                             bone.name.c_str(), bone.parent);
    if (!is_finite(bone.rest))
      return Status::failure(StatusCode::non_finite_value, i,
                             "bone %u '%.80s': rest transform is not finite", i, bone.name.c_str());
    if (std::abs(norm(bone.rest.rotation) - 1.0f) > 1e-4f)
      return Status::failure(StatusCode::invalid_argument, i,
                             "bone %u '%.80s': rest rotation has length %g, not 1", i,
                             bone.name.c_str(), static_cast<double>(norm(bone.rest.rotation)));
  }
  return {};
}

Status validate_skin(const Skin& skin, Index index, std::size_t bone_count) {
  if (skin.bones.empty())
    return Status::failure(StatusCode::empty_input, index, "skin %u has no bones", index);
  if (skin.bones.size() != skin.bone_from_bind.size())
    return Status::failure(StatusCode::size_mismatch, index,
                           "skin %u: it has %zu bones, but %zu bind matrices", index,
                           skin.bones.size(), skin.bone_from_bind.size());
  for (Index slot = 0; slot < skin.bones.size(); ++slot) {
    if (skin.bones[slot] >= bone_count)
      return Status::failure(StatusCode::index_out_of_range, slot,
                             "skin %u slot %u: bone %u does not exist; the skeleton has %zu bones",
                             index, slot, skin.bones[slot], bone_count);
    if (!skin.bone_from_bind[slot].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, slot,
                             "skin %u slot %u: bind matrix is not finite", index, slot);
  }
  return {};
}

/// The name of the mesh, for error texts.
struct MeshPlace {
  Index index;
  const char* name;
};

template <class T>
Status validate_stream(const MeshPlace& mesh, const char* what, const std::vector<T>& stream,
                       std::size_t vertex_count, bool may_be_absent) {
  if (stream.empty() && may_be_absent) return {};
  if (stream.size() != vertex_count)
    return Status::failure(StatusCode::size_mismatch, mesh.index,
                           "mesh %u '%.60s': %zu %s for %zu vertices", mesh.index, mesh.name,
                           stream.size(), what, vertex_count);
  if (all_finite(stream)) return {};
  for (Index v = 0; v < stream.size(); ++v)
    if (!stream[v].allFinite())
      return Status::failure(StatusCode::non_finite_value, v,
                             "mesh %u '%.60s': vertex %u: %s not finite", mesh.index, mesh.name, v,
                             what);
  return {};
}

Status validate_weights(const MeshPlace& mesh, const SkinWeights& weights, std::size_t vertex_count,
                        std::size_t slot_count) {
  const auto& first = weights.first;
  if (first.size() != vertex_count + 1 || first.front() != 0 ||
      first.back() != weights.influences.size())
    return Status::failure(StatusCode::size_mismatch, mesh.index,
                           "mesh %u '%.60s': influence offsets do not fit %zu vertices", mesh.index,
                           mesh.name, vertex_count);
  for (Index v = 0; v < vertex_count; ++v) {
    if (first[v + 1] <= first[v] || first[v + 1] > weights.influences.size())
      return Status::failure(StatusCode::size_mismatch, v,
                             "mesh %u '%.60s': vertex %u has no influence", mesh.index, mesh.name,
                             v);
    const auto influences = weights.of(v);
    double sum = 0;
    for (std::size_t i = 0; i < influences.size(); ++i) {
      const Influence& influence = influences[i];
      if (influence.slot >= slot_count)
        return Status::failure(
            StatusCode::index_out_of_range, v,
            "mesh %u '%.60s': vertex %u: slot %u does not exist; the skin has %zu", mesh.index,
            mesh.name, v, influence.slot, slot_count);
      if (!(influence.weight > 0.0f) || !std::isfinite(influence.weight))
        return Status::failure(StatusCode::weights_not_normalized, v,
                               "mesh %u '%.60s': vertex %u: weight %g is not in (0, 1]", mesh.index,
                               mesh.name, v, static_cast<double>(influence.weight));
      for (std::size_t j = 0; j < i; ++j)
        if (influences[j].slot == influence.slot)
          return Status::failure(StatusCode::invalid_argument, v,
                                 "mesh %u '%.60s': vertex %u: slot %u occurs twice", mesh.index,
                                 mesh.name, v, influence.slot);
      sum += static_cast<double>(influence.weight);
    }
    if (std::abs(sum - 1.0) > 2e-7 * static_cast<double>(influences.size()))
      return Status::failure(StatusCode::weights_not_normalized, v,
                             "mesh %u '%.60s': vertex %u: the weights sum to %.9g, not 1",
                             mesh.index, mesh.name, v, sum);
  }
  return {};
}

Status validate_attributes(const MeshPlace& place, const Mesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (Status status = validate_stream(place, "positions", mesh.positions, count, false); !status)
    return status;
  if (Status status = validate_stream(place, "normals", mesh.normals, count, true); !status)
    return status;
  if (Status status = validate_stream(place, "tangents", mesh.tangents, count, true); !status)
    return status;
  for (const auto& uv : mesh.uv_sets)
    if (Status status = validate_stream(place, "texture coordinates", uv, count, false); !status)
      return status;
  for (const auto& colors : mesh.color_sets)
    if (Status status = validate_stream(place, "colours", colors, count, false); !status)
      return status;
  for (const MorphTarget& target : mesh.morph_targets) {
    if (Status status =
            validate_stream(place, "morph positions", target.position_deltas, count, true);
        !status)
      return status;
    if (Status status = validate_stream(place, "morph normals", target.normal_deltas, count, true);
        !status)
      return status;
    if (Status status =
            validate_stream(place, "morph tangents", target.tangent_deltas, count, true);
        !status)
      return status;
  }
  for (const CustomAttribute& attribute : mesh.custom_attributes) {
    if (attribute.components < 1 || attribute.components > 4 ||
        attribute.values.size() != count * attribute.components)
      return Status::failure(StatusCode::size_mismatch, place.index,
                             "mesh %u '%.60s': attribute '%.60s' does not fit %zu vertices",
                             place.index, place.name, attribute.name.c_str(), count);
    if (all_finite(attribute.values)) continue;
    for (std::size_t i = 0; i < attribute.values.size(); ++i)
      if (!std::isfinite(attribute.values[i])) {
        const auto vertex = static_cast<Index>(i / attribute.components);
        return Status::failure(StatusCode::non_finite_value, vertex,
                               "mesh %u '%.60s': vertex %u: attribute '%.60s' not finite",
                               place.index, place.name, vertex, attribute.name.c_str());
      }
  }
  return {};
}

Status validate_mesh(const Character& character, Index index) {
  const Mesh& mesh = character.meshes[index];
  const MeshPlace place{index, mesh.name.c_str()};
  if (mesh.skin >= character.skins.size())
    return Status::failure(StatusCode::index_out_of_range, index,
                           "mesh %u '%.60s': skin %u does not exist; there are %zu", index,
                           place.name, mesh.skin, character.skins.size());
  if (mesh.positions.size() >= kNone || mesh.triangles.size() >= kNone / 3)
    return Status::failure(StatusCode::limit_exceeded, index,
                           "mesh %u '%.60s' is too large for 32-bit indices", index, place.name);
  if (Status status = validate_attributes(place, mesh); !status) return status;
  if (Status status = validate_weights(place, mesh.weights, mesh.positions.size(),
                                       character.skins[mesh.skin].bones.size());
      !status)
    return status;
  // Sums and products are of 64 bits where std::size_t is not (WebAssembly).
  const std::uint64_t last_weight =
      std::uint64_t{mesh.first_morph_weight} + mesh.morph_targets.size();
  if (last_weight > character.rest_morph_weights.size())
    return Status::failure(StatusCode::index_out_of_range, index,
                           "mesh %u '%.60s': uses morph weights [%u, %llu); the character has %zu",
                           index, place.name, mesh.first_morph_weight,
                           static_cast<unsigned long long>(last_weight),
                           character.rest_morph_weights.size());
  if (mesh.triangle_submesh.size() != mesh.triangles.size())
    return Status::failure(StatusCode::size_mismatch, index,
                           "mesh %u '%.60s': triangle_submesh has %zu entries for %zu triangles",
                           index, place.name, mesh.triangle_submesh.size(), mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index vertex : mesh.triangles[t])
      if (vertex >= mesh.positions.size())
        return Status::failure(
            StatusCode::index_out_of_range, t,
            "mesh %u '%.60s': triangle %u: vertex %u does not exist; there are %zu", index,
            place.name, t, vertex, mesh.positions.size());
    if (mesh.triangle_submesh[t] >= mesh.submeshes.size())
      return Status::failure(
          StatusCode::index_out_of_range, t,
          "mesh %u '%.60s': triangle %u: submesh %u does not exist; there are %zu", index,
          place.name, t, mesh.triangle_submesh[t], mesh.submeshes.size());
  }
  return {};
}

/// @param place  the clip, for texts: "clip 2 'Walk'".
Status validate_channel(const Character& character, const Channel& channel, const char* place,
                        Index index) {
  const auto fail = [&](StatusCode code, const char* what) {
    return Status::failure(code, index, "%s: channel %u: %s", place, index, what);
  };
  const bool morphs = channel.target == ChannelTarget::morph_weights;
  const std::size_t target_count =
      morphs ? character.rest_morph_weights.size() : character.skeleton.bones.size();
  const std::uint64_t last = std::uint64_t{channel.index} + (morphs ? channel.width : 1);
  if (channel.width == 0 || last > target_count)
    return fail(StatusCode::index_out_of_range, "its target does not exist");
  if (!morphs && channel.width != (channel.target == ChannelTarget::rotation ? 4u : 3u))
    return fail(StatusCode::size_mismatch, "wrong number of floats per key");
  if (channel.times.empty()) return fail(StatusCode::empty_input, "it has no key");
  const std::uint64_t values_per_key = channel.interpolation == Interpolation::cubic_spline ? 3 : 1;
  if (channel.values.size() != std::uint64_t{channel.times.size()} * channel.width * values_per_key)
    return fail(StatusCode::size_mismatch,
                "the number of values does not match the number of times");
  float previous = -1.0f;
  for (const float time : channel.times) {
    if (!std::isfinite(time) || time < 0.0f || time <= previous)
      return fail(StatusCode::invalid_argument, "key times must be finite, >= 0 and increase");
    previous = time;
  }
  if (!all_finite(channel.values))
    return fail(StatusCode::non_finite_value, "a key value is not finite");
  return {};
}

Status validate_channels(const Character& character, const Clip& clip, const char* place) {
  for (Index i = 0; i < clip.channels.size(); ++i)
    if (Status status = validate_channel(character, clip.channels[i], place, i); !status)
      return status;
  return {};
}

Status validate(const Character& character) {
  if (character.meshes.empty())
    return Status::failure(StatusCode::empty_input, kNone, "the character has no mesh");
  if (Status status = validate_skeleton(character.skeleton); !status) return status;
  for (Index i = 0; i < character.skins.size(); ++i)
    if (Status status = validate_skin(character.skins[i], i, character.skeleton.bones.size());
        !status)
      return status;
  for (Index i = 0; i < character.rest_morph_weights.size(); ++i)
    if (!std::isfinite(character.rest_morph_weights[i]))
      return Status::failure(StatusCode::non_finite_value, i, "rest morph weight %u is not finite",
                             i);
  for (Index i = 0; i < character.meshes.size(); ++i)
    if (Status status = validate_mesh(character, i); !status) return status;
  for (Index clip = 0; clip < character.clips.size(); ++clip) {
    char place[96];
    std::snprintf(place, sizeof place, "clip %u '%.60s'", clip, character.clips[clip].name.c_str());
    if (Status status = validate_channels(character, character.clips[clip], place); !status)
      return status;
  }
  return {};
}

}  // namespace

Status validate_character(const Character& character) {
  return or_out_of_memory([&] { return validate(character); });
}

Status validate_clip(const Character& character, const Clip& clip) {
  char place[80];
  std::snprintf(place, sizeof place, "clip '%.60s'", clip.name.c_str());
  return validate_channels(character, clip, place);
}

}  // namespace sunder
