#include "support/oracles/particle_laws.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "skinning/internal/reference.h"
#include "support/machine/say.h"
#include "support/models/rigs.h"
#include "tear/internal/surface.h"

namespace sunder::test {
namespace {

using tear::Surface;

/// The common border of two cells.
struct Border {
  std::uint32_t edges = 0;
  Vec3d across = Vec3d::Zero(), middles = Vec3d::Zero();
  double size = 0;  ///< Sum of the lengths of the parts and edges.
};

/// The sums of particles, computed from memberships, the cells of points, and the surface.
struct Sums {
  std::vector<std::vector<std::uint32_t>> members;  ///< Ascending.
  std::vector<double> areas;
  std::vector<std::map<std::uint32_t, Border>> borders;

  Sums(const TornModel& model, const ParticleSet& set)
      : members(set.particle_count()),
        areas(set.particle_count(), 0.0),
        borders(set.particle_count()) {
    for (std::uint32_t point = 0; point < set.point_count(); ++point)
      for (const ParticleMembership& membership : set.memberships(point))
        if (membership.particle < set.particle_count())
          members[membership.particle].push_back(point);
    const Surface& surface = model.surface();
    for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
      const tear::TriangleRef of = surface.triangle(t);
      const std::size_t of_source = model.source().meshes[of.mesh].triangles.size();
      if (surface.has_repeated_point(t) || of.source_triangle >= of_source) continue;
      add_face(set, &surface.corner_point[std::size_t{3} * t]);
    }
  }

 private:
  void add_face(const ParticleSet& set, const std::uint32_t* points) {
    const auto at = [&](std::size_t k) {
      return Vec3d(set.positions()[points[k % 3]].cast<double>());
    };
    const auto owner = [&](std::size_t k) { return set.owners()[points[k % 3]]; };
    const double twice = (at(1) - at(0)).cross(at(2) - at(0)).norm();
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (owner(k) < areas.size()) areas[owner(k)] += twice / 6;
      longest = std::max(longest, (at(k + 1) - at(k)).squaredNorm());
    }
    if (!(twice > 1e-6 * longest)) return;
    for (std::size_t k = 0; k < 3; ++k) {
      if (owner(k) == owner(k + 1) || std::max(owner(k), owner(k + 1)) >= areas.size()) continue;
      const Vec3d a = at(k) - at(k + 2), b = at(k + 1) - at(k + 2);
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      const Vec3d across = 0.5 / std::tan(angle) * (at(k + 1) - at(k));
      for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
        Border& border = borders[owner(k + side)][owner(k + 1 - side)];
        ++border.edges;
        border.across += side == 0 ? across : Vec3d(-across);
        border.middles += 0.5 * (at(k) + at(k + 1));
        border.size += across.norm() + (at(k + 1) - at(k)).norm();
      }
    }
  }
};

/// Each point is in the cell of the particle whose seed is nearest.
void check_owner(const ParticleSet& set, std::uint32_t point, std::vector<std::string>& faults) {
  const std::uint32_t owner = set.owners()[point];
  double nearest = std::numeric_limits<double>::infinity(), own = nearest;
  for (const ParticleMembership& of : set.memberships(point)) {
    const double distance = double{of.reach} * set.range(of.particle);
    nearest = std::min(nearest, distance);
    if (of.particle == owner) own = distance;
  }
  // Distances below the least float of full precision are equal.
  constexpr double kLeast = std::numeric_limits<float>::min();
  if (set.memberships(point).empty() ? owner != kNone : !(own <= nearest * (1 + 1e-6) + kLeast))
    faults.push_back(say("point ", point, " is in the cell of particle ", owner, " at ", own,
                         ", the nearest is at ", nearest));
}

