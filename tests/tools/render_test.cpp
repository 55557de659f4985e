// The renderer of the command's pictures: tools/render.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <jpeglib.h>
#include <limits>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/temporary_folder.h"
#include "tools/render/holed_triangles.h"
#include "tools/render/image.h"
#include "tools/render/lighting.h"
#include "tools/render/lip_blood.h"
#include "tools/render/palette.h"
#include "tools/render/png_file.h"
#include "tools/render/texture.h"
#include "tools/render/trace.h"
#include "tools/render/triangle_tree.h"

namespace sunder::tools {
namespace {

/// Colours that change smoothly, so that a JPEG holds them.
Picture gradient(int width, int height, int offset = 0) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture.colors.push_back({static_cast<std::uint8_t>((4 * x + offset) & 255),
                                static_cast<std::uint8_t>(3 * y), static_cast<std::uint8_t>(80)});
  return picture;
}

/// @param scans  of a progressive file; empty: one for all.
std::vector<std::byte> as_jpeg(const Picture& picture,
                               const std::vector<jpeg_scan_info>& scans = {}) {
  jpeg_compress_struct jpeg = {};
  jpeg_error_mgr errors = {};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* memory = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &memory, &size);
  jpeg.image_width = static_cast<JDIMENSION>(picture.width);
  jpeg.image_height = static_cast<JDIMENSION>(picture.height);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg.scan_info = scans.empty() ? nullptr : scans.data();
  jpeg.num_scans = static_cast<int>(scans.size());
  jpeg_start_compress(&jpeg, TRUE);
  for (int y = 0; y < picture.height; ++y) {
    auto row = picture.colors;
    JSAMPROW rows[] = {row[static_cast<std::size_t>(y * picture.width)].data()};
    jpeg_write_scanlines(&jpeg, rows, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), memory, size);
  jpeg_destroy_compress(&jpeg);
  std::free(memory);
  return bytes;
}

void expect_pixels(const Image& image, const Picture& picture, int tolerance) {
  ASSERT_EQ(image.width, picture.width);
  ASSERT_EQ(image.height, picture.height);
  for (std::size_t i = 0; i < picture.colors.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(image.rgba[4 * i + c], picture.colors[i][c], tolerance) << i;
}

TEST(Image, a_written_png_is_read_again) {
  const test::TemporaryFolder folder;
  const Picture picture = gradient(37, 21);
  ASSERT_TRUE(write_png(folder.path() / "a.png", picture));
  const auto image = decode_image(test::read_bytes(folder.path() / "a.png"));
  ASSERT_TRUE(image) << image.error().text();
  expect_pixels(*image, picture, 0);
}

TEST(Image, a_jpeg_is_read) {
  const Picture picture = gradient(40, 24);
  const auto image = decode_image(as_jpeg(picture));
  ASSERT_TRUE(image) << image.error().text();
  expect_pixels(*image, picture, 14);
}

TEST(Image, a_file_that_promises_too_many_pixels_is_refused_before_they_are_read) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder.path() / "a.png", gradient(64, 64)));
  const std::vector<std::byte> png = test::read_bytes(folder.path() / "a.png");
  const std::vector<std::byte> jpeg = as_jpeg(gradient(64, 64));
  for (const std::vector<std::byte>& file : {png, jpeg}) {
    EXPECT_TRUE(decode_image(file, 64 * 64));
    EXPECT_EQ(decode_image(file, 64 * 64 - 1).error().code(), StatusCode::limit_exceeded);
  }
  std::vector<std::byte> huge = png;
  for (const std::size_t at : {16u, 20u}) huge[at + 1] = std::byte{0x0f};  // 983,104 each way
  EXPECT_FALSE(decode_image(huge));
}

