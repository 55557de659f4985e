// Measures tears: the same stroke across about a hundred faces of one surface of 3.5 thousand to
// 0.9 million points, compared with reading and writing the memory alone, and with CGAL and VTK if
// they are installed. Each time is the median of many runs; see tear_scene.h.
#include <cstdio>
#include <cstring>

#include <benchmark/benchmark.h>

#include "bench/harness/measure.h"
#include "bench/tear/cut_figures.h"
#include "bench/tear/long_stroke.h"
#include "bench/tear/model_memory.h"
#include "bench/tear/repeated_operation.h"
#include "bench/tear/size_table.h"
#include "bench/tear/tear_stages.h"
#include "bench/tear/tear_summary.h"
#include "bench/tear/touch_baseline.h"

#if SUNDER_BENCH_CGAL
#include "bench/peers/cgal_peer.h"
#endif
#if SUNDER_BENCH_VTK
#include "bench/peers/vtk_peer.h"
#endif

namespace sunder::bench {
namespace {

constexpr Effort kUsual = {300, 4, 5}, kHeavy = {20, 4, 2};

const Scene& scene_in(const benchmark::State& state) {
  return scene_of(static_cast<int>(state.range(0)));
}

/// Prints the median of the seconds that `run` returns.
template <class Run>
void report_median(benchmark::State& state, const Effort& effort, Run run) {
  state.counters["points"] = scene_in(state).mesh().vertex_count();
  for (auto _ : state) {
    run();  // warms up
    const auto seconds = sample(effort, run);
    state.SetIterationTime(median(seconds));
    state.counters["runs"] = static_cast<double>(seconds.size());
  }
}

template <RepeatedOperation::Work work>
void operate(benchmark::State& state, Caches caches, const Effort& effort) {
  RepeatedOperation operation(scene_in(state), work);
  report_median(state, effort, [&] { return operation.run(caches); });
  state.counters["faces_crossed"] = operation.report.faces_crossed;
  state.counters["triangles_added"] = operation.report.triangles_added;
  state.counters["triangles_retired"] = operation.report.triangles_retired;
  state.counters["allocations"] = static_cast<double>(operation.allocations);
  state.counters["undo_allocations"] = static_cast<double>(operation.undo_allocations);
}

void tear_warm(benchmark::State& state) { operate<tear_along_stroke>(state, Caches::warm, kUsual); }
void tear_cold(benchmark::State& state) {
  operate<tear_along_stroke>(state, Caches::swept, kUsual);
}
void width_warm(benchmark::State& state) { operate<tear_with_width>(state, Caches::warm, kUsual); }
void drill_warm(benchmark::State& state) { operate<drill_through>(state, Caches::warm, kHeavy); }
void drill_open_warm(benchmark::State& state) { operate<drill_open>(state, Caches::warm, kUsual); }
void cut_whole(benchmark::State& state) { operate<cut_in_two>(state, Caches::warm, kHeavy); }
void cut_whole_with_caps(benchmark::State& state) {
  operate<cut_with_caps>(state, Caches::warm, kHeavy);
}

void undo(benchmark::State& state) {
  RepeatedOperation tear(scene_in(state), tear_along_stroke);
  report_median(state, kUsual, [&] { return tear.run_undo_and_redo().undo; });
}

void redo(benchmark::State& state) {
  RepeatedOperation tear(scene_in(state), tear_along_stroke);
  report_median(state, kUsual, [&] { return tear.run_undo_and_redo().redo; });
}

/// Divides the time of a warm tear among its steps, which are measured on a separate surface; the
/// remainder is reported too. Both are measured in turns.
void tear_in_stages(benchmark::State& state) {
  RepeatedOperation tear(scene_in(state), tear_along_stroke);
  StagedTear staged(scene_in(state));
  std::vector<double> whole;
  std::vector<Stages> runs;
  report_median(state, kUsual, [&] {
    whole.push_back(tear.run());
    return runs.emplace_back(staged.run()).sum();
  });
  double explained_us = 0;
  const auto report = [&](const char* name, auto seconds) {
    std::vector<double> values;
    for (const Stages& stages : runs) values.push_back(seconds(stages) * 1e6);
    explained_us += state.counters[name] = median(values);
  };
  report("us_pose", [](const Stages& s) { return s.pose; });
  report("us_query", [](const Stages& s) { return s.query; });
  report("us_imprint", [](const Stages& s) { return s.imprint - s.attributes; });
  report("us_attributes", [](const Stages& s) { return s.attributes; });
  report("us_open", [](const Stages& s) { return s.open; });
  report("us_improve", [](const Stages& s) { return s.improve; });
  report("us_change_record", [](const Stages& s) { return s.change_record; });
  state.counters["us_rest"] = median(whole) * 1e6 - explained_us;
}

/// Measures the search for the place where a stroke enters the surface in a new pose, compared with
/// taking in the pose alone.
void entry_query(benchmark::State& state) {
  StagedTear staged(scene_in(state));
  std::vector<double> pose_us;
  report_median(state, kUsual, [&] {
    const Stages stages = staged.run_query();
    pose_us.push_back(stages.pose * 1e6);
    return stages.query;
  });
  state.counters["us_pose"] = median(pose_us);
}

/// create() and the first tear, together and separately.
void create_and_first_tear(benchmark::State& state) {
  RepeatedOperation tear(scene_in(state), tear_along_stroke);
  tear.run();
  const double warm = median(sample(kHeavy, [&] { return tear.run(); }));
  std::vector<double> create, first;
  report_median(state, {5, 4, 2}, [&] {
    const FirstTear seconds = time_first_tear(scene_in(state));
    create.push_back(seconds.create);
    first.push_back(seconds.tear);
    return seconds.create + seconds.tear;
  });
  state.counters["us_create"] = median(create) * 1e6;
  state.counters["us_first_tear"] = median(first) * 1e6;
  state.counters["build_ns_per_face"] =
      (median(create) + median(first) - warm) * 1e9 / scene_in(state).mesh().triangle_count();
}

void long_stroke(benchmark::State& state) {
  for (auto _ : state) {
    const LongStroke stroke = time_long_stroke(static_cast<int>(state.range(0)));
    state.SetIterationTime(stroke.last_20 * 1e-6);
    state.counters["us_first"] = stroke.first;
    state.counters["us_second_to_21st"] = stroke.second_to_21st;
    state.counters["us_last_20"] = stroke.last_20;
  }
}

void memory(benchmark::State& state) {
  for (auto _ : state) {
    BytesPerPoint bytes;
    state.SetIterationTime(seconds_of([&] { bytes = bytes_per_point(scene_in(state)); }));
    state.counters["bytes_per_point"] = bytes.model;
    state.counters["posed_bytes_per_point"] = bytes.posed_points;
  }
}

void instances(benchmark::State& state) {
  for (auto _ : state) {
    InstanceCosts costs;
    state.SetIterationTime(seconds_of([&] { costs = instance_costs(scene_in(state)); }));
    state.counters["untouched_bytes"] = costs.untouched_bytes;
    state.counters["packed_bytes_per_vertex"] = costs.packed_bytes_per_vertex;
    state.counters["capacity_bytes_per_vertex"] = costs.capacity_bytes_per_vertex;
    state.counters["capacity_bytes_per_operation"] = costs.capacity_bytes_per_operation;
    state.counters["us_create"] = costs.us_create;
    state.counters["us_pack"] = costs.us_pack;
    state.counters["us_unpack"] = costs.us_unpack;
  }
}

/// Baseline: the memory accesses of a tear alone.
template <Caches caches>
void touch_memory(benchmark::State& state) {
  TouchBaseline baseline(scene_in(state));
  report_median(state, kUsual, [&] { return baseline.run(caches); });
}

void touch_warm(benchmark::State& state) { touch_memory<Caches::warm>(state); }
void touch_cold(benchmark::State& state) { touch_memory<Caches::swept>(state); }

/// Baseline: poses every vertex once, in double, as a tool that works on the whole model must.
void pose_whole_model(benchmark::State& state) {
  const Scene& scene = scene_in(state);
  report_median(state, kHeavy, [&] {
    return seconds_of(
        [&] { benchmark::DoNotOptimize(posed_positions(scene, scene.next_pose()).data()); });
  });
}

void at_four_sizes(benchmark::internal::Benchmark* benchmark) {
  for (const int divisions : kDivisions) benchmark->Arg(divisions);
  benchmark->Iterations(1)->UseManualTime()->Unit(benchmark::kMicrosecond);
}

BENCHMARK(tear_warm)->Apply(at_four_sizes);
BENCHMARK(tear_cold)->Apply(at_four_sizes);
BENCHMARK(tear_in_stages)->Apply(at_four_sizes);
BENCHMARK(entry_query)->Apply(at_four_sizes);
BENCHMARK(touch_warm)->Apply(at_four_sizes);
BENCHMARK(touch_cold)->Apply(at_four_sizes);
BENCHMARK(pose_whole_model)->Apply(at_four_sizes);
BENCHMARK(undo)->Apply(at_four_sizes);
BENCHMARK(redo)->Apply(at_four_sizes);
BENCHMARK(width_warm)->Apply(at_four_sizes);
BENCHMARK(drill_warm)->Apply(at_four_sizes);
BENCHMARK(drill_open_warm)->Apply(at_four_sizes);
BENCHMARK(long_stroke)->Apply(at_four_sizes);
BENCHMARK(create_and_first_tear)->Apply(at_four_sizes);
BENCHMARK(memory)->Apply(at_four_sizes);
BENCHMARK(instances)->Apply(at_four_sizes);
BENCHMARK(cut_whole)->Apply(at_four_sizes);
BENCHMARK(cut_whole_with_caps)->Apply(at_four_sizes);

#if SUNDER_BENCH_VTK
void vtk_plane_clipper(benchmark::State& state) {
  VtkPeer peer(scene_in(state));
  report_median(state, kHeavy, [&] { return peer.clip(); });
}
BENCHMARK(vtk_plane_clipper)->Apply(at_four_sizes);
#endif

#if SUNDER_BENCH_CGAL
void cgal_corefine(benchmark::State& state) {
  CgalPeer peer(scene_in(state));
  report_median(state, kHeavy, [&] { return peer.corefine(); });
  state.counters["new_vertices"] = static_cast<double>(peer.new_vertices());
}
BENCHMARK(cgal_corefine)->Name("cgal_corefine_8_floats")->Apply(at_four_sizes);

void cgal_tree_query(benchmark::State& state) {
  CgalPeer peer(scene_in(state));
  state.counters["us_build"] = median(sample({5, 2, 1}, [&] { return peer.build_tree(); })) * 1e6;
  report_median(state, kUsual, [&] { return peer.query_tree(); });
}
BENCHMARK(cgal_tree_query)->Apply(at_four_sizes);
#endif

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  const auto print_help = [] {
    std::fputs(sunder::bench::kSummaryHelp, stdout);
    std::printf("\n");
    benchmark::PrintDefaultHelp();
  };
  if (argc == 2 && std::strcmp(argv[1], "--summary") == 0) {
    sunder::bench::print_summary();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--widths") == 0) {
    sunder::bench::print_removals();
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--cuts") == 0) {
    sunder::bench::print_cut_summary();
    return 0;
  }
  const bool is_table = argc == 2 && std::strcmp(argv[1], "--table") == 0;
  if (is_table) argc = 1;
  benchmark::Initialize(&argc, argv, print_help);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    std::fprintf(
        stderr,
        "bench_tear takes --summary, --table, --cuts or --widths alone, or options of Google "
        "Benchmark; see --help\n");
    return 2;
  }
  if (sunder::bench::SizeTable table; is_table)
    benchmark::RunSpecifiedBenchmarks(&table, sunder::bench::SizeTable::filter());
  else
    benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
