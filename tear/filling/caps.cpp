#include "tear/filling/caps.h"

#include <algorithm>
#include <map>

#include "core/internal/ordered.h"
#include "tear/filling/filling.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/section/flat_section.h"
#include "tear/surface/append_filling.h"
#include "tear/surface/rim.h"

namespace sunder::tear {
namespace {

/// A frame in the plane of the section, oriented such that the caps of one side are
/// counter-clockwise.
struct SectionFrame {
  Vec3d origin, x, y, normal;

  [[nodiscard]] Vec2d project(const Vec3d& point) const {
    return {dot(x, point - origin), dot(y, point - origin)};
  }
  [[nodiscard]] Vec3d lift(const Vec2d& point) const {
    return origin + point.x() * x + point.y() * y;
  }
};

double doubled_area(const FlatLoop& loop) {
  double area = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return area;
}

double mean_edge(const std::vector<const FlatLoop*>& loops) {
  double length = 0;
  std::size_t count = 0;
  for (const FlatLoop* loop : loops)
    for (std::size_t i = 0; i < loop->size(); ++i, ++count)
      length += norm((*loop)[(i + 1) % loop->size()] - (*loop)[i]);
  return length / static_cast<double>(count);
}

/// The caps of one side.
class Caps {
 public:
  Caps(SectionFrame frame, const Workpiece& work, TearReport& report)
      : frame_(std::move(frame)), work_(work), report_(report), filling_("cap", work) {}

  void add(const std::vector<Index>& half_edges) {
    const Surface& surface = work_.editor.surface();
    std::map<Index, std::vector<Rim>> closed_of_skin;
    for (Rim& rim : chain_rims(half_edges, surface)) {
      if (!rim.is_closed) {
        ++report_.open_sections;
        continue;
      }
      const Index mesh = surface.triangle(rim.half_edges.front() / 3).mesh;
      // A cap runs in the opposite direction of the border that it closes.
      std::reverse(rim.half_edges.begin(), rim.half_edges.end());
      closed_of_skin[work_.editor.character().meshes[mesh].skin].push_back(std::move(rim));
    }
    for (const auto& [skin, rims] : closed_of_skin) close(rims);
  }

 private:
  void close(const std::vector<Rim>& rims) {
    std::vector<FlatLoop> loops;
    std::size_t left_over = rims.size();
    for (const Rim& rim : rims) {
      FlatLoop& loop = loops.emplace_back();
      for (const Index h : rim.half_edges)
        loop.push_back(frame_.project(position(point_before(h))));
    }
    for (const FlatRegion& region : find_regions(loops)) {
      const EditLog::Mark before = work_.editor.mark();
      if (close(rims, loops, region)) {
        ++report_.caps;
        left_over -= 1 + region.holes.size();
      } else {
        filling_.take_back(before);
      }
    }
    report_.open_sections += static_cast<Index>(left_over);
  }

  /// The point at which the cap's edge along a border half-edge begins, which is where the
  /// half-edge ends.
  [[nodiscard]] Index point_before(Index half_edge) const {
    return work_.editor.surface().corner_point[Surface::next(half_edge)];
  }
  [[nodiscard]] Vec3d position(Index point) const {
    return work_.posed.position(work_.editor, point);
  }

