#include "tools/model/ceres_program.h"
#include "tools/plan/plan_request.h"

namespace sunder::tools {

ExitCode run_plan(const PlanRequest&) {
  return complain("plan", become_ceres_program("motions are planned"), ExitCode::usage);
}

}  // namespace sunder::tools
