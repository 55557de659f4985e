#include "tools/tear/plain_tears.h"

#include <sunder/aim/aim.h>

#include <optional>
#include <utility>
#include <variant>

#include "tools/messages/printed.h"
#include "tools/model/named_poses.h"

namespace sunder::tools {
namespace {

/// "+z", "-x" or "0.6/0/0.8".
std::string direction_text(const Vec3d& direction) {
  if (direction == Vec3d(0, 0, 1)) return "+z";
  if (direction == Vec3d(0, 0, -1)) return "-z";
  if (direction == Vec3d(1, 0, 0)) return "+x";
  if (direction == Vec3d(-1, 0, 0)) return "-x";
  return printed("%.3g/%.3g/%.3g", direction.x(), direction.y(), direction.z());
}

/// Whether the side from which an operation is seen depends on which way the character faces.
bool depends_on_facing(const AimedOperation& operation) {
  const auto is_side = [](const std::optional<View>& from) {
    return !from || std::holds_alternative<ViewSide>(*from);
  };
  if (const auto* const slash = std::get_if<SlashOperation>(&operation))
    return is_side(slash->from);
  if (const auto* const sever = std::get_if<SeverOperation>(&operation))
    return sever->tilt != 0 && is_side(sever->from);
  const auto* const puncture = std::get_if<PunctureOperation>(&operation);
  return puncture != nullptr && is_side(puncture->from);
}

/// The operation as it is seen by who stands before the character.
Result<AimedOperation> seen(const AimedOperation& operation, const TearRun& run,
                            std::vector<std::string>& notes) {
  if (!depends_on_facing(operation)) return operation;
  Facing facing;
  if (run.request.facing) {
    facing = {*run.request.facing / run.request.facing->norm(), true};
  } else {
    const Result<Facing> found = find_facing(run.model.source());
    if (!found) return found.error();
    facing = *found;
    const std::string direction = direction_text(facing.direction);
    if (!facing.is_certain)
      notes.push_back("which way the character faces is uncertain; taken as " + direction +
                      ", --facing says it");
    else if (facing.direction != Facing().direction)
      notes.push_back("the character faces " + direction + "; --facing overrides it");
  }
  return facing.direction == Facing().direction ? operation
                                                : seen_by(run.model, operation, facing.direction);
}

double share_of(const AimedOperation& operation) {
  return std::visit(
      [](const auto& of) {
        if constexpr (requires { of.place; })
          return of.place.at;
        else
          return 0.0;
      },
      operation);
}

/// The same operation at the nearest share that works, if none was asked for.
Result<AimedOperation> placed(const AimedOperation& operation, const TearRun& run,
                              std::vector<std::string>& notes) {
  const Result<AimedOperation> moved = at_nearest_share(run.model, operation);
  if (moved && share_of(*moved) != share_of(operation))
    notes.push_back(printed("at %.3g of the bone, the share nearest to %.3g that works",
                            share_of(*moved), share_of(operation)));
  return moved;
}

/// The detachments of what a sever takes off.
Result<std::vector<Operation>> detachments(const SeverOperation& sever, bool takes_props,
                                           const TornModel& model) {
  const Result<SeveredPieces> pieces = severed_pieces(model, sever);
  if (!pieces) return pieces.error();
  std::vector<Operation> operations;
  for (const PiecePlace& piece : pieces->severed)
    operations.push_back(DetachOperation{sever.pose, piece});
  if (takes_props)
    for (const PiecePlace& prop : pieces->props)
      operations.push_back(DetachOperation{sever.pose, prop});
  return operations;
}

}  // namespace

Result<PlainTears> plain_tears(const WantedOperation& wanted, const TearRun& run) {
  const LoggedOperation& operation = wanted.operation;
  PlainTears tears;
  if (const auto* const plain = std::get_if<Operation>(&operation)) {
    tears.operation = *plain;
    return tears;
  }
  Result<AimedOperation> aimed = std::get<AimedOperation>(operation);
  if (wanted.option) aimed = seen(*aimed, run, tears.notes);
  if (aimed && wanted.option && !wanted.option->has_share) aimed = placed(*aimed, run, tears.notes);
  if (!aimed) return aimed.error();
  Result<Operation> plain = resolve(run.model, *aimed);
  if (!plain) return plain.error();
  tears.operation = std::move(*plain);
  const auto* const sever = std::get_if<SeverOperation>(&*aimed);
  const bool detaches =
      wanted.option && wanted.option->detaches.value_or(run.request.pieces.has_value());
  if (sever == nullptr || !detaches) return tears;
  auto detached = detachments(*sever, wanted.option->takes_props, run.model);
  if (!detached) return detached.error();
  tears.detachments = std::move(*detached);
  return tears;
}

std::string advice_on(const WantedOperation& wanted, const Character& source) {
  return std::visit([&](const auto& of) { return advice_on_names(of, source); }, wanted.operation);
}

}  // namespace sunder::tools
