#include "tools/model/model_reading.h"

namespace sunder::tools {

LoadOptions load_options(const ModelReading& reading) {
  LoadOptions options;
  options.strict = reading.strict;
  options.roots = reading.package_roots;
  options.import_seconds = reading.import_seconds;
  return options;
}

RobotLoadOptions robot_load_options(const ModelReading& reading) {
  RobotLoadOptions options;
  options.strict = reading.strict;
  options.meshes = load_options(reading);
  return options;
}

}  // namespace sunder::tools
