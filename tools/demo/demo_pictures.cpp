#include "tools/demo/demo_pictures.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "tools/picture/open_lips.h"
#include "tools/picture/picture.h"
#include "tools/picture/rims.h"

namespace sunder::tools {
namespace {

/// The time of a picture in the clip, and the minimum number of steps for the tissue to open since
/// the previous picture.
struct Shot {
  const char* name;
  double clip_fraction;
  bool is_torn;
  int steps;
};
constexpr Shot kShots[kDemoPictures] = {{"before", kTearFraction, false, 0},
                                        {"torn", kTearFraction, true, 4},
                                        {"later_1", 0.65, true, 30},
                                        {"later_2", 0.95, true, 30}};
constexpr int kPixels = 900;
constexpr double kMostSteps = 600;    ///< Between two pictures, because a clip may have any length.
constexpr double kThickness = 0.006;  ///< Thickness of the flesh, as a fraction of the diagonal.

Result<std::vector<DeformedMesh>> posed_at(const Character& character, double fraction) {
  const Result<ModelPose> pose = make_pose(character, pose_at(character, fraction));
  if (!pose) return pose.error();
  return pose_model(character, *pose);
}

/// The middle of the rims, and the direction of the surface there.
struct Wound {
  Vec3d middle, outwards;
};

Wound wound_of(const std::vector<RimEdge>& rims, const std::vector<DeformedMesh>& posed) {
  Wound wound{Vec3d::Zero(), Vec3d::Zero()};
  for (const RimEdge& edge : rims) {
    wound.middle +=
        posed[edge.mesh].positions[edge.a].cast<double>() / static_cast<double>(rims.size());
    wound.outwards += posed[edge.mesh].normals[edge.a].cast<double>();
  }
  wound.outwards.normalize();
  return wound;
}

/// The view at the moment of the tear. It is kept while the wound is visible; if the wound turns
/// away, the eye follows it.
ViewFrame follow(const ViewFrame& frame, const Wound& then, const Wound& now) {
  if (now.outwards.dot(frame.towards_eye) > 0.45) return frame;
  ViewFrame turned;
  turned.towards_eye = Quatd::FromTwoVectors(then.outwards, now.outwards) * frame.towards_eye;
  turned.right = Vec3d::UnitY().cross(turned.towards_eye);
  if (turned.right.norm() < 1e-3) return frame;
  turned.right.normalize();
  turned.up = turned.towards_eye.cross(turned.right);
  return turned;
}

/// Shows the whole model, with the wound near the middle.
Camera aim(const ViewFrame& frame, const Wound& wound, const Bounds& bounds) {
  Camera camera;
  camera.focal_point = 0.3 * wound.middle + 0.7 * bounds.centre();
  camera.up = frame.up;
  const double slope = std::tan(camera.view_angle_degrees / 2 * std::numbers::pi / 180);
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d half_size = bounds.size() / 2;
    const Vec3d signs((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                      (corner & 4) != 0 ? 1 : -1);
    const Vec3d offset = bounds.centre() + signs.cwiseProduct(half_size) - camera.focal_point;
    const double beside =
        std::max(std::abs(offset.dot(frame.right)), std::abs(offset.dot(frame.up)));
    distance = std::max(distance, beside / slope + offset.dot(frame.towards_eye));
  }
  camera.eye = camera.focal_point + 1.02 * distance * frame.towards_eye;
  return camera;
}

/// Plays the clip from one moment to another while the lips open.
Status play_on(CharacterInstance& instance, double from, double to, int least_steps) {
  const Character& torn = instance.character();
  const double seconds =
      torn.clips.empty() ? 0.0 : (to - from) * static_cast<double>(torn.clips[0].duration);
  const int steps = static_cast<int>(
      std::clamp(std::ceil(60 * seconds), static_cast<double>(least_steps), kMostSteps));
  for (int i = 1; i <= steps; ++i) {
    const Result<ModelPose> pose = make_pose(torn, pose_at(torn, from + (to - from) * i / steps));
    if (!pose) return pose.error();
    if (const Status status = instance.advance(*pose, kPictureStep); !status) return status;
  }
  return instance.draw();
}

/// The torn model at a moment of the clip: its surface, displaced by the tissue, and walls of
/// flesh.
Result<Character> still_at(double clip_fraction, const DemoTear& tear,
                           const std::vector<RimEdge>& rims, const ViewFrame& frame,
                           CharacterInstance& instance) {
  const Result<std::vector<DeformedMesh>> closed = posed_at(tear.model.character(), clip_fraction);
  if (!closed) return closed.error();
  const Result<std::vector<DeformedMesh>> untorn = posed_at(*tear.source, clip_fraction);
  if (!untorn) return untorn.error();
  std::vector<DeformedMesh> open = *closed;
  displace(instance, open);
  return make_torn_still(tear.model, open, *closed, *untorn, rims, frame,
                         kThickness * tear.bounds.size().norm());
}

}  // namespace

PoseSpec pose_at(const Character& character, double fraction) {
  if (character.clips.empty()) return RestPose{};
  return ClipPose{std::uint32_t{0}, fraction * static_cast<double>(character.clips[0].duration)};
}

Status draw_demo(const DemoTear& tear, const std::filesystem::path& folder, std::size_t first_step,
                 ProgressBar& progress) {
  const Character& torn = tear.model.character();
  Result<CharacterInstance> instance = make_gaping_instance(tear.source);
  if (!instance) return instance.error();
  if (const auto report = instance->apply(tear.operation); !report) return report.error();
  const Result<std::vector<DeformedMesh>> at_tear = posed_at(torn, kTearFraction);
  if (!at_tear) return at_tear.error();
  const std::vector<RimEdge> rims = find_rims(tear.model);
  const Wound fresh = wound_of(rims, *at_tear);
  for (std::size_t i = 0; i < kDemoPictures; ++i) {
    const Shot& shot = kShots[i];
    progress.begin_step(first_step + i, std::string("drawing ") + shot.name);
    const Result<std::vector<DeformedMesh>> closed = posed_at(torn, shot.clip_fraction);
    if (!closed) return closed.error();
    const Wound wound = wound_of(rims, *closed);
    const ViewFrame frame = follow(tear.frame, fresh, wound);
    const Camera camera = aim(frame, wound, bounds_of(torn, *closed));
    Result<Character> still = Character();
    if (shot.is_torn) {
      const double before = kShots[i - 1].clip_fraction;
      if (const Status status = play_on(*instance, before, shot.clip_fraction, shot.steps); !status)
        return status;
      still = still_at(shot.clip_fraction, tear, rims, frame, *instance);
    } else {
      const Result<std::vector<DeformedMesh>> untorn = posed_at(*tear.source, shot.clip_fraction);
      if (!untorn) return untorn.error();
      still = make_still(*tear.source, *untorn);
    }
    if (!still) return still.error();
    const std::filesystem::path png = folder / (std::string(shot.name) + ".png");
    if (const Status status = draw(*still, camera, kPixels, kPixels, png); !status) return status;
  }
  return {};
}

}  // namespace sunder::tools
