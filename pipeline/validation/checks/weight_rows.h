#pragma once

#include <vector>

#include "pipeline/validation/checks/skinned.h"
#include "pipeline/validation/internal/weight_row.h"
#include "pipeline/validation/match/bone_match.h"
#include "pipeline/validation/match/surface_match.h"

namespace sunder::validation {

[[nodiscard]] double weight_of(const WeightRow& row, Index bone);

/// Weights of the target beside those that its match on the source has. Everything in bones of the
/// source; a bone of the target without counterpart has a number behind those of the source:
/// source bones + its own.
class RowReader {
 public:
  /// All outlive the reader.
  /// @param replayed  the source after the operations that made the target, if its vertices are
  ///                  those of the target; null otherwise.
  RowReader(const Skinned& source, const Skinned& target, const SurfaceMatches& matches,
            const BoneMatch& bones, const Character* replayed = nullptr);

  [[nodiscard]] const SurfaceMatch& match(Index mesh, Index vertex) const {
    return matches_.of(mesh, vertex);
  }
  /// The weights of a vertex of the target.
  void actual(Index mesh, Index vertex, WeightRow& row) const;
  /// Those of the matched place: interpolated over the triangle with these coordinates.
  void expected(const SurfaceMatch& match, const std::array<double, 3>& barycentric,
                WeightRow& row) const;
  /// The weights that a vertex of the target should have: those of its match or, as a vertex of a
  /// wall or cap has none, those that the operations give it.
  /// @return false if neither is known.
  [[nodiscard]] bool expected_at(Index mesh, Index vertex, WeightRow& row) const;
  /// Whether a vertex has the very weights of the corner it was matched to. No rows are made.
  [[nodiscard]] bool is_same(Index mesh, Index vertex) const;
  /// A bone of the target for a number in a row; kNone: it has none.
  [[nodiscard]] Index target_bone(Index number) const;
  [[nodiscard]] Index source_bone_count() const {
    return static_cast<Index>(source_.character.skeleton.bones.size());
  }

  const Skinned& source() const { return source_; }
  const Skinned& target() const { return target_; }
  const BoneMatch& bones() const { return bones_; }

 private:
  const Skinned &source_, &target_;
  const SurfaceMatches& matches_;
  const BoneMatch& bones_;
  const Character* replayed_;
  /// Per skin of the target and skin of the source: all slots mean the same bones.
  std::vector<std::vector<bool>> same_slots_;
};

/// A vertex of the target whose weights are not those of its match.
struct DifferentRow {
  Index mesh = 0;
  Index vertex = 0;
  double l1 = 0.0;
};

/// All of them with an accepted match, beyond rounding, in the order of vertices.
[[nodiscard]] std::vector<DifferentRow> find_different_rows(const RowReader& reader);

/// The corner that a match lies in, or 3 where it lies between corners.
[[nodiscard]] std::size_t corner_of(const SurfaceMatch& match);

}  // namespace sunder::validation
