#include "bench/tear/touch_baseline.h"

#include "bench/harness/measure.h"
#include "support/machine/random.h"

namespace sunder::bench {

TouchBaseline::TouchBaseline(const Scene& scene)
    : mesh_(scene.mesh()),
      vertex_count_(mesh_.vertex_count()),
      triangle_count_(mesh_.triangle_count()) {
  test::Random random(1);
  for (std::uint32_t i = 0; i < scene.faces_crossed; ++i)
    faces_.push_back(random.index(triangle_count_));
  for (int i = 0; i < 2; ++i) touch();  // so that the arrays have room
}

double TouchBaseline::run(Caches caches) {
  mesh_.positions.resize(vertex_count_);
  mesh_.normals.resize(vertex_count_);
  mesh_.uv_sets[0].resize(vertex_count_);
  mesh_.weights.influences.resize(mesh_.weights.first[vertex_count_]);
  mesh_.weights.first.resize(vertex_count_ + 1);
  mesh_.triangles.resize(triangle_count_);
  mesh_.triangle_submesh.resize(triangle_count_);
  if (caches == Caches::swept) sweep_caches();
  return seconds_of([&] { touch(); });
}

void TouchBaseline::touch() {
  for (const std::uint32_t face : faces_) {
    Vec3f position = Vec3f::Zero(), normal = Vec3f::Zero();
    Vec2f uv = Vec2f::Zero();
    std::array<Influence, 4> influences = {};
    for (const std::uint32_t vertex : mesh_.triangles[face]) {
      position += mesh_.positions[vertex];
      normal += mesh_.normals[vertex];
      uv += mesh_.uv_sets[0][vertex];
      const auto of_vertex = mesh_.weights.of(vertex);
      for (std::size_t i = 0; i < of_vertex.size(); ++i) {
        influences[i].slot = of_vertex[i].slot;
        influences[i].weight += of_vertex[i].weight;
      }
    }
    for (int lip = 0; lip < 2; ++lip) {
      mesh_.positions.push_back(position);
      mesh_.normals.push_back(normal);
      mesh_.uv_sets[0].push_back(uv);
      mesh_.weights.append(influences);
      mesh_.triangles.push_back(mesh_.triangles[face]);
      mesh_.triangle_submesh.push_back(mesh_.triangle_submesh[face]);
    }
  }
}

}  // namespace sunder::bench
