#pragma once

#include <sunder/particles/soft_body.h>
#include <sunder/tear/torn_model.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/picture/model_looks.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// Silk, linear RGBA.
inline const Vec4f kThreadColor(0.012f, 0.012f, 0.016f, 1.0f);

/// A stitch across the lips as a tube, which enters the skin beside one lip and leaves it beside
/// the other one.
struct ThreadTube {
  /// The ends of the thread: points on the two lips, as SutureThread's.
  std::uint32_t left = kNone, right = kNone;
  /// Of rings of kSides vertices, from the left lip to the right one. Empty: the thread is broken,
  /// or a lip has no face there any more, or no normals.
  std::vector<Vec3f> places, normals;

  static constexpr std::size_t kSides = 6;
  [[nodiscard]] std::vector<Triangle> triangles() const;
};

/// One per thread of the model. O(vertices + faces of meshes with threads).
/// @param posed      the torn meshes, lips where they gape.
/// @param loads      of the threads, to leave out broken ones; empty: none is.
/// @param thickness  of the flesh, metres; stitches reach as far from a lip.
[[nodiscard]] std::vector<ThreadTube> thread_tubes(const TornModel& torn,
                                                   std::span<const DeformedMesh> posed,
                                                   std::span<const ThreadLoad> loads,
                                                   double thickness);

/// Draws them as dark stitches.
void add_threads(std::span<const ThreadTube> threads, RenderScene& scene);

}  // namespace sunder::tools
