#include "bench/scene/scene_summary.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"
#include "bench/scene/engine_figures.h"
#include "bench/scene/operation_ratios.h"
#include "bench/scene/scene_crowd.h"
#include "bench/scene/scene_loop.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kSmall = 3'000, kMiddle = 16'000, kLarge = 100'000, kSummaryBones = 64;
constexpr std::uint32_t kMostVertices = 20'000'000;  ///< Of a crowd: more do not fit into memory.

double median_frame(Crowd& crowd, int frames) {
  std::vector<double> seconds;
  for (int i = 0; i < frames; ++i) seconds.push_back(crowd.frame());
  return median(seconds);
}

/// More than a second.
void rest(Crowd& crowd) {
  for (int i = 0; i < 100; ++i) (void)crowd.frame();
}

/// Bytes per instance that was spawned and is not visible: it has no pose yet.
double instance_bytes(const std::shared_ptr<const Character>& character) {
  constexpr std::uint32_t kCount = 1000;
  Crowd base(character, 1, {});
  const auto asset = base.scene().find(base.id(0))->asset();
  const std::uint64_t before = bytes_in_use();
  for (std::uint32_t i = 0; i < kCount; ++i)
    require(base.scene().spawn(asset, {.capacity = {}, .is_visible = false}).error(), "spawn");
  for (int i = 0; i < 3; ++i) (void)base.frame();
  return static_cast<double>(bytes_in_use() - before) / kCount;
}

/// Bytes that a tear adds to an instance, per new vertex, once nobody has torn it for a second.
double torn_bytes_per_vertex(const std::shared_ptr<const Character>& character) {
  constexpr std::uint32_t kCount = 50;
  Crowd crowd(character, kCount + 1, {});
  crowd.tear(kCount, 0.5);  // warms what all instances share
  rest(crowd);
  const std::uint64_t before = bytes_in_use();
  double vertices = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    crowd.tear(i, 0.3 + 0.4 * i / kCount);
    (void)crowd.frame();
    vertices += crowd.scene().results()[0].report.vertices_added;
    rest(crowd);
  }
  return static_cast<double>(bytes_in_use() - before) / vertices;
}

/// Milliseconds that a stroke on one of 100 characters adds to a frame.
double stroke_extra(const std::shared_ptr<const Character>& character) {
  Crowd crowd(character, 100, {});
  crowd.play(100);
  (void)median_frame(crowd, 5);
  std::vector<double> calm, torn;
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 4; ++i) calm.push_back(crowd.frame());
    for (int i = 0; i <= 4; ++i) {
      crowd.stroke_on(static_cast<std::uint32_t>(round), i / 4.0);
      torn.push_back(crowd.frame());
    }
  }
  return 1e3 * (median(torn) - median(calm));
}

/// Milliseconds of the frame in which one of ten soft characters is being torn, all ten moving: the
/// 95th percentile of the stroke's frames.
double vr_frame(const std::shared_ptr<const Character>& character) {
  Crowd crowd(character, 10, {.is_soft = true});
  crowd.play(10);
  for (std::uint32_t i = 0; i < 10; ++i) crowd.tear(i, 0.6);
  (void)median_frame(crowd, 30);
  std::vector<double> seconds;
  for (int i = 0; i <= 40; ++i) {
    crowd.stroke_on(0, i / 40.0);
    seconds.push_back(crowd.frame());
  }
  std::sort(seconds.begin(), seconds.end());
  return 1e3 * seconds[seconds.size() * 95 / 100];
}

/// A frame with ten of a thousand that move, relative to these ten alone.
double one_percent(const std::shared_ptr<const Character>& character) {
  Crowd many(character, 1000, {}), few(character, 10, {});
  many.play(10);
  few.play(10);
  std::vector<double> of_many, of_few;
  for (int i = 0; i < 200; ++i) {
    of_few.push_back(few.frame());
    of_many.push_back(many.frame());
  }
  return median(of_many) / median(of_few);
}

double idle_microseconds(const std::shared_ptr<const Character>& character) {
  Crowd crowd(character, 1000, {});
  return 1e6 * median_frame(crowd, 300);
}

