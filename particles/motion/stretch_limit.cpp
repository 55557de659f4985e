#include "particles/motion/stretch_limit.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

constexpr int kMostSweeps = 64;

/// A spring with a limit, seen from one of its ends.
struct LimitedPair {
  Index p = 0, q = 0;
  Vec3d apart;        ///< From p to q.
  double length = 0;  ///< Of `apart`.
  double most = 0;    ///< The largest distance within the limit.
  double mine = 0,
         yours = 0;  ///< Fractions of a correction that p and q take; 0 for q if it sleeps.
};

/// Calls visit(pair) for each pair with a limit, once.
template <class Visit>
void for_each_limited(const StretchWorld& world, const Motion& motion, Visit visit) {
  for (const Index p : world.active)
    for (const Spring& spring : world.graph.of(p)) {
      const bool is_other_free = motion.awake[spring.other] != 0;
      if (spring.stretch_limit == 0 || (is_other_free && spring.other < p)) continue;
      const Vec3d at_rest = world.rests.place(spring.other) - world.rests.place(p);
      const double most = spring.stretch_limit * norm(at_rest);
      if (!(most > 0)) continue;
      const Vec3d apart = at_rest + motion.displacements[spring.other] - motion.displacements[p];
      const double mine = 1 / world.graph.masses[p];
      const double yours = is_other_free ? 1 / world.graph.masses[spring.other] : 0.0;
      visit(LimitedPair{p, spring.other, apart, norm(apart), most, mine / (mine + yours),
                        yours / (mine + yours)});
    }
}

/// Brings a pair within its limit. @return the excess before, relative to the limit.
double pull_together(const LimitedPair& pair, bool is_first_sweep, Motion& motion,
                     std::vector<Index>& pulled) {
  if (pair.length <= pair.most) return 0;
  const Vec3d by = (1 - pair.most / pair.length) * pair.apart;
  motion.displacements[pair.p] += pair.mine * by;
  motion.bound[pair.p] = 1;
  if (pair.yours > 0) {
    motion.displacements[pair.q] -= pair.yours * by;
    motion.bound[pair.q] = 1;
  } else if (is_first_sweep) {
    // A particle that fell asleep at its limit is pulled permanently, and wakes only for more than
    // that.
    const bool is_used_to_it = motion.bound[pair.q] != 0 || motion.tired[pair.q] != 0 ||
                               motion.quiet.seconds[pair.p] >= kQuietSeconds;
    const bool feels = !is_used_to_it || pair.length > (1 + kStretchWakesExcess) * pair.most;
    if (feels) pulled.push_back(pair.q);
  }
  return pair.length / pair.most - 1;
}

/// Stops a pair at its limit from separating. @return the speed at which it separated, metres per
/// second.
double stop_parting(const LimitedPair& pair, const RestMotion& rests, Motion& motion) {
  if (pair.length < pair.most * (1 - kStretchExcess)) return 0;
  const Vec3d along = pair.apart / pair.length;
  const double parting = dot(along, motion.velocities[pair.q] + rests.velocity(pair.q) -
                                        motion.velocities[pair.p] - rests.velocity(pair.p));
  if (parting <= 0) return 0;
  motion.velocities[pair.p] += pair.mine * parting * along;
  if (pair.yours > 0) motion.velocities[pair.q] -= pair.yours * parting * along;
  return parting;
}

}  // namespace

void limit_stretch(const StretchWorld& world, Motion& motion, std::vector<Index>& pulled) {
  pulled.clear();
  bool is_reached = false;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double worst = 0;
    for_each_limited(world, motion, [&](const LimitedPair& pair) {
      worst = std::max(worst, pull_together(pair, sweep == 0, motion, pulled));
    });
    is_reached |= worst > 0;
    if (worst <= kStretchExcess) break;
  }
  if (!is_reached) return;
  double first = 0;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double fastest = 0;
    for_each_limited(world, motion, [&](const LimitedPair& pair) {
      fastest = std::max(fastest, stop_parting(pair, world.rests, motion));
    });
    first = std::max(first, fastest);
    if (fastest <= kStretchStoppedFraction * first) break;
  }
  for (const Index p : pulled) motion.rouse(p);
}

}  // namespace sunder::particles
