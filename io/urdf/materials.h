#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/gltf_write/new_document.h"
#include "io/urdf/findings.h"
#include "io/urdf/tags.h"

namespace sunder::urdf {

/// The materials of a robot, collected while its shapes are read.
class Materials {
 public:
  explicit Materials(const RobotTags& tags);

  /// Index of the material of a shape by its `<material>`, of one for shapes without any otherwise.
  [[nodiscard]] std::uint32_t of_shape(const ShapeTag& shape, const Place& place,
                                       Findings& findings);

  /// Adds the materials of a mesh file. @return the index of the first.
  [[nodiscard]] std::uint32_t add(const BaseColours& colours,
                                  const std::vector<std::string>& names);

  [[nodiscard]] const gltf::NewMaterials& all() const { return all_; }

 private:
  std::uint32_t add(const std::string& name, const Vec4f& color);

  std::map<std::string, std::array<double, 4>> rgba_of_name_;
  std::map<std::pair<std::string, std::array<double, 4>>, std::uint32_t> index_of_;
  gltf::NewMaterials all_;
};

}  // namespace sunder::urdf
