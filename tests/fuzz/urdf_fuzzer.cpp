// libFuzzer target: the text of a URDF file, from the first check to the robot. No mesh is read.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/gltf/refusal.h"
#include "io/urdf/findings.h"
#include "io/urdf/read_robot.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder;
  RobotLoadOptions options;
  options.shapes = RobotShapes::none;
  urdf::Findings findings(false);
  const auto loaded = gltf::without_exceptions<LoadedRobot>([&] {
    return urdf::read_robot(std::string(reinterpret_cast<const char*>(data), size),
                            "/nowhere/robot.urdf", options, findings);
  });
  if (loaded && !validate_robot(loaded->robot)) std::abort();
  if (!loaded && loaded.error().code() == StatusCode::internal_error) std::abort();
  return 0;
}
