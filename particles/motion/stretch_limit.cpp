#include "particles/motion/stretch_limit.h"

#include <algorithm>

namespace sunder::particles {
namespace {

constexpr int kSweeps = 64;
constexpr double kTolerance = 1e-4, kMore = 1.01;
constexpr double kStopped = 1e-3;  // of the fastest that part

struct Pair {
  Vec3d apart;
  double length = 0, most = 0;
};

Pair pair_of(const RestMotion& rests, const Motion& motion, Index p, const Spring& spring) {
  const Vec3d at_rest = rests.place(spring.other) - rests.place(p);
  const Vec3d apart = at_rest + motion.displacements[spring.other] - motion.displacements[p];
  return {apart, apart.norm(), spring.stretch_limit * at_rest.norm()};
}

/// Calls visit(particle, spring, pair, part of the first, part of the second) for pairs that are limited, once each.
template <class Visit>
void for_each_limited(const SpringGraph& graph, std::span<const SoftMaterial> materials, const RestMotion& rests,
                      std::span<const Index> active, const Motion& motion, Visit visit) {
  for (const Index p : active)
    for (const Spring& spring : graph.of(p)) {
      const bool is_other_free = motion.awake[spring.other] != 0;
      if (spring.stretch_limit == 0 || (is_other_free && spring.other < p)) continue;
      const Pair pair = pair_of(rests, motion, p, spring);
      if (!(pair.most > 0)) continue;
      const double mine = 1 / materials[motion.material_of[p]].mass;
      const double others = is_other_free ? 1 / materials[motion.material_of[spring.other]].mass : 0.0;
      visit(p, spring, pair, mine / (mine + others), others / (mine + others));
    }
}

}  // namespace

void limit_stretch(const SpringGraph& graph, std::span<const SoftMaterial> materials, const RestMotion& rests,
                   std::span<const Index> active, Motion& motion, std::vector<Index>& pulled) {
  pulled.clear();
  bool is_reached = false;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double worst = 0;
    for_each_limited(graph, materials, rests, active, motion,
                     [&](Index p, const Spring& spring, const Pair& pair, double mine, double others) {
                       if (pair.length <= pair.most) return;
                       worst = std::max(worst, pair.length / pair.most - 1);
                       const Vec3d by = (1 - pair.most / pair.length) * pair.apart;
                       motion.displacements[p] += mine * by;
                       if (others > 0) motion.displacements[spring.other] -= others * by;
                       motion.bound[p] = 1;
                       if (others > 0) motion.bound[spring.other] = 1;
                       // Who fell asleep at its limit is pulled at for ever, and feels only more than that.
                       else if (sweep == 0 && (motion.bound[spring.other] == 0 || pair.length > kMore * pair.most))
                         pulled.push_back(spring.other);
                     });
    if (worst > 0) is_reached = true;
    if (worst <= kTolerance) break;
  }
  if (!is_reached) return;
  double first = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double fastest = 0;
    for_each_limited(
        graph, materials, rests, active, motion, [&](Index p, const Spring& spring, const Pair& pair, double mine, double others) {
          if (pair.length < pair.most * (1 - kTolerance)) return;
          const Vec3d along = pair.apart / pair.length;
          const Index q = spring.other;
          const double parting = along.dot(motion.velocities[q] + rests.velocity(q) - motion.velocities[p] - rests.velocity(p));
          if (parting <= 0) return;
          fastest = std::max(fastest, parting);
          motion.velocities[p] += mine * parting * along;
          if (others > 0) motion.velocities[q] -= others * parting * along;
        });
    first = std::max(first, fastest);
    if (fastest <= kStopped * first) break;
  }
  for (const Index p : pulled) motion.wake(p);
}

}  // namespace sunder::particles
