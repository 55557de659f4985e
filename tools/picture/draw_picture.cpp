#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tools/messages/messages.h"
#include "tools/messages/output_file.h"
#include "tools/messages/overwriting.h"
#include "tools/messages/printed.h"
#include "tools/messages/progress_bar.h"
#include "tools/messages/written_file.h"
#include "tools/model/bone_extents.h"
#include "tools/model/history.h"
#include "tools/model/joint_values.h"
#include "tools/model/load_notes.h"
#include "tools/model/name_advice.h"
#include "tools/model/named_poses.h"
#include "tools/model/plain_operations.h"
#include "tools/model/pose_argument.h"
#include "tools/model/robot_joints.h"
#include "tools/picture/bone_marks.h"
#include "tools/picture/guide_marks.h"
#include "tools/picture/labels.h"
#include "tools/picture/model_looks.h"
#include "tools/picture/operation_marks.h"
#include "tools/picture/posed_robot.h"
#include "tools/render/png_file.h"
#include "tools/render/trace.h"
#include "tools/tear/robot_tear.h"
#include "tools/verbs.h"

namespace sunder::tools {
namespace {

const Messages kMessages(Verbosity::normal);
const Vec3f kBackdrop(0.847f, 0.867f, 0.888f);  ///< Linear.

void say(const std::string& text) { kMessages.say(text); }
void warn(const std::string& text) { kMessages.warn(text); }

/// The model in the pose of the picture.
struct Subject {
  PoseArgument pose;
  ModelPose model_pose;
  std::vector<DeformedMesh> meshes;
  Bounds bounds;
  std::vector<BoneExtent> bones;
};

Result<Subject> pose_subject(const Character& character, PoseArgument argument) {
  Result<ModelPose> pose = make_pose(character, argument.spec);
  if (!pose) return pose.error();
  Result<std::vector<DeformedMesh>> meshes = pose_model(character, *pose);
  if (!meshes) return meshes.error();
  Subject subject{std::move(argument), std::move(*pose), std::move(*meshes), {}, {}};
  subject.bounds = bounds_of(character, subject.meshes);
  subject.bones = measure_bones(character, subject.model_pose, subject.meshes);
  return subject;
}

/// Whether a bone is `ancestor` or below it.
bool is_of_branch(const Skeleton& skeleton, std::uint32_t bone, std::uint32_t ancestor) {
  while (bone != kNone && bone != ancestor) bone = skeleton.bones[bone].parent;
  return bone == ancestor;
}

/// The vertices that a bone and those below it move predominantly; all vertices for kNone.
std::vector<Vec3d> places_of_limb(const Character& character, const Subject& subject,
                                  std::uint32_t bone) {
  std::vector<Vec3d> places;
  for (std::size_t m = 0; m < subject.meshes.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    const std::vector<std::uint32_t> bones = predominant_bones(character.skins[mesh.skin], mesh);
    for (std::size_t v = 0; v < bones.size(); ++v)
      if (bones[v] != kNone && (bone == kNone || is_of_branch(character.skeleton, bones[v], bone)))
        places.emplace_back(subject.meshes[m].positions[v].cast<double>());
  }
  return places;
}

/// @return the index of a bone; not_found; empty_input if it moves no surface.
Result<std::uint32_t> find_limb(const Character& character, const Subject& subject,
                                const std::string& name) {
  for (std::uint32_t i = 0; i < character.skeleton.bones.size(); ++i) {
    if (character.skeleton.bones[i].name != name) continue;
    if (subject.bones[i].vertices_of_branch > 0) return i;
    return Status::failure(StatusCode::empty_input, i,
                           "bone '%s' and those below it move no surface predominantly",
                           name.c_str());
  }
  return Status::failure(StatusCode::not_found, kNone, "the model has no bone '%s'", name.c_str());
}

/// The bones with a surface whose names resemble one that is not there.
std::string advice_on_limb(const Character& character, const Subject& subject,
                           const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < subject.bones.size(); ++i)
    if (subject.bones[i].vertices_of_branch > 0) names.push_back(character.skeleton.bones[i].name);
  return name_advice(name, "bones", names);
}

/// @param robot  its surfaces.
RenderScene make_scene(const Character& character, const Subject& subject,
                       const std::vector<Mesh>& robot, const ModelLooks& looks) {
  RenderScene scene = looks.begin_scene();
  for (std::size_t m = 0; m < subject.meshes.size(); ++m)
    looks.add_mesh(character.meshes[m], subject.meshes[m], {}, scene);
  add_surfaces(robot, looks, scene);
  scene.backdrop = kBackdrop;
  scene.backdrop_rise = 0;
  return scene;
}

/// Draws everything that was asked for in addition to the model. @return whether all of it is seen.
bool draw_marks(const PictureRequest& request, const Character& character, const Subject& subject,
                const std::vector<NumberedOperation>& operations, Marks& marks) {
  Labels labels(marks);
  bool is_complete = true;
  if (request.with_grid) {
    const Grid grid = choose_grid(subject.bounds);
    draw_grid(grid, subject.bounds, marks);
    say(printed("grid: one line per %g m, every tenth is heavier; at y = %.4g", grid.spacing,
                grid.height));
  }
  const std::vector<OperationLabel> indices = draw_operations(operations, subject.bounds, marks);
  if (request.with_bones) draw_bones(character.skeleton, subject.bones, marks);
  for (const OperationLabel& index : indices)
    if (marks.viewport().depth(index.place) > 0)
      labels.place_beside(marks.viewport().pixel(index.place), index.text, Vec4f(0, 0, 0, 1));
  if (request.with_axes) draw_axes(marks, labels);
  if (request.with_bones) {
    const std::size_t without_name =
        name_bones(character.skeleton, subject.bones, marks.viewport(), labels);
    if (without_name > 0)
      say("bones: no room for " + std::to_string(without_name) +
          " names; --bone or a larger --size makes room");
  }
  for (const std::string& missing :
       missing_from_picture(operations, subject.bounds, marks.viewport())) {
    warn(missing);
    is_complete = false;
  }
  return is_complete;
}

/// Warns of operations whose places belong to another pose than that of the picture.
void warn_of_other_poses(const Character& character, const Subject& subject,
                         const std::vector<NumberedOperation>& operations) {
  for (const NumberedOperation& logged : operations) {
    const Result<std::vector<ModelPose>> poses = poses_of(*logged.operation, character);
    if (!poses) continue;
    const bool differs = std::any_of(poses->begin(), poses->end(), [&](const ModelPose& pose) {
      for (std::size_t i = 0; i < pose.model_from_bone.size(); ++i)
        if (!pose.model_from_bone[i].isApprox(subject.model_pose.model_from_bone[i], 1e-6))
          return true;
      return false;
    });
    if (differs)
      warn("operation " + std::to_string(logged.index) +
           " is made in another pose than that of the picture, where the surface is elsewhere");
  }
}

/// The pose that was asked for; otherwise that of the last operation with a place, or rest.
Result<PoseArgument> choose_pose(const PictureRequest& request, const Character& character,
                                 const std::vector<NumberedOperation>& operations) {
  if (!request.joints.empty()) {
    Result<ModelPose> pose = pose_of_joints(request.joints, request.model);
    if (!pose) return pose.error();
    return PoseArgument{std::move(*pose), "of --joints", ""};
  }
  if (request.pose) return parse_pose(*request.pose, character);
  for (auto logged = operations.rbegin(); logged != operations.rend(); ++logged) {
    if (std::holds_alternative<WeightsOperation>(*logged->operation)) continue;
    const std::string name = "of operation " + std::to_string(logged->index);
    return PoseArgument{last_pose_of(*logged->operation), name, "drawn in the pose " + name};
  }
  return PoseArgument{RestPose{}, "rest", ""};
}

/// Reads the robot that was asked for, and adds the tear of its blade to the operations.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode read_robot(const PictureRequest& request, const Character& character,
                    std::optional<RobotTear>& robot, std::vector<Operation>& operations) {
  if (!request.robot) return ExitCode::ok;
  robot.emplace();
  if (request.robot->link.empty())
    return place_robot(*request.robot, request.reading, kMessages, *robot);
  const ExitCode code =
      make_robot_tear(*request.robot, request.reading, character, kMessages, *robot);
  if (code == ExitCode::ok) operations.push_back(robot->tear);
  return code;
}

