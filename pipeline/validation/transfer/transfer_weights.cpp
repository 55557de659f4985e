#include <sunder/validation/transfer.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "core/internal/bone_sides.h"
#include "core/internal/out_of_memory.h"
#include "pipeline/validation/internal/option_ranges.h"
#include "pipeline/validation/match/skin_difference.h"
#include "pipeline/validation/transfer/finish_rows.h"
#include "pipeline/validation/transfer/inpaint.h"
#include "pipeline/validation/transfer/regions.h"
#include "pipeline/validation/transfer/target_bones.h"
#include "pipeline/validation/transfer/target_points.h"
#include "pipeline/validation/transfer/transfer_findings.h"

namespace sunder {
namespace {

using namespace validation;

Status check_options(const TransferOptions& options, const Character& target) {
  if (const Status status = validation::kAngleDegrees.check_degrees(options.angle); !status)
    return status;
  for (const auto& [range, value] :
       {std::pair(validation::kDistance, options.distance),
        std::pair(validation::kSmoothness, options.smoothness),
        std::pair(validation::kSmoothingStrength, options.smoothing_strength),
        std::pair(validation::kMix, options.mix)})
    if (const Status status = range.check(value); !status)
      return Status::failure(status.code(), kNone, "transfer_weights: %s",
                             std::string(status.text()).c_str());
  if (!options.locked.empty() && options.locked.size() != target.meshes.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "transfer_weights: locked has %zu meshes, the target %zu",
                           options.locked.size(), target.meshes.size());
  for (Index m = 0; m < options.locked.size(); ++m)
    if (!options.locked[m].empty() && options.locked[m].size() != target.meshes[m].vertex_count())
      return Status::failure(StatusCode::size_mismatch, m,
                             "transfer_weights: locked has %zu vertices of mesh %u, it has %u",
                             options.locked[m].size(), m, target.meshes[m].vertex_count());
  return {};
}

Result<std::vector<bool>> chosen_bones(const Character& source, const TransferOptions& options) {
  const auto& bones = source.skeleton.bones;
  std::vector<bool> is_chosen(bones.size(), options.bones.empty());
  for (Index i = 0; i < options.bones.size(); ++i) {
    const auto found = std::ranges::find(bones, options.bones[i], &Bone::name);
    if (found == bones.end())
      return Status::failure(StatusCode::not_found, i, "the source has no bone '%.80s'",
                             options.bones[i].c_str());
    is_chosen[static_cast<std::size_t>(found - bones.begin())] = true;
  }
  return is_chosen;
}

/// Everything that a transfer computes before it writes.
class Transfer {
 public:
  Transfer(const Character& source, const Character& target, const TransferOptions& options,
           const BoneMatch& match, std::vector<bool> is_chosen)
      : source_(source),
        target_(target),
        options_(options),
        match_(match),
        bones_(choose_bones(source, target, match)),
        from_(make_bind_surface(source)),
        to_(make_bind_surface(target)),
        is_chosen_(std::move(is_chosen)) {}

  Result<TransferResult> run() {
    limits_ = {options_.distance * to_.diagonal, std::cos(options_.angle), options_.flip_normals};
    if (const Status status = choose_sides(); !status) return status;
    match();
    if (const Status status = refuse_nothing(); !status) return status;
    choose_states();
    TransferResult result = describe();
    if (options_.dry_run) {
      result.character = target_;
      return result;
    }
    if (!fill())
      return Status::failure(StatusCode::internal_error, kNone,
                             "transfer_weights: the matrix of the points to fill is singular");
    FinishedRows finished = finish_rows(unfinished_rows(), finish_rules());
    result.steps = std::move(finished.steps);
    write(finished.rows, result.character);
    return result;
  }

 private:
  Status choose_sides();
  void match();
  Status refuse_nothing() const;
  void choose_states();
  [[nodiscard]] std::vector<Vec3d> unit_positions() const;
  bool fill();
  [[nodiscard]] UnfinishedRows unfinished_rows();
  [[nodiscard]] FinishRules finish_rules() const;
  void write(const std::vector<WeightRow>& rows, Character& character) const;
  TransferResult describe();
  void describe_vertices(TransferResult& result) const;

  [[nodiscard]] bool is_locked(Index vertex) const {
    if (options_.locked.empty()) return false;
    const Index mesh = to_.mesh_of_vertex(vertex);
    return !options_.locked[mesh].empty() && options_.locked[mesh][vertex - to_.first_vertex[mesh]];
  }
  [[nodiscard]] WeightRow own_row(Index vertex) const {
    const Index mesh = to_.mesh_of_vertex(vertex);
    return own_rows_[mesh][vertex - to_.first_vertex[mesh]];
  }
  [[nodiscard]] MatchRegions regions() const;
  void interpolate();
  void represent_points();

