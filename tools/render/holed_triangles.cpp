#include "tools/render/holed_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>

namespace sunder::tools {
namespace {

/// Above this share of opacity nothing is seen behind a surface.
constexpr float kSolid = 0.9999f;
/// Images with more pixels are counted by squares of several.
constexpr double kMostCells = 1 << 20;
/// Means of texture coordinates are rounded by less than this share of the largest of them: eight
/// roundings of floats.
constexpr double kRounding = 5e-7;

/// Counts the pixels of an image that are not opaque, in cells of one or more pixels.
class ClearPixels {
 public:
  explicit ClearPixels(const Image& image)
      : step_(static_cast<int>(
            std::ceil(std::sqrt(std::max(1.0, 1.0 * image.width * image.height / kMostCells))))),
        columns_((image.width + step_ - 1) / step_),
        rows_((image.height + step_ - 1) / step_),
        sums_(static_cast<std::size_t>(columns_ + 1) * static_cast<std::size_t>(rows_ + 1), 0) {
    std::size_t pixel = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x, ++pixel)
        if (image.rgba[4 * pixel + 3] != 255) sums_[place(x / step_ + 1, y / step_ + 1)] = 1;
    for (int y = 1; y <= rows_; ++y)
      for (int x = 1; x <= columns_; ++x)
        sums_[place(x, y)] += at(x - 1, y) + at(x, y - 1) - at(x - 1, y - 1);
  }

  using Range = std::array<int, 2>;  ///< First and last pixel.
  [[nodiscard]] bool any(const Range& across, const Range& down) const {
    const int left = across[0] / step_, right = across[1] / step_ + 1, top = down[0] / step_,
              bottom = down[1] / step_ + 1;
    return at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top) > 0;
  }

 private:
  [[nodiscard]] std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_ + 1) +
           static_cast<std::size_t>(x);
  }
  [[nodiscard]] std::uint32_t at(int x, int y) const { return sums_[place(x, y)]; }

  int step_, columns_, rows_;
  std::vector<std::uint32_t> sums_;  ///< Of the cells above and to the left.
};

/// The pixels along one side of an image that a triangle shows: at most two ranges, where its
/// coordinates run over the end.
std::vector<ClearPixels::Range> shown_pixels(const std::array<float, 3>& coordinates, int count,
                                             RenderMaterial::Wrap wrap, bool is_pixelated) {
  const auto [least, greatest] = std::ranges::minmax(coordinates);
  const ClearPixels::Range all = {0, count - 1};
  if (!(std::abs(least) < 1e6f && std::abs(greatest) < 1e6f)) return {all};
  const double rounding = kRounding * count * std::max({1.0f, std::abs(least), std::abs(greatest)});
  // A pixel is not shown if the triangle only touches it.
  const double border = is_pixelated ? -rounding : 0.5 + rounding;
  const auto first = static_cast<std::int64_t>(std::floor(1.0 * least * count - border)),
             last = std::max(
                 first, static_cast<std::int64_t>(std::floor(1.0 * greatest * count + border)));
  if (wrap == RenderMaterial::Wrap::clamp) {
    const auto inside = [&](std::int64_t pixel) {
      return static_cast<int>(std::clamp<std::int64_t>(pixel, 0, count - 1));
    };
    return {{inside(first), inside(last)}};
  }
  if (last - first + 1 >= count) return {all};
  const auto repeat_of = [&](std::int64_t pixel) {
    return pixel / count - (pixel % count < 0 ? 1 : 0);
  };
  const std::int64_t repeat = repeat_of(first), repeat_of_last = repeat_of(last);
  auto a = static_cast<int>(first - repeat * count),
       b = static_cast<int>(last - repeat_of_last * count);
  if (wrap == RenderMaterial::Wrap::repeat && repeat != repeat_of_last)
    return {{a, count - 1}, {0, b}};
  if (repeat != repeat_of_last) return {all};
  if (wrap == RenderMaterial::Wrap::mirror && repeat % 2 != 0) {
    a = count - 1 - a;
    b = count - 1 - b;
  }
  return {{std::min(a, b), std::max(a, b)}};
}

bool is_holed(const RenderTriangle& triangle, const RenderMaterial& material,
              const ClearPixels* clear) {
  const float alpha = material.factor.w() * std::min({triangle.tints[0].w(), triangle.tints[1].w(),
                                                      triangle.tints[2].w()});
  const bool is_cut = material.alpha == RenderMaterial::Alpha::cut;
  if (!(alpha >= (is_cut ? material.cutoff / kSolid : kSolid))) return true;
  if (clear == nullptr) return false;
  const auto ranges = [&](int axis) {
    const Image& image = *material.image;
    return shown_pixels({triangle.uvs[0][axis], triangle.uvs[1][axis], triangle.uvs[2][axis]},
                        axis == 0 ? image.width : image.height,
                        material.wrap[static_cast<std::size_t>(axis)], material.is_pixelated);
  };
  const auto rows = ranges(1);
  for (const ClearPixels::Range& across : ranges(0))
    for (const ClearPixels::Range& down : rows)
      if (clear->any(across, down)) return true;
  return false;
}

}  // namespace

std::vector<bool> holed_triangles(const RenderScene& scene) {
  std::map<const Image*, ClearPixels> images;
  std::vector<bool> are_holed;
  are_holed.reserve(scene.triangles.size());
  for (const RenderTriangle& triangle : scene.triangles) {
    const RenderMaterial& material = scene.materials[triangle.material];
    if (material.alpha == RenderMaterial::Alpha::ignored) {
      are_holed.push_back(false);
      continue;
    }
    const ClearPixels* const clear =
        material.image == nullptr
            ? nullptr
            : &images.try_emplace(material.image, *material.image).first->second;
    are_holed.push_back(is_holed(triangle, material, clear));
  }
  return are_holed;
}

}  // namespace sunder::tools