/// Each scan is a pass over all pixels.
TEST(Image, a_progressive_jpeg_may_have_as_many_scans_as_programs_write) {
  const auto file = [](int bands) {
    std::vector<jpeg_scan_info> scans = {{3, {0, 1, 2, 0}, 0, 0, 0, 0}};
    for (int component = 0; component < 3; ++component)
      for (int band = 0; band < bands; ++band) {
        const int first = 1 + band * 63 / bands, last = (band + 1) * 63 / bands;
        scans.push_back({1, {component, 0, 0, 0}, first, last, 0, 0});
      }
    return as_jpeg(gradient(40, 24), scans);
  };
  const auto image = decode_image(file(7));
  ASSERT_TRUE(image) << image.error().text();
  expect_pixels(*image, gradient(40, 24), 14);
  const auto refused = decode_image(file(63));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code(), StatusCode::malformed_file);
  EXPECT_NE(std::string(refused.error().text()).find("more than 64 scans"), std::string::npos);
}

TEST(Image, damaged_files_are_refused_or_read_in_part) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_png(folder.path() / "a.png", gradient(64, 64)));
  test::Random random(7);
  for (const std::vector<std::byte>& whole :
       {test::read_bytes(folder.path() / "a.png"), as_jpeg(gradient(64, 64))})
    for (int i = 0; i < 300; ++i) {
      std::vector<std::byte> bytes = whole;
      for (int k = 0; k < 4; ++k)
        bytes[3 +
              static_cast<std::size_t>(random.uniform(0, static_cast<double>(bytes.size() - 4)))] =
            static_cast<std::byte>(random.uniform(0, 255));
      if (i % 3 == 0) bytes.resize(bytes.size() / 2);
      const auto image = decode_image(bytes);
      if (image) {
        EXPECT_EQ(image->rgba.size(), std::size_t{4} * static_cast<std::size_t>(image->width) *
                                          static_cast<std::size_t>(image->height));
      }
    }
  EXPECT_EQ(decode_image({}).error().code(), StatusCode::unsupported_format);
}

TEST(AnimatedPng, programs_that_know_plain_png_show_the_first_picture) {
  const test::TemporaryFolder folder;
  const std::vector<Picture> pictures = {gradient(32, 20), gradient(32, 20, 60),
                                         gradient(32, 20, 60), gradient(32, 20)};
  const auto file = folder.path() / "a.png";
  ASSERT_TRUE(write_animated_png(file, pictures, 80));
  const std::vector<std::byte> bytes = test::read_bytes(file);
  const auto image = decode_image(bytes);
  ASSERT_TRUE(image) << image.error().text();
  expect_pixels(*image, pictures[0], 6);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto count = [&](const std::string& kind) {
    std::size_t found = 0;
    for (std::size_t at = text.find(kind); at != std::string::npos; at = text.find(kind, at + 1))
      ++found;
    return found;
  };
  EXPECT_EQ(count("acTL"), 1u);
  EXPECT_EQ(count("fcTL"), 4u);
  EXPECT_EQ(count("fdAT"), 3u);
}

TEST(Palette, few_colours_are_kept) {
  const Picture picture = gradient(12, 12);  // 144 colours
  const Palette palette(std::span(&picture, 1));
  for (const Picture::Color& color : picture.colors)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(palette.colors()[palette.at(color)][c], color[c], 3);
}

/// Where a ray meets the plane of a triangle, and the least share of a corner there.
struct Meeting {
  float distance = 0, inside = -1;
};
Meeting meet(const TriangleTree::Corners& triangle, const Vec3f& from, const Vec3f& along) {
  const Vec3d a = triangle[0].cast<double>(), ab = triangle[1].cast<double>() - a,
              ac = triangle[2].cast<double>() - a;
  Eigen::Matrix3d system;
  system << ab, ac, -along.cast<double>();
  const Vec3d found = system.fullPivLu().solve(from.cast<double>() - a);
  return {static_cast<float>(found[2]),
          static_cast<float>(std::min({found[0], found[1], 1 - found[0] - found[1]}))};
}

/// In the box from -1 to 1.
Vec3f place_in_box(test::Random& random) {
  return Vec3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).cast<float>();
}

