// Wounds whose particles were still being made when an operation, undo or redo came.

#include <sunder/particles/soft_body.h>
#include <sunder/tear/tear_stroke.h>

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "particles/soft_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

/// A slit across the middle of a sheet.
Stroke long_slit() {
  constexpr int kPieces = 12;
  Stroke stroke;
  for (int i = 0; i <= kPieces; ++i) {
    const double x = 0.23 + 0.54 * i / kPieces;
    stroke.push_back(test::down_at(x, 0.42 + 0.1 * x));
  }
  return stroke;
}

struct InterruptedSheet {
  test::SoftScene scene;
  std::vector<ChangeRecord> changes;

  InterruptedSheet(Index cells, double range)
      : scene(test::make_sheet(cells), SoftMaterial(), range) {
    EXPECT_TRUE(scene.body->set_tension({1, {}}));
    scene.step(0);
  }
  void follow() { ASSERT_TRUE(scene.set->follow(*scene.model, {&changes.back(), 1})); }
  void tear() {
    ASSERT_TRUE(scene.model->tear(scene.pose, long_slit(), {}, &changes.emplace_back()));
    follow();
  }
  /// In pieces; nothing is settled in between.
  void tear_piecewise() {
    const Stroke whole = long_slit();
    auto stroke = TearStroke::create(*scene.model, scene.pose, whole[0]);
    ASSERT_TRUE(stroke) << stroke.error().text();
    for (std::size_t i = 1; i < whole.size(); ++i) {
      ASSERT_TRUE(stroke->extend(scene.pose, whole[i], 0, &changes.emplace_back()));
      follow();
    }
    ASSERT_TRUE(stroke->end(&changes.emplace_back()));
    follow();
  }
  [[nodiscard]] double gap() {
    scene.run(4);
    double widest = 0;
    for (const ChangeRecord& change : changes)
      for (const LipPair& lip : change.lips)
        widest = std::max(widest, (scene.body->point_displacement(lip.left) -
                                   scene.body->point_displacement(lip.right))
                                      .norm());
    return widest;
  }
};

TEST(interrupted_tear, gapes_after_undo_and_redo_as_before) {
  for (const double range : {0.05, 0.075, 0.1})
    for (const Index cells : {10u, 12u, 20u, 30u}) {
      InterruptedSheet once(cells, range), again(cells, range);
      once.tear();
      again.tear();
      ChangeRecord undone;
      ASSERT_TRUE(again.scene.model->undo(&undone));
      ASSERT_TRUE(again.scene.set->follow(*again.scene.model, {&undone, 1}));
      again.scene.step(0);
      ASSERT_TRUE(again.scene.model->redo(&again.changes.emplace_back()));
      again.follow();
      EXPECT_NEAR(again.gap() / once.gap(), 1, 0.02) << cells << " cells, range " << range;
    }
}

TEST(interrupted_tear, in_pieces_gapes_no_wider_than_at_once) {
  for (const double range : {0.05, 0.075})
    for (const Index cells : {20u, 30u, 60u}) {
      InterruptedSheet once(cells, range), piecewise(cells, range);
      once.tear();
      piecewise.tear_piecewise();
      EXPECT_LT(piecewise.gap() / once.gap(), 1.05) << cells << " cells, range " << range;
    }
}

}  // namespace
}  // namespace sunder
