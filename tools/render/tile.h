#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/render/coverage.h"
#include "tools/render/marked_samples.h"
#include "tools/render/png_file.h"
#include "tools/render/render_view.h"
#include "tools/render/shading.h"

namespace sunder::tools {

/// What tiles draw.
struct TiledScene {
  const RenderScene& scene;
  const Lighting& lighting;
  const Shading& shading;
  const RenderView& view;
  const Coverage& coverage;
  Vec3f middle;  ///< Of the scene; the floor is around it.
};

/// Draws parts of a picture. Rays from the eye go through the corners and the middles of pixels;
/// where the five of a pixel meet one even surface, it is shaded once, and where they meet nothing,
/// the backdrop is; elsewhere four more rays find surfaces within the pixel. Shadows are looked for
/// once per pixel and surface, and averaged over the neighbouring pixels of the same surface. For
/// one thread; the parts do not depend on each other.
class Tile {
 public:
  static constexpr int kSide = 80;                                ///< Pixels.
  static constexpr std::size_t kSamples = TriangleTree::kBundle;  ///< Per pixel.

  explicit Tile(const TiledScene& drawn)
      : scene_(drawn.scene),
        lighting_(drawn.lighting),
        shading_(drawn.shading),
        view_(drawn.view),
        drawn_(drawn) {}

  /// Draws the pixels from (left, top) to those kSide farther, or the edge.
  void draw(int left, int top, Picture& picture);

 private:
  /// Where shadows are looked for: one per pixel and surface.
  struct Probe {
    Vec3f place, normal;
    Shading::Light light;
    float reach = 0;        ///< Of the same surface, off its plane.
    bool is_floor = false;  ///< Which needs fewer directions.
  };
  /// What a sample sees, behind the layers before; behind the last one is the backdrop.
  struct Layer {
    Shading::Look look;
    std::uint32_t probe = 0;
    float depth = 0;
  };
  enum class Kind : std::uint8_t {
    mixed,  ///< Its samples see different things.
    even,   ///< All samples see one layer.
    empty   ///< All samples see the backdrop.
  };
  struct Pixel {
    std::uint32_t first_probe = 0, probe_count = 0;
    std::array<std::uint32_t, kSamples + 1> layers = {};  ///< Where those of each sample begin.
    std::array<float, kSamples> floor = {};  ///< How strong shadows on the backdrop are.
    std::uint32_t floor_probe = 0;           ///< Where there are some.
    Kind kind = Kind::mixed;
  };
  /// Looks through one place of each pixel from (left_, top_) to (right, bottom).
  /// @param offset  of the place from the pixel's upper left corner, in pixels, both ways.
  void look_through(double offset, int right, int bottom,
                    std::vector<Shading::Glance>& glances) const;
  void find_surfaces();
  void see(Pixel& pixel, int x, int y);
  void see_samples(Pixel& pixel, int x, int y);
  void see_sample(Pixel& pixel, int x, int y, const Vec3f& along, std::size_t sample,
                  TriangleTree::Hit hit);
  /// Adds the layer of a surface.
  void add_layer(Pixel& pixel, int x, int y, const Shading::Surface& surface, float distance);
  void see_floor(Pixel& pixel, int x, int y, const Vec3f& along, std::size_t sample);
  [[nodiscard]] std::uint32_t probe_at(Pixel& pixel, int x, int y, const Probe& wanted,
                                       const Vec3f& start, const Vec3f& flat);
  [[nodiscard]] Shading::Light mean_light(const Probe& probe, int x, int y) const;
  void shade(int x, int y, SampledPart& part);
  [[nodiscard]] Vec3f shade_backdrop(const Pixel& pixel, std::size_t sample, double down) const;
  void shade_sample(const Pixel& pixel, int x, int y, std::size_t sample, Vec3f& color,
                    float& depth);

  /// Metres, at a distance of one metre.
  [[nodiscard]] float pixel_size() const;
  [[nodiscard]] const Pixel& pixel_at(int x, int y) const;

  const RenderScene& scene_;
  const Lighting& lighting_;
  const Shading& shading_;
  const RenderView& view_;
  const TiledScene& drawn_;
  int left_ = 0, top_ = 0, right_ = 0, bottom_ = 0;  ///< With a border, for the averages.
  std::vector<Shading::Glance> corners_;  ///< One more per row than pixels, and one more row.
  std::vector<Shading::Glance> middles_;  ///< One per pixel.
  std::vector<Pixel> pixels_;
  std::vector<Layer> layers_;
  std::vector<Probe> probes_;
  std::vector<Shading::Light> smooth_;  ///< Per probe of the pixel that is drawn.
};

}  // namespace sunder::tools
