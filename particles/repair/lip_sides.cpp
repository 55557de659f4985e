#include "particles/repair/lip_sides.h"

#include <algorithm>

namespace sunder::particles {
namespace {

/// Distances of the points of each lip from the seed of a particle, as fractions of its range.
struct SideScore {
  Index particle;
  std::array<float, 2> near = {};
};

/// Scores of the particles next to the lips, in the order in which they are found.
class SideScores {
 public:
  explicit SideScores(Structure& structure) : scratch_(structure.scratch) {
    scratch_.scored.begin(structure.particles.size());
    scratch_.score_of.resize(std::max(scratch_.score_of.size(), structure.particles.size()));
  }

  void add(std::span<const ParticleMembership> memberships, std::size_t side) {
    for (const ParticleMembership& membership : memberships) {
      if (scratch_.scored.mark(membership.particle)) {
        scratch_.score_of[membership.particle] = static_cast<Index>(scores_.size());
        scores_.push_back({membership.particle});
      }
      float& near = scores_[scratch_.score_of[membership.particle]].near[side];
      near = std::max(near, 1 - membership.reach);
    }
  }
  [[nodiscard]] std::span<const SideScore> all() const { return scores_; }

 private:
  RepairScratch& scratch_;
  std::vector<SideScore> scores_;
};

}  // namespace

void choose_sides(StructureEdit& edit, std::span<const Index> lips) {
  Structure& structure = edit.structure();
  const Index tear = edit.tear();
  SideScores scores(structure);
  for (const Index point : lips) {
    const auto side = static_cast<std::size_t>(structure.points.lip_points[point].side);
    scores.add(edit.memberships(point), side);
    // Both lips are equally near. The points next to them tell on which side the seed is, also for
    // particles that only pass by.
    const Ring around = edit.ring()(point);
    for (std::size_t i = 0; i < around.size(); ++i)
      if (structure.points.lip_points[around.point(i)].tear != tear)
        scores.add(edit.memberships(around.point(i)), side);
  }
  for (const SideScore& score : scores.all()) {
    const Particle& particle = structure.particles[score.particle];
    if (particle.side_of(tear) != nullptr) continue;
    // The seed itself may be on a lip.
    const LipPoint& of_seed = structure.points.lip_points[particle.seed];
    Side side = score.near[0] >= score.near[1] ? Side::left : Side::right;
    if (of_seed.tear == tear) side = of_seed.side;
    edit.change_particle(score.particle).sides.push_back({tear, side});
  }
}

}  // namespace sunder::particles
