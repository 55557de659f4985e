#pragma once

#include <sunder/tear/torn_model.h>

#include <span>
#include <vector>

#include "tools/picture/blood_covers.h"
#include "tools/picture/model_looks.h"
#include "tools/picture/open_lips.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// A torn model to be drawn.
struct TornView {
  const TornModel& torn;
  const std::vector<DeformedMesh>& closed;  ///< With coincident lips.
  const std::vector<DeformedMesh>& open;    ///< With the lips pulled open, or pieces apart.
  std::span<const Wound> wounds;            ///< That a trough of flesh shuts.
  const BloodCovers& blood;
};

/// A scene of a torn model: wounds are troughs of flesh; other openings have rims as thick as
/// flesh, and flesh is what shows through them. Walls and caps are flesh too. It must not outlive
/// the blood.
/// @param thickness  of the flesh at rims, metres.
[[nodiscard]] RenderScene make_torn_scene(const TornView& view, const ModelLooks& looks,
                                          double thickness);

}  // namespace sunder::tools