ExitCode draw_scene(const PictureRequest& request, const LoadedCharacter& loaded,
                    const Subject& subject, const std::vector<Mesh>& robot,
                    const std::vector<NumberedOperation>& operations, ProgressBar& progress,
                    Budget& budget) {
  const Character& character = *loaded.character;
  std::uint32_t limb = kNone;
  if (request.bone) {
    const Result<std::uint32_t> found = find_limb(character, subject, *request.bone);
    if (!found)
      return complain(request.model.string() + ": --bone", found.error(), ExitCode::usage,
                      advice_on_limb(character, subject, *request.bone));
    limb = *found;
  }
  const ViewFrame frame = view_from(request.from);
  std::vector<Vec3d> framed = places_of_limb(character, subject, limb);
  if (limb == kNone) {
    const std::vector<Vec3d> of_operations = places_of(operations, subject.bounds);
    framed.insert(framed.end(), of_operations.begin(), of_operations.end());
    for (const Mesh& surface : robot)
      for (const Vec3f& position : surface.positions) framed.emplace_back(position.cast<double>());
  }
  const Viewport viewport(frame, request.size, framed);
  Marks marks(viewport);
  const bool is_complete = draw_marks(request, character, subject, operations, marks);
  progress.begin_step(1, "reading images");
  const Result<ModelLooks> looks = ModelLooks::create(loaded.source.get());
  if (!looks) return complain(request.model.string(), looks.error(), ExitCode::internal_error);
  const std::string missing = looks->missing_textures();
  if (!missing.empty()) warn(request.model.string() + ": " + missing);
  progress.begin_step(2, "drawing");
  RenderScene scene = make_scene(character, subject, robot, *looks);
  scene.marks = marks.take();
  const Picture picture = trace(scene, viewport.camera(), request.size);
  budget.end();
  if (const Status status = write_png(request.output, picture); !status)
    return complain(request.output.string(), status, ExitCode::internal_error);
  say(written(request.output));
  return is_complete && missing.empty() ? ExitCode::ok : ExitCode::findings;
}

