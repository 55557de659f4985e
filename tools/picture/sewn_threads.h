#pragma once

#include <sunder/particles/soft_body.h>
#include <sunder/tear/torn_model.h>

#include <span>
#include <vector>

#include "tools/picture/model_looks.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// Draws the threads of sutures as dark stitches across the lips: each enters the skin beside one
/// lip and leaves it beside the other one. O(vertices + faces of meshes with threads).
/// @param open       the torn meshes, lips where they gape.
/// @param loads      of the threads, to leave out broken ones; empty: none is.
/// @param thickness  of the flesh, metres; stitches reach as far from a lip.
void add_threads(const TornModel& torn, std::span<const DeformedMesh> open,
                 std::span<const ThreadLoad> loads, double thickness, RenderScene& scene);

}  // namespace sunder::tools
