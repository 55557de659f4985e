#pragma once

#include <sunder/scene/character_instance.h>

#include <memory>
#include <string>
#include <vector>

#include "tools/model/posed_model.h"
#include "tools/picture/view.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// A character of soft tissue that can be torn, pulled and drawn. A failure ends the program.
class SoftScene {
 public:
  /// The cactus of the demo in a pose of its clip.
  /// @param range  of the particles, as a fraction of the diagonal.
  SoftScene(const std::vector<SoftMaterial>& materials, double range);
  SoftScene(std::shared_ptr<const Character> character, const SoftTissue& tissue,
            const PoseSpec& pose);

  /// Tears along places at rest, with blades from the front.
  void tear(const std::vector<Vec2d>& path);
  Result<ForceTearingReport> tear_overstretched(const ForceTearingOptions& options = {});
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
  /// As draw(), for a thing that is no flesh: a sheet of a thickness, which the second colour shows
  /// from behind and at borders.
  struct Sheet {
    double thickness = 0.001;       ///< Metres.
    Vec4f inner = Vec4f::Ones();    ///< Linear RGBA.
    const Mesh* filling = nullptr;  ///< Optional: drawn too, with its colours; it does not move.
  };
  void draw_sheet(const std::string& png, const ViewFrame& frame, const Vec3d& centre,
                  double radius, const Sheet& sheet);

  std::shared_ptr<const Character> source;
  CharacterInstance instance;
  ModelPose rest, pose;
  std::vector<ChangeRecord> changes;

 private:
  void draw_frame(double seconds);
  static void write(const std::string& png, const RenderScene& scene, const ViewFrame& frame,
                    const Vec3d& centre, double radius);

  double diagonal_ = 0;
};

/// A view from the front, rotated sideways and upwards by degrees.
[[nodiscard]] ViewFrame look_from(double side, double above);

}  // namespace sunder::tools
