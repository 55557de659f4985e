#pragma once

#include <filesystem>
#include <string>

namespace sunder::tools {

/// "wrote demo/torn.png, 134 kB".
[[nodiscard]] std::string written(const std::filesystem::path& file);

}  // namespace sunder::tools
