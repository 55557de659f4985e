#pragma once

#include <sunder/io/character_file.h>

#include <filesystem>
#include <optional>

#include "tools/exit_code.h"
#include "tools/refit.h"

namespace sunder::tools {

/// sunder info: says what is in a model.
struct InfoRequest {
  std::filesystem::path model;
  bool as_json = false;
};
[[nodiscard]] ExitCode run_info(const InfoRequest& request);

/// sunder tear: applies an operation log to a model.
struct TearRequest {
  std::filesystem::path model, operations, output;
  SaveOptions save;  ///< How influences are written.
  std::optional<WeightPolicy>
      weights;  ///< Of operations that do not say; else barycentric, with all influences.
  std::optional<RefitOver> refit_over;           ///< Only of `refit`; else what the model has.
  std::optional<std::filesystem::path> report;   ///< Else stdout.
  std::optional<std::filesystem::path> log;      ///< Where what was played is written, if wanted.
  std::optional<std::filesystem::path> picture;  ///< Likewise a picture of what is left.
};
[[nodiscard]] ExitCode run_tear(const TearRequest& request);

/// sunder demo: tears a model in the middle of its animation and takes pictures.
struct DemoRequest {
  std::optional<std::filesystem::path> model;  ///< Else the embedded one.
  std::filesystem::path folder = "demo";
};
[[nodiscard]] ExitCode run_demo(const DemoRequest& request);

}  // namespace sunder::tools
