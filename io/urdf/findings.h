#pragma once

#include <sunder/io/robot_file.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace sunder::urdf {

/// Where in the file something was found.
struct Place {
  std::string name;        ///< "joint 'elbow'"; empty: the file.
  std::uint32_t line = 0;  ///< 0: unknown.
};

[[nodiscard]] Place place_of(std::string_view kind, std::string_view name, std::uint32_t line);

/// Collects what is found while a file is read. With `strict`, warnings become errors. Of each code
/// the first hundred are kept; the last of them says how many more there are.
class Findings {
 public:
  explicit Findings(bool strict) : strict_(strict) {}

  /// @param code  one of finding_kinds(), which says how severe it is.
  void add(std::string_view code, const Place& place, std::string text);

  /// ok, or the refusal of the first error: its text, and its line as index.
  [[nodiscard]] Status status() const;

  [[nodiscard]] const std::vector<RobotFinding>& all() const { return all_; }
  /// In the order of the file's lines; findings without a line come first.
  [[nodiscard]] std::vector<RobotFinding> take();

 private:
  struct Count {
    std::size_t added = 0, last = 0;  ///< `last`: in all_.
  };
  bool strict_;
  std::vector<RobotFinding> all_;
  std::map<std::string_view, Count> counts_;
};

}  // namespace sunder::urdf
