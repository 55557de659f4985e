#include "validation/checks/shape_checks.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace sunder::validation {
namespace {

constexpr std::size_t kPoses = 16;
constexpr double kCollapsed = 0.25;  ///< Of the area at bind.

/// A vertex near a difference: as the target has it and as the matched weights would have it.
struct ActiveSet {
  std::vector<Index> vertices;       ///< In the surface.
  std::vector<Index> row_of_vertex;  ///< kNone: not active.
  std::vector<bool> differs;         ///< Per active vertex.
  SkinDifferences actual, expected;
  std::vector<Index> faces;  ///< With a vertex that differs.
};

/// Vertices of faces that touch a difference. A vertex without an accepted match counts as it is.
ActiveSet make_active_set(const RowReader& reader, const SkinPoints& points,
                          const SkinDifferences& differences) {
  const Skinned& target = reader.target();
  const BindSurface& surface = target.surface;
  ActiveSet set;
  set.row_of_vertex.assign(surface.vertex_count(), kNone);
  std::vector<bool> differs(surface.vertex_count(), false);
  for (Index v = 0; v < surface.vertex_count(); ++v)
    for (const SkinTerm& term : terms_of(differences, v))
      if (std::abs(term.m) > 1e-4 || norm(term.x) > 1e-4 * surface.diagonal) differs[v] = true;
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    const Triangle& face = surface.triangles[t];
    if (!surface.has_area[t] || std::ranges::none_of(face, [&](Index v) { return differs[v]; }))
      continue;
    set.faces.push_back(t);
    for (const Index v : face) set.row_of_vertex[v] = 0;
  }
  TermSum sum = points.make_sum();
  for (Index mesh = 0; mesh < target.character.meshes.size(); ++mesh)
    for (Index v = 0; v < target.character.meshes[mesh].vertex_count(); ++v) {
      const Index vertex = surface.first_vertex[mesh] + v;
      if (set.row_of_vertex[vertex] == kNone) continue;
      set.row_of_vertex[vertex] = static_cast<Index>(set.vertices.size());
      set.vertices.push_back(vertex);
      set.differs.push_back(differs[vertex]);
      points.add_target(mesh, v, 1.0, sum);
      sum.finish(set.actual);
      if (reader.match(mesh, v).is_accepted)
        points.add_expected(mesh, v, 1.0, sum);
      else
        points.add_target(mesh, v, 1.0, sum);
      sum.finish(set.expected);
    }
  return set;
}

/// The blended linear part of a vertex.
Mat3d blended(std::span<const SkinTerm> terms, const std::vector<Affine3d>& matrices) {
  Mat3d sum = Mat3d::Zero();
  for (const SkinTerm& term : terms) sum += term.m * matrices[term.bone].linear();
  return sum;
}

/// The smallest singular value, negative for a mirror. Exact below 0.25; above, a lower bound.
double least_stretch(const Mat3d& m) {
  const double determinant = m.determinant(), square = squared_norm(m);
  const double bound = square > 0.0 ? 2.0 * std::abs(determinant) / square : 0.0;
  if (bound > 0.25) return std::copysign(bound, determinant);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squares;
  squares.computeDirect(multiply(m.transpose(), m), Eigen::EigenvaluesOnly);
  return std::copysign(std::sqrt(std::max(squares.eigenvalues()[0], 0.0)), determinant);
}

/// Worst values of the active set over the poses.
struct Shapes {
  std::vector<double> stretch, turn;  ///< Per active face.
  std::vector<double> inversion;      ///< Per active vertex: how far below the limit.
};

void judge_faces(const Skinned& target, const ActiveSet& set, std::span<const Vec3d> actual,
                 std::span<const Vec3d> expected, Shapes& shapes) {
  for (std::size_t i = 0; i < set.faces.size(); ++i) {
    const Triangle& face = target.surface.triangles[set.faces[i]];
    std::array<Vec3d, 3> a, e;
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = actual[set.row_of_vertex[face[k]]];
      e[k] = expected[set.row_of_vertex[face[k]]];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double of_a = norm(a[(k + 1) % 3] - a[k]), of_e = norm(e[(k + 1) % 3] - e[k]),
                   at_bind = norm(target.surface.positions[face[(k + 1) % 3]] -
                                  target.surface.positions[face[k]]);
      if (at_bind > 0.0)
        shapes.stretch[i] = std::max(shapes.stretch[i], std::abs(of_a - of_e) / at_bind);
    }
    const Vec3d normal_a = (a[1] - a[0]).cross(a[2] - a[0]),
                normal_e = (e[1] - e[0]).cross(e[2] - e[0]);
    const Vec3d at_bind =
        (target.surface.positions[face[1]] - target.surface.positions[face[0]])
            .cross(target.surface.positions[face[2]] - target.surface.positions[face[0]]);
    // The normal of a face that collapses in the source too says nothing.
    if (squared_norm(normal_e) > kCollapsed * kCollapsed * squared_norm(at_bind))
      shapes.turn[i] = std::max(
          shapes.turn[i], std::atan2(norm(normal_a.cross(normal_e)), dot(normal_a, normal_e)));
  }
}

Shapes judge(const Skinned& target, const ActiveSet& set, const PoseBatch& random) {
  Shapes shapes{std::vector<double>(set.faces.size(), 0.0),
                std::vector<double>(set.faces.size(), 0.0),
                std::vector<double>(set.vertices.size(), 0.0)};
  std::vector<Vec3d> actual(set.vertices.size()), expected(set.vertices.size());
  const double limit = kind_of(Code::inversion).threshold;
  for (std::size_t pose = 0; pose < std::min(random.poses.size(), kPoses); ++pose) {
    const auto& matrices = random.poses[pose];
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
      actual[i] = posed(terms_of(set.actual, i), matrices);
      expected[i] = posed(terms_of(set.expected, i), matrices);
      if (!set.differs[i]) continue;
      const double of_actual = least_stretch(blended(terms_of(set.actual, i), matrices));
      if (of_actual >= limit) continue;
      if (least_stretch(blended(terms_of(set.expected, i), matrices)) >= 2 * limit)
        shapes.inversion[i] = std::max(shapes.inversion[i], limit - of_actual);
    }
    judge_faces(target, set, actual, expected, shapes);
  }
  return shapes;
}

Places places_of_faces(const Skinned& target, const ActiveSet& set, std::span<const double> values,
                       double threshold) {
  Places places;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] > threshold)
      places.push_back(target.place(target.surface.triangles[set.faces[i]][0], kNone, values[i]));
  return places;
}

}  // namespace

void check_shapes(const RowReader& reader, const SkinPoints& points,
                  const SkinDifferences& differences, const PoseBatch& random,
                  FindingList& findings) {
  const Skinned& target = reader.target();
  const ActiveSet set = make_active_set(reader, points, differences);
  const Shapes shapes = judge(target, set, random);
  const std::string over =
      "Over " + std::to_string(std::min(random.poses.size(), kPoses)) + " random poses.";
  const auto add = [&](Code code, std::span<const double> values) {
    findings.add(code, places_of_faces(target, set, values, kind_of(code).threshold), over,
                 Evidence::sampled);
  };
  add(Code::stretch, shapes.stretch);
  add(Code::normal, shapes.turn);
  Places inverted;
  for (std::size_t i = 0; i < set.vertices.size(); ++i)
    if (shapes.inversion[i] > 0.0)
      inverted.push_back(target.place(set.vertices[i], kNone, shapes.inversion[i]));
  findings.add(Code::inversion, std::move(inverted), over, Evidence::sampled);
}

}  // namespace sunder::validation
