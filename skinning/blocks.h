#pragma once

#include <sunder/skinning/skinned_mesh.h>

#include <cstdint>
#include <vector>

#include "skinning/aligned_vector.h"
#include "skinning/mover_runs.h"

namespace sunder::skinning {

inline constexpr std::uint32_t kLanes =
    16;  ///< Vertices a block. Vectors of fewer lanes take a block in parts.
/// Vertices gathered at a time, at most: what they write to stays in the L2 cache.
inline constexpr std::uint32_t kWindow = 4096;

/// What a kernel reads of a block before its numbers. Small: it is read with every block.
struct Block {
  std::uint64_t numbers = 0;  ///< First of its numbers in Blocks::stream.
  std::uint32_t first_vertex =
      0;  ///< The smallest. Vertices follow one another, unless there is a `Places`.
  std::uint32_t slots = 0;  ///< First of the slots that move it, in Blocks::slots, ascending.
  std::uint16_t slot_count = 0;
  std::uint8_t lane_count = kLanes;
  std::uint8_t kind = 0;    ///< Bits of BlockKind.
  std::uint32_t extra = 0;  ///< In Blocks::extras, where `kind` has any bit.
};

enum BlockKind : std::uint8_t {
  kSparse =
      1,  ///< Influences a vertex instead of weights a slot: its vertices share too few bones.
  kScattered = 2,  ///< Its vertices do not follow one another.
  kMorphed = 4,
  kExact = 8,  ///< Some of its vertices have a position for each influence.
};

/// What only some blocks have. Each index is the first of its own in an array of Blocks.
struct BlockExtra {
  std::uint32_t places = 0;       ///< kLanes vertices, in Blocks::places.
  std::uint32_t last_vertex = 0;  ///< The largest.
  std::uint32_t window = 0;       ///< First vertex of those it was gathered from.
  std::uint32_t influences = 0;   ///< Of lane 0, in Blocks::influences; `lane_ends` follow.
  std::uint32_t lane_ends = 0;    ///< kLanes ends in Blocks::lane_ends, counted from `influences`.
  std::uint32_t morphs = 0, morph_count = 0;       ///< In Blocks::morphs.
  std::uint32_t exact_lanes = 0, exact_count = 0;  ///< In Blocks::exact_lanes.
};

/// A morph target's part in a block: its displacements, kLanes x, y, z of positions, then of
/// normals, of tangents as the mesh has them.
struct BlockMorph {
  std::uint32_t target = 0;
  std::uint64_t numbers = 0;  ///< In Blocks::morph_stream.
};

/// A vertex with a position for each influence.
struct ExactLane {
  std::uint32_t lane = 0;
  std::uint32_t influences = 0, influence_count = 0;  ///< In Blocks::exact_influences.
  std::uint64_t numbers =
      0;  ///< In Blocks::exact_stream: an influence's position, normal, tangent as the mesh has
          ///< them; then, for each target of the mesh, as many again.
};

/// What a SkinnedMesh holds.
struct Blocks {
  std::uint64_t id = 0;
  std::uint64_t revision = 1;
  std::uint32_t vertex_count = 0;
  std::size_t slot_count = 0;
  bool has_normals = false, has_tangents = false;
  std::uint32_t first_morph_weight = 0, morph_count = 0;

  /// A block's numbers, kLanes each: x, y, z; of normals x, y, z; of tangents x, y, z, w; then
  /// weights, a slot after another.
  AlignedVector<float> stream;
  std::vector<Block> blocks;
  std::vector<std::uint64_t> revisions;  ///< One a block: when it became what it is.
  std::vector<std::uint16_t> slots;
  std::vector<BlockExtra> extras;
  std::vector<std::uint32_t> places;
  std::vector<Influence> influences;
  std::vector<std::uint32_t> lane_ends;
  std::vector<BlockMorph> morphs;
  AlignedVector<float> morph_stream;
  std::vector<ExactLane> exact_lanes;
  std::vector<Influence> exact_influences;
  std::vector<float> exact_stream;

  std::uint32_t scattered_end = 0;  ///< From this block on, all lie in the order of their vertices.

  std::vector<std::uint16_t> scratch;  ///< Slots of the block that is being made.

  MoverRuns movers;  ///< Blocks by slot, then by morph target.

  [[nodiscard]] std::uint32_t block_count() const {
    return static_cast<std::uint32_t>(blocks.size());
  }
  /// Floats a vertex before its weights.
  [[nodiscard]] std::uint32_t attribute_floats() const {
    return 3 + (has_normals ? 3 : 0) + (has_tangents ? 4 : 0);
  }
  [[nodiscard]] std::uint32_t displacement_floats() const {
    return 3 + (has_normals ? 3 : 0) + (has_tangents ? 3 : 0);
  }
  [[nodiscard]] std::uint32_t last_vertex(const Block& block) const {
    return (block.kind & kScattered) != 0 ? extras[block.extra].last_vertex
                                          : block.first_vertex + block.lane_count - 1;
  }
  /// First vertex from which on blocks lie that hold this block's vertices and no others before.
  [[nodiscard]] std::uint32_t window(const Block& block) const {
    return (block.kind & kScattered) != 0 ? extras[block.extra].window : block.first_vertex;
  }
};

}  // namespace sunder::skinning
