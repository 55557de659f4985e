#include "bench/particles/particles_fields.h"

#include <sunder/particles/force_tearing.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "bench/harness/measure.h"
#include "support/models/rigs.h"
#include "support/oracles/membrane.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kFieldCells = 160, kOrders = 6;
constexpr double kFieldTension = 1.2, kHalf = 0.2;

struct FieldCase {
  const char* name;
  test::FactorsOfPlace factors;
  bool is_symmetric;  ///< In x - 0.5: both tips are alike.
};

double wave(double x) { return std::sin(2 * std::numbers::pi * x); }

std::vector<FieldCase> field_cases() {
  return {
      {"stiffness 0.5 to 2 across the slit",
       [](const Vec3d& at) {
         return test::FactorsAt{std::exp2(2 * at.y() - 1), 1, 1};
       },
       true},
      {"stiffness 0.5 to 2 along the slit",
       [](const Vec3d& at) {
         return test::FactorsAt{std::exp2(2 * at.x() - 1), 1, 1};
       },
       false},
      {"stiffness 2 to 0.5 from the middle",
       [](const Vec3d& at) {
         return test::FactorsAt{std::exp2(1 - 4 * std::abs(at.x() - 0.5)), 1, 1};
       },
       true},
      {"thickness 1 +- 0.5, waves of 0.5 m",
       [](const Vec3d& at) {
         return test::FactorsAt{1, 1, 1 + 0.5 * wave(2 * at.x() + 0.25) * wave(2 * at.y() + 0.25)};
       },
       true},
      {"tension 1 +- 0.5, waves of 0.4 m",
       [](const Vec3d& at) {
         return test::FactorsAt{1, 1 + 0.5 * wave(2.5 * (at.x() - 0.5) + 0.25), 1};
       },
       true},
      {"stiffness 1 and 3 beside the slit",
       [](const Vec3d& at) {
         return test::FactorsAt{at.y() > 0.6 ? 3.0 : 1.0, 1, 1};
       },
       true},
  };
}

/// The energy that a tip of the reference releases per length, by the energies of two slits.
double reference_release(const FieldCase& of) {
  constexpr double kMore = 2.0 / kFieldCells;
  const auto energy = [&](double half) {
    const test::SlitSheet sheet(kFieldCells, half, 0.2, {}, 1, 0, of.factors);
    const auto forces = test::lip_forces(*sheet.set, kFieldTension, of.factors);
    const auto moved = test::solve_membrane(*sheet.model, sheet.set->positions(),
                                            sheet.body->materials()[0], forces, of.factors);
    double work = 0;
    for (std::size_t p = 0; p < forces.size(); ++p) work += 0.5 * forces[p].dot(moved[p]);
    return work;
  };
  return (energy(kHalf + kMore) - energy(kHalf - kMore)) / (4 * kMore);  // of two tips
}

double release_of(test::SlitSheet& sheet) {
  // A little more keeps it awake.
  if (!sheet.body->set_tension({1.01 * kFieldTension, {}})) std::exit(1);
  for (int i = 0; i < 5; ++i)
    if (!sheet.body->step(*sheet.model, sheet.pose, 0.1)) std::exit(1);
  const auto report = tear_overstretched(*sheet.body, *sheet.set, *sheet.model, sheet.pose);
  if (!report) std::exit(1);
  return report->greatest_release / (1.01 * 1.01);
}

FieldFigures measure_field(const FieldCase& of, double range, double wanted_release) {
  FieldFigures figures{of.name, range};
  figures.has_load = of.is_symmetric;
  SoftMaterial material;
  material.toughness = 1e12;
  double squares = 0, releases = 0;
  for (std::uint32_t order = 0; order < kOrders; ++order) {
    test::SlitSheet sheet(kFieldCells, kHalf, range, material, 1, order, of.factors);
    sheet.open(kFieldTension);
    const test::GapProfile gap = gap_of(sheet), wanted = reference_gap(sheet, kFieldTension);
    figures.width += (gap.widest() / wanted.widest() - 1) / kOrders;
    squares += std::pow(rms_difference(gap, wanted), 2) / kOrders;
    if (of.is_symmetric) releases += release_of(sheet) / kOrders;
  }
  figures.rms = std::sqrt(squares);
  if (of.is_symmetric) figures.load = std::sqrt(wanted_release / releases) - 1;
  return figures;
}

