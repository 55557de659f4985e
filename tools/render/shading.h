#pragma once

#include "tools/render/lighting.h"
#include "tools/render/render_scene.h"
#include "tools/render/triangle_tree.h"

namespace sunder::tools {

/// The light that surfaces of a scene reflect. Refers to both arguments; any number of threads may
/// ask.
class Shading {
 public:
  struct Hit {
    std::uint32_t triangle = kNone;  ///< kNone: nothing was met.
    float distance = 0;              ///< In lengths of the direction.
    Vec3f place = Vec3f::Zero();
  };

  Shading(const RenderScene& scene, const Lighting& lighting);

  [[nodiscard]] Hit find(const Vec3f& from, const Vec3f& along) const;
  /// Linear RGB, and how much of what is behind the surface it hides.
  [[nodiscard]] Vec4f shade(const Hit& hit, const Vec3f& along, std::size_t sample) const;
  /// The share of the light that reaches a place on the floor.
  [[nodiscard]] float light_on_floor(const Vec3f& place) const;

 private:
  struct Surface;
  [[nodiscard]] Surface surface_at(const Hit& hit, const Vec3f& along) const;
  /// Texture coordinates of flesh that is no wound of its own.
  [[nodiscard]] Vec2f inner_flesh(const Vec3f& place) const;
  [[nodiscard]] Vec3f reddened(const Vec3f& color, const Vec3f& place) const;

  const RenderScene& scene_;
  const Lighting& lighting_;
  TriangleTree all_, opaque_;
  Vec3f least_lip_, greatest_lip_;
  float nearly_nothing_ = 0;  ///< By which rays start above surfaces.
};

}  // namespace sunder::tools
