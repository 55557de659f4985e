#pragma once

#include <sunder/scene/character_instance.h>

#include <memory>
#include <string>
#include <vector>

#include "tools/model/posed_model.h"
#include "tools/picture/view.h"

namespace sunder::tools {

/// The cactus of the demo in a pose of its clip, as soft tissue that can be torn, pulled and drawn.
/// A failure ends the program.
class SoftScene {
 public:
  ///
  /// @param range  of the particles, as a fraction of the diagonal.
  SoftScene(const std::vector<SoftMaterial>& materials, double range);

  /// Tears along places at rest, with blades from the front.
  void tear(const std::vector<Vec2d>& path);
  Result<ForceTearingReport> tear_overstretched();
  void step();
  /// Steps until nothing moves, or for ten seconds. @return number of steps.
  int step_until_still();

  /// The point that is nearest to a place at rest.
  [[nodiscard]] std::uint32_t point_at(const Vec3d& rest_place) const;
  /// Current place of a point.
  [[nodiscard]] Vec3d place(std::uint32_t point) const;
  /// The greatest distance between two points that were one before a tear.
  [[nodiscard]] double widest_gap() const;
  [[nodiscard]] double diagonal() const { return diagonal_; }
  [[nodiscard]] SoftBody& body() { return *instance.body(); }
  [[nodiscard]] const SoftBody& body() const { return *instance.body(); }
  [[nodiscard]] const ParticleSet& particles() const { return *instance.particles(); }

  [[nodiscard]] std::vector<DeformedMesh> posed() const;  ///< By the bones alone.
  [[nodiscard]] std::vector<DeformedMesh> displaced();    ///< By bones and particles.

  ///
  /// @param centre  of the picture, model space.
  /// @param radius  of the visible part, metres.
  void draw(const std::string& png, const ViewFrame& frame, const Vec3d& centre, double radius);
  void draw_particles(const std::string& png) const;

  std::shared_ptr<const Character> source;
  CharacterInstance instance;
  ModelPose rest, pose;
  std::vector<ChangeRecord> changes;

 private:
  void draw_frame(double seconds);

  double diagonal_ = 0;
};

/// A view from the front, rotated sideways and upwards by degrees.
[[nodiscard]] ViewFrame look_from(double side, double above);

}  // namespace sunder::tools
