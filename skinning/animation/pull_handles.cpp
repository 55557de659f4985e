#include <sunder/animation/pull.h>

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

Status check_place(const Character& character, std::uint32_t mesh, std::uint32_t triangle,
                   const Vec3d& barycentrics, std::span<const float> morph_weights) {
  if (mesh >= character.meshes.size())
    return Status::failure(StatusCode::index_out_of_range, mesh,
                           "mesh %u does not exist; the character has %zu", mesh,
                           character.meshes.size());
  if (triangle >= character.meshes[mesh].triangles.size())
    return Status::failure(StatusCode::index_out_of_range, triangle,
                           "mesh %u: triangle %u does not exist; there are %zu", mesh, triangle,
                           character.meshes[mesh].triangles.size());
  if (!morph_weights.empty() && morph_weights.size() != character.rest_morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "there are %zu morph weights, the character has %zu",
                           morph_weights.size(), character.rest_morph_weights.size());
  const double sum = barycentrics.x() + barycentrics.y() + barycentrics.z();
  if (!(barycentrics.minCoeff() >= 0.0) || !(std::abs(sum - 1.0) <= 1e-6))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the barycentrics are %g, %g, %g, but must be >= 0 and sum to 1",
                           barycentrics.x(), barycentrics.y(), barycentrics.z());
  return {};
}

Vec3d bind_position(const Mesh& mesh, std::uint32_t vertex, std::span<const float> morph_weights) {
  Vec3d position = mesh.positions[vertex].cast<double>();
  for (std::size_t i = 0; i < mesh.morph_targets.size() && !morph_weights.empty(); ++i)
    if (const auto& deltas = mesh.morph_targets[i].position_deltas; !deltas.empty())
      position += static_cast<double>(morph_weights[mesh.first_morph_weight + i]) *
                  deltas[vertex].cast<double>();
  return position;
}

/// Adds a weighted point of a bone to a handle; `Part::point` is a weighted sum until finish().
void add_part(PullHandle& handle, std::uint32_t bone, double weight, const Vec3d& point) {
  auto part = std::find_if(handle.parts.begin(), handle.parts.end(),
                           [&](const PullHandle::Part& other) { return other.bone == bone; });
  if (part == handle.parts.end())
    part = handle.parts.insert(part, {bone, 0.0, Vec3d(Vec3d::Zero())});
  part->weight += weight;
  part->point += weight * point;
}

void finish(PullHandle& handle) {
  double sum = 0;
  std::erase_if(handle.parts, [](const PullHandle::Part& part) { return !(part.weight > 0.0); });
  for (const PullHandle::Part& part : handle.parts) sum += part.weight;
  for (PullHandle::Part& part : handle.parts) {
    part.point /= part.weight;
    part.weight /= sum;
  }
}

}  // namespace

std::uint32_t PullHandle::main_bone() const {
  const Part* heaviest = nullptr;
  for (const Part& part : parts)
    if (heaviest == nullptr || part.weight > heaviest->weight ||
        (part.weight == heaviest->weight && part.bone > heaviest->bone))
      heaviest = &part;
  return heaviest == nullptr ? kNone : heaviest->bone;
}

PullHandle handle_on_bone(std::uint32_t bone, const Vec3d& point) { return {{{bone, 1.0, point}}}; }

Result<PullHandle> handle_on_surface(const Character& character, std::uint32_t mesh,
                                     std::uint32_t triangle, const Vec3d& barycentrics,
                                     std::span<const float> morph_weights) {
  if (const Status status = check_place(character, mesh, triangle, barycentrics, morph_weights);
      !status)
    return status;
  return or_out_of_memory([&]() -> Result<PullHandle> {
    const Mesh& on = character.meshes[mesh];
    const Skin& skin = character.skins[on.skin];
    PullHandle handle;
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t vertex = on.triangles[triangle][static_cast<std::size_t>(corner)];
      const Vec3d position = bind_position(on, vertex, morph_weights);
      for (const Influence& influence : on.weights.of(vertex))
        add_part(handle, skin.bones[influence.slot],
                 barycentrics[corner] * static_cast<double>(influence.weight),
                 transform(skin.bone_from_bind[influence.slot].cast<double>(), position));
    }
    finish(handle);
    return handle;
  });
}

Result<std::vector<std::uint32_t>> chain_between(const Skeleton& skeleton, std::uint32_t root,
                                                 std::uint32_t bone) {
  const std::size_t count = skeleton.bones.size();
  for (const std::uint32_t end : {root, bone})
    if (end >= count)
      return Status::failure(StatusCode::index_out_of_range, end,
                             "bone %u does not exist; the skeleton has %zu", end, count);
  return or_out_of_memory([&]() -> Result<std::vector<std::uint32_t>> {
    std::vector<std::uint32_t> chain;
    for (std::uint32_t at = bone; at != kNone; at = skeleton.bones[at].parent) {
      chain.push_back(at);
      if (at != root) continue;
      std::reverse(chain.begin(), chain.end());
      return chain;
    }
    return Status::failure(StatusCode::not_found, root, "bone %u is not above bone %u", root, bone);
  });
}

}  // namespace sunder