TEST(TriangleTree, finds_what_a_search_of_all_triangles_finds) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    const auto place = [&] { return place_in_box(random); };
    std::vector<TriangleTree::Corners> triangles;
    for (std::uint32_t i = 0; i < 40 * seed; ++i) {
      const Vec3f a = place();
      triangles.push_back({a, Vec3f(a + 0.3f * place()), Vec3f(a + 0.3f * place())});
    }
    const TriangleTree tree(triangles);
    for (int ray = 0; ray < 60; ++ray) {
      const Vec3f from = 2 * place(), along = place() - from;
      float nearest = 5;
      bool is_near_an_edge = false;
      for (const TriangleTree::Corners& triangle : triangles) {
        const Meeting met = meet(triangle, from, along);
        is_near_an_edge = is_near_an_edge || std::abs(met.inside) < 1e-4f;
        if (met.inside > 0 && met.distance > 0) nearest = std::min(nearest, met.distance);
      }
      if (is_near_an_edge) continue;
      const TriangleTree::Hit hit = tree.first_hit(from, along, 5);
      EXPECT_EQ(hit.triangle == kNone, nearest == 5);
      EXPECT_NEAR(hit.distance, nearest, 1e-4f * nearest);
      EXPECT_EQ(tree.is_blocked(from, along, 5), nearest < 5);
      if (hit.triangle == kNone) continue;
      const float beyond = 1.001f * hit.distance;
      EXPECT_GT(tree.first_hit(from, along, 5, beyond).distance, hit.distance);
    }
  }
}

TEST(TriangleTree, bundles_find_what_single_rays_find) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    test::Random random(seed);
    const auto place = [&] { return place_in_box(random); };
    std::vector<TriangleTree::Corners> triangles;
    std::vector<bool> has_hole;
    for (std::uint32_t i = 0; i < 20 * seed; ++i) {
      const Vec3f a = place();
      triangles.push_back({a, Vec3f(a + 0.5f * place()), Vec3f(a + 0.5f * place())});
      has_hole.push_back(random.index(3) == 0);
    }
    const TriangleTree tree(triangles,
                            {has_hole, [](Index, const Vec3f& shares, TriangleTree::Ray) {
                               return shares.maxCoeff() < 0.5f;
                             }});
    for (int i = 0; i < 100; ++i) {
      const Vec3f from = 2 * place();
      std::array<Vec3f, TriangleTree::kBundle> along;
      for (Vec3f& ray : along) ray = place() - from;
      if (i % 10 == 0) along[2] = Vec3f::Constant(std::numeric_limits<float>::infinity());
      const auto hits = tree.first_hits(from, along);
      const std::size_t count = 1 + random.index(TriangleTree::kBundle);
      const auto blocked = tree.are_blocked(from, std::span(along).first(count));
      for (std::size_t k = 0; k < along.size(); ++k) {
        const TriangleTree::Hit single = tree.first_hit(from, along[k]);
        EXPECT_EQ(hits[k].triangle, single.triangle);
        EXPECT_NEAR(hits[k].distance, single.triangle == kNone ? 0 : single.distance, 1e-5f);
        EXPECT_EQ(blocked[k], k < count && tree.is_blocked(from, along[k]));
      }
    }
  }
}

TEST(Lighting, directions_across_a_normal_turn_smoothly_with_it) {
  test::Random random(5);
  const Lighting lighting({{1, 2, 4}, {0.2, 0.1, 0}, {0, 1, 0}, 30});
  const Vec3f back = Vec3f(0.8f, 1.9f, 4.0f).normalized();
  for (int i = 0; i < 2000; ++i) {
    const Vec3f normal = random.direction().cast<float>();
    if (normal.dot(back) < -0.5f) continue;
    const auto [side, other] = lighting.across(normal);
    EXPECT_NEAR(side.norm(), 1, 1e-4f);
    EXPECT_NEAR(other.norm(), 1, 1e-4f);
    EXPECT_LT((side.cross(other) - normal).norm(), 1e-4f);
    const Vec3f beside = (normal + 1e-3f * random.direction().cast<float>()).normalized();
    const auto [side_beside, other_beside] = lighting.across(beside);
    EXPECT_LT((side - side_beside).norm() + (other - other_beside).norm(), 1e-2f);
  }
}

