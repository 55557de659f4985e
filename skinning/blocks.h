#pragma once

#include <sunder/skinning/skinned_mesh.h>

#include <cstdint>
#include <vector>

#include "skinning/aligned_vector.h"
#include "skinning/mover_runs.h"
#include "skinning/slot_set.h"

namespace sunder::skinning {

/// Vertices per block. Vectors of fewer lanes process a block in parts.
inline constexpr std::uint32_t kLanes = 16;
/// Maximum number of vertices gathered at a time: their outputs stay in the L2 cache.
inline constexpr std::uint32_t kWindow = 4096;

/// The header of a block, which a kernel reads before its numbers. Small, because it is read with
/// every block.
struct Block {
  std::uint64_t numbers = 0;  ///< First of its numbers in Blocks::stream.
  /// The smallest. Vertices are consecutive unless the block is scattered.
  std::uint32_t first_vertex = 0;
  std::uint32_t slots = 0;  ///< First of the slots that move it, in Blocks::slots, ascending.
  std::uint16_t slot_count = 0;
  std::uint8_t lane_count = kLanes;
  std::uint8_t kind = 0;    ///< Bits of BlockKind.
  std::uint32_t extra = 0;  ///< In Blocks::extras, if `kind` has any bit.
};

/// Bits of Block::kind.
enum BlockKind : std::uint8_t {
  kSparse = 1,  ///< Stores influences per vertex, not weights per slot: too few bones are shared.
  kScattered = 2,  ///< Its vertices are not consecutive.
  kMorphed = 4,
  kExact = 8,  ///< Some of its vertices have a position per influence.
};

/// Fields that only some blocks need. Each index is the first of the block's entries in an array of
/// Blocks.
struct BlockExtra {
  std::uint32_t places = 0;       ///< kLanes vertices, in Blocks::Scattered::places.
  std::uint32_t last_vertex = 0;  ///< The largest.
  std::uint32_t window = 0;       ///< First of the vertices that it was gathered from.
  std::uint32_t influences = 0;   ///< Of lane 0, in Blocks::Sparse::influences.
  /// kLanes ends in Blocks::Sparse::lane_ends, relative to `influences`.
  std::uint32_t lane_ends = 0;
  std::uint32_t morphs = 0, morph_count = 0;       ///< In Blocks::Morphs::parts.
  std::uint32_t exact_lanes = 0, exact_count = 0;  ///< In Blocks::Exact::lanes.
};

/// The displacements of one morph target in a block: kLanes x, y, z of positions, then of normals
/// and tangents if the mesh has them.
struct BlockMorph {
  std::uint32_t target = 0;
  std::uint64_t numbers = 0;  ///< In Blocks::Morphs::stream.
};

/// A vertex with a position per influence.
struct ExactLane {
  std::uint32_t lane = 0;
  std::uint32_t influences = 0, influence_count = 0;  ///< In Blocks::Exact::influences.
  /// In Blocks::Exact::stream: per influence the position, normal and tangent, as far as the mesh
  /// has them; then the same for each morph target of the mesh.
  std::uint64_t numbers = 0;
};

/// The attributes and movers that all vertices of a mesh have.
struct VertexLayout {
  std::size_t slot_count = 0;
  bool has_normals = false, has_tangents = false;
  std::uint32_t first_morph_weight = 0, morph_count = 0;

  /// Floats per vertex before its weights.
  [[nodiscard]] std::uint32_t attribute_floats() const {
    return 3 + (has_normals ? 3 : 0) + (has_tangents ? 4 : 0);
  }
  [[nodiscard]] std::uint32_t displacement_floats() const {
    return 3 + (has_normals ? 3 : 0) + (has_tangents ? 3 : 0);
  }
};

/// The state of a SkinnedMesh.
struct Blocks {
  struct Sparse {
    std::vector<Influence> influences;
    std::vector<std::uint32_t> lane_ends;
  };
  struct Scattered {
    std::vector<std::uint32_t> places;
    std::uint32_t end = 0;  ///< From this block on, all are in the order of their vertices.
  };
  struct Morphs {
    std::vector<BlockMorph> parts;
    AlignedVector<float> stream;
  };
  struct Exact {
    std::vector<ExactLane> lanes;
    std::vector<Influence> influences;
    std::vector<float> stream;
  };

  std::uint64_t id = 0;
  std::uint64_t revision = 1;
  std::uint32_t vertex_count = 0;
  VertexLayout layout;

  /// The numbers of the blocks, kLanes each: x, y, z; of normals x, y, z; of tangents x, y, z, w;
  /// then weights, slot by slot.
  AlignedVector<float> stream;
  std::vector<Block> blocks;
  std::vector<std::uint64_t> revisions;  ///< One per block: when it was made.
  std::vector<std::uint16_t> slots;
  std::vector<BlockExtra> extras;
  Sparse sparse;
  Scattered scattered;
  Morphs morphs;
  Exact exact;
  SlotSet scratch;   ///< Slots of the block under construction.
  MoverRuns movers;  ///< The blocks of each slot, then of each morph target.

  [[nodiscard]] std::uint32_t block_count() const {
    return static_cast<std::uint32_t>(blocks.size());
  }
  [[nodiscard]] std::uint32_t last_vertex(const Block& block) const {
    return (block.kind & kScattered) != 0 ? extras[block.extra].last_vertex
                                          : block.first_vertex + block.lane_count - 1;
  }
  /// The first vertex such that this block and the ones gathered with it hold all vertices from
  /// there on, and no block before them does.
  [[nodiscard]] std::uint32_t window(const Block& block) const {
    return (block.kind & kScattered) != 0 ? extras[block.extra].window : block.first_vertex;
  }
};

}  // namespace sunder::skinning
