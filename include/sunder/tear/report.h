#pragma once

#include <sunder/core/index.h>
#include <sunder/core/math.h>

#include <array>
#include <cstdint>
#include <vector>

namespace sunder {

/// The name of a connected component of the surface that an operation separated from others.
/// TornModel::describe_piece() lists and measures it.
struct TornPiece {
  std::uint32_t mesh = 0, triangle = 0;  ///< One of its triangles, at the edge that was cut.
  /// Number of triangles; kNone if the search that named the pieces did not come to all of them.
  std::uint32_t triangle_count = kNone;
  /// Pieces with the same number were one component before the operation.
  std::uint32_t component = 0;
  /// The piece that remains of its component: the one with the largest area in bind space.
  bool is_body = false;
};

/// The pieces of one operation. Up to sixteen are stored without allocation.
class TornPieces {
 public:
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] const TornPiece* begin() const {
    return many_.empty() ? few_.data() : many_.data();
  }
  [[nodiscard]] const TornPiece* end() const { return begin() + count_; }
  [[nodiscard]] const TornPiece& operator[](std::size_t i) const { return begin()[i]; }
  void push_back(const TornPiece& piece) {
    if (count_ == few_.size()) many_.assign(few_.begin(), few_.end());
    if (count_ < few_.size())
      few_[count_] = piece;
    else
      many_.push_back(piece);
    ++count_;
  }

 private:
  std::array<TornPiece, 16> few_ = {};
  std::vector<TornPiece> many_;  ///< All of them, if they are more.
  std::size_t count_ = 0;
};

/// A piece as it is now.
struct PieceDescription {
  struct Triangles {
    std::uint32_t mesh = 0;
    std::vector<std::uint32_t> triangles;  ///< Ascending.
  };
  std::vector<Triangles> meshes;  ///< Ascending by mesh.
  std::uint32_t triangle_count = 0;
  /// Indices, in the skeleton and ascending, of the bones that move a vertex of the piece.
  std::vector<std::uint32_t> bones;
  double area_posed = 0.0;               ///< Square metres.
  Vec3d centroid_posed = Vec3d::Zero();  ///< Area-weighted centroid, model space.
};

/// Figures of the points to which an operation assigned weights: those that lie between vertices.
/// Vertices at one point count once.
struct WeightReport {
  std::uint32_t points = 0;
  /// `pose_exact`: points that kept their interpolated bind positions.
  std::uint32_t ill_conditioned = 0;
  /// `refit`: points that got weights with a smaller error over the poses.
  std::uint32_t refitted = 0;
  /// Points that lost influences to WeightOptions::maximum_influences.
  std::uint32_t pruned = 0;
  /// `refit`: no pose moves a point farther from its exact place than this, metres: with
  /// barycentric weights and as they were fitted. Joints are free, and only points with a
  /// certificate count; see docs/certificate.md. With several roots, a pose in which they slide by
  /// d metres from bind may exceed them by 4e-6 d.
  double certified_barycentric = 0, certified = 0;
  std::uint32_t uncertified = 0;  ///< `refit`: points without a certificate.
};

/// Figures of one operation. Fields that do not apply to the operation are zero.
struct TearReport {
  /// Connected runs of torn surface. 0 if the operation missed; then nothing changed.
  std::uint32_t runs = 0;
  std::uint32_t segments = 0;  ///< Segments of the stroke.
  /// Segments that met no surface within the blade's reach.
  std::uint32_t segments_missed = 0;
  std::uint32_t faces_crossed = 0;
  std::uint32_t points_added = 0;
  std::uint32_t vertices_added = 0;
  std::uint32_t triangles_added = 0;
  /// Retired triangles that existed before the operation.
  std::uint32_t triangles_retired = 0;
  /// Places where the surface could not be torn, because its faces are too small or degenerate.
  std::uint32_t blocked = 0;
  /// Length of the tear without ways along older lips, or of all edges of a cut, on the posed
  /// surface, metres.
  double length_posed = 0.0;
  /// Posed area of the surface that lay in the gap or bore, square metres.
  double area_removed_posed = 0.0;
  WeightReport weights;
  /// Regions of the flat section that were closed, counted once per side.
  std::uint32_t caps = 0;
  /// Rims of a cut or bore that got no cap or wall, for example because they do not close.
  std::uint32_t open_sections = 0;
  /// The separated pieces. For a tear or bore: the connected components that were part of a larger
  /// one before, without the bodies. For a cut: every component with an edge on the cut, if the cut
  /// separated any of what it was part of.
  TornPieces pieces;
};

}  // namespace sunder
