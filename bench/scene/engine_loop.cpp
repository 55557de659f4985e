#include "bench/scene/engine_loop.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/harness/measure.h"
#include "bench/scene/engine_model.h"
#include "bench/scene/engine_operations.h"
#include "bench/scene/scene_crowd.h"

namespace sunder::bench {
namespace {

constexpr int kFrames = 1800;  // 20 s at 90 Hz
constexpr int kStroke = 180, kStrokeFrames = 40, kGap = 500, kCut = 660, kDetach = 820,
              kDrill = 980, kUndo = 1120, kRefit = 1200, kPush = 1340, kSnapshot = 1540;
constexpr int kSwapped = 45;  ///< Updates after which the background's work takes effect.

/// A phase or an event of the loop.
struct Part {
  const char* name;
  int first_frame, frame_count;
};
constexpr Part kParts[] = {{"untorn", 20, kStroke - 20},
                           {"stroke begins", kStroke, 1},
                           {"stroke", kStroke + 1, kStrokeFrames - 1},
                           {"lips open", kStroke + kStrokeFrames, 200},
                           {"gap", kGap, kSwapped + 1},
                           {"after it", kGap + kSwapped + 1, 100},
                           {"cut", kCut, kSwapped + 1},
                           {"after it", kCut + kSwapped + 1, 100},
                           {"detach", kDetach, kSwapped + 1},
                           {"after it", kDetach + kSwapped + 1, 100},
                           {"bore", kDrill, kSwapped + 1},
                           {"after it", kDrill + kSwapped + 1, 80},
                           {"undo of it", kUndo, 1},
                           {"after it", kUndo + 1, 70},
                           {"refit", kRefit, kSwapped + 1},
                           {"after it", kRefit + kSwapped + 1, 80},
                           {"all displaced", kPush + 10, 180},
                           {"restored", kSnapshot, 2},
                           {"at the end", kSnapshot + 10, kFrames - kSnapshot - 10},
                           {"all", 1, kFrames - 1}};

/// Submits what happens before a frame.
void act(EngineInstance& engine, int frame, bool in_background) {
  if (frame >= kStroke && frame < kStroke + kStrokeFrames) {
    const double way = (frame - kStroke) / (kStrokeFrames - 1.0);
    if (way == 0)
      engine.submit(BeginStrokeCommand{engine_stroke_at(way), walled(0.0), {}});
    else
      engine.submit(ExtendStrokeCommand{engine_stroke_at(way), 10 * way});
    if (way == 1) engine.submit(EndStrokeCommand{});
  }
  if (frame == kGap) engine.submit(TearCommand{engine_gap(20), walled(0.01)}, in_background);
  if (frame == kCut) engine.submit(engine_cut(), in_background);
  if (frame == kDetach) engine.submit(DetachCommand{kEnginePiece, {}}, in_background);
  if (frame == kDrill) engine.submit(engine_bore(), in_background);
  if (frame == kUndo) engine.submit(UndoCommand{});
  if (frame == kRefit) {
    WeightsOperation refit;
    refit.weights.policy = WeightPolicy::refit;
    engine.submit(refit, true);
  }
  if (frame == kPush)  // wakes all tissue
    require(engine.instance().body()->set_gravity({0, -9.81, 0}), "gravity");
}

EngineRun run_once(const std::shared_ptr<const Character>& character, bool in_background) {
  EngineRun run;
  run.vertices = character->meshes[0].vertex_count();
  EngineInstance engine(character, kSwapped);
  for (int frame = 0; frame < kFrames; ++frame) {
    act(engine, frame, in_background);
    if (frame == kSnapshot) run.snapshot = engine.save_and_restore();
    run.frames.push_back(engine.frame());
    engine.finish_background();
    const bool begins_part = std::any_of(std::begin(kParts), std::end(kParts),
                                         [&](const Part& of) { return of.first_frame == frame; });
    if (begins_part || frame == kFrames - 1) run.wrong_elements += engine.wrong_elements();
  }
  return run;
}

/// The values of one figure over some frames, ascending.
template <class Value>
std::vector<double> sorted(const EngineRun& run, const Part& part, Value EngineFrame::*figure) {
  std::vector<double> values;
  for (int f = part.first_frame; f < part.first_frame + part.frame_count; ++f)
    values.push_back(static_cast<double>(run.frames[static_cast<std::size_t>(f)].*figure));
  std::sort(values.begin(), values.end());
  return values;
}

double at_share(const std::vector<double>& ascending, double share) {
  return ascending[static_cast<std::size_t>(share * static_cast<double>(ascending.size() - 1))];
}

}  // namespace

EngineRun run_engine(int divisions, bool in_background, int repeats) {
  const auto character = make_engine_model(divisions);
  EngineRun least = run_once(character, in_background);
  for (int i = 1; i < repeats; ++i) {
    const EngineRun again = run_once(character, in_background);
    for (std::size_t f = 0; f < least.frames.size(); ++f)
      least.frames[f].microseconds =
          std::min(least.frames[f].microseconds, again.frames[f].microseconds);
    least.snapshot.save = std::min(least.snapshot.save, again.snapshot.save);
    least.snapshot.load = std::min(least.snapshot.load, again.snapshot.load);
    least.snapshot.exchange = std::min(least.snapshot.exchange, again.snapshot.exchange);
    least.wrong_elements += again.wrong_elements;
  }
  return least;
}

EngineFigures figures_of(const EngineRun& run) {
  const auto times = sorted(run, kParts[std::size(kParts) - 1], &EngineFrame::microseconds);
  return {at_share(times, 0.5), times.back()};
}

void print_engine_table(const EngineRun& run) {
  std::printf("| %-13s | %6s | %9s | %9s | %9s | %11s | %11s | %11s | %6s | %6s | %6s |\n", "phase",
              "frames", "median µs", "p99 µs", "worst µs", "median kB", "most kB", "allocations",
              "72 Hz", "90 Hz", "120 Hz");
  std::printf("|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Part& part : kParts) {
    const auto times = sorted(run, part, &EngineFrame::microseconds),
               bytes = sorted(run, part, &EngineFrame::uploaded_bytes),
               allocations = sorted(run, part, &EngineFrame::allocations);
    const auto overruns = [&](double hertz) {
      return std::count_if(times.begin(), times.end(),
                           [&](double time) { return time > 1e6 / hertz; });
    };
    std::printf(
        "| %-13s | %6d | %9.0f | %9.0f | %9.0f | %11.1f | %11.1f | %11.0f | %6td | %6td | "
        "%6td |\n",
        part.name, part.frame_count, at_share(times, 0.5), at_share(times, 0.99), times.back(),
        1e-3 * at_share(bytes, 0.5), 1e-3 * bytes.back(), allocations.back(), overruns(72),
        overruns(90), overruns(120));
  }
  std::printf("snapshot of %zu bytes: saved in %.2f ms, loaded in %.2f ms, exchanged in %.3f ms\n",
              run.snapshot.bytes, run.snapshot.save, run.snapshot.load, run.snapshot.exchange);
  std::printf("wrong vertices and triangles of the engine's buffers: %llu\n",
              static_cast<unsigned long long>(run.wrong_elements));
}

}  // namespace sunder::bench
