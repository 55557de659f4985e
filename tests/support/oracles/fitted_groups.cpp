#include "support/oracles/fitted_groups.h"

#include <sunder/skinning/deform.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <type_traits>
#include <utility>
#include <variant>

#include "core/internal/ordered.h"
#include "skinning/internal/reference.h"
#include "tear/model/model_access.h"
#include "tear/weights/assign_weights.h"
#include "tear/weights/refit_poses.h"

namespace sunder::test {
namespace {

using ModelState = std::remove_reference_t<decltype(tear::ModelAccess::state_of(
    std::declval<const TornModel&>()))>;

/// A lower gain is a loss.
constexpr double kLeastGain = 1 - 1e-9;

/// Weights and a bind position, as they are stored.
struct StoredSkin {
  Vec3f position = Vec3f::Zero();
  std::vector<Influence> influences;
};

struct FittedPoint {
  tear::VertexRef vertex;
  std::uint32_t operation = 0;
  AnimationPoint exact;
  std::array<StoredSkin, 2> skins;  ///< Barycentric, and fitted.
};

void assign(TornModel& model, const WeightsOperation& wanted) {
  if (const auto report = model.reweigh(wanted); !report) {
    std::fprintf(stderr, "%s\n", report.error().text().data());
    std::abort();
  }
}

class FittedPoints {
 public:
  FittedPoints(TornModel& model, const WeightsOperation& wanted)
      : model_(tear::ModelAccess::state_of(model)), wanted_(wanted) {
    for (std::uint32_t i = 0; i < model_.history.done().size(); ++i) {
      WeightsOperation one;
      one.first_operation = i;
      one.operation_count = 1;
      for (const auto& vertex : tear::interpolated_points(model_.vertices_of(one), model_.editor)) {
        FittedPoint& point = points_.emplace_back(FittedPoint{vertex, i, {}, {}});
        model_.editor.births.describe_exactly(vertex, model_.source->rest_morph_weights,
                                              point.exact);
      }
    }
    WeightsOperation barycentric = wanted;
    barycentric.weights.policy = WeightPolicy::barycentric;
    assign(model, barycentric);
    read_skins(0);
    if (!model.undo()) std::abort();
    assign(model, wanted);
    read_skins(1);
  }

  [[nodiscard]] std::vector<FittedGroup> measure() {
    for (std::uint32_t skin = 0; skin < model_.source->skins.size(); ++skin) measure_skin(skin);
    std::vector<FittedGroup> groups;
    for (const auto& [of, squares] : squares_) {
      const auto count =
          static_cast<double>(std::ranges::count(points_, of.first, &FittedPoint::operation));
      groups.push_back(
          {of.first, of.second, std::sqrt(squares[0] / count), std::sqrt(squares[1] / count)});
    }
    return groups;
  }

 private:
  void read_skins(std::size_t which) {
    for (FittedPoint& point : points_) {
      const Mesh& mesh = model_.character.meshes[point.vertex.mesh];
      const auto influences = mesh.weights.of(point.vertex.vertex);
      point.skins[which] = {mesh.positions[point.vertex.vertex],
                            {influences.begin(), influences.end()}};
    }
  }

  void measure_skin(std::uint32_t skin) {
    std::vector<const FittedPoint*> points;
    std::vector<bool> moves(model_.source->skeleton.bones.size(), false);
    for (const FittedPoint& point : points_) {
      if (model_.character.meshes[point.vertex.mesh].skin != skin) continue;
      points.push_back(&point);
      for (const AnimationPoint::Term& term : point.exact.terms())
        moves[model_.source->skins[skin].bones[term.slot]] = true;
    }
    if (points.empty()) return;
    const auto poses = tear::RefitPoses::create(model_.source, wanted_.refit, moves);
    if (!poses) std::abort();
    ModelPose pose;
    const auto& groups = poses->groups();
    for (std::size_t group = 0; group < groups.size(); ++group)
      for (const std::size_t number : groups[group].poses) {
        if (!poses->compute(number, pose)) std::abort();
        add(points, pose, group,
            poses->weight_of(number) / static_cast<double>(groups[group].poses.size()));
      }
    for (std::uint32_t i = 0; i < model_.history.done().size(); ++i) {
      const auto* tear = std::get_if<TearOperation>(&model_.history.done()[i]->operation);
      if (tear == nullptr || !tear->pose_changes.empty()) continue;
      std::vector<const FittedPoint*> own;
      std::ranges::copy_if(points, std::back_inserter(own),
                           [&](const FittedPoint* point) { return point->operation == i; });
      if (const auto* of = std::get_if<ModelPose>(&tear->pose)) add(own, *of, groups.size(), 1);
    }
  }

  /// Adds the squared errors of some points of one skin in a pose.
  void add(const std::vector<const FittedPoint*>& points, const ModelPose& pose, std::size_t group,
           double share) {
    if (points.empty()) return;
    const Skin& skin =
        model_.source->skins[model_.character.meshes[points.front()->vertex.mesh].skin];
    std::vector<Affine3d> palette(skin.bones.size());
    if (!compute_palette(skin, pose, palette)) std::abort();
    for (const FittedPoint* point : points) {
      const Mesh& mesh = model_.character.meshes[point->vertex.mesh];
      const Eigen::Vector3d exact = point->exact.posed(palette);
      auto& squares = squares_[{point->operation, group}];
      for (std::size_t which = 0; which < squares.size(); ++which) {
        const StoredSkin& of = point->skins[which];
        const Eigen::Vector3d at =
            deform_position_reference(mesh, point->vertex.vertex, of.position, of.influences,
                                      palette, model_.source->rest_morph_weights);
        squares[which] += share * squared_norm(Eigen::Vector3d(at - exact));
      }
    }
  }

  const ModelState& model_;
  const WeightsOperation& wanted_;
  std::vector<FittedPoint> points_;
  /// By operation and group: sums over the points, barycentric and fitted.
  std::map<std::pair<std::uint32_t, std::size_t>, std::array<double, 2>> squares_;
};

}  // namespace

double FittedGroup::gain(double nothing) const {
  return std::max(barycentric, nothing) / std::max(fitted, nothing);
}

std::vector<FittedGroup> refit_and_measure(TornModel& model, const WeightsOperation& wanted) {
  return FittedPoints(model, wanted).measure();
}

std::size_t count_lost(const std::vector<FittedGroup>& groups, double nothing) {
  return static_cast<std::size_t>(std::ranges::count_if(
      groups, [&](const FittedGroup& group) { return group.gain(nothing) < kLeastGain; }));
}

}  // namespace sunder::test
