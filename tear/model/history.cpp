#include "tear/model/history.h"

#include <algorithm>
#include <atomic>
#include <iterator>

namespace sunder::tear {
namespace {

/// Number of blades for which the next entry has memory, and for which each entry has.
constexpr std::size_t kBlades = 64, kFewBlades = 16;

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
    tear.stroke.reserve(kFewBlades);
  }
  blades_.reserve(kBlades);
}

void History::give_long_stroke(Entry& entry) {
  auto* const tear = std::get_if<TearOperation>(&entry.operation);
  if (limit_ == kUnlimited || tear == nullptr || tear->stroke.capacity() >= kBlades) return;
  blades_.reserve(kBlades);
  tear->stroke.swap(blades_);
}

/// Leaves a short stroke in memory of its size, and keeps the other for the next entry.
void History::take_long_stroke(Entry& entry) {
  auto* const tear = std::get_if<TearOperation>(&entry.operation);
  if (limit_ == kUnlimited || tear == nullptr || tear->stroke.size() > blades_.capacity() ||
      blades_.capacity() >= kBlades)
    return;
  blades_ = tear->stroke;
  tear->stroke.swap(blades_);
}

History::Entry& History::next() {
  if (spare_.empty()) spare_.push_back(std::make_unique<Entry>());
  // Memory is reserved here, so that push() does not fail after the operation.
  if (done_.size() == done_.capacity()) done_.reserve(2 * done_.size() + 8);
  if (spare_.size() + undone_.size() > spare_.capacity())
    spare_.reserve(2 * (spare_.size() + undone_.size()));
  give_long_stroke(*spare_.back());
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
  take_long_stroke(entry);
  entry.serial = ++newest_serial;
  entry.redo.end.reset();  // that of an operation that was here before
  entry.lips = append(borders.lips, next_lips(), borders_.lips);
  entry.rim_points = append(borders.rim_points, next_rim_points(), borders_.rim_points);
  done_.push_back(std::move(spare_.back()));
  spare_.pop_back();
  forget_undone();
}

void History::forget_undone() noexcept {
  while (!undone_.empty()) {
    SurfaceEditor::Redo& redo = undone_.back()->redo;
    redo.clear();
    if (!redo.tails.meshes.empty())
      spare_redos_.push_back(std::exchange(redo, SurfaceEditor::Redo{}));
    move_last(undone_, spare_);
  }
}

void History::adopt_undone(History& from) {
  Entry& entry = *from.undone_.back();
  const auto lips = from.lips_of(entry);
  const auto rim_points = from.rim_points_of(entry);
  borders_.lips.reserve(borders_.lips.size() + lips.size());
  borders_.rim_points.reserve(borders_.rim_points.size() + rim_points.size());
  undone_.reserve(undone_.size() + 1);
  spare_.reserve(spare_.size() + undone_.size() + 1);
  spare_redos_.reserve(spare_redos_.size() + undone_.size() + 1);
  if (done_.size() == done_.capacity()) done_.reserve(2 * done_.size() + 8);
  entry.lips.first = next_lips().first;
  entry.rim_points.first = next_rim_points().first;
  borders_.lips.insert(borders_.lips.begin() + entry.lips.first, lips.begin(), lips.end());
  borders_.rim_points.insert(borders_.rim_points.begin() + entry.rim_points.first,
                             rim_points.begin(), rim_points.end());
  for (const auto& older : undone_) {
    older->lips.first += entry.lips.count;
    older->rim_points.first += entry.rim_points.count;
  }
  move_last(from.undone_, undone_);
}

void History::give_back(History& to) noexcept {
  move_last(undone_, to.undone_);
  Entry& entry = *to.undone_.back();
  const auto erase = [](auto& all, const IndexRange& range) {
    all.erase(all.begin() + range.first, all.begin() + range.first + range.count);
  };
  erase(borders_.lips, entry.lips);
  erase(borders_.rim_points, entry.rim_points);
  for (const auto& older : undone_) {
    older->lips.first -= entry.lips.count;
    older->rim_points.first -= entry.rim_points.count;
  }
  entry.lips.first = to.next_lips().first;
  entry.rim_points.first = to.next_rim_points().first;
}

void History::shrink() noexcept {
  spare_ = Entries();
  spare_redos_ = {};
  // Memory that cannot be returned is kept: shrink_to_fit() does not fail.
  done_.shrink_to_fit();
  undone_.shrink_to_fit();
  borders_.lips.shrink_to_fit();
  borders_.rim_points.shrink_to_fit();
}

void History::make_room_for(const History& to_adopt) {
  done_.reserve(to_adopt.done_.size());
  undone_.reserve(to_adopt.undone_.size());
  make_room_to_hold(to_adopt.borders_.lips.size(), borders_.lips);
  make_room_to_hold(to_adopt.borders_.rim_points.size(), borders_.rim_points);
}

void History::adopt(History& from) noexcept {
  const std::size_t count = from.done_.size() + from.undone_.size();
  spare_.resize(spare_.size() - std::min(count, spare_.size()));
  std::move(from.done_.begin(), from.done_.end(), std::back_inserter(done_));
  std::move(from.undone_.begin(), from.undone_.end(), std::back_inserter(undone_));
  borders_.lips.assign(from.borders_.lips.begin(), from.borders_.lips.end());
  borders_.rim_points.assign(from.borders_.rim_points.begin(), from.borders_.rim_points.end());
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
