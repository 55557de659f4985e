#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

#include "tools/posed_model.h"

namespace sunder::tools {

/// Pulls the lips of a fresh tear apart for a picture, in any pose. The pull fades with the distance along the torn surface, never
/// across the gap, so that each side moves with its own lip.
class PullOpen {
 public:
  /// A lip, from one end of the tear to the other, without its tips; vertices of one mesh.
  struct LipVertex {
    std::uint32_t mesh = 0, vertex = 0;
  };
  using Lip = std::vector<LipVertex>;

  /// @param posed  the torn model in some pose, in which distances are measured.
  /// @param reach  how far along the surface the pull is felt, metres.
  PullOpen(const TornModel& model, const ChangeRecord& change, const std::vector<DeformedMesh>& posed, double reach);

  /// Moves positions by at most `amount` to each side.
  void apply(double amount, std::vector<DeformedMesh>& posed) const;

  /// Left and right lips of each run of torn surface.
  [[nodiscard]] const std::vector<Lip>& lips() const { return lips_; }

 private:
  static constexpr std::uint32_t kSides = 2;
  struct Pair {
    std::uint32_t left, right;    ///< Points.
    std::uint32_t before, after;  ///< Neighbours along the tear, in pairs_; itself at the ends.
    double share;                 ///< 0 at the tips, 1 in the middle.
  };
  /// The nearest lip of one side, and how strongly it pulls.
  struct Pull {
    std::uint32_t pair = kNone;
    double strength = 0;
  };

  void number_vertices(const TornModel& model);
  void chain_pairs(const ChangeRecord& change, const std::vector<DeformedMesh>& posed);
  void spread(const std::vector<DeformedMesh>& posed, double reach);
  [[nodiscard]] Vec3d position(std::uint32_t point, const std::vector<DeformedMesh>& posed) const;
  [[nodiscard]] Vec3d normal(std::uint32_t point, const std::vector<DeformedMesh>& posed) const;
  [[nodiscard]] Vec3d middle_of_neighbours(std::uint32_t point, const std::vector<DeformedMesh>& posed) const;

  std::vector<LipVertex> vertex_of_point_;
  std::vector<std::vector<std::uint32_t>> point_of_vertex_;  ///< By mesh.
  std::vector<std::vector<std::uint32_t>> neighbours_;       ///< Points, by point, across edges of the torn surface.
  std::vector<Pair> pairs_;
  std::vector<std::array<Pull, kSides>> pulls_;  ///< By point: of the left lip, of the right one.
  std::vector<Lip> lips_;
};

}  // namespace sunder::tools
