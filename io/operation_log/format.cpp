#include "io/operation_log/format.h"

#include <span>
#include <utility>

#include "io/operation_log/place.h"

namespace sunder::operation_log {
namespace {

// Doubles are written as the shortest text that is read back to the same bits; floats are written
// as doubles.

template <class Scalar>
Json numbers(std::span<const Scalar> values) {
  Json array = Json::array();
  for (const Scalar value : values) array.push_back(static_cast<double>(value));
  return array;
}

template <class Vector>
Json vector_json(const Vector& vector) {
  return numbers(std::span<const typename Vector::Scalar>(vector.data(),
                                                          static_cast<std::size_t>(vector.size())));
}

Json pose_json(const RestPose&) { return "rest"; }

Json pose_json(const BindPose&) { return "bind"; }

Json pose_json(const ClipPose& pose) {
  Json json;
  std::visit([&](const auto& clip) { json["clip"] = clip; }, pose.clip);
  json["time"] = pose.time;
  return json;
}

Json pose_json(const BonesPose& pose) {
  Json json;
  Json& bones = json["bones"] = Json::object();
  for (const BonesPose::Bone& bone : pose.bones) {
    Json parts = Json::object();
    if (bone.translation) parts["translation"] = vector_json(*bone.translation);
    if (bone.rotation) parts["rotation"] = vector_json(bone.rotation->coeffs());
    if (bone.scale) parts["scale"] = vector_json(*bone.scale);
    bones[bone.name] = std::move(parts);
  }
  return json;
}

Json pose_json(const ModelPose& pose) {
  Json matrices = Json::array();
  for (const Affine3d& matrix : pose.model_from_bone) {
    const Eigen::Matrix<double, 3, 4, Eigen::RowMajor | Eigen::DontAlign> rows = matrix.matrix();
    matrices.push_back(vector_json(rows));
  }
  return {{"matrices", std::move(matrices)},
          {"morph_weights", numbers(std::span<const float>(pose.morph_weights))}};
}

Json pose_json(const PoseSpec& pose) {
  return std::visit([](const auto& kind) { return pose_json(kind); }, pose);
}

Json weights_json(const WeightOptions& weights) {
  return {{"policy", weight_policy_name(weights.policy)},
          {"influences", weights.maximum_influences}};
}

void add_weights(Json& operation, const std::optional<WeightOptions>& weights) {
  if (weights) operation["weights"] = weights_json(*weights);
}

Json pose_set_json(const PoseSetSpec& set) {
  Json limits = Json::array(), poses = Json::array();
  for (const JointLimit& limit : set.joint_limits)
    limits.push_back({{"bone", limit.bone},
                      {"axis", vector_json(limit.axis)},
                      {"lower", limit.lower},
                      {"upper", limit.upper}});
  for (const PoseSpec& pose : set.poses) poses.push_back(pose_json(pose));
  return {{"clip_samples", set.clip_samples},
          {"range_of_motion", set.range_of_motion},
          {"joint_limits", std::move(limits)},
          {"poses", std::move(poses)}};
}

Json importance_json(const RefitImportance& importance) {
  Json of_clip = Json::array();
  for (const RefitImportance::OfClip& of : importance.of_clip)
    of_clip.push_back({{"clip", of.clip}, {"factor", of.factor}});
  return {{"clips", importance.clips},
          {"of_clip", std::move(of_clip)},
          {"range_of_motion", importance.range_of_motion},
          {"poses", importance.poses}};
}

Json refit_json(const RefitOptions& refit) {
  return {{"poses", pose_set_json(refit.poses)},
          {"importance", importance_json(refit.importance)},
          {"bound", refit.bound},
          {"moves_bind", refit.moves_bind},
          {"coupled", refit.is_coupled},
          {"smoothness", refit.smoothness}};
}

void add_material(Json& json, const char* key, std::uint32_t material) {
  if (material != kNone) json[key] = material;
}

/// The fields of an operation that are on its first line.
Json header(const TearOperation& tear) {
  Json json = {{"op", "tear"},
               {"pose", pose_json(tear.pose)},
               {"width", tear.options.width},
               {"layers", tear.options.layers == Layers::all ? "all" : "nearest"},
               {"wall_depth", tear.options.wall_depth}};
  if (tear.options.lip_roll > 0) json["lip_roll"] = tear.options.lip_roll;
  add_material(json, "wall_material", tear.options.wall_material);
  add_weights(json, tear.options.weights);
  return json;
}

Json header(const CutOperation& operation) {
  const PlaneCut& cut = operation.cut;
  Json json = {{"op", "cut"},
               {"pose", pose_json(operation.pose)},
               {"plane", {{"point", vector_json(cut.point)}, {"normal", vector_json(cut.normal)}}}};
  for (const Vec3d& corner : cut.bounds) json["bounds"].push_back(vector_json(corner));
  json["caps"] = cut.caps;
  add_material(json, "cap_material", cut.cap_material);
  for (const Vec3d& place : cut.sections) json["sections"].push_back(vector_json(place));
  if (cut.first_hit)
    json["first_hit"] = {{"origin", vector_json(cut.first_hit->origin)},
                         {"direction", vector_json(cut.first_hit->direction)}};
  if (!cut.bone.empty()) json["bone"] = cut.bone;
  add_weights(json, cut.weights);
  return json;
}

Json header(const DrillOperation& operation) {
  const Bore& bore = operation.bore;
  Json json = {
      {"op", "drill"},
      {"pose", pose_json(operation.pose)},
      {"axis", {{"origin", vector_json(bore.origin)}, {"direction", vector_json(bore.direction)}}},
      {"radius", bore.radius},
      {"depth", bore.depth},
      {"chord_tolerance", bore.chord_tolerance},
      {"wall", bore.wall}};
  add_material(json, "wall_material", bore.wall_material);
  add_weights(json, bore.weights);
  return json;
}

Json piece_json(const PieceOfTriangle& piece) {
  return {{"mesh", piece.mesh}, {"triangle", piece.triangle}};
}

Json piece_json(const PieceNear& piece) {
  Json json = {{"near", vector_json(piece.point)}};
  if (!piece.bone.empty()) json["bone"] = piece.bone;
  return json;
}

Json header(const DetachOperation& operation) {
  return {
      {"op", "detach"},
      {"pose", pose_json(operation.pose)},
      {"piece", std::visit([](const auto& piece) { return piece_json(piece); }, operation.piece)}};
}

Json header(const WeightsOperation& operation) {
  Json json = {{"op", "weights"}, {"first", operation.first_operation}};
  if (operation.operation_count != kNone) json["count"] = operation.operation_count;
  json["weights"] = weights_json(operation.weights);
  if (operation.weights.policy == WeightPolicy::pose_exact)
    json["pose"] = pose_json(operation.pose);
  if (operation.weights.policy == WeightPolicy::refit) json["refit"] = refit_json(operation.refit);
  return json;
}

Json header(const UndoOperation& operation) { return {{"op", "undo"}, {"count", operation.count}}; }

Json header(const RedoOperation& operation) { return {{"op", "redo"}, {"count", operation.count}}; }

/// Names in files may contain any bytes; JSON is UTF-8.
std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void append_stroke(std::string& text, const TearOperation& tear) {
  auto change = tear.pose_changes.begin();
  for (std::uint32_t i = 0; i < tear.stroke.size(); ++i) {
    Json blade = {{"base", vector_json(tear.stroke[i].base)},
                  {"tip", vector_json(tear.stroke[i].tip)}};
    if (change != tear.pose_changes.end() && change->blade == i)
      blade["pose"] = pose_json((change++)->pose);
    text += i == 0 ? "\n      " : ",\n      ";
    text += one_line(blade);
  }
}

}  // namespace

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
