#include "tools/tear/wound_channels.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "tools/blood/blood_layers.h"

namespace sunder::tools {
namespace {

constexpr double kMostStretch = 2.0;  ///< White; twice as long as in bind space.

Result<std::vector<float>> values_of(const MaskedModel& of, std::size_t index,
                                     MaskChannel channel) {
  const WoundMask& mask = of.masks[index];
  switch (channel) {
    case MaskChannel::age: return mask.channel(of.model, WoundChannel::age);
    case MaskChannel::depth: return mask.channel(of.model, WoundChannel::depth);
    case MaskChannel::stretch:
      return mask.stretches(of.model, of.posed[of.meshes[index]].positions);
    case MaskChannel::blood: break;
  }
  return mask.flow(of.model, of.pose, flow_within(mask.options().reach));
}

/// The values of the levels 0 and 255.
std::pair<double, double> range_of(MaskChannel channel, double greatest) {
  switch (channel) {
    case MaskChannel::age: return {255, 0};
    case MaskChannel::depth: return {0, greatest};
    case MaskChannel::stretch: return {1, kMostStretch};
    case MaskChannel::blood: break;
  }
  return {0, 1};
}

std::uint8_t level_of(const ChannelPicture& of, double value) {
  if (of.channel == MaskChannel::age)  // -1: no lip.
    return value < 0 ? 0 : static_cast<std::uint8_t>(255 - std::lround(std::min(value, 254.0)));
  if (of.at_0 == of.at_255) return 0;
  const double share = (value - of.at_0) / (of.at_255 - of.at_0);
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

std::filesystem::path channel_file(const std::filesystem::path& mask, MaskChannel channel) {
  std::filesystem::path file = mask;
  return file.replace_extension(
      "." + std::string(kMaskChannels[static_cast<std::size_t>(channel)]) + ".png");
}

Result<ChannelPicture> draw_channel(const MaskedModel& of, MaskChannel channel) {
  std::vector<std::vector<float>> values;
  double greatest = 0;
  for (std::size_t i = 0; i < of.masks.size(); ++i) {
    Result<std::vector<float>> found = values_of(of, i, channel);
    if (!found) return found.error();
    for (const float value : *found) greatest = std::max(greatest, static_cast<double>(value));
    values.push_back(std::move(*found));
  }
  const WoundMaskOptions& options = of.masks.front().options();
  ChannelPicture drawn;
  drawn.channel = channel;
  std::tie(drawn.at_0, drawn.at_255) = range_of(channel, greatest);
  drawn.picture.width = static_cast<int>(options.width);
  drawn.picture.height = static_cast<int>(options.height);
  drawn.picture.colors.assign(std::size_t{options.width} * options.height, {0, 0, 0});
  for (std::size_t m = 0; m < values.size(); ++m)
    for (std::size_t i = 0; i < values[m].size(); ++i) {
      const std::uint8_t level = level_of(drawn, static_cast<double>(values[m][i]));
      if (level > drawn.picture.colors[i][0]) drawn.picture.colors[i] = {level, level, level};
    }
  return drawn;
}

}  // namespace sunder::tools
