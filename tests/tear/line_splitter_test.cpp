// Faces that are crossed in one pass, without a complete tear.
#include "tear/surface/line_splitter.h"

#include <map>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/say.h"
#include "support/models/rigs.h"
#include "tear/geometry/face_shape.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/flip_edge.h"
#include "tear/surface/split.h"

namespace sunder::tear {
namespace {

using test::Random;

Character some_rig(Random& random) {
  switch (random.index(4)) {
    case 0: return test::make_sheet(2 + random.index(8));
    case 1: return test::make_two_tubes(3 + random.index(4), 5 + random.index(6));
    case 2: return test::make_bumpy_ball(100 + random.index(300));
    default: return test::make_tube(3 + random.index(8), 5 + random.index(8), 3);
  }
}

/// Faults in the references between faces and points.
std::vector<std::string> broken_connections(const SurfaceEditor& editor) {
  std::vector<std::string> broken;
  const Surface& surface = editor.surface();
  for (Index h = 0; h < surface.twin.size(); ++h) {
    const Index twin = surface.twin[h];
    if (twin == kNone) continue;
    if (surface.twin[twin] != h)
      broken.push_back(test::say("half-edge ", h, " is not its twin's twin"));
    if (surface.corner_point[h] != surface.corner_point[Surface::next(twin)] ||
        surface.corner_point[twin] != surface.corner_point[Surface::next(h)])
      broken.push_back(
          test::say("half-edges ", h, " and ", twin, " do not run between the same points"));
  }
  for (Index point = 0; point < surface.point_count(); ++point)
    if (const Index corner = surface.point_corner[point];
        corner != kNone && surface.corner_point[corner] != point)
      broken.push_back(test::say("point ", point, " is known by a corner of another one"));
  // Each fan is all of its point's corners.
  std::map<Index, std::size_t> corners;
  for (const Index point : surface.corner_point) ++corners[point];
  for (const auto& [point, count] : corners) {
    std::size_t found = 0;
    surface.for_each_in_fan(surface.point_corner[point], [&](Index) { ++found; });
    if (found != count)
      broken.push_back(
          test::say("point ", point, " has ", count, " corners, ", found, " of them in its fan"));
  }
  return broken;
}

/// Per origin of mesh 0 and later meshes: the fraction that its parts cover.
std::map<std::array<Index, 2>, double> cover(const SurfaceEditor& editor) {
  std::map<std::array<Index, 2>, double> covered;
  for (Index face = 0; face < editor.surface().triangle_count(); ++face) {
    const TriangleRef ref = editor.surface().triangle(face);
    const double part =
        covered_part(editor.source_barycentric(3 * face), editor.source_barycentric(3 * face + 1),
                     editor.source_barycentric(3 * face + 2));
    EXPECT_GT(part, 0);
    covered[{ref.mesh, ref.source_triangle}] += part;
  }
  return covered;
}

double worse_shape(Index half_edge, const SurfaceEditor& editor) {
  double least = 1;
  for (const Index face : {half_edge / 3, editor.surface().twin[half_edge] / 3}) {
    const auto& positions =
        editor.character().meshes[editor.surface().triangle(face).mesh].positions;
    const auto at = [&](Index k) { return place_of(positions[editor.vertex_at(3 * face + k)]); };
    least = std::min(least, shape_squared(at(0), at(1), at(2)));
  }
  return least;
}

TEST(LineSplitter, splits_faces_and_keeps_the_surface) {
  int crossed = 0, seams = 0, other_diagonals = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character source = some_rig(random);
    Character character = source;
    SurfaceEditor editor(source, character);
    const Surface& surface = editor.surface();
    for (int line = 0; line < 4; ++line) {
      const EditLog::Mark before = editor.mark();
      const auto corner_point = surface.corner_point, twin = surface.twin,
                 point_corner = surface.point_corner;
      const Character as_it_was = character;
      LineSplitter splitter(editor);
      const auto fraction = [&] {
        return random.index(8) == 0 ? 1e-3 : random.uniform(0.01, 0.99);
      };
      Index last =
          splitter.begin(random.index(static_cast<Index>(surface.corner_point.size())), fraction());
      if (last == kNone) continue;
      std::vector<Index> path = {last};
      std::set<Index> in_three;
      while (splitter.ahead() != kNone && editor.origins.is_whole(splitter.ahead() / 3) &&
             random.index(40) != 0) {
        const Index entry = splitter.ahead(),
                    exit = random.index(2) == 0 ? Surface::next(entry) : Surface::previous(entry);
        const std::size_t vertices =
            character.meshes[surface.triangle(entry / 3).mesh].vertex_count();
        last = splitter.go_on(exit, fraction());
        if (last == kNone) {
          ASSERT_EQ(character.meshes[surface.triangle(entry / 3).mesh].vertex_count(), vertices);
          ASSERT_EQ(splitter.ahead(), entry);
          break;
        }
        seams += character.meshes[surface.triangle(entry / 3).mesh].vertex_count() > vertices + 1
                     ? 1
                     : 0;
        ASSERT_EQ(surface.corner_point[splitter.half_edge()], path.back());
        ASSERT_EQ(surface.corner_point[Surface::next(splitter.half_edge())], last);
        ASSERT_NE(surface.twin[splitter.half_edge()], kNone);
        path.push_back(last);
        in_three.insert(entry / 3);
        ++crossed;
      }
      splitter.end();
      ASSERT_THAT(broken_connections(editor), testing::IsEmpty());
      for (const auto& [origin, part] : cover(editor)) ASSERT_NEAR(part, 1, 1e-12) << origin[1];
      for (std::size_t i = 1; i < path.size(); ++i)
        ASSERT_NE(surface.find_half_edge(path[i - 1], path[i]), kNone);

      // The other diagonal of the quadrilateral next to the lost corner is not better.
      for (const Index face : in_three)
        for (Index h = 3 * face; h < 3 * face + 3; ++h) {
          const Index other = surface.twin[h];
          if (other == kNone || !editor.origins.is_inner_edge(h)) continue;
          const std::set<Index> ends = {surface.corner_point[h],
                                        surface.corner_point[Surface::next(h)]};
          const bool is_path = std::count_if(path.begin(), path.end(),
                                             [&](Index p) { return ends.count(p) != 0; }) == 2;
          int parts = 0;
          const TriangleRef ref = surface.triangle(face);
          editor.origins.for_each_part(ref.mesh, ref.source_triangle, [&](Index) { ++parts; });
          if (is_path || parts != 3) continue;
          const double shape = worse_shape(h, editor);
          const EditLog::Mark turned = editor.mark();
          if (!flip_edge(h, editor)) continue;
          EXPECT_LE(worse_shape(Surface::next(h), editor), 1.001 * kBetterShapeFactor * shape);
          ++other_diagonals;
          editor.roll_back(turned);
        }

      if (random.index(2) == 0) continue;
      editor.roll_back(before);
      ASSERT_EQ(surface.corner_point, corner_point);
      ASSERT_EQ(surface.twin, twin);
      ASSERT_EQ(surface.point_corner, point_corner);
      ASSERT_EQ(character, as_it_was);
    }
  }
  EXPECT_GT(crossed, 3000);
  EXPECT_GT(seams, 50);
  EXPECT_GT(other_diagonals, 1000);
}

TEST(LineSplitter, of_one_edge_is_a_split_edge) {
  const Character source = test::make_tube(4, 6, 2);
  for (Index half_edge = 0; half_edge < 3 * source.meshes[0].triangle_count(); half_edge += 7) {
    Character one = source, other = source;
    SurfaceEditor by_line(source, one), by_split(source, other);
    LineSplitter splitter(by_line);
    (void)by_line.mark();
    (void)by_split.mark();
    const Index point = splitter.begin(half_edge, 0.25);
    splitter.end();
    EXPECT_EQ(point, split_edge(half_edge, 0.25, by_split));
    EXPECT_EQ(one, other);
    EXPECT_EQ(by_line.surface().twin, by_split.surface().twin);
  }
}

}  // namespace
}  // namespace sunder::tear
