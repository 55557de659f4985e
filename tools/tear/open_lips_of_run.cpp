#include "tools/tear/open_lips_of_run.h"

#include <utility>
#include <vector>

#include "core/internal/find_named.h"
#include "io/internal/mesh_nodes.h"
#include "tools/messages/printed.h"
#include "tools/model/history.h"
#include "tools/model/name_advice.h"
#include "tools/open/opened_character.h"
#include "tools/open/walled_character.h"
#include "tools/picture/sewn_threads.h"
#include "tools/tear/blood_of_run.h"
#include "tools/tear/flesh_materials.h"
#include "tools/value_of.h"

namespace sunder::tools {
namespace {

bool tears(const Operation& operation) {
  return std::holds_alternative<TearOperation>(operation) ||
         std::holds_alternative<CutOperation>(operation) ||
         std::holds_alternative<DrillOperation>(operation);
}

/// Where clips show the operations that were not undone.
std::vector<ClipMoment> moments_of(const TearRun& run) {
  std::vector<ClipMoment> moments;
  for (const NumberedOperation& numbered : value_of(remaining_operations(run.played))) {
    if (!tears(*numbered.operation)) continue;
    const std::vector<PoseSpec> poses = pose_specs_of(*numbered.operation);
    const auto* const in_clip = poses.empty() ? nullptr : std::get_if<ClipPose>(&poses.front());
    if (in_clip == nullptr) continue;
    if (const auto clip = find_named_clip(run.model.source(), in_clip->clip))
      moments.push_back({*clip, in_clip->time});
  }
  if (const auto& span = run.request.open_span) {
    const auto clip = find_clip(run.model.source(), span->clip);
    if (!clip) return moments;  // Was refused by check_span().
    std::erase_if(moments, [&](const ClipMoment& of) { return of.clip == *clip; });
    moments.push_back({*clip, span->begin, span->end});
  }
  return moments;
}

/// Whether the model has the clip of --open-span, and it is long enough.
/// @return ok, or the exit code of the failure, which was reported.
ExitCode check_span(const TearRun& run) {
  const auto& span = run.request.open_span;
  if (!span) return ExitCode::ok;
  const Character& source = run.model.source();
  const auto clip = find_clip(source, span->clip);
  if (!clip) {
    std::vector<std::string> names;
    for (const Clip& of : source.clips) names.push_back(of.name);
    return complain("--open-span",
                    Status::failure(StatusCode::not_found, kNone, "no clip is named '%.100s'",
                                    span->clip.c_str()),
                    ExitCode::usage, name_advice(span->clip, "clips", names));
  }
  const auto duration = static_cast<double>(source.clips[*clip].duration);
  if (span->end.value_or(span->begin) <= duration) return ExitCode::ok;
  return complain("--open-span",
                  Status::failure(StatusCode::invalid_argument, kNone,
                                  "%g s is beyond the clip '%.100s', which lasts %g s",
                                  span->end.value_or(span->begin), span->clip.c_str(), duration),
                  ExitCode::usage);
}

}  // namespace

ExitCode author_tissue_of_run(TearRun& run) {
  for (const TissueField& field : run.request.tissue_fields)
    if (const Status status = add_tissue_field(*run.loaded.character, field, run.tissue); !status)
      return complain("--tissue-field " + field.text, status, ExitCode::usage);
  return ExitCode::ok;
}

ExitCode open_lips_of_run(TearRun& run) {
  if (run.request.open == OpenLips::no) return ExitCode::ok;
  if (const ExitCode code = check_span(run); code != ExitCode::ok) return code;
  const std::vector<Operation> history = value_of(run.model.history());
  Result<Opening> opening = measure_opening(run.loaded.character, history, run.tissue);
  if (!opening)
    return complain(run.request.model.string() + ": --open", opening.error(), ExitCode::usage);
  run.opening = std::move(*opening);
  if (run.request.flesh.use == FleshOption::Use::none) run.opening->walls = {};
  if (run.opening->widest_gap > 0) {
    run.messages.say(printed("--open: lips gape %.4g m", run.opening->widest_gap));
  } else {
    run.messages.warn("--open: no operation left lips that could gape");
    run.has_findings = true;
  }
  return ExitCode::ok;
}

Result<WrittenModel> written_model(const TearRun& run) {
  const Character& closed = run.certified ? run.certified->character : run.model.character();
  const bool is_open = run.opening && run.opening->widest_gap > 0;
  const bool gets_flesh =
      run.request.flesh.use == FleshOption::Use::flesh && has_fillings(run.model);
  if (!is_open && !gets_flesh && !run.blood && scars_of(run.model).empty())
    return WrittenModel{std::shared_ptr<const Character>(std::shared_ptr<void>(), &closed), {}};
  const Result<FleshMaterials> flesh = FleshMaterials::create(run);
  if (!flesh) return flesh.error();
  Character walled = closed;
  mark_scars(run.model, walled);
  if (gets_flesh) flesh->give_to_fillings(walled);
  std::vector<AppendedMaterial> appended;
  if (is_open || gets_flesh) appended = flesh->appended();
  const bool has_threads = is_open && run.opening->threads.triangle_count() > 0;
  const std::uint32_t threads = flesh->first_painted(appended.size());
  if (has_threads) appended.push_back({"Threads", kThreadColor, 0.0f, 0.6f, false});
  give_blood(run, flesh->first_painted(appended.size()), walled);
  if (is_open) {
    Opening opening = *run.opening;
    const WallMaterial wall_material = [&](std::uint32_t mesh, std::uint32_t submesh) {
      return flesh->beside(mesh, closed.meshes[mesh].submeshes[submesh].material);
    };
    if (const Status status = add_wound_walls(wall_material, opening, walled); !status)
      return status;
    if (has_threads)
      if (const Status status = add_wound_threads(threads, opening, walled); !status) return status;
    Result<Character> open =
        run.request.open == OpenLips::baked
            ? with_open_positions(std::move(walled), opening)
            : with_open_target(std::move(walled), opening, nodes_of_meshes(*run.loaded.source),
                               moments_of(run));
    if (!open) return open.error();
    walled = std::move(*open);
  }
  return WrittenModel{std::make_shared<const Character>(std::move(walled)), std::move(appended)};
}

Json open_lips_json(const TearRun& run) {
  const bool is_morph = run.request.open == OpenLips::morph;
  Json json = {{"as", is_morph ? "morph" : "baked"},
               {"widest_gap", run.opening->widest_gap},
               {"gaps", run.opening->gaps},
               {"seconds", run.opening->course.back().seconds},
               {"wall_faces", run.opening->walls.triangle_count()},
               {"thread_faces", run.opening->threads.triangle_count()}};
  if (is_morph) json["morph_target"] = kOpenTarget;
  return json;
}

}  // namespace sunder::tools
