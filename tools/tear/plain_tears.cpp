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

std::vector<Operation> detachments(const PoseSpec& pose, const std::vector<PiecePlace>& pieces) {
  std::vector<Operation> operations;
  for (const PiecePlace& piece : pieces) operations.push_back(DetachOperation{pose, piece});
  return operations;
}

/// The pieces that a sever takes off.
Result<std::vector<PiecePlace>> pieces_off(const SeverOperation& sever, bool takes_props,
                                           const TornModel& model) {
  Result<SeveredPieces> pieces = severed_pieces(model, sever);
  if (!pieces) return pieces.error();
  if (takes_props)
    pieces->severed.insert(pieces->severed.end(), pieces->props.begin(), pieces->props.end());
  return std::move(pieces->severed);
}

/// The operations that take a limb off without a cut.
PlainTears without_a_cut(const PoseSpec& pose, const LimbPieces& pieces) {
  PlainTears tears;
  tears.detachments = detachments(pose, pieces.places);
  tears.operation = tears.detachments.front();
  tears.detachments.erase(tears.detachments.begin());
  tears.notes.emplace_back("comes off without a cut: the limb is made of pieces of its own");
  return tears;
}

/// The pieces that the limb of a sever is made of; empty if it is joined to the rest, for a sever
/// whose fields describe a cut, and for other operations.
std::optional<LimbPieces> own_pieces(const AimedOperation& operation, const TornModel& model) {
  const auto* const sever = std::get_if<SeverOperation>(&operation);
  if (sever == nullptr || sever->tilt != 0 || sever->cap_material != kNone) return {};
  Result<LimbPieces> pieces = limb_pieces(model, *sever);
  return pieces ? std::optional(std::move(*pieces)) : std::nullopt;
}

/// The refusal of a sever that no cut makes, of a limb that comes off without one.
Status no_cut(const Status& refusal, const char* bone) {
  return Status::failure(
      refusal.code(), refusal.index(),
      "no share of '%.60s' was found at which a cut severs the limb alone, which "
      "is made of pieces of its own; --sever %.60s,detach takes them off",
      bone, bone);
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
  const bool detaches =
      wanted.option && wanted.option->detaches.value_or(run.request.pieces.has_value());
  if (wanted.option) aimed = seen(*aimed, run, tears.notes);
  if (!aimed) return aimed.error();
  if (wanted.option && !wanted.option->has_share) {
    std::optional<LimbPieces> pieces;
    if (detaches) pieces = own_pieces(*aimed, run.model);
    if (pieces && pieces->are_rigid_parts)
      return without_a_cut(std::get<SeverOperation>(*aimed).pose, *pieces);
    Result<AimedOperation> moved = placed(*aimed, run, tears.notes);
    if (!moved && !detaches) pieces = own_pieces(*aimed, run.model);
    if (!moved && pieces) {
      const auto& sever = std::get<SeverOperation>(*aimed);
      if (detaches) return without_a_cut(sever.pose, *pieces);
      return no_cut(moved.error(), sever.place.bone.c_str());
    }
    if (!moved) return moved.error();
    aimed = std::move(moved);
  }
  Result<Operation> plain = resolve(run.model, *aimed);
  if (!plain) return plain.error();
  tears.operation = std::move(*plain);
  const auto* const sever = std::get_if<SeverOperation>(&*aimed);
  if (sever == nullptr || !detaches) return tears;
  const auto pieces = pieces_off(*sever, wanted.option->takes_props, run.model);
  if (!pieces) return pieces.error();
  tears.detachments = detachments(sever->pose, *pieces);
  return tears;
}

std::string advice_on(const WantedOperation& wanted, const Character& source) {
  return std::visit([&](const auto& of) { return advice_on_names(of, source); }, wanted.operation);
}

}  // namespace sunder::tools
