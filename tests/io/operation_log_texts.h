#pragma once

#include <string>

// Texts of operation logs with one operation.

namespace sunder::test {

inline constexpr const char* kBlades =
    R"([{"base": [0,0,1], "tip": [0,0,0]}, {"base": [0.1,0,1], "tip": [0.1,0,0]}])";

inline std::string log_text_of(const std::string& operations) {
  return R"({"sunder_operations": 1, "operations": [)" + operations + "]}";
}

inline std::string cut_with(const std::string& fields) {
  return log_text_of(R"({"op": "cut", "plane": {"point": [0,0,0], "normal": [0,0,1]}, )" + fields +
                     "}");
}

/// A drill with further fields after its axis.
inline std::string drill_with(const std::string& fields) {
  return log_text_of(R"({"op": "drill", "axis": {"origin": [0,0,0], "direction": [0,0,1]}, )" +
                     fields + "}");
}

/// A tear with further fields before the stroke.
inline std::string tear_with(const std::string& fields) {
  return log_text_of(R"({"op": "tear", )" + fields + R"(, "stroke": )" + kBlades + "}");
}

/// Weights of operations, followed by further fields.
inline std::string weights_with(const std::string& fields) {
  return log_text_of(R"({"op": "weights", "weights": )" + fields + "}");
}

/// A refit with other fields.
inline std::string refit_with(const std::string& fields) {
  return weights_with(R"({"policy": "refit"}, "refit": )" + fields);
}

/// A refit over a joint limit with other fields.
inline std::string limit_with(const std::string& fields) {
  return refit_with(R"({"poses": {"joint_limits": [{)" + fields + "}]}}");
}

}  // namespace sunder::test
