#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>

#include <utility>

#include "core/internal/out_of_memory.h"

namespace sunder {

Status deform_mesh(const Mesh& mesh, std::span<const Affine3f> model_from_bind,
                   std::span<const float> morph_weights, DeformedMesh& out) {
  const std::uint64_t last_weight =
      std::uint64_t{mesh.first_morph_weight} + mesh.morph_targets.size();
  if (last_weight > morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "mesh '%.80s' uses morph weights up to %llu; the pose has %zu",
                           mesh.name.c_str(), static_cast<unsigned long long>(last_weight),
                           morph_weights.size());
  for (const Influence& influence : mesh.weights.influences)
    if (influence.slot >= model_from_bind.size())
      return Status::failure(StatusCode::size_mismatch, influence.slot,
                             "mesh '%.80s' uses bone slot %u; the palette has %zu",
                             mesh.name.c_str(), influence.slot, model_from_bind.size());
  const Result<SkinnedMesh> skinned =
      SkinnedMesh::create(source_of(mesh), model_from_bind.size(), VertexGathering::none);
  if (!skinned) return skinned.error();
  Result<BonePalette> palette = BonePalette::create(model_from_bind.size(), morph_weights.size());
  if (!palette) return palette.error();
  if (const Status status = palette->set(model_from_bind, morph_weights); !status) return status;

  return or_out_of_memory([&]() -> Status {
    DeformedMesh made;
    made.positions.resize(mesh.positions.size());
    made.normals.resize(mesh.normals.size());
    made.tangents.resize(mesh.tangents.size());
    VertexTarget target;
    target.vertex_count = mesh.vertex_count();
    target.unit_length = true;
    if (!made.positions.empty()) target.positions.data = made.positions[0].data();
    if (!made.normals.empty()) target.normals.data = made.normals[0].data();
    if (!made.tangents.empty()) target.tangents.data = made.tangents[0].data();
    PosedBuffer buffer(target);
    if (const Status status = skinned->deform(*palette, buffer); !status) return status;
    out = std::move(made);
    return {};
  });
}

}  // namespace sunder
