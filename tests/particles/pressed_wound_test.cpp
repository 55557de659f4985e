// Tissue tears where it is pulled or sheared apart, and not where it is pressed together.

#include <sunder/particles/force_tearing.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "particles/soft_scene.h"
#include "support/models/rigs.h"
#include "support/oracles/membrane.h"

namespace sunder {
namespace {

using test::SoftScene;

constexpr double kHalfLength = 0.2, kMiddle = 0.503;
/// Where a bent sheet of 80 cells is level: in the middle of the faces of the slit, so that a force
/// along y is along these.
constexpr double kLevel = 40.5 / 80;

/// A slit along x in the middle of a sheet of one metre in the plane z = 0, or in the same sheet
/// placed or bent otherwise.
struct Wound {
  std::uint32_t cells = 80;
  double range = 0.1;  ///< Metres.
  double toughness = 1e6;
  double gap = 0;                         ///< Width of the tear, metres.
  bool is_reversed = false;               ///< Torn from +x to -x.
  Affine3d rest = Affine3d::Identity();   ///< Of the sheet before it is torn.
  Affine3d bones = Affine3d::Identity();  ///< Moves all bones, after the tear.
  double bent_radius = 0;                 ///< Of the sheet around the axis of the slit; 0: flat.
};

/// How the two sides of a wound are pulled: newtons per patch, in the sheet's own directions.
struct Pull {
  double apart = 0;   ///< Across the slit; below 0: pressed together.
  double along = 0;   ///< In its direction.
  double across = 0;  ///< Out of the surface.
};

/// A place of the flat sheet on the bent one.
Vec3d bent(const Wound& wound, const Vec3d& at) {
  if (!(wound.bent_radius > 0)) return at;
  const double angle = (at.y() - kLevel) / wound.bent_radius;
  const double radius = wound.bent_radius + at.z();
  return {at.x(), kLevel + radius * std::sin(angle), radius * std::cos(angle) - wound.bent_radius};
}

class PulledWound {
 public:
  explicit PulledWound(const Wound& of) : wound_(of), scene_(make(of)) {
    const auto blade = [&](double x) {
      const auto placed = [&](double z) { return of.rest * bent(of, {x, kMiddle, z}); };
      return Blade{placed(0.1), placed(-0.1)};
    };
    // Where the ends of a gap are on lines of the mesh, no tip is found.
    const double half = kHalfLength - (of.gap > 0 ? 0.0013 : 0.0);
    std::array<Blade, 2> stroke = {blade(0.5 - half), blade(0.5 + half)};
    if (of.is_reversed) std::swap(stroke[0], stroke[1]);
    TearOptions options;
    options.width = of.gap;
    ChangeRecord change;
    EXPECT_TRUE(scene_.model->tear(scene_.pose, stroke, options, &change));
    EXPECT_TRUE(scene_.set->follow(*scene_.model, {&change, 1}));
    while (scene_.set->settle(*scene_.model)) continue;
    scene_.pose = test::moved(scene_.pose, of.bones);
    scene_.step(0.1);
  }

  /// In balance.
  ForceTearingReport under(const Pull& pull) {
    for (const double part : {0.9, 1.0}) {  // at the end it is awake
      std::vector<Vec3d> forces(scene_.count(), Vec3d::Zero());
      for (std::uint32_t p = 0; p < scene_.set->point_count(); ++p)
        if (const std::uint32_t owner = scene_.set->owners()[p]; owner != kNone)
          forces[owner] += part * force_at(p, pull);
      for (std::uint32_t p = 0; p < forces.size(); ++p)
        EXPECT_TRUE(scene_.body->set_force(p, forces[p]));
      for (int i = 0; i < (part < 1 ? 60 : 5); ++i) scene_.step(0.1);
    }
    const auto report = tear_overstretched(*scene_.body, *scene_.set, *scene_.model, scene_.pose);
    EXPECT_TRUE(report) << report.error().text();
    return report ? *report : ForceTearingReport();
  }
  double release(const Pull& pull) { return under(pull).greatest_release; }

 private:
  static SoftScene make(const Wound& of) {
    Character sheet = test::make_sheet(of.cells);
    Eigen::AlignedBox3f box;
    for (Vec3f& at : sheet.meshes[0].positions) {
      at = Vec3d(of.rest * bent(of, at.cast<double>())).cast<float>();
      box.extend(Eigen::Vector3f(at));
    }
    SoftMaterial material;
    material.return_frequency = test::frequency_of(400);
    material.toughness = of.toughness;
    return SoftScene(std::move(sheet), material, of.range / double{box.diagonal().norm()});
  }

