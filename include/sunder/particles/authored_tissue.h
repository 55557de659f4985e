#pragma once

#include <sunder/core/character.h>
#include <sunder/core/status.h>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sunder {

/// Factors by which the tissue of a mesh differs from its SoftMaterial, per vertex of the source.
/// They are factors, not values of their own, so that one painted mask serves every material, and
/// 1 everywhere is the material alone, bit for bit. An array is empty, which is 1 everywhere, or
/// has one entry per vertex. In between, they are linear on each triangle of the source, also at
/// vertices that operations create.
struct TissueFactors {
  std::vector<float> strength;   ///< Of `strength` - 1, the strain that is borne. [0.001, 1000].
  std::vector<float> toughness;  ///< Of `toughness`, or of `flaw_length`. [0.001, 1000].
  std::vector<float> stiffness;  ///< Of `membrane_stiffness`. [0.001, 1000].
  std::vector<float> tension;    ///< Of the tension at lips. [0, 1000].
  /// Of the thickness: of `areal_density`, `membrane_stiffness`, `membrane_damping` and
  /// `toughness` at once. [0.001, 1000].
  std::vector<float> thickness;

  bool operator==(const TissueFactors&) const = default;
};

/// A place on the source's surface.
struct SourcePlace {
  std::uint32_t mesh = 0, triangle = 0;
  std::array<double, 3> barycentric = {1.0, 0.0, 0.0};  ///< Per corner; >= 0, sum 1 within 1e-6.

  bool operator==(const SourcePlace&) const = default;
};

/// A line along which tissue is weaker, such as the holes between stamps. Tearing by force runs
/// along it where that takes less: see tear_overstretched().
struct Perforation {
  /// At least two places, straight in between. It is closed if the last is the first.
  std::vector<SourcePlace> line;
  double strength = 0.3;  ///< Of the toughness and of the strain that is borne. [0.001, 1].

  bool operator==(const Perforation&) const = default;
};

/// What an author gives a surface in addition to its materials.
struct AuthoredTissue {
  std::vector<TissueFactors> meshes;  ///< Empty, or one per mesh of the character.
  std::vector<Perforation> perforations;

  [[nodiscard]] bool empty() const { return meshes.empty() && perforations.empty(); }
  bool operator==(const AuthoredTissue&) const = default;
};

/// Checks sizes, ranges, and places.
/// @return size_mismatch, non_finite_value, invalid_argument or index_out_of_range; the text names
///         the mesh and the vertex, or the perforation and its place. O(vertices). Thread-safe.
[[nodiscard]] SUNDER_API Status validate_authored_tissue(const AuthoredTissue& tissue,
                                                         const Character& character);

// ---- Where the values of a field come from.

/// A channel of a colour, 0 to 3 for r, g, b, a; linear, as in Mesh::color_sets.
struct VertexColor {
  std::uint32_t set = 0, channel = 0;
};
/// A component of a custom attribute, such as "_STRENGTH".
struct VertexAttribute {
  std::string name;
  std::uint32_t component = 0;
};
/// The weight of a bone, 0 to 1.
struct BoneWeight {
  std::string bone;
};
/// A channel of an image at the UVs, bilinear, repeated beyond [0, 1]. The bytes are read as they
/// are, 0 as 0 and 255 as 1: masks are not colours.
struct TextureChannel {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  ///< Row by row, the first one at v = 0; 4 width height bytes.
  std::uint32_t uv_set = 0, channel = 0;
};

/// A field of one mesh: the value v of the source becomes at_zero + (at_one - at_zero) v.
struct FieldSource {
  std::variant<VertexColor, VertexAttribute, BoneWeight, TextureChannel> from;
  double at_zero = 0.0, at_one = 1.0;
};

/// Samples a field at the vertices of a mesh.
/// @return index_out_of_range for a mesh, set, channel or component that does not exist; not_found
///         for an attribute or bone; size_mismatch for an image; non_finite_value for a value, with
///         its vertex; limit_exceeded if out of memory. O(vertices + influences). Thread-safe.
[[nodiscard]] SUNDER_API Result<std::vector<float>> sample_field(const Character& character,
                                                                 std::uint32_t mesh,
                                                                 const FieldSource& source);

/// The array of a name: "strength", "toughness", "stiffness", "tension" or "thickness". Null for
/// any other. Thread-safe.
[[nodiscard]] SUNDER_API std::vector<float>* find_field(TissueFactors& factors,
                                                        std::string_view name);

}  // namespace sunder
