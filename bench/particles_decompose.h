#pragma once

#include <sunder/particles/particle_set.h>

#include <memory>
#include <optional>
#include <string>

namespace sunder::bench {

/// What dividing a surface into particles costs, beside clusters of the same points and the same range in a straight line. Medians,
/// in turns, seconds.
struct DecompositionFigures {
  std::string name;
  DecompositionReport report;
  double seconds = 0;  ///< ParticleSet::create(), all of it.
  double bytes = 0;    ///< That the set holds.
  struct Peer {
    double build = 0, search = 0;
    std::size_t clusters = 0, memberships = 0;
  };
  Peer scan;                      ///< Eigen, every point for every centre.
  std::optional<Peer> nanoflann;  ///< Where it was built.

  /// Our time by nanoflann's.
  [[nodiscard]] std::optional<double> vs_nanoflann() const;
};

/// The range at every size, as a part of the diagonal.
inline constexpr double kRange = 0.1;

/// Runs each candidate so often, after one run that does not count.
[[nodiscard]] DecompositionFigures measure_decomposition(const std::string& name, const TornModel& model, const ModelPose& pose,
                                                         int runs);

/// Of a rigged character of about 3,000 points; none without SUNDER_IO or the file, which is said on stderr.
[[nodiscard]] std::optional<DecompositionFigures> measure_cactus(int runs);

/// The particles of a model, or the end of the program.
[[nodiscard]] std::unique_ptr<ParticleSet> decompose(const TornModel& model, const ModelPose& pose, double range);

}  // namespace sunder::bench
