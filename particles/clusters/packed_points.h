#pragma once

#include "particles/clusters/packed_column.h"
#include "particles/clusters/structure.h"

namespace sunder::particles {

/// What the columns of a structure have of their own. The structure keeps the rest of its data, and
/// an unpacked one is the same bit for bit.
class PackedPoints {
 public:
  /// Empties the columns of `structure`, and drops its scratch memory.
  /// @param structure  settled, between operations, with up-to-date gradients if it has any.
  /// @param shared     the structure that it is a copy of.
  /// @throws std::bad_alloc, and changes nothing.
  PackedPoints(Structure& structure, const Structure& shared);
  /// @throws std::bad_alloc; can be called again then.
  void unpack(Structure& structure, const Structure& shared) const;
  [[nodiscard]] Index point_count() const { return point_count_; }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  struct Columns {
    PackedColumn<Vec3f> positions;
    PackedColumn<VertexRef> vertices;
    PackedColumn<MembershipSlab> slabs;
    PackedColumn<ParticleInfluences> influences;
    PackedColumn<Index> owners;
    PackedColumn<LipPoint> lip_points;
  };
  Index point_count_ = 0;
  Columns columns_;
  PackedColumn<PointFactors> factors_;
  std::vector<PackedColumn<Index>> vertex_points_;  ///< Per mesh.
  PackedColumn<ParticleGradients> gradients_;
};

}  // namespace sunder::particles
