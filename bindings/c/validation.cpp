#if SUNDER_C_VALIDATION
#include <sunder/tear/torn_weights.h>
#include <sunder/validation/validation.h>
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings/c/character.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

struct ReportObject : Object {
  static constexpr Kind kKind = Kind::report;
  sunder_report_info info = {};
  std::vector<std::string> texts;  ///< Of the findings, four each: code, text, advice, unit.
  std::vector<sunder_finding> findings;
  std::vector<float> deviations, bounds;
};

#if SUNDER_C_VALIDATION

constexpr std::uint32_t kMostPoses = 100000;

sunder_finding finding_of(const Finding& from, const std::string* texts) {
  const FindingPlace place = from.places.empty() ? FindingPlace{} : from.places.front();
  return {texts[0].c_str(),
          texts[1].c_str(),
          texts[2].c_str(),
          texts[3].c_str(),
          from.value,
          from.threshold,
          from.count,
          static_cast<uint32_t>(from.severity),
          static_cast<uint32_t>(from.evidence),
          place.mesh,
          place.vertex,
          place.bone,
          0};
}

sunder_report_info info_of(const ValidationReport& from) {
  const auto count = [&](Severity severity) {
    return static_cast<uint32_t>(
        std::count_if(from.findings.begin(), from.findings.end(),
                      [&](const Finding& finding) { return finding.severity == severity; }));
  };
  sunder_report_info to = {};
  to.struct_size = sizeof to;
  to.error_count = count(Severity::error);
  to.warning_count = count(Severity::warning);
  to.note_count = count(Severity::note);
  for (const PosedFigures& figures : from.posed) {
    to.pose_count += figures.pose_count;
    to.sampled = std::max(to.sampled, figures.maximum);
  }
  to.vertex_count = static_cast<uint32_t>(from.vertex_deviation.size());
  to.unmatched = from.matching.target_unmatched;
  to.uncertified = from.bracket.uncertified;
  to.diagonal = from.diagonal;
  to.found = from.bracket.found;
  to.certified = from.bracket.certified;
  to.metres_per_unit = from.metres_per_bind_unit;
  return to;
}

/// Fills the figures of the newest operation.
sunder_status measure_newest(const TornModel& model, const ValidationReport& from,
                             sunder_report_info& to) {
  if (model.undo_count() == 0) return SUNDER_OK;
  // In no pose: which points there are.
  const auto newest = measure_weight_errors(model, model.undo_count() - 1, 1, {});
  if (!newest) return report(newest.error());
  std::vector<std::size_t> first_vertex = {0};
  for (const Mesh& mesh : model.character().meshes)
    first_vertex.push_back(first_vertex.back() + mesh.vertex_count());
  to.newest_points = static_cast<uint32_t>(newest->points.size());
  for (const WeightErrors::OfPoint& point : newest->points) {
    const std::size_t vertex = first_vertex[point.mesh] + point.vertex;
    to.newest_sampled =
        std::fmax(to.newest_sampled, static_cast<double>(from.vertex_deviation[vertex]));
    const bool has_bound =
        vertex < from.vertex_bound.size() && !std::isnan(from.vertex_bound[vertex]);
    if (!has_bound) ++to.newest_uncertified;
    if (has_bound)
      to.newest_certified =
          std::max(to.newest_certified, static_cast<double>(from.vertex_bound[vertex]));
  }
  return SUNDER_OK;
}

