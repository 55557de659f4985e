#include <sunder/skinning/pose.h>
#include <sunder/validation/validation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <new>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "core/internal/or_throw.h"
#include "pipeline/validation/checks/attribute_checks.h"
#include "pipeline/validation/checks/certificate_checks.h"
#include "pipeline/validation/checks/cracks.h"
#include "pipeline/validation/checks/deviation.h"
#include "pipeline/validation/checks/deviation_over_time.h"
#include "pipeline/validation/checks/inherited.h"
#include "pipeline/validation/checks/papers.h"
#include "pipeline/validation/checks/pop_check.h"
#include "pipeline/validation/checks/profile_check.h"
#include "pipeline/validation/checks/row_checks.h"
#include "pipeline/validation/checks/shape_checks.h"
#include "pipeline/validation/checks/side_checks.h"
#include "pipeline/validation/checks/skeleton_checks.h"
#include "pipeline/validation/checks/stored_checks.h"
#include "pipeline/validation/checks/support_checks.h"
#include "pipeline/validation/internal/option_ranges.h"
#include "pipeline/validation/match/skin_difference.h"

namespace sunder {
namespace validation {
namespace {

constexpr double kMatchDistance = 0.05;  ///< Of the diagonal.
constexpr double kMatchCosine = 0.0;
constexpr double kErrorLimits = 10;  ///< A deviation of so many limits is an error.

Status check_stored(const Character& character, std::span<const StoredInfluences> stored,
                    const char* which) {
  if (stored.empty()) return {};
  if (stored.size() != character.meshes.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "%s: stored influences of %zu meshes, the character has %zu", which,
                           stored.size(), character.meshes.size());
  for (Index mesh = 0; mesh < stored.size(); ++mesh) {
    const std::size_t entries =
        std::size_t{stored[mesh].per_vertex} * character.meshes[mesh].vertex_count();
    if (stored[mesh].slots.size() != entries || stored[mesh].weights.size() != entries)
      return Status::failure(StatusCode::size_mismatch, mesh,
                             "%s: mesh %u: %zu stored weights, expected %zu", which, mesh,
                             stored[mesh].weights.size(), entries);
  }
  return {};
}

/// Whether a file has the very vertices of a torn model, so that births match them.
bool has_vertices_of(const Character& target, const Character& torn) {
  return target.meshes.size() == torn.meshes.size() &&
         std::equal(target.meshes.begin(), target.meshes.end(), torn.meshes.begin(),
                    [](const Mesh& a, const Mesh& b) { return a.positions == b.positions; });
}

Places unaccepted(const Skinned& from, const SurfaceMatches& matches) {
  Places places;
  for (Index v = 0; v < matches.matches.size(); ++v)
    if (!matches.matches[v].is_accepted && from.surface.triangle_of_vertex[v] != kNone)
      places.push_back(
          from.place(v, kNone, from.metres_per_bind_unit * matches.matches[v].distance));
  return places;
}

/// The mesh of the source with the name of a target's mesh: the one of the same number, else the
/// only one. kNone: there is none, or several.
Index counterpart_of(Index target_mesh, const Character& source, const std::string& name) {
  if (target_mesh < source.meshes.size() && source.meshes[target_mesh].name == name)
    return target_mesh;
  Index found = kNone;
  for (Index mesh = 0; mesh < source.meshes.size(); ++mesh) {
    if (source.meshes[mesh].name != name) continue;
    if (found != kNone) return kNone;
    found = mesh;
  }
  return found;
}

/// Where meshes touch, a closest place may lie on the wrong one. Such matches are looked up again
/// on the mesh of the same name, and taken there if that is as close.
void keep_to_meshes(const Skinned& source, const Skinned& target, const MatchLimits& limits,
                    SurfaceMatches& matches) {
  const double as_close = 1e-6 * source.surface.diagonal;
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh) {
    const Index named = counterpart_of(mesh, source.character, target.character.meshes[mesh].name);
    if (named == kNone) continue;
    std::optional<SurfaceSearch> search;
    for (Index v = matches.first_vertex[mesh]; v < matches.first_vertex[mesh + 1]; ++v) {
      SurfaceMatch& match = matches.matches[v];
      if (match.mesh == named || match.mesh == kNone) continue;
      if (!search) {
        std::vector<Index> triangles(source.character.meshes[named].triangle_count());
        std::iota(triangles.begin(), triangles.end(), source.surface.first_triangle[named]);
        search.emplace(source.surface, triangles);
      }
      const SurfaceMatch other = search->closest(target.surface, v, limits);
      if (other.is_accepted && other.distance <= match.distance + as_close) match = other;
    }
  }
}

/// In bind space.
double largest_distance(const SurfaceMatches& matches) {
  double largest = 0.0;
  for (const SurfaceMatch& match : matches.matches)
    if (match.is_accepted) largest = std::max(largest, match.distance);
  return largest;
}

/// One validation from beginning to end.
class Validation {
 public:
  Validation(std::shared_ptr<const Character> source, std::shared_ptr<const Character> target,
             const ValidationOptions& options, BoneMatch bones)
      : source_character_(std::move(source)),
        target_character_(std::move(target)),
        options_(options),
        bones_(std::move(bones)) {}

