#pragma once

#include <sunder/binding/binding.h>

#include <vector>

namespace sunder::binding {

/// A model in its bind pose and a rig in the pose of a binding, both in rig space.
struct Joined {
  const Character& model;
  const Character& rig;
  std::vector<Affine3d> rig_from_bone;        ///< Per bone of the rig.
  std::vector<Affine3d> rig_from_model_bone;  ///< Per bone of the model.
  std::vector<Affine3d> rig_from_bind;        ///< Per skin of the model: places its meshes.
  std::vector<std::vector<Vec3d>> positions;  ///< Per mesh of the model and vertex.
  double largest_shape_error = 0;             ///< Binding::largest_shape_error.
};

/// Poses both. @return the first fault of a character; invalid_argument, non_finite_value or
/// size_mismatch of the place.
[[nodiscard]] Result<Joined> join(const Character& model, const Character& rig,
                                  const BindingPlace& place);

}  // namespace sunder::binding
