#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "pipeline/plan/choose_tracks.h"
#include "pipeline/plan/find_obstacles.h"

namespace sunder::plan {
namespace {

constexpr std::size_t kMostTracks = 10;  ///< That are followed.
constexpr std::size_t kBestTracks = 3;
/// Cost of a change of values by one from a sample to the next, and of speeds at their limits.
constexpr double kChange = 1e-2, kAtSpeedLimit = 1;

double change_cost(const Values& change, double seconds, const Values& speed_limits) {
  double cost = kChange * change.squaredNorm();
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    const double share = std::abs(change[i]) / (seconds * speed_limits[i]);
    cost += kAtSpeedLimit * share * share * share * share;
  }
  return cost;
}

}  // namespace

double depth_of_links(BladeChain& chain, const Clearance& clearance, const Track& track) {
  double inside = 0;
  for (std::size_t i = 0; i < clearance.instants() && clearance.is_needed(); ++i)
    inside -= std::min(
        0.0, clearance.least_distance(chain, i, track.values[clearance.sample_of(i)], 0.0));
  return inside;
}

std::vector<Track> follow_tracks(BladeChain& chain, const TrackSearch& search) {
  const std::span<const TargetSample> samples = search.samples;
  std::vector<std::pair<double, Track>> tracks;  // and their costs
  const auto half = std::find_if(samples.begin(), samples.end(),
                                 [](const TargetSample& sample) { return sample.share >= 0.5; });
  // So that neither end is far from a solution.
  const std::size_t middle =
      half == samples.end() ? 0 : static_cast<std::size_t>(half - samples.begin());
  std::vector<Values> starts =
      solutions_of(chain, samples[middle], search.scales, search.limits.values, search.seeds);
  if (starts.size() > kMostTracks) starts.resize(kMostTracks);
  for (const Values& start : starts) {
    double cost = 0;
    Track track;
    track.values.resize(samples.size());
    for (const TargetSample& sample : samples) track.handles.push_back(sample.handle);
    const auto follow = [&](std::size_t i, std::size_t before, const Values& from) {
      track.values[i] = from;
      cost += solve_sample(chain, samples[i], search.scales, search.limits.values, track.values[i]);
      if (i == before) return;
      const double seconds = std::abs(samples[i].time - samples[before].time);
      cost += change_cost(track.values[i] - from, seconds, search.limits.speed);
    };
    follow(middle, middle, start);
    for (std::size_t i = middle; i-- > 0;) follow(i, i + 1, track.values[i + 1]);
    for (std::size_t i = middle + 1; i < samples.size(); ++i) follow(i, i - 1, track.values[i - 1]);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (samples[i].depth > 0 && !is_reached(chain, samples[i], track.values[i], search.tolerance))
        ++track.missed;
    track.inside = depth_of_links(chain, search.clearance, track);
    tracks.emplace_back(cost, std::move(track));
  }
  std::stable_sort(tracks.begin(), tracks.end(), [](const auto& a, const auto& b) {
    return std::tie(a.second.missed, a.second.inside, a.first) <
           std::tie(b.second.missed, b.second.inside, b.first);
  });
  std::vector<Track> best;
  for (std::size_t i = 0; i < std::min(tracks.size(), kBestTracks); ++i)
    best.push_back(std::move(tracks[i].second));
  return best;
}

}  // namespace sunder::plan
