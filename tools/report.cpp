#include "tools/report.h"

#include <fstream>
#include <system_error>
#include <utility>

#include "tools/model_check.h"

namespace sunder::tools {
namespace {

const char* kind_name(LoadNote::Kind kind) {
  switch (kind) {
    case LoadNote::Kind::information: return "information";
    case LoadNote::Kind::repaired: return "repaired";
    case LoadNote::Kind::dropped: return "dropped";
  }
  return "information";
}

}  // namespace

Json to_json(const TopologyCounts& counts) {
  return {{"vertices", counts.vertices},
          {"points", counts.points},
          {"triangles", counts.triangles},
          {"edges", counts.edges},
          {"boundary_edges", counts.boundary_edges},
          {"boundary_loops", counts.boundary_loops},
          {"non_manifold_edges", counts.non_manifold_edges},
          {"components", counts.components},
          {"degenerate_triangles", counts.degenerate_triangles}};
}

Json to_json(const LoadReport& report) {
  Json notes = Json::array();
  for (const LoadNote& note : report.notes)
    notes.push_back({{"kind", kind_name(note.kind)}, {"place", note.place}, {"text", note.text}, {"count", note.count}});
  return {{"format", report.format}, {"space", report.space}, {"notes", std::move(notes)}};
}

Json to_json(const OperationOutcome& outcome) {
  const TearReport& tear = outcome.tear;
  const auto before_and_after = [](std::uint32_t before, std::uint32_t after) {
    return Json{{"before", before}, {"after", after}};
  };
  return {{"op", "tear"},
          {"status", outcome.has_missed() ? "missed" : "torn"},
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
          {"components", before_and_after(outcome.before.components, outcome.after.components)},
          {"boundary_loops", before_and_after(outcome.before.boundary_loops, outcome.after.boundary_loops)}};
}

Json result_json(const Character& torn, const TopologyCounts& source, const TopologyCounts& result) {
  const ModelCheck check = check_model(torn);
  return {{"weight_sum_error_max", check.greatest_weight_sum_error},
          {"weight_min", check.least_weight},
          {"influences_max", check.most_influences},
          {"non_finite_values", check.non_finite_values},
          {"degenerate_triangles", result.degenerate_triangles},
          {"degenerate_triangles_of_source", source.degenerate_triangles},
          {"non_manifold_edges", result.non_manifold_edges},
          {"non_manifold_edges_of_source", source.non_manifold_edges},
          {"topology", to_json(result)}};
}

std::string dump(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'; }

StagedText::StagedText(std::filesystem::path file, const std::string& text) : file_(std::move(file)), partial_(file_) {
  partial_ += ".partial";
  std::ofstream stream(partial_, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) status_ = Status::failure(StatusCode::file_unreadable, kNone, "cannot write this file");
}

StagedText::~StagedText() {
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

Status StagedText::commit() {
  if (!status_) return status_;
  std::error_code error;
  std::filesystem::rename(partial_, file_, error);
  return error ? Status::failure(StatusCode::file_unreadable, kNone, "cannot write this file") : Status();
}

Status write_text(const std::filesystem::path& file, const std::string& text) { return StagedText(file, text).commit(); }

}  // namespace sunder::tools
