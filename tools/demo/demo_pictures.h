#pragma once

#include <sunder/operation/operation.h>
#include <sunder/tear/torn_model.h>

#include <filesystem>
#include <memory>

#include "tools/budget/budget.h"
#include "tools/messages/progress_bar.h"
#include "tools/model/posed_model.h"
#include "tools/picture/model_looks.h"
#include "tools/picture/view.h"

namespace sunder::tools {

constexpr double kTearFraction = 0.40;  ///< Time of the tear, as a fraction of the first clip.
constexpr std::size_t kDemoSteps = 30;  ///< Of draw_demo(), for a progress bar.
constexpr const char* kDemoPictures[] = {"motion", "before", "torn", "wound", "later_1", "later_2"};

/// The pose of a character at a fraction of its first clip; the rest pose if it has none.
[[nodiscard]] PoseSpec pose_at(const Character& character, double fraction);

/// The model and the tear of the demo, and the view.
struct DemoTear {
  std::shared_ptr<const Character> source;
  TornModel model;
  TearOperation operation;
  ViewFrame frame;
};

/// Draws the moment before the tear, the tear, the wound from near, and two later moments of the
/// clip; and motion.png, an animated PNG of the character that is torn while it moves. Lips open
/// like those of soft tissue. Takes five to twelve seconds of processor time.
/// @param budget    not ended while files are written.
/// @param progress  begins kDemoSteps steps, from `first_step` on.
[[nodiscard]] Status draw_demo(const DemoTear& tear, const ModelLooks& looks,
                               const std::filesystem::path& folder, Budget& budget,
                               std::size_t first_step, ProgressBar& progress);

}  // namespace sunder::tools
