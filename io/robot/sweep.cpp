#include <sunder/robot/trajectory.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/internal/or_throw.h"
#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "io/robot/internal/option_ranges.h"

namespace sunder {
namespace {

/// Radians or metres that a value may change within a step, so that a blade that returns to where
/// it was, after a whole turn, is seen on its way.
constexpr double kMostChange = 0.1;
constexpr std::size_t kMostSteps = 1 << 16;  ///< From one time of the trajectory to the next.
/// Share of the spacing by which a blade has to move to be another one.
constexpr double kStands = 1e-3;
constexpr double kShortest = 1e-9;  ///< Seconds; a step is not halved below.

Status check(const RobotMotion& motion, const MountedBlade& blade, const Affine3d& world_from_root,
             const SweepOptions& options) {
  if (blade.link >= motion.link_count())
    return Status::failure(StatusCode::index_out_of_range, blade.link,
                           "link %u does not exist; the robot has %u", blade.link,
                           motion.link_count());
  if (!blade.base.allFinite() || !blade.tip.allFinite() || !world_from_root.matrix().allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the blade or the place of the robot is not finite");
  if (blade.base == blade.tip)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "base and tip of the blade are at one place");
  if (const Status status = robot::kSpacing.check(options.spacing); !status) return status;
  if (!(options.seconds > 0))  // infinity is the default
    return Status::failure(StatusCode::invalid_argument, kNone, "seconds is %g; it must be above 0",
                           options.seconds);
  if (!(options.first_time <= options.last_time))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the swept part begins at %g s and ends at %g s", options.first_time,
                           options.last_time);
  return {};
}

class Sweep {
 public:
  Sweep(const RobotMotion& motion, const MountedBlade& blade, const Affine3d& world_from_root,
        const SweepOptions& options)
      : motion_(motion),
        mounted_(blade),
        world_from_root_(world_from_root),
        options_(options),
        frames_(motion.link_count()),
        values_(motion.value_count()),
        next_values_(motion.value_count()) {}

  Result<BladeSweep> run() {
    const double first = std::clamp(options_.first_time, motion_.first_time(), motion_.last_time());
    const double last = std::clamp(options_.last_time, motion_.first_time(), motion_.last_time());
    std::vector<double> times = {first};
    for (const double time : motion_.times())
      if (time > first && time < last) times.push_back(time);
    if (last > first) times.push_back(last);
    add({first, at(first)});
    for (std::size_t i = 1; i < times.size(); ++i) {
      const std::size_t steps = steps_between(times[i - 1], times[i]);
      Sample from{times[i - 1], at(times[i - 1])};
      for (std::size_t step = 1; step <= steps; ++step) {
        const double share = static_cast<double>(step) / static_cast<double>(steps);
        const double time =
            step == steps ? times[i] : times[i - 1] + share * (times[i] - times[i - 1]);
        const Sample to{time, at(time)};
        if (!refine(from, to)) return too_many();
        from = to;
      }
    }
    if (sweep_.blades.size() < 2)
      return Status::failure(StatusCode::empty_input, kNone,
                             "the blade moves by less than %g m in the whole motion",
                             kStands * options_.spacing);
    return std::move(sweep_);
  }

 private:
  struct Sample {
    double time;
    Blade blade;
  };

  [[nodiscard]] Status too_many() const {
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "the motion needs more than %u blades %g m apart",
                           options_.maximum_blades, options_.spacing);
  }

  Blade at(double time) {
    // Fails for a wrong size or number only, which create() and check() exclude.
    or_throw(motion_.pose_at(time, frames_, world_from_root_));
    const Affine3d& world_from_link = frames_[mounted_.link];
    return {transform(world_from_link, mounted_.base), transform(world_from_link, mounted_.tip)};
  }

  std::size_t steps_between(double from, double to) {
    or_throw(motion_.values_at(from, values_));
    or_throw(motion_.values_at(to, next_values_));
    double most = 0;
    for (std::size_t v = 0; v < values_.size(); ++v)
      most = std::max(most, std::abs(next_values_[v] - values_[v]));
    return static_cast<std::size_t>(
        std::clamp(std::ceil(most / kMostChange), 1.0, static_cast<double>(kMostSteps)));
  }

  static double moved(const Blade& a, const Blade& b) {
    return std::max(norm(Vec3d(b.base - a.base)), norm(Vec3d(b.tip - a.tip)));
  }

  /// Adds blades after `from` up to `to`. @return false if there are too many.
  bool refine(const Sample& from, const Sample& to) {
    const bool is_near =
        moved(from.blade, to.blade) <= options_.spacing && to.time - from.time <= options_.seconds;
    if (is_near || to.time - from.time < kShortest) return add(to);
    const double time = 0.5 * (from.time + to.time);
    const Sample middle{time, at(time)};
    return refine(from, middle) && refine(middle, to);
  }

  bool add(const Sample& sample) {
    const bool stands = !sweep_.blades.empty() && std::isinf(options_.seconds) &&
                        moved(sweep_.blades.back(), sample.blade) <= kStands * options_.spacing;
    if (stands) return true;
    sweep_.blades.push_back(sample.blade);
    sweep_.times.push_back(sample.time);
    return sweep_.blades.size() <= options_.maximum_blades;
  }

  const RobotMotion& motion_;
  const MountedBlade& mounted_;
  const Affine3d& world_from_root_;
  const SweepOptions& options_;
  std::vector<Affine3d> frames_;
  std::vector<double> values_, next_values_;
  BladeSweep sweep_;
};

}  // namespace

Result<BladeSweep> sweep_blade(const RobotMotion& motion, const MountedBlade& blade,
                               const Affine3d& world_from_root, const SweepOptions& options) {
  if (const Status status = check(motion, blade, world_from_root, options); !status) return status;
  return or_out_of_memory([&] { return Sweep(motion, blade, world_from_root, options).run(); });
}

Result<TearOperation> tear_of_sweep(const BladeSweep& sweep, const PoseSpec& pose, double speed,
                                    const TearOptions& options) {
  if (sweep.blades.size() < 2)
    return Status::failure(StatusCode::empty_input, kNone, "%zu blades; a tear needs two",
                           sweep.blades.size());
  if (sweep.blades.size() != sweep.times.size())
    return Status::failure(StatusCode::size_mismatch, kNone, "%zu blades, %zu times",
                           sweep.blades.size(), sweep.times.size());
  const auto* const clip = std::get_if<ClipPose>(&pose);
  if (const Status status = robot::kClipSpeed.check(speed); !status) return status;
  if (speed > 0 && clip == nullptr)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "clip speed is %g, but the pose is none of a clip", speed);
  return or_out_of_memory([&]() -> Result<TearOperation> {
    TearOperation tear{pose, sweep.blades, {}, options};
    for (std::uint32_t i = 1; i < sweep.times.size() && speed > 0; ++i) {
      ClipPose later = *clip;
      later.time += speed * (sweep.times[i] - sweep.times[0]);
      tear.pose_changes.push_back({i, later});
    }
    return tear;
  });
}

}  // namespace sunder
