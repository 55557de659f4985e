#pragma once

// All public headers. A build that counts its compile time includes what it uses instead.

#include <sunder/animation/blend.h>
#include <sunder/animation/clip_editor.h>
#include <sunder/animation/clip_player.h>
#include <sunder/animation/edit_pose.h>
#include <sunder/animation/pull.h>
#include <sunder/bodies/convex_hulls.h>
#include <sunder/bodies/mass_properties.h>
#include <sunder/core/api.h>
#include <sunder/core/character.h>
#include <sunder/core/clip.h>
#include <sunder/core/index.h>
#include <sunder/core/math.h>
#include <sunder/core/memory_scope.h>
#include <sunder/core/mesh.h>
#include <sunder/core/parallel_for.h>
#include <sunder/core/skeleton.h>
#include <sunder/core/skin.h>
#include <sunder/core/status.h>
#include <sunder/core/vertex_origins.h>
#include <sunder/operation/operation.h>
#include <sunder/operation/pose_spec.h>
#include <sunder/operation/weight_options.h>
#include <sunder/particles/authored_tissue.h>
#include <sunder/particles/collider.h>
#include <sunder/particles/force_tearing.h>
#include <sunder/particles/material.h>
#include <sunder/particles/particle_fork.h>
#include <sunder/particles/particle_set.h>
#include <sunder/particles/soft_body.h>
#include <sunder/particles/state_arrays.h>
#include <sunder/scene/character_asset.h>
#include <sunder/scene/character_instance.h>
#include <sunder/scene/frame_stats.h>
#include <sunder/scene/scene.h>
#include <sunder/scene/scene_command.h>
#include <sunder/skinning/bone_palette.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/blade_force.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/contact.h>
#include <sunder/tear/detached_piece.h>
#include <sunder/tear/operation_job.h>
#include <sunder/tear/preview.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/report.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_asset.h>
#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>
#include <sunder/tear/wound_mask.h>
#include <sunder/weights/influences.h>

// A world of double precision cannot hold these bodies.
#ifndef BT_USE_DOUBLE_PRECISION
#include <sunder/particles/bullet_body.h>
#endif

// Absent where the library was built without SUNDER_IO.
#if __has_include(<sunder/io/character_file.h>)
#include <sunder/io/character_bytes.h>
#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>
#endif