void print_crowd(const std::shared_ptr<const Character>& character, std::uint32_t count) {
  const std::uint32_t vertices = character->meshes[0].vertex_count();
  if (std::uint64_t{vertices} * count > kMostVertices) return;
  Crowd crowd(character, count, {.is_soft = true});
  const int frames = std::uint64_t{vertices} * count > 2'000'000 ? 5 : 60;
  const double idle = median_frame(crowd, frames);
  crowd.play(std::max(1u, count / 100));
  const double few = median_frame(crowd, frames);
  crowd.play(count);
  const double all = median_frame(crowd, frames);
  crowd.tear(0, 0.5);
  const double torn = crowd.frame();
  for (std::uint32_t i = 0; i < std::min(10u, count); ++i) crowd.tear(i, 0.6);
  const double ten_torn = crowd.frame();
  const double gaping = median_frame(crowd, std::min(frames, 20));
  std::printf("%9u %6u %10.4f %10.4f %10.3f %10.3f %10.3f %10.3f\n", vertices, count, 1e3 * idle,
              1e3 * few, 1e3 * all, 1e3 * torn, 1e3 * ten_torn, 1e3 * gaping);
}

void print_loop(std::uint32_t vertices, LoopMode mode, int repeats) {
  const LoopTimes t = time_loop(vertices, mode, repeats);
  std::printf("%9u %10s %8.3f %9.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f\n", t.vertices,
              mode == LoopMode::in_frame ? "frame" : "background", t.untorn, t.displaced, t.stroke,
              t.gaping, t.gap, t.cut, t.drill, t.undo, t.worst);
}

/// The figures of the loop with cuts and bores in the background, as docs/frame.md advises; and
/// with all operations in the frame.
void add_loops(JsonObject& object) {
  object.add_text("loop_mode", "cuts with caps and bores with a wall in the background");
  const LoopTimes small = time_loop(13'380, LoopMode::in_background, 3),
                  large = time_loop(214'050, LoopMode::in_background, 2);
  object.add("loop_13k_worst_ms", small.worst);
  object.add("loop_214k_worst_ms", large.worst);
  object.add("loop_214k_stroke_ratio", large.stroke / large.displaced);
  object.add("loop_13k_worst_in_frame_ms", time_loop(13'380, LoopMode::in_frame, 2).worst);
  object.add("loop_214k_worst_in_frame_ms", time_loop(214'050, LoopMode::in_frame, 1).worst);
}

}  // namespace

void print_scene_tables() {
  std::printf("Frames of crowds, soft, one thread, milliseconds\n");
  std::printf("%9s %6s %10s %10s %10s %10s %10s %10s\n", "vertices", "count", "none moves",
              "1 % moves", "all move", "+ a tear", "+ 10 tears", "gaping");
  for (const std::uint32_t vertices : {kSmall, kMiddle, kLarge}) {
    const auto character = make_crowd_model(vertices, kSummaryBones);
    for (const std::uint32_t count : {1u, 10u, 100u, 1000u}) print_crowd(character, count);
  }
  std::printf("\nTwenty seconds of one soft character of 163 bones, one thread, milliseconds\n");
  std::printf("%9s %10s %8s %9s %8s %8s %8s %8s %8s %8s %8s\n", "vertices", "cuts run in", "untorn",
              "displaced", "stroke", "gaping", "gap", "cut", "drill", "undo", "worst");
  for (const LoopMode mode : {LoopMode::in_frame, LoopMode::in_background}) {
    print_loop(13'380, mode, 3);
    print_loop(214'050, mode, 1);
  }
}

void print_scene_summary() {
  const auto small = make_crowd_model(kSmall, kSummaryBones),
             middle = make_crowd_model(kMiddle, kSummaryBones);
  JsonObject object;
  object.add("idle_1000_us", idle_microseconds(middle));
  object.add("one_percent_ratio", one_percent(small));
  object.add("instance_bytes", instance_bytes(middle));
  object.add("torn_bytes_per_vertex", torn_bytes_per_vertex(middle));
  object.add("stroke_extra_ms", stroke_extra(middle));
  object.add("vr_frame_ms", vr_frame(middle));
  add_loops(object);
  add_engine_figures(object);
  add_operation_ratios(object);
  object.end();
}

}  // namespace sunder::bench
