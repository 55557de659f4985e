#include "tear/model/instance.h"

namespace sunder {

TornModel::Instance::~Instance() {
  if (State* const workspace = resident()) parts().give_back(std::unique_ptr<State>(workspace));
}

TornModel::State& TornModel::Instance::unpacked() {
  if (State* const known = resident()) return *known;
  const std::lock_guard lock(unpacking_);
  if (State* const known = resident()) return *known;
  return take_workspace();
}

TornModel::State* TornModel::Instance::torn() {
  if (State* const known = resident()) return known;
  const std::lock_guard lock(unpacking_);
  if (State* const known = resident()) return known;
  return packed_ == nullptr ? nullptr : &take_workspace();
}

TornModel::State& TornModel::Instance::take_workspace() {
  std::unique_ptr<State> workspace = parts().take(capacity);
  if (packed_ != nullptr) workspace->unpack(*packed_);
  packed_.reset();
  workspace->weights = weights;
  workspace_.store(workspace.get(), std::memory_order_release);
  return *workspace.release();
}

void TornModel::Instance::pack() {
  State* const workspace = resident();
  if (workspace == nullptr || parts().is_private) return;
  if (!workspace->history.is_empty()) packed_ = workspace->pack();
  weights = workspace->weights;
  workspace_.store(nullptr, std::memory_order_release);
  parts().give_back(std::unique_ptr<State>(workspace));
}

TornModel::State* TornModel::StatePointer::get() const noexcept { return &instance->unpacked(); }

Status TornModel::pack() {
  const State* const workspace = state_.instance->resident();
  if (workspace != nullptr && workspace->has_stroke) return workspace->may_begin();
  try {
    state_.instance->pack();
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status TornModel::unpack() const {
  try {
    (void)state_.instance->unpacked();
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

bool TornModel::is_packed() const { return state_.instance->resident() == nullptr; }

}  // namespace sunder
