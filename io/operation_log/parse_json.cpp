#include "io/operation_log/parse_json.h"

#include <algorithm>
#include <set>
#include <vector>

namespace sunder::operation_log {
namespace {

constexpr std::size_t kMaximumDepth = 32;  ///< The format itself needs 9.

/// Refuses, while parsing, faults that are not visible in the parsed tree: nesting and repeated
/// fields.
class ParseGuard {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& value) {
    if (static_cast<std::size_t>(depth) > kMaximumDepth)
      throw Fault{Status::failure(StatusCode::limit_exceeded, kNone,
                                  "values are nested deeper than %zu", kMaximumDepth)};
    if (event == Json::parse_event_t::object_start) fields_.emplace_back();
    if (event == Json::parse_event_t::object_end) fields_.pop_back();
    if (event == Json::parse_event_t::key &&
        !fields_.back().insert(value.get<std::string>()).second)
      throw Fault{Status::failure(StatusCode::malformed_file, kNone,
                                  "field '%s' occurs twice in one object",
                                  value.get<std::string>().c_str())};
    return true;
  }

 private:
  std::vector<std::set<std::string>> fields_;  ///< Keys of the enclosing objects, outermost first.
};

}  // namespace

Json parse_json(std::string_view text) {
  if (text.size() > kMaximumBytes)
    throw Fault{Status::failure(StatusCode::limit_exceeded, kNone,
                                "operation log of %zu bytes; the limit is %zu", text.size(),
                                kMaximumBytes)};
  ParseGuard guard;
  try {
    return Json::parse(text, [&](int depth, Json::parse_event_t event, const Json& value) {
      return guard(depth, event, value);
    });
  } catch (const Json::parse_error& error) {
    const std::size_t offset = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
    const auto line =
        1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
    throw Fault{Status::failure(StatusCode::malformed_file, kNone,
                                "invalid JSON: line %td, byte %zu: %s", line, offset,
                                error.what())};
  } catch (const Json::exception& error) {  // Numbers that do not fit into a double.
    throw Fault{
        Status::failure(StatusCode::malformed_file, kNone, "invalid JSON: %s", error.what())};
  }
}

}  // namespace sunder::operation_log
