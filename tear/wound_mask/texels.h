#pragma once

#include <sunder/tear/wound_mask.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tear/wound_mask/flat_faces.h"

namespace sunder::tear {

/// Assigns each texel of a texture a triangle of the mesh: the one at the texel's centre or, near
/// the border of a chart, the nearest one.
class Texels {
 public:
  /// A triangle in units of texels; the centre of texel (i, j) is at (i, j).
  struct InTexture {
    std::array<Flat, 3> corners;
    double twice_area = 0;
    Flat low, high;  ///< The box of the corners.

    /// Barycentric coordinates of a place, or of the nearest one in the triangle.
    [[nodiscard]] std::array<double, 3> nearest(Flat place) const;
    /// The squared distance of a place from the triangle; 0 inside.
    [[nodiscard]] double outside(Flat place) const;
  };

  /// @param mesh  its index, which has the UV set. The options are valid.
  Texels(const Character& source, std::uint32_t mesh, const FlatFaces& faces,
         const WoundMaskOptions& options);

  /// The place of a triangle; none if it is not painted.
  [[nodiscard]] std::optional<InTexture> in_texture(std::uint32_t triangle) const;
  /// Calls visit(column, row, barycentric coordinates) for all texels of a triangle.
  template <class Visit>
  void for_each_of(std::uint32_t triangle, Visit visit) const {
    const std::optional<InTexture> at = in_texture(triangle);
    if (!at) return;
    const std::uint32_t margin = touches_border_[triangle] ? options_.dilation : 0;
    const bool may_come_twice = at->high.x - at->low.x + 2 * margin + 1 >= options_.width ||
                                at->high.y - at->low.y + 2 * margin + 1 >= options_.height;
    for_each_near(*at, margin, [&](Flat p, auto i) {
      if (owners_[i] == triangle && !(may_come_twice && nearest_tile(p, *at) != p))
        visit(static_cast<std::uint32_t>(i % options_.width),
              static_cast<std::uint32_t>(i / options_.width), at->nearest(p));
    });
  }
  [[nodiscard]] bool is_owned(std::size_t texel) const { return owners_[texel] != kNone; }
  /// The triangle of a texel and the place in it; none if it is not owned.
  [[nodiscard]] std::optional<SourcePlace> place_of(std::uint32_t column, std::uint32_t row) const;
  /// Whether a triangle has no area in the texture, or shares a texel with others, clearly inside
  /// of both; false if it is none of those that are painted.
  [[nodiscard]] bool lacks_texels(std::uint32_t triangle) const;
  [[nodiscard]] const WoundMaskNotes& notes() const { return notes_; }

 private:
  /// Calls visit(place, texel) for the texels in the box of a triangle with a margin.
  template <class Visit>
  void for_each_near(const InTexture& at, std::uint32_t margin, Visit visit) const {
    const auto whole = [](double x) { return static_cast<std::int64_t>(x); };
    const auto width = std::int64_t{options_.width}, height = std::int64_t{options_.height};
    const std::int64_t left = whole(std::ceil(at.low.x)) - margin,
                       right = whole(std::floor(at.high.x)) + margin,
                       top = whole(std::ceil(at.low.y)) - margin,
                       bottom = whole(std::floor(at.high.y)) + margin;
    for (std::int64_t y = top; y <= bottom; ++y) {
      const std::int64_t row = ((y % height) + height) % height;
      std::int64_t column = ((left % width) + width) % width;
      for (std::int64_t x = left; x <= right; ++x) {
        visit(Flat{static_cast<double>(x), static_cast<double>(y)},
              static_cast<std::size_t>(row * width + column));
        if (++column == width) column = 0;
      }
    }
  }
  /// Whether a triangle is one of those that are painted.
  [[nodiscard]] bool is_wanted(std::uint32_t triangle) const {
    return options_.submesh == kNone || submesh_of_[triangle] == options_.submesh;
  }
  /// The place of a texel in the tile where it is nearest to a triangle; the first of several.
  [[nodiscard]] Flat nearest_tile(Flat place, const InTexture& at) const;
  void find_borders(const Surface& surface, std::uint32_t mesh);
  void own_centres();
  void own_near_borders();

  WoundMaskOptions options_;
  std::vector<Vec2d> uvs_;  ///< In the texture.
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> submesh_of_;  ///< Per triangle.
  std::vector<bool> touches_border_;   ///< Per triangle: whether an edge is the border of a chart.
  std::vector<std::uint32_t> owners_;  ///< Per texel; kNone.
  std::vector<bool> overlaps_;         ///< Per texel; none if no triangles overlap.
  WoundMaskNotes notes_;
};

}  // namespace sunder::tear
