#include "tools/tear/report.h"

#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>

#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <utility>
#include <variant>

#include "tools/model/history.h"
#include "tools/model/model_check.h"
#include "tools/model/model_json.h"

namespace sunder::tools {
namespace {

/// The names of an operation in the report.
struct Names {
  const char* op;
  const char* done;
  bool can_miss;
};

Names names_of(const Operation& operation) {
  struct Visitor {
    Names operator()(const TearOperation&) const { return {"tear", "torn", true}; }
    Names operator()(const CutOperation&) const { return {"cut", "cut", true}; }
    Names operator()(const DrillOperation&) const { return {"drill", "drilled", true}; }
    Names operator()(const DetachOperation&) const { return {"detach", "detached", false}; }
    Names operator()(const WeldOperation&) const { return {"weld", "welded", true}; }
    Names operator()(const SutureOperation&) const { return {"suture", "sewn", true}; }
    Names operator()(const WeightsOperation&) const { return {"weights", "weighed", false}; }
    Names operator()(const UndoOperation&) const { return {"undo", "undone", false}; }
    Names operator()(const RedoOperation&) const { return {"redo", "redone", false}; }
  };
  return std::visit(Visitor(), operation);
}

Json piece_json(const PieceDescription& piece, bool is_body, const Character& character) {
  Json meshes = Json::array(), bones = Json::array();
  for (const PieceDescription::Triangles& part : piece.meshes)
    meshes.push_back({{"mesh", character.meshes[part.mesh].name},
                      {"index", part.mesh},
                      {"triangle_count", part.triangles.size()}});
  for (const std::uint32_t bone : piece.bones) bones.push_back(character.skeleton.bones[bone].name);
  return {{"meshes", std::move(meshes)},
          {"triangle_count", piece.triangle_count},
          {"is_body", is_body},
          {"bones", std::move(bones)},
          {"area_posed", piece.area_posed},
          {"centroid_posed", vector_json(piece.centroid_posed)}};
}

Json weights_json(const WeightReport& weights, const std::optional<double>& error_max) {
  Json json = {{"points", weights.points},
               {"pruned", weights.pruned},
               {"ill_conditioned", weights.ill_conditioned},
               {"refitted", weights.refitted},
               {"certified_barycentric", weights.certified_barycentric},
               {"certified", weights.certified},
               {"uncertified", weights.uncertified}};
  if (error_max) json["error_max"] = *error_max;
  return json;
}

/// Text, because JSON readers keep only 53 bits of a number.
std::string digest_text(std::uint64_t digest) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, digest);
  return text;
}

}  // namespace

Result<OperationOutcome> play(const Operation& operation, TornModel& model,
                              DetachedPieces* detached) {
  const std::size_t threads_before = threads_of(model).size();
  const auto begin = std::chrono::steady_clock::now();
  Result<TearReport> report =
      detached != nullptr ? detached->apply(operation, model) : apply_operation(model, operation);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  if (!report) return report.error();
  const Names names = names_of(operation);
  const bool has_missed = names.can_miss && report->runs == 0;
  std::vector<PieceDescription> pieces;
  const bool has_left = std::holds_alternative<DetachOperation>(operation);
  for (const TornPiece& piece : report->pieces) {
    if (has_left) break;  // the model does not have it any more
    Result<PieceDescription> description = model.describe_piece(piece);
    if (!description) return description.error();
    pieces.push_back(std::move(*description));
  }
  OperationOutcome outcome{names.op,           names.done,      has_missed,
                           std::move(*report), elapsed.count(), std::move(pieces)};
  if (std::holds_alternative<SutureOperation>(operation))
    outcome.threads = threads_of(model).size() - threads_before;
  return outcome;
}

Status measure_weight_error(const Operation& operation, const TornModel& model,
                            OperationOutcome& outcome) {
  outcome.weight_error_max = 0.0;
  if (outcome.has_missed || !names_of(operation).can_miss) return {};  // It created no points.
  const Result<std::vector<ModelPose>> poses = poses_of(operation, model.source());
  if (!poses) return poses.error();
  const Result<WeightErrors> errors =
      measure_weight_errors(model, model.undo_count() - 1, 1, *poses);
  if (!errors) return errors.error();
  outcome.weight_error_max = errors->metres.maximum;
  return {};
}

Json to_json(const OperationOutcome& outcome, const Character& character) {
  const TearReport& tear = outcome.tear;
  Json pieces = Json::array();
  for (std::size_t i = 0; i < outcome.pieces.size(); ++i)
    pieces.push_back(piece_json(outcome.pieces[i], tear.pieces[i].is_body, character));
  Json json = {{"op", outcome.op},
               {"status", outcome.has_missed ? "missed" : outcome.done},
               {"seconds", outcome.seconds},
               {"runs", tear.runs},
               {"segments", tear.segments},
               {"segments_missed", tear.segments_missed},
               {"faces_crossed", tear.faces_crossed},
               {"points_added", tear.points_added},
               {"vertices_added", tear.vertices_added},
               {"triangles_added", tear.triangles_added},
               {"triangles_retired", tear.triangles_retired},
               {"blocked", tear.blocked},
               {"length_posed", tear.length_posed},
               {"area_removed_posed", tear.area_removed_posed},
               {"weights", weights_json(tear.weights, outcome.weight_error_max)},
               {"caps", tear.caps},
               {"open_sections", tear.open_sections},
               {"pieces", std::move(pieces)}};
  if (outcome.threads > 0) json["threads"] = outcome.threads;
  if (!outcome.topology) return json;
  const TopologyCounts &before = outcome.topology->before, &after = outcome.topology->after;
  json["components"] = {{"before", before.components}, {"after", after.components}};
  json["boundary_loops"] = {{"before", before.boundary_loops}, {"after", after.boundary_loops}};
  return json;
}

Json result_json(const TornModel& torn, const TopologyCounts& source,
                 const TopologyCounts& result) {
  const ModelCheck check = check_model(torn.character());
  return {{"weight_sum_error_max", check.greatest_weight_sum_error},
          {"weight_min", check.least_weight},
          {"influences_max", check.most_influences},
          {"non_finite_values", check.non_finite_values},
          {"degenerate_triangles", result.degenerate_triangles},
          {"degenerate_triangles_of_source", source.degenerate_triangles},
          {"non_manifold_edges", result.non_manifold_edges},
          {"non_manifold_edges_of_source", source.non_manifold_edges},
          {"topology", to_json(result)},
          {"digest", digest_text(torn.digest())}};
}

}  // namespace sunder::tools
