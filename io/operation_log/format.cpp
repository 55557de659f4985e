#include "io/operation_log/format.h"

#include <utility>

#include "core/operation/internal/describe_operations.h"
#include "io/operation_log/write_fields.h"

namespace sunder::operation_log {

Json value_json(const Vec3f& vector) { return numbers_json(vector); }

Json value_json(const Quatf& rotation) { return numbers_json(rotation.coeffs()); }

Json value_json(const Affine3d& matrix) {
  Json numbers = Json::array();
  for (int i = 0; i < 12; ++i) numbers.push_back(matrix(i / 4, i % 4));
  return numbers;
}

namespace {

template <class Pose>
Json pose_json(const Pose& pose) {
  if constexpr (kPoseName<Pose> != nullptr)
    return kPoseName<Pose>;
  else
    return value_json(pose);
}

Json pose_json(const BonesPose& pose) {
  Json json;
  Json& bones = json["bones"] = Json::object();
  for (const BonesPose::Bone& bone : pose.bones) bones[bone.name] = value_json(bone);
  return json;
}

/// The fields of an operation that are on its first line.
template <class Kind>
Json header(const Kind& operation) {
  Json json = {{"op", kOpName<Kind>}};
  const FieldWriter writer(json);
  describe(writer, operation);
  return json;
}

/// Names in files may contain any bytes; JSON is UTF-8.
std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append_stroke(std::string& text, const TearOperation& tear) {
  auto change = tear.pose_changes.begin();
  for (std::uint32_t i = 0; i < tear.stroke.size(); ++i) {
    Json blade = value_json(tear.stroke[i]);
    if (change != tear.pose_changes.end() && change->blade == i)
      blade["pose"] = value_json((change++)->pose);
    text += i == 0 ? "\n      " : ",\n      ";
    text += one_line(blade);
  }
}

}  // namespace

Json value_json(const PoseSpec& pose) {
  return std::visit([](const auto& kind) { return pose_json(kind); }, pose);
}

Json value_json(const PiecePlace& piece) {
  return std::visit([](const auto& kind) { return value_json(kind); }, piece);
}

void append_operation(std::string& text, const Operation& operation) {
  text += one_line(std::visit([](const auto& kind) { return header(kind); }, operation));
  const auto* const tear = std::get_if<TearOperation>(&operation);
  if (tear == nullptr) return;
  text.back() = ',';  // Replaces the closing brace.
  text += "\"stroke\":[";
  append_stroke(text, *tear);
  text += "]}";
}

}  // namespace sunder::operation_log