void check_point(const ParticleSet& set, std::uint32_t point, bool has_face,
                 std::vector<std::string>& faults) {
  const auto memberships = set.memberships(point);
  std::uint32_t next = 0;
  for (const ParticleMembership& membership : memberships) {
    if (membership.particle >= set.particle_count())
      faults.push_back(say("point ", point, " is in a particle that is not there"));
    if (membership.particle < next)
      faults.push_back(say("memberships of point ", point, " do not ascend"));
    next = membership.particle + 1;
    if (!(membership.reach >= 0 && membership.reach < 1))
      faults.push_back(say("point ", point, " reaches particle ", membership.particle, " at ",
                           membership.reach));
  }
  if (has_face == memberships.empty())
    faults.push_back(
        say("point ", point,
            has_face ? " belongs to nothing" : " has no face and belongs to something"));
  const ParticleInfluences& influences = set.influences()[point];
  double sum = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const float weight = influences.weights[i];
    if (!(weight >= 0 && weight <= 1))
      faults.push_back(say("weight ", i, " of point ", point, " is ", weight));
    if (i > 0 && weight > influences.weights[i - 1])
      faults.push_back(say("weights of point ", point, " do not descend"));
    sum += double{weight};
    if (!(weight > 0)) continue;
    if (std::ranges::none_of(memberships, [&](const ParticleMembership& of) {
          return of.particle == influences.particles[i];
        }))
      faults.push_back(say("point ", point, " follows particle ", influences.particles[i],
                           " to which it does not belong"));
  }
  // The four largest shares minus the fifth, by sorting all.
  std::vector<double> shares(5, 0.0);
  for (const ParticleMembership& of : memberships)
    shares.push_back(std::pow(1 - double{of.reach} * double{of.reach}, 2));
  std::sort(shares.rbegin(), shares.rend());
  const double less = shares[0] > shares[4] ? shares[4] : 0.0,
               total = shares[0] + shares[1] + shares[2] + shares[3] - 4 * less;
  for (std::uint32_t i = 0; i < 4 && total > 1e-3 && shares[0] - shares[4] > 1e-5; ++i)
    if (std::abs(double{influences.weights[i]} - (shares[i] - less) / total) > 1e-6 / total)
      faults.push_back(say("weight ", i, " of point ", point, " is ", influences.weights[i],
                           ", not ", (shares[i] - less) / total));
  if (std::abs(sum - (has_face ? 1.0 : 0.0)) > 1e-6)
    faults.push_back(say("weights of point ", point, " add up to ", sum, " over ",
                         memberships.size(), " memberships"));
}

void check_border(const ParticleSet& set, std::uint32_t p, const ParticleNeighbour& neighbour,
                  const Border& sum, std::vector<std::string>& faults) {
  const double range = set.range(p), tolerance = 1e-7 * (sum.size + range);
  const auto at = [&](std::uint32_t of) {
    return Vec3d(set.positions()[set.seed(of)].cast<double>());
  };
  const Vec3d here = at(p), between = at(neighbour.particle) - here;
  if (neighbour.edges != sum.edges || !((neighbour.across - sum.across).norm() <= tolerance) ||
      !((neighbour.middles - sum.middles).norm() <= 1e-7 * sum.edges * (here.norm() + range)))
    faults.push_back(say("the border of particles ", p, " and ", neighbour.particle, " has ",
                         neighbour.edges, " edges and ", neighbour.across.transpose(), ", not ",
                         sum.edges, " and ", sum.across.transpose()));
  // Not more than the border's length by the straight path, nor less than nothing.
  const double length = neighbour.across.norm();
  if (!(neighbour.coupling >= 0 && neighbour.coupling * between.norm() <= length * (1 + 1e-9)))
    faults.push_back(say("the coupling of particles ", p, " and ", neighbour.particle, " is ",
                         neighbour.coupling, ", more than ", length, " / ", between.norm()));
}

