#pragma once

#include <cstdint>
#include <string>
#include <sunder_c.h>
#include <vector>

#include "bindings/godot/variant.h"

namespace sunder::godot {

/// A Skeleton3D and a Skin as those of a character. Godot's bones may stand in any order; here
/// parents stand before children.
class SkeletonReader {
 public:
  /// @return what is wrong; empty if nothing is.
  [[nodiscard]] std::string read(const Variant& skeleton, const Variant& skin);

  // Views of this object.
  [[nodiscard]] const std::vector<sunder_bone>& bones() const { return bones_; }
  [[nodiscard]] sunder_skin skin() const;

  /// The present pose: 12 numbers per bone, columns of a matrix and its translation.
  void read_pose(const Variant& skeleton, std::vector<double>& model_from_bone) const;

 private:
  [[nodiscard]] std::string read_bones(const Variant& skeleton);
  [[nodiscard]] std::string read_skin(const Variant& skeleton, const Variant& skin);

  std::vector<std::int64_t> godot_of_bone_;
  std::vector<std::uint32_t> bone_of_godot_;
  std::vector<std::string> names_;
  std::vector<sunder_bone> bones_;
  std::vector<std::uint32_t> slots_;
  std::vector<float> bone_from_bind_;
};

}  // namespace sunder::godot
