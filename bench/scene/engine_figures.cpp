#include "bench/scene/engine_figures.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <memory>
#include <vector>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/measure.h"
#include "bench/scene/engine_loop.h"
#include "bench/scene/engine_model.h"
#include "bench/scene/engine_operations.h"
#include "bench/scene/scene_crowd.h"
#include "bench/skinning/displacing.h"

namespace sunder::bench {
namespace {

constexpr int kSmall = 2, kLarge = 8;  ///< Divisions: 13 and 214 thousand vertices.

/// A model in its rest pose that is torn and repaired again and again.
class RepeatedTear {
 public:
  explicit RepeatedTear(const std::shared_ptr<const Character>& character)
      : pose_(*rest_pose(*character)), model_(*TornModel::create(character)) {}

  /// Milliseconds of processor time: the median of 15.
  double milliseconds(const Stroke& stroke, const TearOptions& options) {
    std::vector<double> times;
    for (int i = 0; i < 17; ++i) {
      const double begin = thread_seconds();
      const auto report = model_.tear(pose_, stroke, options);
      times.push_back(1e3 * (thread_seconds() - begin));
      require(report.error(), "tear");
      require(model_.undo(), "undo");
    }
    return median({times.begin() + 2, times.end()});
  }

 private:
  ModelPose pose_;
  TornModel model_;
};

void add_walls(JsonObject& object, const std::shared_ptr<const Character>& character) {
  RepeatedTear model(character);
  TearOptions bare = walled(0);
  bare.wall_depth = 0;
  const Stroke segment = engine_gap(1, 0.3);
  object.add("walls_vs_tear",
             model.milliseconds(segment, walled(0)) / model.milliseconds(segment, bare));
  object.add("gap_walls_ms", model.milliseconds(engine_gap(20), walled(0.01)));
}

/// Microseconds per triangle of a piece that the frame takes which detaches it: processor time
/// beyond that of the frame before.
double detach_us_per_triangle(const std::shared_ptr<const Character>& character) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    EngineInstance engine(character, 0);
    for (int frame = 0; frame < 5; ++frame) (void)engine.frame();
    engine.submit(engine_cut());
    for (int frame = 0; frame < 30; ++frame) (void)engine.frame();
    const double before = engine.frame().microseconds;
    engine.submit(DetachCommand{kEnginePiece, {}});
    const double detaching = engine.frame().microseconds;
    const DetachedPiece& piece = *engine.scene().results()[0].piece;
    times.push_back((detaching - before) / piece.character->meshes[0].triangle_count());
  }
  return median(times);
}

/// The frame in which ten instances that nothing has torn yet are torn, each for the first time.
double ten_torn_ms(const std::shared_ptr<const Character>& character) {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    Crowd crowd(character, 10, {.is_soft = true});
    crowd.play(10);
    for (int frame = 0; frame < 5; ++frame) (void)crowd.frame();
    for (std::uint32_t instance = 0; instance < 10; ++instance) crowd.tear(instance, 0.5);
    const double begin = thread_seconds();
    (void)crowd.frame();
    times.push_back(1e3 * (thread_seconds() - begin));
  }
  return median(times);
}

/// Bytes that a soft instance keeps of a tear with a few new vertices, once it is at rest and
/// packed.
double packed_soft_bytes(const std::shared_ptr<const Character>& character) {
  Crowd crowd(character, 2, {.is_soft = true});
  const auto tear_and_rest = [&](std::uint32_t instance) {
    require(crowd.scene().submit(crowd.id(instance), TearCommand{engine_gap(1, 0.04), {}}).error(),
            "submit");
    for (int frame = 0; frame < 1000; ++frame) (void)crowd.frame();
  };
  tear_and_rest(0);  // warms what both share
  const std::uint64_t before = bytes_in_use();
  tear_and_rest(1);
  return static_cast<double>(bytes_in_use() - before);
}

/// Submeshes of the torn mesh after 40 tears with walls, without those that it had before.
double submeshes_after_40(const std::shared_ptr<const Character>& character) {
  TornModel model = *TornModel::create(character);
  const ModelPose pose = *rest_pose(*character);
  for (int i = 0; i < 40; ++i)
    require(model.tear(pose, engine_gap(1, 0.1, 0.3 + 0.035 * i), walled(0)).error(), "tear");
  return static_cast<double>(model.character().meshes[0].submeshes.size() -
                             character->meshes[0].submeshes.size());
}

}  // namespace

void add_engine_figures(JsonObject& object) {
  const EngineRun small = run_engine(kSmall, true, 3), large = run_engine(kLarge, true, 2);
  object.add("engine_13k_median_us", figures_of(small).median);
  object.add("engine_13k_worst_us", figures_of(small).worst);
  object.add("engine_214k_median_ms", 1e-3 * figures_of(large).median);
  object.add("engine_214k_worst_ms", 1e-3 * figures_of(large).worst);
  object.add("restore_214k_ms", large.snapshot.load + large.snapshot.exchange);
  object.add("restore_exchange_ms", large.snapshot.exchange);
  object.add("displace_ns", measure_displacing(SkinningScene(3, true)).tangents);
  const auto character = make_engine_model(kSmall);
  add_walls(object, character);
  object.add("detach_us_per_triangle", detach_us_per_triangle(character));
  object.add("ten_torn_ms", ten_torn_ms(make_crowd_model(4'400, 64)));
  object.add("packed_soft_bytes", packed_soft_bytes(character));
  object.add("submeshes_after_40", submeshes_after_40(character));
}

}  // namespace sunder::bench
