#pragma once

#include <sunder/particles/particle_set.h>

#include "particles/clusters/lip_point.h"
#include "particles/clusters/membership_list.h"

namespace sunder::particles {

/// A vertex of a mesh.
struct VertexRef {
  Index mesh = 0, vertex = kNone;
};

/// Reserves room for `count` entries and an eighth more, if the array has less. By itself an array
/// would double.
template <class T>
void reserve_eighth(std::vector<T>& values, std::size_t count) {
  if (values.capacity() < count) values.reserve(count + count / 8 + 1024);
}

/// The range of a point's memberships in PointTable::memberships.
struct MembershipSlab {
  Index first = 0, count = 0;
};

/// One entry per point in every column.
struct PointColumns {
  std::vector<Vec3f> positions;  ///< In the decomposition's pose, metres.
  /// One vertex of the point: the one that it had when it came. All vertices of a point have the
  /// same weights.
  std::vector<VertexRef> vertices;
  std::vector<MembershipSlab> slabs;
  std::vector<ParticleInfluences> influences;
  std::vector<Index> owners;  ///< The particle in whose cell the point is; kNone: none.
  std::vector<LipPoint> lip_points;

  /// Calls visit(the column of each of `tables`) for each column; the only place that lists them.
  template <class Visit, class... Tables>
  static void for_each_column(Visit visit, Tables&... tables) {
    visit(tables.positions...);
    visit(tables.vertices...);
    visit(tables.slabs...);
    visit(tables.influences...);
    visit(tables.owners...);
    visit(tables.lip_points...);
  }
};

/// Ends of the used entries of tables to which changes append; entries of undone changes follow.
struct TableEnds {
  std::size_t memberships = 0, older_lips = 0;
};

/// The points of the surface and the particles that they belong to.
struct PointTable : PointColumns {
  /// The memberships of a point are contiguous, ascending by particle. A change appends the new
  /// ones and leaves the old ones in place, for undo.
  MembershipList memberships;
  std::vector<OnLip> older_lips;
  TableEnds ends;

  [[nodiscard]] Index count() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] std::span<const ParticleMembership> memberships_of(Index point) const {
    return memberships.at(slabs[point].first, slabs[point].count);
  }
  /// Whether a point has the memberships that the decomposition gave it.
  [[nodiscard]] bool has_decomposed(Index point) const {
    return slabs[point].count > 0 && slabs[point].first < memberships.decomposed_count();
  }
  [[nodiscard]] const ParticleMembership* find(Index point, Index particle) const {
    for (const ParticleMembership& membership : memberships_of(point))
      if (membership.particle == particle) return &membership;
    return nullptr;
  }

  /// Calls visit(tear, side) for each lip that a point is on, the newest first.
  template <class Visit>
  void for_each_lip(Index point, Visit visit) const {
    for (const OnLip* lip = &lip_points[point]; lip->tear != kNone; lip = &older_lips[lip->older]) {
      visit(lip->tear, lip->side);
      if (lip->older == kNone) return;
    }
  }
  [[nodiscard]] bool is_on_lip(Index point, Index tear, Side side) const {
    bool is = false;
    for_each_lip(point, [&](Index of, Side on) { is |= of == tear && on == side; });
    return is;
  }
  /// Puts a point on a lip. It stays on the lips of other tears; later tears have higher numbers.
  void put_on_lip(Index point, Index tear, Side side);
  /// Removes the entries of undone changes, which cannot be redone any more.
  void drop_undone();
  /// Makes room for new points, by an eighth at a time.
  void make_room(std::size_t points);
};

}  // namespace sunder::particles
