#include "tear/wound_mask/texels.h"

namespace sunder::tear {
namespace {

/// Charts that overlap by less are neighbours, rounded: texels.
constexpr double kClearlyInside = 0.01;

/// How far inside a place is, texels; negative outside.
double depth_inside(Flat place, const Texels::InTexture& at) {
  double least = std::numeric_limits<double>::infinity();
  const double sign = at.twice_area > 0 ? 1 : -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const Flat a = at.corners[k], b = at.corners[(k + 1) % 3];
    least = std::min(least, sign * cross(b - a, place - a) / length(b - a));
  }
  return least;
}

Flat nearest_on_border(Flat place, const std::array<Flat, 3>& corners) {
  Flat best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Flat on = nearest_on_segment(place, corners[k], corners[(k + 1) % 3]);
    const double square = dot(on - place, on - place);
    if (!(square < least)) continue;
    least = square;
    best = on;
  }
  return best;
}

}  // namespace

std::array<double, 3> Texels::InTexture::nearest(Flat place) const {
  if (depth_inside(place, *this) < 0) place = nearest_on_border(place, corners);
  const double b = cross(place - corners[0], corners[2] - corners[0]) / twice_area,
               c = cross(corners[1] - corners[0], place - corners[0]) / twice_area;
  return {1 - b - c, b, c};
}

double Texels::InTexture::outside(Flat place) const {
  if (depth_inside(place, *this) >= 0) return 0;
  const Flat way = nearest_on_border(place, corners) - place;
  return dot(way, way);
}

Flat Texels::nearest_tile(Flat place, const InTexture& at) const {
  const double width = options_.width, height = options_.height;
  // The tile around the middle of the triangle, and those beside.
  const Flat middle = {
      place.x + width * std::round(((at.low.x + at.high.x) / 2 - place.x) / width),
      place.y + height * std::round(((at.low.y + at.high.y) / 2 - place.y) / height)};
  Flat best = middle;
  double least = std::numeric_limits<double>::infinity();
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const Flat other = {middle.x + i * width, middle.y + j * height};
      const double outside = at.outside(other);
      if (!(outside < least)) continue;
      least = outside;
      best = other;
    }
  return best;
}

Texels::Texels(const Character& source, std::uint32_t mesh, const FlatFaces& faces,
               const WoundMaskOptions& options)
    : options_(options),
      triangles_(source.meshes[mesh].triangles),
      submesh_of_(source.meshes[mesh].triangle_submesh),
      touches_border_(triangles_.size()) {
  if (options.uv_set == kNone) return;
  for (const Vec2f& uv : source.meshes[mesh].uv_sets[options.uv_set])
    uvs_.emplace_back(options.texture_from_uv * uv.cast<double>().homogeneous());
  owners_.assign(std::size_t{options.width} * options.height, kNone);
  find_borders(faces.surface, mesh);
  own_centres();
  own_near_borders();
}

std::optional<Texels::InTexture> Texels::in_texture(std::uint32_t triangle) const {
  if (uvs_.empty() || !is_wanted(triangle)) return std::nullopt;
  const double width = options_.width, height = options_.height;
  InTexture result;
  result.low = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  result.high = -1.0 * result.low;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2d& uv = uvs_[triangles_[triangle][k]];
    const Flat at = {uv.x() * width - 0.5, uv.y() * height - 0.5};
    result.corners[k] = at;
    result.low = {std::min(result.low.x, at.x), std::min(result.low.y, at.y)};
    result.high = {std::max(result.high.x, at.x), std::max(result.high.y, at.y)};
  }
  const auto& at = result.corners;
  result.twice_area = cross(at[1] - at[0], at[2] - at[0]);
  constexpr double kFarthestTile = 1e6;  // Beyond, floats have no place for texels.
  const double farthest = std::max({std::abs(result.low.x), std::abs(result.low.y),
                                    std::abs(result.high.x), std::abs(result.high.y)});
  const bool fits = result.high.x - result.low.x <= width &&
                    result.high.y - result.low.y <= height &&
                    farthest <= kFarthestTile * std::max(width, height);
  if (!fits || result.twice_area == 0 || !std::isfinite(result.twice_area)) return std::nullopt;
  return result;
}

void Texels::find_borders(const Surface& surface, std::uint32_t mesh) {
  const Index first = surface.first_triangle[mesh], end = surface.first_triangle[mesh + 1];
  const auto uv_at = [&](Index corner) -> const Vec2d& {
    return uvs_[triangles_[corner / 3 - first][corner % 3]];
  };
  for (Index h = 3 * first; h < 3 * end; ++h) {
    const Index twin = surface.twin[h];
    if (twin == kNone || twin / 3 < first || twin / 3 >= end || !is_wanted(twin / 3 - first) ||
        uv_at(h) != uv_at(Surface::next(twin)) || uv_at(Surface::next(h)) != uv_at(twin))
      touches_border_[h / 3 - first] = true;
  }
}

void Texels::own_centres() {
  overlaps_.resize(owners_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const std::optional<InTexture> at = in_texture(t);
    if (!at) {
      if (is_wanted(t)) ++notes_.unpainted_triangles;
      continue;
    }
    for_each_near(*at, 0, [&](Flat place, std::size_t texel) {
      const double depth = depth_inside(place, *at);
      if (depth < 0) return;
      if (owners_[texel] == kNone)
        owners_[texel] = t;
      else if (depth > kClearlyInside)
        overlaps_[texel] = true;
    });
  }
  notes_.overlapping_texels =
      static_cast<std::uint32_t>(std::count(overlaps_.begin(), overlaps_.end(), true));
  if (notes_.overlapping_texels == 0) overlaps_.clear();
}

std::optional<SourcePlace> Texels::place_of(std::uint32_t column, std::uint32_t row) const {
  const std::uint32_t triangle = owners_[std::size_t{row} * options_.width + column];
  if (triangle == kNone) return std::nullopt;
  const InTexture at = *in_texture(triangle);
  const Flat place = nearest_tile({static_cast<double>(column), static_cast<double>(row)}, at);
  return SourcePlace{triangle, at.nearest(place)};
}

bool Texels::lacks_texels(std::uint32_t triangle) const {
  if (uvs_.empty() || !is_wanted(triangle)) return false;
  const std::optional<InTexture> at = in_texture(triangle);
  if (!at) return true;
  if (overlaps_.empty()) return false;
  bool is_any = false;
  for_each_near(*at, 0, [&](Flat place, std::size_t texel) {
    is_any |= overlaps_[texel] && depth_inside(place, *at) > kClearlyInside;
  });
  return is_any;
}

void Texels::own_near_borders() {
  const double most = static_cast<double>(options_.dilation) * options_.dilation;
  std::vector<float> nearest(owners_.size(), std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < owners_.size(); ++i)
    if (owners_[i] != kNone) nearest[i] = -1;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (!touches_border_[t]) continue;
    const std::optional<InTexture> at = in_texture(t);
    if (!at) continue;
    for_each_near(*at, options_.dilation, [&](Flat place, std::size_t texel) {
      if (nearest[texel] < 0) return;
      const Flat way = nearest_on_border(place, at->corners) - place;
      const auto square = static_cast<float>(dot(way, way));
      if (square > most || !(square < nearest[texel])) return;
      nearest[texel] = square;
      owners_[texel] = t;
    });
  }
}

}  // namespace sunder::tear
