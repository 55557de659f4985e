#include "tools/picture/lights.h"

namespace sunder::tools {

std::vector<StillScene::Light> lights_of(const ViewFrame& frame) {
  return {{frame.towards_eye - 0.5 * frame.right + 0.7 * frame.up, 2.5},
          {frame.towards_eye + 0.9 * frame.right - 0.1 * frame.up, 1.2},
          {0.3 * frame.towards_eye - frame.up, 0.7}};
}

}  // namespace sunder::tools
