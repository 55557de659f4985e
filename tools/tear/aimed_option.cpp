#include "tools/tear/aimed_option.h"

#include <sunder/io/operation_log.h>

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/messages/json.h"
#include "tools/model/name_at.h"

namespace sunder::tools {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

/// A value as the log has it.
Json value_json(const std::string& text) {
  if (text == "true" || text == "false") return text == "true";
  if (const auto number = number_in(text)) return *number;
  if (text.ends_with('w'))
    if (const auto widths = number_in(std::string_view(text).substr(0, text.size() - 1)))
      return {{"widths", *widths}};
  const std::vector<std::string> parts = split(text, '/');
  if (parts.size() != 3) return text;
  Json direction = Json::array();
  for (const std::string& part : parts) {
    const auto number = number_in(part);
    if (!number) return text;
    direction.push_back(*number);
  }
  return direction;
}

/// A name and the number behind its last '@'; the whole text if there is none.
std::pair<std::string, std::optional<double>> name_and_number(const std::string& text) {
  const auto [name, at] = split_name_at(text);
  const std::optional<double> number = at ? number_in(*at) : std::nullopt;
  return number ? std::pair(name, number) : std::pair(text, number);
}

Json pose_json(const std::string& text) {
  const auto [clip, time] = name_and_number(text);
  if (!time) return text;  // "rest", "bind", or an error
  return {{"clip", clip}, {"time", *time}};
}

}  // namespace

Result<AimedOperation> parse_aimed_option(const std::string& kind, const std::string& text,
                                          const std::string& pose) {
  const std::vector<std::string> fields = split(text, ',');
  const auto [bone, share] = name_and_number(fields.front());
  Json operation = {{"op", kind}};
  operation[kind == "sever" ? "bone" : "around"] = bone;
  if (share) operation["at"] = *share;
  if (!pose.empty()) operation["pose"] = pose_json(pose);
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const std::size_t equals = fields[i].find('=');
    const std::string key = fields[i].substr(0, equals);
    if (operation.contains(key))
      return Status::failure(StatusCode::malformed_file, kNone, "'%.60s' is given twice",
                             key.c_str());
    operation[key] =
        equals == std::string::npos ? Json(true) : value_json(fields[i].substr(equals + 1));
  }
  const Json log = {{"sunder_operations", 1}, {"operations", Json::array({operation})}};
  auto parsed = parse_aimed_operations(dump_line(log));
  if (parsed) return std::get<AimedOperation>(std::move(parsed->front()));
  // The place in the log says nothing to whom has written none.
  std::string_view fault = parsed.error().text();
  constexpr std::string_view kPlace = "/operations/0";
  if (fault.starts_with(kPlace)) fault.remove_prefix(kPlace.size());
  if (fault.starts_with("/") || fault.starts_with(":")) fault.remove_prefix(1);
  while (fault.starts_with(' ')) fault.remove_prefix(1);
  return Status::failure(StatusCode::malformed_file, kNone, "%.200s", std::string(fault).c_str());
}

}  // namespace sunder::tools
