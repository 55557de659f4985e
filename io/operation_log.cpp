#include <sunder/io/operation_log.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <initializer_list>
#include <set>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

namespace sunder {
namespace {

using Json = nlohmann::ordered_json;  // Bones keep the order in which the log names them.

constexpr std::size_t kMaximumBytes = std::size_t{64} << 20;
constexpr std::size_t kMaximumDepth = 32;  ///< The format itself needs 7.
constexpr double kLargest = 1e9;           ///< Of any number: metres, seconds, scale.

/// Carries a fault out of the nested readers; never leaves this file.
struct Fault {
  Status status;
};

/// A value and the JSON pointer to it.
struct Place {
  const Json& value;
  std::string path;
  std::uint32_t operation = kNone;

  [[noreturn]] void fail(StatusCode code, const std::string& text) const {
    throw Fault{Status::failure(code, operation, "%s: %s", path.empty() ? "/" : path.c_str(), text.c_str())};
  }
  [[noreturn]] void expected(const char* what) const {
    fail(StatusCode::malformed_file, std::string("expected ") + what + ", found " + value.type_name());
  }

  [[nodiscard]] Place at(std::size_t index) const { return {value[index], path + "/" + std::to_string(index), operation}; }
  [[nodiscard]] Place at(const std::string& key) const {
    const auto found = value.find(key);
    if (found == value.end()) fail(StatusCode::malformed_file, "field '" + key + "' is missing");
    return {*found, path + "/" + escaped(key), operation};
  }
  [[nodiscard]] bool has(const char* key) const { return value.contains(key); }

  void check_fields(std::initializer_list<std::string_view> known) const {
    if (!value.is_object()) expected("an object");
    for (const auto& [key, unused] : value.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        fail(StatusCode::malformed_file, "unknown field '" + key + "'");
  }

  /// RFC 6901.
  static std::string escaped(const std::string& key) {
    std::string result;
    for (const char c : key) result += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return result;
  }
};

// ---- text to values
// ---------------------------------------------------------------------------------------------------------------

/// Refuses, while parsing, what a tree of values can no longer show: nesting and repeated fields.
class ParseGuard {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& value) {
    if (static_cast<std::size_t>(depth) > kMaximumDepth)
      throw Fault{Status::failure(StatusCode::limit_exceeded, kNone, "values are nested deeper than %zu", kMaximumDepth)};
    if (event == Json::parse_event_t::object_start) fields_.emplace_back();
    if (event == Json::parse_event_t::object_end) fields_.pop_back();
    if (event == Json::parse_event_t::key && !fields_.back().insert(value.get<std::string>()).second)
      throw Fault{Status::failure(StatusCode::malformed_file, kNone, "field '%s' occurs twice in one object",
                                  value.get<std::string>().c_str())};
    return true;
  }

