#include "tools/render/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunder::tools {
namespace {

int wrapped(int index, int count, RenderMaterial::Wrap wrap) {
  if (wrap == RenderMaterial::Wrap::clamp) return std::clamp(index, 0, count - 1);
  const int period = wrap == RenderMaterial::Wrap::mirror ? 2 * count : count;
  if (index < 0 || index >= period) index %= period;
  if (index < 0) index += period;
  return index < count ? index : period - 1 - index;
}

/// A texture coordinate in a range in which pixels can be counted.
float folded(float value, RenderMaterial::Wrap wrap) {
  if (wrap == RenderMaterial::Wrap::clamp) return std::clamp(value, 0.0f, 1.0f);
  return std::isfinite(value) ? value - 2 * std::floor(value / 2) : 0.0f;
}

}  // namespace

const std::array<float, 256>& linear_from_srgb() {
  static const std::array<float, 256> kTable = [] {
    std::array<float, 256> table;
    for (std::size_t i = 0; i < table.size(); ++i) {
      const float c = static_cast<float>(i) / 255;
      table[i] = c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
    }
    return table;
  }();
  return kTable;
}

Vec4f sampled(const Image& image, const RenderMaterial& material, const Vec2f& uv) {
  const auto& [wrap_u, wrap_v] = material.wrap;
  const auto pixel_at = [&, &wrap_u = wrap_u, &wrap_v = wrap_v](float x, float y) {
    const auto column = wrapped(static_cast<int>(x), image.width, wrap_u),
               row = wrapped(static_cast<int>(y), image.height, wrap_v);
    const std::uint8_t* const pixel =
        &image.rgba[std::size_t{4} *
                    (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(column))];
    const auto& linear = linear_from_srgb();
    return Vec4f(linear[pixel[0]], linear[pixel[1]], linear[pixel[2]],
                 static_cast<float>(pixel[3]) / 255);
  };
  const float x = folded(uv.x(), wrap_u) * static_cast<float>(image.width),
              y = folded(uv.y(), wrap_v) * static_cast<float>(image.height);
  if (material.is_pixelated) return pixel_at(std::floor(x), std::floor(y));
  const float left = std::floor(x - 0.5f), top = std::floor(y - 0.5f);
  const float right_share = x - 0.5f - left, bottom_share = y - 0.5f - top;
  Vec4f sum = Vec4f::Zero();
  for (int i = 0; i < 4; ++i) {
    const auto to_right = static_cast<float>(i & 1), down = static_cast<float>(i >> 1);
    const float weight = ((i & 1) != 0 ? right_share : 1 - right_share) *
                         ((i >> 1) != 0 ? bottom_share : 1 - bottom_share);
    sum += weight * pixel_at(left + to_right, top + down);
  }
  return sum;
}

}  // namespace sunder::tools
