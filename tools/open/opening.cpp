#include "tools/open/opening.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/model/history.h"
#include "tools/open/wound_threads.h"
#include "tools/picture/open_lips.h"
#include "tools/picture/taper_wounds.h"

namespace sunder::tools {
namespace {

constexpr int kMostSteps = 180;
constexpr double kTolerance = 0.01;  ///< Of the course: a share that a line may miss.

/// The pose of the last operation that parts a surface.
PoseSpec pose_of_last_tear(std::span<const Operation> history) {
  for (auto operation = history.rbegin(); operation != history.rend(); ++operation)
    if (!pose_specs_of(*operation).empty() &&
        !std::holds_alternative<WeightsOperation>(*operation) &&
        !std::holds_alternative<DetachOperation>(*operation))
      return last_pose_of(*operation);
  return RestPose{};
}

/// Displacements of all points of the lips.
std::vector<Vec3d> lips_of(const GapingModel& model) {
  std::vector<Vec3d> places;
  for (const Wound& wound : model.wounds)
    for (const LipPair& pair : wound.lips) {
      places.push_back(model.instance.body()->point_displacement(pair.left));
      places.push_back(model.instance.body()->point_displacement(pair.right));
    }
  return places;
}

/// The share of each moment: the factor of the last displacements that is nearest to its own.
std::vector<double> shares(const std::vector<std::vector<Vec3d>>& moments) {
  std::vector<double> found;
  for (const std::vector<Vec3d>& moment : moments) {
    double product = 0, square = 0;
    for (std::size_t i = 0; i < moment.size(); ++i) {
      product += moment[i].dot(moments.back()[i]);
      square += moments.back()[i].squaredNorm();
    }
    found.push_back(square > 0 ? product / square : 1.0);
  }
  return found;
}

/// Moments such that lines between them come close to all.
std::vector<Opening::Moment> few_moments(const std::vector<double>& share) {
  std::vector<Opening::Moment> few = {{0, 0}};
  std::size_t from = 0;
  while (from + 1 < share.size()) {
    std::size_t to = from + 1;
    const auto is_straight = [&](std::size_t end) {
      for (std::size_t i = from + 1; i < end; ++i) {
        const double t = static_cast<double>(i - from) / static_cast<double>(end - from);
        if (std::abs(share[from] + t * (share[end] - share[from]) - share[i]) > kTolerance)
          return false;
      }
      return true;
    };
    while (to + 1 < share.size() && is_straight(to + 1)) ++to;
    few.push_back({static_cast<double>(to) * kPictureStep, share[to]});
    from = to;
  }
  // What moves by less than the tolerance is at rest.
  while (few.size() > 2 && std::abs(few[few.size() - 2].share - 1) < kTolerance) few.pop_back();
  few.back().share = 1;
  return few;
}

}  // namespace

Result<Opening> measure_opening(std::shared_ptr<const Character> character,
                                std::span<const Operation> history,
                                const AuthoredTissue& authored) {
  Opening opening;
  const Result<ModelPose> pose = make_pose(*character, pose_of_last_tear(history));
  if (!pose) return pose.error();
  opening.pose = *pose;
  Result<GapingModel> model = make_gaping_model(std::move(character), history, *pose, authored);
  if (!model) return model.error();
  CharacterInstance& instance = model->instance;
  Tension tension = std::exchange(model->tension, {});
  if (const Status status = instance.body()->set_tension({}); !status) return status;
  if (const Status status = instance.advance(*pose, 0); !status) return status;
  if (const Status status = instance.draw(); !status) return status;
  opening.closed = drawn(instance);
  if (const Status status = instance.body()->set_tension(std::move(tension)); !status)
    return status;
  std::vector<std::vector<Vec3d>> moments = {lips_of(*model)};
  for (int i = 0; i < kMostSteps; ++i) {
    if (const Status status = instance.advance(*pose, kPictureStep); !status) return status;
    moments.push_back(lips_of(*model));
    if (instance.body()->awake_count() == 0) break;
  }
  if (const Status status = instance.draw(); !status) return status;
  opening.open = drawn(instance);
  taper_wounds(instance, model->wounds, opening.closed, opening.open);
  std::vector<DeformedMesh> closed = opening.closed;  // Meshes may lack normals.
  mend_normals(instance.character(), closed);
  opening.walls = make_wound_walls(*instance.model(), model->wounds, closed, opening.open);
  std::vector<DeformedMesh> open = opening.open;
  mend_normals(instance.character(), open);
  opening.threads =
      make_wound_threads(*instance.model(), thread_loads(*instance.body()), closed, open);
  opening.course = few_moments(shares(moments));
  for (const Wound& wound : model->wounds) {
    opening.gaps.push_back(widest_gap(instance, wound));
    opening.widest_gap = std::max(opening.widest_gap, opening.gaps.back());
  }
  return opening;
}

}  // namespace sunder::tools
