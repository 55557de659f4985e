#include "tools/demo/demo_pictures.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tools/demo/demo_camera.h"
#include "tools/demo/torn_actor.h"
#include "tools/picture/wound_view.h"
#include "tools/render/trace.h"

namespace sunder::tools {
namespace {

constexpr PictureSize kStill, kMotion = {480, 360};
constexpr double kDemoFrame = 0.1;  ///< Seconds per picture of the motion.
constexpr int kFramesBefore = 5, kFramesOfTear = 5, kFrames = 26;
constexpr double kCloseness = 0.35;   ///< Of the pictures of the tear, as aim() has it.
constexpr double kSameEnds = 0.02;    ///< A clip whose ends differ less, by the diagonal, runs on.
constexpr float kFloorRadius = 1.5f;  ///< In diagonals.

/// The time of a picture in the clip, how near it is, and the time since the picture before.
struct Shot {
  const char* name;
  double clip_fraction, closeness, seconds;
  double turn;  ///< Degrees by which the view turns around a model that does not move.
};
constexpr Shot kShots[] = {{"torn", kTearFraction, kCloseness, 0, 0},
                           {"wound", kTearFraction, 1, 0, 0},
                           {"later_1", 0.65, 0, 0.5, 40},
                           {"later_2", 0.95, kCloseness, 0.5, -40}};

Result<std::vector<DeformedMesh>> posed_at(const Character& character, const PoseSpec& spec) {
  const Result<ModelPose> pose = make_pose(character, spec);
  if (!pose) return pose.error();
  return pose_model(character, *pose);
}

/// Puts a floor below a scene.
void add_floor(const std::vector<Vec3d>& places, RenderScene& scene) {
  Bounds bounds;
  for (const Vec3d& place : places) {
    bounds.least = bounds.least.cwiseMin(place);
    bounds.greatest = bounds.greatest.cwiseMax(place);
  }
  scene.floor = static_cast<float>(bounds.least.y() - 1e-3 * bounds.size().norm());
  scene.floor_radius = kFloorRadius * static_cast<float>(bounds.size().norm());
}

/// Poses of the motion: the clip around the moment of the tear.
class Motion {
 public:
  [[nodiscard]] static Result<Motion> create(const Character& character) {
    Motion motion(character);
    if (character.clips.empty()) return motion;
    const auto begin = posed_at(character, pose_at(character, 0));
    if (!begin) return begin.error();
    const auto end = posed_at(character, pose_at(character, 1));
    if (!end) return end.error();
    double farthest = 0;
    for (std::size_t m = 0; m < begin->size(); ++m)
      for (std::size_t v = 0; v < (*begin)[m].positions.size(); ++v)
        farthest = std::max(
            farthest,
            static_cast<double>(((*begin)[m].positions[v] - (*end)[m].positions[v]).norm()));
    motion.runs_on_ = farthest < kSameEnds * bounds_of(character, *begin).size().norm();
    return motion;
  }

  [[nodiscard]] PoseSpec pose(int frame) const {
    if (character_.clips.empty()) return RestPose{};
    const auto duration = static_cast<double>(character_.clips[0].duration);
    double time = kTearFraction * duration + (frame - kFramesBefore) * kDemoFrame;
    if (runs_on_ && duration > 0) time -= duration * std::floor(time / duration);
    return ClipPose{std::uint32_t{0}, std::clamp(time, 0.0, duration)};
  }

