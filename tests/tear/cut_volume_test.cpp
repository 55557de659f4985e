// Closed bodies cut with caps: pieces are closed bodies whose volumes add up to the whole, and
// equal those that Manifold computes.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/manifold_oracle.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using test::SplitCells;
using test::SplitTask;
using testing::IsEmpty;

int count_of_bodies(int usual) { return test::stressed(usual, 20); }

// ---- Bodies.

/// On two bones; weights blend along x.
Character make_body(const char* name, const std::vector<Vec3f>& positions,
                    const std::vector<Triangle>& triangles) {
  Character character = test::make_sheet(1);  // for its bones
  Mesh& mesh = character.meshes[0];
  mesh = {};
  character.name = mesh.name = name;
  mesh.submeshes.push_back({"outside", kNone});
  mesh.positions = positions;
  mesh.triangles = triangles;
  mesh.triangle_submesh.assign(triangles.size(), 0);
  for (const Vec3f& position : positions) {
    const float along = std::clamp(0.5f + 0.4f * position.x(), 0.05f, 0.95f);
    mesh.weights.append(std::vector<Influence>{{0, 1.0f - along}, {1, along}});
  }
  return character;
}

Character make_torus(std::uint32_t around, std::uint32_t across) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double radius = 1 + 0.4 * std::cos(v);
      positions.push_back(
          Vec3d(radius * std::cos(u), radius * std::sin(u), 0.4 * std::sin(v)).cast<float>());
      const auto at = [&](std::uint32_t a, std::uint32_t b) {
        return (a % around) * across + b % across;
      };
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return make_body("torus", positions, triangles);
}

Character make_ball(std::uint32_t rings, std::uint32_t sides) {
  std::vector<Vec3f> positions = {{0, 0, -1}};
  std::vector<Triangle> triangles;
  for (std::uint32_t ring = 1; ring < rings; ++ring)
    for (std::uint32_t side = 0; side < sides; ++side) {
      const double u = std::numbers::pi * ring / rings, v = 2 * std::numbers::pi * side / sides;
      positions.push_back(
          Vec3d(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), -std::cos(u)).cast<float>());
    }
  positions.emplace_back(0.0f, 0.0f, 1.0f);
  const auto top = static_cast<std::uint32_t>(positions.size() - 1);
  const auto at = [&](std::uint32_t ring, std::uint32_t side) {
    return 1 + (ring - 1) * sides + side % sides;
  };
  for (std::uint32_t side = 0; side < sides; ++side) {
    triangles.push_back({0, at(1, side + 1), at(1, side)});
    for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
      triangles.push_back({at(ring, side), at(ring, side + 1), at(ring + 1, side + 1)});
      triangles.push_back({at(ring, side), at(ring + 1, side + 1), at(ring + 1, side)});
    }
    triangles.push_back({top, at(rings - 1, side), at(rings - 1, side + 1)});
  }
  return make_body("ball", positions, triangles);
}

void add_box(const Vec3f& low, const Vec3f& high, bool inwards, std::vector<Vec3f>& positions,
             std::vector<Triangle>& triangles) {
  const auto first = static_cast<std::uint32_t>(positions.size());
  for (const int corner : {0, 1, 3, 2, 4, 5, 7, 6})
    positions.emplace_back((corner & 1) != 0 ? high.x() : low.x(),
                           (corner & 2) != 0 ? high.y() : low.y(),
                           (corner & 4) != 0 ? high.z() : low.z());
  for (Triangle triangle : {Triangle{0, 2, 1},
                            {0, 3, 2},
                            {4, 5, 6},
                            {4, 6, 7},
                            {0, 1, 5},
                            {0, 5, 4},
                            {1, 2, 6},
                            {1, 6, 5},
                            {2, 3, 7},
                            {2, 7, 6},
                            {3, 0, 4},
                            {3, 4, 7}}) {
    if (inwards) std::swap(triangle[1], triangle[2]);
    triangles.push_back({first + triangle[0], first + triangle[1], first + triangle[2]});
  }
}

/// A box with a cavity that contains a box.
Character make_nested_boxes() {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  add_box({-1, -1, -1}, {1, 1, 1}, false, positions, triangles);
  add_box({-0.7f, -0.6f, -0.8f}, {0.5f, 0.7f, 0.6f}, true, positions, triangles);
  add_box({-0.4f, -0.3f, -0.5f}, {0.2f, 0.4f, 0.3f}, false, positions, triangles);
  return make_body("boxes", positions, triangles);
}

