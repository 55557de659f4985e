#include "tools/demo/torn_actor.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <utility>

#include "tools/picture/taper_wounds.h"

namespace sunder::tools {

TornActor::TornActor(GapingModel model, TearOperation tear, ModelPose pose)
    : model_(std::move(model)), tear_(std::move(tear)), tear_pose_(std::move(pose)) {
  pose_ = tear_pose_;
}

Result<TornActor> TornActor::create(std::shared_ptr<const Character> source,
                                    const TearOperation& tear) {
  Result<ModelPose> pose = make_pose(*source, tear.pose);
  if (!pose) return pose.error();
  const Operation history[] = {tear};
  Result<GapingModel> model = make_gaping_model(std::move(source), history, *pose);
  if (!model) return model.error();
  if (const Status status = model->instance.undo(); !status) return status;
  return TornActor(std::move(*model), tear, std::move(*pose));
}

Status TornActor::tear_to(std::size_t blade) {
  CharacterInstance& instance = model_.instance;
  const auto keep = [this](const ChangeRecord& change) {
    wound_.lips.insert(wound_.lips.end(), change.lips.begin(), change.lips.end());
  };
  ChangeRecord change;
  if (blade == 0) return instance.begin_stroke(tear_pose_, tear_.stroke[0], tear_.options);
  if (const auto report = instance.extend_stroke(tear_pose_, tear_.stroke[blade], 0, &change);
      !report)
    return report.error();
  keep(change);
  if (blade + 1 < tear_.stroke.size()) return {};
  if (const auto report = instance.end_stroke(&change); !report) return report.error();
  keep(change);
  return {};
}

Status TornActor::play(const PoseSpec& pose, double seconds) {
  Result<ModelPose> wanted = make_pose(character(), pose);
  if (!wanted) return wanted.error();
  pose_ = std::move(*wanted);
  const int steps = std::max(1, static_cast<int>(seconds / kPictureStep + 0.5));
  for (int i = 0; i < steps; ++i)
    if (const Status status = model_.instance.advance(pose_, seconds / steps); !status)
      return status;
  return model_.instance.draw();
}

Status TornActor::settle(const PoseSpec& pose) {
  Result<ModelPose> wanted = make_pose(character(), pose);
  if (!wanted) return wanted.error();
  pose_ = std::move(*wanted);
  return open_lips(model_.instance, pose_);
}

Result<TornActor::Posture> TornActor::posture() {
  Result<std::vector<DeformedMesh>> closed = pose_model(character(), pose_);
  if (!closed) return closed.error();
  Posture posture{std::move(*closed), {}, {}};
  posture.open = posture.closed;
  displace(model_.instance, posture.open);
  if (wound_.lips.empty()) return posture;
  const std::span<const Wound> wounds(&wound_, 1);
  taper_wounds(model_.instance, wounds, posture.closed, posture.open);
  posture.wound.emplace(*model_.instance.model(), wounds, posture.closed);
  return posture;
}

Result<RenderScene> TornActor::scene(const Posture& posture, const ModelLooks& looks) {
  const TornModel& model = *model_.instance.model();
  const Character& source = model.source();
  if (posture.wound && bloody_lips_ != wound_.lips.size()) {
    Result<BloodCovers> blood =
        BloodCovers::create(model, tear_pose_, looks, posture.wound->length());
    if (!blood) return blood.error();
    blood_ = std::move(*blood);
    bloody_lips_ = wound_.lips.size();
  }
  RenderScene scene = looks.begin_scene();
  const auto covers = blood_.add_to(looks, scene);
  for (std::uint32_t m = 0; m < posture.open.size(); ++m) {
    ModelLooks::Flesh flesh{static_cast<std::uint32_t>(source.meshes[m].submeshes.size())};
    if (m < covers.size()) flesh.covers = covers[m];
    flesh.reaches = blood_.reaches_of(m);
    looks.add_mesh(character().meshes[m], posture.open[m], flesh, scene);
  }
  if (posture.wound) posture.wound->add(posture.closed, posture.open, ModelLooks::kFlesh, scene);
  return scene;
}

}  // namespace sunder::tools
