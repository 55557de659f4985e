#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <memory>

#include "bench/cut_share/cut_sides.h"
#include "support/models/cut_bodies.h"

namespace sunder::bench {
namespace {

std::optional<CutSides> cut_one(const test::HardCut& hard) {
  auto model = TornModel::create(std::make_shared<const Character>(test::character_of(hard.body)));
  if (!model) return std::nullopt;
  PlaneCut cut;
  cut.point = hard.point;
  cut.normal = hard.normal;
  cut.caps = true;
  if (!model->cut(*bind_pose(model->source()), cut)) return std::nullopt;
  return test::sides_of(*model, hard.point, hard.normal);
}

}  // namespace

CutSidesOfAll cut_by_sunder(const std::vector<test::HardCut>& cuts) {
  CutSidesOfAll sides;
  for (const test::HardCut& cut : cuts) sides.push_back(cut_one(cut));
  return sides;
}

}  // namespace sunder::bench
