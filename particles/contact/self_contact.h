#pragma once

#include <sunder/particles/soft_body.h>

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
  /// O(1) if nothing is awake or no lip exists; otherwise O(lip points + particles log particles),
  /// and O(contact points) of particles near others. Wakes the particles that it pushes.
  /// @throws std::bad_alloc
  void push_apart(const sunder::SelfContact& options, const Contact::World& world, Motion& motion);
  [[nodiscard]] std::size_t memory_bytes() const {
    return pairs_.capacity() * sizeof(LipPoints) + touches_.capacity() * sizeof(Touch) +
           points_.memory_bytes() + normals_.capacity() * sizeof(Normals) +
           (order_.capacity() + near_.capacity()) * sizeof(Index);
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

  void find_lips(const Contact::World& world);
  void touch_lips(double thickness, const Contact::World& world, const Motion& motion);
  void touch_skin(double thickness, const Contact::World& world, const Motion& motion);
  void touch_particles(double thickness, const Contact::World& world, const Motion& motion,
                       Index mover, std::span<const Index> others);
  const Normals& normals_of(const Contact::World& world, const ContactPoints::Points& points,
                            Index particle);
  double push_once(double friction, Motion& motion);
  void slow_down(const Contact::World& world, Motion& motion);

  std::uint64_t revision_ = 0;  ///< Of the set, plus one, for the pairs.
  std::vector<LipPoints> pairs_;
  std::vector<Touch> touches_;
  ContactPoints points_;
  std::vector<Normals> normals_;
  std::vector<Index> order_;  ///< Particles by the x of their places.
  std::vector<Index> near_;   ///< Those whose skin a particle may touch.
};

}  // namespace sunder::particles
