#include "bench/scene/scene_loop.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/measure.h"
#include "bench/scene/scene_crowd.h"

namespace sunder::bench {
namespace {

constexpr int kFrames = 1800;  // 20 s at 90 Hz
constexpr int kStroke = 180, kStrokeFrames = 40, kGap = 540, kCut = 720, kDrill = 900, kUndo = 1080,
              kUndoCut = 1200, kPush = 1300;
constexpr int kSwapped = 45;  ///< Updates after which the background's work takes effect; half a
                              ///< second, in which it ends.
constexpr std::uint32_t kBones = 163;

/// Submits what happens before a frame.
void act(Crowd& crowd, int frame) {
  if (frame >= kStroke && frame < kStroke + kStrokeFrames)
    crowd.stroke_on(0, (frame - kStroke) / (kStrokeFrames - 1.0));
  if (frame == kGap) crowd.tear(0, 0.6, {.width = 0.01});
  if (frame == kCut) crowd.cut(0, 0.85);
  if (frame == kDrill) crowd.drill(0, 0.3);
  if (frame == kUndo || frame == kUndoCut) crowd.undo(0);
  if (frame == kPush)  // wakes all tissue
    require(crowd.scene().find(crowd.id(0))->body()->set_gravity({0, -9.81, 0}), "gravity");
}

/// An operation of the loop.
struct Act {
  const char* name;
  int first_frame, frame_count;
};
constexpr Act kActs[] = {{"untorn", 20, kStroke - 20},
                         {"stroke begins", kStroke, 1},
                         {"stroke", kStroke + 1, kStrokeFrames - 1},
                         {"lips open", kStroke + kStrokeFrames, 100},
                         {"gap", kGap, 1},
                         {"after it", kGap + 1, 100},
                         {"cut", kCut, kSwapped + 1},
                         {"after it", kCut + kSwapped + 1, 100},
                         {"bore", kDrill, kSwapped + 1},
                         {"after it", kDrill + kSwapped + 1, 100},
                         {"undo of it", kUndo, 1},
                         {"after it", kUndo + 1, 100},
                         {"undo of the cut", kUndoCut, 1},
                         {"after it", kUndoCut + 1, 90},
                         {"all displaced", kPush + 10, 90}};

/// The figures of each frame; `total` is processor time.
std::vector<FrameStats> run_loop(const std::shared_ptr<const Character>& character, LoopMode mode) {
  const std::uint32_t updates = mode == LoopMode::in_background ? kSwapped : 0;
  Crowd crowd(character, 1, {.is_soft = true, .background_updates = updates});
  require(crowd.scene().find(crowd.id(0))->prepare_to_tear(), "prepare");
  crowd.play(1);
  std::vector<FrameStats> stats;
  for (int frame = 0; frame < kFrames; ++frame) {
    act(crowd, frame);
    if (frame == kCut + kSwapped || frame == kDrill + kSwapped) crowd.finish_background();
    const double begin = thread_seconds();
    (void)crowd.frame();
    stats.push_back(crowd.scene().stats());
    stats.back().total = 1e6 * (thread_seconds() - begin);
  }
  return stats;
}

/// Runs the loop several times. @return of each frame the fastest.
std::vector<FrameStats> fastest_frames(const std::shared_ptr<const Character>& character,
                                       LoopMode mode, int repeats) {
  std::vector<FrameStats> least = run_loop(character, mode);
  for (int i = 1; i < repeats; ++i) {
    const std::vector<FrameStats> again = run_loop(character, mode);
    for (std::size_t f = 0; f < least.size(); ++f)
      if (again[f].total < least[f].total) least[f] = again[f];
  }
  return least;
}

}  // namespace

void print_loop_stages(std::uint32_t vertices, LoopMode mode, int repeats) {
  const std::vector<FrameStats> frames =
      fastest_frames(make_crowd_model(vertices, kBones), mode, repeats);
  std::printf(
      "Slowest frames, large operations %s, milliseconds; total: processor time\n%15s %6s %9s %9s "
      "%9s %9s %9s %9s\n",
      mode == LoopMode::in_frame ? "in the frame" : "in the background", "", "frame", "total",
      "animation", "operation", "settling", "tissue", "drawing");
  for (const Act& part : kActs) {
    const FrameStats& slowest = *std::max_element(
        frames.begin() + part.first_frame, frames.begin() + part.first_frame + part.frame_count,
        [](const FrameStats& a, const FrameStats& b) { return a.total < b.total; });
    std::printf("%15s %6llu %9.3f %9.3f %9.3f %9.3f %9.3f %9.3f\n", part.name,
                static_cast<unsigned long long>(slowest.frame - 1), 1e-3 * slowest.total,
                1e-3 * slowest.animation, 1e-3 * slowest.operations, 1e-3 * slowest.settling,
                1e-3 * slowest.tissue, 1e-3 * slowest.drawing);
  }
}

LoopTimes time_loop(std::uint32_t vertices, LoopMode mode, int repeats) {
  const auto character = make_crowd_model(vertices, kBones);
  std::vector<double> least;  // milliseconds
  for (const FrameStats& frame : fastest_frames(character, mode, repeats))
    least.push_back(1e-3 * frame.total);
  const auto median_of = [&](int first, int end) {
    return median({least.begin() + first, least.begin() + end});
  };
  const auto at = [&](int frame) { return least[static_cast<std::size_t>(frame)]; };
  const auto worst_of = [&](int first) {
    return *std::max_element(least.begin() + first, least.begin() + first + kSwapped + 1);
  };
  LoopTimes times;
  times.vertices = character->meshes[0].vertex_count();
  times.untorn = median_of(20, kStroke);
  times.displaced = median_of(kPush + 10, kPush + 100);
  times.stroke = median_of(kStroke + 1, kStroke + kStrokeFrames - 1);
  times.gaping = median_of(kStroke + kStrokeFrames + 5, kStroke + kStrokeFrames + 45);
  times.gap = at(kGap);
  times.cut = worst_of(kCut);
  times.drill = worst_of(kDrill);
  times.undo = at(kUndo);
  times.worst = *std::max_element(least.begin() + 1, least.end());
  return times;
}

}  // namespace sunder::bench
