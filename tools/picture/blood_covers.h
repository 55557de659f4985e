#pragma once

#include <sunder/tear/torn_model.h>

#include <span>
#include <vector>

#include "tools/blood/blood_layers.h"
#include "tools/picture/model_looks.h"

namespace sunder::tools {

/// The blood of a torn model in pictures: in its textures, and on skin without room in one by the
/// distance to RenderScene::lips.
class BloodCovers {
 public:
  BloodCovers() = default;  ///< None.
  /// @param pose    of the operations, in which blood runs down.
  /// @param length  of its wounds, metres; 0: they have none.
  /// @return the failures of lay_blood() and pose_positions().
  [[nodiscard]] static Result<BloodCovers> create(const TornModel& model, const ModelPose& pose,
                                                  const ModelLooks& looks, double length);

  /// Adds the materials to a scene that `looks` began and that must not outlive this object.
  /// @return per mesh, ModelLooks::Flesh::covers.
  [[nodiscard]] std::vector<std::vector<ModelLooks::Cover>> add_to(const ModelLooks& looks,
                                                                   RenderScene& scene) const;
  /// The scale of BloodPlace::rest: bind space to reaches; 1 without blood.
  [[nodiscard]] float reaches_of(std::uint32_t mesh) const {
    return mesh < reaches_of_.size() ? reaches_of_[mesh] : 1.0f;
  }

 private:
  BloodLayers layers_;
  std::vector<std::size_t> submeshes_of_;  ///< Per mesh of the source.
  std::vector<float> reaches_of_;          ///< Per mesh.
};

}  // namespace sunder::tools
