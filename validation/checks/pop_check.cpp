#include "validation/checks/pop_check.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cstdio>

namespace sunder::validation {
namespace {

const PoseSpec* pose_of(const Operation& operation) {
  if (const auto* const tear = std::get_if<TearOperation>(&operation)) return &tear->pose;
  if (const auto* const cut = std::get_if<CutOperation>(&operation)) return &cut->pose;
  if (const auto* const drill = std::get_if<DrillOperation>(&operation)) return &drill->pose;
  return nullptr;
}

/// The largest error of the points that the newest operation made, in its pose.
FindingPlace pop_of_newest(const TornModel& model, const ModelPose& pose) {
  FindingPlace place;
  const auto errors = measure_weight_errors(model, model.undo_count() - 1, 1, {&pose, 1});
  if (!errors) return place;
  for (const auto& point : errors->points)
    if (point.maximum > place.value) {
      place.mesh = point.mesh;
      place.value = point.maximum;
    }
  return place;
}

}  // namespace

std::optional<TornModel> check_pops(const std::shared_ptr<const Character>& source,
                                    std::span<const Operation> operations, double diagonal,
                                    FindingList& findings) {
  if (operations.empty()) {
    findings.not_tested(Code::pop, "no operation log was given");
    return {};
  }
  Result<TornModel> model = TornModel::create(source);
  if (!model) {
    findings.not_tested(Code::pop, std::string(model.error().text()));
    return {};
  }
  Places pops;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const Result<TearReport> report = apply_operation(*model, operations[i]);
    if (!report) {
      findings.not_tested(
          Code::pop, "operation " + std::to_string(i) + ": " + std::string(report.error().text()));
      return {};
    }
    const PoseSpec* const spec = pose_of(operations[i]);
    if (spec == nullptr || report->runs == 0) continue;
    const Result<ModelPose> pose = make_pose(*source, *spec);
    if (pose) pops.push_back(pop_of_newest(*model, *pose));
  }
  const double least = kind_of(Code::pop).threshold * diagonal;
  std::erase_if(pops, [&](const FindingPlace& place) { return !(place.value > least); });
  findings.add(Code::pop, std::move(pops),
               "Over " + std::to_string(operations.size()) + " operations.", Evidence::exact);
  return std::move(*model);
}

}  // namespace sunder::validation
