#include "bench/weights/bounded_refit_time.h"

#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>

#include "bench/harness/measure.h"
#include "tear/internal/mesh_vertices.h"
#include "tear/weights/refit_bounds.h"
#include "weights/internal/point_refit.h"
#include "weights/internal/refit_terms.h"

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
  std::vector<Index> tears;
  std::vector<std::vector<Influence>> barycentric;
  std::vector<double> squares;  ///< Of barycentric weights, points x groups.
  std::vector<AnimationPoint::Term> terms, difference;
  std::vector<double> of_terms;

  void measure(std::size_t i, std::span<const Influence> influences, std::span<double> of_groups) {
    weights::centre_terms(points[i]->exact, by_group, terms);
    weights::weights_of_terms(terms, influences, of_terms);
    weights::differences(terms, of_terms, points[i]->position() - by_group.centre(), difference);
    by_group.mean_squares(difference, of_groups);
  }
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

void set_objective(SkinPoints& skin, std::size_t groups) {
  std::vector<double> factors(groups + 1, 0.0);
  skin.squares.resize(skin.points.size() * groups);
  for (std::size_t i = 0; i < skin.points.size(); ++i) {
    const std::span<double> squares = std::span(skin.squares).subspan(i * groups, groups);
    skin.measure(i, skin.barycentric[i], squares);
    for (std::size_t group = 0; group < groups; ++group) factors[group] += squares[group];
  }
  for (double& factor : factors) factor = factor > 1e-12 ? 1 / factor : 0.0;
  skin.by_group.combine(factors, groups);
}

PointToRefit to_refit(const SkinPoints& skin, std::size_t i) {
  PointToRefit point;
  point.exact = &skin.points[i]->exact;
  point.position = skin.points[i]->position();
  point.barycentric = skin.barycentric[i];
  return point;
}

/// Fits the points of a skin as a refit does: within bounds, which are tightened.
double fit_within_bounds(SkinPoints& skin, std::size_t groups, PointRefit& refit) {
  tear::RefitBounds bounds(groups, skin.tears);
  for (std::size_t i = 0; i < skin.points.size(); ++i)
    for (std::size_t group = 0; group < groups; ++group)
      bounds.set_barycentric(i, group, skin.squares[i * groups + group], 1e-14);
  bounds.begin();
  std::vector<std::size_t> open(skin.points.size());
  std::iota(open.begin(), open.end(), 0u);
  double sum = 0;
  const auto without_doubt = [](std::span<const std::size_t> of, std::size_t) {
    return std::vector<double>(of.size(), 0.0);
  };
  for (; !open.empty(); open = bounds.tighten(without_doubt))
    for (const std::size_t i : open) {
      PointToRefit point = to_refit(skin, i);
      point.allowed = bounds.allowed(i);
      const PointRefit::Fit fit = refit.fit(point, {kInfluences, false, groups}, skin.by_group);
      skin.measure(i, fit.influences, bounds.of_fit(i));
      sum += fit.mean_square;
    }
  return sum;
}

double fit_without_bounds(const SkinPoints& skin, PointRefit& refit) {
  double sum = 0;
  for (std::size_t i = 0; i < skin.points.size(); ++i)
    sum += refit.fit(to_refit(skin, i), {kInfluences, false, 0}, skin.together).mean_square;
  return sum;
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
  for (std::size_t tear = 0; tear < model.tears.size(); ++tear)
    for (const TornPoint& point : model.tears[tear].points) {
      const std::uint32_t of = model.character->meshes[point.mesh].skin;
      SkinPoints& skin =
          skins.try_emplace(of, model.character->skins[of].bones.size(), point.position(), groups)
              .first->second;
      std::vector<Influence> mean(point.influences[0].size() + point.influences[1].size() +
                                  point.influences[2].size());
      const std::size_t count = mean_influences(point.influences, point.barycentric, mean.data());
      mean.resize(prune_influences(std::span(mean).first(count), kInfluences));
      skin.points.push_back(&point);
      skin.tears.push_back(static_cast<Index>(tear));
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
  for (auto& [of, skin] : skins) set_objective(skin, groups);
  PointRefit refit;
  for (const bool is_bounded : {true, false})
    (is_bounded ? time.bounded : time.plain) = microseconds_of(time.points, [&] {
      double sum = 0;
      for (auto& [of, skin] : skins)
        sum +=
            is_bounded ? fit_within_bounds(skin, groups, refit) : fit_without_bounds(skin, refit);
      kept_alive = sum;
    });
  return time;
}

}  // namespace sunder::bench
