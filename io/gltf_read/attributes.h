#pragma once

#include <sunder/core/mesh.h>

#include <string>
#include <vector>

#include "io/gltf_read/reading.h"
#include "io/gltf_read/weights.h"

namespace sunder::gltf {

/// Reads a primitive's vertices into a mesh and records whether it changed any.
class AttributeReader {
 public:
  /// @param place  names the mesh in notes.
  AttributeReader(Reading& reading, const Cursor& primitive, std::string place);

  /// Everything except weights and morph targets.
  void read_streams(Mesh& mesh);
  void read_morph_targets(Mesh& mesh, const std::vector<std::string>& names);
  /// JOINTS_n with WEIGHTS_n, n = 0, 1 …; empty if the primitive has none.
  [[nodiscard]] std::vector<InfluenceSet> read_influences(const Mesh& mesh);

  [[nodiscard]] const std::vector<std::uint32_t>& color_components() const {
    return color_components_;
  }
  [[nodiscard]] bool repaired() const { return repaired_; }

 private:
  [[nodiscard]] Accessor open(const Cursor& at, const Mesh& mesh, std::uint32_t components) const;
  void read_positions(Mesh& mesh);
  void read_normals(Mesh& mesh);
  void read_tangents(Mesh& mesh);
  void read_uv_sets(Mesh& mesh);
  void read_color_sets(Mesh& mesh);
  void read_tear_side_feature(Mesh& mesh, const Cursor& at);
  void read_custom(Mesh& mesh, const std::string& name, const Cursor& at);
  /// Of walls: indices without a material in the file would make a torn one refuse to be saved.
  void forget_absent_materials(std::vector<float>& indices);
  std::vector<Vec3f> read_deltas(const Cursor& target, const char* name, const Mesh& mesh);
  void clamp_colors(std::vector<Vec4f>& colors);
  void note_sets_beyond(const char* prefix, std::size_t used);
  template <class Vector>
  void zero_non_finite(std::vector<Vector>& values, const char* what);
  template <class Vector>
  bool drop_non_finite(std::vector<Vector>& values, const std::string& what);

  Reading& reading_;
  Cursor primitive_;
  Cursor attributes_;
  std::string place_;
  std::vector<std::uint32_t> color_components_;
  bool repaired_ = false;
};

}  // namespace sunder::gltf
