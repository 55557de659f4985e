#include "particles/clusters/check_sums.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/clusters/cells.h"
#include "particles/clusters/member_search.h"
#include "particles/clusters/rest_terms.h"
#include "particles/clusters/torn_meshes.h"

namespace sunder::particles {
namespace {

/// Rounding of sums that were changed many times, relative to what was added: of borders and of
/// members; of areas, all of which are positive.
constexpr double kRounding = 1e-8, kAreaRounding = 5e-10;

Status differs(const char* what, Index index) {
  return Status::failure(StatusCode::invalid_argument, index, "a recorded state of particles: %s",
                         what);
}

/// Every vertex that a face uses is at one of the points that use it.
Status check_vertex_points(const Structure& structure, const TornModel& model) {
  const tear::Surface& surface = model.surface();
  std::vector<std::vector<std::uint8_t>> is_found;
  for (const auto& of_mesh : structure.vertex_points.of_mesh) is_found.emplace_back(of_mesh.size());
  const auto for_each_corner = [&](auto visit) {
    for (Index t = 0; t < surface.triangle_count(); ++t) {
      if (surface.has_repeated_point(t)) continue;
      const tear::TriangleRef ref = surface.triangle(t);
      for (Index corner = 3 * t; corner < 3 * t + 3; ++corner)
        visit(ref.mesh, vertex_at(model, ref, corner), surface.corner_point[corner]);
    }
  };
  for_each_corner([&](Index mesh, Index vertex, Index point) {
    if (structure.vertex_points.of_mesh[mesh][vertex] == point) is_found[mesh][vertex] = 1;
  });
  Index lost = kNone;
  for_each_corner([&](Index mesh, Index vertex, Index) {
    if (is_found[mesh][vertex] == 0) lost = vertex;
  });
  return lost == kNone ? Status() : differs("a vertex is not at its point", lost);
}

Status check_points(const Structure& structure, const TornModel& model) {
  const std::vector<Index>& corners = model.surface().point_corner;
  for (Index p = 0; p < structure.points.count(); ++p)
    if ((corners[p] != kNone) != (structure.points.slabs[p].count > 0))
      return differs("a point has a face and no particle, or a particle and no face", p);
  return {};
}

/// The cell of a particle.
struct Cell {
  double area = 0;
  std::vector<ParticleNeighbour> neighbours;
};

/// @param range  of a particle, metres. @param place  distance of its seed from the origin.
bool are_alike(const ParticleNeighbour& a, const ParticleNeighbour& b, double range, double place) {
  return a.particle == b.particle && a.edges == b.edges &&
         norm(Vec3d(a.across - b.across)) <= kRounding * (norm(a.across) + range) &&
         norm(Vec3d(a.middles - b.middles)) <= kRounding * (place + range) * a.edges;
}

Status check_cells(Structure& structure, const TornModel& model) {
  std::vector<Cell> kept(structure.particles.size());
  const auto exchange = [&] {
    for (Index p = 0; p < kept.size(); ++p) {
      std::swap(kept[p].area, structure.particles[p].area);
      std::swap(kept[p].neighbours, structure.particles[p].neighbours);
    }
  };
  exchange();
  sum_cells(model.surface(), structure);
  exchange();
  for (Index p = 0; p < kept.size(); ++p) {
    const Particle& of = structure.particles[p];
    const double range = of.range,
                 place = norm(Vec3d(structure.points.positions[of.seed].cast<double>()));
    const bool is_alike =
        std::abs(kept[p].area - of.area) <= kAreaRounding * (kept[p].area + range * range) &&
        std::ranges::equal(kept[p].neighbours, of.neighbours, [&](const auto& a, const auto& b) {
          return are_alike(a, b, range, place);
        });
    if (!is_alike) return differs("a cell is another one than its points say", p);
    for (const ParticleNeighbour& neighbour : of.neighbours) {
      const double coupling = coupling_of(structure, p, neighbour);
      if (!(std::abs(coupling - neighbour.coupling) <= kRounding * coupling))
        return differs("a coupling is not that of its border", p);
    }
  }
  return {};
}

/// Compares the sums of particles with others.
class TermComparison {
 public:
  explicit TermComparison(Index slots) : sums_(slots, Vec4d::Zero()) {}

