#include "support/models/random_operations.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

CutOperation random_cut(const TornModel& model, Random& random) {
  const Character& source = model.source();
  CutOperation operation;
  const ModelPose pose = random_pose(source, random);
  operation.pose = pose;
  const auto positions = posed_positions(source, 0, pose);
  operation.cut.point = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
  operation.cut.normal = random.direction();
  operation.cut.normal *= random.uniform(0.1, 3);
  operation.cut.caps = random.index(2) == 0;
  if (random.index(2) == 0) {
    const Vec3d right = operation.cut.normal.unitOrthogonal(),
                up = operation.cut.normal.normalized().cross(right);
    const double radius = random.uniform(0.1, 0.5) * posed_diagonal(source, pose);
    for (const double angle : {0.0, 1.3, 2.9, 4.4})
      operation.cut.bounds.push_back(operation.cut.point +
                                     radius * (std::cos(angle) * right + std::sin(angle) * up));
  }
  return operation;
}

DrillOperation random_drill(const TornModel& model, Random& random) {
  const Character& source = model.source();
  DrillOperation operation;
  const ModelPose pose = random_pose(source, random);
  operation.pose = pose;
  const Blade along = random_stroke(source, pose, random, 0.1, 1)[0];
  operation.bore.origin = along.base;
  operation.bore.direction = random.uniform(0.1, 3) * (along.tip - along.base);
  operation.bore.depth = random.uniform(0.8, 4) * (along.tip - along.base).norm();
  operation.bore.radius = random.uniform(0.005, 0.1) * posed_diagonal(source, pose);
  operation.bore.wall = random.index(2) == 0;
  return operation;
}

}  // namespace

Character random_character(Random& random) {
  if (random.index(2) == 0) return make_sheet(2 + random.index(10));
  const std::uint32_t rings = 3 + random.index(10),
                      sides = 5 + random.index(10);  // evaluated in this order by every compiler
  return make_tube(rings, sides, 2 + random.index(4));
}

TearOperation random_tear(const TornModel& model, Random& random, bool has_width) {
  const Character& source = model.source();
  TearOperation operation;
  const ModelPose pose = random_pose(source, random);
  operation.pose = pose;
  const double length = random.uniform(0.02, 0.5);
  operation.stroke = random_stroke(source, pose, random, length, 1 + random.index(6));
  if (!has_width) return operation;
  operation.options.width = random.uniform(0.002, 0.05) * posed_diagonal(source, pose);
  if (random.index(3) == 0)
    operation.options.wall_depth = random.uniform(0.002, 0.02) * posed_diagonal(source, pose);
  if (random.index(3) == 0) operation.options.layers = Layers::all;
  return operation;
}

Operation random_operation(const TornModel& model, Random& random) {
  switch (random.index(4)) {
    case 0: return random_cut(model, random);
    case 1: return random_drill(model, random);
    case 2: return random_tear(model, random, true);
    default: return random_tear(model, random, false);
  }
}

Operation random_lossless_operation(const TornModel& model, Random& random, bool has_fillings) {
  if (random.index(3) > 0) {
    TearOperation tear = random_tear(model, random, false);
    if (has_fillings && random.index(2) == 0)
      tear.options.wall_depth = random.uniform(0.002, 0.05) *
                                posed_diagonal(model.source(), std::get<ModelPose>(tear.pose));
    return tear;
  }
  CutOperation cut = random_cut(model, random);
  cut.cut.caps = has_fillings && random.index(2) == 0;
  return cut;
}

WeldOperation random_weld(const TornModel& model, Random& random) {
  const Character& source = model.source();
  WeldOperation operation;
  const ModelPose pose = random_pose(source, random);
  operation.pose = pose;
  if (random.index(2) == 0) return operation;
  const auto positions = posed_positions(source, 0, pose);
  operation.weld.places = {positions[random.index(static_cast<std::uint32_t>(positions.size()))]};
  if (random.index(3) > 0)
    operation.weld.reach = random.uniform(0.01, 0.3) * posed_diagonal(source, pose);
  return operation;
}

SutureOperation random_suture(const TornModel& model, Random& random) {
  const WeldOperation like = random_weld(model, random);
  const double diagonal = posed_diagonal(model.source(), std::get<ModelPose>(like.pose));
  SutureOperation operation{like.pose, {like.weld.places, like.weld.reach}};
  operation.suture.spacing = random.uniform(0.005, 0.1) * diagonal;
  operation.suture.stiffness = std::pow(10, random.uniform(-3, 6));
  if (random.index(2) == 0) operation.suture.tension = std::pow(10, random.uniform(-3, 3));
  if (random.index(2) == 0) operation.suture.strength = std::pow(10, random.uniform(-4, 3));
  return operation;
}

Stroke turning_stroke(Random& random) {
  Stroke stroke;
  double x = 0.15, y = 0.5, heading = random.uniform(-0.3, 0.3);
  for (int k = 0; k < 8; ++k) {
    stroke.push_back(down_at(x, y));
    x += 0.09 * std::cos(heading);
    y += 0.09 * std::sin(heading);
    // Back to the middle before it leaves the sheet.
    heading =
        std::clamp(heading + random.uniform(y < 0.3 ? 0.0 : -1.5, y > 0.7 ? 0.0 : 1.5), -1.2, 1.2);
  }
  return stroke;
}

Result<TearReport> play(TornModel& model, const Operation& operation, ChangeRecord* change) {
  if (const auto* tear = std::get_if<TearOperation>(&operation))
    return model.tear(std::get<ModelPose>(tear->pose), tear->stroke, tear->options, change);
  if (const auto* cut = std::get_if<CutOperation>(&operation))
    return model.cut(std::get<ModelPose>(cut->pose), cut->cut, change);
  if (const auto* drill = std::get_if<DrillOperation>(&operation))
    return model.drill(std::get<ModelPose>(drill->pose), drill->bore, change);
  if (const auto* weld = std::get_if<WeldOperation>(&operation))
    return model.weld(std::get<ModelPose>(weld->pose), weld->weld, change);
  if (const auto* sewn = std::get_if<SutureOperation>(&operation))
    return suture(model, std::get<ModelPose>(sewn->pose), sewn->suture, change);
  std::abort();
}

}  // namespace sunder::test
