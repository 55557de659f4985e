#include "tools/tear/aimed_option.h"

#include <sunder/io/operation_log.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/messages/json.h"
#include "tools/model/name_at.h"
#include "tools/written_weights/length.h"

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

/// The index of a material, which logs have as an integer; another text as it is.
Json index_json(const std::string& text) {
  std::uint32_t index = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, index);
  return error == std::errc() && rest == end ? Json(index) : Json(text);
}

bool may_be_in_widths(const std::string& key) {
  return key == "length" || key == "depth" || key == "radius";
}

bool is_length(const std::string& key) {
  return may_be_in_widths(key) || key == "width" || key == "wall_depth" || key == "lip_roll" ||
         key == "chord_tolerance";
}

/// The value of a field as the log has it.
Json value_json(const std::string& key, const std::string& text) {
  if (key.ends_with("_material")) return index_json(text);
  if (text == "true" || text == "false") return text == "true";
  if (const auto number = number_in(text)) return *number;
  if (const auto metres = parse_length(text); metres && is_length(key)) return *metres;
  if (text.ends_with('w'))
    if (const auto widths = number_in(std::string_view(text).substr(0, text.size() - 1)))
      return {{"widths", *widths}};
  if (const auto direction = direction_in(text))
    return Json::array({direction->x(), direction->y(), direction->z()});
  return text;
}

/// "0.4" or "40%".
std::optional<double> share_in(std::string_view text) {
  if (!text.ends_with('%')) return number_in(text);
  const std::optional<double> percent = number_in(text.substr(0, text.size() - 1));
  return percent ? std::optional(*percent / 100) : std::nullopt;
}

/// A name and the number behind its last '@'; the whole text if there is none.
std::pair<std::string, std::optional<double>> name_and_number(
    const std::string& text, std::optional<double> (*read)(std::string_view) = number_in) {
  const auto [name, at] = split_name_at(text);
  const std::optional<double> number = at ? read(*at) : std::nullopt;
  return number ? std::pair(name, number) : std::pair(text, number);
}

Result<Json> pose_json(const std::string& text) {
  if (text == "rest" || text == "bind") return Json(text);
  const auto [clip, time] =
      name_and_number(text.ends_with('s') ? text.substr(0, text.size() - 1) : text);
  if (!time || *time < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "--pose: '%.100s' is no pose; expected rest, bind or CLIP@TIME with "
                           "seconds, 0 or more",
                           text.c_str());
  return Json{{"clip", clip}, {"time", *time}};
}

/// Adds a field and its value, "turn=30", to an operation of a log.
Status add_field(const std::string& field, Json& operation) {
  const std::size_t equals = field.find('=');
  const std::string key = field.substr(0, equals);
  if (key == "pose")
    return Status::failure(StatusCode::malformed_file, kNone,
                           "'pose' is no field; give it as --pose");
  if (operation.contains(key))
    return Status::failure(StatusCode::malformed_file, kNone, "'%.60s' is given twice",
                           key.c_str());
  const Json value =
      equals == std::string::npos ? Json(true) : value_json(key, field.substr(equals + 1));
  if (value.is_object() && is_length(key) && !may_be_in_widths(key))
    return Status::failure(StatusCode::malformed_file, kNone,
                           "%s: '%.60s': expected metres; only length, depth and radius may be in "
                           "widths",
                           key.c_str(), field.c_str() + equals + 1);
  operation[key] = value;
  return {};
}

/// Takes `detach` and `parts`, which say what the command does after the cut, out of the operation
/// of the log.
Status read_detaching(Json& operation, TearRequest::Aimed& aimed) {
  if (const auto detach = operation.find("detach"); detach != operation.end()) {
    if (!detach->is_boolean())
      return Status::failure(StatusCode::malformed_file, kNone,
                             "detach: expected no value, true or false");
    aimed.detaches = detach->get<bool>();
    operation.erase(detach);
  }
  if (const auto parts = operation.find("parts"); parts != operation.end()) {
    if (*parts != "all" && *parts != "none")
      return Status::failure(StatusCode::malformed_file, kNone,
                             "parts: expected all or none: the separate parts that come off with "
                             "the limb");
    aimed.takes_props = *parts == "all";
    operation.erase(parts);
  }
  return {};
}

}  // namespace

Result<TearRequest::Aimed> parse_aimed_option(const std::string& kind, const std::string& text,
                                              const std::optional<std::string>& pose) {
  TearRequest::Aimed aimed;
  aimed.option = "--" + kind + " " + text;
  const std::vector<std::string> fields = split(text, ',');
  const auto [bone, share] = name_and_number(fields.front(), share_in);
  Json operation = {{"op", kind}};
  operation[kind == "sever" ? "bone" : "around"] = bone;
  if (share) operation["at"] = *share;
  aimed.has_share = share.has_value();
  for (std::size_t i = 1; i < fields.size(); ++i)
    if (const Status status = add_field(fields[i], operation); !status) return status;
  aimed.has_share |= operation.contains("at");
  if (kind == "sever")
    if (const Status status = read_detaching(operation, aimed); !status) return status;
  if (pose) {
    Result<Json> posed = pose_json(*pose);
    if (!posed) return posed.error();
    operation["pose"] = std::move(*posed);
  }
  const Json log = {{"sunder_operations", 1}, {"operations", Json::array({operation})}};
  auto parsed = parse_aimed_operations(dump_line(log));
  if (parsed) {
    aimed.operation = std::get<AimedOperation>(std::move(parsed->front()));
    return aimed;
  }
  // The place in the log says nothing to whom has written none.
  std::string_view fault = parsed.error().text();
  constexpr std::string_view kPlace = "/operations/0";
  if (fault.starts_with(kPlace)) fault.remove_prefix(kPlace.size());
  if (fault.starts_with("/") || fault.starts_with(":")) fault.remove_prefix(1);
  while (fault.starts_with(' ')) fault.remove_prefix(1);
  return Status::failure(StatusCode::malformed_file, kNone, "%.200s", std::string(fault).c_str());
}

}  // namespace sunder::tools
