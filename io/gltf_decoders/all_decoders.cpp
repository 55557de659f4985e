#include "io/gltf_decoders/all_decoders.h"

#include "io/gltf_decoders/draco_primitives.h"
#include "io/gltf_decoders/meshopt_views.h"
#include "io/gltf_decoders/parse_json.h"

namespace sunder::gltf {

const Decoders& all_decoders() {
  static constexpr Decoders kAll = {parse_json_fast, decode_meshopt_views, decode_draco_primitives};
  return kAll;
}

}  // namespace sunder::gltf
