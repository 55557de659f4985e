#pragma once

#include <sunder/io/character_file.h>
#include <sunder/tear/topology.h>

#include "tools/messages/json.h"

namespace sunder::tools {

// As the reports of all verbs have them; docs/command/info.md.
[[nodiscard]] Json to_json(const TopologyCounts& counts);
[[nodiscard]] Json to_json(const LoadReport& report);

}  // namespace sunder::tools
