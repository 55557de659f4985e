#include <sunder/io/trajectory_file.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <string>

#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

/// The shortest text that is read back as the same number.
void append_number(std::string& text, double number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), end);
}

}  // namespace

Result<std::string> trajectory_csv(const RobotTrajectory& trajectory) {
  const std::size_t width = trajectory.names.size();
  if (trajectory.values.size() != trajectory.times.size() * width)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%zu times and %zu names, but %zu values", trajectory.times.size(),
                           width, trajectory.values.size());
  for (std::size_t i = 0; i < width; ++i)
    if (trajectory.names[i].find_first_of(",\"\r\n") != std::string::npos)
      return Status::failure(StatusCode::invalid_argument, static_cast<std::uint32_t>(i),
                             "name %zu has a comma, a quote or an end of line, which CSV "
                             "trajectories cannot have",
                             i);
  return or_out_of_memory([&]() -> Result<std::string> {
    std::string text = "time";
    for (const std::string& name : trajectory.names) text += ',' + name;
    text += '\n';
    for (std::size_t i = 0; i < trajectory.times.size(); ++i) {
      append_number(text, trajectory.times[i]);
      for (std::size_t k = 0; k < width; ++k) {
        text += ',';
        append_number(text, trajectory.values[i * width + k]);
      }
      text += '\n';
    }
    return text;
  });
}

}  // namespace sunder