Character random_body(Random& random) {
  const std::uint32_t a = random.index(16),
                      b = random.index(16);  // evaluated in this order by every compiler
  switch (random.index(4)) {
    case 0: return make_torus(5 + a, 4 + b);
    case 1: return make_ball(3 + a, 4 + b);
    case 2: return make_nested_boxes();
    default: return test::make_tube(3 + a, 4 + b, 2);
  }
}

// ---- The bodies after cuts.

/// Positions of a torn body's points on the posed source and in the planes of its cuts, in double;
/// the only stored positions used are the source's.
class Places {
 public:
  Places(const TornModel& model, const ModelPose& pose) : model_(model), pose_(pose) {
    of_vertex_ = test::posed_positions(model.source(), 0, pose);
  }

  /// To be called after each cut.
  void extend(const PlaneCut& cut) {
    const Mesh& mesh = model_.character().meshes[0];
    const auto source_vertices = model_.source().meshes[0].vertex_count();
    const auto source_triangles = model_.source().meshes[0].triangle_count();
    const auto first = static_cast<std::uint32_t>(of_vertex_.size());
    of_vertex_.resize(mesh.vertex_count(), Vec3d::Constant(std::nan("")));
    const auto corner_of = [&](const Birth& birth, std::size_t k) {
      return birth.triangle < source_triangles
                 ? model_.source().meshes[0].triangles[birth.triangle][k]
                 : model_.fillings(0)[birth.triangle - source_triangles][k];
    };
    const auto is_own = [&](std::uint32_t vertex) {  // a corner of a cap as created
      if (vertex < source_vertices) return false;
      const Birth birth = model_.birth(0, vertex);
      for (std::size_t k = 0; k < 3; ++k)
        if (birth.triangle >= source_triangles && birth.barycentric[k] == 1 &&
            corner_of(birth, k) == vertex)
          return true;
      return false;
    };
    for (std::uint32_t vertex = first; vertex < mesh.vertex_count(); ++vertex) {
      if (is_own(vertex)) continue;
      const Birth birth = model_.birth(0, vertex);
      of_vertex_[vertex] = Vec3d::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        if (birth.barycentric[k] != 0)
          of_vertex_[vertex] += birth.barycentric[k] * of_vertex_[corner_of(birth, k)];
    }
    std::vector<Vec3d> of_point(model_.point_count(), Vec3d::Constant(std::nan("")));
    const auto for_each_corner =
        [&](const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
          for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
            for (std::uint32_t k = 0; k < 3 && !is_retired(mesh.triangles[t]); ++k)
              visit(mesh.triangles[t][k], model_.point_at(0, t, k));
        };
    for_each_corner([&](std::uint32_t vertex, std::uint32_t point) {
      if (of_vertex_[vertex].allFinite()) of_point[point] = of_vertex_[vertex];
    });
    const auto stored = test::posed_positions(model_.character(), 0, pose_);
    const Vec3d normal = cut.normal.normalized();
    for_each_corner([&](std::uint32_t vertex, std::uint32_t point) {
      if (of_vertex_[vertex].allFinite()) return;
      if (of_point[point].allFinite())
        of_vertex_[vertex] = of_point[point];
      else  // inside of a cap
        of_vertex_[vertex] = stored[vertex] - normal.dot(stored[vertex] - cut.point) * normal;
    });
  }

  [[nodiscard]] const Vec3d& operator[](std::uint32_t vertex) const { return of_vertex_[vertex]; }

 private:
  const TornModel& model_;
  const ModelPose& pose_;
  std::vector<Vec3d> of_vertex_;
};

/// The connected components across edges, by the kernel's points.
struct Body {
  std::vector<std::uint32_t> triangles;
  bool is_closed = true;  ///< Each edge has one face on each side.
  double volume = 0;
};

