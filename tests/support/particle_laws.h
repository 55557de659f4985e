#pragma once

#include <sunder/particles/particle_set.h>

#include <string>
#include <vector>

namespace sunder::test {

/// The laws that particles must keep, whatever tore their model. Each returns what is broken, one
/// sentence a fault; empty: nothing. All are computed from what ParticleSet and TornModel tell, not
/// from the set's own sums.

/// Memberships, influences, members, neighbours and vertices agree with one another and with the
/// model; every point of a face belongs to a particle, every other to none; weights are in [0, 1],
/// descend, and add up to one; numbers of particles are apart.
std::vector<std::string> broken_particles(const TornModel& model, const ParticleSet& set);

/// No particle holds points of both lips, or of both sides of a gap, of one operation. @param
/// changes  what it wrote, call by call.
std::vector<std::string> broken_sides(const ParticleSet& set,
                                      std::span<const ChangeRecord> changes);

/// Every particle lies in one piece of the surface.
std::vector<std::string> broken_pieces(const TornModel& model, const ParticleSet& set);

/// Rest places and linear parts in a pose are those of the members, skinned one by one.
std::vector<std::string> broken_rest(const TornModel& model, const ParticleSet& set,
                                     const ModelPose& pose);

/// Lips are the borders of the surface, without walls and caps, that the source has not: each once,
/// with a vector that is as long as the edge, at right angles to it, and points into the surface.
/// For sets that were decomposed in the bind pose of a whole model.
std::vector<std::string> broken_lip_edges(const TornModel& model, const ParticleSet& set);

/// Where a member of a particle is by the reference, and the linear part that moved it. One a
/// point; what no face uses is at zero.
struct PosedPoint {
  Vec3d place = Vec3d::Zero();
  Mat3d linear = Mat3d::Zero();
};
std::vector<PosedPoint> posed_points(const TornModel& model, const ParticleSet& set,
                                     const ModelPose& pose);

/// Which piece of the surface each point is in; kNone for what no face uses.
std::vector<std::uint32_t> pieces_of(const TornModel& model);

/// All that a set tells about itself, but for revisions and dirty points. What has no face any more
/// has no place worth comparing.
struct ParticleState {
  struct Particle {
    std::uint64_t serial = 0;
    std::uint32_t seed = 0, member_count = 0;
    double range = 0.0;
    std::vector<std::uint32_t> members;
    std::vector<ParticleNeighbour> neighbours;
    std::vector<double> couplings;
    ParticleInfluences parents;
    ParticleRest rest;  ///< In some pose.
  };
  std::vector<Particle> particles;
  std::vector<std::vector<ParticleMembership>> memberships;
  std::vector<ParticleInfluences> influences;
  std::vector<std::vector<std::uint32_t>> vertex_points;
  std::vector<Vec3f> positions;
  std::vector<LipEdge> lips;
};
ParticleState state_of(const TornModel& model, const ParticleSet& set, const ModelPose& pose);

/// How closely two states have to agree: sums that were gathered in another order differ in their
/// last bits, and particles that were made anew have other numbers.
enum class Sameness { bits, but_for_sums };

/// What two states differ in, for a message; empty where they are the same.
std::string difference(const ParticleState& a, const ParticleState& b,
                       Sameness sameness = Sameness::bits);

}  // namespace sunder::test
