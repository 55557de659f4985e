#pragma once

#include <sunder/tear/torn_model.h>

#include <memory>
#include <optional>
#include <vector>

#include "tools/picture/blood_covers.h"
#include "tools/picture/model_looks.h"
#include "tools/picture/open_lips.h"
#include "tools/picture/wound_flesh.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// A character of soft tissue that plays its clip and is torn stroke by stroke, for pictures.
class TornActor {
 public:
  /// Not torn yet; `tear` and its pose decide how soft it is.
  [[nodiscard]] static Result<TornActor> create(std::shared_ptr<const Character> source,
                                                const TearOperation& tear);

  /// Tears on to a blade of the operation; 0 begins, the last one ends.
  [[nodiscard]] Status tear_to(std::size_t blade);
  [[nodiscard]] std::size_t blade_count() const { return tear_.stroke.size(); }

  /// Lets time pass in a pose.
  [[nodiscard]] Status play(const PoseSpec& pose, double seconds);
  /// Lets time pass until nothing moves.
  [[nodiscard]] Status settle(const PoseSpec& pose);

  /// The surface as it is now.
  struct Posture {
    std::vector<DeformedMesh> closed, open;  ///< With and without coincident lips.
    std::optional<WoundFlesh> wound;         ///< Empty before the first tear.
  };
  [[nodiscard]] Result<Posture> posture();
  /// A scene that is valid until the next call. @return the failures of lay_blood().
  [[nodiscard]] Result<RenderScene> scene(const Posture& posture, const ModelLooks& looks);
  [[nodiscard]] const Character& character() const { return model_.instance.character(); }

 private:
  TornActor(GapingModel model, TearOperation tear, ModelPose pose);

  GapingModel model_;
  TearOperation tear_;
  ModelPose tear_pose_, pose_;
  Wound wound_;
  BloodCovers blood_;
  std::size_t bloody_lips_ = 0;  ///< Lips of the wound when `blood_` was laid.
};

}  // namespace sunder::tools