  /// @param largest  of what one member adds.
  bool are_alike(const Particle& a, const Particle& b, double largest) {
    for (const RestTerm& term : a.terms) sums_[term.slot] += term.sum;
    for (const RestTerm& term : b.terms) sums_[term.slot] -= term.sum;
    const double tolerance = kRounding * (largest + 1) * (a.member_count + 1.0);
    bool are = true;
    for (const Particle* of : {&a, &b})
      for (const RestTerm& term : of->terms) {
        are &= sums_[term.slot].cwiseAbs().maxCoeff() <= tolerance;
        sums_[term.slot].setZero();
      }
    return are && are_alike(a.morph_terms, b.morph_terms, tolerance);
  }

 private:
  /// Terms in their order by morph weight and slot, those of `b` subtracted, add up to nothing.
  static bool are_alike(const std::vector<RestMorphTerm>& a, const std::vector<RestMorphTerm>& b,
                        double tolerance) {
    std::vector<RestMorphTerm> all = a;
    for (const RestMorphTerm& of : b) all.push_back({of.morph_weight, of.slot, Vec3d(-of.sum)});
    const auto key = [](const RestMorphTerm& of) { return std::pair(of.morph_weight, of.slot); };
    std::ranges::stable_sort(all, {}, key);
    for (std::size_t i = 0; i < all.size();) {
      Vec3d sum = Vec3d::Zero();
      const std::size_t first = i;
      for (; i < all.size() && key(all[i]) == key(all[first]); ++i) sum += all[i].sum;
      if (!(sum.cwiseAbs().maxCoeff() <= tolerance)) return false;
    }
    return true;
  }

  std::vector<Vec4d> sums_;  ///< Per slot; zero between calls.
};

/// Per particle: whether it may have other members than the decomposition gave it.
std::vector<std::uint8_t> find_changed(const Structure& structure, const Structure& decomposition) {
  std::vector<std::uint8_t> is_changed(structure.particles.size(), 1);
  std::fill_n(is_changed.begin(), decomposition.particles.size(), std::uint8_t{0});
  const auto add = [&](const PointTable& points, Index point) {
    for (const ParticleMembership& of : points.memberships_of(point)) is_changed[of.particle] = 1;
  };
  const Index known = decomposition.points.count();
  for (Index p = 0; p < structure.points.count(); ++p) {
    const MembershipSlab& now = structure.points.slabs[p];
    if (p < known && now.first == decomposition.points.slabs[p].first &&
        now.count == decomposition.points.slabs[p].count)
      continue;
    add(structure.points, p);
    if (p < known) add(decomposition.points, p);
  }
  return is_changed;
}

/// A particle with the members that the decomposition gave it has its sums, because operations
/// change the weights of new points alone. The others are summed again.
Status check_terms(const Structure& structure, const Structure& decomposition,
                   const TornModel& model) {
  const std::vector<std::uint8_t> is_changed = find_changed(structure, decomposition);
  MemberSearch search(structure);
  Particle again;
  RestSums sums(model, structure.character.first_slots, structure.points.vertices);
  TermComparison comparison(structure.character.first_slots.back());
  double largest = 0;
  for (const Mesh& mesh : model.character().meshes)
    for (const Vec3f& at : mesh.positions)
      largest = std::max(largest, double{at.cwiseAbs().maxCoeff()});
  for (Index p = 0; p < structure.particles.size(); ++p) {
    if (is_changed[p] != 0) sums.sum(search.members_of(p), again);
    if (!comparison.are_alike(structure.particles[p],
                              is_changed[p] != 0 ? again : decomposition.particles[p], largest))
      return differs("a sum over members is another one than they add up to", p);
  }
  return {};
}

}  // namespace

Status check_sums(Structure& structure, const Structure& decomposition, const TornModel& model) {
  if (Status status = check_vertex_points(structure, model); !status) return status;
  if (Status status = check_points(structure, model); !status) return status;
  if (Status status = check_cells(structure, model); !status) return status;
  return check_terms(structure, decomposition, model);
}

}  // namespace sunder::particles
