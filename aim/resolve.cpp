#include <sunder/aim/aim.h>

#include "aim/operations.h"
#include "aim/posed_surface.h"
#include "core/internal/out_of_memory.h"

namespace sunder {
namespace {

struct Resolve {
  const aim::PosedSurface& surface;

  Result<Operation> operator()(const SlashOperation& slash) const {
    return aim::resolve_slash(surface, slash);
  }
  Result<Operation> operator()(const SeverOperation& sever) const {
    return aim::resolve_sever(surface, sever);
  }
  Result<Operation> operator()(const PunctureOperation& puncture) const {
    return aim::resolve_puncture(surface, puncture);
  }
  Result<Operation> operator()(const IncisionOperation& incision) const {
    return aim::resolve_incision(surface, incision);
  }
};

}  // namespace

Result<Operation> resolve(const TornModel& model, const AimedOperation& operation) {
  return or_out_of_memory([&]() -> Result<Operation> {
    const PoseSpec& pose =
        std::visit([](const auto& aimed) -> const PoseSpec& { return aimed.pose; }, operation);
    const auto surface = aim::PosedSurface::create(model, pose);
    if (!surface) return surface.error();
    return std::visit(Resolve{*surface}, operation);
  });
}

}  // namespace sunder
