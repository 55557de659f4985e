// Compares refits with other ways to fit weights to example poses, on the same points and poses.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "bench/weights/refit_contest.h"

namespace sunder::bench {
namespace {

constexpr const char* kHelp =
    "bench_refits [--random-rigs N] [--seeds N]\n"
    "\n"
    "Fits the points of four tears per rig, at most 4 influences, over a random half of the rig's\n"
    "clips, and measures them over the other half: clips that no method has seen. Every method\n"
    "gets the same points, candidate bones and poses. A gain is the root mean square error of\n"
    "barycentric weights divided by that of the fits. Prints one table: quartiles over the rigs,\n"
    "each as the mean over the seeds and their standard deviation.\n"
    "  --random-rigs N  random rigs besides the files with two clips or more; 60\n"
    "  --seeds N        seeds of the tears and of the choice of clips; 5\n";

/// Of the methods on all rigs, by one seed.
struct OfSeed {
  std::vector<MethodGains> rigs;
};

/// The value below which a share of the values lies.
double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (at - static_cast<double>(low)) * (values[high] - values[low]);
}

/// Prints the mean and the standard deviation over the seeds of a figure.
template <class Figure>
void print_over_seeds(const std::vector<OfSeed>& seeds, int digits, const Figure& figure) {
  std::vector<double> values;
  double mean = 0, square = 0;
  for (const OfSeed& seed : seeds) mean += values.emplace_back(figure(seed));
  mean /= static_cast<double>(values.size());
  for (const double value : values) square += (value - mean) * (value - mean);
  const double deviation =
      values.size() > 1 ? std::sqrt(square / static_cast<double>(values.size() - 1)) : 0.0;
  std::printf(" %.*f ± %.*f |", digits, mean, digits, deviation);
}

std::vector<double> of_rigs(const OfSeed& seed, std::size_t method, double MethodGain::*figure) {
  std::vector<double> values;
  for (const MethodGains& rig : seed.rigs) values.push_back(rig.methods[method].*figure);
  return values;
}

void print_method(const std::vector<OfSeed>& seeds, std::size_t method) {
  std::printf("| %s |", method_names()[method].c_str());
  print_over_seeds(seeds, 2, [&](const OfSeed& seed) {
    return quantile(of_rigs(seed, method, &MethodGain::fitted), 0.5);
  });
  for (const double share : {0.25, 0.5, 0.75})
    print_over_seeds(seeds, 2, [&](const OfSeed& seed) {
      return quantile(of_rigs(seed, method, &MethodGain::held_out), share);
    });
  print_over_seeds(seeds, 1, [&](const OfSeed& seed) {
    double clips = 0, lost = 0;
    for (const MethodGains& rig : seed.rigs) {
      clips += static_cast<double>(rig.methods[method].clips);
      lost += static_cast<double>(rig.methods[method].clips_lost);
    }
    return 100 * lost / clips;
  });
  print_over_seeds(seeds, 3, [&](const OfSeed& seed) {
    return quantile(of_rigs(seed, method, &MethodGain::least_clip), 0);
  });
  print_over_seeds(seeds, 2, [&](const OfSeed& seed) {
    double own = 0, of_refit = 0;
    for (const MethodGains& rig : seed.rigs) {
      own += rig.methods[method].seconds;
      of_refit += rig.methods[0].seconds;
    }
    return own / of_refit;
  });
  std::printf("\n");
}

int run(int random_rigs, int seeds) {
  const std::vector<BendingRig> rigs = bending_rigs(random_rigs);
  std::vector<OfSeed> all;
  std::size_t points = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    OfSeed& of_seed = all.emplace_back();
    for (const BendingRig& rig : rigs) {
      MethodGains gains = compare_methods(rig, static_cast<std::uint64_t>(seed));
      if (gains.methods.empty()) continue;
      points += gains.points;
      of_seed.rigs.push_back(std::move(gains));
    }
    std::fprintf(stderr, "seed %d of %d: %zu rigs\n", seed, seeds, of_seed.rigs.size());
  }
  std::printf(
      "%zu rigs, %d seeds, %zu points. Gains, quartiles over rigs; mean ± standard deviation "
      "over seeds.\n\n"
      "| method | clips of the fit, median | held-out clips: 25 %% | median | 75 %% | held-out "
      "clips "
      "that lose, %% | least gain over one | time / refit |\n|---|---|---|---|---|---|---|---|\n",
      all.front().rigs.size(), seeds, points);
  for (std::size_t method = 0; method < method_names().size(); ++method) print_method(all, method);
  return 0;
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  int random_rigs = 60, seeds = 5;
  for (int i = 1; i < argc; ++i) {
    const bool has_next = i + 1 < argc;
    if (std::strcmp(argv[i], "--random-rigs") == 0 && has_next) {
      random_rigs = std::atoi(argv[++i]);
    } else if (std::strcmp(argv[i], "--seeds") == 0 && has_next) {
      seeds = std::atoi(argv[++i]);
    } else {
      const bool asked = std::strcmp(argv[i], "--help") == 0;
      std::fputs(sunder::bench::kHelp, asked ? stdout : stderr);
      return asked ? 0 : 2;
    }
  }
  if (random_rigs < 1 || seeds < 1) return 2;
  return sunder::bench::run(random_rigs, seeds);
}
