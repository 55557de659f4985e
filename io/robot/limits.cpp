#include <sunder/robot/robot.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace sunder {
namespace {

template <class Entry>
std::uint32_t index_of(const std::vector<Entry>& entries, std::string_view name) {
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (entries[i].name == name) return static_cast<std::uint32_t>(i);
  return kNone;
}

Status check_count(const Robot& robot, std::size_t given) {
  if (given == robot.values.size()) return {};
  return Status::failure(StatusCode::size_mismatch, kNone,
                         "the robot has %zu values; given are %zu", robot.values.size(), given);
}

}  // namespace

std::uint32_t find_link(const Robot& robot, std::string_view name) {
  return index_of(robot.links, name);
}

std::uint32_t find_joint(const Robot& robot, std::string_view name) {
  return index_of(robot.joints, name);
}

std::uint32_t find_value(const Robot& robot, std::string_view name) {
  return index_of(robot.values, name);
}

std::vector<double> rest_values(const Robot& robot) try {
  std::vector<double> values;
  values.reserve(robot.values.size());
  for (const RobotValue& value : robot.values) values.push_back(value.rest);
  return values;
} catch (const std::bad_alloc&) {
  return {};
}

Result<std::uint32_t> clamp_to_limits(const Robot& robot, std::span<double> values) {
  if (const Status status = check_count(robot, values.size()); !status) return status;
  std::uint32_t changed = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const RobotValue& of = robot.values[i];
    if (!(values[i] < of.lower || values[i] > of.upper)) continue;
    values[i] = values[i] < of.lower ? of.lower : of.upper;
    ++changed;
  }
  return changed;
}

Status check_limits(const Robot& robot, std::span<const double> values, double tolerance) {
  if (const Status status = check_count(robot, values.size()); !status) return status;
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    const RobotValue& of = robot.values[i];
    if (!std::isfinite(values[i]))
      return Status::failure(StatusCode::non_finite_value, i, "value '%.80s' is not finite",
                             of.name.c_str());
    if (values[i] < of.lower - tolerance || values[i] > of.upper + tolerance)
      return Status::failure(StatusCode::invalid_argument, i,
                             "value '%.80s' is %g; its limits are %g and %g", of.name.c_str(),
                             values[i], of.lower, of.upper);
  }
  return {};
}

}  // namespace sunder
