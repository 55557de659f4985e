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

  Vec4f factor = Vec4f(0.6f, 0.6f, 0.6f, 1);  ///< Linear RGBA, multiplied by image and tint.
  const Image* image = nullptr;               ///< Outlives the material.
  std::array<Wrap, 2> wrap = {};              ///< Of u and v.
  float cutoff = 0;                           ///< Nothing is there where alpha is below.
  bool is_flesh = false;  ///< Coloured by flesh_color() of the texture coordinates, and wet.
  bool is_skin = false;   ///< Reddened near wounds.
};

struct RenderTriangle {
  std::array<Vec3f, 3> corners;
  std::array<Vec3f, 3> normals;  ///< Unit length; either side.
  std::array<Vec2f, 3> uvs;
  std::array<Vec4f, 3> tints;  ///< Linear RGBA.
  std::uint32_t material = 0;
  bool has_flesh_inside = false;  ///< Seen from behind its normals.
};

/// A still surface, model space, metres, y up.
struct RenderScene {
  std::vector<RenderMaterial> materials;
  std::vector<RenderTriangle> triangles;
  /// The lips of wounds, as segments; skin is reddened within `redness` of them.
  std::vector<std::array<Vec3f, 2>> lips;
  float redness = 0;
  float floor = 0;         ///< Height of the floor, which shows nothing but shadows.
  float floor_radius = 0;  ///< Around the middle of the scene; 0: no floor.
};

}  // namespace sunder::tools
