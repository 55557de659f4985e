#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cstdint>
#include <vector>

#include "tools/render/image.h"

namespace sunder::tools {

/// How a surface of a RenderScene looks.
struct RenderMaterial {
  enum class Wrap : std::uint8_t { repeat, clamp, mirror };
  enum class Alpha : std::uint8_t {
    ignored,  ///< Opaque.
    cut,      ///< Nothing is there where alpha is below `cutoff`; opaque elsewhere.
    blended,  ///< The rest of the light comes from behind.
  };

  Vec4f factor = Vec4f(0.6f, 0.6f, 0.6f, 1);  ///< Linear RGBA, multiplied by image and tint.
  Vec3f emission = Vec3f::Zero();             ///< Linear RGB, multiplied by its image.
  const Image* image = nullptr;               ///< Outlives the material.
  const Image* emission_image = nullptr;      ///< Outlives the material.
  std::array<Wrap, 2> wrap = {};              ///< Of u and v.
  bool is_pixelated = false;                  ///< Images show the nearest pixel.
  Alpha alpha = Alpha::ignored;
  float cutoff = 0.5f;
  bool is_unlit = false;  ///< Its colour is shown as it is.
  bool is_flesh = false;  ///< Coloured by flesh_color() of the texture coordinates, and wet.
  bool is_skin = false;   ///< Bloody near RenderScene::lips.
};

struct RenderTriangle {
  std::array<Vec3f, 3> corners;
  std::array<Vec3f, 3> normals;  ///< Unit length; either side.
  std::array<Vec2f, 3> uvs;
  std::array<Vec4f, 3> tints;  ///< Linear RGBA.
  /// BloodPlace::rest, for the blood of RenderMaterial::is_skin.
  std::array<Vec3f, 3> rest = {Vec3f::Zero(), Vec3f::Zero(), Vec3f::Zero()};
  std::uint32_t material = 0;
  bool has_flesh_inside = false;  ///< Seen from behind its normals.
};

/// A flat convex polygon of the picture, of a colour that no light changes.
struct RenderMark {
  std::vector<Vec2d> corners;  ///< Pixels: x to the right, y down, from the upper left corner.
  /// Per corner its distance from the plane of the eye, metres: surfaces hide what is behind them.
  /// Empty: the mark is on top of all surfaces and of the marks before it.
  std::vector<double> depths;
  Vec4f color = Vec4f::Ones();  ///< Linear RGBA.
};

/// A still surface, model space, metres, y up.
struct RenderScene {
  std::vector<RenderMaterial> materials;
  std::vector<RenderTriangle> triangles;
  std::vector<RenderMark> marks;
  /// The lips of wounds, as segments; there is blood on the skin within `blood_reach` of them.
  std::vector<std::array<Vec3f, 2>> lips;
  float blood_reach = 0;
  Vec3f backdrop = Vec3f(0.62f, 0.65f, 0.69f);  ///< Linear RGB in the middle of the picture.
  float backdrop_rise = 0.08f;                  ///< By this share it is brighter at the upper edge.
  float floor = 0;         ///< Height of the floor, which shows nothing but shadows.
  float floor_radius = 0;  ///< Around the middle of the scene; 0: no floor.
};

}  // namespace sunder::tools