/// Embree aborts at such rays; a model with places at 1e12 metres leads to them.
TEST(TriangleTree, rays_beyond_the_numbers_of_embree_meet_nothing) {
  const std::vector<TriangleTree::Corners> triangles = {
      {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}};
  const TriangleTree tree(triangles);
  const Vec3f from(0.2f, 0.2f, 1), along(0, 0, -1);
  ASSERT_EQ(tree.first_hit(from, along).triangle, 0u);
  for (const float odd :
       {1e30f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    const Vec3f beyond(0, 0, odd);
    EXPECT_EQ(tree.first_hit(beyond, along).triangle, kNone);
    EXPECT_EQ(tree.first_hit(from, beyond).triangle, kNone);
    EXPECT_FALSE(tree.is_blocked(beyond, along));
    EXPECT_FALSE(tree.is_blocked(from, beyond));
  }
}

TEST(TriangleTree, rays_pass_holes_and_nothing_else) {
  const std::vector<TriangleTree::Corners> triangles = {
      {Vec3f(-1, -1, 2), Vec3f(3, -1, 2), Vec3f(-1, 3, 2)},
      {Vec3f(-1, -1, 1), Vec3f(3, -1, 1), Vec3f(-1, 3, 1)},
      {Vec3f(-1, -1, 3), Vec3f(3, -1, 3), Vec3f(-1, 3, 3)}};
  std::vector<Index> asked;
  const TriangleTree tree(
      triangles,
      {{false, true, true}, [&](Index triangle, const Vec3f& shares, TriangleTree::Ray ray) {
         EXPECT_NEAR(shares[1], 0.25f, 1e-5f);
         EXPECT_NEAR(shares[2], 0.25f, 1e-5f);
         asked.push_back(triangle);
         return triangle == 1 && ray == TriangleTree::Ray::sight;
       }});
  const Vec3f origin = Vec3f::Zero(), along = Vec3f::UnitZ();
  EXPECT_EQ(tree.first_hit(origin, along).triangle, 0u);
  EXPECT_NEAR(tree.first_hit(origin, along).distance, 2, 1e-5);
  EXPECT_TRUE(tree.is_blocked(origin, along, 1.5f));
  EXPECT_FALSE(tree.is_blocked(origin, along, 0.5f));
  EXPECT_NE(std::find(asked.begin(), asked.end(), Index{1}), asked.end());
  EXPECT_EQ(
      TriangleTree(std::span<const TriangleTree::Corners>()).first_hit(origin, along).triangle,
      kNone);
}

/// A square of 2 m at a height, facing up.
void add_square(float height, float size, std::uint32_t material, RenderScene& scene) {
  const auto corner = [&](float x, float z) { return Vec3f(x * size, height, z * size); };
  for (const auto& corners : {std::array<Vec3f, 3>{corner(-1, -1), corner(-1, 1), corner(1, 1)},
                              std::array<Vec3f, 3>{corner(-1, -1), corner(1, 1), corner(1, -1)}}) {
    RenderTriangle triangle;
    triangle.corners = corners;
    triangle.material = material;
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.normals[i] = Vec3f::UnitY();
      triangle.uvs[i] = Vec2f(corners[i].x(), corners[i].z()) / (2 * size) + Vec2f(0.5f, 0.5f);
      triangle.tints[i].setOnes();
    }
    scene.triangles.push_back(triangle);
  }
}

int brightness(const Picture& picture, int x, int y) {
  const Picture::Color& color = picture.colors[static_cast<std::size_t>(y * picture.width + x)];
  return color[0] + color[1] + color[2];
}