  const Character& source_;
  const Character& target_;
  const TransferOptions& options_;
  const BoneMatch& match_;
  TargetBones bones_;
  BindSurface from_, to_;
  std::vector<bool> is_chosen_;  ///< Per bone of the source.
  MatchLimits limits_;
  std::optional<SidePlane> plane_;
  std::vector<int> side_of_bone_;  ///< Per bone of the result.

  SurfaceMatches matches_;
  std::vector<std::vector<WeightRow>> own_rows_;  ///< Per mesh and vertex of the target.
  std::vector<WeightRow> matched_rows_;           ///< Per vertex.
  TargetPoints points_;
  Parts parts_;
  std::vector<Index> representative_;  ///< Per point: the vertex whose match counts.
  std::vector<bool> is_point_locked_, part_has_match_;
  std::vector<PointState> states_;
  std::vector<WeightRow> rows_;  ///< Per point.
  std::vector<bool> is_filled_;  ///< Per point: continued or smoothed.
  Laplacian laplacian_;          ///< Empty where nothing is filled.
};

Status Transfer::choose_sides() {
  side_of_bone_.assign(bones_.skeleton.bones.size(), 0);
  if (!options_.keep_sides_apart) return {};
  plane_ = find_side_plane(source_);
  if (!plane_)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "keep_sides_apart: the source has no pair of bones named left and "
                           "right");
  for (Index bone = 0; bone < source_.skeleton.bones.size(); ++bone)
    if (const int side = side_of_name(source_.skeleton.bones[bone].name);
        side != 0 && bones_.of_source[bone] != kNone)
      side_of_bone_[bones_.of_source[bone]] = side;
  return {};
}

constexpr double kMirrorBand = 1e-3;  ///< Of the diagonal of the source: neither left nor right.

MatchRegions Transfer::regions() const {
  MatchRegions regions;
  if (options_.isolate_parts) {
    const auto parts_of = [](const BindSurface& surface) {
      std::vector<Triangle> triangles = surface.triangles;
      for (Triangle& triangle : triangles)
        for (Index& corner : triangle) corner = surface.weld.point_of_vertex[corner];
      return find_parts(surface.weld.point_count, triangles);
    };
    const Parts of_source = parts_of(from_), of_target = parts_of(to_);
    for (const Triangle& triangle : from_.triangles)
      regions.source_part.push_back(of_source.of[from_.weld.point_of_vertex[triangle[0]]]);
    for (const Index point : to_.weld.point_of_vertex)
      regions.target_part.push_back(of_target.of[point]);
  }
  if (!plane_) return regions;
  std::vector<int> side_of_bone, side_of_vertex;
  for (const Bone& bone : source_.skeleton.bones) side_of_bone.push_back(side_of_name(bone.name));
  for (Index m = 0; m < source_.meshes.size(); ++m)
    for (const WeightRow& row : rows_of(source_, m, {})) {
      double balance[3] = {0, 0, 0};
      for (const BoneWeight& entry : row) balance[1 + side_of_bone[entry.bone]] += entry.weight;
      side_of_vertex.push_back(balance[0] > 0.5 ? -1 : balance[2] > 0.5 ? 1 : 0);
    }
  for (const auto& [a, b, c] : from_.triangles) {
    const int sum = side_of_vertex[a] + side_of_vertex[b] + side_of_vertex[c];
    regions.source_side.push_back(sum < 0 ? -1 : sum > 0 ? 1 : 0);
  }
  for (const Vec3d& position : to_.positions)
    regions.target_side.push_back(plane_->side_of(position, kMirrorBand * from_.diagonal));
  return regions;
}

void Transfer::match() {
  matches_ = match_in_regions(to_, from_, limits_, regions());
  for (Index m = 0; m < target_.meshes.size(); ++m) own_rows_.push_back(rows_of(target_, m, {}));
  interpolate();
  points_ = make_points(to_, matches_.matches, matched_rows_);
  parts_ = find_parts(points_.count(), points_.triangles);
  represent_points();
}

void Transfer::interpolate() {
  std::vector<std::vector<WeightRow>> source_rows;
  for (Index m = 0; m < source_.meshes.size(); ++m)
    source_rows.push_back(rows_of(source_, m, bones_.of_source));
  matched_rows_.resize(to_.positions.size());
  for (Index v = 0; v < to_.vertex_count(); ++v) {
    const SurfaceMatch& match = matches_.matches[v];
    if (match.mesh == kNone) continue;
    const Triangle& triangle = source_.meshes[match.mesh].triangles[match.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(match.barycentric[k] > 0)) continue;
      const WeightRow& row = source_rows[match.mesh][triangle[k]];
      if (match.barycentric[k] == 1)
        matched_rows_[v] = row;
      else
        add(matched_rows_[v], match.barycentric[k], row);
    }
  }
}