  ValidationReport run();

 private:
  void begin(std::string_view stage) {
    constexpr double kStages = 7.0;
    if (options_.progress) options_.progress(stage, stage_ / kStages);
    stage_ += 1.0;
  }
  void bring_to_scale();
  void match();
  SurfaceMatches match_to_source(const Skinned& target, const MatchLimits& limits) const;
  /// Whether the target's vertices are those of the source after the operations.
  [[nodiscard]] bool has_played_vertices() const {
    return replayed_ && has_vertices_of(*target_character_, replayed_->character());
  }
  void match_in_bind_pose_of_source(const MatchLimits& limits, std::size_t unmatched);
  void check_stored_weights(const RowReader& reader);
  void check_weights(const RowReader& reader);
  void check_poses(const RowReader& reader);
  void check_lips();

  std::shared_ptr<const Character> source_character_, target_character_;
  std::shared_ptr<const Character> named_ = target_character_;  ///< Kept for the findings.
  const ValidationOptions& options_;
  BoneMatch bones_;
  double stage_ = 0.0;
  ValidationReport report_;
  std::optional<FindingList> findings_;
  std::optional<Skinned> source_, target_;
  std::optional<TornModel> replayed_;
  SurfaceMatches matches_;
};

void Validation::bring_to_scale() {
  report_.scale = find_scale(*source_, *target_, bones_);
  if (report_.scale == 1.0) return findings_->add(Code::scale, {});
  char text[160];
  std::snprintf(text, sizeof text,
                "The target is %.4g times as large as the source; all else compares the target "
                "divided by that.",
                report_.scale);
  findings_->add_finding(Code::scale, kind_of(Code::scale).severity, Evidence::exact, text, {},
                         report_.scale);
  target_character_ =
      std::make_shared<const Character>(divided_by(*target_character_, report_.scale));
  target_.emplace(*target_character_, options_.stored_target);
}

SurfaceMatches Validation::match_to_source(const Skinned& target, const MatchLimits& limits) const {
  SurfaceMatches matches = match_surfaces(target.surface, source_->surface, limits);
  keep_to_meshes(*source_, target, limits, matches);
  return matches;
}

/// Two characters that move alike may have bind poses of their own: a skeleton of rigid parts has
/// none, and what it then gets depends on the number of skins. The target stays in its own bind
/// pose if no more of its vertices are matched in the source's.
void Validation::match_in_bind_pose_of_source(const MatchLimits& limits, std::size_t unmatched) {
  const ModelPose own = or_throw(bind_pose(*target_character_)),
                  driven = driven_bind_pose(or_throw(bind_pose(*source_character_)),
                                            *target_character_, bones_);
  if (std::ranges::equal(own.model_from_bone, driven.model_from_bone,
                         [](const Affine3d& a, const Affine3d& b) { return a.isApprox(b, 1e-6); }))
    return;
  Skinned target(*target_character_, options_.stored_target, driven);
  SurfaceMatches matches = match_to_source(target, limits);
  if (unaccepted(target, matches).size() >= unmatched) return;
  target_.emplace(std::move(target));
  matches_ = std::move(matches);
}

void Validation::match() {
  const MatchLimits limits{kMatchDistance * source_->surface.diagonal, kMatchCosine, false};
  if (has_played_vertices()) {
    matches_ = matches_from_births(*replayed_);
  } else {
    matches_ = match_to_source(*target_, limits);
    if (const std::size_t unmatched = unaccepted(*target_, matches_).size(); unmatched > 0)
      match_in_bind_pose_of_source(limits, unmatched);
  }
  const SurfaceMatches back = match_surfaces(source_->surface, target_->surface, limits);
  Places missing = unaccepted(*source_, back);
  Places unmatched = unaccepted(*target_, matches_);
  MatchFigures& figures = report_.matching;
  figures.target_samples = target_->surface.vertex_count();
  figures.source_samples = source_->surface.vertex_count();
  figures.target_unmatched = static_cast<Index>(unmatched.size());
  figures.source_unmatched = static_cast<Index>(missing.size());
  figures.target_distance = source_->metres_per_bind_unit * largest_distance(matches_);
  figures.source_distance = source_->metres_per_bind_unit * largest_distance(back);
  const std::string holes = std::to_string(missing.size()) + " of " +
                            std::to_string(figures.source_samples) +
                            " vertices of the source have no counterpart on the target.";
  if (unmatched.empty() && !missing.empty())
    findings_->add_finding(Code::unmatched, Severity::note, Evidence::exact, holes, {},
                           static_cast<double>(missing.size()));
  else
    findings_->add(Code::unmatched, std::move(unmatched), holes);
}

void Validation::check_stored_weights(const RowReader& reader) {
  StoredFaults of_target = find_stored_faults(*target_);
  if (!of_target.is_tested) {
    for (const Code code :
         {Code::sum, Code::sum_integer, Code::rounding, Code::negative, Code::not_finite,
          Code::duplicate, Code::out_of_range, Code::unweighted, Code::unsorted, Code::zero_joint})
      findings_->not_tested(code, "the weights that the file stores are not known");
    return;
  }
  const StoredFaults of_source = find_stored_faults(*source_);
  const auto add = [&](Code code, Places places, const Places& known) {
    const Places inherited = take_inherited(reader, places, known);
    findings_->add_new(code, std::move(places), inherited);
  };
  Places integer_sums = std::move(of_target.sum_integer);
  const Places inherited = take_inherited(reader, integer_sums, of_source.sum_integer);
  findings_->add(Code::rounding, take_rounded_one_by_one(reader, integer_sums));
  findings_->add_new(Code::sum_integer, std::move(integer_sums), inherited);
  add(Code::sum, std::move(of_target.sum), of_source.sum);
  add(Code::negative, std::move(of_target.negative), of_source.negative);
  add(Code::not_finite, std::move(of_target.not_finite), of_source.not_finite);
  add(Code::duplicate, std::move(of_target.duplicate), of_source.duplicate);
  add(Code::out_of_range, std::move(of_target.out_of_range), of_source.out_of_range);
  add(Code::unweighted, std::move(of_target.unweighted), of_source.unweighted);
  add(Code::unsorted, std::move(of_target.unsorted), of_source.unsorted);
  add(Code::zero_joint, std::move(of_target.zero_joint), of_source.zero_joint);
}

void Validation::check_weights(const RowReader& reader) {
  const std::size_t kept = limits_of(options_.profile).influences;
  InfluenceFigures figures = count_influences(*target_, kept == 0 ? 4 : kept);
  report_.influence_histogram = std::move(figures.histogram);
  findings_->add(Code::many_influences, std::move(figures.many));
  findings_->add(Code::prunable, std::move(figures.prunable));
  const std::vector<DifferentRow> rows = find_different_rows(reader);
  check_rows(reader, rows, *findings_);
  check_bones(reader, rows, *findings_);
}

void Validation::check_poses(const RowReader& reader) {
  const SkinPoints points(reader);
  const std::vector<PoseBatch> batches =
      make_pose_batches(source_character_, points.bind(), options_);
  const SkinDifferences differences =
      difference_of(*source_character_, *target_character_, matches_, points.skins());
  measure_deviation(reader, differences, batches, points.bind(), report_);
  if (options_.times_per_clip > 1)
    report_.over_time =
        deviation_over_time(*source_character_, points.bind(), differences,
                            report_.posed.front().sample_count, options_.times_per_clip);
  check_deviation(reader, points, differences, batches, report_,
                  std::min(options_.maximum_deviation, options_.error_deviation) * report_.diagonal,
                  std::min(options_.error_deviation, kErrorLimits * options_.maximum_deviation) *
                      report_.diagonal,
                  *findings_);
  check_shapes(reader, points, differences, batches.back(), *findings_);
  const CrackRows cracks = check_cracks(reader, points, batches, *findings_);
  check_profile(reader, points, batches, options_.profile, *findings_);
  report_.papers = measure_for_papers(reader, points, differences, batches.back());
  begin("certificate");
  check_certificates(reader, {points, differences, cracks}, options_, report_, *findings_);
}

void Validation::check_lips() {
  if (replayed_) {
    const Skinned torn(replayed_->character(), {});
    findings_->add(Code::lip_welded, find_welded_lips(torn, *target_));
  } else {
    findings_->add(Code::lip_welded, find_welded_lips(*source_, *target_));
  }
}

ValidationReport Validation::run() {
  findings_.emplace(*target_character_);
  begin("surfaces");
  source_.emplace(*source_character_, options_.stored_source);
  target_.emplace(*target_character_, options_.stored_target);
  bring_to_scale();
  report_.diagonal = source_->rest_diagonal;
  report_.metres_per_bind_unit = source_->metres_per_bind_unit;
  report_.source_bone_of_target = bones_.source_of_target;
  replayed_ = check_pops(source_character_, *target_character_, options_.operations,
                         report_.diagonal, *findings_);
  begin("matching");
  match();
  const RowReader reader(*source_, *target_, matches_, bones_,
                         has_played_vertices() ? &replayed_->character() : nullptr);
  begin("weights");
  check_stored_weights(reader);
  check_weights(reader);
  begin("poses");
  check_poses(reader);
  begin("structure");
  check_supports(reader, *findings_);
  check_sides(reader, *findings_);
  check_lips();
  begin("attributes");
  check_attributes(reader, *findings_);
  check_mesh_health(reader, *findings_);
  check_skeletons(reader, *findings_);
  findings_->finish(report_);
  return std::move(report_);
}

}  // namespace
}  // namespace validation

Result<ValidationReport> validate_skin(const std::shared_ptr<const Character>& source,
                                       const std::shared_ptr<const Character>& target,
                                       const ValidationOptions& options) {
  using namespace validation;
  if (!source || !target)
    return Status::failure(StatusCode::empty_input, kNone, "validate_skin: no character");
  for (const auto& [range, value] :
       {std::pair(kMaximumDeviation, options.maximum_deviation),
        std::pair(kErrorDeviation, options.error_deviation),
        std::pair(kRandomAngle, options.random_angle), std::pair(kClipMargin, options.clip_margin)})
    if (const Status status = range.check(value); !status) return status;
  try {
    for (const auto* const character : {source.get(), target.get()})
      if (const Status status = validate_character(*character); !status) return status;
    if (const Status status = check_stored(*source, options.stored_source, "source"); !status)
      return status;
    if (const Status status = check_stored(*target, options.stored_target, "target"); !status)
      return status;
    Result<BoneMatch> bones = match_bones(source->skeleton, target->skeleton, options.bone_names);
    if (!bones) return bones.error();
    return Validation(source, target, options, std::move(*bones)).run();
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "validate_skin: out of memory");
  }
}

}  // namespace sunder
