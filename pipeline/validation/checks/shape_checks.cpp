#include "pipeline/validation/checks/shape_checks.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/internal/ordered.h"
#include "pipeline/validation/checks/pose_block.h"

namespace sunder::validation {
namespace {

constexpr std::size_t kPoses = 16;
constexpr std::size_t kFacesPerPatch = 4096;
constexpr double kCollapsed = 0.25;      ///< Of the area at bind.
constexpr double kSurelyRegular = 0.25;  ///< A bound above this is not made exact.

/// The faces that are judged together: few enough that their posed vertices stay in the cache.
struct Patch {
  std::vector<Triangle> faces;   ///< In `vertices`.
  std::vector<Index> vertices;   ///< In the surface.
  std::vector<bool> is_counted;  ///< Per vertex: it differs, and no earlier patch had it.
  SkinDifferences actual, expected;
  /// Per face and edge: the length at bind; per face: the doubled area at bind. Metres.
  std::vector<std::array<double, 3>> edges;
  std::vector<double> areas;
};

/// Judges faces that touch a difference, in random poses: as the target has their vertices and as
/// the matched weights would have them. A vertex without an accepted match counts as it is.
class ShapeJudge {
 public:
  ShapeJudge(const RowReader& reader, const SkinPoints& points, const SkinDifferences& differences,
             const PoseBatch& random)
      : reader_(reader),
        points_(points),
        random_(random),
        surface_(reader.target().surface),
        sum_(points.make_sum()),
        differs_(surface_.vertex_count(), false),
        number_(surface_.vertex_count(), kNone) {
    for (Index v = 0; v < surface_.vertex_count(); ++v)
      for (const SkinTerm& term : terms_of(differences, v))
        if (std::abs(term.m) > 1e-4 || norm(term.x) > 1e-4 * surface_.diagonal) differs_[v] = true;
    is_open_ = differs_;
  }

  void run() {
    std::vector<Index> faces;
    for (Index t = 0; t < surface_.triangles.size(); ++t) {
      if (!surface_.has_area[t] ||
          std::ranges::none_of(surface_.triangles[t], [&](Index v) { return differs_[v]; }))
        continue;
      faces.push_back(t);
      if (faces.size() < kFacesPerPatch) continue;
      judge(faces);
      faces.clear();
    }
    judge(faces);
  }

  Places stretched, turned, inverted;

 private:
  void judge(std::span<const Index> faces);
  [[nodiscard]] Patch make_patch(std::span<const Index> faces);
  void add_vertex(Index vertex, Patch& patch);
  void judge_blend(const PoseBlock& block, const Patch& patch, std::size_t i,
                   std::vector<double>& inversion) const;

  const RowReader& reader_;
  const SkinPoints& points_;
  const PoseBatch& random_;
  const BindSurface& surface_;
  TermSum sum_;
  std::vector<bool> differs_;  // per vertex of the surface
  std::vector<bool> is_open_;  // per vertex: differs and is not judged yet
  std::vector<Index> number_;  // per vertex: in the patch
};

void ShapeJudge::add_vertex(Index vertex, Patch& patch) {
  const Index mesh = surface_.mesh_of_vertex(vertex), own = vertex - surface_.first_vertex[mesh];
  number_[vertex] = static_cast<Index>(patch.vertices.size());
  patch.vertices.push_back(vertex);
  patch.is_counted.push_back(is_open_[vertex]);
  is_open_[vertex] = false;
  points_.add_target(mesh, own, 1.0, sum_);
  sum_.finish(patch.actual);
  if (reader_.match(mesh, own).is_accepted)
    points_.add_expected(mesh, own, 1.0, sum_);
  else
    points_.add_target(mesh, own, 1.0, sum_);
  sum_.finish(patch.expected);
}

Patch ShapeJudge::make_patch(std::span<const Index> faces) {
  const double unit = reader_.target().metres_per_bind_unit;
  Patch patch;
  for (const Index t : faces) {
    const Triangle& face = surface_.triangles[t];
    for (const Index v : face)
      if (number_[v] == kNone) add_vertex(v, patch);
    patch.faces.push_back({number_[face[0]], number_[face[1]], number_[face[2]]});
    const Vec3d &a = surface_.positions[face[0]], &b = surface_.positions[face[1]],
                &c = surface_.positions[face[2]];
    patch.edges.push_back({unit * norm(b - a), unit * norm(c - b), unit * norm(a - c)});
    patch.areas.push_back(unit * unit * norm((b - a).cross(c - a)));
  }
  for (const Index v : patch.vertices) number_[v] = kNone;
  return patch;
}

/// The smallest singular value, negative for a mirror. Exact below kSurelyRegular; above, a lower
/// bound.
double least_stretch(const Mat3d& m) {
  const double determinant = m.determinant(), square = squared_norm(m);
  const double bound = square > 0.0 ? 2.0 * std::abs(determinant) / square : 0.0;
  if (bound > kSurelyRegular) return std::copysign(bound, determinant);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> squares;
  squares.computeDirect(multiply(m.transpose(), m), Eigen::EigenvaluesOnly);
  return std::copysign(std::sqrt(std::max(squares.eigenvalues()[0], 0.0)), determinant);
}

/// One lane of a blended matrix, divided by a unit.
Mat3d matrix_of(const std::array<PosedPoint, 3>& rows, Eigen::Index lane, double unit) {
  Mat3d matrix;
  for (std::size_t row = 0; row < 3; ++row)
    matrix.row(static_cast<Eigen::Index>(row)) << rows[row].x[lane] / unit,
        rows[row].y[lane] / unit, rows[row].z[lane] / unit;
  return matrix;
}

/// How far the blended matrix of a vertex is below the limit where the source's is not.
void ShapeJudge::judge_blend(const PoseBlock& block, const Patch& patch, std::size_t i,
                             std::vector<double>& inversion) const {
  const double limit = kind_of(Code::inversion).threshold;
  const double unit = reader_.source().metres_per_bind_unit;
  const auto rows = block.blend(terms_of(patch.actual, i));
  const PoseArray determinant = dot(rows[0], cross(rows[1], rows[2]));
  const PoseArray square =
      rows[0].squared_length() + rows[1].squared_length() + rows[2].squared_length();
  const auto is_regular = (2.0 * determinant > kSurelyRegular * unit * square).eval();
  if (is_regular.all()) return;
  for (std::size_t pose = 0; pose < block.count(); ++pose) {
    const auto lane = static_cast<Eigen::Index>(pose);
    if (is_regular[lane]) continue;
    const double of_actual = least_stretch(matrix_of(rows, lane, unit));
    if (of_actual >= limit) continue;
    const auto of_source = block.blend(terms_of(patch.expected, i));
    if (least_stretch(matrix_of(of_source, lane, unit)) >= 2 * limit)
      inversion[i] = std::max(inversion[i], limit - of_actual);
  }
}

/// The corners of a face in the poses of a block.
using PosedFace = std::array<PosedPoint, 3>;

/// The largest change of an edge's length, relative to bind.
double stretch_of(const PosedFace& actual, const PosedFace& expected,
                  const std::array<double, 3>& at_bind) {
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(at_bind[k] > 0.0)) continue;
    const std::size_t next = (k + 1) % 3;
    const double change =
        ((actual[next] - actual[k]).length() - (expected[next] - expected[k]).length())
            .abs()
            .maxCoeff();
    largest = std::max(largest, change / at_bind[k]);
  }
  return largest;
}

