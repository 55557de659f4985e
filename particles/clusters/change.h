#pragma once

#include <memory>
#include <optional>

#include "particles/clusters/particle.h"
#include "particles/clusters/point_table.h"
#include "particles/internal/chunked_list.h"

namespace sunder::particles {

struct PendingWork;
struct Structure;

/// The changes of an operation to the structure, as previous values. exchange() swaps them with the
/// current values, which undoes or redoes the operation.
struct Change {
  static constexpr std::uint64_t kUnnamed = ~std::uint64_t{0};
  std::uint64_t operation =
      0;  ///< TornModel::newest_operation() at its end; 0: in progress; kUnnamed: restored.
  Index points = 0, particles = 0, lips = 0;  ///< Counts before.
  TableEnds ends_before, ends_after;
  std::vector<Index> vertices;  ///< Per mesh: the count before.
  /// Work that was left before, and when the operation was undone; null: none.
  std::shared_ptr<const PendingWork> pending_before, pending_after;

  struct OfPoint {
    Index point = 0;
    MembershipSlab slab;
    ParticleInfluences influences;
    Index owner = kNone;
    LipPoint lip;
  };
  struct OfVertex {
    Index mesh = 0, vertex = 0, point = kNone;
  };
  /// Gradients before, if they were wanted then: each point once. The others need not be computed
  /// again after undo.
  struct OfGradients {
    Index point = 0;
    bool is_known = false;
    ParticleGradients gradients;
  };
  std::optional<std::vector<OfGradients>> changed_gradients;  ///< Empty: they were not wanted.

  ChunkedList<OfPoint> changed_points;
  std::vector<std::pair<Index, Particle>> changed_particles;
  std::vector<OfVertex> changed_vertices;
  std::vector<std::pair<Index, LipEdge>> changed_lips;

  /// The entries that the operation appended, while it is undone.
  struct Appended {
    PointColumns points;
    std::vector<Particle> particles;
    std::vector<std::vector<Index>> joined;
    std::vector<LipEdge> lips;
    std::vector<std::vector<Index>> vertex_points;  ///< Per mesh.
  };
  std::shared_ptr<Appended> appended;
};

/// Undoes a change, or redoes it.
void exchange(Structure& structure, Change& change);

}  // namespace sunder::particles
