#include "bench/model_memory.h"

#include <cstdlib>

#include "bench/measure.h"
#include "tear/posed/posed_points.h"

namespace sunder::bench {
namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

/// All arrays that grow with the model.
std::uint64_t bytes_of(const Mesh& mesh) {
  std::uint64_t bytes = bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.tangents);
  for (const auto& uv : mesh.uv_sets) bytes += bytes_of(uv);
  for (const auto& colors : mesh.color_sets) bytes += bytes_of(colors);
  for (const CustomAttribute& attribute : mesh.custom_attributes)
    bytes += bytes_of(attribute.values);
  for (const MorphTarget& target : mesh.morph_targets)
    bytes += bytes_of(target.position_deltas) + bytes_of(target.normal_deltas) +
             bytes_of(target.tangent_deltas);
  bytes += bytes_of(mesh.weights.first) + bytes_of(mesh.weights.influences);
  return bytes + bytes_of(mesh.triangles) + bytes_of(mesh.triangle_submesh);
}

}  // namespace

BytesPerPoint bytes_per_point(const Scene& scene) {
  const std::uint64_t before = bytes_in_use();
  auto model = TornModel::create(scene.character);
  if (!model || !model->tear(scene.poses[0], scene.stroke)) std::abort();
  std::uint64_t copy = 0;
  for (const Mesh& mesh : model->character().meshes) copy += bytes_of(mesh);
  const std::uint64_t all = bytes_in_use() - before - copy;
  const std::uint64_t without = bytes_in_use();
  tear::PosedPoints posed;
  posed.cover(model->point_count());
  const std::uint64_t of_posed_points = bytes_in_use() - without;
  const double points = model->point_count();
  return {static_cast<double>(all - of_posed_points) / points,
          static_cast<double>(of_posed_points) / points};
}

}  // namespace sunder::bench
