// Caps and walls take their temporary data from the scratch memory of the operation, and their rows
// from the room that was reserved.
#include <sunder/skinning/pose.h>

#include <gtest/gtest.h>

#include "core/internal/ordered.h"
#include "support/machine/allocation_count.h"
#include "support/models/rigs.h"
#include "tear/filling/bore_wall.h"
#include "tear/filling/caps.h"
#include "tear/filling/lip_walls.h"
#include "tear/sheet/open_sheet.h"
#include "tear/surface/surface_editor.h"

namespace sunder::tear {
namespace {

/// A tube that was cut across, on an editor of fixed capacity.
class OpenTube {
 public:
  OpenTube() : character_(source_), editor_(source_, character_) {
    editor_.reserve({40000, 40000, 16});
    posed_.cover(50000);
    if (!posed_.begin(character_, *bind_pose(source_))) std::abort();
  }

  /// Cuts, and counts the allocations of `fill(opening, work)`. Takes all back.
  template <class Fill>
  std::uint64_t allocations_of(const PlaneSide& plane, Fill fill) {
    editor_.scratch().reset();
    const EditLog::Mark before = editor_.mark();
    const Sheet sheet{plane, {}};
    std::vector<LipPair> lips;
    const SheetOpening opening =
        open_sheet(sheet, faces_across(sheet, editor_, posed_), true, {editor_, posed_}, lips);
    const Index triangles = editor_.surface().triangle_count();
    const std::uint64_t count = test::allocation_count();
    fill(opening, Workpiece{editor_, posed_});
    const std::uint64_t allocations = test::allocation_count() - count;
    EXPECT_GT(editor_.surface().triangle_count(), triangles);
    editor_.roll_back(before);
    posed_.forget_from(before.points);
    return allocations;
  }

 private:
  Character source_ = test::make_tube(20, 48, 6);
  Character character_;
  SurfaceEditor editor_;
  PosedPoints posed_;
};

PlaneSide plane_across(test::Random& random) {
  const Vec3d normal = normalized(Vec3d(random.direction() + 2 * Vec3d::UnitY()));
  return {normal, dot(normal, Vec3d(0, random.uniform(1, 2), 0))};
}

TEST(FillingMemory, warm_caps_allocate_nothing) {
  OpenTube tube;
  test::Random random(1);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const PlaneSide plane = plane_across(random);
    const auto count = tube.allocations_of(plane, [&](const auto& opening, const Workpiece& work) {
      TearReport report;
      std::vector<LipPair> lips;
      add_caps(opening, plane.normal, kNone, work, report, lips);
      EXPECT_EQ(report.caps, 2u);
    });
    EXPECT_EQ(count, 0u);
  }
}

TEST(FillingMemory, warm_walls_allocate_nothing) {
  OpenTube tube;
  test::Random random(2);
  const Stroke stroke{{{1, 2, 0}, {0, 2, 0}}, {{0, 2, 1}, {0, 2, 0}}};
  LipWallOptions options;
  options.depth = 0.01;
  LipWalls walls;
  walls.submeshes.reserve(1);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const auto hang = [&](const auto& opening, const Workpiece& work) {
      walls.clear();
      EXPECT_EQ(add_lip_walls(opening.left, stroke, options, walls, work), 1u);
    };
    EXPECT_EQ(tube.allocations_of(plane_across(random), hang), 0u);
    // Each side is a bore without a second rim: a wall with a floor.
    const auto line = [&](const auto& opening, const Workpiece& work) {
      const Index left = add_bore_wall(opening.left, {0, 3, 0}, {0, -1, 0}, 4, kNone, work),
                  right = add_bore_wall(opening.right, {0, 3, 0}, {0, -1, 0}, 4, kNone, work);
      EXPECT_EQ(left + right, 1u);
    };
    EXPECT_EQ(tube.allocations_of(plane_across(random), line), 0u);
  }
}

}  // namespace
}  // namespace sunder::tear