/// The largest angle between the normals, as far as it is above the threshold. The normal of a face
/// that collapses in the source too says nothing.
double turn_of(const PosedFace& actual, const PosedFace& expected, double area_at_bind) {
  static const double threshold = kind_of(Code::normal).threshold,
                      square_of_tangent = (1.0 - 1e-9) * std::pow(std::tan(threshold), 2);
  const PosedPoint of_actual = cross(actual[1] - actual[0], actual[2] - actual[0]),
                   of_expected = cross(expected[1] - expected[0], expected[2] - expected[0]);
  const PoseArray cosines = dot(of_actual, of_expected),
                  squared_sines = cross(of_actual, of_expected).squared_length();
  const double least = kCollapsed * kCollapsed * area_at_bind * area_at_bind;
  const auto turns = (of_expected.squared_length() > least &&
                      (cosines < 0.0 || squared_sines > square_of_tangent * cosines.square()))
                         .eval();
  double largest = 0.0;
  if (!turns.any()) return largest;
  for (Eigen::Index lane = 0; lane < turns.size(); ++lane)
    if (turns[lane])
      largest = std::max(largest, std::atan2(std::sqrt(squared_sines[lane]), cosines[lane]));
  return largest;
}

void ShapeJudge::judge(std::span<const Index> faces) {
  const Patch patch = make_patch(faces);
  std::vector<double> stretch(faces.size(), 0.0), turn(faces.size(), 0.0),
      inversion(patch.vertices.size(), 0.0);
  std::vector<PosedPoint> actual(patch.vertices.size()), expected(patch.vertices.size());
  for_each_block(random_, kPoses, [&](const PoseBlock& block) {
    for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
      actual[i] = block.pose(terms_of(patch.actual, i));
      expected[i] = block.pose(terms_of(patch.expected, i));
      if (patch.is_counted[i]) judge_blend(block, patch, i, inversion);
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const auto& [a, b, c] = patch.faces[i];
      const PosedFace of_actual = {actual[a], actual[b], actual[c]},
                      of_expected = {expected[a], expected[b], expected[c]};
      stretch[i] = std::max(stretch[i], stretch_of(of_actual, of_expected, patch.edges[i]));
      turn[i] = std::max(turn[i], turn_of(of_actual, of_expected, patch.areas[i]));
    }
  });
  const Skinned& target = reader_.target();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Index vertex = surface_.triangles[faces[i]][0];
    if (stretch[i] > kind_of(Code::stretch).threshold)
      stretched.push_back(target.place(vertex, kNone, stretch[i]));
    if (turn[i] > kind_of(Code::normal).threshold)
      turned.push_back(target.place(vertex, kNone, turn[i]));
  }
  for (std::size_t i = 0; i < inversion.size(); ++i)
    if (inversion[i] > 0.0)
      inverted.push_back(target.place(patch.vertices[i], kNone, inversion[i]));
}

}  // namespace

void check_shapes(const RowReader& reader, const SkinPoints& points,
                  const SkinDifferences& differences, const PoseBatch& random,
                  FindingList& findings) {
  ShapeJudge judge(reader, points, differences, random);
  judge.run();
  const std::string over =
      "Over " + std::to_string(std::min(random.poses.size(), kPoses)) + " random poses.";
  findings.add(Code::stretch, std::move(judge.stretched), over, Evidence::sampled);
  findings.add(Code::normal, std::move(judge.turned), over, Evidence::sampled);
  findings.add(Code::inversion, std::move(judge.inverted), over, Evidence::sampled);
}

}  // namespace sunder::validation
