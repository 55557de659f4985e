#include <sunder/robot/trajectory.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "core/internal/nearest_names.h"
#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

Status check_times(const RobotTrajectory& trajectory) {
  const std::size_t count = trajectory.times.size();
  if (count == 0)
    return Status::failure(StatusCode::empty_input, kNone, "the trajectory has no time");
  if (trajectory.values.size() != count * trajectory.names.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the trajectory has %zu values, expected %zu times x %zu names",
                           trajectory.values.size(), count, trajectory.names.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!std::isfinite(trajectory.times[i]))
      return Status::failure(StatusCode::non_finite_value, i, "time %u is not finite", i);
    if (i > 0 && trajectory.times[i] <= trajectory.times[i - 1])
      return Status::failure(StatusCode::invalid_argument, i,
                             "time %u, %g s, does not come after the one before, %g s", i,
                             trajectory.times[i], trajectory.times[i - 1]);
    for (std::size_t n = 0; n < trajectory.names.size(); ++n)
      if (!std::isfinite(trajectory.values[i * trajectory.names.size() + n]))
        return Status::failure(StatusCode::non_finite_value, i,
                               "at time %u, %g s, the value of '%.80s' is not finite", i,
                               trajectory.times[i], trajectory.names[n].c_str());
  }
  return {};
}

Status unknown_name(const Robot& robot, std::uint32_t index, const std::string& name) {
  std::vector<std::string> names;
  for (const RobotValue& value : robot.values) names.push_back(value.name);
  const std::string near = listed_names(nearest_names(name, names));
  const std::uint32_t joint = find_joint(robot, name);
  const char* const why = joint == kNone ? "the robot has no joint of that name"
                          : robot.joints[joint].mimicked_joint != kNone
                              ? "this joint mimics another one"
                              : "this joint has no value, or several";
  return Status::failure(StatusCode::not_found, index, "'%.60s': %s%s%s%s", name.c_str(), why,
                         near.empty() ? "" : "; did you mean ", near.c_str(),
                         near.empty() ? "" : "?");
}

/// Per name of a trajectory: its value of the robot.
Result<std::vector<std::uint32_t>> find_values(const Robot& robot,
                                               const std::vector<std::string>& names) {
  std::vector<std::uint32_t> values;
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    const std::uint32_t value = find_value(robot, names[i]);
    if (value == kNone) return unknown_name(robot, i, names[i]);
    if (std::ranges::find(values, value) != values.end())
      return Status::failure(StatusCode::invalid_argument, i, "'%.80s' occurs twice",
                             names[i].c_str());
    values.push_back(value);
  }
  return values;
}

/// How far a number is outside of a value's limits.
double outside(const RobotValue& value, double number) {
  return std::max({0.0, value.lower - number, number - value.upper});
}

}  // namespace

struct RobotMotion::State {
  RobotKinematics kinematics;
  std::vector<double> times;
  std::vector<double> values;  ///< times x values of the robot.
  std::uint32_t value_count = 0;
  std::vector<LimitExcess> excesses;

  /// Lists the values that leave their limits, which they do most at one of the times, and clamps
  /// them if that is wanted.
  void check_limits(const Robot& robot, bool clamps);
};

void RobotMotion::State::check_limits(const Robot& robot, bool clamps) {
  constexpr double kTolerance = 1e-9;
  for (std::uint32_t v = 0; v < value_count; ++v) {
    const RobotValue& value = robot.values[v];
    LimitExcess worst{v, 0.0, 0.0};
    double most = kTolerance;
    for (std::size_t i = 0; i < times.size(); ++i) {
      double& number = values[i * value_count + v];
      if (outside(value, number) > most) {
        most = outside(value, number);
        worst = {v, times[i], number};
      }
      if (clamps) number = std::clamp(number, value.lower, value.upper);
    }
    if (most > kTolerance) excesses.push_back(worst);
  }
}

RobotMotion::RobotMotion(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Result<RobotMotion> RobotMotion::create(const Robot& robot, const RobotTrajectory& trajectory,
                                        const RobotMotionOptions& options) {
  return or_out_of_memory([&]() -> Result<RobotMotion> {
    Result<RobotKinematics> kinematics = RobotKinematics::create(robot);
    if (!kinematics) return kinematics.error();
    if (const Status status = check_times(trajectory); !status) return status;
    const Result<std::vector<std::uint32_t>> found = find_values(robot, trajectory.names);
    if (!found) return found.error();
    auto state =
        std::make_shared<State>(State{std::move(*kinematics), trajectory.times, {}, 0, {}});
    const std::vector<double> rest = rest_values(robot);
    if (rest.size() != robot.values.size()) throw std::bad_alloc();
    state->value_count = static_cast<std::uint32_t>(rest.size());
    for (std::size_t i = 0; i < trajectory.times.size(); ++i) {
      std::vector<double> row = rest;
      for (std::size_t n = 0; n < found->size(); ++n)
        row[(*found)[n]] = trajectory.values[i * found->size() + n];
      state->values.insert(state->values.end(), row.begin(), row.end());
    }
    state->check_limits(robot, options.clamps_to_limits);
    return RobotMotion(std::move(state));
  });
}

double RobotMotion::first_time() const { return state_->times.front(); }
double RobotMotion::last_time() const { return state_->times.back(); }
std::span<const double> RobotMotion::times() const { return state_->times; }
std::uint32_t RobotMotion::link_count() const { return state_->kinematics.link_count(); }
std::uint32_t RobotMotion::value_count() const { return state_->value_count; }
std::span<const LimitExcess> RobotMotion::excesses() const { return state_->excesses; }

Status RobotMotion::values_at(double time, std::span<double> values) const {
  const std::vector<double>& times = state_->times;
  const std::size_t count = state_->value_count;
  if (values.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone, "%zu values, the robot has %zu",
                           values.size(), count);
  if (!std::isfinite(time))
    return Status::failure(StatusCode::non_finite_value, kNone, "the time is not finite");
  const auto after = std::ranges::upper_bound(times, time);
  const std::size_t next = std::min<std::size_t>(after - times.begin(), times.size() - 1);
  const std::size_t previous = after == times.begin() || after == times.end() ? next : next - 1;
  const double share =
      previous == next ? 0.0 : (time - times[previous]) / (times[next] - times[previous]);
  for (std::size_t v = 0; v < count; ++v) {
    const double from = state_->values[previous * count + v], to = state_->values[next * count + v];
    values[v] = from + share * (to - from);
  }
  return {};
}

Status RobotMotion::pose_at(double time, std::span<Affine3d> model_from_link,
                            const Affine3d& model_from_root) const {
  return or_out_of_memory([&]() -> Status {
    std::vector<double> values(state_->value_count);
    if (const Status status = values_at(time, values); !status) return status;
    return state_->kinematics.evaluate(values, model_from_link, model_from_root);
  });
}

}  // namespace sunder
