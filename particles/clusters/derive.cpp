#include "particles/clusters/derive.h"

#include <algorithm>

#include "particles/clusters/cells.h"
#include "particles/clusters/influences.h"

namespace sunder::particles {
namespace {

class Derivation {
 public:
  Derivation(Structure& structure, const Structure& decomposition)
      : structure_(structure), decomposition_(decomposition), points_(structure.points) {}

  void points_now() {
    const std::size_t known = decomposition_.points.count();
    points_.influences.resize(points_.count());
    points_.owners.resize(points_.count(), kNone);
    for (Index p = 0; p < points_.count(); ++p)
      if (p >= known || !is_of_decomposition(p, points_.slabs[p]))
        set(points_.slabs[p], points_.influences[p], points_.owners[p]);
  }
  void points_before() {
    for (Change& change : structure_.tears.done)
      change.changed_points.for_each(
          [&](Change::OfPoint& of) { set(of.slab, of.influences, of.owner); });
  }
  void members() {
    structure_.members.joined.assign(structure_.particles.size(), {});
    for (Index p = 0; p < points_.count(); ++p) join(p, points_.slabs[p]);
    for (const Change& change : structure_.tears.done)
      change.changed_points.for_each([&](const Change::OfPoint& of) { join(of.point, of.slab); });
    for (std::vector<Index>& joined : structure_.members.joined) MemberLists::drop_repeated(joined);
  }

 private:
  [[nodiscard]] bool is_of_decomposition(Index point, const MembershipSlab& slab) const {
    if (point >= decomposition_.points.count()) return false;
    const MembershipSlab& before = decomposition_.points.slabs[point];
    return slab.first == before.first && slab.count == before.count;
  }
  void set(const MembershipSlab& slab, ParticleInfluences& influences, Index& owner) const {
    const auto memberships = points_.memberships.at(slab.first, slab.count);
    influences = influences_from(memberships);
    owner = owner_of(memberships, structure_.particles);
  }
  /// Lists a point with its particles, unless the decomposition does.
  void join(Index point, const MembershipSlab& slab) {
    if (is_of_decomposition(point, slab)) return;
    const bool is_old = point < decomposition_.points.count();
    for (const ParticleMembership& of : points_.memberships.at(slab.first, slab.count))
      if (!is_old || decomposition_.points.find(point, of.particle) == nullptr)
        structure_.members.joined[of.particle].push_back(point);
  }

  Structure& structure_;
  const Structure& decomposition_;
  PointTable& points_;
};

}  // namespace

void derive(Structure& structure, const Structure& decomposition) {
  Derivation derivation(structure, decomposition);
  derivation.points_now();
  derivation.points_before();
  derivation.members();
}

}  // namespace sunder::particles