  bool close(const std::vector<Rim>& rims, const std::vector<FlatLoop>& loops,
             const FlatRegion& region) {
    std::vector<Index> half_edges, members = {region.outline};
    members.insert(members.end(), region.holes.begin(), region.holes.end());
    std::vector<Vec2d> places;
    std::vector<const FlatLoop*> outlines;
    for (const Index member : members) {
      half_edges.insert(half_edges.end(), rims[member].half_edges.begin(),
                        rims[member].half_edges.end());
      places.insert(places.end(), loops[member].begin(), loops[member].end());
      outlines.push_back(&loops[member]);
    }
    auto flat = triangulate(loops, region, 1.5 * mean_edge(outlines));
    if (!flat) return false;
    const auto rim_count = static_cast<Index>(places.size());
    split_second_face(half_edges, places, *flat);
    split_joined_edges(half_edges, places, *flat);
    places.insert(places.end(), flat->inner.begin(), flat->inner.end());
    // A body whose faces point inwards has reversed rims.
    const bool is_inside_out = doubled_area(loops[region.outline]) < 0;

    const Index mesh = mesh_with_most(half_edges);
    std::vector<Index> points, vertices;
    for (const Index h : half_edges) {
      points.push_back(point_before(h));
      vertices.push_back(filling_.add_rim_vertex(mesh, Surface::next(h)));
    }
    add_inner_points(mesh, places, rim_count, flat->triangles, points, vertices);
    shade(mesh, places, is_inside_out, vertices);

    turn_flat_triangles(half_edges, mesh, vertices, flat->triangles);
    for (std::array<Index, 3> corners : flat->triangles) {
      if (is_inside_out) std::swap(corners[1], corners[2]);
      const Triangle triangle = {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
      const Eigen::Vector3d a = place(mesh, triangle[0]), ab = place(mesh, triangle[1]) - a,
                            ac = place(mesh, triangle[2]) - a;
      if (!(squared_norm(ab.cross(ac)) > 0))
        return false;  // stored positions are too coarse for it
      filling_.add_triangle(mesh, half_edges.front(),
                            {points[corners[0]], points[corners[1]], points[corners[2]]}, triangle);
    }
    return filling_.connect(half_edges);
  }

  /// Whether two points of the rim are joined by an edge other than the rim's: a fold or a face in
  /// the plane, or a border elsewhere. With an edge of the cap between them, that edge would have
  /// too many faces.
  [[nodiscard]] bool is_joined(Index half_edge_a, Index half_edge_b) const {
    const Surface& surface = work_.editor.surface();
    const Index a = point_before(half_edge_a), b = point_before(half_edge_b);
    const Index ab = surface.find_half_edge(a, b), ba = surface.find_half_edge(b, a);
    return (ab != kNone && ab != half_edge_b) || (ba != kNone && ba != half_edge_a);
  }

  /// Adds a point in the middle of the cap of an isolated face: two faces on the same three points
  /// could not be split separately.
  void split_second_face(const std::vector<Index>& half_edges, const std::vector<Vec2d>& rim,
                         FlatMesh& flat) const {
    const bool is_one_face = std::all_of(half_edges.begin(), half_edges.end(),
                                         [&](Index h) { return h / 3 == half_edges.front() / 3; });
    if (!is_one_face || flat.triangles.size() != 1) return;
    const auto [a, b, c] = flat.triangles[0];
    const auto middle = static_cast<Index>(rim.size());
    flat.inner.push_back((rim[a] + rim[b] + rim[c]) / 3);
    flat.triangles = {{a, b, middle}, {b, c, middle}, {c, a, middle}};
  }

  /// Adds a point in the middle of each edge between points that are joined.
  void split_joined_edges(const std::vector<Index>& half_edges, const std::vector<Vec2d>& rim,
                          FlatMesh& flat) const {
    const auto key = [](Index a, Index b) {
      return std::array<Index, 2>{std::min(a, b), std::max(a, b)};
    };
    std::map<std::array<Index, 2>, Index> middles;  // kNone: not joined
    for (const auto& corners : flat.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = corners[k], b = corners[(k + 1) % 3];
        if (a >= rim.size() || b >= rim.size() || !middles.emplace(key(a, b), kNone).second)
          continue;
        if (!is_joined(half_edges[a], half_edges[b])) continue;
        middles[key(a, b)] = static_cast<Index>(rim.size() + flat.inner.size());
        flat.inner.push_back(0.5 * (rim[a] + rim[b]));
      }
    for (std::size_t t = 0; t < flat.triangles.size();
         ++t)  // parts are appended, and looked at in their turn
      for (std::size_t k = 0; k < 3;) {
        const Index a = flat.triangles[t][k], b = flat.triangles[t][(k + 1) % 3],
                    c = flat.triangles[t][(k + 2) % 3];
        const auto middle = middles.find(key(a, b));
        if (middle == middles.end() || middle->second == kNone) {
          ++k;
          continue;
        }
        flat.triangles[t] = {a, middle->second, c};
        flat.triangles.push_back({middle->second, b, c});
        k = 0;
      }
  }

  /// Rim points that should be collinear, as where a cut meets an older cap, are so only
  /// approximately in the pose. After rounding to float, a triangle of three of them has no area.
  /// Its longest edge is flipped.
  void turn_flat_triangles(const std::vector<Index>& half_edges, Index mesh,
                           const std::vector<Index>& vertices,
                           std::vector<std::array<Index, 3>>& triangles) const {
    const auto at = [&](Index i) { return place(mesh, vertices[i]); };
    const auto height_of = [&](const std::array<Index, 3>& t) {
      const double longest = std::max(
          {norm(at(t[1]) - at(t[0])), norm(at(t[2]) - at(t[1])), norm(at(t[0]) - at(t[2]))});
      return longest > 0 ? norm((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]))) / longest : 0.0;
    };
    std::map<std::array<Index, 2>, std::size_t> triangle_at;  // by directed edge
    const auto enter = [&](std::size_t t) {
      for (std::size_t k = 0; k < 3; ++k)
        triangle_at[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    };
    for (std::size_t t = 0; t < triangles.size(); ++t) enter(t);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const std::array<Index, 3> flat = triangles[t];
      if (height_of(flat) > kStoredCoordinates * at(flat[0]).cwiseAbs().maxCoeff()) continue;
      std::size_t k = 0;
      for (std::size_t i = 1; i < 3; ++i)
        if (norm(at(flat[(i + 1) % 3]) - at(flat[i])) > norm(at(flat[(k + 1) % 3]) - at(flat[k])))
          k = i;
      const Index a = flat[k], b = flat[(k + 1) % 3], c = flat[(k + 2) % 3];
      const auto across = triangle_at.find({b, a});
      if (across == triangle_at.end()) continue;
      const std::size_t other = across->second;
      const std::array<Index, 3> of_other = triangles[other];
      const Index d = of_other[0] != a && of_other[0] != b   ? of_other[0]
                      : of_other[1] != a && of_other[1] != b ? of_other[1]
                                                             : of_other[2];
      if (triangle_at.count({c, d}) != 0 || triangle_at.count({d, c}) != 0) continue;
      if (std::max(c, d) < half_edges.size() && is_joined(half_edges[c], half_edges[d])) continue;
      if (!(std::min(height_of({a, d, c}), height_of({d, b, c})) > height_of(flat))) continue;
      triangle_at.erase({a, b});
      triangle_at.erase({b, a});
      triangles[t] = {a, d, c};
      triangles[other] = {d, b, c};
      enter(t);
      enter(other);
    }
  }

