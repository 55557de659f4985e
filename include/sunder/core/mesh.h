#pragma once

#include <sunder/core/math.h>
#include <sunder/core/skin.h>

#include <array>
#include <string>
#include <vector>

namespace sunder {

using Triangle = std::array<std::uint32_t, 3>;  ///< Vertices, counter-clockwise from outside.

/// A triangle that an operation took away keeps its number and names one vertex three times:
/// buffers that mirror the mesh draw nothing there. Files are written without it.
[[nodiscard]] constexpr bool is_retired(const Triangle& triangle) {
  return triangle[0] == triangle[1] && triangle[1] == triangle[2];
}

/// Whether two triangles have the same vertices in the same order. (The comparison of arrays calls
/// into the C library.)
[[nodiscard]] constexpr bool is_same(const Triangle& a, const Triangle& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// Displacements added to a mesh in bind space, scaled by the target's weight. An array is empty or
/// has one entry per vertex.
struct MorphTarget {
  std::string name;
  std::vector<Vec3f> position_deltas;
  std::vector<Vec3f> normal_deltas;
  std::vector<Vec3f> tangent_deltas;

  bool operator==(const MorphTarget&) const = default;
};

/// An attribute that Sunder gives no meaning to and carries along.
struct CustomAttribute {
  std::string name;              ///< glTF style: "_FEATURE_ID_0".
  std::uint32_t components = 1;  ///< Floats per vertex, 1 to 4.
  bool interpolates = true;      ///< false: a label; a new vertex takes its nearest parent's.
  std::vector<float> values;     ///< V x components.

  bool operator==(const CustomAttribute&) const = default;
};

/// Triangles that share a material.
struct Submesh {
  std::string name;
  std::uint32_t material = kNone;  ///< The source file's index.

  bool operator==(const Submesh&) const = default;
};

/// A triangle mesh in bind space with one skin. Every array with "V" has one entry per vertex or,
/// if optional, none.
struct Mesh {
  std::string name;
  std::uint32_t skin = 0;  ///< In Character::skins.

  std::vector<Vec3f> positions;  ///< V.
  std::vector<Vec3f> normals;    ///< V or none. Unit length.
  std::vector<Vec4f> tangents;   ///< V or none. Unit xyz; w = +1 or -1, the bitangent's sign.
  std::vector<std::vector<Vec2f>> uv_sets;     ///< Each V.
  std::vector<std::vector<Vec4f>> color_sets;  ///< Each V. Linear RGBA.
  std::vector<CustomAttribute> custom_attributes;
  SkinWeights weights;  ///< V.

  std::vector<MorphTarget> morph_targets;
  std::uint32_t first_morph_weight = 0;  ///< Weight of morph target 0 in Pose::morph_weights.

  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> triangle_submesh;  ///< One a triangle, in `submeshes`.
  std::vector<Submesh> submeshes;

  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(positions.size());
  }
  [[nodiscard]] std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(triangles.size());
  }

  bool operator==(const Mesh&) const = default;
};

/// Name of the custom attribute that keeps the two lips of a tear apart: coincident vertices of one
/// surface differ in it.
inline constexpr const char* kTearSideAttribute = "_TEARSIDE";

/// The same values once more in glTF files, under a name that tools keep which drop attributes they
/// do not know.
inline constexpr const char* kTearSideFeatureAttribute = "_FEATURE_ID_7353";

}  // namespace sunder
