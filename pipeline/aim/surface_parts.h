#pragma once

#include <vector>

#include "pipeline/aim/limb.h"

namespace sunder::aim {

/// The connected parts of the surface as it was before it was torn, and which of them is the body
/// that a limb is a part of: not the shield in its hand, the tusks, the eyes or the hair.
class SurfaceParts {
 public:
  /// O(faces x influences).
  explicit SurfaceParts(const Limb& limb);

  /// Whether a face is of the body: of the part whose surface the limb shares with other bones,
  /// most of both. Of a limb that shares none, as a robot's, all larger parts are its body; of
  /// one that consists of faces that are not joined, all.
  [[nodiscard]] bool is_of_body(Index face) const { return parts_[part_of_face_[face]].is_body; }
  /// Whether a face is of another part than the body, which the limb alone moves.
  [[nodiscard]] bool is_of_prop(Index face) const;
  /// How much of the surface a face is: the mean of its share of the posed area and of the faces,
  /// so that neither a large shield nor a finely modelled clasp counts for all. 0 if it is retired
  /// or degenerate.
  [[nodiscard]] double size(Index face) const { return sizes_[face]; }
  /// How much of the surface a point is: the mean of its share of the places of live faces, which
  /// points in one place divide, and of the area, a third of each face at it.
  [[nodiscard]] double size_of_point(Index point) const { return point_sizes_[point]; }
  /// The first point in the same place.
  [[nodiscard]] Index place_of(Index point) const { return place_of_point_[point]; }
  /// The size of the face times the share of it that the limb moves.
  [[nodiscard]] double moved_size(Index face) const { return moved_sizes_[face]; }

 private:
  struct Part {
    double size = 0, moved = 0;
    bool is_body = false;
  };
  void find_parts(const PosedSurface& surface);
  void measure(const Limb& limb);
  void measure_points(const PosedSurface& surface);
  void choose_body();

  std::vector<Index> part_of_face_;
  std::vector<double> sizes_, moved_sizes_;  ///< Per face.
  std::vector<double> point_sizes_;
  std::vector<Index> place_of_point_;
  std::vector<Part> parts_;
};

}  // namespace sunder::aim