/// Refuses an output that is an input or no file.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode check_output(const PictureRequest& request) {
  std::vector<NamedFile> inputs = {{"MODEL", request.model}};
  if (request.operations) inputs.push_back({"--ops", *request.operations});
  if (request.robot) {
    inputs.push_back({"--robot", request.robot->robot});
    if (!request.robot->trajectory.empty())
      inputs.push_back({"--trajectory", request.robot->trajectory});
  }
  if (const std::string fault = overwriting(inputs, {{"--output", request.output}});
      !fault.empty()) {
    print_error("sunder: " + fault);
    return ExitCode::usage;
  }
  if (const std::string fault = impossible_output({{"--output", request.output}}); !fault.empty()) {
    print_error("sunder: " + fault);
    return ExitCode::unreadable_input;
  }
  if (const std::string fault = other_ending({"--output", request.output}, "png"); !fault.empty())
    warn(fault);
  return ExitCode::ok;
}

/// Refuses operations whose poses the model does not have.
/// @param logged_count  of those in the log; a robot's is behind them.
ExitCode check_poses(const PictureRequest& request, const Character& character,
                     const std::vector<NumberedOperation>& operations, std::size_t logged_count) {
  for (const NumberedOperation& logged : operations)
    if (const auto poses = poses_of(*logged.operation, character); !poses)
      return complain(
          logged.index < logged_count
              ? request.operations->string() + ": /operations/" + std::to_string(logged.index)
              : "--robot",
          poses.error(), ExitCode::usage, advice_on_names(*logged.operation, character));
  return ExitCode::ok;
}

}  // namespace

ExitCode run_picture(const PictureRequest& request) {
  if (const ExitCode code = check_output(request); code != ExitCode::ok) return code;
  Budget budget(request.budget, request.model.string());
  ProgressBar progress(3);
  progress.begin_step(0, "reading");
  const Result<LoadedCharacter> loaded =
      load_character(request.model, load_options(request.reading));
  if (!loaded) return complain(request.model.string(), loaded.error(), ExitCode::unreadable_input);
  warn_of_repairs(request.model.string(), loaded->report, Messages(Verbosity::normal));
  std::vector<Operation> log;
  if (request.operations) {
    auto read = load_plain_operations(*request.operations, loaded->character, budget);
    if (!read) return complain(request.operations->string(), read.error(), ExitCode::usage);
    log = std::move(*read);
  }
  const std::size_t logged_count = log.size();
  std::optional<RobotTear> robot;
  if (const ExitCode code = read_robot(request, *loaded->character, robot, log);
      code != ExitCode::ok)
    return code;
  const Result<std::vector<Mesh>> surfaces =
      robot ? robot_surfaces(posed_robot(*robot)) : std::vector<Mesh>();
  if (!surfaces) return complain("--robot", surfaces.error(), ExitCode::internal_error);
  const Result<std::vector<NumberedOperation>> operations = remaining_operations(log);
  if (!operations)
    return complain(request.operations->string(), operations.error(), ExitCode::usage);
  if (const ExitCode code = check_poses(request, *loaded->character, *operations, logged_count);
      code != ExitCode::ok)
    return code;
  const Result<PoseArgument> pose = choose_pose(request, *loaded->character, *operations);
  if (!pose)
    return complain(request.model.string() + (request.pose ? ": --pose" : ": --joints"),
                    pose.error(), ExitCode::usage,
                    request.pose ? advice_on_pose(*request.pose, *loaded->character) : "");
  if (!pose->remark.empty()) (request.pose ? warn : say)(pose->remark);
  bool has_all_textures = true;
  for (const LoadNote& note : loaded->report.notes) {
    if (!note.place.starts_with("texture")) continue;
    warn(note.place + ": " + note.text);
    has_all_textures = false;
  }
  const Result<Subject> subject = pose_subject(*loaded->character, *pose);
  if (!subject)
    return complain(request.model.string() + ": pose " + pose->name, subject.error(),
                    ExitCode::usage);
  warn_of_other_poses(*loaded->character, *subject, *operations);
  const ExitCode code =
      draw_scene(request, *loaded, *subject, *surfaces, *operations, progress, budget);
  return code == ExitCode::ok && !has_all_textures ? ExitCode::findings : code;
}

}  // namespace sunder::tools
