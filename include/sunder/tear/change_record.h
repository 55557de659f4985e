#pragma once

#include <sunder/core/api.h>
#include <sunder/core/index.h>
#include <sunder/core/mesh.h>

#include <array>
#include <span>
#include <vector>

namespace sunder {

/// The origin of a new vertex: a triangle of the source mesh and a place in it. Every attribute is
/// derived from the birth, so errors do not accumulate over operations.
struct Birth {
  /// Index in the source mesh. From its triangle count on: a triangle of a wall or cap, see
  /// TornModel::fillings().
  std::uint32_t triangle = 0;
  std::array<double, 3> barycentric = {1.0, 0, 0};  ///< Per corner; >= 0, sum 1.

  bool operator==(const Birth&) const = default;
};

/// A triangle whose corners now refer to other vertices.
struct RewrittenTriangle {
  std::uint32_t triangle = 0;  ///< Index in Mesh::triangles.
  Triangle before = {};

  bool operator==(const RewrittenTriangle&) const = default;
};

/// The parts of a buffer that have to be uploaded again: at most eight separate ranges, ascending.
/// If more places changed, the ranges also cover elements that did not.
class DirtyRanges {
 public:
  static constexpr std::size_t kMaximum = 8;

  /// @param elements  ascending; repeated elements count once. The seven widest gaps between them
  ///         separate the ranges; of equally wide gaps the first. O(elements).
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
  std::vector<Birth> births;                             ///< Per appended vertex.
  /// Ascending by triangle; includes the retired ones.
  std::vector<RewrittenTriangle> rewritten;
  /// Triangles that are is_retired() from now on, ascending.
  std::vector<std::uint32_t> retired;
  /// Appended vertices, and those whose tear side changed.
  DirtyRanges dirty_vertices;
  DirtyRanges dirty_triangles;  ///< Appended and rewritten triangles.
  /// Vertices that only a detached piece used, ascending: they need no skinning any more. Undo
  /// lists them as `returned`, redo as `released` again. See SkinnedMesh::release().
  std::vector<std::uint32_t> released, returned;
};

/// Two surface points that were one before the tear, left and right of the stroke's direction as
/// seen from outside. For a cut, left is the side to which the plane's normal points.
struct LipPair {
  std::uint32_t left = 0;
  std::uint32_t right = 0;

  bool operator==(const LipPair&) const = default;
};

/// The surface points on the two sides of a gap, each side ascending. Left and right are those of
/// LipPair. A corner between a side and an end belongs to the side; points between the corners of
/// an end are in neither. No point is in both: if a stroke crosses its own gap, the later segment
/// decides.
struct Rims {
  std::vector<std::uint32_t> left;
  std::vector<std::uint32_t> right;

  bool operator==(const Rims&) const = default;
};

/// A surface point on an edge that a weld closed, and the one that gave it its faces and has none
/// any more; the same one at the tips of a wound, where there was one only.
struct WeldedPoint {
  std::uint32_t kept = 0, lost = 0;

  bool operator==(const WeldedPoint&) const = default;
};

/// A thread of a suture. It may have broken: thread_loads() tells.
struct SutureThread {
  /// Surface points. A later weld or detachment may have left one of them without faces: then the
  /// thread holds nothing.
  std::uint32_t left = 0, right = 0;
  double stiffness = 0, tension = 0, strength = 0;  ///< As in Suture.

  bool operator==(const SutureThread&) const = default;
};

/// The changes by one call, for engine buffers, particles, bounds and other mirrors of the model.
struct ChangeRecord {
  std::uint32_t first_point = 0, point_count = 0;  ///< Surface points appended.
  std::vector<MeshChange> meshes;                  ///< The meshes that changed, ascending.
  /// In order along the tear. Gaps, cuts and bores list only the pairs of opened edges. Tips are
  /// single points and not listed.
  std::vector<LipPair> lips;
  /// For a gap: the points on its two sides. All have a face, and lie on a border or on a rim at
  /// which a wall starts. Empty for a bore, which has one rim and no sides.
  Rims rims;
  /// The points that a weld closed, ascending. The undo of a weld lists the same ones: it separates
  /// them again.
  std::vector<WeldedPoint> welded;
};

}  // namespace sunder
