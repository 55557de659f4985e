#include "bench/bounded_refit_time.h"

#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "bench/measure.h"
#include "tear/surface/mesh_vertices.h"
#include "weights/internal/point_refit.h"

namespace sunder::bench {
namespace {

constexpr Effort kEffort = {200, 0.3, 10};
constexpr std::uint32_t kInfluences = 4;

volatile double kept_alive;

/// The points of one skin, with moments by group and, last, the sum that is minimised; and with
/// those of all poses as one group.
struct SkinPoints {
  SkinPoints(std::size_t slots, const Vec3d& centre, std::size_t groups)
      : by_group(slots, centre, groups + 1), together(slots, centre) {}

  PoseMoments by_group, together;
  std::vector<const TornPoint*> points;
  std::vector<std::vector<Influence>> barycentric;
  std::vector<double> bounds;  ///< Points x groups.
};

std::vector<std::vector<ModelPose>> poses_by_group(const WeightsModel& model) {
  const auto rest = rest_pose(*model.character);
  PoseSetSpec spec;
  spec.range_of_motion = true;
  const auto set = PoseSet::create(model.character, spec);
  if (!rest || !set) std::abort();
  std::vector<std::vector<ModelPose>> groups = {{*rest}};
  std::vector<PoseSet::Group> kinds = {{}};
  for (std::size_t i = 0; i < set->size(PoseSet::Role::fit); ++i) {
    const PoseSet::Group kind = set->group_of(PoseSet::Role::fit, i);
    const auto known = std::find(kinds.begin() + 1, kinds.end(), kind);
    const auto group = static_cast<std::size_t>(known - kinds.begin());
    if (known == kinds.end()) {
      kinds.push_back(kind);
      groups.emplace_back();
    }
    if (!set->compute(PoseSet::Role::fit, i, groups[group].emplace_back())) std::abort();
  }
  return groups;
}

void add_bounds(SkinPoints& skin, std::size_t groups) {
  std::vector<double> factors(groups + 1, 0.0);
  std::vector<AnimationPoint::Term> difference;
  for (std::size_t i = 0; i < skin.points.size(); ++i) {
    const TornPoint& point = *skin.points[i];
    difference.clear();
    for (const AnimationPoint::Term& term : point.exact.terms()) {
      double weight = 0;
      for (const Influence& influence : skin.barycentric[i])
        if (influence.slot == term.slot) weight = static_cast<double>(influence.weight);
      Vec4d q = -term.q;
      q.head<3>() += term.q.w() * skin.by_group.centre() +
                     weight * (point.position() - skin.by_group.centre());
      q.w() += weight;
      difference.push_back({term.slot, q});
    }
    skin.bounds.resize(skin.bounds.size() + groups);
    const std::span<double> bounds = std::span(skin.bounds).last(groups);
    skin.by_group.mean_squares(difference, bounds);
    for (std::size_t group = 0; group < groups; ++group) {
      factors[group] += bounds[group];
      bounds[group] = 1.0001 * bounds[group] + 1e-14;
    }
  }
  for (double& factor : factors) factor = factor > 1e-12 ? 1 / factor : 0.0;
  skin.by_group.combine(factors, groups);
}

template <class Work>
double microseconds_of(std::size_t points, const Work& work) {
  const auto seconds = sample(kEffort, [&] { return seconds_of(work); });
  return 1e6 * *std::min_element(seconds.begin(), seconds.end()) / static_cast<double>(points);
}

}  // namespace

BoundedRefitTime measure_bounded_refit(const WeightsModel& model) {
  const auto poses = poses_by_group(model);
  const std::size_t groups = poses.size();
  std::map<std::uint32_t, SkinPoints> skins;
  BoundedRefitTime time{0, groups, 0, 0};
  for (const TornOnce& torn : model.tears)
    for (const TornPoint& point : torn.points) {
      const std::uint32_t of = model.character->meshes[point.mesh].skin;
      SkinPoints& skin =
          skins.try_emplace(of, model.character->skins[of].bones.size(), point.position(), groups)
              .first->second;
      std::vector<Influence> mean(point.influences[0].size() + point.influences[1].size() +
                                  point.influences[2].size());
      const std::size_t count = mean_influences(point.influences, point.barycentric, mean.data());
      mean.resize(prune_influences(std::span(mean).first(count), kInfluences));
      skin.points.push_back(&point);
      skin.barycentric.push_back(std::move(mean));
      skin.by_group.want(point.exact);
      skin.together.want(point.exact);
      ++time.points;
    }
  for (std::size_t group = 0; group < groups; ++group)
    for (const ModelPose& pose : poses[group]) {
      const auto palettes = palettes_of(*model.character, pose);
      for (auto& [of, skin] : skins) {
        skin.by_group.add(palettes[of], group);
        skin.together.add(palettes[of]);
      }
    }
  for (auto& [of, skin] : skins) add_bounds(skin, groups);
  PointRefit refit;
  for (const bool is_bounded : {true, false})
    (is_bounded ? time.bounded : time.plain) = microseconds_of(time.points, [&] {
      double sum = 0;
      for (auto& [of, skin] : skins)
        for (std::size_t i = 0; i < skin.points.size(); ++i) {
          PointToRefit point;
          point.exact = &skin.points[i]->exact;
          point.position = skin.points[i]->position();
          point.barycentric = skin.barycentric[i];
          if (is_bounded) point.allowed = std::span(skin.bounds).subspan(i * groups, groups);
          sum += refit
                     .fit(point, {kInfluences, false, is_bounded ? groups : 0},
                          is_bounded ? skin.by_group : skin.together)
                     .mean_square;
        }
      kept_alive = sum;
    });
  return time;
}

}  // namespace sunder::bench
