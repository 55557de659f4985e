#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace sunder {

/// The ending of a file's name, which tells its format: ".glb", in small letters.
[[nodiscard]] inline std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace sunder
