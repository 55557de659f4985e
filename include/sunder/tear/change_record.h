#pragma once

#include <sunder/core/api.h>
#include <sunder/core/index.h>
#include <sunder/core/mesh.h>

#include <array>
#include <span>
#include <vector>

namespace sunder {

/// Where a new vertex came from: a triangle of the source mesh and a place in it. Every attribute
/// is derived from the birth, so errors do not accumulate over operations.
struct Birth {
  std::uint32_t triangle = 0;  ///< In the source mesh; beyond its last: of a wall or cap.
  std::array<double, 3> barycentric = {1.0, 0, 0};  ///< Of its corners; >= 0, sum 1.

  bool operator==(const Birth&) const = default;
};

/// A triangle whose corners refer to other vertices now.
struct RewrittenTriangle {
  std::uint32_t triangle = 0;  ///< In Mesh::triangles.
  Triangle before = {};

  bool operator==(const RewrittenTriangle&) const = default;
};

/// The parts of a buffer that have to be uploaded again: at most eight separate ranges, ascending.
/// If more places changed, the ranges also cover elements that did not.
class DirtyRanges {
 public:
  static constexpr std::size_t kMaximum = 8;

  /// @param elements  ascending; repeated ones count once. The seven widest gaps stay apart, of
  /// equal ones the first. O(elements).
  SUNDER_API static DirtyRanges covering(std::span<const std::uint32_t> elements);

  [[nodiscard]] const IndexRange* begin() const { return ranges_.data(); }
  [[nodiscard]] const IndexRange* end() const { return ranges_.data() + count_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  bool operator==(const DirtyRanges&) const = default;

 private:
  std::array<IndexRange, kMaximum> ranges_ = {};
  std::size_t count_ = 0;
};

/// The changes of one mesh by one call. Vertices and triangles are only appended, and removed from
/// the end by undo: indices stay valid. Afterwards the mesh has first_vertex + vertex_count
/// vertices and first_triangle + triangle_count triangles.
struct MeshChange {
  std::uint32_t mesh = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;      ///< Appended.
  std::uint32_t first_triangle = 0, triangle_count = 0;  ///< Appended.
  std::vector<Birth> births;                             ///< Of the appended vertices.
  std::vector<RewrittenTriangle> rewritten;  ///< Ascending by triangle; the retired ones too.
  std::vector<std::uint32_t> retired;        ///< Ascending: is_retired() from now on.
  DirtyRanges dirty_vertices;                ///< Appended ones, and those whose tear side changed.
  DirtyRanges dirty_triangles;               ///< Appended and rewritten ones.
};

/// Two surface points that were one before the tear, left and right of the stroke's direction as
/// seen from outside. For a cut, left is the side to which the plane's normal points.
struct LipPair {
  std::uint32_t left = 0;
  std::uint32_t right = 0;

  bool operator==(const LipPair&) const = default;
};

/// The surface points on the two sides of a gap, each side ascending; left and right as of a
/// LipPair. A corner where a side meets an end belongs to its side; what lies between the corners
/// of an end is in neither. No point is in both: where a stroke crosses its own gap, the later
/// segment says.
struct Rims {
  std::vector<std::uint32_t> left;
  std::vector<std::uint32_t> right;

  bool operator==(const Rims&) const = default;
};

/// The changes by one call, for engine buffers, particles, bounds and other mirrors of the model.
struct ChangeRecord {
  std::uint32_t first_point = 0, point_count = 0;  ///< Surface points appended.
  std::vector<MeshChange> meshes;                  ///< Those that changed, ascending.
  /// In order along the tear; of a gap, cut or bore no pairs but those of an opened edge. Tips are
  /// single points and not listed.
  std::vector<LipPair> lips;
  /// Of a gap: what the call left at its two sides. All have a face, and lie on a border, or where
  /// it was before a wall was hung from it. Of a bore none: it has one rim, and no sides.
  Rims rims;
};

}  // namespace sunder
