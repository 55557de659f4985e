#pragma once

#include <sunder/io/character_file.h>

#include <filesystem>
#include <optional>
#include <string>

#include "tools/exit_code.h"
#include "tools/refit.h"

namespace sunder::tools {

/// sunder info: describes a model.
struct InfoRequest {
  std::filesystem::path model;
  bool as_json = false;
};
[[nodiscard]] ExitCode run_info(const InfoRequest& request);

/// sunder tear: applies an operation log to a model.
struct TearRequest {
  std::filesystem::path model, operations, output;
  SaveOptions save;  ///< How influences are written.
  /// For operations without weights of their own; none: barycentric, with all influences.
  std::optional<WeightPolicy> weights;
  std::optional<RefitOver> refit_over;          ///< Only for `refit`; none: what the model has.
  std::optional<std::filesystem::path> report;  ///< None: stdout.
  std::optional<std::filesystem::path> log;     ///< Output file of the operations that were played.
  std::optional<std::filesystem::path> picture;  ///< Output file of a picture.
};
[[nodiscard]] ExitCode run_tear(const TearRequest& request);

/// sunder demo: tears a model in the middle of its animation and draws it.
struct DemoRequest {
  std::optional<std::filesystem::path> model;  ///< None: the embedded one.
  std::filesystem::path folder = "demo";
};
[[nodiscard]] ExitCode run_demo(const DemoRequest& request);

/// sunder validate: compares how the skins of two models deform.
struct ValidateRequest {
  std::filesystem::path source, target;
  std::optional<std::filesystem::path> operations, bones;
  std::string profile, limits = "none", fail_on = "error";
  std::optional<std::filesystem::path> report;    ///< Output file of the JSON report.
  std::optional<std::filesystem::path> manifest;  ///< Many pairs instead of source and target.
  unsigned jobs = 1;                              ///< Pairs of a manifest at a time.
  bool as_json_lines = false;                     ///< Progress and results on stdout.
};
[[nodiscard]] ExitCode run_validate(const ValidateRequest& request);

}  // namespace sunder::tools
