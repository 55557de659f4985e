#include <algorithm>

#include "bindings/c/piece.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

/// @param from  its text is kept by the view.
sunder_result result_of(const CommandResult& from) {
  const TearReport& report = from.report;
  sunder_result to = {};
  to.command = from.command;
  to.instance = handle_of(from.instance);
  to.error = from.status.text().data();
  to.status = static_cast<sunder_status>(from.status.code());
  to.error_index = from.status.index();
  to.runs = report.runs;
  to.segments_missed = report.segments_missed;
  to.faces_crossed = report.faces_crossed;
  to.vertices_added = report.vertices_added;
  to.triangles_added = report.triangles_added;
  to.triangles_retired = report.triangles_retired;
  to.blocked = report.blocked;
  to.caps = report.caps;
  to.open_sections = report.open_sections;
  to.separated_pieces = static_cast<std::uint32_t>(
      std::count_if(report.pieces.begin(), report.pieces.end(),
                    [](const TornPiece& piece) { return !piece.is_body; }));
  to.has_piece = from.piece != nullptr ? 1 : 0;
  to.advises_background = from.advises_background ? 1 : 0;
  to.length = report.length_posed;
  to.area_removed = report.area_removed_posed;
  return to;
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_status sunder_get_results(sunder_scene scene, const sunder_result** results,
                                 uint32_t* count) {
  return guarded([&]() -> sunder_status {
    SceneObject* const object = find<SceneObject>(scene);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (results == nullptr) return null_pointer("results");
    if (count == nullptr) return null_pointer("count");
    const auto all = object->scene.results();
    object->results.resize(all.size());
    std::transform(all.begin(), all.end(), object->results.begin(), result_of);
    *results = object->results.data();
    *count = static_cast<uint32_t>(all.size());
    return SUNDER_OK;
  });
}

sunder_status sunder_take_piece(sunder_scene scene, sunder_command command, sunder_piece* piece) {
  return guarded([&]() -> sunder_status {
    SceneObject* const object = find<SceneObject>(scene);
    if (object == nullptr) return SUNDER_INVALID_HANDLE;
    if (piece == nullptr) return null_pointer("piece");
    for (const sunder::CommandResult& result : object->scene.results()) {
      if (result.command != command || result.piece == nullptr) continue;
      auto added = std::make_unique<PieceObject>();
      added->piece = result.piece;
      added->tissue = result.tissue;
      return add(std::move(added), piece);
    }
    return fail(SUNDER_NOT_FOUND, sunder::kNone,
                "no piece came off by command %llu in the last update",
                static_cast<unsigned long long>(command));
  });
}

}  // extern "C"
