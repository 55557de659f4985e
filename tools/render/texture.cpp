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

Vec4f sampled(const Image& image, const std::array<RenderMaterial::Wrap, 2>& wrap,
              const Vec2f& uv) {
  const float x = folded(uv.x(), wrap[0]) * static_cast<float>(image.width) - 0.5f,
              y = folded(uv.y(), wrap[1]) * static_cast<float>(image.height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  const auto& linear = linear_from_srgb();
  Vec4f sum = Vec4f::Zero();
  for (int i = 0; i < 4; ++i) {
    const int column = wrapped(static_cast<int>(left) + (i & 1), image.width, wrap[0]);
    const int row = wrapped(static_cast<int>(top) + (i >> 1), image.height, wrap[1]);
    const std::uint8_t* const pixel =
        &image.rgba[std::size_t{4} *
                    (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(column))];
    const float weight =
        ((i & 1) != 0 ? x - left : 1 - (x - left)) * ((i >> 1) != 0 ? y - top : 1 - (y - top));
    sum += weight * Vec4f(linear[pixel[0]], linear[pixel[1]], linear[pixel[2]],
                          static_cast<float>(pixel[3]) / 255);
  }
  return sum;
}

}  // namespace sunder::tools
