#pragma once

#include <sunder/io/character_file.h>
#include <sunder/validation/validation.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/budget/budget.h"
#include "tools/messages/exit_code.h"
#include "tools/messages/json.h"
#include "tools/messages/lines.h"
#include "tools/model/model_reading.h"

namespace sunder::tools {

/// A source and a target, loaded and compared.
struct ValidatedPair {
  std::filesystem::path source_file, target_file;
  LoadedCharacter source, target;
  ValidationReport report;
};

/// Files of one comparison and how to make it.
struct ValidatePair {
  std::filesystem::path source, target;
  std::optional<std::filesystem::path> operations;  ///< The log that made the target.
  std::optional<std::filesystem::path> bone_names;  ///< Bones whose names differ.
  TargetProfile profile = TargetProfile::none;
  std::string limits = "none";  ///< "none" (of a robot: its own), "clips" or a file.
  bool over_time = false;       ///< Also measures the deviation over the time of each clip.
  ModelReading reading = {};
  double error_deviation = ValidationOptions{}.error_deviation;  ///< See there.
};

/// A failure and the file that it is about.
struct ValidateFailure {
  std::string place;
  Status status;
  ExitCode otherwise = ExitCode::usage;
};

/// Loads both models and compares them. Repairs that loading made are findings.
/// @param budget  told which pair is compared.
/// @param failure  written where there is no result.
/// @param progress  see ValidationOptions.
[[nodiscard]] std::optional<ValidatedPair> validate_pair(
    const ValidatePair& pair, const std::function<void(std::string_view, double)>& progress,
    Budget& budget, ValidateFailure& failure);

/// The report for machines: version, files, verdicts, findings with places, figures.
[[nodiscard]] Json validation_json(const ValidatedPair& pair);

/// The report for people: one line per finding and a verdict.
/// @param fail_on    least severity of a finding that fails.
/// @param in_colour  with escape sequences.
[[nodiscard]] Lines validation_text(const ValidatedPair& pair, Severity fail_on, bool in_colour);

/// Whether some finding is at or above a severity.
[[nodiscard]] bool has_findings(const ValidationReport& report, Severity severity);

}  // namespace sunder::tools