  /// In bind space.
  [[nodiscard]] Eigen::Vector3d place(Index mesh, Index vertex) const {
    return work_.editor.births.position(mesh, vertex).cast<double>();
  }

  [[nodiscard]] Index mesh_with_most(const std::vector<Index>& half_edges) const {
    std::map<Index, Index> count;
    for (const Index h : half_edges) ++count[work_.editor.surface().triangle(h / 3).mesh];
    return std::max_element(count.begin(), count.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  /// Adds the inner points. Bind positions, weights and morph displacements are harmonic between
  /// those of the rim.
  void add_inner_points(Index mesh, const std::vector<Vec2d>& places, Index rim_count,
                        const std::vector<std::array<Index, 3>>& triangles,
                        std::vector<Index>& points, std::vector<Index>& vertices) {
    if (places.size() == rim_count) return;
    const Mesh& of = work_.editor.character().meshes[mesh];
    std::vector<Index> slots;
    for (const Index vertex : vertices)
      for (const Influence& influence : work_.editor.births.influences(mesh, vertex))
        slots.push_back(influence.slot);
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());

    const auto first_morph = static_cast<Eigen::Index>(3 + slots.size());
    const auto target_count = static_cast<Eigen::Index>(of.morph_targets.size());
    Eigen::MatrixXd rim = Eigen::MatrixXd::Zero(rim_count, first_morph + 3 * target_count);
    for (Index i = 0; i < rim_count; ++i) {
      rim.block<1, 3>(i, 0) = place(mesh, vertices[i]).transpose();
      for (const Influence& influence : work_.editor.births.influences(mesh, vertices[i])) {
        const auto slot =
            std::lower_bound(slots.begin(), slots.end(), influence.slot) - slots.begin();
        rim(i, 3 + slot) = static_cast<double>(influence.weight);
      }
      for (Eigen::Index t = 0; t < target_count; ++t) {
        const auto& deltas = of.morph_targets[static_cast<std::size_t>(t)].position_deltas;
        if (!deltas.empty())
          rim.block<1, 3>(i, first_morph + 3 * t) = deltas[vertices[i]].cast<double>().transpose();
      }
    }
    const Eigen::MatrixXd inner = extend_harmonically(places, rim_count, triangles, rim);

    for (Eigen::Index i = 0; i < inner.rows(); ++i) {
      Filling::Inner made;
      made.bind_position = inner.block<1, 3>(i, 0).transpose();
      double sum = 0;
      for (std::size_t s = 0; s < slots.size(); ++s) {
        const double weight = inner(i, 3 + static_cast<Eigen::Index>(s));
        if (weight < kLeastCapWeight) continue;
        made.influences.push_back({slots[s], static_cast<float>(weight)});
        sum += static_cast<double>(made.influences.back().weight);
      }
      for (Influence& influence : made.influences)
        influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
      std::sort(made.influences.begin(), made.influences.end(),
                [](const Influence& a, const Influence& b) {
                  return a.weight != b.weight ? a.weight > b.weight : a.slot < b.slot;
                });
      for (Eigen::Index t = 0; t < target_count; ++t)
        made.morph_displacements.emplace_back(
            inner.block<1, 3>(i, first_morph + 3 * t).transpose());
      vertices.push_back(filling_.add_inner_vertex(mesh, vertices.front(), made));
      points.push_back(append_filling_point(work_.editor));
      work_.posed.pin(points.back(), frame_.lift(places[rim_count + static_cast<std::size_t>(i)]));
    }
  }

  void shade(Index mesh, const std::vector<Vec2d>& places, bool is_inside_out,
             const std::vector<Index>& vertices) {
    Vec2d low = places[0], high = places[0];
    for (const Vec2d& place : places) {
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
    const double extent = (high - low).maxCoeff();
    for (std::size_t i = 0; i < places.size(); ++i)
      filling_.shade(mesh, vertices[i], is_inside_out ? Vec3d(-frame_.normal) : frame_.normal,
                     frame_.x, (places[i] - low) / extent);
  }

  SectionFrame frame_;
  Workpiece work_;
  TearReport& report_;
  Filling filling_;
};

}  // namespace

void add_caps(const SheetOpening& opening, const Vec3d& normal, const Workpiece& work,
              TearReport& report) {
  if (opening.edges.empty()) return;
  const Vec3d origin = work.posed.position(work.editor, opening.edges.front()[0]);
  const Vec3d away = std::abs(normal.x()) < 0.5 ? Vec3d(Vec3d::UnitX()) : Vec3d(Vec3d::UnitY());
  Vec3d x = normal.cross(away);
  x /= norm(x);
  const Vec3d y = normal.cross(x);
  Caps({origin, x, -y, -normal}, work, report).add(opening.left);
  Caps({origin, x, y, normal}, work, report).add(opening.right);
}

}  // namespace sunder::tear