 private:
  std::vector<std::set<std::string>> fields_;  ///< Of the objects around the value, outermost first.
};

Json parse_json(std::string_view text) {
  if (text.size() > kMaximumBytes)
    throw Fault{Status::failure(StatusCode::limit_exceeded, kNone, "operation log of %zu bytes; the limit is %zu", text.size(),
                                kMaximumBytes)};
  ParseGuard guard;
  try {
    return Json::parse(text, [&](int depth, Json::parse_event_t event, const Json& value) { return guard(depth, event, value); });
  } catch (const Json::parse_error& error) {
    const std::size_t offset = std::min(error.byte == 0 ? 0 : error.byte - 1, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
    throw Fault{Status::failure(StatusCode::malformed_file, kNone, "not JSON: line %td, byte %zu: %s", line, offset, error.what())};
  } catch (const Json::exception& error) {  // Numbers that no double can hold.
    throw Fault{Status::failure(StatusCode::malformed_file, kNone, "not JSON: %s", error.what())};
  }
}

// ---- values to operations
// ---------------------------------------------------------------------------------------------------------

double read_number(const Place& place) {
  if (!place.value.is_number()) place.expected("a number");
  const double number = place.value.get<double>();
  if (!std::isfinite(number) || std::abs(number) > kLargest) place.fail(StatusCode::malformed_file, "number beyond 1e9");
  return number;
}

template <int N>
Eigen::Matrix<double, N, 1, Eigen::DontAlign> read_vector(const Place& place) {
  if (!place.value.is_array() || place.value.size() != N)
    place.expected(N == 3 ? "an array of 3 numbers" : "an array of 4 numbers");
  Eigen::Matrix<double, N, 1, Eigen::DontAlign> vector;
  for (int i = 0; i < N; ++i) vector[i] = read_number(place.at(static_cast<std::size_t>(i)));
  return vector;
}

std::string read_name(const Place& place) {
  if (!place.value.is_string()) place.expected("a string");
  return place.value.get<std::string>();
}

ClipPose read_clip_pose(const Place& place) {
  place.check_fields({"clip", "time"});
  ClipPose pose;
  const Place clip = place.at("clip");
  if (clip.value.is_number_unsigned()) {
    const auto index = clip.value.get<std::uint64_t>();
    if (index >= kNone) clip.fail(StatusCode::malformed_file, "clip index too large");
    pose.clip = static_cast<std::uint32_t>(index);
  } else if (clip.value.is_string()) {
    pose.clip = clip.value.get<std::string>();
  } else {
    clip.expected("a clip's name or index");
  }
  const Place time = place.at("time");
  pose.time = read_number(time);
  if (pose.time < 0.0) time.fail(StatusCode::malformed_file, "negative time");
  return pose;
}

BonesPose read_bones_pose(const Place& place) {
  place.check_fields({"bones"});
  const Place bones = place.at("bones");
  if (!bones.value.is_object()) bones.expected("an object");
  BonesPose pose;
  for (const auto& [name, unused] : bones.value.items()) {
    const Place bone = bones.at(name);
    bone.check_fields({"translation", "rotation", "scale"});
    if (name.empty()) bone.fail(StatusCode::malformed_file, "a bone without name");
    BonesPose::Bone read{.name = name, .translation = {}, .rotation = {}, .scale = {}};
    if (bone.has("translation")) read.translation = read_vector<3>(bone.at("translation")).cast<float>();
    if (bone.has("rotation")) {
      const Place rotation = bone.at("rotation");
      const Quatd quaternion(Vec4d(read_vector<4>(rotation)));
      if (quaternion.norm() < 1e-9) rotation.fail(StatusCode::malformed_file, "rotation of zero length");
      read.rotation = quaternion.normalized().cast<float>();
    }
    if (bone.has("scale")) read.scale = read_vector<3>(bone.at("scale")).cast<float>();
    pose.bones.push_back(std::move(read));
  }
  return pose;
}

PoseSpec read_pose(const Place& place) {
  if (place.value.is_string()) {
    if (place.value == "rest") return RestPose{};
    if (place.value == "bind") return BindPose{};
    place.fail(StatusCode::malformed_file, "expected \"rest\" or \"bind\"");
  }
  if (!place.value.is_object()) place.expected("\"rest\", \"bind\" or an object");
  if (place.has("bones")) return read_bones_pose(place);
  return read_clip_pose(place);
}

Stroke read_stroke(const Place& place) {
  if (!place.value.is_array()) place.expected("an array of blades");
  if (place.value.size() < 2) place.fail(StatusCode::malformed_file, "a stroke needs at least two blades");
  Stroke stroke;
  stroke.reserve(place.value.size());
  for (std::size_t i = 0; i < place.value.size(); ++i) {
    const Place blade = place.at(i);
    blade.check_fields({"base", "tip"});
    stroke.push_back({read_vector<3>(blade.at("base")), read_vector<3>(blade.at("tip"))});
    if (stroke.back().base == stroke.back().tip) blade.fail(StatusCode::malformed_file, "blade without length");
  }
  return stroke;
}

Operation read_operation(const Place& place) {
  if (!place.value.is_object()) place.expected("an object");
  const Place kind = place.at("op");
  if (const std::string name = read_name(kind); name != "tear")
    kind.fail(StatusCode::unsupported_feature, "operation '" + name + "'; only 'tear' is known");
  place.check_fields({"op", "pose", "width", "layers", "stroke"});
  TearOperation tear;
  if (place.has("pose")) tear.pose = read_pose(place.at("pose"));
  if (place.has("width")) {
    const Place width = place.at("width");
    if (read_number(width) != 0.0) width.fail(StatusCode::unsupported_feature, "only width 0 is supported");
  }
  if (place.has("layers")) {
    const Place layers = place.at("layers");
    if (const std::string name = read_name(layers); name != "nearest")
      layers.fail(StatusCode::unsupported_feature, "layers '" + name + "'; only 'nearest' is supported");
  }
  tear.stroke = read_stroke(place.at("stroke"));
  return tear;
}

std::vector<Operation> read_log(const Json& log) {
  const Place root{log, ""};
  if (!log.is_object()) root.expected("an object");
  // Before all else: a log of another version is to be called that, not wrong.
  const Place version = root.at("sunder_operations");
  if (!version.value.is_number_integer()) version.expected("the version, an integer");
  if (version.value != 1)
    version.fail(StatusCode::unsupported_feature, "version " + version.value.dump() + "; this build reads version 1");
  root.check_fields({"sunder_operations", "operations"});

  const Place list = root.at("operations");
  if (!list.value.is_array()) list.expected("an array");
  std::vector<Operation> operations;
  operations.reserve(list.value.size());
  for (std::size_t i = 0; i < list.value.size(); ++i) {
    Place one = list.at(i);
    one.operation = static_cast<std::uint32_t>(i);
    operations.push_back(read_operation(one));
  }
  return operations;
}

}  // namespace

Result<std::vector<Operation>> parse_operations(std::string_view json) {
  try {
    return read_log(parse_json(json));
  } catch (const Fault& fault) {
    return fault.status;
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "no memory for the operation log");
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "operation log: %s", error.what());
  }
}

Result<std::vector<Operation>> load_operations(const std::filesystem::path& file) {
  try {
    const std::string name = file.filename().string();
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found)
      return Status::failure(StatusCode::file_not_found, kNone, "no file '%s'", name.c_str());
    std::ifstream stream(file, std::ios::binary);
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (status.type() != std::filesystem::file_type::regular || error || !stream)
      return Status::failure(StatusCode::file_unreadable, kNone, "cannot read '%s'", name.c_str());
    if (size > kMaximumBytes)
      return Status::failure(StatusCode::limit_exceeded, kNone, "%s: %ju bytes; the limit is %zu", name.c_str(), size,
                             kMaximumBytes);
    std::string text(static_cast<std::size_t>(size), '\0');
    if (!stream.read(text.data(), static_cast<std::streamsize>(size)))
      return Status::failure(StatusCode::file_unreadable, kNone, "cannot read '%s'", name.c_str());
    return parse_operations(text);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "no memory for the operation log");
  } catch (const std::exception& error) {
    return Status::failure(StatusCode::internal_error, kNone, "operation log: %s", error.what());
  }
}

}  // namespace sunder
