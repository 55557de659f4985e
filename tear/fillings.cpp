#include <sunder/tear/torn_model.h>

namespace sunder {

// Nothing makes walls or caps yet.
std::span<const Triangle> TornModel::fillings(std::uint32_t) const { return {}; }

}  // namespace sunder
