// One tear across about 60 faces of a tube of 64 bones in a bent pose, on meshes of 3.5 thousand to 173 thousand vertices.
#include <sunder/skinning/palette.h>
#include <sunder/skinning/reference.h>
#include <sunder/tear/torn_model.h>

#include <cmath>

#include <benchmark/benchmark.h>

#include "support/rigs.h"

namespace sunder {
namespace {

struct Scene {
  explicit Scene(std::uint32_t sides) : character(std::make_shared<const Character>(test::make_tube(sides, sides, 64))) {
    test::Random random(1);
    pose = test::random_pose(*character, random, 0.05, 1.0);
    // The stroke follows about 30 squares of the mesh, whatever their size: the tear is the same, the model grows.
    const double faces = 30.0 / sides;
    stroke = test::random_stroke(*character, pose, random, faces, 4);
  }
  std::shared_ptr<const Character> character;
  ModelPose pose;
  Stroke stroke;
};

void tear_once(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  TearReport report;
  for (auto _ : state) {
    state.PauseTiming();
    auto model = TornModel::create(scene.character);
    state.ResumeTiming();
    const auto torn = model->tear(scene.pose, scene.stroke);
    if (!torn || torn->runs == 0) state.SkipWithError("the stroke tore nothing");
    if (torn) report = *torn;
    state.PauseTiming();
    model = Status();  // destroyed outside of what is measured
    state.ResumeTiming();
  }
  state.counters["vertices"] = scene.character->meshes[0].vertex_count();
  state.counters["faces_crossed"] = report.faces_crossed;
}

void build_model(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(TornModel::create(scene.character));
  state.counters["vertices"] = scene.character->meshes[0].vertex_count();
  state.counters["per_face"] = benchmark::Counter(static_cast<double>(scene.character->meshes[0].triangle_count()),
                                                  benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Baseline: poses every vertex once, in double, as a tool that works on the whole model must.
void pose_whole_model(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(test::posed_positions(*scene.character, 0, scene.pose));
  state.counters["vertices"] = scene.character->meshes[0].vertex_count();
}

BENCHMARK(tear_once)->Arg(59)->Arg(187)->Arg(416)->Unit(benchmark::kMicrosecond);
BENCHMARK(pose_whole_model)->Arg(59)->Arg(187)->Arg(416)->Unit(benchmark::kMicrosecond);
BENCHMARK(build_model)->Arg(59)->Arg(187)->Arg(416)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sunder
