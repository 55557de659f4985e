#include <sunder/aim/aim.h>

#include <optional>
#include <string>
#include <vector>

#include "core/internal/out_of_memory.h"
#include "pipeline/aim/bone_tree.h"
#include "pipeline/aim/facing.h"
#include "pipeline/aim/limb.h"
#include "pipeline/aim/limb_pieces.h"
#include "pipeline/aim/operations.h"
#include "pipeline/aim/posed_surface.h"

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

const PoseSpec& pose_of(const AimedOperation& operation) {
  return std::visit([](const auto& of) -> const PoseSpec& { return of.pose; }, operation);
}

/// The place on a limb; null for an incision, which has none.
LimbPlace* place_of(AimedOperation& operation) {
  return std::visit(
      [](auto& of) -> LimbPlace* {
        if constexpr (requires { of.place; })
          return &of.place;
        else
          return nullptr;
      },
      operation);
}

/// Writes the view of an operation as a direction; of a sever only if it leans.
struct TurnView {
  const aim::PosedSurface& surface;
  const Vec3d& front;

  Status operator()(SlashOperation& slash) const { return turn(slash.place, slash.from); }
  Status operator()(PunctureOperation& puncture) const {
    return turn(puncture.place, puncture.from);
  }
  Status operator()(SeverOperation& sever) const {
    return sever.tilt == 0 ? Status() : turn(sever.place, sever.from);
  }
  Status operator()(IncisionOperation&) const { return {}; }

 private:
  Status turn(const LimbPlace& place, std::optional<View>& from) const {
    if (from && std::holds_alternative<ViewDirection>(*from)) return {};
    if (from) {
      from = ViewDirection{aim::side_direction(std::get<ViewSide>(*from), front)};
      return {};
    }
    const Result<aim::Limb> limb = aim::find_limb(surface, place);
    if (!limb) return limb.error();
    from = ViewDirection{aim::default_direction(*limb, front)};
    return {};
  }
};

/// Why an operation misses its limb; a sever, why it does not take off most of the whole limb.
Status miss(const aim::PosedSurface& surface, const AimedOperation& operation, bool counts_props) {
  if (const auto* const sever = std::get_if<SeverOperation>(&operation))
    return aim::severs(surface, *sever, {true, counts_props});
  const Result<Operation> plain = std::visit(Resolve{surface}, operation);
  return plain ? Status() : plain.error();
}

/// Whether a sever is of a limb that rigid parts make. It is at its own share or nowhere: farther
/// on, a cut leaves most of a block, or the blocks beside it.
bool keeps_its_share(const aim::PosedSurface& surface, const AimedOperation& operation) {
  const auto* const sever = std::get_if<SeverOperation>(&operation);
  if (sever == nullptr) return false;
  const Skeleton& skeleton = surface.character().skeleton;
  const Result<std::uint32_t> bone = find_bone(skeleton, sever->place.bone);
  return bone && aim::BoneTree(surface).is_made_of_parts(skeleton, *bone);
}

/// The share at which an operation hits, its own or the nearest one.
std::optional<double> share_that_hits(const aim::PosedSurface& surface, AimedOperation operation) {
  LimbPlace& place = *place_of(operation);
  const double wanted = place.at;
  if (keeps_its_share(surface, operation))
    return miss(surface, operation, false).is_ok() ? std::optional(wanted) : std::nullopt;
  for (const bool counts_props : {false, true}) {
    const auto hits_at = [&](double at) {
      place.at = at;
      return miss(surface, operation, counts_props).is_ok();
    };
    if (hits_at(wanted)) return wanted;
    if (const auto share = aim::nearest_share(wanted, hits_at)) return share;
    if (!std::holds_alternative<SeverOperation>(operation)) return {};
  }
  return {};
}

/// What else a sever that hits at no share might do. @param works_there  it cuts something at its
/// own share
std::string sever_advice(const aim::PosedSurface& surface, SeverOperation sever, Index bone,
                         bool works_there) {
  const std::vector<Bone>& bones = surface.character().skeleton.bones;
  if (const Index parent = bones[bone].parent; parent != kNone) {
    sever.place.bone = bones[parent].name;
    if (share_that_hits(surface, sever))
      return "; that of '" + sever.place.bone + "', which moves it, can be severed";
  }
  return works_there ? "; give one to sever it there all the same" : "";
}

/// The failure of an operation that hits at no share of its bone. @param fault  at its own share;
/// ok for a sever that takes off less than most of the limb there.
Status no_share(const aim::PosedSurface& surface, const AimedOperation& operation, Index bone,
                const Status& fault) {
  const auto* const sever = std::get_if<SeverOperation>(&operation);
  if (sever == nullptr) return fault;
  const Status why = fault ? miss(surface, operation, true) : fault;
  return Status::failure(why.code(), why.index(),
                         "%s; no share of the bone was found at which most of the limb comes off "
                         "alone%s",
                         std::string(why.text()).c_str(),
                         sever_advice(surface, *sever, bone, fault.is_ok()).c_str());
}

}  // namespace

Result<Operation> resolve(const TornModel& model, const AimedOperation& operation) {
  return or_out_of_memory([&]() -> Result<Operation> {
    const auto surface = aim::PosedSurface::create(model, pose_of(operation));
    if (!surface) return surface.error();
    return std::visit(Resolve{*surface}, operation);
  });
}

Result<AimedOperation> at_nearest_share(const TornModel& model, const AimedOperation& operation) {
  return or_out_of_memory([&]() -> Result<AimedOperation> {
    const auto surface = aim::PosedSurface::create(model, pose_of(operation));
    if (!surface) return surface.error();
    AimedOperation moved = operation;
    LimbPlace* const place = place_of(moved);
    const Result<Operation> here = std::visit(Resolve{*surface}, operation);
    const Result<std::uint32_t> bone =
        place == nullptr ? kNone : find_bone(surface->character().skeleton, place->bone);
    if (!bone) return bone.error();
    if (place == nullptr || (!here && here.error().code() != StatusCode::not_found))
      return here ? Result<AimedOperation>(moved) : here.error();
    const std::optional<double> share = share_that_hits(*surface, operation);
    if (!share) return no_share(*surface, operation, *bone, here ? Status() : here.error());
    place->at = *share;
    return moved;
  });
}

Result<SeveredPieces> severed_pieces(const TornModel& model, const SeverOperation& sever) {
  return or_out_of_memory([&]() -> Result<SeveredPieces> {
    const auto surface = aim::PosedSurface::create(model, sever.pose);
    if (!surface) return surface.error();
    return aim::find_severed_pieces(*surface, sever);
  });
}

Result<LimbPieces> limb_pieces(const TornModel& model, const SeverOperation& sever) {
  return or_out_of_memory([&]() -> Result<LimbPieces> {
    const auto surface = aim::PosedSurface::create(model, sever.pose);
    if (!surface) return surface.error();
    return aim::find_limb_pieces(*surface, sever.place);
  });
}

Result<Facing> find_facing(const Character& character) {
  return or_out_of_memory([&] { return aim::facing_of(character); });
}

Result<AimedOperation> seen_by(const TornModel& model, const AimedOperation& operation,
                               const Vec3d& front) {
  return or_out_of_memory([&]() -> Result<AimedOperation> {
    const auto surface = aim::PosedSurface::create(model, pose_of(operation));
    if (!surface) return surface.error();
    AimedOperation seen = operation;
    if (const Status status = std::visit(TurnView{*surface, front}, seen); !status) return status;
    return seen;
  });
}

}  // namespace sunder
