#pragma once

#include <sunder/tear/torn_asset.h>
#include <sunder/tear/torn_model.h>

#include <memory>
#include <vector>

#include "core/internal/threads.h"
#include "tear/model/model_state.h"
#include "tear/posed/source_trees.h"

namespace sunder {

struct TornAsset::Parts {
  explicit Parts(std::shared_ptr<const Character> of)
      : character(std::move(of)),
        surface(tear::build_surface(*character)),
        trees(std::make_unique<tear::SourceTrees>(*character)) {}

  /// An asset of one model only, which takes the surface.
  [[nodiscard]] static std::shared_ptr<const TornAsset> make_private(
      std::shared_ptr<const Character> character);

  /// An idle workspace, or a new one. @throws std::bad_alloc
  [[nodiscard]] std::unique_ptr<TornModel::State> take(const TornCapacity& capacity);
  /// @param workspace  with operations or without.
  void give_back(std::unique_ptr<TornModel::State> workspace) noexcept;
  [[nodiscard]] std::unique_ptr<TornModel::State> make_workspace(const TornCapacity& capacity);

  const std::shared_ptr<const Character> character;
  tear::Surface surface;  ///< Empty in a private asset whose model was made.
  const std::unique_ptr<const tear::SourceTrees> trees;
  std::shared_ptr<const tear::SurfaceCells> cells;  ///< Null in a private asset.
  bool is_private = false;

  Mutex mutex;  ///< Of what follows.
  std::vector<std::unique_ptr<TornModel::State>> idle;
  std::size_t kept = 1;  ///< At most so many idle workspaces.
};

/// @return limit_exceeded if there are too many triangles, including the capacity.
[[nodiscard]] Status check_size(const Character& character, const TornCapacity& capacity);

}  // namespace sunder