void check_members(const ParticleSet& set, std::uint32_t p, const Sums& sums,
                   std::vector<std::string>& faults) {
  if (set.member_count(p) != sums.members[p].size())
    faults.push_back(say("particle ", p, " counts ", set.member_count(p), " members of ",
                         sums.members[p].size()));
  if (set.members(p).value() != sums.members[p])
    faults.push_back(say("members of particle ", p, " are others than its points say"));
  if (!(set.range(p) > 0)) faults.push_back(say("the range of particle ", p, " is ", set.range(p)));
}

void check_cell(const ParticleSet& set, std::uint32_t p, const Sums& sums,
                std::vector<std::string>& faults) {
  if (std::abs(set.area(p) - sums.areas[p]) > 1e-9 * (sums.areas[p] + set.range(p) * set.range(p)))
    faults.push_back(
        say("the cell of particle ", p, " has an area of ", set.area(p), ", not ", sums.areas[p]));
  const auto neighbours = set.neighbours(p);
  if (neighbours.size() != sums.borders[p].size())
    faults.push_back(
        say("particle ", p, " has ", neighbours.size(), " neighbours of ", sums.borders[p].size()));
  std::uint32_t next = 0;
  for (const ParticleNeighbour& neighbour : neighbours) {
    if (neighbour.particle < next)
      faults.push_back(say("neighbours of particle ", p, " do not ascend"));
    next = neighbour.particle + 1;
    const auto expected = sums.borders[p].find(neighbour.particle);
    if (expected == sums.borders[p].end()) {
      faults.push_back(
          say("the cell of particle ", p, " does not border on that of ", neighbour.particle));
      continue;
    }
    check_border(set, p, neighbour, expected->second, faults);
  }
}

/// The influences on a point, per slot of its skin. All vertices of the point must have the same.
PosedPoint pose_vertex(const TornModel& model, std::uint32_t m, std::uint32_t vertex,
                       const std::vector<Affine3d>& palette, const ModelPose& pose) {
  const Mesh& mesh = model.character().meshes[m];
  PosedPoint posed;
  const auto influences = mesh.weights.of(vertex);
  for (const Influence& influence : influences)
    posed.linear += double{influence.weight} * palette[influence.slot].linear();
  const std::uint32_t place = model.influence_place(m, vertex);
  if (place == kNone) {
    posed.place = deform_position_reference(mesh, vertex, palette, pose.morph_weights);
    return posed;
  }
  const InfluencePositions& exact = model.influence_positions(m);
  for (std::size_t i = 0; i < influences.size(); ++i) {
    Vec3d at = exact.positions[place + i].cast<double>();
    for (std::size_t t = 0; t < mesh.morph_targets.size(); ++t)
      if (t < exact.morph_targets.size() && !exact.morph_targets[t].positions.empty())
        at += double{pose.morph_weights[mesh.first_morph_weight + t]} *
              exact.morph_targets[t].positions[place + i].cast<double>();
    posed.place += palette[influences[i].slot].linear() * at +
                   double{influences[i].weight} * palette[influences[i].slot].translation();
  }
  return posed;
}

/// Half-edges with a face on their own side only, without walls and caps.
class Borders {
 public:
  explicit Borders(const TornModel& model) : model_(model), surface_(model.surface()) {}
  [[nodiscard]] bool has(std::uint32_t half_edge) const {
    if (!is_surface(half_edge / 3)) return false;
    const std::uint32_t twin = surface_.twin[half_edge];
    return twin == kNone || !is_surface(twin / 3);
  }
  [[nodiscard]] bool is_surface(std::uint32_t t) const {
    const tear::TriangleRef of = surface_.triangle(t);
    if (is_retired(model_.character().meshes[of.mesh].triangles[of.triangle]) ||
        surface_.has_repeated_point(t))
      return false;
    return of.source_triangle < model_.source().meshes[of.mesh].triangle_count();
  }

 private:
  const TornModel& model_;
  const Surface& surface_;
};

