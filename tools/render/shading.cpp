#include "tools/render/shading.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/render/flesh.h"

namespace sunder::tools {
namespace {

constexpr float kEverywhere = 0.13f;  ///< Light that reaches even closed corners.
constexpr float kFar = std::numeric_limits<float>::max() / 4;

std::vector<TriangleTree::Corners> corners_of(const RenderScene& scene, bool only_opaque) {
  std::vector<TriangleTree::Corners> corners;
  for (const RenderTriangle& triangle : scene.triangles)
    if (!only_opaque || scene.materials[triangle.material].factor.w() > 0.5f)
      corners.push_back(triangle.corners);
  return corners;
}

int wrapped(int index, int count, RenderMaterial::Wrap wrap) {
  if (wrap == RenderMaterial::Wrap::clamp) return std::clamp(index, 0, count - 1);
  const int period = wrap == RenderMaterial::Wrap::mirror ? 2 * count : count;
  index %= period;
  if (index < 0) index += period;
  return index < count ? index : period - 1 - index;
}

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

/// The bilinear mean of the four pixels around a place.
Vec4f sampled(const RenderMaterial& material, const Vec2f& uv) {
  const Image& image = *material.image;
  const auto fold = [](float value) {
    return std::isfinite(value) ? std::fmod(value, 2.0f) : 0.0f;
  };
  const bool clamps_u = material.wrap[0] == RenderMaterial::Wrap::clamp,
             clamps_v = material.wrap[1] == RenderMaterial::Wrap::clamp;
  const float u = clamps_u ? std::clamp(uv.x(), 0.0f, 1.0f) : fold(uv.x()),
              v = clamps_v ? std::clamp(uv.y(), 0.0f, 1.0f) : fold(uv.y());
  const float x = u * static_cast<float>(image.width) - 0.5f,
              y = v * static_cast<float>(image.height) - 0.5f;
  const float left = std::floor(x), top = std::floor(y);
  Vec4f sum = Vec4f::Zero();
  for (int i = 0; i < 4; ++i) {
    const int column = wrapped(static_cast<int>(left) + (i & 1), image.width, material.wrap[0]);
    const int row = wrapped(static_cast<int>(top) + (i >> 1), image.height, material.wrap[1]);
    const std::uint8_t* const pixel =
        &image.rgba[std::size_t{4} * static_cast<std::size_t>(row * image.width + column)];
    const float weight =
        ((i & 1) != 0 ? x - left : 1 - (x - left)) * ((i >> 1) != 0 ? y - top : 1 - (y - top));
    const auto& linear = linear_from_srgb();
    sum += weight * Vec4f(linear[pixel[0]], linear[pixel[1]], linear[pixel[2]],
                          static_cast<float>(pixel[3]) / 255);
  }
  return sum;
}

/// Of a place, in a triangle.
Vec3f barycentric(const std::array<Vec3f, 3>& corners, const Vec3f& place) {
  const Vec3f ab = corners[1] - corners[0], ac = corners[2] - corners[0],
              offset = place - corners[0];
  const float bb = ab.dot(ab), bc = ab.dot(ac), cc = ac.dot(ac);
  const float determinant = bb * cc - bc * bc;
  if (!(determinant > 0)) return {1, 0, 0};
  const float b = (cc * ab.dot(offset) - bc * ac.dot(offset)) / determinant,
              c = (bb * ac.dot(offset) - bc * ab.dot(offset)) / determinant;
  return {1 - b - c, b, c};
}

float squared_distance(const std::array<Vec3f, 2>& segment, const Vec3f& place) {
  const Vec3f along = segment[1] - segment[0], offset = place - segment[0];
  const float length = along.squaredNorm();
  const float t = length > 0 ? std::clamp(along.dot(offset) / length, 0.0f, 1.0f) : 0.0f;
  return (offset - t * along).squaredNorm();
}

}  // namespace

struct Shading::Surface {
  Vec4f color;
  Vec3f normal, start;  ///< Towards the eye; where rays begin.
  float gloss = 0.035f, sharpness = 18;
};

Shading::Shading(const RenderScene& scene, const Lighting& lighting)
    : scene_(scene),
      lighting_(lighting),
      all_(corners_of(scene, false)),
      opaque_(corners_of(scene, true)) {
  Vec3f least = Vec3f::Constant(kFar), greatest = -least;
  for (const RenderTriangle& triangle : scene.triangles)
    for (const Vec3f& corner : triangle.corners) {
      least = least.cwiseMin(corner);
      greatest = greatest.cwiseMax(corner);
    }
  nearly_nothing_ = 2e-5f * (greatest - least).norm();
  least_lip_ = Vec3f::Constant(kFar);
  greatest_lip_ = -least_lip_;
  for (const auto& segment : scene.lips)
    for (const Vec3f& end : segment) {
      least_lip_ = least_lip_.cwiseMin(end);
      greatest_lip_ = greatest_lip_.cwiseMax(end);
    }
}

Shading::Hit Shading::find(const Vec3f& from, const Vec3f& along) const {
  const TriangleTree::Hit hit = all_.first_hit(from, along, kFar);
  return {hit.triangle, hit.distance, from + hit.distance * along};
}

Vec3f Shading::reddened(const Vec3f& color, const Vec3f& place) const {
  const float reach = scene_.redness;
  if (reach <= 0 || ((place - least_lip_).array() < -2 * reach).any() ||
      ((place - greatest_lip_).array() > 2 * reach).any())
    return color;
  float nearest = kFar;
  for (const auto& segment : scene_.lips)
    nearest = std::min(nearest, squared_distance(segment, place));
  const float share = 0.55f * std::exp(-nearest / (reach * reach));
  const Vec3f red = (0.35f * color + 0.25f * color.norm() * Vec3f(0.9f, 0.16f, 0.13f));
  return color + share * (red - color);
}

Vec2f Shading::inner_flesh(const Vec3f& place) const {
  const Vec3f at = place / (600 * nearly_nothing_);
  return {at.x() + 0.5f * at.y(), -1000 - at.z() - 0.5f * at.y()};
}

Shading::Surface Shading::surface_at(const Hit& hit, const Vec3f& along) const {
  const RenderTriangle& triangle = scene_.triangles[hit.triangle];
  const RenderMaterial& material = scene_.materials[triangle.material];
  const Vec3f at = barycentric(triangle.corners, hit.place);
  const auto mean = [&at](const auto& values) {
    return (at[0] * values[0] + at[1] * values[1] + at[2] * values[2]).eval();
  };
  const Vec2f uv = mean(triangle.uvs);
  Surface surface;
  Vec3f flat = (triangle.corners[1] - triangle.corners[0])
                   .cross(triangle.corners[2] - triangle.corners[0])
                   .normalized();
  if (flat.dot(along) > 0) flat = -flat;
  Vec3f normal = mean(triangle.normals);
  if (normal.dot(flat) < 0) normal = -normal;
  surface.color = material.factor.cwiseProduct(mean(triangle.tints));
  const bool is_inside =
      triangle.has_flesh_inside &&
      std::ranges::all_of(triangle.normals, [&along](const Vec3f& n) { return n.dot(along) > 0; });
  if (material.is_flesh || is_inside) {
    const Vec2f at_flesh = material.is_flesh ? uv : inner_flesh(hit.place);
    surface.color.head<3>() = flesh_color(at_flesh.x(), at_flesh.y());
    const Vec3f side = normal.unitOrthogonal(), other = normal.cross(side);
    const float size = 0.35f * normal.norm();
    const float stretch = at_flesh.y() < -1 ? 7.0f : 20.0f;
    normal += size * ((noise(7 * at_flesh.x(), stretch * at_flesh.y()) - 0.5f) * side +
                      (noise(7 * at_flesh.x() + 40, stretch * at_flesh.y()) - 0.5f) * other);
    surface.gloss = 0.20f;
    surface.sharpness = 45;
    if (!material.is_flesh) surface.color.w() = 1;
  } else if (material.image != nullptr) {
    surface.color = surface.color.cwiseProduct(sampled(material, uv));
  }
  if (material.is_skin && !is_inside)
    surface.color.head<3>() = reddened(surface.color.head<3>(), hit.place);
  if (material.cutoff > 0) surface.color.w() = surface.color.w() < material.cutoff ? 0.0f : 1.0f;
  surface.color.w() = std::clamp(surface.color.w(), 0.0f, 1.0f);
  surface.normal = normal.norm() > 0 ? Vec3f(normal.normalized()) : flat;
  surface.start = hit.place + nearly_nothing_ * flat;
  return surface;
}

Vec4f Shading::shade(const Hit& hit, const Vec3f& along, std::size_t sample) const {
  const Surface surface = surface_at(hit, along);
  Vec4f result = surface.color;
  if (result.w() <= 0) return result;
  const Vec3f towards_eye = -along.normalized();
  Vec3f diffuse = Vec3f::Constant(kEverywhere), mirrored = Vec3f::Zero();
  const auto add = [&](const Lighting::Light& light, bool has_shadow) {
    const float facing = surface.normal.dot(light.towards);
    if (facing <= 0) return;
    if (has_shadow && opaque_.is_blocked(surface.start, light.towards, kFar)) return;
    diffuse += facing * light.intensity;
    const float half = surface.normal.dot((light.towards + towards_eye).normalized());
    if (half > 0) mirrored += std::pow(half, surface.sharpness) * light.intensity;
  };
  for (const Lighting::Light& light : lighting_.lamp(sample)) add(light, true);
  add(lighting_.fill(), false);
  for (const Lighting::Light& light : lighting_.sky(sample)) {
    const float facing = surface.normal.dot(light.towards);
    if (facing <= 0 || opaque_.is_blocked(surface.start, light.towards, kFar)) continue;
    diffuse += 0.5f * facing * light.intensity;
  }
  result.head<3>() =
      0.56f * surface.color.head<3>().cwiseProduct(diffuse) + surface.gloss * mirrored;
  return result;
}

float Shading::light_on_floor(const Vec3f& place) const {
  float lit = 0, all = 0;
  const auto add = [&](const Lighting::Light& light) {
    if (light.towards.y() <= 0) return;
    const float brightness = light.towards.y() * light.intensity.y();
    all += brightness;
    if (!opaque_.is_blocked(place, light.towards, kFar)) lit += brightness;
  };
  for (std::size_t sample = 0; sample < Lighting::kSamples; ++sample) {
    for (const Lighting::Light& light : lighting_.lamp(sample)) add(light);
    for (const Lighting::Light& light : lighting_.sky(sample)) add(light);
  }
  return all > 0 ? lit / all : 1.0f;
}

}  // namespace sunder::tools
