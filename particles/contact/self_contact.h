#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/contact/ball_grid.h"
#include "particles/contact/contact.h"
#include "particles/contact/contact_points.h"

namespace sunder::particles {

/// Keeps lips from passing through one another, and flaps through the skin on which they lie.
/// Position based, after the motion and before the colliders.
///
/// Lips: two points that a tear parted may only move apart across the lips, while they are less
/// than the tissue's thickness apart out of the surface. Skin: a contact point of a displaced
/// particle stays a thickness outside of the surface at the contact points of particles that it
/// comes near, but that were not near it at rest; each stands for a disc in its tangent plane.
class SelfContact {
 public:
  /// O(1) if nothing is awake or no lip exists; otherwise O(lip points + particles),
  /// and O(contact points squared) of particles near others. Wakes the particles that it pushes.
  /// @throws std::bad_alloc
  void push_apart(const sunder::SelfContact& options, const Contact::World& world, Motion& motion);
  [[nodiscard]] std::size_t memory_bytes() const {
    return pairs_.capacity() * sizeof(LipPoints) + touches_.capacity() * sizeof(Touch) +
           points_.memory_bytes() + normals_.capacity() * sizeof(Normals) +
           moved_.capacity() * sizeof(MovedPoints) +
           (movers_.capacity() + ground_.capacity()) * sizeof(Ball) + grid_.memory_bytes() +
           near_.capacity() * sizeof(Near);
  }

 private:
  /// Two points that a tear parted, and the unit directions from the first to the second lip and
  /// out of the surface, in the decomposition's pose.
  struct LipPoints {
    std::array<Index, 2> points = {};
    Vec3d across = Vec3d::Zero(), out = Vec3d::Zero();
  };
  /// Two points that may not come nearer along a direction.
  struct Touch {
    ParticleInfluences first, second;  ///< The second is pushed along the normal.
    Vec3d normal = Vec3d::Zero();
    double gap = 0;      ///< At no displacement, metres.
    double squares = 0;  ///< Sum of the squares of all weights.
    double tolerance = 0;
    double depth = 0, dragged = 0;  ///< Pushed, and moved back by friction so far, metres.
  };
  /// Normals of the contact points of a particle in a pose.
  struct Normals {
    std::array<Vec3d, ContactPoints::kMost> at;
    std::uint64_t revision = 0, epoch = 0;
  };
  /// The displaced contact points of a particle.
  struct MovedPoints {
    const ContactPoints::Points* points = nullptr;
    std::array<Vec3d, ContactPoints::kMost> at;
    Eigen::AlignedBox3d box;   ///< Around them.
    std::uint64_t search = 0;  ///< For which they were computed.
  };
  /// A particle whose skin another one may touch.
  struct Near {
    Index particle = 0;
    double x = 0;  ///< Of its place.
    const MovedPoints* moved = nullptr;
    double disc_square = 0;      ///< Square of the radius of its discs.
    double separate_square = 0;  ///< Points that were nearer at rest do not touch.
  };

  void find_lips(const Contact::World& world);
  void touch_lips(double thickness, const Contact::World& world, const Motion& motion);
  void touch_skin(double thickness, const Contact::World& world, const Motion& motion);
  void find_balls(double thickness, const Contact::World& world, const Motion& motion);
  void touch_particles(double thickness, const Contact::World& world, const Motion& motion,
                       Index mover);
  const MovedPoints& moved_points(const Contact::World& world, const Motion& motion,
                                  Index particle);
  const Normals& normals_of(const Contact::World& world, const ContactPoints::Points& points,
                            Index particle);
  double push_once(double friction, Motion& motion);
  void slow_down(const Contact::World& world, Motion& motion);

  std::uint64_t revision_ = 0;  ///< Of the set, plus one, for the pairs.
  std::vector<LipPoints> pairs_;
  std::vector<Touch> touches_;
  ContactPoints points_;
  std::vector<Normals> normals_;
  std::vector<MovedPoints> moved_;
  std::uint64_t search_ = 0;  ///< Counts searches for skin.
  std::vector<Ball> movers_;  ///< Particles that moved enough to touch others, ascending.
  std::vector<Ball> ground_;  ///< Those that any of them may touch.
  BallGrid grid_;             ///< Of the ground.
  double widest_ = 0;         ///< Largest reach of all particles.
  std::vector<Near> near_;    ///< Those that the current mover may touch.
};

}  // namespace sunder::particles