std::vector<Body> bodies_of(const TornModel& model,
                            const std::function<Vec3d(std::uint32_t)>& place) {
  const Mesh& mesh = model.character().meshes[0];
  std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> faces_of_edge;  // directed
  std::vector<std::uint32_t> parent(mesh.triangle_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto find = [&](std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  const auto edge_of = [&](std::uint32_t t, std::uint32_t k) {
    return std::array{model.point_at(0, t, k), model.point_at(0, t, (k + 1) % 3)};
  };
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::uint32_t k = 0; k < 3 && !is_retired(mesh.triangles[t]); ++k)
      faces_of_edge[edge_of(t, k)].push_back(t);
  std::set<std::uint32_t> with_border;
  for (const auto& [edge, faces] : faces_of_edge) {
    const auto other = faces_of_edge.find({edge[1], edge[0]});
    if (faces.size() == 1 && other != faces_of_edge.end() && other->second.size() == 1)
      parent[find(faces[0])] = find(other->second[0]);
    else
      with_border.insert(faces.begin(), faces.end());
  }
  std::map<std::uint32_t, Body> bodies;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (is_retired(mesh.triangles[t])) continue;
    Body& body = bodies[find(t)];
    body.triangles.push_back(t);
    body.is_closed = body.is_closed && !with_border.contains(t);
    const Vec3d a = place(mesh.triangles[t][0]), b = place(mesh.triangles[t][1]),
                c = place(mesh.triangles[t][2]);
    body.volume += a.dot(Vec3d(b.cross(c))) / 6;
  }
  std::vector<Body> result;
  for (auto& [unused, body] : bodies) result.push_back(std::move(body));
  return result;
}

double sum_of_volumes(const std::vector<Body>& bodies) {
  return std::accumulate(bodies.begin(), bodies.end(), 0.0,
                         [](double sum, const Body& body) { return sum + body.volume; });
}

std::array<double, 4> plane_of(const PlaneCut& cut) {
  const Vec3d normal = cut.normal.normalized();
  return {normal.x(), normal.y(), normal.z(), normal.dot(cut.point)};
}

SplitTask task_of(const Character& source, const ModelPose& pose) {
  const TornModel model = make_model(source);
  SplitTask task;
  task.positions.resize(model.point_count());
  const auto posed = test::posed_positions(source, 0, pose);
  const Mesh& mesh = source.meshes[0];
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    auto& triangle = task.triangles.emplace_back();
    for (std::uint32_t k = 0; k < 3; ++k) {
      triangle[k] = model.point_at(0, t, k);
      const Vec3d& at = posed[mesh.triangles[t][k]];
      task.positions[triangle[k]] = {at.x(), at.y(), at.z()};
    }
  }
  return task;
}

/// For each body, its side of all planes, determined by its farthest point from each.
SplitCells cells_of(const TornModel& model, const std::vector<Body>& bodies, const SplitTask& task,
                    const std::function<Vec3d(std::uint32_t)>& place) {
  SplitCells cells;
  for (const Body& body : bodies) {
    std::string sides;
    for (const auto& [x, y, z, offset] : task.planes) {
      double farthest = 0;
      for (const std::uint32_t t : body.triangles)
        for (const std::uint32_t vertex : model.character().meshes[0].triangles[t]) {
          const double distance = Vec3d(x, y, z).dot(place(vertex)) - offset;
          if (std::abs(distance) > std::abs(farthest)) farthest = distance;
        }
      sides += farthest > 0 ? '+' : '-';
    }
    cells[sides].volume += body.volume;
    ++cells[sides].parts;
  }
  return cells;
}

void expect_same_cells(const SplitCells& ours, const SplitCells& theirs, double whole) {
  for (const auto& [sides, cell] : ours) {
    const auto other = theirs.find(sides);
    EXPECT_NEAR(cell.volume, other == theirs.end() ? 0.0 : other->second.volume, 1e-6 * whole)
        << sides;
  }
  for (const auto& [sides, cell] : theirs)
    EXPECT_TRUE(ours.contains(sides) || std::abs(cell.volume) <= 1e-6 * whole)
        << sides << " has volume " << cell.volume;
}

PlaneCut cut_at(const Vec3d& point, const Vec3d& normal) {
  PlaneCut cut;
  cut.point = point;
  cut.normal = normal;
  cut.caps = true;
  return cut;
}

Vec3d somewhere_in(const Character& character, const ModelPose& pose, Random& random) {
  const auto positions = test::posed_positions(character, 0, pose);
  const auto count = static_cast<std::uint32_t>(positions.size());
  const double part = random.uniform(0, 1);
  Vec3d place = part * positions[random.index(count)];
  place += (1 - part) * positions[random.index(count)];
  return place;
}

