#include "io/gltf_write/clip_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Core>

#include "io/gltf/accessors.h"

namespace sunder::gltf {
namespace {

std::uint32_t add_floats(GlbDraft& draft, std::span<const float> values, const char* type,
                         std::size_t components) {
  list_of(draft.json, "accessors")
      .push_back({{"bufferView", draft.add_view(std::as_bytes(values), GlbDraft::ViewTarget::none)},
                  {"componentType", static_cast<std::uint32_t>(ComponentType::f32)},
                  {"count", values.size() / components},
                  {"type", type}});
  return static_cast<std::uint32_t>(draft.json["accessors"].size() - 1);
}

}  // namespace

Json add_sampler(GlbDraft& draft, const Channel& channel, std::span<const float> values,
                 std::uint32_t components) {
  constexpr std::array<const char*, 3> kInterpolations = {"LINEAR", "STEP", "CUBICSPLINE"};
  constexpr std::array<const char*, 5> kTypes = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  Interpolation interpolation = channel.interpolation;
  // A spline needs two keys; a single one is a constant.
  if (interpolation == Interpolation::cubic_spline && channel.times.size() == 1) {
    interpolation = Interpolation::step;
    values = values.subspan(values.size() / 3, values.size() / 3);
  }
  const std::uint32_t input = add_floats(draft, channel.times, "SCALAR", 1);
  const auto [least, greatest] = std::minmax_element(channel.times.begin(), channel.times.end());
  Json& times = draft.json["accessors"][input];
  times["min"] = Json::array({static_cast<double>(*least)});
  times["max"] = Json::array({static_cast<double>(*greatest)});
  return {{"input", input},
          {"interpolation", kInterpolations[static_cast<std::size_t>(interpolation)]},
          {"output", add_floats(draft, values, kTypes[components], components)}};
}

std::vector<float> unit_rotations(const Channel& channel) {
  std::vector<float> values = channel.values;
  const bool is_spline = channel.interpolation == Interpolation::cubic_spline;
  for (std::size_t row = 0; 4 * row < values.size(); ++row) {
    if (is_spline && row % 3 != 1) continue;
    Eigen::Map<Eigen::Vector4f> key(values.data() + 4 * row);
    const double length = key.cast<double>().norm();
    if (std::abs(length * length - 1.0) > 1e-6 && length > 0.0)
      key = (key.cast<double>() / length).cast<float>();
  }
  return values;
}

}  // namespace sunder::gltf
