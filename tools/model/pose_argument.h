#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/pose_spec.h>

#include <string>

namespace sunder::tools {

/// A pose of the command line.
struct PoseArgument {
  PoseSpec spec;
  std::string name;    ///< "rest", "bind" or "'Walk' at 0.4 s".
  std::string remark;  ///< What the user should know about it; empty: nothing.
};

/// Reads "rest", "bind" or CLIP@TIME: the name of a clip and a time in seconds. A time beyond the
/// end of the clip holds its last pose, and the remark says so.
/// @return not_found for an unknown clip; invalid_argument.
[[nodiscard]] Result<PoseArgument> parse_pose(const std::string& text, const Character& character);

/// "; did you mean 'Walk'?" if the text names a clip that the character does not have; otherwise
/// empty.
[[nodiscard]] std::string advice_on_pose(const std::string& text, const Character& character);

}  // namespace sunder::tools