  /// Where a point is on the flat sheet.
  [[nodiscard]] Vec3d flat(std::uint32_t point) const {
    const Vec3d at = wound_.rest.inverse() * scene_.set->positions()[point].cast<double>();
    if (!(wound_.bent_radius > 0)) return at;
    const double angle = std::atan2(at.y() - kLevel, at.z() + wound_.bent_radius);
    return {at.x(), kLevel + angle * wound_.bent_radius, 0};
  }
  /// On two patches at both sides of the slit, between its tips and near them.
  [[nodiscard]] Vec3d force_at(std::uint32_t point, const Pull& pull) const {
    const Vec3d at = flat(point);
    const double x = std::abs(at.x() - 0.5), y = at.y() - kMiddle;
    if (x > 0.15 || std::abs(y) < 0.04 || std::abs(y) > 0.12) return Vec3d::Zero();
    const Vec3d force = std::copysign(400.0 / (wound_.cells * wound_.cells), y) *
                        Vec3d(pull.along, pull.apart, pull.across);
    return wound_.bones.linear() * (wound_.rest.linear() * force);
  }

  Wound wound_;
  SoftScene scene_;
};

/// A rotation that moves every axis.
Affine3d turned() {
  Affine3d map = test::turn_by(2.1, Vec3d(1, -2, 0.5).normalized());
  map.translation() = Vec3d(0.3, -0.1, 0.7);
  return map;
}

std::vector<Wound> wounds() {
  std::vector<Wound> all;
  all.push_back({});
  all.push_back({.cells = 160, .range = 0.05});
  all.push_back({.is_reversed = true});
  all.push_back({.rest = turned()});
  all.push_back({.bones = turned()});
  all.push_back({.bent_radius = 0.25});
  return all;
}

TEST(PressedWound, releases_nothing_at_any_load) {
  for (const Wound& of : wounds()) {
    PulledWound wound(of);
    const double opened = wound.release({.apart = 0.05});
    EXPECT_GT(opened, 1e-3);
    for (const double load : {0.05, 0.5, 5.0})
      EXPECT_LT(wound.release({.apart = -load}), 1e-6 * opened) << load;
    EXPECT_NEAR(wound.release({.apart = 0.05}), opened, 1e-3 * opened);  // nothing is remembered
  }
}

TEST(PressedWound, never_tears_on_and_does_when_it_is_pulled_apart) {
  for (Wound of : wounds()) {
    of.toughness = 1;
    const double release = PulledWound({of}).release({.apart = 0.05});
    of.toughness = 0.9 * release;
    PulledWound pressed(of), pulled(of);
    for (const double load : {0.05, 1.0, 30.0})
      EXPECT_FALSE(pressed.under({.apart = -load}).has_torn) << load;
    EXPECT_FALSE(pulled.under({.apart = 0.045}).has_torn);  // by the square: 0.81 of it
    EXPECT_TRUE(pulled.under({.apart = 0.05}).has_torn);
  }
}

TEST(PressedWound, shear_tears_as_a_pull_does) {
  // The components of the displacement are independent, and each obeys the same equation.
  for (const Wound& of : wounds()) {
    if (of.bent_radius > 0) continue;  // there, the directions differ from point to point
    PulledWound wound(of);
    const double opened = wound.release({.apart = 0.05});
    for (const double sign : {1.0, -1.0}) {
      EXPECT_NEAR(wound.release({.along = sign * 0.05}), opened, 1e-3 * opened);
      EXPECT_NEAR(wound.release({.across = sign * 0.05}), opened, 1e-3 * opened);
    }
    Wound weak = of;
    weak.toughness = 0.9 * opened;
    EXPECT_TRUE(PulledWound(weak).under({.along = 0.05}).has_torn);
    EXPECT_TRUE(PulledWound(weak).under({.across = -0.05}).has_torn);
  }
}

TEST(PressedWound, sheared_while_it_is_pressed_releases_the_energy_of_the_shear) {
  // Particles fall asleep near the balance, so energies are within a hundredth.
  for (const Wound& of : wounds()) {
    PulledWound wound(of);
    const double opened = wound.release({.apart = 0.05}), sheared = wound.release({.along = 0.03});
    for (const double load : {0.05, 0.5}) {
      const double found = wound.release({.apart = -load, .along = 0.03});
      EXPECT_NEAR(found, sheared, 0.015 * sheared) << load;
    }
    EXPECT_NEAR(wound.release({.apart = 0.05, .along = 0.03}), opened + sheared,
                0.015 * (opened + sheared));
  }
}

TEST(PressedWound, of_a_gap_with_blunt_ends_releases_nothing) {
  for (const double range : {0.1, 0.05}) {
    PulledWound wound({.cells = 160, .range = range, .gap = 0.01});
    const double opened = wound.release({.apart = 0.05});
    EXPECT_GT(opened, 1e-3);
    EXPECT_LT(wound.release({.apart = -0.5}), 1e-4 * opened);
    const double sheared = wound.release({.along = 0.05});
    EXPECT_NEAR(sheared, opened, 1e-2 * opened);
    EXPECT_NEAR(wound.release({.apart = -0.5, .along = 0.05}), sheared, 1e-2 * sheared);
  }
}

/// A sheet whose bones stretch it across the slit, with a tension to which the pose adds.
double release_in_pose(double stretch, double tension) {
  SoftMaterial material;
  material.toughness = 1e6;
  test::SlitSheet sheet(80, kHalfLength, 0.1, material);
  EXPECT_TRUE(sheet.body->set_tension({tension, {}, true}));
  Affine3d map = Affine3d::Identity();
  ForceTearingReport report;
  for (const double part : {0.9, 1.0}) {
    map.linear() = Vec3d(1, 1 + part * stretch, 1).asDiagonal();
    const ModelPose pose = test::moved(sheet.pose, map);
    for (int i = 0; i < (part < 1 ? 60 : 5); ++i)
      EXPECT_TRUE(sheet.body->step(*sheet.model, pose, 0.1));
    const auto torn = tear_overstretched(*sheet.body, *sheet.set, *sheet.model, pose);
    EXPECT_TRUE(torn);
    report = *torn;
  }
  return report.greatest_release;
}

TEST(PressedWound, in_a_pose_that_compresses_the_tissue_releases_nothing) {
  const double stretched = release_in_pose(0.2, 0);
  EXPECT_GT(stretched, 1e-3);
  EXPECT_LT(release_in_pose(-0.2, 0), 1e-6 * stretched);
  EXPECT_LT(release_in_pose(-0.2, 0.5 * 0.2 * SoftMaterial().membrane_stiffness), 1e-6 * stretched);
}

/// The middle of a sheet, of which nothing may tear elsewhere, between two sides that are held.
ForceTearingReport between_held_sides(double apart, const Affine3d& map) {
  SoftMaterial firm, weak;
  firm.return_frequency = weak.return_frequency = test::frequency_of(0);
  weak.strength = 1.3;
  Character character = test::make_sheet(40);
  for (Vec3f& at : character.meshes[0].positions) at = Vec3d(map * at.cast<double>()).cast<float>();
  SoftScene scene(std::move(character), {firm, weak}, 0.06, {});
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    const double x = (map.inverse() * scene.body->place(p)).x();
    EXPECT_TRUE(scene.body->set_material(p, x > 0.4 && x < 0.6 ? 1 : 0));
    if (x > 0.15 && x < 0.85) continue;
    const Vec3d by = map.linear() * Vec3d(x < 0.5 ? -apart : apart, 0, 0);
    EXPECT_TRUE(scene.body->hold(p, scene.body->place(p) + by));
  }
  scene.run(1);
  const auto report = tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose);
  EXPECT_TRUE(report);
  return *report;
}

TEST(PressedTissue, does_not_begin_to_tear) {
  for (const Affine3d& map : {Affine3d::Identity(), turned()}) {
    const ForceTearingReport pulled = between_held_sides(0.3, map);
    EXPECT_TRUE(pulled.has_torn);
    EXPECT_GT(pulled.greatest_stretch, 1.5);
    // With 0.35 the two sides meet; beyond, they pass through one another.
    for (const double together : {0.1, 0.3, 0.5, 1.0, 5.0}) {
      const ForceTearingReport pressed = between_held_sides(-together, map);
      EXPECT_FALSE(pressed.has_torn) << together;
      EXPECT_LT(pressed.greatest_stretch, 1.2) << together;
    }
  }
}

}  // namespace
}  // namespace sunder
