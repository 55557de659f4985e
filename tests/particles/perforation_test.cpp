#include <sunder/particles/force_tearing.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "particles/rupture/perforations.h"
#include "particles/soft_scene.h"
#include "support/models/rigs.h"
#include "support/oracles/membrane.h"

namespace sunder {
namespace {

constexpr double kPerforatedTension = 1.2;

/// A sheet with a line of holes, given as positions, and a slit in it.
struct PerforatedSheet {
  std::shared_ptr<const Character> character;
  TornModel model;
  ModelPose pose;
  std::vector<Vec3d> line;
  ParticleSet set;
  SoftBody body;

  PerforatedSheet(const std::vector<Vec3d>& places, double strength, const SoftMaterial& material)
      : character(std::make_shared<const Character>(test::make_sheet(60))),
        model(*TornModel::create(character)),
        pose(*bind_pose(*character)),
        line(places),
        set(*ParticleSet::create(model, pose, {0.1, false}, tissue(strength))),
        body(*SoftBody::create(set, pose, {&material, 1})) {
    EXPECT_TRUE(body.set_tension({kPerforatedTension, {}}));
  }

  AuthoredTissue tissue(double strength) const {
    AuthoredTissue made;
    if (line.empty()) return made;
    made.perforations.push_back({{}, strength});
    for (const Vec3d& at : line)
      made.perforations[0].line.push_back(test::place_on_sheet(*character, at));
    return made;
  }
  void slit(double x, double y, double half) { slit({{x - half, y, 0}, {x + half, y, 0}}); }
  void slit(const std::vector<Vec3d>& places) {
    Stroke stroke;
    for (const Vec3d& at : places) stroke.push_back(test::down_at(at.x(), at.y()));
    ChangeRecord change;
    ASSERT_TRUE(model.tear(pose, stroke, {}, &change));
    ASSERT_TRUE(set.follow(model, {&change, 1}));
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(body.step(model, pose, 1.0 / 30));
  }
  /// @return the number of tears.
  int run(int frames, const ForceTearingOptions& options = {}) {
    int tears = 0;
    for (int i = 0; i < frames; ++i) {
      EXPECT_TRUE(body.step(model, pose, 1.0 / 30));
      const auto report = tear_overstretched(body, set, model, pose, options);
      EXPECT_TRUE(report) << report.error().text();
      if (report && report->has_torn) ++tears;
    }
    return tears;
  }
  [[nodiscard]] double distance_from_line(const Vec3d& at) const {
    double least = 1e30;
    for (std::size_t i = 1; i < line.size(); ++i) {
      const Vec3d along = line[i] - line[i - 1];
      const double part = std::clamp((at - line[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (at - line[i - 1] - part * along).norm());
    }
    return least;
  }
  /// The greatest distance from the line, of lips beside it that are at least `from` from a place.
  [[nodiscard]] double farthest_lip(const Vec3d& place, double from) const {
    double most = 0;
    for (const LipEdge& lip : set.lips())
      for (const Index point : lip.points) {
        const Vec3d at = set.positions()[point].cast<double>();
        if ((at - place).norm() > from && std::abs(at.x() - 0.5) < 0.4)
          most = std::max(most, distance_from_line(at));
      }
    return most;
  }
  [[nodiscard]] double length() const {
    double sum = 0;
    for (const LipEdge& lip : set.lips())
      sum += 0.5 * (set.positions()[lip.points[1]] - set.positions()[lip.points[0]]).norm();
    return sum;
  }
};

SoftMaterial tough_tissue(double toughness) {
  SoftMaterial material;
  material.toughness = toughness;
  return material;
}

std::vector<Vec3d> bent_line() {
  std::vector<Vec3d> line;
  for (int i = 0; i <= 80; ++i) {
    const double x = 0.1 + 0.8 * i / 80;
    line.emplace_back(x, 0.503 + 0.05 * std::sin(2 * std::numbers::pi * (x - 0.5)), 0);
  }
  return line;
}

TEST(perforation, the_energy_after_a_turn_falls_to_nothing) {
  EXPECT_EQ(particles::release_after_turn(0), 1);
  double before = 1;
  for (int i = 1; i < 32; ++i) {
    const double now = particles::release_after_turn(std::numbers::pi * i / 32);
    EXPECT_LT(now, before);
    before = now;
  }
  // Sih 1965: K(angle) = K ((1 - m) / (1 + m))^(m / 2), m = angle / pi, whose square this is.
  EXPECT_NEAR(particles::release_after_turn(std::numbers::pi / 2), std::pow(1.0 / 3, 0.5), 1e-12);
  EXPECT_EQ(particles::release_after_turn(std::numbers::pi), 0);
}

TEST(perforation, tears_run_along_it_and_not_without_it) {
  // The slit of 0.2 m releases half of the toughness.
  PerforatedSheet plain({}, 1, tough_tissue(0.1)), perforated(bent_line(), 0.3, tough_tissue(0.1));
  const std::vector<Vec3d> line = bent_line();
  for (PerforatedSheet* sheet : {&plain, &perforated})
    sheet->slit({line.begin() + 30, line.begin() + 51});
  EXPECT_EQ(plain.run(60), 0);
  EXPECT_GT(perforated.run(200), 5);
  EXPECT_GT(perforated.length(), 0.75);
  EXPECT_LT(perforated.farthest_lip(Vec3d::Zero(), 0), 1e-4);
}

TEST(perforation, a_tip_beside_it_joins_it) {
  PerforatedSheet sheet(bent_line(), 0.1, tough_tissue(0.045));
  sheet.slit(0.5, 0.515, 0.1);
  EXPECT_GT(sheet.run(200), 5);
  // The right tip is 0.017 m beside the line, the left one 0.041 m, which is too far.
  EXPECT_LT(sheet.farthest_lip({0.2, 0.503, 0}, 0.45), 1e-4);
  EXPECT_GT(sheet.farthest_lip({0.8, 0.503, 0}, 0.45), 0.02);
}

TEST(perforation, a_line_as_strong_as_the_tissue_changes_nothing) {
  PerforatedSheet plain({}, 1, tough_tissue(0.03)), perforated(bent_line(), 1, tough_tissue(0.03));
  for (PerforatedSheet* sheet : {&plain, &perforated}) {
    sheet->slit(0.5, 0.503, 0.1);
    sheet->run(10);
  }
  EXPECT_GT(plain.length(), 0.25);
  EXPECT_EQ(plain.model.digest(), perforated.model.digest());
}

TEST(perforation, a_tear_does_not_turn_back_to_a_line_behind_it) {
  // The line crosses the slit at a right angle in its middle.
  PerforatedSheet sheet({{0.5, 0.1, 0}, {0.5, 0.9, 0}}, 0.3, tough_tissue(0.1));
  sheet.slit(0.5, 0.503, 0.1);
  EXPECT_EQ(sheet.run(30), 0);
}

TEST(perforation, tissue_tears_along_it_where_it_is_pulled_across) {
  SoftMaterial material = tough_tissue(10);
  material.strength = 1.5;
  const std::vector<Vec3d> line = {{0.1, 0.452, 0}, {0.9, 0.452, 0}};
  PerforatedSheet plain({}, 1, material), perforated(line, 0.3, material);
  for (PerforatedSheet* sheet : {&plain, &perforated}) {
    for (Index p = 0; p < sheet->set.particle_count(); ++p) {
      const double y = sheet->set.positions()[sheet->set.seed(p)].y() - 0.452;
      ASSERT_TRUE(sheet->body.set_force(p, Vec3d(0, y > 0 ? 0.09 : -0.09, 0)));
    }
  }
  const int of_plain = plain.run(20), of_perforated = perforated.run(20);
  EXPECT_EQ(of_plain, 0);
  EXPECT_GT(of_perforated, 0);
  EXPECT_LT(perforated.farthest_lip(Vec3d::Zero(), 0), 1e-4);
}

TEST(perforation, of_a_closed_line_a_piece_comes_off) {
  std::vector<Vec3d> ring;
  for (int i = 0; i < 48; ++i) {
    const double angle = 2 * std::numbers::pi * i / 48;
    ring.emplace_back(0.5 + 0.22 * std::sin(angle), 0.503 + 0.22 * std::cos(angle), 0);
  }
  ring.push_back(ring.front());
  PerforatedSheet sheet(ring, 0.05, tough_tissue(0.1));
  sheet.slit({ring.begin(), ring.begin() + 5});
  sheet.run(300);
  EXPECT_LT(sheet.farthest_lip({0.5, 0.723, 0}, 0.1), 1e-3);
  EXPECT_GT(sheet.length(), 0.8 * 2 * std::numbers::pi * 0.22);
}

}  // namespace
}  // namespace sunder
