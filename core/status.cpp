#include <sunder/core/status.h>

#include <cstdarg>
#include <cstdio>

namespace sunder {

std::string_view status_name(StatusCode code) {
  switch (code) {
    case StatusCode::ok: return "ok";
    case StatusCode::empty_input: return "empty_input";
    case StatusCode::size_mismatch: return "size_mismatch";
    case StatusCode::index_out_of_range: return "index_out_of_range";
    case StatusCode::non_finite_value: return "non_finite_value";
    case StatusCode::weights_not_normalized: return "weights_not_normalized";
    case StatusCode::not_a_tree: return "not_a_tree";
    case StatusCode::invalid_argument: return "invalid_argument";
    case StatusCode::not_found: return "not_found";
    case StatusCode::file_not_found: return "file_not_found";
    case StatusCode::file_unreadable: return "file_unreadable";
    case StatusCode::path_not_allowed: return "path_not_allowed";
    case StatusCode::unsupported_format: return "unsupported_format";
    case StatusCode::unsupported_feature: return "unsupported_feature";
    case StatusCode::malformed_file: return "malformed_file";
    case StatusCode::limit_exceeded: return "limit_exceeded";
    case StatusCode::capacity_exceeded: return "capacity_exceeded";
    case StatusCode::internal_error: return "internal_error";
  }
  return "unknown";
}

Status Status::failure(StatusCode code, std::uint32_t index, const char* format, ...) {
  Status status;
  status.code_ = code;
  status.index_ = index;
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(status.text_, sizeof status.text_, format, arguments);
  va_end(arguments);
  return status;
}

}  // namespace sunder
