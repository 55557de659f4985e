// The memory of models, TornModel::memory_bytes().

#include "tear/model/instance.h"
#include "tear/surface/memory_use.h"

namespace sunder {
namespace tear {
namespace {

void add(const PoseSpec& pose, MemoryUse& use) {
  if (const auto* held = std::get_if<ModelPose>(&pose)) {
    use.add(held->model_from_bone);
    use.add(held->morph_weights);
  }
}

void add(const Operation& operation, MemoryUse& use) {
  if (const auto* tear = std::get_if<TearOperation>(&operation)) {
    add(tear->pose, use);
    use.add(tear->stroke);
    use.add(tear->pose_changes);
    for (const auto& change : tear->pose_changes) add(change.pose, use);
  }
  if (const auto* cut = std::get_if<CutOperation>(&operation)) add(cut->pose, use);
  if (const auto* drill = std::get_if<DrillOperation>(&operation)) add(drill->pose, use);
  if (const auto* weld = std::get_if<WeldOperation>(&operation)) {
    add(weld->pose, use);
    use.add(weld->weld.places);
  }
  if (const auto* suture = std::get_if<SutureOperation>(&operation)) {
    add(suture->pose, use);
    use.add(suture->suture.places);
  }
}

}  // namespace

void SurfaceEditor::Redo::add_to(MemoryUse& use) const {
  use.add(tails.edit);
  use.add(tails.meshes);
  for (const Mesh& mesh : tails.meshes) use.add(mesh);
  use.add(changed);
  use.add(known_corners);
  use.add(sides);
}

void History::add_to(MemoryUse& use) const {
  const auto add_entry = [&](const Entry& entry) {
    use.add(sizeof(Entry), sizeof(Entry));
    add(entry.operation, use);
    entry.redo.add_to(use);
    for (const auto* vertices : {&entry.weights.vertices, &entry.weights.spare_vertices})
      use.add(*vertices);
    for (const auto* influences : {&entry.weights.influences, &entry.weights.spare_influences})
      use.add(*influences);
  };
  for (const auto* entries : {&done_, &undone_}) {
    use.add(*entries);
    for (const auto& entry : *entries) add_entry(*entry);
  }
  MemoryUse spare;
  std::swap(spare, use);
  for (const auto& entry : spare_) add_entry(*entry);
  for (const SurfaceEditor::Redo& redo : spare_redos_) redo.add_to(use);
  std::swap(spare, use);
  use.add(0, spare.held() + spare_.capacity() * sizeof(spare_[0]));
  use.add(borders_.lips);
  use.add(borders_.rim_points);
}

void SurfaceEditor::add_to(MemoryUse& use) const {
  use.add(columns_);
  use.add(0, scratch_.bytes());
}

}  // namespace tear

tear::MemoryUse TornModel::State::memory_use() const {
  tear::MemoryUse use;
  use.add(sizeof(State), sizeof(State));
  use.add(character);
  editor.add_to(use);
  use.add(0, posed.bytes());
  history.add_to(use);
  for (const auto* borders : {&borders_.of_call, &borders_.of_operation}) {
    use.add(borders->lips);
    use.add(borders->rim_points);
  }
  return use;
}

TornMemory TornModel::memory_bytes() const {
  const Instance& instance = *state_.instance;
  tear::MemoryUse use;
  use.add(sizeof(TornModel) + sizeof(Instance), sizeof(TornModel) + sizeof(Instance));
  instance.read([&](const State* workspace, const tear::PackedOperations* packed) {
    if (workspace != nullptr) use.add(workspace->memory_use());
    if (packed == nullptr) return;
    use.add(sizeof(tear::PackedOperations), sizeof(tear::PackedOperations));
    packed->change.add_to(use);
    packed->history.add_to(use);
  });
  return {instance.asset->memory_bytes().shared, use.used(), use.held() - use.used()};
}

}  // namespace sunder
