// Skinning of a tube of 64 bones, about four influences a vertex, with one morph target: positions, normals. Nanoseconds a vertex.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/palette.h>
#include <sunder/skinning/reference.h>

#include <benchmark/benchmark.h>

#include "support/rigs.h"

namespace sunder {
namespace {

struct Scene {
  explicit Scene(std::uint32_t rings) : character(test::make_tube(rings, 64, 64)), palette(64), float_palette(64) {
    test::Random random(1);
    pose = test::random_pose(character, random);
    if (!compute_palette(character.skins[0], pose, std::span(palette))) std::abort();
    if (!compute_palette(character.skins[0], pose, std::span(float_palette))) std::abort();
  }
  Character character;
  ModelPose pose;
  std::vector<Affine3d> palette;
  std::vector<Affine3f> float_palette;
};

void report(benchmark::State& state, const Mesh& mesh) {
  state.counters["vertices"] = mesh.vertex_count();
  state.counters["per_vertex"] = benchmark::Counter(static_cast<double>(mesh.vertex_count()),
                                                    benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void deform_float(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  DeformedMesh deformed;
  for (auto _ : state) {
    if (!deform_mesh(scene.character.meshes[0], scene.float_palette, scene.pose.morph_weights, deformed))
      state.SkipWithError("failed");
    benchmark::DoNotOptimize(deformed.positions.data());
  }
  report(state, scene.character.meshes[0]);
}

void deform_reference(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  const Mesh& mesh = scene.character.meshes[0];
  for (auto _ : state)
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      benchmark::DoNotOptimize(deform_position_reference(mesh, v, scene.palette, scene.pose.morph_weights));
      benchmark::DoNotOptimize(deform_normal_reference(mesh, v, scene.palette, scene.pose.morph_weights));
    }
  report(state, mesh);
}

/// Lower bound: reads what skinning reads and writes what it writes.
void touch_memory(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  const Mesh& mesh = scene.character.meshes[0];
  std::vector<Vec3f> positions(mesh.vertex_count()), normals(mesh.vertex_count());
  for (auto _ : state) {
    float sum = 0;
    for (const Influence& influence : mesh.weights.influences) sum += influence.weight;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      positions[v] = mesh.positions[v] + mesh.morph_targets[0].position_deltas[v];
      normals[v] = mesh.normals[v];
    }
    benchmark::DoNotOptimize(sum);
    benchmark::DoNotOptimize(positions.data());
    benchmark::DoNotOptimize(normals.data());
  }
  report(state, mesh);
}

BENCHMARK(deform_float)->Arg(54)->Arg(540)->Arg(2700);
BENCHMARK(deform_reference)->Arg(54)->Arg(540)->Arg(2700);
BENCHMARK(touch_memory)->Arg(54)->Arg(540)->Arg(2700);

}  // namespace
}  // namespace sunder
