#include <sunder/tear/torn_model.h>

#include "tear/model/model_access.h"

namespace sunder {

std::span<const SutureThread> threads_of(const TornModel& model) {
  if (model.undo_count() == 0) return {};
  return tear::ModelAccess::state_of(model).editor.connectivity.threads();
}

MeshVertex vertex_at(const TornModel& model, std::uint32_t point) {
  const tear::Surface& surface = model.surface();
  const std::uint32_t corner = surface.point_corner[point];
  if (corner == kNone) return {};
  const tear::TriangleRef ref = surface.triangle(corner / 3);
  return {ref.mesh, model.character().meshes[ref.mesh].triangles[ref.triangle][corner % 3]};
}

}  // namespace sunder
