#pragma once

#include <sunder/core/math.h>
#include <sunder/core/skin.h>

#include <array>
#include <string>
#include <vector>

namespace sunder {

using Triangle = std::array<std::uint32_t, 3>;  ///< Vertices, counter-clockwise from outside.

/// Whether an operation removed the triangle. A removed triangle keeps its index and names one
/// vertex three times, so that nothing is drawn there. It is not written to files.
[[nodiscard]] constexpr bool is_retired(const Triangle& triangle) {
  return triangle[0] == triangle[1] && triangle[1] == triangle[2];
}

/// Whether two triangles have the same vertices in the same order. (Faster than `==` of arrays,
/// which calls the C library.)
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

/// A vertex attribute without a meaning to Sunder. Operations keep it and interpolate it.
struct CustomAttribute {
  std::string name;              ///< glTF style: "_FEATURE_ID_0".
  std::uint32_t components = 1;  ///< Floats per vertex, 1 to 4.
  bool interpolates = true;   ///< false: a label, copied to a new vertex from its nearest parent.
  std::vector<float> values;  ///< V x components.

  bool operator==(const CustomAttribute&) const = default;
};

/// Triangles that share a material.
struct Submesh {
  std::string name;
  std::uint32_t material = kNone;  ///< Index in the source file.

  bool operator==(const Submesh&) const = default;
};

/// A triangle mesh in bind space with one skin. Arrays marked "V" have one entry per vertex;
/// arrays marked "V or none" may be empty.
struct Mesh {
  std::string name;
  std::uint32_t skin = 0;  ///< Index in Character::skins.

  std::vector<Vec3f> positions;  ///< V.
  std::vector<Vec3f> normals;    ///< V or none. Unit length.
  std::vector<Vec4f> tangents;   ///< V or none. xyz of unit length; w is the bitangent's sign, ±1.
  std::vector<std::vector<Vec2f>> uv_sets;     ///< Each V.
  std::vector<std::vector<Vec4f>> color_sets;  ///< Each V. Linear RGBA.
  std::vector<CustomAttribute> custom_attributes;
  SkinWeights weights;  ///< V.

  std::vector<MorphTarget> morph_targets;
  std::uint32_t first_morph_weight = 0;  ///< Index of target 0's weight in Pose::morph_weights.

  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> triangle_submesh;  ///< One per triangle: index in `submeshes`.
  std::vector<Submesh> submeshes;

  [[nodiscard]] std::uint32_t vertex_count() const {
    return static_cast<std::uint32_t>(positions.size());
  }
  [[nodiscard]] std::uint32_t triangle_count() const {
    return static_cast<std::uint32_t>(triangles.size());
  }

  bool operator==(const Mesh&) const = default;
};

/// Name of the custom attribute that keeps the two lips of a tear apart in other tools: coincident
/// vertices on opposite lips have different values.
inline constexpr const char* kTearSideAttribute = "_TEARSIDE";

/// A second name for the same values in glTF files: some tools drop every custom attribute except
/// feature ids.
inline constexpr const char* kTearSideFeatureAttribute = "_FEATURE_ID_7353";

}  // namespace sunder
