#include "tools/render/tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace sunder::tools {
namespace {

constexpr int kBorder = 2;  ///< Pixels on each side over which light is averaged.
/// Each of 4 x 4 patterns of directions counts the same.
constexpr std::array<float, 5> kWeights = {0.5f, 1, 1, 1, 0.5f};
constexpr int kMostLayers = 8;        ///< Of transparent surfaces.
constexpr float kSameNormal = 0.8f;   ///< Least cosine on one surface.
constexpr float kSamePlane = 3;       ///< Pixels between neighbours, off the plane.
constexpr float kDarkest = 0.62f;     ///< Share of the floor's light that a shadow takes.
constexpr float kLampOnFloor = 0.6f;  ///< Share of the lamp in the light of the floor.
constexpr float kNowhere = 1e30f;

/// Rotated by about 27 degrees, so that steep and flat edges are smooth alike.
const std::array<Vec2d, Tile::kSamples> kPlaces = {
    {{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}}};

/// Linear light as a byte of sRGB.
class ByteOfLight {
 public:
  ByteOfLight() {
    for (std::size_t i = 0; i < bytes_.size(); ++i) {
      const float tone = static_cast<float>(i) / kSteps;
      const float coded =
          tone <= 0.0031308f ? 12.92f * tone : 1.055f * std::pow(tone, 1 / 2.4f) - 0.055f;
      bytes_[i] = static_cast<std::uint8_t>(std::lround(255 * coded));
    }
  }
  std::uint8_t operator()(float linear) const {
    const float tone = std::clamp(linear, 0.0f, 1.0f);
    return bytes_[static_cast<std::size_t>(kSteps * tone + 0.5f)];
  }

 private:
  static constexpr std::size_t kSteps = 1u
                                        << 14u;  ///< A fifth of the least light between two bytes.
  std::array<std::uint8_t, kSteps + 1> bytes_;
};

}  // namespace

float Tile::pixel_size() const {
  return 2 * view_.up.norm() / static_cast<float>(view_.size.height);
}

const Tile::Pixel& Tile::pixel_at(int x, int y) const {
  return pixels_[static_cast<std::size_t>((y - top_) * (right_ - left_) + x - left_)];
}

void Tile::look_through(double offset, int right, int bottom,
                        std::vector<Shading::Glance>& glances) const {
  glances.clear();
  constexpr auto kBundle = static_cast<int>(TriangleTree::kBundle);
  for (int y = top_; y < bottom; ++y)
    for (int x = left_; x < right; x += kBundle) {
      std::array<Vec3f, TriangleTree::kBundle> along;
      std::array<TriangleTree::Hit, TriangleTree::kBundle> hits;
      const int count = std::min(kBundle, right - x);
      bool may_show = false;
      for (int i = 0; i < kBundle; ++i) {
        const int column = x + std::min(i, count - 1);
        along[static_cast<std::size_t>(i)] = view_.along(column + offset, y + offset);
        may_show = may_show || drawn_.coverage.may_show(column, y);
      }
      if (may_show) hits = shading_.find(view_.eye, along);
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        glances.push_back(shading_.glance(hits[i], view_.eye, along[i]));
    }
}

void Tile::find_surfaces() {
  look_through(0, right_ + 1, bottom_ + 1, corners_);
  look_through(0.5, right_, bottom_, middles_);
  pixels_.clear();
  layers_.clear();
  probes_.clear();
  for (int y = top_; y < bottom_; ++y)
    for (int x = left_; x < right_; ++x) {
      Pixel& pixel = pixels_.emplace_back();
      pixel.first_probe = static_cast<std::uint32_t>(probes_.size());
      see(pixel, x, y);
      pixel.layers[kSamples] = static_cast<std::uint32_t>(layers_.size());
    }
}

void Tile::see(Pixel& pixel, int x, int y) {
  const auto width = static_cast<std::size_t>(right_ - left_),
             row = static_cast<std::size_t>(y - top_), column = static_cast<std::size_t>(x - left_);
  const Shading::Glance& middle = middles_[row * width + column];
  const Shading::Glance* const corner = &corners_[row * (width + 1) + column];
  const Shading::Glances glances = {&middle, corner, corner + 1, corner + width + 1,
                                    corner + width + 2};
  const Vec3f along = view_.along(x + 0.5, y + 0.5);
  pixel.layers.fill(static_cast<std::uint32_t>(layers_.size()));
  if (shading_.look_alike(glances, kSamePlane * pixel_size() * middle.hit.distance)) {
    pixel.kind = Kind::even;
    add_layer(pixel, x, y, shading_.surface_at(middle.hit, view_.eye, along), middle.hit.distance);
    return;
  }
  if (std::ranges::all_of(glances, [](const auto* of) { return of->hit.triangle == kNone; })) {
    pixel.kind = Kind::empty;
    see_floor(pixel, x, y, along, 0);
    return;
  }
  see_samples(pixel, x, y);
}