TEST(Trace, textures_shadows_and_transparent_surfaces) {
  Image image{2, 1, {255, 0, 0, 255, 0, 0, 255, 255}};
  RenderScene scene;
  scene.materials.resize(3);
  scene.materials[0].factor.setOnes();
  scene.materials[0].image = &image;
  scene.materials[0].wrap = {RenderMaterial::Wrap::clamp, RenderMaterial::Wrap::clamp};
  scene.materials[2].factor = Vec4f(1, 1, 1, 0);
  scene.materials[2].alpha = RenderMaterial::Alpha::blended;
  add_square(0, 1, 0, scene);
  const Camera camera{{0, 6, 0.01}, {0, 0, 0}, {0, 0, -1}, 30};
  const PictureSize size{80, 60};
  const Picture plain = trace(scene, camera, size);
  const auto& left = plain.colors[30 * 80 + 28];
  const auto& right = plain.colors[30 * 80 + 52];
  EXPECT_GT(left[0], 3 * left[2]);
  EXPECT_GT(right[2], 3 * right[0]);

  RenderScene covered = scene;
  add_square(3, 0.5f, 2, covered);  // Invisible: nothing changes.
  EXPECT_EQ(trace(covered, camera, size).colors, plain.colors);
  RenderScene shaded = scene;
  add_square(0.3f, 0.25f, 1, shaded);
  const Picture below = trace(shaded, camera, size);
  EXPECT_LT(brightness(below, 47, 32), brightness(plain, 47, 32) - 20);  // beside the small square
  for (const unsigned threads : {1u, 2u, 5u})
    EXPECT_EQ(trace(shaded, camera, size, threads).colors, below.colors);
}

TEST(Texture, pixelated_materials_show_the_nearest_pixel) {
  const Image image{2, 1, {255, 0, 0, 255, 0, 0, 255, 255}};  // red, blue
  RenderMaterial material;
  const Vec4f red(1, 0, 0, 1), blue(0, 0, 1, 1);
  for (const float u : {0.02f, 0.3f, 0.48f, 1.3f, -0.7f}) {
    material.is_pixelated = true;
    EXPECT_EQ(sampled(image, material, {u, 0.5f}), red) << u;
    EXPECT_EQ(sampled(image, material, {u + 0.5f, 0.5f}), blue) << u;
    material.is_pixelated = false;
    const Vec4f mixed = sampled(image, material, {u, 0.5f});
    EXPECT_GT(mixed.z(), 0.01f) << u;
    EXPECT_NEAR(mixed.x() + mixed.z(), 1, 1e-5) << u;
  }
}

/// Stripes finer than pixels: each pixel is the mean of what its samples see.
TEST(Trace, textures_finer_than_pixels_are_averaged) {
  Image image{400, 1, {}};
  for (int i = 0; i < image.width; ++i)
    for (const int byte : {i % 2 * 255, 0, (i + 1) % 2 * 255, 255})
      image.rgba.push_back(static_cast<std::uint8_t>(byte));
  RenderScene scene;
  scene.materials.resize(1);
  scene.materials[0].factor.setOnes();
  scene.materials[0].image = &image;
  scene.materials[0].is_unlit = true;
  add_square(0, 1, 0, scene);
  const Picture picture = trace(scene, {{0, 6, 0.01}, {0, 0, 0}, {0, 0, -1}, 30}, {80, 60});
  int pure = 0;
  for (int x = 25; x < 55; ++x) {
    const Picture::Color& color = picture.colors[static_cast<std::size_t>(30 * 80 + x)];
    pure += color[0] == 0 || color[2] == 0 ? 1 : 0;
  }
  EXPECT_EQ(pure, 0);
}

