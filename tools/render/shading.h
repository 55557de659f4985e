#pragma once

#include <array>
#include <span>

#include "tools/render/lighting.h"
#include "tools/render/lip_blood.h"
#include "tools/render/render_scene.h"
#include "tools/render/triangle_tree.h"

namespace sunder::tools {

/// The light that surfaces of a scene reflect. Refers to both arguments; any number of threads may
/// ask.
class Shading {
 public:
  /// How a place on a surface reflects light.
  struct Look {
    Vec4f color = Vec4f::Zero();  ///< Linear RGBA.
    Vec3f emission = Vec3f::Zero();
    Vec3f normal = Vec3f::UnitY();  ///< Towards the eye, with bumps.
    float gloss = 0.035f, sharpness = 18;
    bool is_unlit = false;
  };
  /// A place on a surface, as it is seen.
  struct Surface : Look {
    Vec3f smooth = Vec3f::UnitY();                       ///< Without bumps.
    Vec3f flat = Vec3f::UnitY();                         ///< Of the triangle.
    Vec3f place = Vec3f::Zero(), start = Vec3f::Zero();  ///< `start`: where rays begin.
  };
  /// How much of the sky and of the lamp is seen from a place: sums over directions.
  struct Light {
    Vec3f sky = Vec3f::Zero(), whole_sky = Vec3f::Zero();
    float lamp = 0, whole_lamp = 0;
    void add(const Light& other, float weight) {
      sky += weight * other.sky;
      whole_sky += weight * other.whole_sky;
      lamp += weight * other.lamp;
      whole_lamp += weight * other.whole_lamp;
    }
    [[nodiscard]] Vec3f share_of_sky() const;   ///< Per channel, 0 to 1.
    [[nodiscard]] float share_of_lamp() const;  ///< 0 to 1.
  };

  static constexpr std::size_t kMostDirections = 4;
  static constexpr float kOpaque = 0.99f;  ///< Least alpha of what hides all behind it.

  Shading(const RenderScene& scene, const Lighting& lighting);

  /// The first surface on a ray beyond a distance.
  [[nodiscard]] TriangleTree::Hit find(const Vec3f& from, const Vec3f& along, float beyond) const;
  /// The first surfaces on rays from one place.
  [[nodiscard]] std::array<TriangleTree::Hit, TriangleTree::kBundle> find(
      const Vec3f& from, const std::array<Vec3f, TriangleTree::kBundle>& along) const {
    return tree_.first_hits(from, along);
  }
  [[nodiscard]] Surface surface_at(const TriangleTree::Hit& hit, const Vec3f& from,
                                   const Vec3f& along) const;
  /// The first surface on a ray: what look_alike() compares of it.
  struct Glance {
    TriangleTree::Hit hit;
    Vec3f place = Vec3f::Zero(), normal = Vec3f::UnitY();
    Vec2f uv = Vec2f::Zero();
    bool stands_alone = false;  ///< Flesh, or what shows through: like no other place.
  };
  using Glances = std::array<const Glance*, 5>;
  [[nodiscard]] Glance glance(const TriangleTree::Hit& hit, const Vec3f& from,
                              const Vec3f& along) const;
  /// Whether one of four neighbours stands for all: they are opaque, of one material and smooth,
  /// and at most a texel wide.
  /// @param reach  how far places may be off one plane, metres.
  [[nodiscard]] bool look_alike(const Glances& glances, float reach) const;
  /// Looks in directions of the sky, around the normal in z, and of the lamp: at most
  /// kMostDirections of each.
  [[nodiscard]] Light light_at(const Vec3f& start, const Vec3f& normal, const Vec3f& flat,
                               std::span<const Vec3f> sky, std::span<const Vec3f> lamp) const;
  /// Linear RGB that is shown of a surface, each channel below 1.
  [[nodiscard]] Vec3f shown(const Look& look, const Light& light, const Vec3f& along) const;

 private:
  /// Texture coordinates of flesh that is no wound of its own.
  [[nodiscard]] Vec2f inner_flesh(const Vec3f& place) const;
  /// The alpha of a triangle at a place.
  /// @param shares  of its three corners at that place; sum 1.
  [[nodiscard]] float alpha_at(const RenderTriangle& triangle, const Vec3f& shares) const;
  [[nodiscard]] bool lets_pass(Index triangle, const Vec3f& shares, TriangleTree::Ray ray) const;
  [[nodiscard]] TriangleTree::Holes holes() const;

  const RenderScene& scene_;
  const Lighting& lighting_;
  LipBlood blood_;
  std::vector<bool> are_holed_;  ///< Per triangle.
  float nearly_nothing_ = 0;     ///< By which rays start above surfaces.
  TriangleTree tree_;
};

}  // namespace sunder::tools
