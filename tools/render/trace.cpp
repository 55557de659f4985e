#include "tools/render/trace.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

#include "tools/render/lighting.h"
#include "tools/render/shading.h"

namespace sunder::tools {
namespace {

const Vec3f kBackdrop(0.62f, 0.65f, 0.69f);  ///< Linear.
constexpr float kDarkest = 0.62f;            ///< Share of the floor's light that a shadow takes.
constexpr int kPixelsOfCell = 5;             ///< Where the light of the floor is measured.
constexpr int kMostLayers = 8;               ///< Of transparent surfaces.

/// Rotated by about 27 degrees, so that steep and flat edges are smooth alike.
constexpr std::array<std::array<double, 2>, Lighting::kSamples> kPlaces = {
    {{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}}};

std::uint8_t as_byte(float linear) {
  // Above 0.7, light is compressed instead of cut.
  const float bright = 0.7f + 0.3f * (1 - std::exp(-(linear - 0.7f) / 0.3f));
  const float tone = std::clamp(linear < 0.7f ? linear : bright, 0.0f, 1.0f);
  const float coded =
      tone <= 0.0031308f ? 12.92f * tone : 1.055f * std::pow(tone, 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255 * coded));
}

class Tracer {
 public:
  Tracer(const RenderScene& scene, const Camera& camera, const PictureSize& size)
      : scene_(scene), lighting_(camera), shading_(scene, lighting_), size_(size) {
    eye_ = camera.eye.cast<float>();
    const Vec3d back = (camera.eye - camera.focal_point).normalized();
    const Vec3d right = camera.up.cross(back).normalized();
    const double slope = std::tan(camera.view_angle_degrees / 2 * std::numbers::pi / 180);
    right_ = (slope * size.width / size.height * right).cast<float>();
    up_ = (slope * back.cross(right)).cast<float>();
    forward_ = -back.cast<float>();
    Vec3f least = Vec3f::Constant(std::numeric_limits<float>::max()), greatest = -least;
    for (const RenderTriangle& triangle : scene.triangles)
      for (const Vec3f& corner : triangle.corners) {
        least = least.cwiseMin(corner);
        greatest = greatest.cwiseMax(corner);
      }
    middle_ = (least + greatest) / 2;
    cells_ = size.width / kPixelsOfCell + 1;
    if (scene.floor_radius > 0)
      floor_.assign(static_cast<std::size_t>(cells_ + 1) * static_cast<std::size_t>(cells_ + 1), 1);
  }

  /// Places along a side of the floor where its light is measured; a row of them before pixels.
  [[nodiscard]] int floor_rows() const { return scene_.floor_radius > 0 ? cells_ + 1 : 0; }
  void light_floor(int row) {
    for (int column = 0; column <= cells_; ++column) {
      const Vec2f offset =
          scene_.floor_radius * (2.0f * Vec2f(static_cast<float>(column), static_cast<float>(row)) /
                                     static_cast<float>(cells_) -
                                 Vec2f(1, 1));
      if (offset.norm() > 1.1f * scene_.floor_radius) continue;
      float& light = floor_[static_cast<std::size_t>(row * (cells_ + 1) + column)];
      light = shading_.light_on_floor(
          {middle_.x() + offset.x(), scene_.floor, middle_.z() + offset.y()});
    }
  }

  [[nodiscard]] Picture::Color pixel(int x, int y) const {
    Vec3f sum = Vec3f::Zero();
    for (std::size_t sample = 0; sample < kPlaces.size(); ++sample) {
      const double right = 2 * (x + kPlaces[sample][0]) / size_.width - 1,
                   up = 1 - 2 * (y + kPlaces[sample][1]) / size_.height;
      sum += radiance(forward_ + static_cast<float>(right) * right_ + static_cast<float>(up) * up_,
                      static_cast<float>(up), sample);
    }
    sum /= static_cast<float>(kPlaces.size());
    return {as_byte(sum.x()), as_byte(sum.y()), as_byte(sum.z())};
  }

 private:
  /// Light from one direction; `height` is that in the picture, -1 to 1.
  [[nodiscard]] Vec3f radiance(const Vec3f& along, float height, std::size_t sample) const {
    Vec3f sum = Vec3f::Zero();
    float left = 1, from = 0;
    for (int layer = 0; layer < kMostLayers && left > 0.01f; ++layer) {
      const Shading::Hit hit = shading_.find(eye_ + from * along, along);
      if (hit.triangle == kNone) break;
      const Vec4f shaded = shading_.shade(hit, along, sample);
      sum += left * shaded.w() * shaded.head<3>();
      left *= 1 - shaded.w();
      from += hit.distance * 1.00001f;
    }
    return left > 0.01f ? Vec3f(sum + left * background(along, height)) : sum;
  }

  [[nodiscard]] Vec3f background(const Vec3f& along, float height) const {
    const Vec3f backdrop = (1 + 0.08f * height) * kBackdrop;
    if (scene_.floor_radius <= 0 || along.y() >= 0 || eye_.y() <= scene_.floor) return backdrop;
    const Vec3f place = eye_ + (scene_.floor - eye_.y()) / along.y() * along;
    const Vec2f offset(place.x() - middle_.x(), place.z() - middle_.z());
    const float fade = 1 - offset.norm() / scene_.floor_radius;
    if (fade <= 0) return backdrop;
    return (1 - std::min(1.0f, 2 * fade) * kDarkest * (1 - floor_light(offset))) * backdrop;
  }

  /// Light on the floor, between the four nearest places where it is known.
  [[nodiscard]] float floor_light(const Vec2f& offset) const {
    const Vec2f at =
        (offset / scene_.floor_radius + Vec2f(1, 1)) * (0.5f * static_cast<float>(cells_));
    const int column = std::clamp(static_cast<int>(at.x()), 0, cells_ - 1),
              row = std::clamp(static_cast<int>(at.y()), 0, cells_ - 1);
    const float u = at.x() - static_cast<float>(column), v = at.y() - static_cast<float>(row);
    const auto light = [this](int x, int y) {
      return floor_[static_cast<std::size_t>(y * (cells_ + 1) + x)];
    };
    return (1 - v) * ((1 - u) * light(column, row) + u * light(column + 1, row)) +
           v * ((1 - u) * light(column, row + 1) + u * light(column + 1, row + 1));
  }

  const RenderScene& scene_;
  Lighting lighting_;
  Shading shading_;
  PictureSize size_;
  Vec3f eye_, right_, up_, forward_, middle_;
  int cells_ = 1;  ///< Along a side of the square around the floor.
  std::vector<float> floor_;
};

/// Calls draw(row) for all rows, on all threads.
template <class Draw>
void for_each_row(int rows, const Draw& draw) {
  std::atomic<int> next = 0;
  const auto draw_rows = [&] {
    for (int row = next++; row < rows; row = next++) draw(row);
  };
  std::vector<std::thread> others;
  for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) others.emplace_back(draw_rows);
  draw_rows();
  for (std::thread& thread : others) thread.join();
}

}  // namespace

Picture trace(const RenderScene& scene, const Camera& camera, const PictureSize& size) {
  Tracer tracer(scene, camera, size);
  for_each_row(tracer.floor_rows(), [&tracer](int row) { tracer.light_floor(row); });
  Picture picture{size.width, size.height, {}};
  picture.colors.resize(static_cast<std::size_t>(size.width) *
                        static_cast<std::size_t>(size.height));
  for_each_row(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x)
      picture.colors[static_cast<std::size_t>(y * size.width + x)] = tracer.pixel(x, y);
  });
  return picture;
}

}  // namespace sunder::tools