/// A strip half as wide as a pixel, slanted so that it crosses columns: no row misses it.
TEST(Trace, surfaces_thinner_than_a_pixel_are_not_broken) {
  RenderScene scene;
  scene.materials.resize(1);
  scene.materials[0].factor = Vec4f(0, 0, 0, 1);
  scene.materials[0].is_unlit = true;
  scene.backdrop_rise = 0;
  const Camera camera{{0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 90};
  const PictureSize size{80, 80};
  const float pixel = 2.0f / 80;  // The picture is two metres wide.
  RenderTriangle half;
  for (auto& normal : half.normals) normal = Vec3f::UnitZ();
  for (auto& tint : half.tints) tint.setOnes();
  const Vec3f low(-3 * pixel, -1.2f, 0), high(3 * pixel, 1.2f, 0), across(pixel / 2, 0, 0);
  half.corners = {low, low + across, high};
  scene.triangles.push_back(half);
  half.corners = {low + across, high + across, high};
  scene.triangles.push_back(half);
  const Picture picture = trace(scene, camera, size);
  const auto light = [](const Picture::Color& color) {
    return std::pow(static_cast<double>(color[1]) / 255, 2.2);
  };
  const double bright = light(picture.colors[0]);
  for (std::size_t y = 0; y < 80; ++y) {
    double ink = 0;
    for (std::size_t x = 0; x < 80; ++x) ink += 1 - light(picture.colors[80 * y + x]) / bright;
    EXPECT_GT(ink, 0.2) << y;
    EXPECT_LT(ink, 0.8) << y;
  }
}

/// Cut into small pieces, a lip bleeds on the same places.
TEST(LipBlood, long_lips_bleed_where_their_pieces_bleed) {
  test::Random random(7);
  const auto place = [&random] {
    return Vec3f(static_cast<float>(random.uniform(-1, 1)),
                 static_cast<float>(random.uniform(-1, 1)),
                 static_cast<float>(random.uniform(-1, 1)));
  };
  std::vector<LipBlood::Segment> lips, pieces;
  constexpr int kPieces = 200;
  for (int i = 0; i < 5; ++i) {
    lips.push_back({place(), place()});
    const Vec3f along = (lips.back()[1] - lips.back()[0]) / kPieces;
    for (int k = 0; k < kPieces; ++k)
      pieces.push_back({lips.back()[0] + static_cast<float>(k) * along,
                        lips.back()[0] + static_cast<float>(k + 1) * along});
  }
  constexpr float kReach = 0.02f;
  const LipBlood of_lips(lips, kReach), of_pieces(pieces, kReach);
  const Vec3f skin(0.8f, 0.6f, 0.5f);
  int red = 0;
  for (int i = 0; i < 5000; ++i) {
    const LipBlood::Segment& near = lips[static_cast<std::size_t>(i) % lips.size()];
    const Vec3f at = near[0] + static_cast<float>(random.uniform(0, 1)) * (near[1] - near[0]) +
                     0.5f * kReach * place();  // Within 0.9 reaches.
    EXPECT_LT((of_lips.bloodied(skin, at, at) - of_pieces.bloodied(skin, at, at)).norm(), 1e-3f);
    red += of_lips.bloodied(skin, at, at) != skin ? 1 : 0;
  }
  EXPECT_EQ(red, 5000);
}

/// Pixels of one even surface are shaded once, and look for either the sky or the lamp; a surface
/// that might be transparent takes all samples and directions everywhere. Both look alike.
TEST(Trace, even_surfaces_look_as_if_every_sample_were_shaded) {
  RenderScene scene;
  scene.materials.resize(2);
  scene.materials[0].factor = Vec4f(0.8f, 0.7f, 0.6f, 1);
  scene.materials[1].factor = Vec4f(0.3f, 0.5f, 0.7f, 1);
  add_square(0, 1, 0, scene);
  for (RenderTriangle& triangle : scene.triangles)  // As if it were curved.
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3f& corner = triangle.corners[i];
      triangle.normals[i] = Vec3f(0.3f * corner.x(), 1, 0.3f * corner.z()).normalized();
    }
  add_square(0.3f, 0.25f, 1, scene);
  const Camera camera{{0.5, 3, 2}, {0, 0, 0}, {0, 1, 0}, 35};
  const PictureSize size{160, 120};
  const Picture even = trace(scene, camera, size);
  for (RenderMaterial& material : scene.materials) {
    material.alpha = RenderMaterial::Alpha::blended;
    material.factor.w() = 0.995f;
  }
  const Picture sampled = trace(scene, camera, size);
  int sum = 0;
  for (std::size_t i = 0; i < even.colors.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const int difference = std::abs(even.colors[i][c] - sampled.colors[i][c]);
      EXPECT_LE(difference, 20) << i % 160 << ", " << i / 160;
      sum += difference;
    }
  EXPECT_LT(sum, static_cast<int>(even.colors.size()) * 3);
  EXPECT_GT(sum, 0);
}

