#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <map>
#include <new>

#include "core/internal/out_of_memory.h"
#include "tear/model/model_state.h"

namespace sunder {
namespace {

using tear::VertexRef;

/// The corners between which a vertex lies and their weights. The corners are those of the vertex;
/// their order and weights are those of the coincident corners of the first vertex at its point.
ParentBlend blend_of(const tear::SurfaceEditor& editor, std::uint32_t mesh, std::uint32_t vertex) {
  const auto coincide = [&](const VertexRef& a, const VertexRef& b) {
    return editor.births.position(a.mesh, a.vertex) == editor.births.position(b.mesh, b.vertex) &&
           std::ranges::equal(editor.births.influences(a.mesh, a.vertex),
                              editor.births.influences(b.mesh, b.vertex));
  };
  const Birth& own = editor.births.at(mesh, vertex);
  const VertexRef first = editor.births.original(mesh, vertex);
  // A vertex on the rim of a wall or cap is born in its own corner, at the place of the lip. If the
  // lip is in another mesh its vertices cannot be parents, so the vertex is posed by its own
  // weights.
  const bool is_of_rim =
      own.triangle == kNone ||
      std::ranges::count_if(own.barycentric, [](double part) { return part > 0; }) < 2;
  if (is_of_rim && first.mesh != mesh) return {vertex, {vertex, vertex, vertex}, {1, 0, 0}};
  const Birth& shared = editor.births.at(first.mesh, first.vertex);
  const Triangle& of_shared = editor.fillings.origin_triangle(first.mesh, shared.triangle);
  const Triangle& corners =
      is_of_rim ? of_shared : editor.fillings.origin_triangle(mesh, own.triangle);
  ParentBlend blend{vertex, {}, {}};
  std::size_t count = 0;
  std::uint32_t repeated = kNone;
  for (std::size_t l = 0; l < 3; ++l) {
    if (!(shared.barycentric[l] > 0)) continue;
    const auto same = std::ranges::find_if(corners, [&](std::uint32_t corner) {
      return is_of_rim ? corner == of_shared[l]
                       : coincide({mesh, corner}, {first.mesh, of_shared[l]});
    });
    if (same == corners.end()) break;
    blend.parents[count] = repeated = *same;
    blend.parts[count++] = static_cast<float>(shared.barycentric[l]);
  }
  const auto wanted = static_cast<std::size_t>(
      std::ranges::count_if(shared.barycentric, [](double part) { return part > 0; }));
  if (count < wanted) {  // not all corners coincide: use its own birth
    blend = {vertex, corners, {}};
    for (std::size_t k = 0; k < 3; ++k) blend.parts[k] = static_cast<float>(own.barycentric[k]);
    return blend;
  }
  for (; count < 3; ++count) blend.parents[count] = repeated;
  return blend;
}

}  // namespace

Result<ParentBlends> parent_blends(const TornModel& model, std::uint32_t mesh) {
  if (Status status = model.unpack(); !status) return status;
  const tear::SurfaceEditor& editor = model.state_->editor;
  try {
    ParentBlends result;
    std::map<std::uint32_t, std::size_t> level_of;  // per exact vertex
    std::vector<std::vector<ParentBlend>> levels;
    for (const std::uint32_t vertex : editor.exact.of(mesh).vertices) {
      const ParentBlend blend = blend_of(editor, mesh, vertex);
      std::size_t level = 0;
      for (const std::uint32_t parent : blend.parents)
        if (const auto known = level_of.find(parent); known != level_of.end())
          level = std::max(level, known->second + 1);
      level_of.emplace(vertex, level);
      if (level >= levels.size()) levels.resize(level + 1);
      levels[level].push_back(blend);
    }
    for (const auto& of_level : levels) {
      result.level_begin.push_back(static_cast<std::uint32_t>(result.blends.size()));
      result.blends.insert(result.blends.end(), of_level.begin(), of_level.end());
    }
    result.level_begin.push_back(static_cast<std::uint32_t>(result.blends.size()));
    return result;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace sunder
