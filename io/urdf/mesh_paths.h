#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/urdf/findings.h"

namespace sunder::urdf {

/// Finds the mesh files of a robot, in the folder of its URDF file and in the given package roots
/// only. Links are resolved before this is checked, so none leads outside.
class MeshPaths {
 public:
  MeshPaths(const std::filesystem::path& urdf_file, std::vector<std::filesystem::path> roots);

  /// The file that a reference names: package://NAME/..., model://NAME/..., file://..., or a path
  /// relative to the URDF file. Nothing, and a finding, if there is none or it is not allowed.
  [[nodiscard]] std::optional<std::filesystem::path> find(const std::string& reference,
                                                          const Place& place,
                                                          Findings& findings) const;

  /// Canonical: the URDF's folder, then the roots.
  [[nodiscard]] const std::vector<std::filesystem::path>& folders() const { return folders_; }

 private:
  [[nodiscard]] std::optional<std::filesystem::path> in_package(const std::string& rest,
                                                                const std::string& reference,
                                                                const Place& place,
                                                                Findings& findings) const;
  [[nodiscard]] std::string advice_on(const std::string& package) const;
  [[nodiscard]] bool is_allowed(const std::filesystem::path& file) const;

  std::filesystem::path folder_;  ///< Of the URDF file.
  std::vector<std::filesystem::path> roots_, folders_;
};

}  // namespace sunder::urdf
