#pragma once

#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// The pose of the last operation that was not undone, or rest.
[[nodiscard]] Result<ModelPose> pose_of_run(const TearRun& run);

}  // namespace sunder::tools
