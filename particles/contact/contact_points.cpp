#include "particles/contact/contact_points.h"

#include <algorithm>
#include <new>

namespace sunder::particles {
namespace {

/// Chooses the contact points of a particle. O(members log members), allocates.
void choose(const ParticleSet& set, Index particle, ContactPoints::Points& chosen) {
  struct Candidate {
    float reach;
    Index point;
    bool operator<(const Candidate& other) const {
      return reach != other.reach ? reach < other.reach : point < other.point;
    }
  };
  std::vector<Candidate> candidates;
  const auto members = set.members(particle);
  if (!members) throw std::bad_alloc();
  for (const Index point : *members) {
    const ParticleInfluences& of = set.influences()[point];
    if (!(of.weights[0] > 0) || of.particles[0] != particle) continue;
    for (const ParticleMembership& membership : set.memberships(point))
      if (membership.particle == particle) candidates.push_back({membership.reach, point});
  }
  std::sort(candidates.begin(), candidates.end());
  chosen.count = static_cast<Index>(std::min<std::size_t>(candidates.size(), ContactPoints::kMost));
  for (Index i = 0; i < chosen.count; ++i)
    chosen.points[i] = candidates[i * candidates.size() / chosen.count].point;
}

}  // namespace

const ContactPoints::Points& ContactPoints::of(const ParticleSet& set, const TornModel& model,
                                               const SurfacePose& pose, std::uint64_t epoch,
                                               Index particle) {
  Points& points = points_[particle];
  if (points.revision != set.revision() + 1) {
    choose(set, particle, points);
    points.revision = set.revision() + 1;
    points.epoch = 0;
  }
  if (points.epoch != epoch) {
    for (Index i = 0; i < points.count; ++i) points.places[i] = pose.place(model, points.points[i]);
    points.epoch = epoch;
  }
  return points;
}

}  // namespace sunder::particles
