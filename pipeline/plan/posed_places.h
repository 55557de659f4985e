#pragma once

#include <sunder/core/character.h>
#include <sunder/tear/contact.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace sunder::plan {

/// Places in triangles of a character, posed together: only the corners of their triangles are
/// skinned, by morph targets and linear blending, in double.
class PosedPlaces {
 public:
  /// @param places  valid, see check_place().
  PosedPlaces(const Character& character, std::span<const SurfaceAnchor> places);

  [[nodiscard]] std::size_t size() const { return places_.size(); }

  /// @param places   one per place, written.
  /// @param normals  one per place, written: those of the triangles, unit length or zero. Or empty.
  /// @return the failures of compute_palette().
  Status pose(const ModelPose& pose, std::span<Vec3d> places, std::span<Vec3d> normals) const;

 private:
  struct Corner {
    std::uint32_t mesh, vertex;
  };
  struct Place {
    std::array<std::uint32_t, 3> corners;
    std::array<double, 3> barycentric;
  };
  const Character& character_;
  std::vector<Corner> corners_;
  std::vector<Place> places_;
};

/// @return index_out_of_range, non_finite_value or invalid_argument, with `index` as index.
[[nodiscard]] Status check_place(const Character& character, const SurfaceAnchor& place,
                                 std::uint32_t index);

}  // namespace sunder::plan
