#include "tools/render/shading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "tools/render/flesh.h"
#include "tools/render/holed_triangles.h"
#include "tools/render/texture.h"

namespace sunder::tools {
namespace {

constexpr float kEverywhere = 0.13f;  ///< Light that reaches even closed corners.
constexpr float kReflected = 0.56f;
constexpr float kSmooth = 0.995f;  ///< Least cosine of normals that look alike.

std::vector<TriangleTree::Corners> corners_of(const RenderScene& scene) {
  std::vector<TriangleTree::Corners> corners;
  corners.reserve(scene.triangles.size());
  for (const RenderTriangle& triangle : scene.triangles) corners.push_back(triangle.corners);
  return corners;
}

/// The diagonal of a scene.
float size_of(const RenderScene& scene) {
  Vec3f least = Vec3f::Constant(TriangleTree::kFar), greatest = -least;
  for (const RenderTriangle& triangle : scene.triangles)
    for (const Vec3f& corner : triangle.corners) {
      least = least.cwiseMin(corner);
      greatest = greatest.cwiseMax(corner);
    }
  return (greatest - least).norm();
}

/// The shares of the corners of a triangle in a place.
Vec3f shares_of(const std::array<Vec3f, 3>& corners, const Vec3f& place) {
  const Vec3f ab = corners[1] - corners[0], ac = corners[2] - corners[0],
              offset = place - corners[0];
  const float bb = ab.dot(ab), bc = ab.dot(ac), cc = ac.dot(ac);
  const float determinant = bb * cc - bc * bc;
  if (!(determinant > 0)) return {1, 0, 0};
  const float b = (cc * ab.dot(offset) - bc * ac.dot(offset)) / determinant,
              c = (bb * ac.dot(offset) - bc * ab.dot(offset)) / determinant;
  return {1 - b - c, b, c};
}

template <class Values>
auto mean(const Vec3f& shares, const Values& values) {
  return (shares[0] * values[0] + shares[1] * values[1] + shares[2] * values[2]).eval();
}

/// Whether texture coordinates are within a texel of each other.
bool are_within_texel(const Image* image, const Vec2f& a, const Vec2f& b) {
  return image == nullptr || (std::abs(a.x() - b.x()) * static_cast<float>(image->width) < 1 &&
                              std::abs(a.y() - b.y()) * static_cast<float>(image->height) < 1);
}

/// Above 0.7, light is compressed instead of cut.
Vec3f compressed(Vec3f light) {
  for (float& channel : light)
    if (channel > 0.7f) channel = 0.7f + 0.3f * (1 - std::exp(-(channel - 0.7f) / 0.3f));
  return light;
}

}  // namespace

Vec3f Shading::Light::share_of_sky() const {
  Vec3f share;
  for (int i = 0; i < 3; ++i) share[i] = whole_sky[i] > 0 ? sky[i] / whole_sky[i] : 1.0f;
  return share;
}

float Shading::Light::share_of_lamp() const { return whole_lamp > 0 ? lamp / whole_lamp : 1.0f; }

Shading::Shading(const RenderScene& scene, const Lighting& lighting)
    : scene_(scene),
      lighting_(lighting),
      blood_(scene.lips, scene.blood_reach),
      are_holed_(holed_triangles(scene)),
      nearly_nothing_(2e-5f * size_of(scene)),
      tree_(corners_of(scene), holes()) {}

TriangleTree::Holes Shading::holes() const {
  TriangleTree::Holes holes;
  holes.may_be_in = are_holed_;
  holes.lets_pass = [this](Index triangle, const Vec3f& shares, TriangleTree::Ray ray) {
    return lets_pass(triangle, shares, ray);
  };
  return holes;
}

float Shading::alpha_at(const RenderTriangle& triangle, const Vec3f& shares) const {
  const RenderMaterial& material = scene_.materials[triangle.material];
  float alpha = material.factor.w() * mean(shares, triangle.tints).w();
  if (material.image != nullptr)
    alpha *= sampled(*material.image, material, mean(shares, triangle.uvs)).w();
  return alpha;
}

bool Shading::lets_pass(Index index, const Vec3f& shares, TriangleTree::Ray ray) const {
  const RenderTriangle& triangle = scene_.triangles[index];
  const RenderMaterial& material = scene_.materials[triangle.material];
  const float alpha = alpha_at(triangle, shares);
  if (material.alpha == RenderMaterial::Alpha::cut) return alpha < material.cutoff;
  // The shadow of glass would be too dark; a picture needs none.
  return ray == TriangleTree::Ray::shadow ? alpha < 0.5f : alpha <= 0.0f;
}

TriangleTree::Hit Shading::find(const Vec3f& from, const Vec3f& along, float beyond) const {
  return tree_.first_hit(from, along, TriangleTree::kFar, beyond);
}

Vec2f Shading::inner_flesh(const Vec3f& place) const {
  const Vec3f at = place / (600 * nearly_nothing_);
  return {at.x() + 0.5f * at.y(), -1000 - at.z() - 0.5f * at.y()};
}

Shading::Surface Shading::surface_at(const TriangleTree::Hit& hit, const Vec3f& from,
                                     const Vec3f& along) const {
  const RenderTriangle& triangle = scene_.triangles[hit.triangle];
  const RenderMaterial& material = scene_.materials[triangle.material];
  Surface surface;
  surface.place = from + hit.distance * along;
  const Vec3f shares = shares_of(triangle.corners, surface.place);
  const Vec2f uv = mean(shares, triangle.uvs);
  Vec3f flat = (triangle.corners[1] - triangle.corners[0])
                   .cross(triangle.corners[2] - triangle.corners[0])
                   .normalized();
  if (flat.dot(along) > 0) flat = -flat;
  Vec3f normal = mean(shares, triangle.normals);
  if (normal.dot(flat) < 0) normal = -normal;
  surface.flat = flat;
  surface.smooth = normal.norm() > 0 ? Vec3f(normal.normalized()) : flat;
  surface.color = material.factor.cwiseProduct(mean(shares, triangle.tints));
  const bool is_inside =
      triangle.has_flesh_inside &&
      std::ranges::all_of(triangle.normals, [&along](const Vec3f& n) { return n.dot(along) > 0; });
  if (material.is_flesh || is_inside) {
    const Vec2f at_flesh = material.is_flesh ? uv : inner_flesh(surface.place);
    surface.color.head<3>() = flesh_color(at_flesh.x(), at_flesh.y());
    const auto [side, other] = lighting_.across(surface.smooth);
    const float size = 0.35f * normal.norm();
    const float stretch = at_flesh.y() < -1 ? 7.0f : 20.0f;
    normal += size * ((noise(7 * at_flesh.x(), stretch * at_flesh.y()) - 0.5f) * side +
                      (noise(7 * at_flesh.x() + 40, stretch * at_flesh.y()) - 0.5f) * other);
    surface.gloss = 0.20f;
    surface.sharpness = 45;
    surface.color.w() = 1;
  } else {
    surface.is_unlit = material.is_unlit;
    surface.emission = material.emission;
    if (material.image != nullptr)
      surface.color = surface.color.cwiseProduct(sampled(*material.image, material, uv));
    if (material.emission_image != nullptr && surface.emission.maxCoeff() > 0)
      surface.emission =
          surface.emission.cwiseProduct(sampled(*material.emission_image, material, uv).head<3>());
    if (material.is_skin)
      surface.color.head<3>() =
          blood_.bloodied(surface.color.head<3>(), surface.place, mean(shares, triangle.rest));
    if (material.alpha != RenderMaterial::Alpha::blended) surface.color.w() = 1;
    surface.color.w() = std::clamp(surface.color.w(), 0.0f, 1.0f);
  }
  surface.normal = normal.norm() > 0 ? Vec3f(normal.normalized()) : flat;
  surface.start = surface.place + nearly_nothing_ * flat;
  return surface;
}

Shading::Glance Shading::glance(const TriangleTree::Hit& hit, const Vec3f& from,
                                const Vec3f& along) const {
  Glance glance;
  glance.hit = hit;
  if (hit.triangle == kNone) return glance;
  const RenderTriangle& triangle = scene_.triangles[hit.triangle];
  const RenderMaterial& material = scene_.materials[triangle.material];
  glance.place = from + hit.distance * along;
  const Vec3f shares = shares_of(triangle.corners, glance.place);
  glance.normal = mean(shares, triangle.normals).normalized();
  glance.uv = mean(shares, triangle.uvs);
  glance.stands_alone = material.is_flesh || triangle.has_flesh_inside ||
                        (material.alpha == RenderMaterial::Alpha::blended &&
                         are_holed_[hit.triangle] && alpha_at(triangle, shares) < kOpaque);
  return glance;
}

bool Shading::look_alike(const Glances& glances, float reach) const {
  const Glance& first = *glances[0];
  if (first.hit.triangle == kNone) return false;
  const Index index = scene_.triangles[first.hit.triangle].material;
  const RenderMaterial& material = scene_.materials[index];
  return std::ranges::all_of(glances, [&](const Glance* other) {
    return other->hit.triangle != kNone && !other->stands_alone &&
           scene_.triangles[other->hit.triangle].material == index &&
           first.normal.dot(other->normal) > kSmooth &&
           std::abs(first.normal.dot(other->place - first.place)) < reach &&
           are_within_texel(material.image, first.uv, other->uv) &&
           are_within_texel(material.emission_image, first.uv, other->uv);
  });
}

Shading::Light Shading::light_at(const Vec3f& start, const Vec3f& normal, const Vec3f& flat,
                                 std::span<const Vec3f> sky, std::span<const Vec3f> lamp) const {
  Light light;
  const auto [side, other] = lighting_.across(normal);
  static_assert(Lighting::kSkyRays <= kMostDirections &&
                2 * Lighting::kLampRays <= kMostDirections);
  std::array<Vec3f, 2 * kMostDirections> towards, colors;
  std::size_t count = 0;
  // Directions below the triangle say nothing: there, a smooth normal differs from its own.
  for (const Vec3f& local : sky) {
    const Vec3f direction = local.x() * side + local.y() * other + local.z() * normal;
    if (flat.dot(direction) <= 0) continue;
    colors[count] = Lighting::sky_color(direction);
    light.whole_sky += colors[count];
    towards[count++] = direction;
  }
  const std::size_t of_sky = count;
  for (const Vec3f& direction : lamp) {
    if (flat.dot(direction) <= 0 || normal.dot(direction) <= 0) continue;
    light.whole_lamp += 1;
    towards[count++] = direction;
  }
  const std::span rays = std::span(towards).first(count);
  for (std::size_t first = 0; first < count; first += TriangleTree::kBundle) {
    const auto bundle = rays.subspan(first, std::min(TriangleTree::kBundle, count - first));
    const auto blocked = tree_.are_blocked(start, bundle);
    for (std::size_t i = 0; i < bundle.size(); ++i)
      if (blocked[i])
        continue;
      else if (first + i < of_sky)
        light.sky += colors[first + i];
      else
        light.lamp += 1;
  }
  return light;
}

Vec3f Shading::shown(const Look& look, const Light& light, const Vec3f& along) const {
  const Vec3f color = look.color.head<3>();
  if (look.is_unlit) return color.cwiseMin(1.0f);
  const Vec3f towards_eye = -along.normalized();
  Vec3f diffuse = Vec3f::Constant(kEverywhere), mirrored = Vec3f::Zero();
  const auto add = [&](const Lighting::Light& from, float share) {
    const float facing = look.normal.dot(from.towards);
    if (facing <= 0 || share <= 0) return;
    diffuse += share * facing * from.intensity;
    const float half = look.normal.dot((from.towards + towards_eye).normalized());
    if (half > 0) mirrored += share * std::pow(half, look.sharpness) * from.intensity;
  };
  add(lighting_.middle_of_lamp(), light.share_of_lamp());
  add(lighting_.fill(), 1);
  diffuse += light.share_of_sky().cwiseProduct(Lighting::sky_light(look.normal));
  return compressed(kReflected * color.cwiseProduct(diffuse) + look.gloss * mirrored +
                    look.emission);
}

}  // namespace sunder::tools