/// The positions of a cut are known in double. Rim points of a later cut lie in its plane only
/// within the precision of stored positions, and so does a vertex that is closer to the plane than
/// that.
constexpr double kExactVolume = 1e-12, kStored = 1e-6;

/// Cuts a copy of the body and checks the result.
struct CutBody {
  SplitTask task;
  SplitCells cells;
  double whole = 0;
  bool is_capped = true;  ///< Everywhere.
};

///
/// @param rounding   of the volume, as a fraction of it.
/// @param may_touch  the section may touch itself; such parts get no cap.
CutBody cut_and_check(const Character& character, const ModelPose& pose,
                      const std::vector<PlaneCut>& cuts, double rounding, bool may_touch = false) {
  CutBody result;
  TornModel model = make_model(character);
  result.task = task_of(character, pose);
  Places places(model, pose);
  const auto place = [&](std::uint32_t vertex) { return places[vertex]; };
  const std::vector<Body> before = bodies_of(model, place);
  for (const Body& body : before) EXPECT_TRUE(body.is_closed);
  result.whole = sum_of_volumes(before);
  for (const PlaneCut& cut : cuts) {
    SCOPED_TRACE(testing::Message() << character.name << ", point " << cut.point.transpose()
                                    << ", normal " << cut.normal.transpose());
    const auto report = model.cut(pose, cut);
    EXPECT_TRUE(report) << report.error().text();
    result.is_capped = result.is_capped && report->open_sections == 0 && report->blocked == 0;
    EXPECT_TRUE(result.is_capped || may_touch);
    EXPECT_EQ(report->caps + report->open_sections > 0, report->runs > 0);
    places.extend(cut);
    result.task.planes.push_back(plane_of(cut));
  }
  const std::vector<Body> bodies = bodies_of(model, place);
  for (const Body& body : bodies) EXPECT_TRUE(body.is_closed || !result.is_capped);
  // The kernel's points agree with the arrays.
  const TopologyCounts counts = *count_topology(model.character());
  EXPECT_EQ(counts.components, bodies.size());
  EXPECT_EQ(counts.boundary_edges == 0, result.is_capped);
  EXPECT_EQ(counts.non_manifold_edges, 0u);
  if (result.is_capped) {
    EXPECT_NEAR(sum_of_volumes(bodies), result.whole, rounding * result.whole);
  }
  const auto stored = test::posed_positions(model.character(), 0, pose);
  if (cuts.size() > 1 && result.is_capped) {
    EXPECT_NEAR(sum_of_volumes(bodies_of(model, [&](std::uint32_t v) { return stored[v]; })),
                result.whole, 1e-5 * result.whole);
  }
  result.cells = cells_of(model, bodies, result.task, place);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  while (model.undo_count() > 0) EXPECT_TRUE(model.undo());
  EXPECT_EQ(model.character(), model.source());
  return result;
}

/// Compares with Manifold if it is installed.
void compare(const std::vector<CutBody>& bodies) {
  ASSERT_FALSE(bodies.empty());
  if (!test::has_manifold()) return;
  std::vector<SplitTask> tasks;
  for (const CutBody& body : bodies) tasks.push_back(body.task);
  const auto cells = test::split_by_manifold(tasks);
  ASSERT_EQ(cells.size(), bodies.size()) << "Manifold did not run";
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    std::ostringstream planes;
    planes.precision(17);
    for (const auto& [x, y, z, offset] : tasks[i].planes)
      planes << x << ' ' << y << ' ' << z << ' ' << offset << '\n';
    SCOPED_TRACE(planes.str());
    expect_same_cells(bodies[i].cells, cells[i], bodies[i].whole);
  }
}

using MakePose = std::function<ModelPose(const Character&, Random&)>;

/// Cuts random bodies one after another, checks the pieces of each and compares them all.
void cut_random_bodies(std::uint64_t seed, int cases, const MakePose& make_pose,
                       const std::function<std::size_t(Random&)>& count_of_cuts, double tolerance) {
  Random random(seed);
  std::vector<CutBody> bodies;
  for (int i = 0; i < cases; ++i) {
    SCOPED_TRACE(i);
    const Character character = random_body(random);
    const ModelPose pose = make_pose(character, random);
    std::vector<PlaneCut> cuts(count_of_cuts(random));
    for (PlaneCut& cut : cuts) {
      const Vec3d point = somewhere_in(character, pose, random);
      cut = cut_at(point, random.direction());
    }
    bodies.push_back(cut_and_check(character, pose, cuts, tolerance));
    if (testing::Test::HasFailure()) return;
  }
  compare(bodies);
}

