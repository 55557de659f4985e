#pragma once

#include <sunder/particles/soft_body.h>
#include <sunder/tear/torn_model.h>

#include <memory>
#include <string>
#include <vector>

#include "tools/picture.h"
#include "tools/posed_model.h"
#include "tools/view.h"

namespace sunder::tools {

/// The cactus of the demo in a pose of its clip, made soft, to be torn, pulled and drawn. What
/// fails ends the program.
class SoftScene {
 public:
  /// @param range  of the particles, of the diagonal.
  SoftScene(const std::vector<SoftMaterial>& materials, double range);

  /// Places at rest, which blades from the front pass one after another; the body does not move.
  void tear(const std::vector<Vec2d>& path);
  void step();
  /// At most ten seconds. @return how many steps it took.
  int step_until_still();

  /// The point that is nearest to a place at rest.
  [[nodiscard]] std::uint32_t point_at(const Vec3d& rest_place) const;
  /// Where a point is now.
  [[nodiscard]] Vec3d place(std::uint32_t point) const;
  /// Greatest distance of two lips that were one point.
  [[nodiscard]] double widest_gap() const;
  [[nodiscard]] double diagonal() const { return diagonal_; }

  [[nodiscard]] std::vector<DeformedMesh> posed() const;      ///< As the bones have it.
  [[nodiscard]] std::vector<DeformedMesh> displaced() const;  ///< As the particles move that.

  /// @param centre  of the picture; model space. @param radius  of what is seen, metres.
  void draw(const std::string& png, const ViewFrame& frame, const Vec3d& centre,
            double radius) const;
  void draw_particles(const std::string& png) const;

  std::shared_ptr<const Character> source;
  std::unique_ptr<TornModel> model;
  ModelPose rest, pose;
  std::unique_ptr<ParticleSet> particles;
  std::unique_ptr<SoftBody> body;
  std::vector<ChangeRecord> changes;

 private:
  double diagonal_ = 0;
};

/// A view from the front, turned to a side and up; degrees.
[[nodiscard]] ViewFrame look_from(double side, double above);

}  // namespace sunder::tools
