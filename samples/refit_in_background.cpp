// Weights of torn points fitted in the background: the tear is on screen at once with interpolated
// weights, a fit runs on another thread, and a few frames later its weights are swapped in. The
// engine uploads what the change record lists.

#include <sunder/tear/refit_job.h>
#include <sunder/tear/torn_weights.h>

#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

#include "samples/tube.h"

namespace {

int fail(const sunder::Status& status) { return std::printf("%s\n", status.text().data()), 1; }

}  // namespace

int main() {
  const auto tube = std::make_shared<const sunder::Character>(samples::make_tube({16, 24}));
  auto model = sunder::TornModel::create(tube);
  if (!model) return fail(model.error());

  // A tear along the joint, in a bent pose. At most four influences per vertex, interpolated for
  // now.
  const sunder::ModelPose pose = samples::bent(*tube, 0.9);
  const sunder::Stroke stroke = {{{0.01, 0.40, 0.5}, {0.01, 0.40, 0.0}},
                                 {{-0.03, 0.55, 0.6}, {-0.03, 0.55, 0.1}}};
  sunder::TearOptions options;
  options.weights = sunder::WeightOptions{sunder::WeightPolicy::refit, 4};
  const auto torn = model->tear(pose, stroke, options);
  if (!torn || torn->runs == 0) return std::printf("not torn\n"), 1;

  // The weights are fitted over the motion of the joint.
  sunder::WeightsOperation wanted;
  wanted.weights = *options.weights;
  wanted.refit.poses.clip_samples = 0;
  wanted.refit.poses.joint_limits = {{1, {1, 0, 0}, 0.0, 2.4}};
  const auto job = sunder::RefitJob::create(*model, wanted);
  if (!job) return fail(job.error());
  const std::jthread worker([job = *job] { job.run(); });

  std::vector<sunder::ModelPose> poses;
  for (int i = 1; i <= 12; ++i) poses.push_back(samples::bent(*tube, 0.2 * i));
  const auto before = sunder::measure_weight_errors(*model, 0, 1, poses);

  int frame = 0;
  for (; job->poll() != sunder::RefitJob::State::done; ++frame) {  // draws, and looks again
    if (job->poll() == sunder::RefitJob::State::failed) return fail(job->failure());
    std::this_thread::yield();
  }
  sunder::ChangeRecord change;
  const auto report = job->swap_in(*model, &change);
  if (!report) return fail(report.error());
  std::printf("frame %d: %u of %u points fitted\n", frame, report->refitted, report->points);
  for (const sunder::MeshChange& mesh : change.meshes)
    std::printf("mesh %u: %zu ranges of vertices to upload\n", mesh.mesh,
                mesh.dirty_vertices.size());

  const auto after = sunder::measure_weight_errors(*model, 0, 1, poses);
  if (!before || !after) return 1;
  std::printf("off by %.3f mm before, %.3f mm after\n", 1e3 * before->metres.rms,
              1e3 * after->metres.rms);
  return after->metres.rms < before->metres.rms ? 0 : 1;
}
