#include "tools/render/trace.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <numbers>
#include <thread>
#include <vector>

#include "tools/render/tile.h"

namespace sunder::tools {
namespace {

Vec3f middle_of(const RenderScene& scene) {
  Vec3f least = Vec3f::Constant(std::numeric_limits<float>::max()), greatest = -least;
  for (const RenderTriangle& triangle : scene.triangles)
    for (const Vec3f& corner : triangle.corners) {
      least = least.cwiseMin(corner);
      greatest = greatest.cwiseMax(corner);
    }
  return (least + greatest) / 2;
}

RenderView view_of(const Camera& camera, const PictureSize& size) {
  const Vec3d back = (camera.eye - camera.focal_point).normalized();
  const Vec3d right = camera.up.cross(back).normalized();
  const double slope = std::tan(camera.view_angle_degrees / 2 * std::numbers::pi / 180);
  return {size, camera.eye.cast<float>(), (slope * size.width / size.height * right).cast<float>(),
          (slope * back.cross(right)).cast<float>(), -back.cast<float>()};
}

/// Draws all tiles.
void draw_tiles(const TiledScene& scene, unsigned threads, Picture& picture) {
  const int columns = (picture.width + Tile::kSide - 1) / Tile::kSide,
            rows = (picture.height + Tile::kSide - 1) / Tile::kSide;
  std::atomic<int> next = 0;
  std::mutex guard;
  std::exception_ptr failure;
  const auto draw = [&] {
    try {
      Tile tile(scene);
      for (int i = next++; i < columns * rows; i = next++)
        tile.draw(i % columns * Tile::kSide, i / columns * Tile::kSide, picture);
    } catch (...) {
      const std::lock_guard lock(guard);
      failure = std::current_exception();
      next = columns * rows;
    }
  };
  std::vector<std::thread> others;
  const unsigned most = std::min(threads, static_cast<unsigned>(columns * rows));
  for (unsigned i = 1; i < most; ++i) others.emplace_back(draw);
  draw();
  for (std::thread& thread : others) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

Picture trace(const RenderScene& scene, const Camera& camera, const PictureSize& size,
              unsigned threads) {
  const Lighting lighting(camera);
  const Shading shading(scene, lighting);
  Picture picture{size.width, size.height, {}};
  picture.colors.resize(static_cast<std::size_t>(size.width) *
                        static_cast<std::size_t>(size.height));
  const RenderView view = view_of(camera, size);
  const Coverage coverage(scene, view);
  draw_tiles({scene, lighting, shading, view, coverage, middle_of(scene)},
             threads == 0 ? std::thread::hardware_concurrency() : threads, picture);
  return picture;
}

}  // namespace sunder::tools
