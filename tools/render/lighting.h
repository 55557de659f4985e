#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cstddef>
#include <span>

#include "tools/render/camera.h"

namespace sunder::tools {

/// Lights infinitely far away: a lamp above the left shoulder of the camera, a weak one on the
/// other side, which casts no shadow, and the sky. A pixel asks for one pattern of directions in
/// which it may be in shadow; 4 x 4 pixels together ask for all of them, so that their mean is
/// smooth.
class Lighting {
 public:
  static constexpr std::size_t kPatterns = 16, kSkyRays = 4, kLampRays = 2;
  struct Light {
    Vec3f towards;    ///< Unit length.
    Vec3f intensity;  ///< Linear RGB.
  };

  explicit Lighting(const Camera& camera);

  /// Directions around a normal in z, more of them where the cosine is larger.
  [[nodiscard]] std::span<const Vec3f> sky(std::size_t pattern) const { return sky_[pattern]; }
  /// Directions of places on the lamp, model space.
  [[nodiscard]] std::span<const Vec3f> lamp(std::size_t pattern) const {
    return std::span(lamp_).subspan(pattern * kLampRays, kLampRays);
  }
  /// Those of a pattern and of its neighbour.
  [[nodiscard]] std::span<const Vec3f> lamp_pair(std::size_t pattern) const {
    return std::span(lamp_).subspan(pattern / 2 * 2 * kLampRays, 2 * kLampRays);
  }
  /// Two directions across a normal, all of unit length, that turn smoothly with it for all that
  /// face the eye: surfaces show no step where a frame would jump.
  struct Across {
    Vec3f side, other;
  };
  [[nodiscard]] Across across(const Vec3f& normal) const;
  [[nodiscard]] const Light& middle_of_lamp() const { return middle_of_lamp_; }
  [[nodiscard]] const Light& fill() const { return fill_; }
  /// The colour of the sky in a direction: paler above than below.
  [[nodiscard]] static Vec3f sky_color(const Vec3f& towards);
  /// The light of the whole sky on a surface, in closed form.
  [[nodiscard]] static Vec3f sky_light(const Vec3f& normal);

 private:
  std::array<std::array<Vec3f, kSkyRays>, kPatterns> sky_;
  std::array<Vec3f, kPatterns * kLampRays> lamp_;
  Light middle_of_lamp_, fill_;
  Vec3f back_, right_, up_;  ///< Towards the eye, and across.
};

}  // namespace sunder::tools
