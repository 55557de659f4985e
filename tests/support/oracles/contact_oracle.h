#pragma once

#include <sunder/core/character.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace sunder::test {

/// The posed surface as a list of triangles, searched one by one: the reference for queries. No
/// tree, no topology, and other formulas.
class ContactOracle {
 public:
  struct Face {
    std::uint32_t mesh = 0, triangle = 0;
    std::array<Vec3d, 3> corners;
  };
  /// @param positions  of all vertices, per mesh.
  ContactOracle(const Character& character, const std::vector<std::vector<Vec3d>>& positions);

  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }

  struct Crossing {
    const Face* face = nullptr;
    double along = 0;  ///< In units of `way`.
    bool enters = true;
    /// The least barycentric coordinate, of either sign: near 0 it is a matter of rounding whether
    /// the face is met.
    double least = 0;
  };
  /// All crossings of the half-line with faces, also those that miss a face by less than `margin`
  /// (barycentric), ascending along it.
  [[nodiscard]] std::vector<Crossing> crossings(const Vec3d& base, const Vec3d& way,
                                                double margin) const;

  /// The least distance of the surface from a segment.
  [[nodiscard]] double distance(const Vec3d& base, const Vec3d& tip) const;
  /// The solid angle of the surface as seen from a point, as a fraction of the full one: 1 inside a
  /// closed surface, 0 outside.
  [[nodiscard]] double winding(const Vec3d& point) const;

 private:
  std::vector<Face> faces_;
};

/// The distance of a point and a triangle.
double point_distance(const Vec3d& point, const std::array<Vec3d, 3>& corners);

}  // namespace sunder::test
