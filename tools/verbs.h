#pragma once

#include <sunder/binding/binding.h>
#include <sunder/io/character_file.h>
#include <sunder/operation/aimed_operation.h>
#include <sunder/robot/trajectory.h>
#include <sunder/validation/transfer.h>
#include <sunder/validation/validation.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/budget/budget.h"
#include "tools/messages/exit_code.h"
#include "tools/messages/messages.h"
#include "tools/model/model_reading.h"
#include "tools/open/flesh_option.h"
#include "tools/open/tissue_field.h"
#include "tools/render/camera.h"
#include "tools/tear/refit.h"
#include "tools/tear/wound_channels.h"
#include "tools/written_weights/certified_weights.h"

namespace sunder::tools {

/// sunder info: describes a model.
struct InfoRequest {
  std::filesystem::path model;
  bool as_json = false;
  bool with_bones = false;                      ///< The bones with their places and surfaces.
  std::string pose = "rest";                    ///< As parse_pose().
  std::optional<std::filesystem::path> report;  ///< File for the JSON object.
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_info(const InfoRequest& request);

/// A robot whose blade tears a model: part of sunder tear.
struct RobotTearRequest {
  std::filesystem::path robot, trajectory;
  std::string link;                                     ///< That carries the blade.
  Vec3d base = Vec3d::Zero(), tip = Vec3d(0, 0, 0.05);  ///< In the link's frame, metres.
  Affine3d place = Affine3d::Identity();                ///< In the model's space, y up.
  std::string pose = "rest";                            ///< Of the model, as parse_pose().
  double clip_speed = 0.0;                              ///< Seconds per second.
  double spacing = SweepOptions{}.spacing;
  bool clamps_to_limits = false;
  TearOptions options;
};

/// How `sunder tear --open` writes gaping lips.
enum class OpenLips : std::uint8_t {
  no,     ///< Lips coincide.
  morph,  ///< As a morph target whose weight opens them.
  baked,  ///< In the positions.
};

/// sunder tear: applies operations to a model: those of a log, then those of the command line.
struct TearRequest {
  /// An operation of the command line, and the option that gives it: "--slash LeftArm@0.4".
  struct Aimed {
    AimedOperation operation;
    std::string option;
    /// Whether it gives a share of the bone; otherwise the nearest one counts that works.
    bool has_share = false;
    std::optional<bool> detaches = {};  ///< Of a sever; empty: if pieces are written.
    bool takes_props = true;            ///< Whether separate parts come off with the limb.
    std::string material = {};          ///< Name of the caps' or walls' material; empty: none.
  };
  std::filesystem::path model, operations;  ///< No log: empty.
  std::vector<Aimed> aimed;                 ///< In the order in which they were given.
  std::optional<RobotTearRequest> robot;    ///< Tears after all others.
  /// A weld or suture of the command line, and the option that gives it.
  struct Closing {
    Operation operation;
    std::string option;
  };
  std::vector<Closing> closings;                ///< After all tears: sutures, then welds.
  std::optional<std::filesystem::path> output;  ///< Only empty in a dry run.
  SaveOptions save;                             ///< How influences are written.
  /// Chooses influences and formats in place of `save`.
  std::optional<MaximumError> maximum_error;
  /// For operations without weights of their own; empty: barycentric, with all influences.
  std::optional<WeightPolicy> weights;
  /// Only for `refit`; empty: clips and range of motion, or what the model has.
  std::optional<RefitOptions> refit_over;
  double refit_bound = RefitOptions{}.bound;    ///< RefitOptions::bound.
  std::optional<std::filesystem::path> report;  ///< JSON; "-": stdout. Empty: a summary instead.
  bool weight_errors = false;                   ///< Measured for the report.
  bool count_topology = false;                  ///< Per operation, for the report.
  OpenLips open = OpenLips::no;
  FleshOption flesh;  ///< With `open`.
  /// When lips open in a clip; without an end, as the tissue does from then on.
  struct OpenSpan {
    std::string clip;
    double begin = 0;  ///< Seconds of the clip.
    std::optional<double> end = {};
  };
  std::optional<OpenSpan> open_span;       ///< With `open`.
  std::vector<TissueField> tissue_fields;  ///< With `open` or `picture`; of each factor one.
  /// Blood on the textures so far from lips, metres; 0: as the size of the model suggests.
  std::optional<double> blood;
  std::optional<Vec3d> facing;   ///< Of the character, for `aimed`; empty: as the rig tells.
  bool keep_going = false;       ///< Operations that fail are reported and left out.
  bool dry_run = false;          ///< Writes no files.
  bool force = false;            ///< Outputs may overwrite inputs.
  bool without_origins = false;  ///< The file does not tell where its vertices come from.
  Verbosity verbosity = Verbosity::normal;
  std::optional<std::string> pieces;  ///< Beginning of the names of files for detached pieces.
  bool pieces_are_animated = false;
  std::optional<std::filesystem::path> log;  ///< Output file for the log of the applied operations.
  std::optional<std::filesystem::path> picture;       ///< Output file for a picture.
  std::optional<std::filesystem::path> wound_mask;    ///< Output file for a WoundMask.
  std::uint32_t wound_mask_size = 1024;               ///< Texels a side.
  double wound_mask_reach = 0.01;                     ///< Metres.
  std::vector<MaskChannel> wound_mask_channels;       ///< Each once.
  std::optional<std::filesystem::path> robot_limits;  ///< URDF: joint limits for `refit`.
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_tear(const TearRequest& request);

struct PlanRequest;  // "tools/plan/plan_request.h"
/// sunder plan: finds the motion of a robot or a hand that makes a wound.
[[nodiscard]] ExitCode run_plan(const PlanRequest& request);

/// sunder view: writes a page that shows a model and makes operation logs.
struct ViewRequest {
  std::filesystem::path model, output;
  std::optional<std::filesystem::path> torn, operations;
  bool has_images = true;  ///< Whether the images of base colours are embedded.
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_view(const ViewRequest& request);

/// sunder studio: serves the page of bindings/js/studio to this machine, until SIGINT.
struct StudioRequest {
  std::optional<std::filesystem::path> model;
  std::optional<std::filesystem::path> page;  ///< Empty: the installed or built one.
  std::uint16_t port = 0;                     ///< 0: a free one.
  bool opens_browser = true;
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_studio(const StudioRequest& request);

/// sunder picture: draws a model in a pose.
struct PictureRequest {
  std::filesystem::path model, output;
  std::optional<std::string> pose;  ///< As parse_pose(); empty: that of the operations, or rest.
  Vec3d from = Vec3d::UnitZ();      ///< Direction from the model to the eye.
  std::optional<std::string> bone;  ///< The bone whose limb fills the frame; empty: the model.
  PictureSize size;
  bool with_axes = false, with_grid = false, with_bones = false;
  std::optional<std::filesystem::path> operations;  ///< Drawn on the model, not applied.
  std::vector<std::string> joints;  ///< Of a robot, in place of `pose`; as pose_of_joints().
  /// A robot beside the model, at the end of its trajectory or at rest; with the way of its blade
  /// if a link is given.
  std::optional<RobotTearRequest> robot;
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_picture(const PictureRequest& request);

/// sunder demo: tears a model in the middle of its animation and draws it.
struct DemoRequest {
  std::optional<std::filesystem::path> model;  ///< Empty: the embedded model.
  std::filesystem::path folder = "demo";
  bool no_pictures = false;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_demo(const DemoRequest& request);

/// sunder transfer: gives a model the skin of another one.
struct TransferRequest {
  std::filesystem::path source, target, output;
  TransferOptions options;  ///< But for what the files below say.
  bool copies_clips = false;
  SaveOptions save;
  std::optional<MaximumError> maximum_error;  ///< As in TearRequest.
  std::optional<std::filesystem::path>
      bone_names;  ///< JSON: {"bone of the target": "of the source"}.
  std::optional<std::filesystem::path>
      vertices;                     ///< JSON: {"mesh": [vertex, …]}; others are locked.
  std::optional<std::string> lock;  ///< Attribute of the target's vertices.
  std::optional<std::filesystem::path> report;
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_transfer(const TransferRequest& request);

/// sunder bind: attaches a model to the skeleton of another one.
struct BindRequest {
  std::filesystem::path model, skeleton, output;
  std::optional<std::filesystem::path> map;  ///< JSON: {"bone of the model": "of the skeleton"}.
  bool refuse_unmapped = false;              ///< MappingOptions::refuse_unmapped.
  HeatOptions options;                       ///< Without a map; but for the place.
  std::string pose = "rest";                 ///< Of the skeleton, as parse_pose().
  std::vector<std::string> joints;           ///< "elbow=0.3": values of a robot, its pose.
  std::optional<Affine3d> place;             ///< BindingPlace::rig_from_model.
  bool fit = false;                          ///< Whether fit_place() finds it.
  SaveOptions save;
  std::optional<std::filesystem::path> report;
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_bind(const BindRequest& request);

/// sunder validate: compares how the skins of two models deform.
struct ValidateRequest {
  std::filesystem::path source, target;
  std::optional<std::filesystem::path> operations, bone_names;
  std::string profile, limits = "none", fail_on = "error";
  double error_deviation = ValidationOptions{}.error_deviation;
  std::optional<std::filesystem::path> report;    ///< Output file of the JSON report.
  std::optional<std::filesystem::path> html;      ///< Output file of the page.
  std::optional<std::filesystem::path> manifest;  ///< Many pairs instead of source and target.
  unsigned jobs = 1;                              ///< Pairs of a manifest at a time.
  bool as_json_lines = false;                     ///< Progress and results on stdout.
  ModelReading reading;
  BudgetLimits budget;
};
[[nodiscard]] ExitCode run_validate(const ValidateRequest& request);

}  // namespace sunder::tools
