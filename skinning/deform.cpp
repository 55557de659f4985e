#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>

namespace sunder {

Status deform_mesh(const Mesh& mesh, std::span<const Affine3f> model_from_bind,
                   std::span<const float> morph_weights, DeformedMesh& out) {
  if (mesh.first_morph_weight + mesh.morph_targets.size() > morph_weights.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "mesh '%.80s' uses morph weights up to %zu; the pose has %zu",
                           mesh.name.c_str(), mesh.first_morph_weight + mesh.morph_targets.size(),
                           morph_weights.size());
  for (const Influence& influence : mesh.weights.influences)
    if (influence.slot >= model_from_bind.size())
      return Status::failure(StatusCode::size_mismatch, influence.slot,
                             "mesh '%.80s' uses bone slot %u; the palette has %zu",
                             mesh.name.c_str(), influence.slot, model_from_bind.size());
  const Result<SkinnedMesh> skinned = SkinnedMesh::create(source_of(mesh), model_from_bind.size());
  if (!skinned) return skinned.error();
  BonePalette palette(model_from_bind.size(), morph_weights.size());
  if (const Status status = palette.set(model_from_bind, morph_weights); !status) return status;

  VertexTarget target;
  target.vertex_count = mesh.vertex_count();
  target.unit_length = true;
  out.positions.resize(mesh.positions.size());
  out.normals.resize(mesh.normals.size());
  out.tangents.resize(mesh.tangents.size());
  if (!out.positions.empty()) target.positions.data = out.positions[0].data();
  if (!out.normals.empty()) target.normals.data = out.normals[0].data();
  if (!out.tangents.empty()) target.tangents.data = out.tangents[0].data();
  PosedBuffer buffer(target);
  return skinned->deform(palette, buffer);
}

}  // namespace sunder
