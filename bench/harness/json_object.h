#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sunder::bench {

/// Prints one JSON object, member by member.
class JsonObject {
 public:
  explicit JsonObject(std::FILE* file = stdout) : file_(file) {}
  void add(const char* name, std::optional<double> value);
  void add(const char* name, const std::vector<std::pair<std::string, double>>& values);
  void add_text(const char* name,
                const std::string& text);  ///< The text must not need escapes in JSON.
  void end();

 private:
  void begin(const char* name);
  std::FILE* file_;
  bool is_first_ = true;
};

}  // namespace sunder::bench
