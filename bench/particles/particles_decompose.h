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
  double seconds = 0;  ///< The whole of ParticleSet::create().
  double bytes = 0;    ///< Held by the set.
  struct Peer {
    double build = 0, search = 0;
    std::size_t clusters = 0, memberships = 0;
  };
  Peer scan;                      ///< By Eigen: every point against every centre.
  std::optional<Peer> nanoflann;  ///< If it is built.

  /// Our time divided by nanoflann's.
  [[nodiscard]] std::optional<double> vs_nanoflann() const;
};

/// The range at every size, as a fraction of the diagonal.
inline constexpr double kRange = 0.1;

/// Runs each candidate `runs` times, after one run that does not count.
[[nodiscard]] DecompositionFigures measure_decomposition(const std::string& name,
                                                         const TornModel& model,
                                                         const ModelPose& pose, int runs);

/// Measures a rigged character of about 3,000 points. Nothing without SUNDER_IO or the file; this
/// is reported on stderr.
[[nodiscard]] std::optional<DecompositionFigures> measure_cactus(int runs);

/// Creates the particles of a model; ends the program on failure.
[[nodiscard]] std::unique_ptr<ParticleSet> decompose(const TornModel& model, const ModelPose& pose,
                                                     double range);

}  // namespace sunder::bench
