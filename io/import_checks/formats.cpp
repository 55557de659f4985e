#include "io/import_checks/formats.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace sunder::assimp_import {
namespace {

constexpr std::array kFormats = {
    Format{"3ds", "3DS", "MM", ""},
    Format{"ase", "ASE", "*3DSMAX_ASCIIEXPORT", ""},
    Format{"b3d", "B3D", "BB3D", ""},
    Format{"cob", "COB", "Caligari ", ""},
    Format{"dae", "COLLADA", "", ""},
    Format{"fbx", "FBX", "Kaydara FBX Binary", "FBX"},
    Format{"iqm", "IQM", "INTERQUAKEMODEL", ""},
    Format{"md5mesh", "MD5MESH", "", "MD5Version"},
    Format{"mdl", "MDL", "IDST", ""},  // Half-Life 1
    Format{"ms3d", "MS3D", "MS3D000000", ""},
    Format{"obj", "OBJ", "", ""},
    Format{"off", "OFF", "", ""},
    Format{"ply", "PLY", "ply", ""},
    Format{"smd", "SMD", "", "version"},
    Format{"stl", "STL", "", ""},
    Format{"x", "X", "xof ", ""},
    Format{"zae", "COLLADA", "PK", ""},
};

std::string lower_extension(std::string_view file_name) {
  const std::size_t dot = file_name.rfind('.');
  std::string extension(dot == std::string_view::npos ? "" : file_name.substr(dot + 1));
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

std::span<const Format> formats() { return kFormats; }

Result<Format> format_of(std::string_view file_name) {
  const std::string extension = lower_extension(file_name);
  const auto format = std::find_if(kFormats.begin(), kFormats.end(),
                                   [&](const Format& one) { return one.extension == extension; });
  if (format != kFormats.end()) return *format;
  if (extension == "usd" || extension == "usda" || extension == "usdc" || extension == "usdz")
    return Status::failure(StatusCode::unsupported_format, kNone,
                           "%.80s: USD is written, not read (docs/usd.md says why); convert it to "
                           "GLB first",
                           std::string(file_name).c_str());
  std::string known = "glb, vrm, gltf";
  for (const Format& one : kFormats) known += ", " + std::string(one.extension);
  const std::string kind =
      extension.empty() ? "files without an extension" : "." + extension.substr(0, 20) + " files";
  return Status::failure(StatusCode::unsupported_format, kNone,
                         "%.80s: no reader for %s; there are readers for %s",
                         std::string(file_name).c_str(), kind.c_str(), known.c_str());
}

Status check_start(const Format& format, std::string_view first_kilobyte,
                   const std::string& file_name) {
  if (format.begins.empty() && format.contains.empty()) return {};
  if (!format.begins.empty() && first_kilobyte.starts_with(format.begins)) return {};
  if (!format.contains.empty() && first_kilobyte.find(format.contains) != std::string_view::npos)
    return {};
  return Status::failure(StatusCode::malformed_file, kNone,
                         "%.100s: the content is not that of a .%s file", file_name.c_str(),
                         std::string(format.extension).c_str());
}

}  // namespace sunder::assimp_import
