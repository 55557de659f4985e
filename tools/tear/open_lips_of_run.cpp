#include "tools/tear/open_lips_of_run.h"

#include <utility>
#include <vector>

#include "io/internal/mesh_nodes.h"
#include "tools/messages/printed.h"
#include "tools/model/find_clip.h"
#include "tools/model/history.h"
#include "tools/open/opened_character.h"
#include "tools/value_of.h"

namespace sunder::tools {
namespace {

bool tears(const Operation& operation) {
  return std::holds_alternative<TearOperation>(operation) ||
         std::holds_alternative<CutOperation>(operation) ||
         std::holds_alternative<DrillOperation>(operation);
}

std::optional<std::uint32_t> clip_of(const ClipPose& pose, const Character& source) {
  if (const auto* const index = std::get_if<std::uint32_t>(&pose.clip)) return *index;
  return find_clip(source, std::get<std::string>(pose.clip));
}

/// Where clips show the operations that were not undone.
std::vector<ClipMoment> moments_of(const TearRun& run) {
  std::vector<ClipMoment> moments;
  for (const NumberedOperation& numbered : value_of(remaining_operations(run.played))) {
    if (!tears(*numbered.operation)) continue;
    const std::vector<PoseSpec> poses = pose_specs_of(*numbered.operation);
    const auto* const in_clip = poses.empty() ? nullptr : std::get_if<ClipPose>(&poses.front());
    if (in_clip == nullptr) continue;
    if (const auto clip = clip_of(*in_clip, run.model.source()))
      moments.push_back({*clip, in_clip->time});
  }
  return moments;
}

}  // namespace

ExitCode open_lips_of_run(TearRun& run) {
  if (run.request.open == OpenLips::no) return ExitCode::ok;
  const std::vector<Operation> history = value_of(run.model.history());
  Result<Opening> opening = measure_opening(run.loaded.character, history);
  if (!opening)
    return complain(run.request.model.string() + ": --open", opening.error(),
                    ExitCode::internal_error);
  run.opening = std::move(*opening);
  if (run.opening->widest_gap > 0) {
    run.messages.say(printed("--open: lips gape %.4g m", run.opening->widest_gap));
  } else {
    run.messages.warn("--open: no operation left lips that could gape");
    run.has_findings = true;
  }
  return ExitCode::ok;
}

Result<std::shared_ptr<const Character>> written_character(const TearRun& run) {
  const Character& closed = run.certified ? run.certified->character : run.model.character();
  if (!run.opening || !(run.opening->widest_gap > 0))
    return std::shared_ptr<const Character>(std::shared_ptr<void>(), &closed);
  Result<Character> open =
      run.request.open == OpenLips::baked
          ? with_open_positions(closed, *run.opening)
          : with_open_target(closed, *run.opening, nodes_of_meshes(*run.loaded.source),
                             moments_of(run));
  if (!open) return open.error();
  return std::make_shared<const Character>(std::move(*open));
}

Json open_lips_json(const TearRun& run) {
  const bool is_morph = run.request.open == OpenLips::morph;
  Json json = {{"as", is_morph ? "morph" : "baked"},
               {"widest_gap", run.opening->widest_gap},
               {"seconds", run.opening->course.back().seconds}};
  if (is_morph) json["morph_target"] = kOpenTarget;
  return json;
}

}  // namespace sunder::tools