/// The corners of a triangle's texture coordinates in pixels of an image of 8 x 8, of which the
/// pixel (5, 2) alone is clear.
bool is_holed(const std::array<Vec2f, 3>& pixels, bool is_pixelated,
              RenderMaterial::Wrap wrap = RenderMaterial::Wrap::repeat) {
  Image image{8, 8, std::vector<std::uint8_t>(256, 255)};
  image.rgba[4 * (2 * 8 + 5) + 3] = 254;
  RenderScene scene;
  scene.materials.resize(1);
  scene.materials[0].image = &image;
  scene.materials[0].alpha = RenderMaterial::Alpha::cut;
  scene.materials[0].is_pixelated = is_pixelated;
  scene.materials[0].wrap = {wrap, wrap};
  RenderTriangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    triangle.uvs[i] = pixels[i] / 8;
    triangle.tints[i].setOnes();
  }
  scene.triangles = {triangle};
  return holed_triangles(scene)[0];
}

TEST(HoledTriangles, are_those_that_show_a_clear_pixel) {
  using enum RenderMaterial::Wrap;
  EXPECT_TRUE(is_holed({{{4, 1}, {7, 1}, {4, 4}}}, true));
  EXPECT_FALSE(is_holed({{{6, 3}, {8, 3}, {6, 8}}}, true)) << "it ends at the pixel's edges";
  EXPECT_TRUE(is_holed({{{6, 3}, {8, 3}, {6, 8}}}, false)) << "pixels are mixed there";
  EXPECT_FALSE(is_holed({{{6.6f, 3.6f}, {7.4f, 3.6f}, {7, 7}}}, false));
  EXPECT_TRUE(is_holed({{{13, 10}, {13.5f, 10}, {13, 10.5f}}}, true)) << "the next repetition";
  EXPECT_TRUE(is_holed({{{-3, -6}, {-2.5f, -6}, {-3, -5.5f}}}, true)) << "and the one before";
  EXPECT_TRUE(is_holed({{{7, 2}, {14, 2}, {7, 2.5f}}}, true)) << "over the end of the image";
  EXPECT_FALSE(is_holed({{{7, 2}, {12, 2}, {7, 2.5f}}}, true));
  EXPECT_TRUE(is_holed({{{0, 0}, {1000, 0}, {0, 1000}}}, true));
  EXPECT_TRUE(is_holed({{{10, 2}, {11, 2}, {10, 2.5f}}}, true, mirror)) << "8 is 7, 10 is 5";
  EXPECT_FALSE(is_holed({{{13, 2}, {13.5f, 2}, {13, 2.5f}}}, true, mirror));
  EXPECT_FALSE(is_holed({{{13, 2}, {20, 2}, {13, 2.5f}}}, true, clamp)) << "all is the last pixel";
  EXPECT_TRUE(is_holed({{{-4, 2}, {20, 2}, {13, 2.5f}}}, true, clamp));
}

/// An opaque image looks alike whatever the material says of its alpha.
TEST(Trace, a_material_that_cuts_nothing_out_is_opaque) {
  Image image{16, 16, {}};
  for (int i = 0; i < 256; ++i)
    for (const int byte : {i, 255 - i, 7 * i % 256, 255})
      image.rgba.push_back(static_cast<std::uint8_t>(byte));
  RenderScene scene;
  scene.materials.resize(1);
  scene.materials[0].factor.setOnes();
  scene.materials[0].image = &image;
  add_square(0, 1, 0, scene);
  const Camera camera{{0.5, 3, 2}, {0, 0, 0}, {0, 1, 0}, 35};
  const PictureSize size{80, 60};
  const Picture opaque = trace(scene, camera, size);
  for (const auto alpha : {RenderMaterial::Alpha::cut, RenderMaterial::Alpha::blended}) {
    scene.materials[0].alpha = alpha;
    EXPECT_EQ(trace(scene, camera, size).colors, opaque.colors);
  }
  image.rgba[4 * (16 * 8 + 8) + 3] = 0;
  EXPECT_NE(trace(scene, camera, size).colors, opaque.colors) << "a hole in the middle";
}

