#pragma once

#include <string>
#include <vector>

#include "tools/messages/overwriting.h"

namespace sunder::tools {

/// The first output that cannot be a file: it has no name, is a folder, or its folder does not
/// exist. Empty if there is none, which does not promise that all can be written.
[[nodiscard]] std::string impossible_output(const std::vector<NamedFile>& outputs);

/// "--output a.obj: the file is written as GLB, but its name does not end in .glb"; empty if it
/// does, in small or capital letters.
/// @param ending  "glb", which VRM files are too.
[[nodiscard]] std::string other_ending(const NamedFile& output, const std::string& ending);

}  // namespace sunder::tools
