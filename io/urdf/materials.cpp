#include "io/urdf/materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sunder::urdf {
namespace {

constexpr std::array<double, 4> kPlain = {0.8, 0.8, 0.8, 1.0};  ///< sRGB.

/// Colours of URDF are those of the screen; glTF's are linear.
float linear(double srgb) {
  const double value = std::clamp(srgb, 0.0, 1.0);
  return static_cast<float>(value <= 0.04045 ? value / 12.92
                                             : std::pow((value + 0.055) / 1.055, 2.4));
}

}  // namespace

Materials::Materials(const RobotTags& tags) {
  const auto define = [&](const MaterialTag& material) {
    if (material.rgba && !material.name.empty())
      rgba_of_name_.try_emplace(material.name, *material.rgba);
  };
  for (const MaterialTag& material : tags.materials) define(material);
  // A shape may name a material that another one defines.
  for (const LinkTag& link : tags.links)
    for (const std::vector<ShapeTag>* shapes : {&link.visuals, &link.collisions})
      for (const ShapeTag& shape : *shapes)
        if (shape.material) define(*shape.material);
}

std::uint32_t Materials::of_shape(const ShapeTag& shape, const Place& place, Findings& findings) {
  std::array<double, 4> rgba = kPlain;
  std::string name = "plain";
  if (shape.material) {
    const MaterialTag& material = *shape.material;
    const auto known = rgba_of_name_.find(material.name);
    if (!material.name.empty()) name = material.name;
    if (material.rgba)
      rgba = *material.rgba;
    else if (known != rgba_of_name_.end())
      rgba = known->second;
    else
      findings.add("material_unknown", {place.name, material.line},
                   "no material '" + material.name.substr(0, 80) +
                       "' with a colour is defined; "
                       "it is drawn light grey");
  }
  const auto [entry, is_new] = index_of_.try_emplace({name, rgba}, 0);
  if (is_new)
    entry->second = add(name, Vec4f(linear(rgba[0]), linear(rgba[1]), linear(rgba[2]),
                                    static_cast<float>(std::clamp(rgba[3], 0.0, 1.0))));
  return entry->second;
}

std::uint32_t Materials::add(const std::string& name, const Vec4f& color) {
  BaseColour base;
  base.factor = color;
  all_.colours.materials.push_back(base);
  all_.names.push_back(name);
  return static_cast<std::uint32_t>(all_.names.size() - 1);
}

std::uint32_t Materials::add(const BaseColours& colours, const std::vector<std::string>& names) {
  const auto first = static_cast<std::uint32_t>(all_.names.size());
  const auto first_image = static_cast<std::uint32_t>(all_.colours.images.size());
  for (std::size_t i = 0; i < colours.materials.size(); ++i) {
    BaseColour material = colours.materials[i];
    if (material.image != kNone) material.image += first_image;
    all_.colours.materials.push_back(material);
    all_.names.push_back(i < names.size() ? names[i] : std::string());
  }
  all_.colours.images.insert(all_.colours.images.end(), colours.images.begin(),
                             colours.images.end());
  return first;
}

}  // namespace sunder::urdf
