#include "bench/harness/json_object.h"

#include <cmath>

namespace sunder::bench {
namespace {

/// Counts are printed with all digits. JSON has no infinity.
void print(std::FILE* file, double value) {
  if (!std::isfinite(value)) {
    std::fprintf(file, "null");
    return;
  }
  const bool is_count = value == std::floor(value) && std::abs(value) < 1e15;
  std::fprintf(file, is_count ? "%.0f" : "%.6g", value);
}

}  // namespace

void JsonObject::add(const char* name, std::optional<double> value) {
  begin(name);
  if (value)
    print(file_, *value);
  else
    std::fprintf(file_, "null");
}

void JsonObject::add(const char* name, const std::vector<std::pair<std::string, double>>& values) {
  begin(name);
  std::fprintf(file_, "{");
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::fprintf(file_, "%s\"%s\": ", i == 0 ? "" : ", ", values[i].first.c_str());
    print(file_, values[i].second);
  }
  std::fprintf(file_, "}");
}

void JsonObject::add_text(const char* name, const std::string& text) {
  begin(name);
  std::fprintf(file_, "\"%s\"", text.c_str());
}

void JsonObject::end() { std::fprintf(file_, "}\n"); }

void JsonObject::begin(const char* name) {
  std::fprintf(file_, "%s\"%s\": ", is_first_ ? "{" : ", ", name);
  is_first_ = false;
}

}  // namespace sunder::bench
