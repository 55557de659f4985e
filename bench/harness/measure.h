#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

namespace sunder::bench {

/// Seconds that `work` takes.
template <class Work>
double seconds_of(Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

[[nodiscard]] double median(std::vector<double> values);

/// Number of measurements: `runs`, or fewer if they take longer than `seconds`, but at least
/// `least_runs`.
struct Effort {
  int runs = 300;
  double seconds = 10;
  int least_runs = 3;
};

/// The values that `run` returns, one per run.
template <class Run>
std::vector<double> sample(const Effort& effort, Run run) {
  std::vector<double> samples;
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  for (int i = 0; i < effort.runs && (i < effort.least_runs || elapsed() < effort.seconds); ++i)
    samples.push_back(run());
  return samples;
}

/// Reads 64 MB, so that no earlier data is left in a cache.
void sweep_caches();

/// Bytes allocated by malloc in this process.
[[nodiscard]] std::uint64_t bytes_in_use();

}  // namespace sunder::bench