/// The border of the source, as segments of its bind pose.
class SourceBorder {
 public:
  explicit SourceBorder(const Character& source) {
    const Surface surface = tear::build_surface(source);
    for (std::uint32_t h = 0; h < surface.twin.size(); ++h) {
      if (surface.twin[h] != kNone || surface.has_repeated_point(h / 3)) continue;
      const tear::TriangleRef of = surface.triangle(h / 3);
      const Mesh& mesh = source.meshes[of.mesh];
      segments_.push_back(
          {mesh.positions[mesh.triangles[of.triangle][h % 3]].cast<double>(),
           mesh.positions[mesh.triangles[of.triangle][Surface::next(h) % 3]].cast<double>()});
    }
  }
  /// Whether an edge lies on it.
  [[nodiscard]] bool has(const Vec3d& a, const Vec3d& b, double tolerance) const {
    return std::ranges::any_of(segments_, [&](const auto& segment) {
      return distance(segment, a) < tolerance && distance(segment, b) < tolerance;
    });
  }

 private:
  static double distance(const std::array<Vec3d, 2>& segment, const Vec3d& point) {
    const Vec3d along = segment[1] - segment[0];
    const double t = std::clamp((point - segment[0]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return (segment[0] + t * along - point).norm();
  }
  std::vector<std::array<Vec3d, 2>> segments_;
};

template <class T>
bool have_same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool are_near(double a, double b) { return std::abs(a - b) <= 1e-9 * (1 + std::abs(a)); }

std::string difference(const ParticleState::Particle& a, const ParticleState::Particle& b,
                       Sameness sameness) {
  if (sameness == Sameness::bits && a.serial != b.serial)
    return say("serial ", a.serial, " and ", b.serial);
  if (a.seed != b.seed) return say("seed ", a.seed, " and ", b.seed);
  if (a.range != b.range) return say("range ", a.range, " and ", b.range);
  if (a.member_count != b.member_count)
    return say("member count ", a.member_count, " and ", b.member_count);
  if (a.members != b.members) return "members";
  if (a.parents != b.parents) return "parents";
  if (a.neighbours.size() != b.neighbours.size())
    return say("neighbours: ", a.neighbours.size(), " and ", b.neighbours.size());
  for (std::size_t i = 0; i < a.neighbours.size(); ++i) {
    const ParticleNeighbour &x = a.neighbours[i], &y = b.neighbours[i];
    if (x.particle != y.particle || x.edges != y.edges) return say("neighbour ", i);
    if (sameness == Sameness::bits
            ? x.coupling != y.coupling || x.across != y.across || x.middles != y.middles
            : !(std::abs(x.coupling - y.coupling) <= 1e-7 * (1 + x.coupling)))
      return say("coupling with neighbour ", i, ": ", x.coupling, " and ", y.coupling);
  }
  if (sameness == Sameness::bits ? a.area != b.area : !are_near(a.area, b.area))
    return say("area ", a.area, " and ", b.area);
  const bool rests_alike = sameness == Sameness::bits
                               ? a.rest.place == b.rest.place && a.rest.linear == b.rest.linear
                               : (a.rest.place - b.rest.place).norm() < 1e-9 &&
                                     (a.rest.linear - b.rest.linear).norm() < 1e-9;
  return rests_alike ? ""
                     : say("rest: ", a.rest.place.transpose(), " and ", b.rest.place.transpose());
}

}  // namespace

std::vector<std::string> broken_particles(const TornModel& model, const ParticleSet& set,
                                          bool checks_cells) {
  std::vector<std::string> faults;
  const Surface& surface = model.surface();
  if (set.point_count() != model.point_count() || set.influences().size() != model.point_count() ||
      set.positions().size() != model.point_count() || set.owners().size() != model.point_count())
    return {say(set.point_count(), " points of ", model.point_count())};
  for (std::uint32_t point = 0; point < set.point_count(); ++point) {
    check_point(set, point, surface.point_corner[point] != kNone, faults);
    check_owner(set, point, faults);
  }
  const Sums sums(model, set);
  std::set<std::uint64_t> serials;
  for (std::uint32_t p = 0; p < set.particle_count(); ++p) {
    check_members(set, p, sums, faults);
    if (checks_cells) check_cell(set, p, sums, faults);
    if (!serials.insert(set.serial(p)).second)
      faults.push_back(say("the number of particle ", p, " is not its own"));
  }
  // A vertex where a surface touches itself has several points; it is listed at one of them.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> points_of_vertex;
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const tear::TriangleRef of = surface.triangle(t);
    const Triangle& triangle = model.character().meshes[of.mesh].triangles[of.triangle];
    if (is_retired(triangle) || surface.has_repeated_point(t)) continue;
    for (std::uint32_t k = 0; k < 3; ++k)
      points_of_vertex[{of.mesh, triangle[k]}].insert(surface.corner_point[3 * t + k]);
  }
  for (const auto& [vertex, points] : points_of_vertex)
    if (!points.contains(set.vertex_points(vertex.first)[vertex.second]))
      faults.push_back(say("vertex ", vertex.second, " of mesh ", vertex.first, " is at point ",
                           set.vertex_points(vertex.first)[vertex.second], ", not at ",
                           *points.begin()));
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m)
    if (set.vertex_points(m).size() != model.character().meshes[m].vertex_count())
      faults.push_back(say("mesh ", m, " has ", set.vertex_points(m).size(), " vertices"));
  return faults;
}

