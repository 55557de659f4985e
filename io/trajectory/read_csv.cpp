#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "io/trajectory/read_trajectory.h"

namespace sunder::trajectory {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
    text = text.substr(1, text.size() - 2);
  return text;
}

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string shown(std::string_view text) { return std::string(text.substr(0, 60)); }

class CsvReader {
 public:
  Result<RobotTrajectory> read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      ++line_;
      if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
      if (const Status status = check_columns(line); !status) return status;
      const Status status = has_names_ ? read_row(fields_of(line)) : read_names(fields_of(line));
      if (!status) return status;
    }
    if (!has_names_ || trajectory_.times.empty())
      return Status::failure(StatusCode::empty_input, kNone,
                             "expected a line of names and a line of numbers at least");
    return std::move(trajectory_);
  }

 private:
  /// Checks the number of columns before a list of them takes memory.
  Status check_columns(std::string_view line) const {
    const auto columns = 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (has_names_ && columns != trajectory_.names.size() + 1)
      return Status::failure(StatusCode::malformed_file, line_,
                             "line %u has %zu columns, the names have %zu", line_, columns,
                             trajectory_.names.size() + 1);
    if (columns > kMaximumNames)
      return Status::failure(StatusCode::limit_exceeded, line_,
                             "line %u: %zu columns; the limit is %zu", line_, columns,
                             kMaximumNames);
    return {};
  }

  Status read_names(const std::vector<std::string_view>& fields) {
    if (fields[0] != "time")
      return Status::failure(StatusCode::malformed_file, line_,
                             "line %u, column 1: '%s'; expected the name 'time'", line_,
                             shown(fields[0]).c_str());
    for (std::size_t column = 1; column < fields.size(); ++column) {
      if (fields[column].empty())
        return Status::failure(StatusCode::malformed_file, line_, "line %u, column %zu has no name",
                               line_, column + 1);
      const auto before = std::find(fields.begin(), fields.begin() + column, fields[column]);
      if (before != fields.begin() + column)
        return Status::failure(
            StatusCode::malformed_file, line_, "line %u: columns %td and %zu are both named '%s'",
            line_, before - fields.begin() + 1, column + 1, shown(fields[column]).c_str());
      trajectory_.names.emplace_back(fields[column]);
    }
    has_names_ = true;
    return {};
  }

  Status read_row(const std::vector<std::string_view>& fields) {
    for (std::size_t column = 0; column < fields.size(); ++column) {
      const std::string_view field = fields[column];
      double number = 0;
      const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
      const std::string name = column == 0 ? "time" : shown(trajectory_.names[column - 1]);
      if (error != std::errc() || end != field.data() + field.size())
        return Status::failure(StatusCode::malformed_file, line_,
                               "line %u, column %zu ('%s'): '%s' is not a number", line_,
                               column + 1, name.c_str(), shown(field).c_str());
      if (!std::isfinite(number))
        return Status::failure(StatusCode::non_finite_value, line_,
                               "line %u, column %zu ('%s'): '%s' is not finite", line_, column + 1,
                               name.c_str(), shown(field).c_str());
      if (column > 0)
        trajectory_.values.push_back(number);
      else if (const Status status = add_time(number); !status)
        return status;
    }
    return {};
  }

  Status add_time(double time) {
    if (!trajectory_.times.empty() && time <= trajectory_.times.back())
      return Status::failure(StatusCode::invalid_argument, line_,
                             "line %u, column 1 ('time'): %g s does not come after %g s", line_,
                             time, trajectory_.times.back());
    trajectory_.times.push_back(time);
    return {};
  }

  RobotTrajectory trajectory_;
  std::uint32_t line_ = 0;
  bool has_names_ = false;
};

}  // namespace

Result<RobotTrajectory> read_csv(std::string_view text) {
  if (text.size() > kMaximumBytes)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "a trajectory of %zu bytes; the limit is %zu", text.size(),
                           kMaximumBytes);
  return CsvReader().read(text);
}

}  // namespace sunder::trajectory
