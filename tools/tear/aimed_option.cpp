#include "tools/tear/aimed_option.h"

#include <sunder/io/operation_log.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/operation/internal/names.h"
#include "tools/messages/json.h"
#include "tools/model/name_at.h"
#include "tools/tear/aimed_fields.h"

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

/// The index of a material, which logs have as an integer; its name as it is.
Json index_json(const std::string& text) {
  std::uint32_t index = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, index);
  return error == std::errc() && rest == end ? Json(index) : Json(text);
}

/// "0.4w" or "40%": widths of the limb.
std::optional<double> widths_in(std::string_view text) {
  if (text.ends_with('%')) return quantity_in(text, Quantity::share);
  return text.ends_with('w') ? number_in(text.substr(0, text.size() - 1)) : std::nullopt;
}

/// The value of a field as the log has it.
Json value_json(const AimedField& field, const std::string& text) {
  if (field.is_material) return index_json(text);
  if (text == "true" || text == "false") return text == "true";
  if (const auto number = quantity_in(text, field.quantity)) return *number;
  if (field.takes_widths)
    if (const auto widths = widths_in(text)) return {{"widths", *widths}};
  if (const auto direction = direction_in(text))
    return Json::array({direction->x(), direction->y(), direction->z()});
  return text;
}

std::optional<double> share_in(std::string_view text) { return quantity_in(text, Quantity::share); }

std::optional<double> time_in(std::string_view text) { return quantity_in(text, Quantity::time); }

/// A name and the number behind its last '@'; the whole text if there is none.
std::pair<std::string, std::optional<double>> name_and_number(
    const std::string& text, std::optional<double> (*read)(std::string_view)) {
  const auto [name, at] = split_name_at(text);
  const std::optional<double> number = at ? read(*at) : std::nullopt;
  return number ? std::pair(name, number) : std::pair(text, number);
}

Result<Json> pose_json(const std::string& text) {
  if (text == kPoseName<RestPose> || text == kPoseName<BindPose>) return Json(text);
  const auto [clip, time] = name_and_number(text, time_in);
  if (!time || *time < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "--pose: '%.100s' is no pose; expected rest, bind or CLIP@TIME with "
                           "seconds, 0 or more",
                           text.c_str());
  return Json{{"clip", clip}, {"time", *time}};
}

/// Adds a field and its value, "turn=30", to an operation of a log.
/// @param material  becomes the name of a material, if the field has one.
Status add_field(const AimedFields& fields, const std::string& text, Json& operation,
                 std::string& material) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  if (key == "pose")
    return Status::failure(StatusCode::malformed_file, kNone,
                           "'pose' is no field; give it as --pose");
  if (operation.contains(key))
    return Status::failure(StatusCode::malformed_file, kNone, "'%.60s' is given twice",
                           key.c_str());
  const AimedField* const known = fields.find(key);
  const AimedField field = known != nullptr ? *known : AimedField{key.c_str()};
  const Json value =
      equals == std::string::npos ? Json(true) : value_json(field, text.substr(equals + 1));
  if (field.is_material && value.is_string()) {
    // A name is looked up when the model is loaded; an index in its place checks that the
    // operation has the field.
    material = value.get<std::string>();
    operation[key] = 0;
    return {};
  }
  if (field.quantity != Quantity::number && value.is_string())
    return Status::failure(StatusCode::malformed_file, kNone,
                           "%.40s: '%.60s' is no number; expected one%s%s", key.c_str(),
                           text.c_str() + equals + 1, units_of(field.quantity),
                           field.takes_widths ? ", or widths of the limb: 0.4w, 40%" : "");
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

/// The operation of a log with this one.
Result<LoggedOperation> parse_one(const Json& operation) {
  const Json log = {{"sunder_operations", 1}, {"operations", Json::array({operation})}};
  auto parsed = parse_aimed_operations(dump_line(log));
  if (parsed) return std::move(parsed->front());
  // The place in the log says nothing to whom has written none.
  std::string_view fault = parsed.error().text();
  constexpr std::string_view kPlace = "/operations/0";
  if (fault.starts_with(kPlace)) fault.remove_prefix(kPlace.size());
  if (fault.starts_with("/") || fault.starts_with(":")) fault.remove_prefix(1);
  while (fault.starts_with(' ')) fault.remove_prefix(1);
  // "depth: depth is -1 m": the text of a range names its field.
  if (const std::size_t colon = fault.find(": "); colon != std::string_view::npos)
    if (fault.substr(colon + 2).starts_with(std::string(fault.substr(0, colon)) + " is "))
      fault.remove_prefix(colon + 2);
  return Status::failure(StatusCode::malformed_file, kNone, "%.200s", std::string(fault).c_str());
}

}  // namespace

Result<TearRequest::Aimed> parse_aimed_option(const std::string& kind, const std::string& text,
                                              const std::optional<std::string>& pose) {
  TearRequest::Aimed aimed;
  aimed.option = "--" + kind + " " + text;
  const std::vector<std::string> fields = split(text, ',');
  const auto [bone, share] = name_and_number(fields.front(), share_in);
  const AimedFields& known = aimed_fields(kind);
  Json operation = {{"op", kind}, {known.bone, bone}};
  if (share) operation[kShareField] = *share;
  aimed.has_share = share.has_value();
  for (std::size_t i = 1; i < fields.size(); ++i)
    if (const Status status = add_field(known, fields[i], operation, aimed.material); !status)
      return status;
  aimed.has_share |= operation.contains(kShareField);
  if (kind == "sever")
    if (const Status status = read_detaching(operation, aimed); !status) return status;
  if (pose) {
    Result<Json> posed = pose_json(*pose);
    if (!posed) return posed.error();
    operation["pose"] = std::move(*posed);
  }
  auto parsed = parse_one(operation);
  if (!parsed) return parsed.error();
  aimed.operation = std::get<AimedOperation>(std::move(*parsed));
  return aimed;
}

Result<Operation> parse_closing_option(const std::string& kind, const std::string& text,
                                       const std::optional<std::string>& pose) {
  const std::vector<std::string> fields = split(text, ',');
  Json operation = {{"op", kind}};
  if (fields.front() != "all") {
    const std::optional<Vec3d> place = direction_in(fields.front());
    if (!place)
      return Status::failure(StatusCode::malformed_file, kNone,
                             "'%.60s' is no place; expected all or x/y/z in metres",
                             fields.front().c_str());
    operation["places"] = Json::array({{place->x(), place->y(), place->z()}});
  }
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const std::size_t equals = fields[i].find('=');
    const std::optional<double> value =
        equals == std::string::npos ? std::nullopt : number_in(fields[i].substr(equals + 1));
    if (!value)
      return Status::failure(StatusCode::malformed_file, kNone,
                             "'%.60s' is no field with a number, FIELD=VALUE", fields[i].c_str());
    const std::string name = fields[i].substr(0, equals);
    if (operation.contains(name))
      return Status::failure(StatusCode::malformed_file, kNone, "'%.40s' is given twice",
                             name.c_str());
    operation[name] = *value;
  }
  if (operation.contains("reach") && !operation.contains("places"))
    return Status::failure(StatusCode::malformed_file, kNone,
                           "reach needs a place x/y/z in place of all");
  if (pose) {
    Result<Json> posed = pose_json(*pose);
    if (!posed) return posed.error();
    operation["pose"] = std::move(*posed);
  }
  auto parsed = parse_one(operation);
  if (!parsed) return parsed.error();
  return std::get<Operation>(std::move(*parsed));
}

}  // namespace sunder::tools
