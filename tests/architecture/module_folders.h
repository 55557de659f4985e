#pragma once

#include <string>

namespace sunder::test {

/// The folder of a module's sources, relative to the repository. Most modules have a folder of
/// their name at the top level; some lie in that of another one, or in pipeline/.
std::string folder_of(const std::string& module);

/// The module of a source, from its path relative to the repository: "animation" for
/// "skinning/animation/blend.cpp", "skinning" for "skinning/pose.cpp".
std::string module_of(const std::string& path);

}  // namespace sunder::test
