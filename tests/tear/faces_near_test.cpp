// The faces that are found near a plane.
#include "tear/sheet/faces_near.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "tear/sheet/open_sheet.h"

namespace sunder::tear {
namespace {

/// A plane through a point of a posed surface: exactly through it if `offset` is 0.
PlaneSide plane_at(Index point, double offset, test::Random& random, const SurfaceEditor& editor,
                   PosedPoints& posed) {
  const Vec3d normal = random.direction();
  return {normal, dot(normal, Vec3d(posed.position(editor, point))) + offset};
}

void expect_all_across(const PlaneSide& plane, const SurfaceEditor& editor, PosedPoints& posed) {
  const ScratchVector<Index> near = faces_near({plane, {}}, editor, posed);
  const Surface& surface = editor.surface();
  std::size_t across = 0;
  for (Index face = 0; face < surface.triangle_count(); ++face) {
    if (surface.has_repeated_point(face)) continue;
    const auto is_inside = [&](Index k) {
      return plane.contains(posed.position(editor, surface.corner_point[3 * face + k]));
    };
    if (is_inside(0) == is_inside(1) && is_inside(1) == is_inside(2)) continue;
    ++across;
    EXPECT_EQ(std::count(near.begin(), near.end(), face), 1) << face;
  }
  EXPECT_LE(near.size(), across + 40);  // those around points on the plane
}

TEST(FacesNear, holds_each_face_across_whatever_was_cut_before) {
  Character source = test::make_tube(12, 16, 6);
  for (MorphTarget& target : source.meshes[0].morph_targets) target.position_deltas.clear();
  std::size_t opened = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    Character character = source;
    SurfaceEditor editor(source, character);
    PosedPoints posed;
    for (int cuts = 0; cuts < 4; ++cuts) {
      ASSERT_TRUE(posed.begin(character, test::random_pose(source, random, 0.5, 1.1)));
      const double offset = cuts % 2 == 0 ? 0 : random.uniform(-0.1, 0.1);
      const PlaneSide plane = plane_at(random.index(editor.surface().source_point_count()), offset,
                                       random, editor, posed);
      expect_all_across(plane, editor, posed);
      std::vector<LipPair> lips;
      const Sheet sheet{plane, {}};
      (void)open_sheet(sheet, faces_across(sheet, editor, posed), false, {editor, posed}, lips);
      opened += lips.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(opened, 80u);
}

}  // namespace
}  // namespace sunder::tear
