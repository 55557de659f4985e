#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <unordered_map>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "pipeline/plan/lip_shares.h"
#include "pipeline/plan/target_path.h"

namespace sunder {
namespace plan {
namespace {

Result<Tension> make_tension(const WoundTarget& target, const PlanTiming& timing,
                             const PlannedMotion& planned, const TornModel& model,
                             std::span<const ChangeRecord> changes) {
  const PlannedGape& gape = *planned.report.gape;
  Tension tension;
  tension.newtons_per_metre = gape.tension;
  if (gape.tension_shares.empty()) return tension;
  const Result<ModelPose> begin = make_pose(model.source(), timing.pose);
  if (!begin) return begin.error();
  const std::shared_ptr<const Character> source(std::shared_ptr<const Character>(),
                                                &model.source());  // the model keeps it
  const Result<TargetPath> path = TargetPath::create(source, target, *begin);
  if (!path) return path.error();
  const Result<ModelPose> pose = pose_at(model.source(), timing, planned.report.cut_ends);
  if (!pose) return pose.error();
  const Result<std::unordered_map<std::uint32_t, double>> lips =
      lip_shares(model, changes, *path, *pose);
  if (!lips) return lips.error();
  tension.shares = shares_of_points(*lips, gape.tension_shares);
  return tension;
}

}  // namespace
}  // namespace plan

Result<Tension> tension_of_gape(const WoundTarget& target, const PlanTiming& timing,
                                const PlannedMotion& planned, const TornModel& model,
                                std::span<const ChangeRecord> changes) {
  if (!planned.report.gape)
    return Status::failure(StatusCode::invalid_argument, kNone, "no gape was planned");
  return or_out_of_memory(
      [&] { return plan::make_tension(target, timing, planned, model, changes); });
}

}  // namespace sunder
