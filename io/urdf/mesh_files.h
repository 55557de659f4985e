#pragma once

#include <sunder/core/mesh.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "io/urdf/findings.h"
#include "io/urdf/materials.h"
#include "io/urdf/mesh_paths.h"

namespace sunder::urdf {

/// A mesh file as it stands in its own space, all parts together.
struct MeshFile {
  Mesh mesh;                       ///< Without triangles if the file cannot be read.
  bool has_own_materials = false;  ///< Otherwise Submesh::material is kNone.
};

/// Reads each mesh file once.
class MeshFiles {
 public:
  MeshFiles(const MeshPaths& paths, const RobotLoadOptions& options, Materials& materials)
      : paths_(paths), options_(options), materials_(materials) {}

  /// The content of a file. What is wrong with it is found when it is first read.
  [[nodiscard]] const MeshFile& read(const std::filesystem::path& file, const Place& place,
                                     Findings& findings);
  /// The sizes of the files that were read.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

 private:
  [[nodiscard]] MeshFile load(const std::filesystem::path& file, const Place& place,
                              Findings& findings);

  void warn_of_filter(const LoadReport& report, const Place& place, Findings& findings);

  const MeshPaths& paths_;
  const RobotLoadOptions& options_;
  Materials& materials_;
  std::map<std::filesystem::path, MeshFile> files_;
  std::uint64_t bytes_ = 0;
  bool has_told_up_axis_ = false, has_told_filter_ = false;
};

}  // namespace sunder::urdf
