#include "bench/scene_loop.h"

#include <algorithm>
#include <vector>

#include "bench/measure.h"
#include "bench/scene_crowd.h"

namespace sunder::bench {
namespace {

constexpr int kFrames = 1800;  // 20 s at 90 Hz
constexpr int kStroke = 180, kStrokeFrames = 40, kGap = 540, kCut = 720, kDrill = 900, kUndo = 1080,
              kPush = 1300;
constexpr std::uint32_t kBones = 163;

/// Submits what happens before a frame.
void act(Crowd& crowd, int frame) {
  if (frame >= kStroke && frame < kStroke + kStrokeFrames)
    crowd.stroke_on(0, (frame - kStroke) / (kStrokeFrames - 1.0));
  if (frame == kGap) crowd.tear(0, 0.6, {.width = 0.01});
  if (frame == kCut) crowd.cut(0, 0.85);
  if (frame == kDrill) crowd.drill(0, 0.3);
  if (frame == kUndo) crowd.undo(0);
  if (frame == kPush)  // wakes all tissue
    require(crowd.scene().find(crowd.id(0))->body()->set_gravity({0, -9.81, 0}), "gravity");
}

/// Milliseconds of each frame.
std::vector<double> run_loop(const std::shared_ptr<const Character>& character) {
  Crowd crowd(character, 1, {.is_soft = true});
  require(crowd.scene().find(crowd.id(0))->prepare_to_tear(), "prepare");
  crowd.play(1);
  std::vector<double> milliseconds;
  for (int frame = 0; frame < kFrames; ++frame) {
    act(crowd, frame);
    milliseconds.push_back(1e3 * crowd.frame());
  }
  return milliseconds;
}

}  // namespace

LoopTimes time_loop(std::uint32_t vertices, int repeats) {
  const auto character = make_crowd_model(vertices, kBones);
  std::vector<double> least = run_loop(character);
  for (int i = 1; i < repeats; ++i) {
    const std::vector<double> again = run_loop(character);
    for (std::size_t f = 0; f < least.size(); ++f) least[f] = std::min(least[f], again[f]);
  }
  const auto median_of = [&](int first, int end) {
    return median({least.begin() + first, least.begin() + end});
  };
  const auto at = [&](int frame) { return least[static_cast<std::size_t>(frame)]; };
  LoopTimes times;
  times.vertices = character->meshes[0].vertex_count();
  times.untorn = median_of(20, kStroke);
  times.displaced = median_of(kPush + 10, kPush + 100);
  times.stroke = median_of(kStroke + 1, kStroke + kStrokeFrames - 1);
  times.gaping = median_of(kStroke + kStrokeFrames + 5, kStroke + kStrokeFrames + 45);
  times.gap = at(kGap);
  times.cut = at(kCut);
  times.drill = at(kDrill);
  times.undo = at(kUndo);
  times.worst = *std::max_element(least.begin() + 1, least.end());
  return times;
}

}  // namespace sunder::bench
