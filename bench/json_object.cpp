#include "bench/json_object.h"

#include <cstdio>

namespace sunder::bench {

void JsonObject::add(const char* name, std::optional<double> value) {
  begin(name);
  if (value)
    std::printf("%.6g", *value);
  else
    std::printf("null");
}

void JsonObject::add(const char* name, const std::vector<std::pair<std::string, double>>& values) {
  begin(name);
  std::printf("{");
  for (std::size_t i = 0; i < values.size(); ++i)
    std::printf("%s\"%s\": %.6g", i == 0 ? "" : ", ", values[i].first.c_str(), values[i].second);
  std::printf("}");
}

void JsonObject::end() { std::printf("}\n"); }

void JsonObject::begin(const char* name) {
  std::printf("%s\"%s\": ", is_first_ ? "{" : ", ", name);
  is_first_ = false;
}

}  // namespace sunder::bench
