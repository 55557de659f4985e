#pragma once

#include <sunder/core/index.h>
#include <sunder/operation/operation.h>

#include <memory>
#include <span>
#include <vector>

#include "tear/surface/opened_borders.h"
#include "tear/surface/surface_editor.h"
#include "tear/surface/weight_change.h"

namespace sunder::tear {

/// The operations that were done and those that were taken back. What is dropped keeps its memory
/// for the next.
class History {
 public:
  struct Entry {
    Operation operation;
    EditLog::Mark begin;
    SurfaceEditor::Redo redo;     ///< Of one that was taken back.
    WeightChange weights;         ///< Of a WeightsOperation: what takes it back, or does it again.
    std::uint64_t serial = 0;     ///< That no other entry has, of any model; given by push().
    IndexRange lips, rim_points;  ///< Among those of all entries; given by push().

    /// The operation as one of this kind, to be filled in.
    template <class Kind>
    Kind& as() {
      if (!std::holds_alternative<Kind>(operation)) operation = Kind{};
      return std::get<Kind>(operation);
    }
  };

  /// Has memory for so many operations, and for the lips that all of them may open, and takes no
  /// more.
  /// @param pose  like all that come.
  void limit_to(std::size_t operations, std::size_t lips, const ModelPose& pose);
  [[nodiscard]] bool has_room() const { return limit_ == kUnlimited || done_.size() < limit_; }

  /// An entry that is none yet, to be filled in.
  [[nodiscard]] Entry& next();
  /// To be called before push() with so many, which does not fail then.
  void make_room_for(std::size_t lips, std::size_t rim_points);
  /// Makes next() the newest, and forgets what was taken back.
  /// @param borders  that it opened: to be told again by redo().
  void push(const OpenedBorders& borders);

  [[nodiscard]] const std::vector<std::unique_ptr<Entry>>& done() const { return done_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Entry>>& undone() const { return undone_; }
  /// What an entry was pushed with; of one that was taken back too.
  [[nodiscard]] std::span<const LipPair> lips_of(const Entry& entry) const {
    return std::span(borders_.lips).subspan(entry.lips.first, entry.lips.count);
  }
  [[nodiscard]] std::span<const RimPoint> rim_points_of(const Entry& entry) const {
    return std::span(borders_.rim_points).subspan(entry.rim_points.first, entry.rim_points.count);
  }
  void make_room_to_undo() {
    if (undone_.size() == undone_.capacity()) undone_.reserve(2 * undone_.size() + 8);
  }
  /// Moves the newest from one side to the other.
  void move_to_undone() { move_last(done_, undone_); }
  void move_to_done() { move_last(undone_, done_); }

 private:
  using Entries = std::vector<std::unique_ptr<Entry>>;
  static void move_last(Entries& from, Entries& to);
  /// Where what the next entry opened is to stand: after what was opened by all that are done.
  [[nodiscard]] IndexRange next_lips() const;
  [[nodiscard]] IndexRange next_rim_points() const;

  Entries done_, undone_, spare_;
  OpenedBorders borders_;  ///< Of all entries, the done ones from the oldest on, then those taken
                           ///< back, from the last on.
  static constexpr std::size_t kUnlimited = ~std::size_t{0};
  std::size_t limit_ = kUnlimited;
};

/// Makes a pose description hold a pose; where it held one before, in the same memory.
void assign_pose(const ModelPose& pose, PoseSpec& spec);

}  // namespace sunder::tear
