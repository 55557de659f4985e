#pragma once

#include <sunder/particles/particle_set.h>

#include <memory>
#include <optional>
#include <string>

namespace sunder::bench {

/// The cost of dividing a surface into particles, compared with clusters of the same points and the
/// same range in a straight line. Medians in seconds; candidates run in turns.
struct DecompositionFigures {
  std::string name;
  DecompositionReport report;
  double seconds = 0;  ///< ParticleSet::create(), all of it.
  double bytes = 0;    ///< Held by the set.
  struct Peer {
    double build = 0, search = 0;
    std::size_t clusters = 0, memberships = 0;
  };
  Peer scan;                      ///< By Eigen, every point for every centre.
  std::optional<Peer> nanoflann;  ///< Where it was built.

  /// Our time divided by nanoflann's.
  [[nodiscard]] std::optional<double> vs_nanoflann() const;
};

/// The range at every size, as a fraction of the diagonal.
inline constexpr double kRange = 0.1;

/// Runs each candidate `runs` times, after one run that does not count.
[[nodiscard]] DecompositionFigures measure_decomposition(const std::string& name,
                                                         const TornModel& model,
                                                         const ModelPose& pose, int runs);

/// Measures a rigged character of about 3,000 points. None without SUNDER_IO or the file; stderr
/// says so.
[[nodiscard]] std::optional<DecompositionFigures> measure_cactus(int runs);

/// The particles of a model; ends the program where there are none.
[[nodiscard]] std::unique_ptr<ParticleSet> decompose(const TornModel& model, const ModelPose& pose,
                                                     double range);

}  // namespace sunder::bench
