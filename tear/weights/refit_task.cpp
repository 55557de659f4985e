#include "tear/weights/refit_task.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "tear/surface/morph_displacement.h"
#include "tear/weights/refit_certificate.h"
#include "tear/weights/refit_skin.h"
#include "tear/weights/refit_surface.h"

namespace sunder::tear {
namespace {

/// Poses kept of a stroke whose pose changes.
constexpr std::size_t kMostPosesOfStroke = 8;

void keep_pose(const PoseSpec& spec, std::vector<ModelPose>& poses) {
  if (const ModelPose* pose = std::get_if<ModelPose>(&spec)) poses.push_back(*pose);
}

/// The poses in which a recorded operation was made.
std::vector<ModelPose> poses_of(const Operation& operation) {
  std::vector<ModelPose> poses;
  if (const auto* tear = std::get_if<TearOperation>(&operation)) {
    keep_pose(tear->pose, poses);
    const std::size_t changes = tear->pose_changes.size(),
                      kept = std::min(changes, kMostPosesOfStroke - 1);
    for (std::size_t i = 0; i < kept; ++i)  // the last one always
      keep_pose(tear->pose_changes[(i + 1) * changes / kept - 1].pose, poses);
  } else if (const auto* cut = std::get_if<CutOperation>(&operation)) {
    keep_pose(cut->pose, poses);
  } else if (const auto* drill = std::get_if<DrillOperation>(&operation)) {
    keep_pose(drill->pose, poses);
  } else if (const auto* weld = std::get_if<WeldOperation>(&operation)) {
    keep_pose(weld->pose, poses);
  }
  return poses;
}

}  // namespace

RefitTask::RefitTask(std::shared_ptr<const Character> from, WeightsOperation wanted,
                     WeightAssignment begin, const EditLog::Mark& since,
                     const SurfaceEditor& editor)
    : source(std::move(from)), operation(std::move(wanted)), assignment(std::move(begin)) {
  const std::vector<double> reach = find_reach(assignment, since, editor);
  points.reserve(assignment.points.size());
  for (const PointWeights& of : assignment.points) {
    const Mesh& mesh = editor.character().meshes[of.vertex.mesh];
    Point& point = points.emplace_back();
    editor.births.describe_exactly(of.vertex, source->rest_morph_weights, point.exact);
    point.skin = mesh.skin;
    point.morph = morph_displacement(mesh, of.vertex.vertex, source->rest_morph_weights);
    point.position = Vec3d(of.position.cast<double>()) + point.morph;
    point.reach = reach[points.size() - 1];
  }
  if (operation.refit.is_coupled) neighbours = find_neighbours(assignment, since, editor);
}

void RefitTask::add_operation(const Operation& of, std::uint64_t serial,
                              std::span<const Index> first_vertices) {
  const auto number = static_cast<Index>(operations.size());
  operations.push_back({serial, {}});
  bool has_points = false;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (assignment.points[i].vertex.vertex >= first_vertices[assignment.points[i].vertex.mesh]) {
      points[i].operation = number;  // unless a later one created it
      has_points = true;
    }
  if (has_points) operations.back().poses = poses_of(of);
}

void RefitTask::run() {
  using State = RefitJob::State;
  State expected = State::waiting;
  if (!state.compare_exchange_strong(expected, State::running)) return;
  try {
    RefitCertificate certificate(*source);
    certify(certificate);
    std::vector<PointFit> fits;
    for (Index skin = 0; skin < source->skins.size() && failure && !is_cancelled; ++skin) {
      auto of_skin = fit(skin, certificate);
      if (of_skin)
        std::move(of_skin->begin(), of_skin->end(), std::back_inserter(fits));
      else
        failure = of_skin.error();
    }
    if (failure && !is_cancelled) store(fits);
  } catch (const std::bad_alloc&) {
    failure = out_of_memory();
  }
  expected = State::running;
  state.compare_exchange_strong(expected, is_cancelled ? State::cancelled
                                          : failure    ? State::done
                                                       : State::failed);
}

void RefitTask::cancel() {
  using State = RefitJob::State;
  is_cancelled = true;
  for (State from : {State::waiting, State::running, State::done})
    state.compare_exchange_strong(from, State::cancelled);
}

/// Certifies the points with barycentric weights.
void RefitTask::certify(RefitCertificate& certificate) {
  for (std::size_t i = 0; i < points.size(); ++i)
    certificate.add(points[i].exact, barycentric(i), points[i].position, points[i].skin);
  const std::vector<double> bounds = certificate.take_bounds();
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].certified = bounds[i];
    if (std::isfinite(bounds[i]))
      report.certified_barycentric = std::max(report.certified_barycentric, bounds[i]);
  }
}

/// Fits the points of a skin.
Result<std::vector<PointFit>> RefitTask::fit(Index skin, RefitCertificate& certificate) const {
  std::vector<std::size_t> of_skin;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].skin == skin) of_skin.push_back(i);
  if (of_skin.empty()) return std::vector<PointFit>();
  SkinRefit refit(*this, skin, std::move(of_skin), certificate);
  if (Status status = refit.run(); !status) return status;
  return refit.take_fits();
}

/// The influences with which a point started.
std::span<const Influence> RefitTask::barycentric(std::size_t point) const {
  const PointWeights& of = assignment.points[point];
  return std::span<const Influence>(assignment.influences)
      .subspan(of.first_influence, of.influence_count);
}

/// Replaces the barycentric weights by the fits that are taken.
void RefitTask::store(const std::vector<PointFit>& fits) {
  std::vector<Influence> fitted;
  for (const PointFit& fit : fits) {
    const std::span<const Influence> influences =
        fit.is_taken ? std::span<const Influence>(fit.influences) : barycentric(fit.point);
    PointWeights& point = assignment.points[fit.point];
    if (fit.is_taken && fit.position != points[fit.point].position)
      point.position = (fit.position - points[fit.point].morph).cast<float>();
    const auto first = static_cast<Index>(fitted.size());
    fitted.insert(fitted.end(), influences.begin(), influences.end());
    point.first_influence = first;
    point.influence_count = static_cast<Index>(influences.size());
    report.refitted += fit.is_taken ? 1 : 0;
    if (std::isfinite(fit.certified))
      report.certified = std::max(report.certified, fit.certified);
    else
      ++report.uncertified;
  }
  assignment.influences.swap(fitted);
}

}  // namespace sunder::tear