std::vector<std::string> broken_sides(const ParticleSet& set,
                                      std::span<const ChangeRecord> changes) {
  std::array<std::set<std::uint32_t>, 2> points, particles;
  for (const ChangeRecord& change : changes) {
    for (const LipPair& pair : change.lips) {
      points[0].insert(pair.left);
      points[1].insert(pair.right);
    }
    points[0].insert(change.rims.left.begin(), change.rims.left.end());
    points[1].insert(change.rims.right.begin(), change.rims.right.end());
  }
  for (std::size_t side = 0; side < 2; ++side)
    for (const std::uint32_t point : points[side]) {
      if (points[1 - side].contains(point)) continue;  // a stroke that crosses itself
      for (const ParticleMembership& membership : set.memberships(point))
        particles[side].insert(membership.particle);
    }
  std::vector<std::string> faults;
  for (const std::uint32_t particle : particles[0])
    if (particles[1].contains(particle))
      faults.push_back(say("particle ", particle, " has points of both sides"));
  return faults;
}

std::vector<std::uint32_t> pieces_of(const TornModel& model) {
  const Surface& surface = model.surface();
  std::vector<std::uint32_t> above(surface.point_count());
  std::iota(above.begin(), above.end(), 0u);
  const auto root = [&](std::uint32_t point) {
    while (above[point] != point) point = above[point] = above[above[point]];
    return point;
  };
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const tear::TriangleRef of = surface.triangle(t);
    if (is_retired(model.character().meshes[of.mesh].triangles[of.triangle]) ||
        surface.has_repeated_point(t))
      continue;
    for (std::uint32_t k = 1; k < 3; ++k)
      above[root(surface.corner_point[3 * t + k])] = root(surface.corner_point[3 * t]);
  }
  std::vector<std::uint32_t> pieces(surface.point_count(), kNone);
  for (std::uint32_t point = 0; point < pieces.size(); ++point)
    if (surface.point_corner[point] != kNone) pieces[point] = root(point);
  return pieces;
}

std::vector<std::string> broken_pieces(const TornModel& model, const ParticleSet& set) {
  std::vector<std::string> faults;
  const std::vector<std::uint32_t> pieces = pieces_of(model);
  for (std::uint32_t p = 0; p < set.particle_count(); ++p) {
    std::set<std::uint32_t> of_particle;
    const std::vector<std::uint32_t> members = set.members(p).value();
    for (const std::uint32_t point : members) of_particle.insert(pieces[point]);
    if (of_particle.size() > 1)
      faults.push_back(say("particle ", p, " is in ", of_particle.size(), " pieces"));
  }
  return faults;
}

