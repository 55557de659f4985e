#include "tools/tear/validation_notes.h"

#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

/// Whether there are vertices that stand nowhere on the source's surface.
bool has_walls(const TornModel& model) {
  for (Index mesh = 0; mesh < model.character().meshes.size(); ++mesh) {
    const Mesh& source = model.source().meshes[mesh];
    for (Index v = source.vertex_count(); v < model.character().meshes[mesh].vertex_count(); ++v)
      if (model.birth(mesh, v).triangle >= source.triangle_count()) return true;
  }
  return false;
}

}  // namespace

std::vector<std::string> validation_notes(const TearRun& run) {
  const TearRequest& request = run.request;
  std::vector<std::string> notes;
  const auto add = [&](const std::string& cause, const char* finds) {
    notes.push_back(cause + ": `sunder validate` " + finds);
  };
  if (request.open != OpenLips::no)
    add("--open moves lips apart and adds walls",
        "compares the surface with the closed source, and may warn of its shape and weights");
  else if (has_walls(run.model))
    add("walls and caps stand nowhere on the source",
        "takes them for a changed surface, and may warn of its shape and weights, if its --ops "
        "names no log");
  if (limits_influences(request.save) && run.pruning.vertices_pruned > 0)
    add(printed("--influences %s takes influences from %zu vertices, which move by up to %.3g m "
                "for it",
                influences_name(request.save.maximum_influences).c_str(),
                static_cast<std::size_t>(run.pruning.vertices_pruned),
                run.pruning.pruning_error_max),
        "finds that");
  if (!request.maximum_error && request.save.weights == WeightFormat::unorm8)
    add("--weights-as u8 rounds weights to 1/255", "may find how far vertices move for it");
  if (request.maximum_error)
    add(printed("--max-error allows vertices to move by %.3g m", request.maximum_error->metres),
        "may find that");
  return notes;
}

}  // namespace sunder::tools
