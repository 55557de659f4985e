#include <sunder/particles/particle_set.h>
#include <sunder/particles/soft_body.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/internal/elementary.h"

namespace sunder {
namespace {

constexpr double kFirst = 0.1, kLeast = 1e-6,
                 kMost = 4.0;  // diagonals; distances along a surface may be larger than that
constexpr int kTrials = 12;

/// The largest range known to be too small, the smallest known to be too large, and the next one to
/// try.
class Bracket {
 public:
  void add(double range, bool is_too_small) { (is_too_small ? small_ : large_) = range; }
  [[nodiscard]] bool is_closed() const { return large_ < 1.0001 * small_; }
  ///
  /// @param guess  used if it is well between the two.
  [[nodiscard]] double next(double guess) const {
    if (guess > 1.02 * small_ && guess < 0.98 * large_) return guess;
    return std::sqrt(small_ * large_);
  }

 private:
  double small_ = kLeast, large_ = kMost;
};

Result<ParticleSet> decompose(const TornModel& model, const ModelPose& pose, double range,
                              std::uint64_t seed) {
  DecompositionOptions options;
  options.range = range;
  options.seed = seed;
  return ParticleSet::create(model, pose, options);
}

/// The minimum over some batches of the mean duration of a step with all particles awake.
Result<double> time_step(const TornModel& model, const ModelPose& pose, ParticleSet& set,
                         const SoftMaterial& material) {
  constexpr int kBatches = 5, kSteps = 8;
  constexpr double kStep = 1.0 / 60;
  auto body = SoftBody::create(set, pose, std::span(&material, 1));
  if (!body) return body.error();
  double least = std::numeric_limits<double>::infinity();
  for (int batch = 0; batch < kBatches; ++batch) {
    // In different directions, so that every spring is stretched.
    for (std::uint32_t p = 0; p < set.particle_count(); ++p) {
      const Vec3d push = body->mass(p) * set.range(p) *
                         Vec3d((p % 2 == 0) ? 1.0 : -1.0, (p % 3 == 0) ? 1.0 : -1.0, 0.5);
      if (Status status = body->add_impulse(p, push); !status) return status;
    }
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < kSteps; ++i)
      if (Status status = body->step(model, pose, kStep); !status) return status;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / kSteps;
    if (batch > 0) least = std::min(least, seconds);  // the first one warms up
  }
  return least;
}

}  // namespace

Result<FoundRange> find_range_for_particles(const TornModel& model, const ModelPose& pose,
                                            std::uint32_t wanted, std::uint64_t seed) {
  if (wanted == 0 || wanted > model.point_count())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%u particles are requested; it must be 1 to the number of points, %u",
                           wanted, model.point_count());
  FoundRange best;
  Bracket bracket;
  double range = kFirst;
  for (int trial = 0; trial < kTrials && !bracket.is_closed(); ++trial) {
    auto set = decompose(model, pose, range, seed);
    if (!set && set.error().code() != StatusCode::limit_exceeded) return set.error();
    const double count = set ? set->particle_count() : std::numeric_limits<std::uint32_t>::max();
    const auto miss = [&](double of) { return std::abs(elementary::log(of / wanted)); };
    if (set && (best.particles == 0 || miss(count) < miss(best.particles)))
      best = {range, set->particle_count(), 0.0};
    if (set && std::abs(count - wanted) <= 0.02 * wanted) break;
    bracket.add(range, count > wanted);
    range = bracket.next(range * std::sqrt(count / wanted));
  }
  return best;
}

Result<FoundRange> find_range_for_step(const TornModel& model, const ModelPose& pose,
                                       double seconds, const SoftMaterial& material,
                                       std::uint64_t seed) {
  if (!(seconds > 0) || !std::isfinite(seconds))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the requested step time is %g s; it must be finite and above 0",
                           seconds);
  FoundRange best;
  Bracket bracket;
  double range = kFirst;
  for (int trial = 0; trial < kTrials / 2 && !bracket.is_closed(); ++trial) {
    auto set = decompose(model, pose, range, seed);
    if (!set && set.error().code() != StatusCode::limit_exceeded) return set.error();
    double taken = std::numeric_limits<double>::max();
    if (set) {
      auto timed = time_step(model, pose, *set, material);
      if (!timed) return timed.error();
      taken = *timed;
    }
    const bool fits = taken <= seconds;
    if (fits && (best.particles == 0 || range < best.range))
      best = {range, set->particle_count(), taken};
    if (fits && (taken > 0.9 * seconds || set->particle_count() >= model.point_count())) break;
    bracket.add(range, !fits);
    range = bracket.next(range * std::sqrt(taken / (0.95 * seconds)));
  }
  if (best.particles == 0)
    return Status::failure(StatusCode::not_found, kNone,
                           "no range was found with steps of at most %g s", seconds);
  return best;
}

}  // namespace sunder