void Tile::see_samples(Pixel& pixel, int x, int y) {
  std::array<Vec3f, kSamples> along;
  for (std::size_t sample = 0; sample < kSamples; ++sample)
    along[sample] = view_.along(x + kPlaces[sample].x(), y + kPlaces[sample].y());
  const std::array<TriangleTree::Hit, kSamples> first = shading_.find(view_.eye, along);
  for (std::size_t sample = 0; sample < kSamples; ++sample) {
    pixel.layers[sample] = static_cast<std::uint32_t>(layers_.size());
    see_sample(pixel, x, y, along[sample], sample, first[sample]);
  }
}

void Tile::add_layer(Pixel& pixel, int x, int y, const Shading::Surface& surface, float distance) {
  const Probe probe{surface.place, surface.smooth, {}, kSamePlane * pixel_size() * distance, false};
  const std::uint32_t index = probe_at(pixel, x, y, probe, surface.start, surface.flat);
  layers_.push_back({surface, index, distance});
}

void Tile::see_sample(Pixel& pixel, int x, int y, const Vec3f& along, std::size_t sample,
                      TriangleTree::Hit hit) {
  for (int i = 0; hit.triangle != kNone; ++i) {
    const Shading::Surface surface = shading_.surface_at(hit, view_.eye, along);
    add_layer(pixel, x, y, surface, hit.distance);
    if (surface.color.w() >= Shading::kOpaque) return;
    if (i + 1 == kMostLayers) break;
    hit = shading_.find(view_.eye, along, hit.distance * 1.00001f);
  }
  see_floor(pixel, x, y, along, sample);
}

void Tile::see_floor(Pixel& pixel, int x, int y, const Vec3f& along, std::size_t sample) {
  if (scene_.floor_radius <= 0 || along.y() >= 0 || view_.eye.y() <= scene_.floor) return;
  const Vec3f place = view_.eye + (scene_.floor - view_.eye.y()) / along.y() * along;
  const Vec3f offset(place.x() - drawn_.middle.x(), 0, place.z() - drawn_.middle.z());
  const float fade = 1 - offset.norm() / scene_.floor_radius;
  if (fade <= 0) return;
  const Vec3f up = Vec3f::UnitY();
  pixel.floor_probe = probe_at(pixel, x, y, {place, up, {}, kNowhere, true}, place, up);
  pixel.floor[sample] = std::min(1.0f, 2 * fade);
}

std::uint32_t Tile::probe_at(Pixel& pixel, int x, int y, const Probe& wanted, const Vec3f& start,
                             const Vec3f& flat) {
  for (std::uint32_t i = 0; i < pixel.probe_count; ++i) {
    const Probe& probe = probes_[pixel.first_probe + i];
    if (probe.is_floor == wanted.is_floor && probe.normal.dot(wanted.normal) > kSameNormal &&
        std::abs(probe.normal.dot(wanted.place - probe.place)) < wanted.reach)
      return pixel.first_probe + i;
  }
  // Further surfaces of a pixel look in other directions than the first one.
  const std::size_t pattern =
      (static_cast<std::size_t>((x & 3) + 4 * (y & 3)) + 5 * pixel.probe_count) %
      Lighting::kPatterns;
  std::span<const Vec3f> sky = lighting_.sky(pattern), lamp = lighting_.lamp(pattern);
  if (wanted.is_floor) {
    sky = sky.first(sky.size() / 2);
  } else if (pixel.kind == Kind::even) {
    // One looks at the sky, the next one at the lamp: the pixels beside it see the same surface, or
    // more than one, and then look at both.
    const bool looks_at_sky = (x + y) % 2 == 0;
    lamp = looks_at_sky ? std::span<const Vec3f>() : lighting_.lamp_pair(pattern);
    if (!looks_at_sky) sky = {};
  }
  Probe& added = probes_.emplace_back(wanted);
  added.light = shading_.light_at(start, wanted.normal, flat, sky, lamp);
  return pixel.first_probe + pixel.probe_count++;
}

