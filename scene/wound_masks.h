#pragma once

#include <sunder/tear/wound_mask.h>

#include <map>
#include <span>

namespace sunder::scene {

/// The wounds of an instance in the textures of its meshes, kept in step with its operations.
class WoundMasks {
 public:
  /// A mask, and the texels that may have changed since it was taken last.
  struct Taken {
    const WoundMask* mask = nullptr;
    TexelRectangle changed;
  };

  /// @return as WoundMask::create().
  Status begin(const TornModel& model, Index mesh, const WoundMaskOptions& options);
  void end(Index mesh) noexcept { masks_.erase(mesh); }
  /// A mask that memory does not suffice for is painted anew when it is taken.
  void follow(const TornModel& model, std::span<const ChangeRecord> changes) noexcept;
  /// @return not_found: the mesh has none; limit_exceeded: out of memory.
  Result<Taken> take(const TornModel& model, Index mesh);
  /// The mask alone; what changed is kept. @return as take().
  Result<const WoundMask*> peek(const TornModel& model, Index mesh);

 private:
  struct OfMesh {
    WoundMask mask;
    TexelRectangle changed;
    bool is_stale = false;
  };
  Result<OfMesh*> find(const TornModel& model, Index mesh);
  std::map<Index, OfMesh> masks_;
};

}  // namespace sunder::scene
