#include "io/urdf/mesh_paths.h"

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

namespace sunder::urdf {

namespace fs = std::filesystem;

namespace {

bool is_inside(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

std::string quoted(const std::string& text) { return "'" + text.substr(0, 120) + "'"; }

bool is_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && !error;
}

bool is_folder(const fs::path& folder) {
  std::error_code error;
  return fs::is_directory(folder, error) && !error;
}

fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  return error ? fs::path() : canonical;
}

bool is_package_name(const std::string& name) {
  return !name.empty() && name != "." && name != "..";
}

}  // namespace

MeshPaths::MeshPaths(const fs::path& urdf_file, std::vector<fs::path> roots) {
  std::error_code error;
  folder_ = resolved(fs::absolute(urdf_file, error)).parent_path();
  if (!folder_.empty()) folders_.push_back(folder_);
  for (const fs::path& root : roots) {
    const fs::path canonical = fs::canonical(root, error);
    if (error) continue;
    roots_.push_back(canonical);
    folders_.push_back(canonical);
  }
}

std::optional<fs::path> MeshPaths::find(const std::string& reference, const Place& place,
                                        Findings& findings) const {
  std::string path = reference;
  std::replace(path.begin(), path.end(), '\\', '/');
  if (path.find_first_not_of(' ') == std::string::npos) {
    findings.add("mesh_not_found", place, "its mesh has no filename; it is left out");
    return std::nullopt;
  }
  for (const std::string_view scheme : {"package://", "model://"})
    if (path.starts_with(scheme))
      return in_package(path.substr(scheme.size()), reference, place, findings);
  if (path.starts_with("file://")) path.erase(0, std::string_view("file://").size());
  if (path.find("://") != std::string::npos) {
    findings.add("mesh_path_not_allowed", place,
                 "mesh " + quoted(reference) + " is neither a file nor package://; it is left out");
    return std::nullopt;
  }
  const fs::path file = resolved(folder_ / path);  // if `path` is absolute, folder_ is ignored
  if (file.empty() || !is_allowed(file)) {
    findings.add("mesh_path_not_allowed", place,
                 "mesh " + quoted(reference) +
                     " is outside of the robot's folder and the package roots; it is left out");
    return std::nullopt;
  }
  if (is_file(file)) return file;
  findings.add("mesh_not_found", place,
               "there is no file " + quoted(reference) + "; the link stays without this mesh");
  return std::nullopt;
}

std::optional<fs::path> MeshPaths::in_package(const std::string& rest, const std::string& reference,
                                              const Place& place, Findings& findings) const {
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string package = rest.substr(0, slash);
  const std::string inside = slash < rest.size() ? rest.substr(slash + 1) : std::string();
  bool is_known = false, leads_outside = !is_package_name(package);
  for (const fs::path& root : roots_) {
    if (leads_outside) break;
    // A root may also be the folder of the package itself.
    const fs::path folder = root.filename() == package ? root : root / package;
    if (!is_folder(folder)) continue;
    is_known = true;
    const fs::path file = resolved(folder / fs::path(inside).relative_path());
    if (file.empty() || !is_inside(file, root))
      leads_outside = true;
    else if (is_file(file))
      return file;
  }
  if (leads_outside)
    findings.add("mesh_path_not_allowed", place,
                 "mesh " + quoted(reference) + " leads out of the package roots; it is left out");
  else if (!is_known)
    findings.add("package_unknown", place,
                 "no package root has a folder " + quoted(package) + " for mesh " +
                     quoted(reference) + "; the link stays without this mesh" + advice_on(package));
  else
    findings.add("mesh_not_found", place,
                 "there is no file " + quoted(reference) + "; the link stays without this mesh");
  return std::nullopt;
}

/// Packages usually hold the URDF file itself, in a folder below.
std::string MeshPaths::advice_on(const std::string& package) const {
  for (fs::path folder = folder_; folder.has_relative_path(); folder = folder.parent_path())
    if (folder.filename() == package)
      return ". A package root may be '" + folder.parent_path().string() + "'";
  return {};
}

bool MeshPaths::is_allowed(const fs::path& file) const {
  return std::any_of(folders_.begin(), folders_.end(),
                     [&](const fs::path& folder) { return is_inside(file, folder); });
}

}  // namespace sunder::urdf