void Transfer::represent_points() {
  const auto key = [&](Index v) {
    const SurfaceMatch& match = matches_.matches[v];
    return std::tuple(!match.is_accepted, match.distance, match.mesh, match.triangle);
  };
  representative_ = points_.first_vertex;
  is_point_locked_.assign(points_.count(), false);
  for (Index v = 0; v < to_.vertex_count(); ++v) {
    const Index point = points_.point_of_vertex[v];
    if (key(v) < key(representative_[point])) representative_[point] = v;
    if (is_locked(v)) is_point_locked_[point] = true;
  }
}

Status Transfer::refuse_nothing() const {
  if (matches_.counts.accepted > 0) return {};
  if (matches_.matches.empty())
    return Status::failure(StatusCode::empty_input, kNone, "the target has no vertex");
  if (matches_.counts.impossible > 0)
    return Status::failure(StatusCode::empty_input, kNone,
                           "the source has no triangle with an area");
  double nearest = matches_.matches[0].distance;
  for (const SurfaceMatch& match : matches_.matches) nearest = std::min(nearest, match.distance);
  return Status::failure(
      StatusCode::not_found, kNone,
      "no vertex of the target matches the source: %u are farther than %g m "
      "(the nearest is %g m away), %u have normals that disagree; are both in the "
      "same place and unit?",
      matches_.counts.too_far, limits_.distance, nearest, matches_.counts.turned_away);
}

void Transfer::choose_states() {
  part_has_match_.assign(parts_.count, false);
  rows_.resize(points_.count());
  states_.assign(points_.count(), PointState::ignored);
  const bool inpaints = options_.method == TransferMethod::inpainting;
  for (Index point = 0; point < points_.count(); ++point)
    if (is_point_locked_[point] || matches_.matches[representative_[point]].is_accepted)
      part_has_match_[parts_.of[point]] = true;
  for (Index point = 0; point < points_.count(); ++point) {
    const Index vertex = representative_[point];
    const bool is_known = is_point_locked_[point] || matches_.matches[vertex].is_accepted;
    if (is_known)
      states_[point] = PointState::fixed;
    else if (inpaints && part_has_match_[parts_.of[point]])
      states_[point] = PointState::unknown;
    rows_[point] = matched_rows_[vertex];
  }
  for (Index v = to_.vertex_count(); v-- > 0;)
    if (is_locked(v)) rows_[points_.point_of_vertex[v]] = own_row(v);
}

/// The places of the points in units of the target's diagonal, so that the balance of the two terms
/// of the energy does not depend on the unit.
std::vector<Vec3d> Transfer::unit_positions() const {
  std::vector<Vec3d> positions = points_.positions;
  for (Vec3d& position : positions) position /= to_.diagonal > 0 ? to_.diagonal : 1.0;
  return positions;
}

bool Transfer::fill() {
  is_filled_.assign(points_.count(), false);
  if (laplacian_.mass.empty()) return true;
  if (!inpaint(laplacian_, options_.smoothness, states_, rows_)) return false;
  for (Index point = 0; point < points_.count(); ++point)
    is_filled_[point] = states_[point] == PointState::unknown;
  if (options_.smoothing_sweeps == 0) return true;
  std::vector<bool> is_smoothed =
      points_near_unknown(laplacian_, unit_positions(), states_, options_.distance);
  for (Index point = 0; point < points_.count(); ++point) {
    if (is_point_locked_[point]) is_smoothed[point] = false;
    if (is_smoothed[point]) is_filled_[point] = true;
  }
  smooth(laplacian_, is_smoothed, options_.smoothing_sweeps, options_.smoothing_strength, rows_);
  return true;
}

UnfinishedRows Transfer::unfinished_rows() {
  UnfinishedRows unfinished{std::move(rows_), {}, {}, {}, is_filled_, is_point_locked_};
  for (Index point = 0; point < points_.count(); ++point) {
    unfinished.fallback.push_back(matched_rows_[representative_[point]]);
    unfinished.own.push_back(own_row(representative_[point]));
    unfinished.side.push_back(
        plane_ ? plane_->side_of(points_.positions[point], kMirrorBand * from_.diagonal) : 0);
  }
  return unfinished;
}

