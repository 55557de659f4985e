#include "bench/tear/model_memory.h"

#include <cstdlib>
#include <utility>

#include "bench/harness/measure.h"
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

constexpr int kInstances = 100;

TornModel model_of(const std::shared_ptr<const TornAsset>& asset) {
  auto model = TornModel::create(asset);
  if (!model) std::abort();
  return std::move(*model);
}

/// Bytes of a model that has a workspace of this capacity.
double bytes_with(const Scene& scene, const TornCapacity& capacity) {
  const std::uint64_t before = bytes_in_use();
  const auto model = TornModel::create(scene.character, capacity);
  if (!model) std::abort();
  return static_cast<double>(bytes_in_use() - before);
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

InstanceCosts instance_costs(const Scene& scene) {
  InstanceCosts costs;
  const auto asset = TornAsset::create(scene.character);
  if (!asset || !(*asset)->prepare()) std::abort();
  std::vector<TornModel> models;
  models.reserve(kInstances);
  const std::uint64_t before = bytes_in_use();
  costs.us_create = 1e6 / kInstances * seconds_of([&] {
                      while (models.size() < kInstances) models.push_back(model_of(*asset));
                    });
  costs.untouched_bytes = static_cast<double>(bytes_in_use() - before) / kInstances;

  for (int turn = 0; turn < 2; ++turn) {  // the first one warms up
    TornModel model = model_of(*asset);
    if (!model.tear(scene.poses[0], scene.stroke)) std::abort();
    const double vertices =
        model.character().meshes[0].vertex_count() - scene.mesh().vertex_count();
    costs.us_pack = 1e6 * seconds_of([&] { (void)model.pack(); });
    const TornMemory memory = model.memory_bytes();
    costs.packed_bytes_per_vertex = static_cast<double>(memory.own + memory.reserved) / vertices;
    costs.us_unpack = 1e6 * seconds_of([&] { (void)model.unpack(); });
  }
  const double least = bytes_with(scene, {1000, 2000, 4});
  costs.capacity_bytes_per_vertex = (bytes_with(scene, {21000, 42000, 4}) - least) / 20000;
  costs.capacity_bytes_per_operation = (bytes_with(scene, {1000, 2000, 68}) - least) / 64;
  return costs;
}

}  // namespace sunder::bench
