#pragma once

#include <sunder/skinning/deform.h>
#include <sunder/tear/wound_mask.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "tools/render/png_file.h"

namespace sunder::tools {

/// The channels of wounds that `--wound-mask-channels` names.
enum class MaskChannel : std::uint8_t { age, depth, stretch, blood };
inline constexpr std::array<const char*, 4> kMaskChannels = {"age", "depth", "stretch", "blood"};

/// A channel of wounds in levels of grey.
struct ChannelPicture {
  MaskChannel channel = MaskChannel::age;
  Picture picture;
  double at_0 = 0, at_255 = 0;  ///< Values of these levels; they are linear in between.
};

/// The masks of a torn model, one per mesh at most.
struct MaskedModel {
  const TornModel& model;
  std::span<const WoundMask> masks;       ///< Of one size; at least one.
  std::span<const std::uint32_t> meshes;  ///< Of each mask.
  const ModelPose& pose;                  ///< In which blood runs.
  std::span<const DeformedMesh> posed;    ///< The torn meshes, for the stretch.
};

/// The file of a channel: "wound.age.png" beside "wound.png".
[[nodiscard]] std::filesystem::path channel_file(const std::filesystem::path& mask,
                                                 MaskChannel channel);

/// Draws a channel of all masks; where masks share a texel, the greater level counts. Ages count
/// down from 255, the newest operation, to 1; depths are shares of the deepest; blood is a share.
/// @return the failures of WoundMask::channel(), stretches() and flow().
[[nodiscard]] Result<ChannelPicture> draw_channel(const MaskedModel& of, MaskChannel channel);

}  // namespace sunder::tools