std::vector<PosedPoint> posed_points(const TornModel& model, const ParticleSet& set,
                                     const ModelPose& pose) {
  const Character& character = model.character();
  std::vector<PosedPoint> points(set.point_count());
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    std::vector<Affine3d> palette(character.skins[character.meshes[m].skin].bones.size());
    if (!compute_palette(character.skins[character.meshes[m].skin], pose, palette)) std::abort();
    for (std::uint32_t v = 0; v < character.meshes[m].vertex_count(); ++v)
      if (const std::uint32_t point = set.vertex_points(m)[v]; point != kNone)
        points[point] = pose_vertex(model, m, v, palette, pose);
  }
  return points;
}

std::vector<std::string> broken_rest(const TornModel& model, const ParticleSet& set,
                                     const ModelPose& pose) {
  std::vector<std::string> faults;
  std::vector<std::uint32_t> all(set.particle_count());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<ParticleRest> rest(all.size());
  if (const Status status = set.rest(pose, all, rest); !status) return {std::string(status.text())};
  const std::vector<PosedPoint> points = posed_points(model, set, pose);
  const double diagonal = std::max(posed_diagonal(model.character(), pose),
                                   posed_diagonal(model.source(), *bind_pose(model.source())));
  for (const std::uint32_t p : all) {
    const std::vector<std::uint32_t> members = set.members(p).value();
    if (members.empty()) continue;
    PosedPoint mean;
    for (const std::uint32_t point : members) {
      mean.place += points[point].place / static_cast<double>(members.size());
      mean.linear += points[point].linear / static_cast<double>(members.size());
    }
    if (!((mean.place - rest[p].place).norm() <= 1e-6 * diagonal))
      faults.push_back(say("particle ", p, " of ", members.size(), " points rests ",
                           (mean.place - rest[p].place).norm() / diagonal, " of the diagonal off"));
    if (!((mean.linear - rest[p].linear).norm() <= 1e-6 * (1 + mean.linear.norm())))
      faults.push_back(say("the linear part of particle ", p, " is ",
                           (mean.linear - rest[p].linear).norm(), " off"));
  }
  return faults;
}

std::vector<std::string> broken_lip_edges(const TornModel& model, const ParticleSet& set) {
  std::vector<std::string> faults;
  const Surface& surface = model.surface();
  const Borders borders(model);
  const SourceBorder source(model.source());
  const double tolerance = 1e-6 * posed_diagonal(model.source(), *bind_pose(model.source()));
  const auto at = [&](std::uint32_t point) { return Vec3d(set.positions()[point].cast<double>()); };
  std::set<std::uint32_t> listed;
  for (const LipEdge& lip : set.lips()) {
    const auto [a, b] = lip.points;
    if (a == b) {
      if (lip.inward != Vec3f::Zero())
        faults.push_back(say("the edge that is no more at point ", a, " still pulls"));
      continue;
    }
    const std::uint32_t half_edge =
        surface.point_corner[a] == kNone ? kNone : surface.find_half_edge(a, b);
    if (half_edge == kNone || !borders.has(half_edge)) {
      faults.push_back(say("from point ", a, " to ", b, " there is no border"));
      continue;
    }
    if (!listed.insert(half_edge).second)
      faults.push_back(say("the edge from point ", a, " to ", b, " is listed twice"));
    const Vec3d edge = at(b) - at(a), inward = lip.inward.cast<double>();
    const Vec3d across = at(surface.corner_point[Surface::previous(half_edge)]) - at(a);
    if (source.has(at(a), at(b), tolerance) && edge.norm() > 10 * tolerance)
      faults.push_back(say("the edge from point ", a, " to ", b, " is one of the source's border"));
    if (!inward.allFinite())
      faults.push_back(say("the edge from point ", a, " to ", b, " is not finite"));
    const double length = edge.norm(), height = length > 0 ? edge.cross(across).norm() / length : 0;
    // The plane of a needle-shaped face is lost in rounding.
    if (!(height > 1e-3 * across.norm()) || !(length > 100 * tolerance)) continue;
    if (std::abs(inward.dot(edge)) > 1e-3 * length * length)
      faults.push_back(say("the edge from point ", a, " to ", b, " pulls askew"));
    if (std::abs(inward.norm() - length) > 1e-5 * length)
      faults.push_back(say("the edge from point ", a, " to ", b, ", ", length, " long, pulls by ",
                           inward.norm()));
    if (!(inward.dot(across) > 0))
      faults.push_back(say("the edge from point ", a, " to ", b, " pulls outwards"));
  }
  for (std::uint32_t h = 0; h < surface.twin.size(); ++h) {
    if (!borders.has(h) || listed.contains(h)) continue;
    const std::uint32_t a = surface.corner_point[h], b = surface.corner_point[Surface::next(h)];
    if (!source.has(at(a), at(b), tolerance))
      faults.push_back(say("the border from point ", a, " to ", b, " is missing"));
  }
  return faults;
}

