#include "bench/tear/repeated_operation.h"

#include <cstdio>
#include <cstdlib>

#include "bench/harness/cpu_seconds.h"
#include "bench/harness/measure.h"
#include "support/machine/allocation_count.h"

namespace sunder::bench {
namespace {

template <class Outcome>
void require(const Outcome& outcome) {
  if (outcome) return;
  std::fprintf(stderr, "an operation failed\n");
  std::exit(1);
}

/// A bore through the middle of the stroke. @param radius  by the length of the stroke.
Bore bore_across(const Scene& scene, double radius, bool wall) {
  const Vec3d along = scene.stroke.back().tip - scene.stroke.front().tip;
  const Vec3d depth = scene.stroke[0].tip - scene.stroke[0].base;
  return {
      scene.stroke[0].base + 0.5 * along, depth, radius * along.norm(), depth.norm(), 0.0, wall};
}

}  // namespace

double RepeatedOperation::run(Caches caches) {
  const ModelPose& pose = scene_.next_pose();
  if (caches == Caches::swept) sweep_caches();
  const std::uint64_t before = test::allocation_count();
  Result<TearReport> done = Status();
  const double seconds = cpu_seconds_of([&] { done = work_(scene_, pose, change_); });
  allocations = test::allocation_count() - before;
  require(done);
  report = std::move(*done);
  take_back();
  return seconds;
}

void RepeatedOperation::take_back() {
  const std::uint64_t before = test::allocation_count();
  require(scene_.model().undo(&change_));
  undo_allocations = test::allocation_count() - before;
}

RepeatedOperation::Seconds RepeatedOperation::run_undo_and_redo() {
  Seconds seconds;
  require(work_(scene_, scene_.next_pose(), change_));
  seconds.undo = seconds_of([&] { require(scene_.model().undo(&change_)); });
  seconds.redo = seconds_of([&] { require(scene_.model().redo(&change_)); });
  take_back();
  return seconds;
}

Result<TearReport> tear_along_stroke(const Scene& scene, const ModelPose& pose,
                                     ChangeRecord& change) {
  return scene.model().tear(pose, scene.stroke, {}, &change);
}

Result<TearReport> tear_with_width(const Scene& scene, const ModelPose& pose,
                                   ChangeRecord& change) {
  const double length = (scene.stroke.back().tip - scene.stroke.front().tip).norm();
  return scene.model().tear(pose, scene.stroke, {0.05 * length, Layers::nearest, 0.0}, &change);
}

Result<TearReport> cut_in_two(const Scene& scene, const ModelPose& pose, ChangeRecord& change) {
  return scene.model().cut(pose, scene.middle_plane, &change);
}

Result<TearReport> cut_with_caps(const Scene& scene, const ModelPose& pose, ChangeRecord& change) {
  PlaneCut cut = scene.middle_plane;
  cut.caps = true;
  return scene.model().cut(pose, cut, &change);
}

Result<TearReport> drill_through(const Scene& scene, const ModelPose& pose, ChangeRecord& change) {
  return scene.model().drill(pose, bore_across(scene, 0.1, true), &change);
}

Result<TearReport> drill_open(const Scene& scene, const ModelPose& pose, ChangeRecord& change) {
  return scene.model().drill(pose, bore_across(scene, 0.2, false), &change);
}

FirstTear time_first_tear(const Scene& scene) {
  FirstTear seconds;
  Result<TornModel> model = Status();
  seconds.create = seconds_of([&] { model = TornModel::create(scene.character); });
  require(model);
  ChangeRecord change;
  seconds.tear =
      seconds_of([&] { require(model->tear(scene.next_pose(), scene.stroke, {}, &change)); });
  return seconds;
}

}  // namespace sunder::bench
