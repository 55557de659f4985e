#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sunder::bench {

/// Prints one JSON object to stdout, member by member.
class JsonObject {
 public:
  void add(const char* name, std::optional<double> value);
  void add(const char* name, const std::vector<std::pair<std::string, double>>& values);
  void end();

 private:
  void begin(const char* name);
  bool is_first_ = true;
};

}  // namespace sunder::bench
