#include <sunder/plan/plan.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "pipeline/plan/check_inputs.h"
#include "pipeline/plan/choose_tracks.h"
#include "pipeline/plan/clearance.h"
#include "pipeline/plan/plan_setup.h"
#include "pipeline/plan/target_path.h"

namespace sunder {
namespace plan {
namespace {

constexpr int kShells = 24, kDirections = 42;
constexpr int kMostPlans = 16, kHalves = 4;
constexpr std::uint32_t kTries = 24;    ///< Random starts per place of the curve.
constexpr std::uint32_t kSamples = 96;  ///< Of the motion, for the search.
constexpr double kShares[] = {0.5, 0.0, 1.0, 0.25, 0.75};

/// Length of the arm when it is stretched, at least.
double reach_of(const Robot& robot) {
  double reach = 0;
  for (const RobotJoint& joint : robot.joints) {
    reach += joint.parent_from_joint.translation().norm();
    if (joint.type != RobotJointType::prismatic) continue;
    const double slide = std::max(std::abs(joint.lower), std::abs(joint.upper));
    if (std::isfinite(slide)) reach += slide;
  }
  return reach;
}

/// Evenly on the unit sphere: the golden spiral (Saff and Kuijlaars 1997).
Vec3d direction_of(int i) {
  const double y = 1 - (2.0 * i + 1) / kDirections;
  const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const double radius = std::sqrt(1 - y * y);
  return {radius * std::cos(turn), y, radius * std::sin(turn)};
}

class BaseSearch {
 public:
  BaseSearch(const std::shared_ptr<const Character>& character, const WoundTarget& target,
             const PlanTiming& timing, const PlanTool& tool, const PlanOptions& options)
      : character_(character), target_(target), timing_(timing), tool_(tool), options_(options) {}

  Result<std::optional<PlannedBase>> run() {
    if (const Status status = prepare(); !status) return status;
    double nearest = 0;
    for (int shell = 1; shell <= kShells && plans_ < kMostPlans; ++shell) {
      const double radius = farthest_ * shell / kShells;
      for (int i = 0; i < kDirections && plans_ < kMostPlans; ++i) {
        const Vec3d moved = radius * direction_of(i);
        Result<std::optional<PlannedBase>> found = plan_from(moved);
        if (!found) return found;
        if (*found) return nearer(std::move(**found), nearest / radius);
      }
      nearest = radius;
    }
    return std::optional<PlannedBase>();
  }

 private:
  Status prepare() {
    Result<PlanSetup> setup = PlanSetup::create(character_, target_, timing_, tool_, options_);
    if (!setup) return setup.error();
    setup_.emplace(std::move(*setup));
    Result<std::vector<TargetSample>> samples =
        sample_target(*character_, setup_->path, timing_, kSamples);
    if (!samples) return samples.error();
    samples_ = std::move(*samples);
    Result<Clearance> clearance = Clearance::create(*character_, tool_, timing_, samples_);
    if (!clearance) return clearance.error();
    clearance_ = std::move(*clearance);
    const Vec3d middle = samples_[samples_.size() / 2].place;
    from_curve_ = tool_.world_from_root.translation() - middle;
    reach_ = reach_of(tool_.robot) + setup_->chain.blade_length() + tool_.blade.base.norm();
    farthest_ = from_curve_.norm() + reach_;
    return {};
  }

  /// The instant of the cut that is nearest to a share of the curve.
  [[nodiscard]] std::size_t instant_at(double share) const {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < clearance_->instants(); ++i) {
      const TargetSample& sample = samples_[clearance_->sample_of(i)];
      if (sample.depth <= 0 || std::abs(sample.share - share) >= least) continue;
      least = std::abs(sample.share - share);
      nearest = i;
    }
    return nearest;
  }

  /// Whether the arm reaches some places of the curve from there.
  bool is_promising(const Vec3d& moved) {
    if ((from_curve_ + moved).norm() > reach_) return false;
    BladeChain chain = setup_->chain;
    chain.move_root(moved);
    const TrackSearch search{samples_,           setup_->scales,    setup_->limits, *clearance_,
                             options_.clearance, setup_->tolerance, options_.seeds};
    return std::all_of(std::begin(kShares), std::end(kShares), [&](double share) {
      return has_free_values(chain, search, instant_at(share), kTries);
    });
  }

  Result<std::optional<PlannedBase>> plan_from(const Vec3d& moved) {
    std::optional<PlannedBase> found;
    if (!is_promising(moved)) return found;
    ++plans_;
    PlanTool tool = tool_;
    tool.world_from_root.translation() += moved;
    Result<PlannedMotion> planned = plan_motion(character_, target_, timing_, tool, options_);
    if (!planned) return planned.error();
    if (planned->report.is_reachable) found = PlannedBase{moved, std::move(*planned)};
    return found;
  }

  /// The nearest one that is found by halves between a share of the way and its end.
  Result<std::optional<PlannedBase>> nearer(PlannedBase best, double low) {
    const Vec3d end = best.moved;
    double high = 1;
    for (int i = 0; i < kHalves; ++i) {
      const double share = 0.5 * (low + high);
      Result<std::optional<PlannedBase>> found = plan_from(share * end);
      if (!found) return found;
      (*found ? high : low) = share;
      if (*found) best = std::move(**found);
    }
    return std::optional<PlannedBase>(std::move(best));
  }

  const std::shared_ptr<const Character>& character_;
  const WoundTarget& target_;
  const PlanTiming& timing_;
  const PlanTool& tool_;
  const PlanOptions& options_;
  std::optional<PlanSetup> setup_;
  std::vector<TargetSample> samples_;
  std::optional<Clearance> clearance_;
  Vec3d from_curve_ = Vec3d::Zero();  ///< To the root.
  double reach_ = 0, farthest_ = 0;   ///< Metres.
  int plans_ = 0;
};

}  // namespace
}  // namespace plan

Result<std::optional<PlannedBase>> find_base(const std::shared_ptr<const Character>& character,
                                             const WoundTarget& target, const PlanTiming& timing,
                                             const PlanTool& tool, const PlanOptions& options) {
  if (character == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  if (const Status status = plan::check_timing(timing, options); !status) return status;
  return or_out_of_memory([&]() -> Result<std::optional<PlannedBase>> {
    if (const Status status = validate_character(*character); !status) return status;
    return plan::BaseSearch(character, target, timing, tool, options).run();
  });
}

}  // namespace sunder
