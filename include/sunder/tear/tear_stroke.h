#pragma once

#include <sunder/tear/torn_model.h>

namespace sunder {

/// Which of the blades that a stroke is given it takes up.
struct StrokeSampling {
  double minimum_distance =
      0.0;  ///< Metres that base or tip must have moved since the last blade taken up; >= 0.
  double minimum_seconds = 0.0;  ///< That must have passed since then; >= 0.
};

/// A tear that arrives blade by blade, over many frames, while the character moves. In one pose it
/// gives the same surface, bit for bit, as TornModel::tear() of all its blades. It is one operation
/// to undo.
///
/// While a stroke is under way its model refuses other operations. The model must outlive it;
/// moving the model is allowed.
class SUNDER_API TearStroke {
 public:
  /// @param blade  where the stroke begins; nothing is torn yet.
  /// @return as TornModel::tear(); also invalid_argument where another stroke is under way.
  static Result<TearStroke> create(TornModel& model, const ModelPose& pose, const Blade& blade,
                                   const TearOptions& options = {},
                                   const StrokeSampling& sampling = {});

  /// Tears on to `blade`, from where the tear now stands on the posed surface. With a width the gap
  /// follows one segment behind: how it is mitred depends on where the blade goes next.
  ///
  /// @param seconds  time of the blade, for the sampling; not before that of the last.
  /// @return what this call did: a blade that is not taken up yet is no segment; one that meets
  /// nothing is a segment missed. On failure
  ///         the stroke and the model are as they were.
  ///
  /// O(faces crossed) while the tear stands on the surface.
  Result<TearReport> extend(const ModelPose& pose, const Blade& blade, double seconds = 0.0,
                            ChangeRecord* change = nullptr);

  /// Takes up a blade that was held back, tears what of the gap was left to do, and closes the
  /// operation.
  /// @return what the whole stroke did; `change` is that of this call alone. On failure the stroke
  /// and the model are as they were:
  ///         the stroke can be extended, ended or cancelled.
  Result<TearReport> end(ChangeRecord* change = nullptr);

  /// Takes the whole stroke back: the model is as it was before create(), bit for bit, with what
  /// could be undone and redone.
  /// @param change  written where given: what takes all calls of the stroke back. No lips and no
  /// rims.
  /// @return ok without `change`; else limit_exceeded or capacity_exceeded where there is no memory
  /// to describe the change, and the
  ///         stroke is as it was. O(what the stroke changed).
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