/// @param torn  the model of the target, if an instance has it
sunder_status validate(const std::shared_ptr<const Character>& source,
                       const std::shared_ptr<const Character>& target, const TornModel* torn,
                       const sunder_validation_options& from, sunder_report* handle) {
  if (from.random_poses > kMostPoses)
    return fail(SUNDER_INVALID_ARGUMENT, kNone, "random_poses is %u; it must be at most %u",
                from.random_poses, kMostPoses);
  ValidationOptions options;
  options.random_poses = from.random_poses;
  options.limits_from = from.has_clip_limits != 0 ? LimitsFrom::clips : LimitsFrom::none;
  options.seed = from.seed;
  options.random_angle = from.random_angle;
  options.maximum_deviation = from.maximum_deviation;
  options.error_deviation = from.error_deviation;
  options.clip_margin = from.clip_margin;
  std::vector<Operation> operations;
  if (torn != nullptr) {
    auto history = torn->history();
    if (!history) return report(history.error());
    operations = std::move(*history);
    options.operations = operations;
  }
  auto found = validate_skin(source, target, options);
  if (!found) return report(found.error());
  auto object = std::make_unique<ReportObject>();
  object->info = info_of(*found);
  if (torn != nullptr) SUNDER_C_TRY(measure_newest(*torn, *found, object->info));
  object->texts.reserve(4 * found->findings.size());
  object->findings.reserve(found->findings.size());
  for (const Finding& finding : found->findings) {
    for (const std::string_view text :
         {finding.code, std::string_view(finding.text), finding.advice, finding.unit})
      object->texts.emplace_back(text);
    object->findings.push_back(finding_of(finding, &object->texts[object->texts.size() - 4]));
  }
  object->deviations = std::move(found->vertex_deviation);
  object->bounds = std::move(found->vertex_bound);
  object->bounds.resize(object->deviations.size(), std::numeric_limits<float>::quiet_NaN());
  return add(std::move(object), handle);
}

sunder_validation_options default_options() {
  const ValidationOptions from;
  return {sizeof(sunder_validation_options),
          from.random_poses,
          0,
          0,
          from.seed,
          from.random_angle,
          from.maximum_deviation,
          from.error_deviation,
          from.clip_margin};
}

#else

sunder_status validate(const std::shared_ptr<const Character>&,
                       const std::shared_ptr<const Character>&, const TornModel*,
                       const sunder_validation_options&, sunder_report*) {
  return fail(SUNDER_UNSUPPORTED_FEATURE, kNone, "this library was built without validation");
}

sunder_validation_options default_options() {
  sunder_validation_options options = {};
  options.struct_size = sizeof options;
  return options;
}

#endif

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_validation_options sunder_default_validation_options(void) { return default_options(); }

sunder_status sunder_validate(sunder_character source, sunder_character target,
                              const sunder_validation_options* options, sunder_report* report) {
  return guarded([&]() -> sunder_status {
    const CharacterObject* const from = find<CharacterObject>(source);
    if (from == nullptr) return SUNDER_INVALID_HANDLE;
    const CharacterObject* const to = find<CharacterObject>(target);
    if (to == nullptr) return SUNDER_INVALID_HANDLE;
    SUNDER_C_TRY(check_options(options, "options"));
    if (report == nullptr) return null_pointer("report");
    return validate(from->parts->loaded.character, to->parts->loaded.character, nullptr,
                    options != nullptr ? *options : default_options(), report);
  });
}

sunder_status sunder_validate_instance(sunder_scene scene, sunder_instance instance,
                                       const sunder_validation_options* options,
                                       sunder_report* report) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    SUNDER_C_TRY(check_options(options, "options"));
    if (report == nullptr) return null_pointer("report");
    // The instance keeps its character meanwhile.
    const std::shared_ptr<const sunder::Character> torn(std::shared_ptr<void>(),
                                                        &found.instance->character());
    return validate(found.instance->asset()->character(), torn, found.instance->model(),
                    options != nullptr ? *options : default_options(), report);
  });
}

sunder_status sunder_destroy_report(sunder_report report) {
  return destroy_object(report, Kind::report);
}

sunder_status sunder_get_report(sunder_report report, sunder_report_info* info) {
  const ReportObject* const object = find<ReportObject>(report);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  SUNDER_C_TRY(check_struct(info, "info"));
  *info = object->info;
  return SUNDER_OK;
}

sunder_status sunder_get_findings(sunder_report report, const sunder_finding** findings,
                                  uint32_t* count) {
  const ReportObject* const object = find<ReportObject>(report);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (findings == nullptr) return null_pointer("findings");
  if (count == nullptr) return null_pointer("count");
  *findings = object->findings.data();
  *count = static_cast<uint32_t>(object->findings.size());
  return SUNDER_OK;
}

sunder_status sunder_get_vertex_deviations(sunder_report report, const float** deviations,
                                           const float** bounds, uint32_t* count) {
  const ReportObject* const object = find<ReportObject>(report);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if (deviations == nullptr) return null_pointer("deviations");
  if (bounds == nullptr) return null_pointer("bounds");
  if (count == nullptr) return null_pointer("count");
  *deviations = object->deviations.data();
  *bounds = object->bounds.data();
  *count = static_cast<uint32_t>(object->deviations.size());
  return SUNDER_OK;
}

}  // extern "C"