FinishRules Transfer::finish_rules() const {
  FinishRules rules;
  rules.side_of_bone = side_of_bone_;
  rules.is_chosen.assign(bones_.skeleton.bones.size(), options_.bones.empty());
  for (Index bone = 0; bone < is_chosen_.size(); ++bone)
    if (is_chosen_[bone] && bones_.of_source[bone] != kNone)
      rules.is_chosen[bones_.of_source[bone]] = true;
  rules.mix = options_.mix;
  rules.maximum_influences = options_.maximum_influences;
  return rules;
}

void Transfer::write(const std::vector<WeightRow>& rows, Character& character) const {
  character = target_;
  character.skeleton = bones_.skeleton;
  std::vector<std::vector<WeightRow>> of_meshes(target_.meshes.size());
  for (Index m = 0; m < target_.meshes.size(); ++m)
    for (Index v = to_.first_vertex[m]; v < to_.first_vertex[m + 1]; ++v)
      of_meshes[m].push_back(is_locked(v) ? WeightRow() : rows[points_.point_of_vertex[v]]);
  write_rows(bones_, of_meshes, character);
}

void Transfer::describe_vertices(TransferResult& result) const {
  result.outcomes.resize(target_.meshes.size());
  const auto outcome_of = [&](Index v) {
    const SurfaceMatch& match = matches_.matches[v];
    if (is_locked(v)) return TransferOutcome::locked;
    switch (states_[points_.point_of_vertex[v]]) {
      case PointState::unknown: return TransferOutcome::inpainted;
      case PointState::ignored: return TransferOutcome::nearest;
      case PointState::fixed: break;
    }
    const bool is_vertex =
        match.is_accepted && match.distance == 0 && std::ranges::count(match.barycentric, 1.0) == 1;
    return is_vertex ? TransferOutcome::coincident : TransferOutcome::matched;
  };
  for (Index m = 0; m < target_.meshes.size(); ++m)
    for (Index v = to_.first_vertex[m]; v < to_.first_vertex[m + 1]; ++v) {
      const TransferOutcome outcome = outcome_of(v);
      result.outcomes[m].push_back(outcome);
      std::uint32_t* const counts[] = {&result.coincident, &result.matched, &result.inpainted,
                                       &result.nearest, &result.locked};
      ++*counts[static_cast<std::size_t>(outcome)];
      const SurfaceMatch& match = matches_.matches[v];
      if (!match.is_accepted && !is_locked(v))
        ++(match.distance > limits_.distance ? result.too_far : result.turned_away);
    }
}

TransferResult Transfer::describe() {
  if (std::ranges::count(states_, PointState::unknown) > 0)
    laplacian_ = make_laplacian(unit_positions(), points_.triangles);
  TransferResult result;
  result.vertices = to_.vertex_count();
  describe_vertices(result);
  result.largest_distance = limits_.distance;
  result.points = points_.count();
  result.parts = parts_.count;
  result.parts_without_match = static_cast<Index>(std::ranges::count(part_has_match_, false));
  result.edges = laplacian_.edges;
  result.clamped_edges = laplacian_.clamped_edges;
  result.floored_points = laplacian_.floored_points;
  result.has_adopted_skeleton = bones_.has_adopted;
  result.bone_of_source = bones_.counterparts;
  if (!bones_.has_adopted)
    for (Index bone = 0; bone < match_.kind.size(); ++bone)
      if (match_.kind[bone] == BoneMatchKind::fuzzy)
        result.fuzzy_bones.push_back({target_.skeleton.bones[bone].name,
                                      source_.skeleton.bones[match_.source_of_target[bone]].name});
  add_findings({source_, target_, bones_, to_, points_, parts_, part_has_match_}, result);
  return result;
}

}  // namespace

Result<TransferResult> transfer_weights(const Character& source, const Character& target,
                                        const TransferOptions& options) {
  return or_out_of_memory([&]() -> Result<TransferResult> {
    for (const Character* const character : {&source, &target})
      if (const Status status = validate_character(*character); !status) return status;
    if (const Status status = check_options(options, target); !status) return status;
    const Result<BoneMatch> match =
        match_bones(source.skeleton, target.skeleton, options.bone_names);
    if (!match) return match.error();
    const Result<std::vector<bool>> chosen = chosen_bones(source, options);
    if (!chosen) return chosen.error();
    return Transfer(source, target, options, *match, *chosen).run();
  });
}

}  // namespace sunder
