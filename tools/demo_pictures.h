#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/torn_model.h>

#include <filesystem>
#include <memory>

#include "tools/posed_model.h"
#include "tools/progress_bar.h"
#include "tools/view.h"

namespace sunder::tools {

constexpr double kTearFraction = 0.40;    ///< When in the first clip the demo tears.
constexpr std::size_t kDemoPictures = 4;  ///< How many pictures the demo takes.

/// The pose of a character at a part of its first clip; at rest where it has none.
[[nodiscard]] PoseSpec pose_at(const Character& character, double fraction);

/// What the demo tore, and from where it is seen.
struct DemoTear {
  std::shared_ptr<const Character> source;
  TornModel model;
  TearOperation operation;
  ViewFrame frame;
  Bounds bounds;  ///< At the moment of the tear.
};

/// Draws the moment before the tear, the tear, and two later moments of the clip. Lips open as
/// those of soft tissue do.
/// @param progress  its steps from `first_step` on are begun, one per picture.
[[nodiscard]] Status draw_demo(const DemoTear& tear, const std::filesystem::path& folder,
                               std::size_t first_step, ProgressBar& progress);

}  // namespace sunder::tools
