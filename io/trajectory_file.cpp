#include <sunder/io/trajectory_file.h>

#include <exception>
#include <new>
#include <string>

#include "io/internal/read_input.h"
#include "io/operation_log/place.h"
#include "io/trajectory/read_trajectory.h"

namespace sunder {
namespace {

/// Runs a reader. @return its result, or the Status of what it throws.
template <class Read>
Result<RobotTrajectory> without_exceptions(const Read& read) {
  try {
    return read();
  } catch (const operation_log::Fault& fault) {
    return fault.status;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "out of memory while reading the trajectory");
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "trajectory: %s", error.what());
  }
}

}  // namespace

Result<RobotTrajectory> parse_trajectory_csv(std::string_view text) {
  return without_exceptions([&] { return trajectory::read_csv(text); });
}

Result<RobotTrajectory> parse_trajectory_json(std::string_view text) {
  return without_exceptions(
      [&]() -> Result<RobotTrajectory> { return trajectory::read_json(text); });
}

Result<RobotTrajectory> load_trajectory(const std::filesystem::path& file) {
  return without_exceptions([&]() -> Result<RobotTrajectory> {
    const std::string extension = file.extension().string();
    if (extension != ".csv" && extension != ".json")
      return Status::failure(StatusCode::unsupported_format, kNone,
                             "'%.20s' is no format of trajectories; expected .csv or .json",
                             extension.c_str());
    const Result<std::string> text = read_input(file, trajectory::kMaximumBytes);
    if (!text) return text.error();
    return extension == ".csv" ? parse_trajectory_csv(*text) : parse_trajectory_json(*text);
  });
}

}  // namespace sunder
