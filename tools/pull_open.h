#pragma once

#include <sunder/tear/torn_model.h>

#include <array>
#include <vector>

#include "tools/posed_model.h"

namespace sunder::tools {

/// Two lips that a picture pulls apart, at one place of the tear. Points.
struct PulledPair {
  std::uint32_t left = 0, right = 0;
  std::uint32_t before = 0, after = 0;  ///< Neighbours of the left one along the tear; itself at the ends.
  double share = 0;                     ///< 0 at the tips, 1 in the middle and all around a closed tear.
};

/// The lips that an operation left, run by run.
/// @param posed  the model in some pose, in which lengths are measured.
[[nodiscard]] std::vector<PulledPair> chain_lips(const TornModel& model, const ChangeRecord& change,
                                                 const std::vector<DeformedMesh>& posed);

/// The vertices of each surface point, and its neighbours.
struct PointMap {
  explicit PointMap(const TornModel& model);

  /// Those along the border, of a point on one; else all.
  [[nodiscard]] std::vector<std::uint32_t> neighbours_to_follow(std::uint32_t point) const;

  struct AnyVertex {
    std::uint32_t mesh = kNone, vertex = kNone;
  };
  std::vector<AnyVertex> vertex_of_point;                   ///< kNone: no triangle is left there.
  std::vector<std::vector<std::uint32_t>> point_of_vertex;  ///< By mesh.
  std::vector<std::vector<std::uint32_t>> neighbours;       ///< Points, by point, along edges: once for each face of the edge.
};

/// Pulls lips apart for a picture, in any pose. The pull fades with the distance along the torn surface, never across the gap, so
/// that each side moves with its own lip.
class PullOpen {
 public:
  /// @param pairs  of any of the model's operations; what later ones took away is left out.
  /// @param posed  the torn model in some pose, in which distances are measured.
  /// @param reach  how far along the surface the pull is felt, metres.
  PullOpen(const TornModel& model, const std::vector<PulledPair>& pairs, const std::vector<DeformedMesh>& posed, double reach);

  /// Moves positions by at most `amount` to each side.
  void apply(double amount, std::vector<DeformedMesh>& posed) const;

 private:
  static constexpr std::uint32_t kSides = 2;
  /// The nearest lip of one side, and how strongly it pulls.
  struct Pull {
    std::uint32_t pair = kNone;
    double strength = 0;
  };

  void spread(const std::vector<DeformedMesh>& posed, double reach);
  [[nodiscard]] Vec3d position(std::uint32_t point, const std::vector<DeformedMesh>& posed) const;
  [[nodiscard]] Vec3d normal(std::uint32_t point, const std::vector<DeformedMesh>& posed) const;
  [[nodiscard]] Vec3d middle_of_neighbours(std::uint32_t point, const std::vector<DeformedMesh>& posed) const;

  PointMap map_;
  std::vector<PulledPair> pairs_;
  std::vector<std::array<Pull, kSides>> pulls_;  ///< By point: of the left lip, of the right one.
};

}  // namespace sunder::tools
