#include "scene/instance_replay.h"

#include "scene/instance_state.h"

namespace sunder::scene {

Status InstanceReplay::begin() {
  state_.needs_draw = true;
  if (Status status = state_.make_torn(false); !status) return status;
  return state_.prepare_model();
}

Status InstanceReplay::apply(const Operation& operation) {
  const Result<TearReport> report = apply_operation(state_.torn->model, operation);
  return report ? Status() : report.error();
}

Status InstanceReplay::undo() { return state_.torn->model.undo(); }

Status InstanceReplay::draw() {
  if (state_.pose.model_from_bone.empty()) return {};
  state_.needs_draw = true;
  Status status = state_.draw({});
  state_.needs_draw = true;
  return status;
}

}  // namespace sunder::scene
