#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/validation/checks/weight_rows.h"

namespace sunder::validation {

/// An attribute whose values a vertex of the target is to have from the source's surface.
enum class FaceAttribute : std::uint8_t { normals, tangents, uv };

/// Compares attributes of vertices of the target with those of the places on the source that they
/// were matched to, whether these are vertices, on edges or inside faces.
///
/// Only vertices on the surface are compared: those whose match is within 1e-6 of the diagonal and
/// around which every face lies in a face of the source at that place. That leaves out walls and
/// caps, and surfaces that were made anew. Where several faces of the source meet, at seams, hard
/// edges and between layers, the least difference from any of them counts.
class FaceAttributes {
 public:
  explicit FaceAttributes(const RowReader& reader) : reader_(reader) {}

  /// @param threshold  from which a difference counts; smaller ones are not made exact.
  /// @return the angle, radians, or the largest difference of a texture coordinate of any set that
  /// both meshes have; 0 where nothing is to be compared. O(1) below the threshold, else a search.
  [[nodiscard]] double difference(FaceAttribute attribute, Index mesh, Index vertex,
                                  double threshold);

 private:
  struct Query {
    FaceAttribute attribute;
    Index mesh, vertex;  ///< Of the target.
    double threshold;
  };
  [[nodiscard]] bool is_comparable(FaceAttribute attribute, Index mesh, Index vertex) const;
  [[nodiscard]] bool lies_in(Index vertex, std::span<const SurfacePlace> faces);
  [[nodiscard]] double excess(const Query& query, const SurfacePlace& place) const;

  const RowReader& reader_;
  std::optional<SurfaceSearch> search_;    // on the source, built when first needed
  std::vector<Index> first_face_, faces_;  // of the vertices of the target's surface, back to back
  WeightRow actual_, expected_;
};

}  // namespace sunder::validation
