#pragma once

#include <sunder/tear/torn_model.h>

namespace sunder {

/// Which incoming blade samples a stroke uses; the others are held back.
struct StrokeSampling {
  double minimum_distance = 0.0;  ///< Least distance that base or tip must have moved since the
                                  ///< last used blade, metres; >= 0.
  double minimum_seconds = 0.0;   ///< Least time since that blade; >= 0.
};

/// A tear that is extended blade by blade, over many frames, while the character moves. In one pose
/// it gives the same surface, bit for bit, as TornModel::tear() with all its blades. It is one
/// operation for undo.
///
/// While a stroke is in progress, its model refuses other operations. The model must outlive the
/// stroke and may be moved. Use both on one thread at a time.
class SUNDER_API TearStroke {
 public:
  ///
  /// @param blade  the start of the stroke; nothing is torn yet.
  /// @return as TornModel::tear(); also invalid_argument if another stroke is in progress.
  static Result<TearStroke> create(TornModel& model, const ModelPose& pose, const Blade& blade,
                                   const TearOptions& options = {},
                                   const StrokeSampling& sampling = {});

  /// Extends the tear to `blade`, from its current end on the posed surface. A gap follows one
  /// segment behind, because its mitre depends on the next blade. O(faces crossed) while the tear
  /// is on the surface.
  ///
  /// @param seconds  time of the blade, for the sampling; not before that of the last.
  /// @return the figures of this call: a blade that is held back is no segment, and one that meets
  ///         nothing is a missed segment. On failure the stroke and the model are unchanged.
  Result<TearReport> extend(const ModelPose& pose, const Blade& blade, double seconds = 0.0,
                            ChangeRecord* change = nullptr);

  /// Uses a blade that was held back, completes the gap and the walls, and closes the operation.
  /// @return the figures of the whole stroke; `change` is that of this call alone. On failure the
  ///         stroke and the model are unchanged: the stroke can be extended, ended or cancelled.
  Result<TearReport> end(ChangeRecord* change = nullptr);

  /// Undoes the whole stroke: the model is as it was before create(), bit for bit, with its undo
  /// and redo stacks. O(changes by the stroke).
  ///
  /// @param change  optional; written: reverts all calls of the stroke, without lips and rims.
  /// @return ok without `change`; otherwise limit_exceeded or capacity_exceeded if there is no
  ///         memory to describe the change, and the stroke is unchanged.
  Status cancel(ChangeRecord* change = nullptr);

  /// Cancels the stroke if it was not ended.
  ~TearStroke();
  TearStroke(TearStroke&&) noexcept;
  TearStroke& operator=(TearStroke&&) = delete;

 private:
  struct State;
  explicit TearStroke(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace sunder
