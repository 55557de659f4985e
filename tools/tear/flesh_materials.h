#pragma once

#include <sunder/core/character.h>

#include <set>
#include <vector>

#include "tools/model/surface_kinds.h"
#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// The materials of what operations and --open fill wounds with: flesh, as --flesh says, unless the
/// operation named one or the surface beside has no flesh.
class FleshMaterials {
 public:
  /// @param run  outlives this.
  /// @return the failures of SurfaceKinds::create().
  [[nodiscard]] static Result<FleshMaterials> create(const TearRun& run);

  /// SaveOptions::materials.
  [[nodiscard]] std::vector<AppendedMaterial> appended() const;

  /// The number of the first of SaveOptions::painted.
  [[nodiscard]] std::uint32_t first_painted(std::size_t appended) const {
    return kinds_.material_count() + static_cast<std::uint32_t>(appended);
  }

  /// The material of a wall beside one of the source's. Links of a robot have no flesh.
  [[nodiscard]] std::uint32_t beside(std::uint32_t mesh, std::uint32_t material) const;

  /// Gives it to the walls and caps of a torn model.
  void give_to_fillings(Character& torn) const;
  /// Gives it to those of a piece. @return the piece as it was if it has none.
  [[nodiscard]] std::shared_ptr<const Character> with_flesh(const DetachedPiece& piece) const;

 private:
  FleshMaterials(const TearRun& run, SurfaceKinds kinds);
  void give_to(std::uint32_t source_mesh, std::uint32_t submesh, Mesh& mesh) const;

  const TearRun& run_;
  SurfaceKinds kinds_;
  std::set<std::uint32_t> named_;  ///< By operations, and by `_WALL_MATERIAL`.
};

/// Whether operations filled wounds with walls or caps.
[[nodiscard]] bool has_fillings(const TornModel& model);

}  // namespace sunder::tools
