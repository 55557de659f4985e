#pragma once

#include <sunder/core/operation.h>

#include <memory>
#include <vector>

#include "tear/surface_editor.h"

namespace sunder::tear {

/// The operations that were done and those that were taken back. What is dropped keeps its memory for the next.
class History {
 public:
  struct Entry {
    Operation operation;
    SurfaceEditor::Mark begin;
    SurfaceEditor::Redo redo;             ///< Of one that was taken back.
    SurfaceEditor::WeightChange weights;  ///< Of a WeightsOperation: what takes it back, or does it again.
    std::uint64_t serial = 0;             ///< That no other entry has, of any model; given by push().

    /// The operation as one of this kind, to be filled in.
    template <class Kind>
    Kind& as() {
      if (!std::holds_alternative<Kind>(operation)) operation = Kind{};
      return std::get<Kind>(operation);
    }
  };

  /// Has memory for so many operations and takes no more. @param pose  like all that come.
  void limit_to(std::size_t operations, const ModelPose& pose);
  [[nodiscard]] bool has_room() const { return limit_ == kUnlimited || done_.size() < limit_; }

  /// An entry that is none yet, to be filled in.
  [[nodiscard]] Entry& next();
  /// Makes next() the newest, and forgets what was taken back.
  void push();

  [[nodiscard]] const std::vector<std::unique_ptr<Entry>>& done() const { return done_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Entry>>& undone() const { return undone_; }
  void make_room_to_undo() {
    if (undone_.size() == undone_.capacity()) undone_.reserve(2 * undone_.size() + 8);
  }
  /// Moves the newest from one side to the other.
  void move_to_undone() { move_last(done_, undone_); }
  void move_to_done() { move_last(undone_, done_); }

 private:
  using Entries = std::vector<std::unique_ptr<Entry>>;
  static void move_last(Entries& from, Entries& to);

  Entries done_, undone_, spare_;
  static constexpr std::size_t kUnlimited = ~std::size_t{0};
  std::size_t limit_ = kUnlimited;
};

/// Makes a pose description hold a pose; where it held one before, in the same memory.
void assign_pose(const ModelPose& pose, PoseSpec& spec);

}  // namespace sunder::tear
