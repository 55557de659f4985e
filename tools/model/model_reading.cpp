#include "tools/model/model_reading.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sunder::tools {

LoadOptions load_options(const ModelReading& reading) {
  LoadOptions options;
  options.strict = reading.strict;
  options.roots = reading.package_roots;
  options.import_seconds = reading.import_seconds;
  options.maximum_memory = static_cast<std::uint64_t>(std::ceil(reading.memory * (1 << 20)));
  options.maximum_bytes = std::max(options.maximum_bytes, options.maximum_memory);
  return options;
}

RobotLoadOptions robot_load_options(const ModelReading& reading) {
  RobotLoadOptions options;
  options.strict = reading.strict;
  options.meshes = load_options(reading);
  return options;
}

}  // namespace sunder::tools