/// The wavy line of a perforation, between two parts of it.
std::vector<Vec3d> wavy_line(double from, double to) {
  constexpr int kPlaces = 240;
  std::vector<Vec3d> line;
  for (int i = 0; i <= kPlaces; ++i) {
    const double x = from + (to - from) * i / kPlaces;
    line.emplace_back(x, 0.503 + 0.06 * wave(x), 0);
  }
  return line;
}

double length_of(const std::vector<Vec3d>& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

double distance_from(const std::vector<Vec3d>& line, const Vec3d& at) {
  double least = 1e30;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3d along = line[i] - line[i - 1];
    const double part = std::clamp((at - line[i - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (at - line[i - 1] - part * along).norm());
  }
  return least;
}

}  // namespace

PerforationFigures measure_perforation() {
  const auto character = std::make_shared<const Character>(test::make_sheet(100));
  const ModelPose pose = *bind_pose(*character);
  TornModel model = *TornModel::create(character);
  const std::vector<Vec3d> line = wavy_line(0.1, 0.9);
  AuthoredTissue tissue;
  Perforation& perforation = tissue.perforations.emplace_back();
  for (const Vec3d& at : line) perforation.line.push_back(test::place_on_sheet(*character, at));
  ParticleSet set = *ParticleSet::create(model, pose, {0.1, false}, tissue);
  SoftMaterial material;
  material.toughness = 0.1;  // the slit releases half of it
  SoftBody body = *SoftBody::create(set, pose, {&material, 1});
  Stroke stroke;
  for (const Vec3d& at : wavy_line(0.4, 0.6)) stroke.push_back(test::down_at(at.x(), at.y()));
  ChangeRecord change;
  if (!model.tear(pose, stroke, {}, &change) || !set.follow(model, {&change, 1})) std::exit(1);
  if (!body.set_tension({kFieldTension, {}})) std::exit(1);
  for (int i = 0; i < 300; ++i) {
    if (!body.step(model, pose, 1.0 / 30)) std::exit(1);
    if (i > 20 && !tear_overstretched(body, set, model, pose)) std::exit(1);
  }
  PerforationFigures figures;
  double lips = 0;
  for (const LipEdge& lip : set.lips()) {
    const Vec3d a = set.positions()[lip.points[0]].cast<double>(),
                b = set.positions()[lip.points[1]].cast<double>();
    for (const Vec3d& at : {a, b})
      figures.follow = std::max(figures.follow, distance_from(line, at));
    lips += 0.5 * (b - a).norm();
  }
  figures.length = lips / length_of(line);
  return figures;
}

double measure_self_contact_ratio() {
  const auto character = std::make_shared<const Character>(test::make_sheet(100));
  const ModelPose pose = *bind_pose(*character);
  TornModel model = *TornModel::create(character);
  ParticleSet set = *ParticleSet::create(model, pose, {0.05, false});
  const SoftMaterial material;
  SoftBodyOptions touching;
  touching.self_contact = {0.005, 0.3};
  SoftBody plain = *SoftBody::create(set, pose, {&material, 1});
  SoftBody pressed = *SoftBody::create(set, pose, {&material, 1}, touching);
  const Stroke stroke = {test::down_at(0.3, 0.503), test::down_at(0.7, 0.503)};
  ChangeRecord change;
  if (!model.tear(pose, stroke, {}, &change) || !set.follow(model, {&change, 1})) std::exit(1);
  while (set.settle(model, 100000)) continue;
  std::array<std::vector<double>, 2> seconds;
  for (int i = 0; i < 200; ++i)
    for (SoftBody* body : {&plain, &pressed}) {
      if (!body->step(model, pose, 0)) std::exit(1);
      for (std::uint32_t p = 0; p < set.particle_count(); ++p) {
        const double to = set.positions()[set.seed(p)].y() > 0.503f ? -1 : 1;
        // A changing force keeps all awake.
        if (!body->set_force(p, Vec3d(0, (6 + 0.1 * (i % 2)) * to * set.area(p), 0))) std::exit(1);
      }
      seconds[body == &plain ? 0 : 1].push_back(
          seconds_of([&] { (void)body->step(model, pose, 1.0 / 60); }));
    }
  return median(seconds[1]) / median(seconds[0]);
}

std::vector<FieldFigures> measure_fields() {
  std::vector<FieldFigures> figures;
  for (const FieldCase& of : field_cases()) {
    const double release = of.is_symmetric ? reference_release(of) : 0.0;
    for (const double range : {0.2, 0.1, 0.05})
      figures.push_back(measure_field(of, range, release));
  }
  return figures;
}

}  // namespace sunder::bench
