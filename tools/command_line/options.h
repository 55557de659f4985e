#pragma once

#include <CLI/CLI.hpp>

#include "tools/verbs.h"

namespace sunder::tools {

// Each function adds a verb with its options to the command; parsing fills in the request.
CLI::App* add_bind(CLI::App& app, BindRequest& request);
CLI::App* add_info(CLI::App& app, InfoRequest& request);
CLI::App* add_plan(CLI::App& app, PlanRequest& request);
CLI::App* add_picture(CLI::App& app, PictureRequest& request);
CLI::App* add_studio(CLI::App& app, StudioRequest& request);
CLI::App* add_tear(CLI::App& app, TearRequest& request);
CLI::App* add_demo(CLI::App& app, DemoRequest& request);
CLI::App* add_transfer(CLI::App& app, TransferRequest& request);
CLI::App* add_validate(CLI::App& app, ValidateRequest& request);
CLI::App* add_view(CLI::App& app, ViewRequest& request);

/// `--slash`, `--sever`, `--puncture`, and their `--pose`.
void add_aimed_operations(CLI::App& verb);
/// Reads the aimed operations that were given, in order. @throws CLI::ValidationError
void read_aimed_operations(const CLI::App& verb, TearRequest& request);

/// `--robot`, its blade and its place. @return `--robot`.
CLI::Option* add_placed_robot(CLI::App& verb, RobotTearRequest& robot, const char* description);
CLI::Option* add_clip_speed(CLI::App& verb, RobotTearRequest& robot);
/// `--robot`, its motion, its blade and its place.
/// @param description  of `--robot`.
void add_robot(CLI::App& verb, RobotTearRequest& robot, const char* description);
/// Whether a robot is asked for, with all that it needs. @throws CLI::ValidationError
[[nodiscard]] bool has_robot(const CLI::App& verb, const RobotTearRequest& robot, bool needs_blade);

/// `--strict`, `--package-root`, `--import-seconds` and `--memory`: how the verb reads its models.
void add_model_reading(CLI::App& verb, ModelReading& reading);

/// `--max-seconds` and `--max-memory`: the work that the verb may do.
void add_budget(CLI::App& verb, BudgetLimits& limits);
/// `--max-vertices` too, for a verb that applies operations.
void add_budget_of_operations(CLI::App& verb, BudgetLimits& limits);

/// `--weights-as`, the number format of written weights.
void add_weights_as(CLI::App& verb, SaveOptions& save);
/// Refuses an output of the kinds of USD that are not written, and options that are only for GLB
/// with those that are. @throws CLI::ValidationError
void check_output_format(const CLI::App& verb, const std::filesystem::path& output);
/// `--max-error` and its limits, which exclude that the caller chooses influences and format.
/// @param verb  with the options --influences and --weights-as.
/// @param robot_limits  if not null, `--limits` may be a URDF file for fits, without `--max-error`.
void add_maximum_error(CLI::App& verb, std::optional<MaximumError>& wanted,
                       std::optional<std::filesystem::path>* robot_limits = nullptr);

}  // namespace sunder::tools
