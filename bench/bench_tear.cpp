// Operations on a tube of 64 bones in a bent pose, on meshes of 3.5 thousand to 173 thousand vertices: a tear across about 60 faces
// with and without width, a cut, a bore, undo and redo, and a stroke that arrives in 200 pieces.
#include <sunder/skinning/palette.h>
#include <sunder/skinning/reference.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <chrono>
#include <cmath>
#include <numeric>

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

/// Times `operation` on a model that is made anew for each run.
template <class Operation>
void operate(benchmark::State& state, Operation operation) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  TearReport report;
  for (auto _ : state) {
    state.PauseTiming();
    auto model = TornModel::create(scene.character);
    state.ResumeTiming();
    const auto done = operation(*model, scene);
    if (!done || done->runs + done->triangles_retired == 0) state.SkipWithError("nothing was torn");
    if (done) report = *done;
    state.PauseTiming();
    model = Status();  // destroyed outside of what is measured
    state.ResumeTiming();
  }
  state.counters["vertices"] = scene.character->meshes[0].vertex_count();
  state.counters["faces_crossed"] = report.faces_crossed;
}

Result<TearReport> tear_along(TornModel& model, const Scene& scene, double width) {
  return model.tear(scene.pose, scene.stroke, {width, Layers::nearest, 0.0});
}

void tear_once(benchmark::State& state) {
  operate(state, [](TornModel& model, const Scene& scene) { return tear_along(model, scene, 0.0); });
}

void tear_with_width(benchmark::State& state) {
  operate(state, [](TornModel& model, const Scene& scene) { return tear_along(model, scene, 0.05); });
}

void cut_once(benchmark::State& state) {
  operate(state, [](TornModel& model, const Scene& scene) {
    const Blade& blade = scene.stroke[0];
    return model.cut(scene.pose, {blade.base + 2.0 / 3 * (blade.tip - blade.base), {0.1, 1, 0.2}, {}, true});
  });
}

void drill_once(benchmark::State& state) {
  operate(state, [](TornModel& model, const Scene& scene) {
    const Blade& blade = scene.stroke[0];
    return model.drill(scene.pose, {blade.base, blade.tip - blade.base, 0.1, (blade.tip - blade.base).norm(), 0.0, true});
  });
}

void undo_and_redo(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  auto model = TornModel::create(scene.character);
  if (!tear_along(*model, scene, 0.0)) state.SkipWithError("nothing was torn");
  for (auto _ : state)
    if (!model->undo() || !model->redo()) state.SkipWithError("nothing to undo");
  state.counters["vertices"] = scene.character->meshes[0].vertex_count();
}

/// A stroke along the tube at rest, 200 extensions. What one costs does not depend on how many came before.
void extend_stroke(benchmark::State& state) {
  const Scene scene(static_cast<std::uint32_t>(state.range(0)));
  test::Random random(1);
  const ModelPose rest = test::random_pose(*scene.character, random, 0.0, 1.0);
  constexpr int kSegments = 200, kCompared = 20;
  const auto blade = [](int i) {
    const double across = 0.1 * std::sin(0.2 * i), along = 2 + 60.0 * i / kSegments;
    return Blade{{across, along, 1.0}, {across, along, 0.2}};
  };
  std::vector<double> seconds(kSegments, 0.0);
  for (auto _ : state) {
    auto model = TornModel::create(scene.character);
    auto stroke = TearStroke::begin(*model, rest, blade(0));
    const double before = std::accumulate(seconds.begin(), seconds.end(), 0.0);
    for (int i = 0; i < kSegments; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      if (!stroke->extend(rest, blade(i + 1))) state.SkipWithError("nothing was torn");
      seconds[i] += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }
    state.SetIterationTime(std::accumulate(seconds.begin(), seconds.end(), 0.0) - before);
    if (!stroke->end()) state.SkipWithError("nothing was torn");
  }
  const auto microseconds = [&](auto begin) {
    return std::accumulate(begin, begin + kCompared, 0.0) / kCompared * 1e6 / static_cast<double>(state.iterations());
  };
  state.counters["vertices"] = scene.character->meshes[0].vertex_count();
  state.counters["us_second_to_21st"] = microseconds(seconds.begin() + 1);  // the first one enters
  state.counters["us_last_20"] = microseconds(seconds.end() - kCompared);
  state.counters["us_first"] = seconds[0] * 1e6 / static_cast<double>(state.iterations());
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

void at_three_sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(59)->Arg(187)->Arg(416)->Unit(benchmark::kMicrosecond);
}

BENCHMARK(pose_whole_model)->Apply(at_three_sizes);
BENCHMARK(build_model)->Apply(at_three_sizes);
BENCHMARK(tear_once)->Apply(at_three_sizes);
BENCHMARK(tear_with_width)->Apply(at_three_sizes);
BENCHMARK(cut_once)->Apply(at_three_sizes);
BENCHMARK(drill_once)->Apply(at_three_sizes);
BENCHMARK(undo_and_redo)->Apply(at_three_sizes);
BENCHMARK(extend_stroke)->Apply(at_three_sizes)->UseManualTime();

}  // namespace
}  // namespace sunder
