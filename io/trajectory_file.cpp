#include <sunder/io/trajectory_file.h>

#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

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

Result<std::string> read_text(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    return Status::failure(StatusCode::file_not_found, kNone, "there is no such file");
  std::ifstream stream(file, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  const Status unreadable =
      Status::failure(StatusCode::file_unreadable, kNone, "this file cannot be read");
  if (status.type() != std::filesystem::file_type::regular || error || !stream) return unreadable;
  if (size > trajectory::kMaximumBytes)
    return Status::failure(StatusCode::limit_exceeded, kNone, "%ju bytes; the limit is %zu", size,
                           trajectory::kMaximumBytes);
  std::string text(static_cast<std::size_t>(size), '\0');
  if (!stream.read(text.data(), static_cast<std::streamsize>(size))) return unreadable;
  return text;
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
    const Result<std::string> text = read_text(file);
    if (!text) return text.error();
    return extension == ".csv" ? parse_trajectory_csv(*text) : parse_trajectory_json(*text);
  });
}

}  // namespace sunder
