#include "tools/tear/pose_of_run.h"

#include <sunder/skinning/pose.h>

#include "tools/model/history.h"
#include "tools/value_of.h"

namespace sunder::tools {

Result<ModelPose> pose_of_run(const TearRun& run) {
  const std::vector<Operation> history = value_of(run.model.history());
  return make_pose(run.model.source(), history.empty() ? PoseSpec() : last_pose_of(history.back()));
}

}  // namespace sunder::tools
