#pragma once

#include <sunder/core/math.h>

#include <array>
#include <cstddef>
#include <vector>

#include "tools/render/camera.h"

namespace sunder::tools {

/// Lights infinitely far away. Each sample of a pixel asks for a part of them, in turn, so that
/// shadows are soft without noise.
class Lighting {
 public:
  static constexpr std::size_t kSamples = 4;  ///< Per pixel.
  struct Light {
    Vec3f towards;    ///< Unit length.
    Vec3f intensity;  ///< Linear RGB; the light of all parts is the mean of the parts.
  };

  /// A lamp above the left shoulder of the camera, a weak one on the other side, and the sky.
  explicit Lighting(const Camera& camera);

  [[nodiscard]] const std::vector<Light>& sky(std::size_t sample) const { return sky_[sample]; }
  [[nodiscard]] const std::vector<Light>& lamp(std::size_t sample) const { return lamp_[sample]; }
  [[nodiscard]] const Light& fill() const { return fill_; }

 private:
  std::array<std::vector<Light>, kSamples> sky_, lamp_;
  Light fill_;
};

}  // namespace sunder::tools
