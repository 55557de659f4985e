#include "tear/history.h"

#include <atomic>

namespace sunder::tear {
namespace {

/// Number of blades per stroke for which a new entry has memory.
constexpr std::size_t kBlades = 64;

}  // namespace

void History::limit_to(std::size_t operations, std::size_t lips, const ModelPose& pose) {
  limit_ = operations;
  borders_.lips.reserve(lips);
  done_.reserve(operations);
  undone_.reserve(operations);
  spare_.reserve(operations + 1);
  while (spare_.size() < operations + 1) {
    spare_.push_back(std::make_unique<Entry>());
    auto& tear = spare_.back()->as<TearOperation>();
    assign_pose(pose, tear.pose);
    tear.stroke.reserve(kBlades);
  }
}

History::Entry& History::next() {
  if (spare_.empty()) spare_.push_back(std::make_unique<Entry>());
  // Memory is reserved here, so that push() does not fail after the operation.
  if (done_.size() == done_.capacity()) done_.reserve(2 * done_.size() + 8);
  if (spare_.size() + undone_.size() > spare_.capacity())
    spare_.reserve(2 * (spare_.size() + undone_.size()));
  if (spare_redos_.capacity() - spare_redos_.size() < undone_.size())
    spare_redos_.reserve(2 * (spare_redos_.size() + undone_.size()));
  return *spare_.back();
}

void History::Entry::add_pose_change(std::uint32_t blade, const ModelPose& pose) {
  auto& changes = std::get<TearOperation>(operation).pose_changes;
  // Memory is reserved here, so that dropping the changes does not fail.
  make_room_to_hold(spare_pose_changes.size() + changes.size() + 1, spare_pose_changes);
  TearOperation::PoseChange change;
  if (!spare_pose_changes.empty()) {
    change = std::move(spare_pose_changes.back());
    spare_pose_changes.pop_back();
  }
  change.blade = blade;
  assign_pose(pose, change.pose);
  changes.push_back(std::move(change));
}

void History::Entry::drop_pose_changes(std::size_t count) noexcept {
  auto* const tear = std::get_if<TearOperation>(&operation);
  if (tear == nullptr) return;
  for (; tear->pose_changes.size() > count; tear->pose_changes.pop_back())
    if (spare_pose_changes.size() < spare_pose_changes.capacity())
      spare_pose_changes.push_back(std::move(tear->pose_changes.back()));
}

IndexRange History::next_lips() const {
  return done_.empty() ? IndexRange{}
                       : IndexRange{done_.back()->lips.first + done_.back()->lips.count, 0};
}

IndexRange History::next_rim_points() const {
  return done_.empty()
             ? IndexRange{}
             : IndexRange{done_.back()->rim_points.first + done_.back()->rim_points.count, 0};
}

void History::make_room_for(std::size_t lips, std::size_t rim_points) {
  make_room_to_hold(next_lips().first + lips, borders_.lips);
  make_room_to_hold(next_rim_points().first + rim_points, borders_.rim_points);
}

void History::push(const OpenedBorders& borders) {
  static std::atomic<std::uint64_t> newest_serial = 0;
  const auto append = [](const auto& values, IndexRange range, auto& all) {
    all.resize(range.first);
    all.insert(all.end(), values.begin(), values.end());
    range.count = static_cast<Index>(values.size());
    return range;
  };
  Entry& entry = *spare_.back();
  entry.serial = ++newest_serial;
  entry.redo.end.reset();  // that of an operation that was here before
  entry.lips = append(borders.lips, next_lips(), borders_.lips);
  entry.rim_points = append(borders.rim_points, next_rim_points(), borders_.rim_points);
  done_.push_back(std::move(spare_.back()));
  spare_.pop_back();
  while (!undone_.empty()) {
    SurfaceEditor::Redo& redo = undone_.back()->redo;
    redo.clear();
    if (!redo.tails.meshes.empty())
      spare_redos_.push_back(std::exchange(redo, SurfaceEditor::Redo{}));
    move_last(undone_, spare_);
  }
}

void History::move_last(Entries& from, Entries& to) {
  to.push_back(std::move(from.back()));
  from.pop_back();
}

void assign_pose(const ModelPose& pose, PoseSpec& spec) {
  if (auto* held = std::get_if<ModelPose>(&spec))
    *held = pose;
  else
    spec = pose;
}

}  // namespace sunder::tear
