#include "tools/tear/wound_picture.h"

#include <algorithm>
#include <cmath>

#include "tools/messages/output_file.h"
#include "tools/messages/printed.h"
#include "tools/messages/written_file.h"

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

/// The masks of all meshes with texture coordinates.
/// @return the failure of WoundMask::create().
Result<std::vector<WoundMask>> make_masks(const TearRun& run) {
  const std::vector<Mesh>& meshes = run.model.source().meshes;
  WoundMaskOptions options;
  options.width = options.height = run.request.wound_mask_size;
  options.reach = run.request.wound_mask_reach;
  std::vector<WoundMask> masks;
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
    masks.push_back(std::move(*mask));
  }
  if (masks.empty())
    return Status::failure(StatusCode::not_found, kNone, "no mesh has texture coordinates");
  return masks;
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

ExitCode write_wound_mask(TearRun& run) {
  const std::filesystem::path& file = *run.request.wound_mask;
  const Result<std::vector<WoundMask>> masks = make_masks(run);
  if (!masks) return complain("--wound-mask", masks.error(), ExitCode::findings);
  if (const Status status = write_png(file, wound_picture(*masks)); !status)
    return complain(file.string(), status, ExitCode::unreadable_input);
  run.messages.say(written(file));
  return ExitCode::ok;
}

}  // namespace sunder::tools
