#include "tools/model/model_json.h"

#include <utility>

namespace sunder::tools {
namespace {

const char* kind_name(LoadNote::Kind kind) {
  switch (kind) {
    case LoadNote::Kind::information: return "information";
    case LoadNote::Kind::repaired: return "repaired";
    case LoadNote::Kind::dropped: return "dropped";
    case LoadNote::Kind::warning: return "warning";
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
    notes.push_back({{"kind", kind_name(note.kind)},
                     {"place", note.place},
                     {"text", note.text},
                     {"count", note.count}});
  return {{"format", report.format}, {"space", report.space}, {"notes", std::move(notes)}};
}

}  // namespace sunder::tools