 private:
  explicit Motion(const Character& character) : character_(character) {}
  const Character& character_;
  bool runs_on_ = false;
};

static_assert(kDemoSteps == kFrames + std::size(kShots));

/// Tears as far as a picture of the motion shows.
Status tear_in_motion(int frame, TornActor& actor, std::size_t& next) {
  const int step = frame - kFramesBefore + 1;
  if (step < 1) return {};
  const std::size_t wanted = std::min(
      actor.blade_count(),
      (actor.blade_count() * static_cast<std::size_t>(step) + kFramesOfTear - 1) / kFramesOfTear);
  for (; next < wanted; ++next)
    if (const Status status = actor.tear_to(next); !status) return status;
  return {};
}

Status draw_motion(const DemoTear& tear, const ModelLooks& looks, const std::filesystem::path& png,
                   Budget& budget, std::size_t first_step, ProgressBar& progress,
                   TornActor& actor) {
  const Result<Motion> motion = Motion::create(*tear.source);
  if (!motion) return motion.error();
  std::vector<Vec3d> places, wound;
  for (int frame = 0; frame < kFrames; frame += 2) {
    const auto posed = posed_at(*tear.source, motion->pose(frame));
    if (!posed) return posed.error();
    for (const Vec3d& place : places_of(*tear.source, *posed)) places.push_back(place);
  }
  const Camera camera = aim(tear.frame, places, {}, 0);
  std::vector<Picture> pictures;
  std::size_t next = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    progress.begin_step(first_step++, "drawing motion");
    if (const Status status = actor.play(motion->pose(frame), kDemoFrame); !status) return status;
    if (const Status status = tear_in_motion(frame, actor, next); !status) return status;
    if (const Status status = actor.play(motion->pose(frame), 0); !status) return status;
    const Result<TornActor::Posture> posture = actor.posture();
    if (!posture) return posture.error();
    Result<RenderScene> scene = actor.scene(*posture, looks);
    if (!scene) return scene.error();
    add_floor(places, *scene);
    pictures.push_back(trace(*scene, camera, kMotion));
  }
  const Budget::Writing writing(budget);
  return write_animated_png(png, pictures, static_cast<int>(1000 * kDemoFrame));
}

Status write_still(const std::filesystem::path& png, const Picture& picture, Budget& budget) {
  const Budget::Writing writing(budget);
  return write_png(png, picture);
}

/// A view that goes around the model.
ViewFrame turned(const ViewFrame& frame, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  ViewFrame result = frame;
  result.towards_eye = std::cos(angle) * frame.towards_eye + std::sin(angle) * frame.right;
  result.right = frame.up.cross(result.towards_eye);
  return result;
}

/// One picture of the torn model, and one of the same moment before the tear if that is wanted.
Status draw_shot(const Shot& shot, const DemoTear& tear, const ModelLooks& looks,
                 const std::filesystem::path& folder, Budget& budget, ViewFrame& frame,
                 TornActor& actor) {
  const PoseSpec pose = pose_at(*tear.source, shot.clip_fraction);
  const Status status = shot.seconds > 0 ? actor.play(pose, shot.seconds) : actor.settle(pose);
  if (!status) return status;
  const Result<TornActor::Posture> posture = actor.posture();
  if (!posture) return posture.error();
  Result<RenderScene> scene = actor.scene(*posture, looks);
  if (!scene) return scene.error();
  std::vector<Vec3d> wound;
  if (posture->wound) {
    wound = posture->wound->places(posture->open);
    frame = see_wound(*scene, frame).frame;
  }
  const std::vector<Vec3d> places = places_of(actor.character(), posture->open);
  const bool is_still = tear.source->clips.empty();
  const Camera camera =
      aim(is_still ? turned(frame, shot.turn) : frame, places, wound, shot.closeness);
  add_floor(places, *scene);
  const std::filesystem::path png = folder / (std::string(shot.name) + ".png");
  if (const Status written = write_still(png, trace(*scene, camera, kStill), budget); !written)
    return written;
  if (&shot != &kShots[0]) return {};
  const auto untorn = posed_at(*tear.source, pose);
  if (!untorn) return untorn.error();
  RenderScene before = looks.begin_scene();
  for (std::size_t m = 0; m < untorn->size(); ++m)
    looks.add_mesh(tear.source->meshes[m], (*untorn)[m], {}, before);
  add_floor(places, before);
  return write_still(folder / "before.png", trace(before, camera, kStill), budget);
}

}  // namespace

PoseSpec pose_at(const Character& character, double fraction) {
  if (character.clips.empty()) return RestPose{};
  return ClipPose{std::uint32_t{0}, fraction * static_cast<double>(character.clips[0].duration)};
}

Status draw_demo(const DemoTear& tear, const ModelLooks& looks, const std::filesystem::path& folder,
                 Budget& budget, std::size_t first_step, ProgressBar& progress) {
  Result<TornActor> actor = TornActor::create(tear.source, tear.operation);
  if (!actor) return actor.error();
  if (const Status status =
          draw_motion(tear, looks, folder / "motion.png", budget, first_step, progress, *actor);
      !status)
    return status;
  first_step += kFrames;
  ViewFrame frame = tear.frame;
  for (const Shot& shot : kShots) {
    progress.begin_step(first_step++, std::string("drawing ") + shot.name);
    if (const Status status = draw_shot(shot, tear, looks, folder, budget, frame, *actor); !status)
      return status;
  }
  return {};
}

}  // namespace sunder::tools
