#include "bench/weights/weights_times.h"

#include <sunder/weights/influences.h>

#include <algorithm>
#include <cstdlib>

#include "bench/harness/measure.h"
#include "tear/internal/mesh_vertices.h"
#include "weights/internal/bind_position.h"

namespace sunder::bench {
namespace {

constexpr Effort kTimedEffort = {400, 0.5, 20};

/// A value that the compiler cannot optimise away.
volatile double kept_sum;

std::size_t mean_of(const TornPoint& point, std::size_t maximum, std::vector<Influence>& mean) {
  const std::size_t count = mean_influences(point.influences, point.barycentric, mean.data());
  return maximum == 0 ? count : prune_influences(std::span(mean).first(count), maximum);
}

void describe(const TornPoint& point, AnimationPoint& exact) {
  exact.clear();
  for (std::size_t k = 0; k < 3; ++k)
    exact.add(point.barycentric[k], point.positions[k], point.influences[k]);
}

template <class Work>
double microseconds_of(std::size_t points, Work work) {
  const auto seconds = sample(kTimedEffort, [&] { return seconds_of(work); });
  return 1e6 * *std::min_element(seconds.begin(), seconds.end()) / static_cast<double>(points);
}

}  // namespace

PointsToWeigh::PointsToWeigh(const WeightsModel& model, std::span<const ModelPose> poses) {
  const Character& character = *model.character;
  std::vector<Influence> mean;
  const auto kept = [&](const TornPoint& point, std::size_t maximum) {
    const std::size_t count = mean_of(point, maximum, mean);
    return std::vector<Influence>(mean.begin(), mean.begin() + static_cast<std::ptrdiff_t>(count));
  };
  std::map<std::uint32_t, std::pair<Eigen::Vector3d, double>> sums;  // positions by skin
  for (const TornOnce& torn : model.tears)
    for (const TornPoint& point : torn.points) {
      const std::uint32_t skin = character.meshes[point.mesh].skin;
      mean.resize(std::max(mean.size(), point.influences[0].size() + point.influences[1].size() +
                                            point.influences[2].size()));
      points_.push_back({&point, skin, kept(point, 0), kept(point, 4), kept(point, 8)});
      auto& [sum, count] = sums.try_emplace(skin, Eigen::Vector3d::Zero(), 0.0).first->second;
      sum += point.position();
      ++count;
    }
  for (const auto& [skin, sum] : sums)
    moments_.try_emplace(skin, character.skins[skin].bones.size(), Vec3d(sum.first / sum.second));
  for (const Point& point : points_) moments_.at(point.skin).want(point.torn->exact);
  for (const ModelPose& pose : poses) {
    const auto palettes = palettes_of(character, pose);
    for (auto& [skin, moments] : moments_) {
      moments.add(palettes[skin]);
      palettes_[skin].push_back(palettes[skin]);
    }
  }
}

PointToRefit PointsToWeigh::to_refit(std::size_t i, std::size_t maximum) const {
  const Point& of = points_[i];
  return {&of.torn->exact, of.torn->position(),
          maximum == 0   ? of.barycentric
          : maximum == 4 ? of.pruned
                         : of.pruned_to_8};
}

double PointsToWeigh::microseconds(const WeightOptions& options) const {
  std::size_t most = 0;
  for (const Point& point : points_)
    most = std::max(most, point.torn->influences[0].size() + point.torn->influences[1].size() +
                              point.torn->influences[2].size());
  std::vector<Influence> mean(most);
  AnimationPoint exact;
  PointRefit refit;
  return microseconds_of(points_.size(), [&] {
    double sum = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const TornPoint& point = *points_[i].torn;
      const auto influences =
          std::span<const Influence>(mean).first(mean_of(point, options.maximum_influences, mean));
      sum += static_cast<double>(influences[0].weight);
      if (options.policy == WeightPolicy::barycentric) continue;
      describe(point, exact);
      sum += exact.terms()[0].q.x();
      if (options.policy == WeightPolicy::exact) continue;
      if (options.policy == WeightPolicy::pose_exact) {
        const std::vector<Affine3d>& palette = palettes(i)[0];
        if (const auto bind = solve_bind_position(influences, exact.posed(palette), palette))
          sum += bind->x();
      } else {
        sum += refit
                   .fit({&exact, point.position(), influences}, {options.maximum_influences, true},
                        moments(i))
                   .mean_square;
      }
    }
    kept_sum = sum;
  });
}

double PointsToWeigh::fit_microseconds(const PointRefit::Options& options,
                                       std::span<const std::size_t> points) const {
  std::vector<PointToRefit> inputs;
  for (const std::size_t i : points) inputs.push_back(to_refit(i, options.maximum_influences));
  PointRefit refit;
  return microseconds_of(points.size(), [&] {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      sum += refit.fit(inputs[i], options, moments(points[i])).mean_square;
    kept_sum = sum;
  });
}

std::vector<ModelPose> some_of(std::span<const ModelPose> poses, std::size_t count) {
  std::vector<ModelPose> some;
  for (std::size_t i = 0; i < std::min(count, poses.size()); ++i)
    some.push_back(poses[i * poses.size() / std::min(count, poses.size())]);
  return some;
}

}  // namespace sunder::bench
