#include "tools/tear/wound_picture.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tools/messages/output_file.h"
#include "tools/messages/printed.h"
#include "tools/messages/written_file.h"
#include "tools/model/posed_model.h"
#include "tools/tear/pose_of_run.h"

namespace sunder::tools {
namespace {

std::uint8_t level(double share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
}

/// How much of a texel was removed, by its distance and those of its neighbours.
double removed_share(std::span<const float> distances, std::size_t width, std::size_t texel) {
  const double here = distances[texel];
  double step = 0;
  bool is_at_lip = false;
  const auto compare = [&](std::size_t other) {
    is_at_lip |= std::signbit(distances[other]) != std::signbit(distances[texel]);
    step = std::max(step, std::abs(here - static_cast<double>(distances[other])));
  };
  if (texel % width > 0) compare(texel - 1);
  if (texel % width + 1 < width) compare(texel + 1);
  if (texel >= width) compare(texel - width);
  if (texel + width < distances.size()) compare(texel + width);
  if (!is_at_lip || step == 0) return std::signbit(distances[texel]) ? 1 : 0;
  return std::clamp(0.5 - here / step, 0.0, 1.0);
}

struct WoundMasks {
  std::vector<WoundMask> masks;
  std::vector<std::uint32_t> meshes;  ///< Of each mask.
};

/// The masks of all meshes with texture coordinates.
/// @return the failure of WoundMask::create().
Result<WoundMasks> make_masks(const TearRun& run) {
  const std::vector<Mesh>& meshes = run.model.source().meshes;
  WoundMaskOptions options;
  options.width = options.height = run.request.wound_mask_size;
  options.reach = run.request.wound_mask_reach;
  WoundMasks made;
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    if (meshes[m].uv_sets.empty()) {
      run.messages.warn(
          printed("--wound-mask: mesh '%.100s' has no texture coordinates, so its "
                  "wounds are not in the picture",
                  meshes[m].name.c_str()));
      continue;
    }
    Result<WoundMask> mask = WoundMask::create(run.model, m, options);
    if (!mask) return mask.error();
    const WoundMaskNotes& notes = mask->notes();
    if (notes.overlapping_texels > 0)
      run.messages.warn(
          printed("--wound-mask: charts of mesh '%.100s' overlap in %u texels, which "
                  "show the wounds of one of them",
                  meshes[m].name.c_str(), notes.overlapping_texels));
    if (notes.unpainted_triangles > 0)
      run.messages.warn(
          printed("--wound-mask: %u triangles of mesh '%.100s' have no area in the "
                  "texture, or repeat it; their wounds are not in the picture",
                  notes.unpainted_triangles, meshes[m].name.c_str()));
    made.masks.push_back(std::move(*mask));
    made.meshes.push_back(m);
  }
  if (made.masks.empty())
    return Status::failure(StatusCode::not_found, kNone, "no mesh has texture coordinates");
  return made;
}

/// What the levels of a picture stand for, where they depend on the model.
std::string meaning(const ChannelPicture& of) {
  if (of.channel != MaskChannel::depth) return {};
  return printed("; the level 255 is %.4g m", of.at_255);
}

/// The channels that are wanted, in the pose of the last operation; lips gape with --open.
Result<std::vector<ChannelPicture>> draw_channels(const TearRun& run, const WoundMasks& made) {
  std::vector<ChannelPicture> drawn;
  if (run.request.wound_mask_channels.empty()) return drawn;
  const Result<ModelPose> pose = pose_of_run(run);
  if (!pose) return pose.error();
  Result<std::vector<DeformedMesh>> posed = std::vector<DeformedMesh>();
  if (run.opening)
    posed = run.opening->open;
  else
    posed = pose_positions(run.model.character(), *pose);
  if (!posed) return posed.error();
  for (const MaskChannel channel : run.request.wound_mask_channels) {
    Result<ChannelPicture> picture =
        draw_channel({run.model, made.masks, made.meshes, *pose, *posed}, channel);
    if (!picture) return picture.error();
    drawn.push_back(std::move(*picture));
  }
  return drawn;
}

}  // namespace

Picture wound_picture(std::span<const WoundMask> masks) {
  const WoundMaskOptions& options = masks.front().options();
  Picture picture;
  picture.width = static_cast<int>(options.width);
  picture.height = static_cast<int>(options.height);
  picture.colors.assign(std::size_t{options.width} * options.height, {0, 0, 0});
  for (const WoundMask& mask : masks)
    for (std::size_t i = 0; i < picture.colors.size(); ++i) {
      const auto column = static_cast<std::uint32_t>(i % options.width),
                 row = static_cast<std::uint32_t>(i / options.width);
      if (!mask.is_painted(column, row)) continue;
      const double outside = std::max(0.0, static_cast<double>(mask.distances()[i]));
      Picture::Color& color = picture.colors[i];
      color[0] = std::max(color[0], level(1 - outside / options.reach));
      color[1] = std::max(color[1], level(removed_share(mask.distances(), options.width, i)));
      color[2] = 255;
    }
  return picture;
}

ExitCode draw_wounds_of_run(TearRun& run) {
  if (!run.request.wound_mask || run.request.dry_run) return ExitCode::ok;
  const Result<WoundMasks> made = make_masks(run);
  if (!made) {
    run.has_findings = true;
    (void)complain("--wound-mask", made.error(), ExitCode::findings);
    return ExitCode::ok;
  }
  Result<std::vector<ChannelPicture>> channels = draw_channels(run, *made);
  if (!channels)
    return complain("--wound-mask-channels", channels.error(), ExitCode::internal_error);
  run.wounds = {wound_picture(made->masks), std::move(*channels)};
  return ExitCode::ok;
}

ExitCode write_wounds_of_run(const TearRun& run) {
  if (!run.wounds) return ExitCode::ok;
  const std::filesystem::path& mask = *run.request.wound_mask;
  if (const Status status = write_png(mask, run.wounds->mask); !status)
    return complain(mask.string(), status, ExitCode::unreadable_input);
  run.messages.say(written(mask));
  for (const ChannelPicture& of : run.wounds->channels) {
    const std::filesystem::path file = channel_file(mask, of.channel);
    if (const Status status = write_png(file, of.picture); !status)
      return complain(file.string(), status, ExitCode::unreadable_input);
    run.messages.say(written(file) + meaning(of));
  }
  return ExitCode::ok;
}

Json wounds_json(const TearRun& run) {
  Json channels = Json::array();
  for (const ChannelPicture& of : run.wounds->channels)
    channels.push_back({{"channel", kMaskChannels[static_cast<std::size_t>(of.channel)]},
                        {"file", channel_file(*run.request.wound_mask, of.channel).string()},
                        {"at_0", of.at_0},
                        {"at_255", of.at_255}});
  return {{"file", run.request.wound_mask->string()},
          {"reach", run.request.wound_mask_reach},
          {"channels", std::move(channels)}};
}

}  // namespace sunder::tools
