#include "tear/history.h"

#include <atomic>

namespace sunder::tear {
namespace {

/// Blades of one stroke that an entry has memory for from the start.
constexpr std::size_t kBlades = 64;

}  // namespace

void History::limit_to(std::size_t operations, const ModelPose& pose) {
  limit_ = operations;
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
  // So that push() does not fail once the operation is done.
  if (done_.size() == done_.capacity()) done_.reserve(2 * done_.size() + 8);
  if (spare_.size() + undone_.size() > spare_.capacity()) spare_.reserve(2 * (spare_.size() + undone_.size()));
  return *spare_.back();
}

void History::push() {
  static std::atomic<std::uint64_t> newest_serial = 0;
  spare_.back()->serial = ++newest_serial;
  done_.push_back(std::move(spare_.back()));
  spare_.pop_back();
  while (!undone_.empty()) move_last(undone_, spare_);
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
