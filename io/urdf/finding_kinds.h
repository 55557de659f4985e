#pragma once

#include <sunder/io/robot_file.h>

#include <span>
#include <string_view>

namespace sunder::urdf {

/// One row of the table of codes; docs/robot.md has the same rows.
struct FindingKind {
  std::string_view code;
  RobotSeverity severity;
  StatusCode status;  ///< Of the refusal, if it is an error or options are strict.
};

/// All codes that loading can find.
[[nodiscard]] std::span<const FindingKind> finding_kinds();

/// The row of a code of the table.
[[nodiscard]] const FindingKind& kind_of(std::string_view code);

}  // namespace sunder::urdf
