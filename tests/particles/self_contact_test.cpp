#include <sunder/particles/soft_body.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "particles/soft_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::SoftScene;

SoftBodyOptions touching(double thickness, double friction = 0) {
  SoftBodyOptions options;
  options.self_contact = {thickness, friction};
  return options;
}

/// A sheet whose lips are pressed together by forces on both sides of a slit.
struct PressedSheet {
  SoftScene scene;
  std::vector<LipPair> lips;

  PressedSheet(const SoftBodyOptions& options, double force)
      : scene(test::make_sheet(60), SoftMaterial{}, 0.07, options) {
    const Stroke stroke = {test::down_at(0.3, 0.503), test::down_at(0.7, 0.503)};
    ChangeRecord change;
    EXPECT_TRUE(scene.model->tear(scene.pose, stroke, {}, &change));
    EXPECT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
    lips = change.lips;
    scene.step(1.0 / 60);
    for (Index p = 0; p < scene.count(); ++p) {
      const Vec3f& at = scene.set->positions()[scene.set->seed(p)];
      if (std::abs(at.y() - 0.503f) > 0.15f) continue;
      const double to = at.y() > 0.503f ? -1 : 1;
      EXPECT_TRUE(scene.body->set_force(p, Vec3d(0, force * to * scene.set->area(p), 0)));
    }
  }
  /// The least distance of the lips across the slit; below 0 they passed through one another.
  [[nodiscard]] double least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const LipPair& pair : lips) {
      const Vec3d apart =
          scene.body->point_displacement(pair.left) - scene.body->point_displacement(pair.right);
      const bool is_left_above = is_above(pair.left);
      least = std::min(least, is_left_above ? apart.y() : -apart.y());
    }
    return least;
  }

 private:
  /// Whether a lip's point belongs to the tissue above the slit, by its particle.
  [[nodiscard]] bool is_above(Index point) const {
    const Index owner = scene.set->owners()[point];
    return scene.set->positions()[scene.set->seed(owner)].y() > 0.503f || upper_lip(point);
  }
  [[nodiscard]] bool upper_lip(Index point) const {
    for (const LipEdge& edge : scene.set->lips())
      if (edge.points[0] == point || edge.points[1] == point) return edge.inward.y() > 0;
    return false;
  }
};

TEST(self_contact, pressed_lips_stay_apart) {
  PressedSheet without(touching(0), 6), with(touching(0.01), 6);
  for (PressedSheet* sheet : {&without, &with}) sheet->scene.run(3);
  EXPECT_LT(without.least_gap(), -0.02);
  EXPECT_GT(with.least_gap(), -0.002);
  EXPECT_GT(with.scene.farthest(), 0.001);
}

TEST(self_contact, pressed_lips_fall_asleep) {
  PressedSheet sheet(touching(0.01), 6);
  sheet.scene.run(30);
  EXPECT_LT(sheet.scene.body->awake_count(), 5u);
}

TEST(self_contact, open_lips_change_no_bit) {
  PressedSheet without(touching(0), -30), with(touching(0.01), -30);
  for (PressedSheet* sheet : {&without, &with}) sheet->scene.run(2);
  EXPECT_GT(without.least_gap(), 0);
  EXPECT_TRUE(
      std::ranges::equal(without.scene.body->displacements(), with.scene.body->displacements()));
}

/// A flap of a sheet that is folded along an axis and pressed down on the skin there.
struct FoldedFlap {
  SoftScene scene;
  int axis = 0;  ///< 0: to the right; 1: up.
  Index end = 0;

  explicit FoldedFlap(const SoftBodyOptions& options, int along = 0)
      : scene(test::make_sheet(60), flap_material(), 0.07, options), axis(along) {
    Stroke stroke;
    for (const Vec3d& at :
         {Vec3d(0.5, 0.4, 0), Vec3d(0.2, 0.4, 0), Vec3d(0.2, 0.6, 0), Vec3d(0.5, 0.6, 0)})
      stroke.push_back(test::down_at(turned(at).x(), turned(at).y()));
    ChangeRecord change;
    EXPECT_TRUE(scene.model->tear(scene.pose, stroke, {}, &change));
    EXPECT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
    scene.step(1.0 / 60);
    end = scene.nearest(turned({0.25, 0.5, 0}));
  }
  /// A place for a fold to the right, for a fold along the axis.
  [[nodiscard]] Vec3d turned(const Vec3d& at) const {
    return axis == 0 ? at : Vec3d(at.y(), at.x(), at.z());
  }
  static SoftMaterial flap_material() {
    SoftMaterial material;
    material.return_frequency = 0.3;
    material.damping_ratio = 1;
    material.membrane_stiffness = 1;
    return material;
  }
  void fold() {
    const HoldId hold = *scene.body->hold(end, turned({0.25, 0.5, 0.0}), {});
    const auto lead = [&](const Vec3d& from, const Vec3d& to) {
      for (int i = 1; i <= 60; ++i) {
        EXPECT_TRUE(scene.body->move_hold(hold, turned(from + (to - from) * i / 60)));
        scene.step(1.0 / 60);
      }
    };
    lead({0.25, 0.5, 0}, {0.35, 0.5, 0.25});
    lead({0.35, 0.5, 0.25}, {0.75, 0.5, 0.15});
    lead({0.75, 0.5, 0.15}, {0.78, 0.5, -0.1});
  }
  /// How far points of the flap's end are above the skin there, at least.
  [[nodiscard]] double least_height() const {
    double least = std::numeric_limits<double>::infinity();
    for (Index point = 0; point < scene.set->point_count(); ++point) {
      if (scene.set->owners()[point] != end) continue;
      const Vec3d at =
          scene.set->positions()[point].cast<double>() + scene.body->point_displacement(point);
      double skin = 0, nearest = 1;
      for (Index other = 0; other < scene.set->point_count(); ++other) {
        const Vec3f& rest = scene.set->positions()[other];
        if (rest[axis] < 0.6f) continue;
        const Vec3d there = rest.cast<double>() + scene.body->point_displacement(other);
        const double distance = (there - at).head<2>().norm();
        if (distance < nearest) {
          nearest = distance;
          skin = there.z();
        }
      }
      least = std::min(least, at.z() - skin);
    }
    return least;
  }
};

TEST(self_contact, a_flap_stays_above_the_skin) {
  for (const int axis : {0, 1}) {
    FoldedFlap without(touching(0), axis), with(touching(0.01), axis);
    for (FoldedFlap* flap : {&without, &with}) flap->fold();
    EXPECT_LT(without.least_height(), -0.02);
    EXPECT_GT(with.least_height(), 0);
  }
}

TEST(self_contact, faults_are_named) {
  SoftScene scene(test::make_sheet(8));
  const SoftMaterial material;
  for (const auto& options :
       {touching(-1), touching(1e10), touching(1, -1), touching(std::nan(""))})
    EXPECT_FALSE(SoftBody::create(*scene.set, scene.pose, {&material, 1}, options));
}

}  // namespace
}  // namespace sunder