ParticleState state_of(const TornModel& model, const ParticleSet& set, const ModelPose& pose) {
  ParticleState state;
  std::vector<std::uint32_t> all(set.particle_count());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<ParticleRest> rest(all.size());
  if (!set.rest(pose, all, rest)) std::abort();
  for (const std::uint32_t p : all) {
    ParticleState::Particle& particle = state.particles.emplace_back();
    particle.serial = set.serial(p);
    particle.seed = set.seed(p);
    particle.range = set.range(p);
    particle.member_count = set.member_count(p);
    particle.members = set.members(p).value();
    particle.neighbours.assign(set.neighbours(p).begin(), set.neighbours(p).end());
    particle.area = set.area(p);
    particle.parents = set.parents(p);
    particle.rest = rest[p];
  }
  for (std::uint32_t point = 0; point < set.point_count(); ++point)
    state.memberships.emplace_back(set.memberships(point).begin(), set.memberships(point).end());
  state.influences.assign(set.influences().begin(), set.influences().end());
  state.owners.assign(set.owners().begin(), set.owners().end());
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m)
    state.vertex_points.emplace_back(set.vertex_points(m).begin(), set.vertex_points(m).end());
  state.positions.assign(set.positions().begin(), set.positions().end());
  state.lips.assign(set.lips().begin(), set.lips().end());
  return state;
}

std::string difference(const ParticleState& a, const ParticleState& b, Sameness sameness) {
  if (a.memberships.size() != b.memberships.size())
    return say(a.memberships.size(), " and ", b.memberships.size(), " points");
  if (a.particles.size() != b.particles.size())
    return say(a.particles.size(), " and ", b.particles.size(), " particles");
  for (std::size_t point = 0; point < a.memberships.size(); ++point) {
    if (!have_same_bits(a.memberships[point], b.memberships[point]))
      return say("memberships of point ", point);
    if (a.influences[point] != b.influences[point]) return say("influences of point ", point);
    if (a.owners[point] != b.owners[point]) return say("cell of point ", point);
  }
  for (std::size_t p = 0; p < a.particles.size(); ++p)
    if (const std::string found = difference(a.particles[p], b.particles[p], sameness);
        !found.empty())
      return say("particle ", p, ": ", found);
  if (a.vertex_points != b.vertex_points) return "points of vertices";
  if (!have_same_bits(a.positions, b.positions)) return "positions";
  if (!have_same_bits(a.lips, b.lips)) return "lips";
  return "";
}

}  // namespace sunder::test