TEST(Trace, alpha_counts_only_where_the_material_says_so) {
  const Image clear{1, 1, {255, 255, 255, 60}};
  RenderScene scene;
  scene.materials.resize(2);
  scene.materials[0].factor = Vec4f(1, 0, 0, 1);
  scene.materials[1].factor = Vec4f(0, 0, 1, 1);
  scene.materials[1].image = &clear;
  add_square(0, 1, 0, scene);
  add_square(0.5f, 1, 1, scene);
  const Camera camera{{0, 6, 0.01}, {0, 0, 0}, {0, 0, -1}, 30};
  const auto middle = [&](RenderMaterial::Alpha alpha) {
    scene.materials[1].alpha = alpha;
    return trace(scene, camera, {80, 60}).colors[30 * 80 + 40];
  };
  const auto ignored = middle(RenderMaterial::Alpha::ignored),
             cut = middle(RenderMaterial::Alpha::cut),
             blended = middle(RenderMaterial::Alpha::blended);
  EXPECT_GT(ignored[2], 150);
  EXPECT_LT(ignored[0], 80);
  EXPECT_GT(cut[0], 200) << "neither seen nor in the way of light";
  EXPECT_LT(cut[2], 80);
  EXPECT_GT(blended[0], 100);
  EXPECT_GT(blended[2], 80);
}

TEST(Trace, unlit_colours_and_emission_are_shown_without_light) {
  RenderScene scene;
  scene.materials.resize(2);
  scene.materials[0].factor = Vec4f(0.5f, 0.25f, 1, 1);
  scene.materials[0].is_unlit = true;
  scene.materials[1].factor = Vec4f(0, 0, 0, 1);
  scene.materials[1].emission = Vec3f(0, 0.4f, 0);
  const Camera camera{{0, 6, 0.01}, {0, 0, 0}, {0, 0, -1}, 30};
  add_square(0, 1, 0, scene);
  EXPECT_EQ(trace(scene, camera, {80, 60}).colors[30 * 80 + 40], (Picture::Color{188, 137, 255}));
  scene.triangles.clear();
  add_square(0, 1, 1, scene);
  const auto glowing = trace(scene, camera, {80, 60}).colors[30 * 80 + 40];
  EXPECT_GT(glowing[1], 160);
  EXPECT_LT(glowing[0], 80);
}

/// Marks of one colour each, whose pixels are counted.
TEST(Trace, marks_lie_before_and_behind_surfaces_and_on_top) {
  RenderScene scene;
  scene.materials.resize(1);
  scene.materials[0].factor = Vec4f(0.5f, 0.5f, 0.5f, 1);
  scene.materials[0].is_unlit = true;
  add_square(0, 1, 0, scene);
  const Camera camera{{0, 6, 0.01}, {0, 0, 0}, {0, 0, -1}, 30};
  const auto mark = [](double left, std::vector<double> depths, const Vec4f& color) {
    return RenderMark{
        {{left, 26}, {left + 8, 26}, {left + 8, 34}, {left, 34}}, std::move(depths), color};
  };
  const Vec4f red(1, 0, 0, 1), green(0, 1, 0, 1), blue(0, 0, 1, 0.5f);
  scene.marks = {mark(24, {5, 5, 5, 5}, red), mark(36, {7, 7, 7, 7}, red),
                 mark(48, {}, green),         mark(50, {}, blue),
                 mark(52, {5, 5, 5, 5}, red), mark(8, {5, 7, 7, 5}, red)};
  const Picture picture = trace(scene, camera, {80, 60});
  const auto at = [&](int x) { return picture.colors[static_cast<std::size_t>(30 * 80 + x)]; };
  EXPECT_EQ(at(28), (Picture::Color{255, 0, 0})) << "before the surface";
  EXPECT_EQ(at(40), (Picture::Color{188, 188, 188})) << "behind it";
  EXPECT_EQ(at(49), (Picture::Color{0, 255, 0})) << "on top";
  EXPECT_EQ(at(51), (Picture::Color{0, 188, 188})) << "half of it over another one";
  EXPECT_EQ(at(54), (Picture::Color{0, 188, 188})) << "over one in the scene, which came later";
  EXPECT_EQ(at(59), (Picture::Color{255, 0, 0}));
  EXPECT_EQ(at(31), (Picture::Color{255, 0, 0}));
  EXPECT_EQ(at(32), (Picture::Color{188, 188, 188}));
}

}  // namespace
}  // namespace sunder::tools
