#pragma once

#include <sunder/particles/particle_set.h>

#include <string>
#include <vector>

namespace sunder::test {

/// Invariants of particles after any operation. Each function returns the violations, one sentence
/// per fault. All are computed from the public data of ParticleSet and TornModel, not from the
/// set's own sums.

/// Memberships, influences, cells, members, neighbours and vertices agree with one another and with
/// the model; every point of a face belongs to a particle, every other point to none; weights are
/// in [0, 1], descend, and sum to one; serial numbers of particles are unique.
/// @param checks_cells  whether cells and their borders are compared with the surface.
std::vector<std::string> broken_particles(const TornModel& model, const ParticleSet& set,
                                          bool checks_cells = true);

/// No particle has points of both lips, or of both sides of a gap, of one operation.
/// @param changes  the records of the operation, call by call.
std::vector<std::string> broken_sides(const ParticleSet& set,
                                      std::span<const ChangeRecord> changes);

/// Every particle lies in one connected component of the surface.
std::vector<std::string> broken_pieces(const TornModel& model, const ParticleSet& set);

/// Rest places and linear parts in a pose are those of the members, skinned one by one.
std::vector<std::string> broken_rest(const TornModel& model, const ParticleSet& set,
                                     const ModelPose& pose);

/// The lips are the borders of the surface, without walls and caps, that the source does not have.
/// Each is listed once, with a vector that is as long as the edge, at right angles to it, and
/// points into the surface. For sets decomposed in the bind pose of an untorn model.
std::vector<std::string> broken_lip_edges(const TornModel& model, const ParticleSet& set);

/// Position of each point by the reference, and the linear part that moved it. Points without a
/// face are at zero.
struct PosedPoint {
  Vec3d place = Vec3d::Zero();
  Mat3d linear = Mat3d::Zero();
};
std::vector<PosedPoint> posed_points(const TornModel& model, const ParticleSet& set,
                                     const ModelPose& pose);

/// The connected component of each point; kNone for points without a face.
std::vector<std::uint32_t> pieces_of(const TornModel& model);

/// All observable state of a set, except revisions and dirty points. Positions of points without a
/// face are not compared.
struct ParticleState {
  struct Particle {
    std::uint64_t serial = 0;
    std::uint32_t seed = 0, member_count = 0;
    double range = 0.0;
    std::vector<std::uint32_t> members;
    std::vector<ParticleNeighbour> neighbours;
    double area = 0.0;
    ParticleInfluences parents;
    ParticleRest rest;  ///< In some pose.
  };
  std::vector<Particle> particles;
  std::vector<std::vector<ParticleMembership>> memberships;
  std::vector<ParticleInfluences> influences;
  std::vector<std::uint32_t> owners;
  std::vector<std::vector<std::uint32_t>> vertex_points;
  std::vector<Vec3f> positions;
  std::vector<LipEdge> lips;
};
ParticleState state_of(const TornModel& model, const ParticleSet& set, const ModelPose& pose);

/// How closely two states must agree: sums in another order differ in their last bits, and
/// particles that were recreated have other serial numbers.
enum class Sameness { bits, but_for_sums };

/// The difference between two states, as a text; empty if they are equal.
std::string difference(const ParticleState& a, const ParticleState& b,
                       Sameness sameness = Sameness::bits);

}  // namespace sunder::test
