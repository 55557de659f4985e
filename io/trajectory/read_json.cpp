#include <string>

#include "io/internal/strict_json.h"
#include "io/operation_log/place.h"
#include "io/trajectory/read_trajectory.h"

namespace sunder::trajectory {
namespace {

using operation_log::Place;

constexpr operation_log::NumberIn kSampleTime = {{.field = "time",
                                                  .least = -operation_log::kLargest,
                                                  .most = operation_log::kLargest,
                                                  .unit = " s"}};

void read_names(const Place& place, RobotTrajectory& trajectory) {
  const auto& names = operation_log::read_array(place, "an array of names");
  if (names.size() > kMaximumNames)
    place.fail(StatusCode::limit_exceeded, std::to_string(names.size()) + " names; the limit is " +
                                               std::to_string(kMaximumNames));
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string name = operation_log::read_name(place.at(i));
    for (const std::string& other : trajectory.names)
      if (other == name) place.at(i).malformed("'" + name + "' occurs twice");
    trajectory.names.push_back(std::move(name));
  }
}

void read_sample(const Place& place, RobotTrajectory& trajectory) {
  place.check_fields({"time", "values"});
  const double time = kSampleTime(place.at("time"));
  if (!trajectory.times.empty() && time <= trajectory.times.back())
    place.at("time").fail(StatusCode::invalid_argument,
                          "does not come after the time of the sample before");
  trajectory.times.push_back(time);
  std::vector<double> values(trajectory.names.size());
  operation_log::read_numbers(place.at("values"), values);
  trajectory.values.insert(trajectory.values.end(), values.begin(), values.end());
}

}  // namespace

RobotTrajectory read_json(std::string_view text) {
  const Result<StrictJson> json = parse_strict_json(text);
  if (!json) throw operation_log::Fault{json.error()};
  const Place root{*json, ""};
  root.check_fields({"names", "samples"});
  RobotTrajectory trajectory;
  read_names(root.at("names"), trajectory);
  const Place samples = root.at("samples");
  const std::size_t count = operation_log::read_array(samples, "an array of samples").size();
  if (count == 0) samples.fail(StatusCode::empty_input, "is empty");
  for (std::size_t i = 0; i < count; ++i) read_sample(samples.at(i), trajectory);
  return trajectory;
}

}  // namespace sunder::trajectory