Shading::Light Tile::mean_light(const Probe& probe, int x, int y) const {
  Shading::Light sum;
  const int first_x = std::max(x - kBorder, left_), last_x = std::min(x + kBorder, right_ - 1),
            first_y = std::max(y - kBorder, top_), last_y = std::min(y + kBorder, bottom_ - 1);
  for (int row = first_y; row <= last_y; ++row) {
    const float weight_of_row = kWeights[static_cast<std::size_t>(row - y + kBorder)];
    const Pixel* pixel = &pixel_at(first_x, row);
    for (int column = first_x; column <= last_x; ++column, ++pixel) {
      const Probe* other = probes_.data() + pixel->first_probe;
      for (const Probe* const end = other + pixel->probe_count; other != end; ++other)
        if (other->is_floor == probe.is_floor && other->normal.dot(probe.normal) > kSameNormal &&
            std::abs(probe.normal.dot(other->place - probe.place)) < probe.reach)
          sum.add(other->light,
                  weight_of_row * kWeights[static_cast<std::size_t>(column - x + kBorder)]);
    }
  }
  return sum;
}

void Tile::shade(int x, int y, SampledPart& part) {
  const Pixel& pixel = pixel_at(x, y);
  smooth_.clear();
  for (std::uint32_t i = 0; i < pixel.probe_count; ++i)
    smooth_.push_back(mean_light(probes_[pixel.first_probe + i], x, y));
  if (pixel.kind == Kind::mixed) {
    for (std::size_t sample = 0; sample < kSamples; ++sample)
      shade_sample(pixel, x, y, sample, part.colors.emplace_back(), part.depths.emplace_back());
    return;
  }
  Vec3f color;
  float depth = kNowhere;
  if (pixel.kind == Kind::even) {
    const Layer& layer = layers_[pixel.layers[0]];
    color = shading_.shown(layer.look, smooth_[layer.probe - pixel.first_probe],
                           view_.along(x + 0.5, y + 0.5));
    depth = layer.depth;
  } else {
    color = shade_backdrop(pixel, 0, y + 0.5);
  }
  part.colors.insert(part.colors.end(), kSamples, color);
  part.depths.insert(part.depths.end(), kSamples, depth);
}

void Tile::shade_sample(const Pixel& pixel, int x, int y, std::size_t sample, Vec3f& color,
                        float& depth) {
  const double down = y + kPlaces[sample].y();
  const Vec3f along = view_.along(x + kPlaces[sample].x(), down);
  color.setZero();
  depth = kNowhere;
  float left = 1;
  for (std::uint32_t i = pixel.layers[sample]; i < pixel.layers[sample + 1]; ++i) {
    const Layer& layer = layers_[i];
    const float alpha = layer.look.color.w();
    if (alpha >= 0.5f) depth = std::min(depth, layer.depth);
    const Shading::Light& light = smooth_[layer.probe - pixel.first_probe];
    color += left * alpha * shading_.shown(layer.look, light, along);
    left *= 1 - alpha;
  }
  if (left > 0) color += left * shade_backdrop(pixel, sample, down);
}

Vec3f Tile::shade_backdrop(const Pixel& pixel, std::size_t sample, double down) const {
  const Vec3f backdrop = (1 + scene_.backdrop_rise * view_.height(down)) * scene_.backdrop;
  if (!(pixel.floor[sample] > 0)) return backdrop;
  const Shading::Light& light = smooth_[pixel.floor_probe - pixel.first_probe];
  const float lit =
      kLampOnFloor * light.share_of_lamp() + (1 - kLampOnFloor) * light.share_of_sky().y();
  return (1 - pixel.floor[sample] * kDarkest * (1 - lit)) * backdrop;
}

void Tile::draw(int left, int top, Picture& picture) {
  const int right = std::min(left + kSide, view_.size.width),
            bottom = std::min(top + kSide, view_.size.height);
  left_ = std::max(0, left - kBorder);
  top_ = std::max(0, top - kBorder);
  right_ = std::min(view_.size.width, right + kBorder);
  bottom_ = std::min(view_.size.height, bottom + kBorder);
  find_surfaces();
  SampledPart part{left, top, right - left, bottom - top, kPlaces, {}, {}};
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) shade(x, y, part);
  lay_marks(scene_.marks, part);
  static const ByteOfLight as_byte;
  auto color = part.colors.begin();
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      Vec3f sum = Vec3f::Zero();
      for (std::size_t sample = 0; sample < kSamples; ++sample) sum += *color++;
      sum /= static_cast<float>(kSamples);
      picture.colors[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                     static_cast<std::size_t>(x)] = {as_byte(sum.x()), as_byte(sum.y()),
                                                     as_byte(sum.z())};
    }
}

}  // namespace sunder::tools