ModelPose in_bind_pose(const Character& character, Random&) { return *bind_pose(character); }
ModelPose bent(const Character& character, Random& random) {
  return test::random_pose(character, random, 0.3, 1.2);
}
std::size_t one(Random&) { return 1; }
std::size_t several(Random& random) { return 2 + random.index(5); }

TEST(CutVolume, of_one_random_cut_adds_up) {
  cut_random_bodies(1, count_of_bodies(100), in_bind_pose, one, kExactVolume);
}

TEST(CutVolume, of_one_cut_in_a_bent_pose_adds_up) {
  cut_random_bodies(2, count_of_bodies(60), bent, one, kExactVolume);
}

TEST(CutVolume, of_many_cuts_adds_up) {
  cut_random_bodies(3, count_of_bodies(60), in_bind_pose, several, kStored);
}

/// Whether a plane passes so close to a face, the farthest point of a body or a saddle point that
/// stored positions cannot tell them apart: there pieces without volume come off, or the section
/// touches itself and gets no cap.
bool grazes(const Character& character, const PlaneCut& cut) {
  constexpr double kNear = 2e-3;
  const SplitTask task = task_of(character, *bind_pose(character));
  std::vector<int> side;
  for (const auto& [x, y, z] : task.positions) {
    const double distance = cut.normal.normalized().dot(Vec3d(x, y, z) - cut.point);
    side.push_back(distance > kNear ? 1 : distance < -kNear ? -1 : 0);
  }
  if (std::find(side.begin(), side.end(), 1) == side.end() ||
      std::find(side.begin(), side.end(), -1) == side.end())
    return true;
  std::map<std::uint32_t, int> lines;                       // in which the plane leaves a point
  std::map<std::array<std::uint32_t, 2>, int> side_beside;  // of edges in the plane
  for (const auto& triangle : task.triangles) {
    if (side[triangle[0]] == 0 && side[triangle[1]] == 0 && side[triangle[2]] == 0) return true;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3], c = triangle[(k + 2) % 3];
      if (side[a] == 0 && side[b] * side[c] < 0) ++lines[a];
      if (side[a] != 0 || side[b] != 0) continue;
      int& beside = side_beside[{std::min(a, b), std::max(a, b)}];
      if (beside * side[c] < 0) {
        ++lines[a];
        ++lines[b];
      }
      beside = side[c];
    }
  }
  return std::any_of(lines.begin(), lines.end(), [](const auto& at) { return at.second > 2; });
}

/// Along the axes, through vertices and along edges.
TEST(CutVolume, of_cuts_through_vertices_and_edges_adds_up) {
  Random random(4);
  std::vector<CutBody> bodies;
  for (int i = 0; i < count_of_bodies(150); ++i) {
    SCOPED_TRACE(i);
    const Character character = random_body(random);
    const ModelPose pose = *bind_pose(character);
    std::vector<PlaneCut> cuts(1 + random.index(3));
    for (PlaneCut& cut : cuts) {
      const Mesh& mesh = character.meshes[0];
      const Vec3d point = mesh.positions[random.index(mesh.vertex_count())].cast<double>();
      const double side = random.index(2) == 0 ? 1.0 : -1.0;
      cut = cut_at(point, side * Vec3d(Vec3d::Unit(random.index(3))));
      if (random.index(3) == 0) cut.point += std::pow(10.0, random.uniform(-16, -3)) * cut.normal;
    }
    std::erase_if(cuts, [&](const PlaneCut& cut) { return grazes(character, cut); });
    if (cuts.empty()) continue;
    CutBody body = cut_and_check(character, pose, cuts, kStored, cuts.size() > 1);
    if (body.is_capped) bodies.push_back(std::move(body));
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(static_cast<int>(bodies.size()), count_of_bodies(75));
  compare(bodies);
}

/// The tests above compare with Manifold if it is installed; this one reports by name if it is not.
TEST(CutVolume, is_compared_with_manifold) { SUNDER_SKIP_WITHOUT_MANIFOLD(); }

}  // namespace
}  // namespace sunder
