#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <system_error>
#include <vector>

#include "tools/demo_rig.h"
#include "tools/demo_stroke.h"
#include "tools/open_lips.h"
#include "tools/picture.h"
#include "tools/posed_model.h"
#include "tools/progress_bar.h"
#include "tools/report.h"
#include "tools/rims.h"
#include "tools/verbs.h"
#include "tools/weight_report.h"

namespace sunder::tools {
namespace {

/// When in the clip each picture is taken, and how much time the tissue has had to open since the
/// one before, at least; steps.
struct Shot {
  const char* name;
  double clip_fraction;
  bool is_torn;
  int steps;
};
constexpr Shot kShots[] = {{"before", 0.40, false, 0},
                           {"torn", 0.40, true, 4},
                           {"later_1", 0.65, true, 30},
                           {"later_2", 0.95, true, 30}};
constexpr int kPixels = 900;
constexpr double kTearFraction = 0.40;
constexpr double kMostSteps = 600;    ///< Between two pictures; a clip may be of any length.
constexpr double kThickness = 0.006;  ///< Of the flesh; of the diagonal.

/// The model and where it came from; without a file there is nothing to patch on saving.
struct DemoModel {
  LoadedCharacter loaded;
  bool is_embedded = false;
};

Result<DemoModel> get_model(const DemoRequest& request) {
  if (request.model) {
    Result<LoadedCharacter> loaded = load_character(*request.model);
    if (!loaded) return loaded.error();
    return DemoModel{*loaded, false};
  }
  LoadedCharacter embedded;
  embedded.character = std::make_shared<const Character>(make_cactus());
  embedded.report.format = "embedded";
  embedded.report.space = "metres, y up";
  return DemoModel{embedded, true};
}

Status save(const std::filesystem::path& file, const Character& character, const DemoModel& model) {
  return model.is_embedded ? save_glb(file, character) : save_glb(file, character, model.loaded);
}

PoseSpec pose_at(const Character& character, double fraction) {
  if (character.clips.empty()) return RestPose{};
  return ClipPose{std::uint32_t{0}, fraction * static_cast<double>(character.clips[0].duration)};
}

Result<std::vector<DeformedMesh>> posed_at(const Character& character, double fraction) {
  const Result<ModelPose> pose = make_pose(character, pose_at(character, fraction));
  if (!pose) return pose.error();
  return pose_model(character, *pose);
}

/// The rims' middle and the surface's direction there.
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

/// The eye of the tear's moment, kept as long as the wound stays in sight; where it turns away or
/// leaves, the eye goes with it.
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

/// The whole model, the wound near the middle.
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

/// The same tear as an operation log, to repeat it with `sunder tear`.
Json operations_json(const Character& character, const Stroke& stroke) {
  Json blades = Json::array();
  for (const Blade& blade : stroke)
    blades.push_back({{"base", vector_json(blade.base)}, {"tip", vector_json(blade.tip)}});
  Json pose = "rest";
  if (!character.clips.empty())
    pose = {{"clip", 0},
            {"time", kTearFraction * static_cast<double>(character.clips[0].duration)}};
  Json operation = {{"op", "tear"},
                    {"pose", std::move(pose)},
                    {"width", 0.0},
                    {"layers", "nearest"},
                    {"stroke", std::move(blades)}};
  return {{"sunder_operations", 1}, {"operations", Json::array({std::move(operation)})}};
}

/// The demo as far as it does not depend on a renderer.
struct Demo {
  TornModel model;
  OperationOutcome outcome;
  Result<OpenLips>
      lips;  ///< Or why they can't be opened: then there are no pictures, but all else.
  Stroke stroke;
  ViewFrame frame;
  Bounds bounds;
};

Result<Demo> tear_mid_clip(std::shared_ptr<const Character> character) {
  const Result<ModelPose> pose = make_pose(*character, pose_at(*character, kTearFraction));
  if (!pose) return pose.error();
  const Result<std::vector<DeformedMesh>> posed = pose_model(*character, *pose);
  if (!posed) return posed.error();
  const Bounds bounds = bounds_of(*character, *posed);
  const ViewFrame frame = choose_view(bounds);
  Stroke stroke = choose_stroke(*character, *posed, frame);
  if (stroke.empty())
    return Status::failure(StatusCode::empty_input, kNone,
                           "no surface is seen that a stroke could cross");

  Result<TornModel> model = TornModel::create(character);
  if (!model) return model.error();
  Result<OpenLips> lips = OpenLips::create(*model);
  std::vector<ChangeRecord> changes;
  const Result<OperationOutcome> outcome =
      play(TearOperation{*pose, stroke, {}, {}}, count_topology(*character), *model, &changes);
  if (!outcome) return outcome.error();
  if (lips)
    if (Status status = lips->follow(*model, changes); !status) lips = std::move(status);
  return Demo{std::move(*model), *outcome, std::move(lips), std::move(stroke), frame, bounds};
}

/// Plays the clip on from one moment to another, and lets the lips open meanwhile.
Status play_on(Demo& demo, double from, double to, int least_steps) {
  const Character& torn = demo.model.character();
  const double seconds =
      torn.clips.empty() ? 0.0 : (to - from) * static_cast<double>(torn.clips[0].duration);
  const int steps = static_cast<int>(
      std::clamp(std::ceil(60 * seconds), static_cast<double>(least_steps), kMostSteps));
  for (int i = 1; i <= steps; ++i) {
    const Result<ModelPose> pose = make_pose(torn, pose_at(torn, from + (to - from) * i / steps));
    if (!pose) return pose.error();
    if (const Status status = demo.lips->step(demo.model, *pose); !status) return status;
  }
  return {};
}

Status take_pictures(Demo& demo, const std::filesystem::path& folder, ProgressBar& progress) {
  if (!demo.lips) return demo.lips.error();
  const Character& torn = demo.model.character();
  const double diagonal = demo.bounds.size().norm();
  const Result<std::vector<DeformedMesh>> at_tear = posed_at(torn, kTearFraction);
  if (!at_tear) return at_tear.error();
  const std::vector<RimEdge> rims = find_rims(demo.model);
  const Wound fresh = wound_of(rims, *at_tear);
  for (std::size_t i = 0; i < std::size(kShots); ++i) {
    const Shot& shot = kShots[i];
    progress.begin_step(2 + i, std::string("drawing ") + shot.name);
    Result<std::vector<DeformedMesh>> closed = posed_at(torn, shot.clip_fraction);
    if (!closed) return closed.error();
    const Wound wound = wound_of(rims, *closed);
    const ViewFrame frame = follow(demo.frame, fresh, wound);
    const Camera camera = aim(frame, wound, bounds_of(torn, *closed));
    const Result<std::vector<DeformedMesh>> untorn =
        posed_at(demo.model.source(), shot.clip_fraction);
    if (!untorn) return untorn.error();
    Character still;
    if (shot.is_torn) {
      if (const Status status =
              play_on(demo, kShots[i - 1].clip_fraction, shot.clip_fraction, shot.steps);
          !status)
        return status;
      std::vector<DeformedMesh> open = *closed;
      demo.lips->displace(open);
      still =
          make_torn_still(demo.model, open, *closed, *untorn, rims, frame, kThickness * diagonal);
    } else {
      still = make_still(demo.model.source(), *untorn);
    }
    if (const Status status =
            draw(still, camera, kPixels, kPixels, folder / (std::string(shot.name) + ".png"));
        !status)
      return status;
  }
  return {};
}

}  // namespace

ExitCode run_demo(const DemoRequest& request) {
  const std::string place = request.model ? request.model->string() : "embedded cactus";
  ProgressBar progress(2 + std::size(kShots));
  progress.begin_step(0, "reading");
  const Result<DemoModel> model = get_model(request);
  if (!model) return complain(place, model.error(), ExitCode::unreadable_input);
  const Character& character = *model->loaded.character;

  std::error_code error;
  std::filesystem::create_directories(request.folder, error);
  if (error) {
    std::fprintf(stderr, "sunder: %s: cannot make this folder: %s\n", request.folder.c_str(),
                 error.message().c_str());
    return ExitCode::unreadable_input;
  }

  progress.begin_step(1, "tearing");
  Result<Demo> demo = tear_mid_clip(model->loaded.character);
  if (!demo) return complain(place, demo.error(), ExitCode::unreadable_input);

  const std::filesystem::path output = request.folder / "torn.glb";
  if (model->is_embedded)
    if (const Status status = save(request.folder / "cactus.glb", character, *model); !status)
      return complain((request.folder / "cactus.glb").string(), status, ExitCode::internal_error);
  if (const Status status = save(output, demo->model.character(), *model); !status)
    return complain(output.string(), status, ExitCode::internal_error);
  const Result<Json> weight_errors = weight_errors_by_policy_json(
      demo->model, model->loaded.character, pose_at(character, kTearFraction));
  if (!weight_errors) return complain(place, weight_errors.error(), ExitCode::internal_error);
  const Json report = {
      {"sunder_report", 1},
      {"model", place},
      {"output", output.string()},
      {"loading", to_json(model->loaded.report)},
      {"operations", Json::array({to_json(demo->outcome, demo->model.character())})},
      {"weight_errors", *weight_errors},
      {"result", result_json(demo->model, demo->outcome.before, demo->outcome.after)}};
  if (const Status status = write_text(request.folder / "report.json", dump(report)); !status)
    return complain((request.folder / "report.json").string(), status, ExitCode::unreadable_input);
  if (const Status status =
          write_text(request.folder / "ops.json", dump(operations_json(character, demo->stroke)));
      !status)
    return complain((request.folder / "ops.json").string(), status, ExitCode::unreadable_input);
  if (demo->outcome.has_missed) {
    std::fprintf(stderr, "sunder: %s: the stroke missed\n", place.c_str());
    return ExitCode::findings;
  }

  if (!can_draw()) {
    std::fputs(
        "sunder: no pictures: f3d and xvfb-run are not both installed (Debian: apt install f3d "
        "xvfb xauth)\n",
        stderr);
    return ExitCode::findings;
  }
  if (const Status status = take_pictures(*demo, request.folder, progress); !status) {
    (void)complain(request.folder.string() + ": pictures", status, ExitCode::findings);
    return ExitCode::findings;
  }
  return ExitCode::ok;
}

}  // namespace sunder::tools
