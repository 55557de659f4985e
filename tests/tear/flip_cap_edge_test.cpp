#include "tear/surface/flip_cap_edge.h"

#include <map>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/rigs.h"
#include "tear/geometry/face_shape.h"
#include "tear/internal/surface.h"
#include "tear/surface/append_filling.h"
#include "tear/surface/split.h"

namespace sunder::tear {
namespace {

using test::Random;

constexpr double kAnyShape = 0.1;

/// A sheet, and a cap with a copy of each of its triangles.
class CappedSheet {
 public:
  explicit CappedSheet(Index cells)
      : source_(test::make_sheet(cells)),
        character_(source_),
        editor_(source_, character_),
        first_(editor_.surface().triangle_count()) {
    const FillingSubmesh of_cap = {0, submesh_of_fillings(0, "cap", kNone, editor_), 0};
    std::map<Index, std::array<Index, 2>> copies;  // point and vertex
    std::map<std::array<Index, 2>, Index> half_edges;
    for (const Triangle& triangle : source_.meshes[0].triangles) {
      std::array<Index, 3> points;
      Triangle vertices;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [copy, is_new] = copies.insert({triangle[k], {}});
        if (is_new)
          copy->second = {append_filling_point(editor_),
                          editor_.births.append_filling_vertex(0, triangle[k])};
        points[k] = copy->second[0];
        vertices[k] = copy->second[1];
      }
      const Index face = append_filling(of_cap, points, vertices, editor_);
      for (Index k = 0; k < 3; ++k) {
        half_edges[{points[k], points[(k + 1) % 3]}] = 3 * face + k;
        const auto other = half_edges.find({points[(k + 1) % 3], points[k]});
        if (other != half_edges.end()) connect(3 * face + k, other->second, editor_);
      }
    }
  }

  [[nodiscard]] SurfaceEditor& editor() { return editor_; }
  [[nodiscard]] const Surface& surface() const { return editor_.surface(); }
  [[nodiscard]] Index first() const { return first_; }
  void move(Index vertex, const Vec3f& way) { character_.meshes[0].positions[vertex] += way; }

  void expect_whole() const {
    double area = 0;
    std::size_t live = 0;
    for (Index face = first_; face < surface().triangle_count(); ++face) {
      if (surface().has_repeated_point(face)) continue;
      ++live;
      const auto at = [&](Index k) {
        return place_of(character_.meshes[0].positions[editor_.vertex_at(3 * face + k)]);
      };
      const Place n = normal(at(0), at(1), at(2));
      EXPECT_GT(n.z, 0);
      area += 0.5 * n.z;
      for (Index h = 3 * face; h < 3 * face + 3; ++h) {
        const Index twin = surface().twin[h];
        if (twin == kNone) continue;
        EXPECT_EQ(surface().twin[twin], h);
        EXPECT_EQ(surface().corner_point[h], surface().corner_point[Surface::next(twin)]);
        EXPECT_EQ(surface().corner_point[twin], surface().corner_point[Surface::next(h)]);
      }
    }
    EXPECT_EQ(live, source_.meshes[0].triangle_count());
    EXPECT_NEAR(area, 1, 1e-6);
    for (Index point = 0; point < surface().point_count(); ++point)
      if (surface().point_corner[point] != kNone) {
        EXPECT_EQ(surface().corner_point[surface().point_corner[point]], point);
      }
  }

 private:
  Character source_, character_;
  SurfaceEditor editor_;
  Index first_;
};

TEST(FlipCapEdge, keeps_a_flat_cap_whole_and_can_be_undone) {
  std::size_t flips = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    CappedSheet sheet(2 + random.index(5));
    const EditLog::Mark before = sheet.editor().mark();
    const auto corner_point = sheet.surface().corner_point, twin = sheet.surface().twin,
               point_corner = sheet.surface().point_corner;
    for (int i = 0; i < 40; ++i) {
      const Index count = 3 * (sheet.surface().triangle_count() - sheet.first());
      const Index h = 3 * sheet.first() + random.index(count);
      if (sheet.surface().has_repeated_point(h / 3)) continue;
      const Index from = sheet.surface().corner_point[h],
                  to = sheet.surface().corner_point[Surface::next(h)];
      const auto fresh = flip_cap_edge(h, kAnyShape, sheet.editor());
      if (!fresh) continue;
      ++flips;
      EXPECT_EQ(sheet.surface().find_half_edge(from, to), kNone);
      EXPECT_EQ(sheet.surface().twin[3 * (*fresh)[0] + 1], 3 * (*fresh)[1] + 1);
    }
    sheet.expect_whole();
    sheet.editor().roll_back(before);
    EXPECT_EQ(sheet.surface().corner_point, corner_point);
    EXPECT_EQ(sheet.surface().twin, twin);
    EXPECT_EQ(sheet.surface().point_corner, point_corner);
    sheet.expect_whole();
  }
  EXPECT_GT(flips, 300u);
}

/// An edge within the cap, between two triangles of a square.
Index diagonal_of(const CappedSheet& sheet) {
  for (Index h = 3 * sheet.first();; ++h)
    if (sheet.surface().twin[h] != kNone && sheet.surface().twin[h] / 3 == h / 3 + 1) return h;
}

TEST(FlipCapEdge, leaves_what_is_bent_or_split_and_the_source) {
  CappedSheet sheet(3);
  const Index h = diagonal_of(sheet), count = sheet.surface().triangle_count();
  for (Index of_source = 0; of_source < 3 * sheet.first(); ++of_source)
    EXPECT_FALSE(flip_cap_edge(of_source, kAnyShape, sheet.editor()));

  const Index opposite = sheet.editor().vertex_at(Surface::previous(h));
  sheet.move(opposite, {0, 0, 0.01f});
  EXPECT_FALSE(flip_cap_edge(h, kAnyShape, sheet.editor()));
  sheet.move(opposite, {0, 0, -0.01f});

  const EditLog::Mark before = sheet.editor().mark();
  ASSERT_NE(split_edge(Surface::next(h), 0.5, sheet.editor()), kNone);
  EXPECT_FALSE(flip_cap_edge(h, kAnyShape, sheet.editor()));
  sheet.editor().roll_back(before);

  EXPECT_EQ(sheet.surface().triangle_count(), count);
  EXPECT_TRUE(flip_cap_edge(h, kAnyShape, sheet.editor()));
}

}  // namespace
}  // namespace sunder::tear
