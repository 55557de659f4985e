#pragma once

#include <functional>
#include <vector>

#include <CLI/CLI.hpp>

#include "tools/plan/plan_request.h"
#include "tools/verbs.h"

namespace sunder::tools {

/// The requests of all verbs; parsing fills in one of them.
struct Requests {
  BindRequest bind;
  InfoRequest info;
  PictureRequest picture;
  PlanRequest plan;
  TearRequest tear;
  DemoRequest demo;
  TransferRequest transfer;
  ValidateRequest validate;
  ViewRequest view;
  StudioRequest studio;
  std::string shell;  ///< For `sunder completions`.
};

/// A verb and what runs it after parsing.
struct Verb {
  const CLI::App* app;
  std::function<ExitCode()> run;
};

/// The description, the version and the exit codes of the command.
void describe_command(CLI::App& app);

/// Adds all verbs to the command: also the hidden `man` and `completions`, which print the manual
/// page and the completions of a shell.
/// @param app, requests  must outlive the result.
[[nodiscard]] std::vector<Verb> add_verbs(CLI::App& app, Requests& requests);

}  // namespace sunder::tools
