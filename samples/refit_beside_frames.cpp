// Weights of torn points fitted beside the frame: torn and on screen at once with interpolated
// weights, fitted on another thread, swapped in a few frames later. The engine uploads what the
// change record says.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>
#include <vector>

namespace {

/// A sleeve around the x axis on two bones, an upper arm and a forearm.
std::shared_ptr<const sunder::Character> make_sleeve() {
  constexpr std::uint32_t kRings = 24, kSides = 16;
  auto character = std::make_shared<sunder::Character>();
  character->skeleton.bones.push_back({"upper arm", sunder::kNone, {}});
  sunder::Bone forearm{"forearm", 0, {}};
  forearm.rest.translation = {0.3f, 0.0f, 0.0f};
  character->skeleton.bones.push_back(forearm);
  sunder::Skin skin{
      "sleeve", {0, 1}, std::vector<sunder::Affine3f>(2, sunder::Affine3f::Identity())};
  skin.bone_from_bind[1].translation() = Eigen::Vector3f(-0.3f, 0.0f, 0.0f);
  character->skins.push_back(skin);
  sunder::Mesh mesh;
  mesh.name = "sleeve";
  mesh.submeshes.push_back({"cloth", sunder::kNone});
  for (std::uint32_t i = 0; i < kRings; ++i)
    for (std::uint32_t j = 0; j < kSides; ++j) {
      const float along = static_cast<float>(i) / (kRings - 1),
                  angle = 6.2831853f * static_cast<float>(j) / kSides;
      mesh.positions.emplace_back(0.6f * along, 0.05f * std::cos(angle), 0.05f * std::sin(angle));
      const float forward = std::clamp(3.0f * along - 1.0f, 0.0f, 1.0f);
      const sunder::Influence both[] = {{0, 1.0f - forward}, {1, forward}};
      mesh.weights.append(forward <= 0.0f   ? std::span<const sunder::Influence>(both, 1)
                          : forward >= 1.0f ? std::span<const sunder::Influence>(both + 1, 1)
                                            : std::span<const sunder::Influence>(both));
      if (i + 1 == kRings) continue;
      const std::uint32_t a = i * kSides + j, b = i * kSides + (j + 1) % kSides, c = a + kSides,
                          d = b + kSides;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  character->meshes.push_back(mesh);
  return character;
}

sunder::ModelPose bent(const sunder::Character& character, float angle) {
  sunder::Pose pose;
  for (const sunder::Bone& bone : character.skeleton.bones)
    pose.parent_from_bone.push_back(bone.rest);
  pose.parent_from_bone[1].rotation =
      sunder::Quatf(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
  sunder::ModelPose posed;
  (void)sunder::compute_model_pose(character.skeleton, pose, posed);
  return posed;
}

}  // namespace

int main() {
  const auto sleeve = make_sleeve();
  auto model = sunder::TornModel::create(sleeve);
  if (!model) return std::printf("%s\n", model.error().text().data()), 1;

  // A tear along the elbow, in a bent pose. Four influences a vertex, interpolated for now.
  const sunder::ModelPose pose = bent(*sleeve, 0.9f);
  const sunder::Stroke stroke = {{{0.24, 0.02, 0.3}, {0.24, 0.02, 0.0}},
                                 {{0.33, 0.05, 0.3}, {0.33, 0.05, 0.0}}};
  sunder::TearOptions options;
  options.weights = sunder::WeightOptions{sunder::WeightPolicy::refit, 4};
  const auto torn = model->tear(pose, stroke, options);
  if (!torn || torn->runs == 0) return std::printf("not torn\n"), 1;

  // What the elbow can do is what the weights are fitted to.
  sunder::WeightsOperation wanted;
  wanted.weights = *options.weights;
  wanted.refit.poses.clip_samples = 0;
  wanted.refit.poses.joint_limits = {{1, {0, 0, 1}, 0.0, 2.4}};
  const auto job = sunder::RefitJob::create(*model, wanted);
  if (!job) return std::printf("%s\n", job.error().text().data()), 1;
  std::thread worker([job = *job] { job.run(); });

  std::vector<sunder::ModelPose> poses;
  for (int i = 1; i <= 12; ++i) poses.push_back(bent(*sleeve, 0.2f * static_cast<float>(i)));
  const auto before = sunder::measure_weight_errors(*model, 0, 1, poses);

  for (int frame = 0;; ++frame) {  // draw, and look in
    if (job->poll() != sunder::RefitJob::State::done) {
      std::this_thread::yield();
      continue;
    }
    sunder::ChangeRecord change;
    const auto report = job->swap_in(*model, &change);
    if (!report) return std::printf("%s\n", report.error().text().data()), 1;
    std::printf("frame %d: %u of %u points fitted; %zu ranges of vertices to upload\n", frame,
                report->refitted, report->points, change.meshes[0].dirty_vertices.size());
    break;
  }
  worker.join();
  const auto after = sunder::measure_weight_errors(*model, 0, 1, poses);
  if (!before || !after) return 1;
  std::printf("off by %.3f mm before, %.3f mm after\n", 1e3 * before->metres.rms,
              1e3 * after->metres.rms);
  return after->metres.rms < before->metres.rms ? 0 : 1;
}
