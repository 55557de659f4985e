#include <sunder/particles/soft_body.h>

#include <vector>

#include "bindings/c/numbers.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

/// Calls `call(found, body)` for an instance with a soft body.
template <class Call>
sunder_status call_body(sunder_scene scene, sunder_instance instance, Call&& call) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    SoftBody* const body = found.instance->body();
    if (body == nullptr)
      return fail(SUNDER_NOT_FOUND, kNone,
                  "the instance has no tissue, or needs sunder_prepare_to_tear()");
    ++found.scene->change;
    return call(found, *body);
  });
}

/// The same with three numbers that must be given.
template <class Call>
sunder_status call_body_with(sunder_scene scene, sunder_instance instance, const double* numbers,
                             const char* name, Call&& call) {
  return call_body(scene, instance, [&](const Found&, SoftBody& body) -> sunder_status {
    if (numbers == nullptr) return null_pointer(name);
    return report(call(body, vector_of(numbers)));
  });
}

/// @param collider  its shape is a SUNDER_COLLIDER_...
Collider collider_of(const sunder_collider& collider) {
  const auto placed = [&](auto shape) {
    return Collider{shape, vector_of(collider.place), Quatd(collider.rotation), collider.friction};
  };
  switch (collider.shape) {
    case SUNDER_COLLIDER_SPHERE: return placed(Collider::Sphere{collider.size[0]});
    case SUNDER_COLLIDER_CAPSULE:
      return placed(Collider::Capsule{collider.size[0], collider.size[1]});
    case SUNDER_COLLIDER_BOX: return placed(Collider::Box{vector_of(collider.size)});
    default: return placed(Collider::HalfSpace{});
  }
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_force_tearing_options sunder_default_force_tearing_options(void) {
  const sunder::ForceTearingOptions defaults;
  return {sizeof(sunder_force_tearing_options), 0, defaults.length, defaults.metres, 0, 0};
}

sunder_status sunder_get_tissue(sunder_scene scene, sunder_instance instance,
                                sunder_tissue_info* info) {
  return call_body(scene, instance, [&](const Found& found, sunder::SoftBody&) -> sunder_status {
    SUNDER_C_TRY(check_struct(info, "info"));
    const sunder::ParticleSet& particles = *found.instance->particles();
    *info = {sizeof(sunder_tissue_info), particles.particle_count(), particles.point_count(),
             found.instance->needs_step() ? 1u : 0u};
    return SUNDER_OK;
  });
}

sunder_status sunder_get_threads(sunder_scene scene, sunder_instance instance,
                                 const sunder_suture_thread** threads, uint32_t* count) {
  return guarded([&]() -> sunder_status {
    Found found;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    if (threads == nullptr) return null_pointer("threads");
    if (count == nullptr) return null_pointer("count");
    std::vector<sunder_suture_thread>& read = found.scene->threads;
    read.clear();
    const sunder::TornModel* const model = found.instance->model();
    std::span<const sunder::ThreadLoad> loads;
    if (const auto* const body = found.instance->body()) loads = sunder::thread_loads(*body);
    if (model != nullptr)
      for (const sunder::SutureThread& thread : sunder::threads_of(*model)) {
        const auto left = vertex_at(*model, thread.left), right = vertex_at(*model, thread.right);
        sunder::ThreadLoad load;
        if (read.size() < loads.size()) load = loads[read.size()];
        read.push_back({left.mesh, left.vertex, right.mesh, right.vertex, load.newtons,
                        load.is_broken ? 1u : 0u, 0});
      }
    *threads = read.data();
    *count = static_cast<uint32_t>(read.size());
    return SUNDER_OK;
  });
}

sunder_status sunder_get_point(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                               uint32_t vertex, uint32_t* point) {
  return call_body(scene, instance, [&](const Found& found, sunder::SoftBody&) -> sunder_status {
    if (point == nullptr) return null_pointer("point");
    const auto& meshes = found.instance->character().meshes;
    if (mesh >= meshes.size())
      return fail(SUNDER_INDEX_OUT_OF_RANGE, mesh, "mesh %u of %zu", mesh, meshes.size());
    const auto points = found.instance->particles()->vertex_points(mesh);
    if (vertex >= points.size())
      return fail(SUNDER_INDEX_OUT_OF_RANGE, vertex, "vertex %u of %zu", vertex, points.size());
    *point = points[vertex];
    return SUNDER_OK;
  });
}

sunder_status sunder_change_material(sunder_scene scene, sunder_instance instance, uint32_t index,
                                     const sunder_material* material) {
  return call_body(scene, instance, [&](const Found&, sunder::SoftBody& body) -> sunder_status {
    SUNDER_C_TRY(check_struct(material, "material"));
    return report(body.change_material(index, material_of(*material)));
  });
}

sunder_status sunder_set_gravity(sunder_scene scene, sunder_instance instance,
                                 const double gravity[3]) {
  return call_body_with(scene, instance, gravity, "gravity",
                        [&](sunder::SoftBody& body, const sunder::Vec3d& acceleration) {
                          return body.set_gravity(acceleration);
                        });
}

sunder_status sunder_set_tension(sunder_scene scene, sunder_instance instance,
                                 double newtons_per_metre, uint32_t adds_pose_strain) {
  return call_body(scene, instance, [&](const Found&, sunder::SoftBody& body) {
    return report(body.set_tension({newtons_per_metre, {}, adds_pose_strain != 0}));
  });
}

sunder_status sunder_add_impulse(sunder_scene scene, sunder_instance instance, uint32_t point,
                                 const double newton_seconds[3]) {
  return call_body_with(scene, instance, newton_seconds, "newton_seconds",
                        [&](sunder::SoftBody& body, const sunder::Vec3d& impulse) {
                          return body.add_point_impulse(point, impulse);
                        });
}

sunder_status sunder_hold_point(sunder_scene scene, sunder_instance instance, uint32_t point,
                                const double target[3], double stiffness, uint64_t* hold) {
  return call_body(scene, instance, [&](const Found&, sunder::SoftBody& body) -> sunder_status {
    if (target == nullptr) return null_pointer("target");
    if (hold == nullptr) return null_pointer("hold");
    sunder::HoldOptions options;
    if (stiffness != 0.0) options.stiffness = stiffness;
    const auto held = body.hold_point(point, vector_of(target), options);
    if (!held) return report(held.error());
    *hold = *held;
    return SUNDER_OK;
  });
}

sunder_status sunder_move_hold(sunder_scene scene, sunder_instance instance, uint64_t hold,
                               const double target[3]) {
  return call_body_with(scene, instance, target, "target",
                        [&](sunder::SoftBody& body, const sunder::Vec3d& place) {
                          return body.move_hold(hold, place);
                        });
}

sunder_status sunder_release_hold(sunder_scene scene, sunder_instance instance, uint64_t hold) {
  return call_body(scene, instance, [&](const Found&, sunder::SoftBody& body) {
    return report(body.release(hold));
  });
}

sunder_status sunder_tear_overstretched(sunder_scene scene, sunder_instance instance,
                                        const sunder_force_tearing_options* options,
                                        sunder_force_tearing* found) {
  return call_body(scene, instance, [&](const Found& of, sunder::SoftBody&) -> sunder_status {
    SUNDER_C_TRY(check_options(options, "options"));
    SUNDER_C_TRY(check_struct(found, "found"));
    sunder::ForceTearingOptions limits;
    if (options != nullptr) {
      limits.length = options->length;
      limits.metres = options->metres;
      if (options->metres_per_second != 0) limits.metres_per_second = options->metres_per_second;
      limits.least_piece_area = options->least_piece_area;
    }
    const auto torn = of.instance->tear_overstretched(limits);
    if (!torn) return report(torn.error());
    *found = {sizeof *found,
              torn->has_torn ? 1u : 0u,
              torn->is_from_tip ? 1u : 0u,
              torn->tear.vertices_added,
              torn->greatest_stretch,
              torn->greatest_release,
              torn->tear.length_posed,
              {},
              {}};
    for (int i = 0; i < 3; ++i)
      found->place[i] = torn->place[i], found->direction[i] = torn->direction[i];
    return SUNDER_OK;
  });
}

sunder_status sunder_set_colliders(sunder_scene scene, sunder_instance instance,
                                   const sunder_collider* colliders, uint32_t count) {
  return call_body(scene, instance, [&](const Found&, sunder::SoftBody& body) -> sunder_status {
    if (colliders == nullptr && count > 0) return null_pointer("colliders");
    std::vector<sunder::Collider> all;
    for (uint32_t i = 0; i < count; ++i) {
      SUNDER_C_TRY(check_enum(colliders[i].shape, SUNDER_COLLIDER_HALF_SPACE, "shape"));
      all.push_back(collider_of(colliders[i]));
    }
    return report(body.set_colliders(all));
  });
}

sunder_status sunder_move_collider(sunder_scene scene, sunder_instance instance, uint32_t collider,
                                   const double place[3], const double rotation[4]) {
  return call_body(scene, instance, [&](const Found&, sunder::SoftBody& body) -> sunder_status {
    if (place == nullptr) return null_pointer("place");
    if (rotation == nullptr) return null_pointer("rotation");
    return report(body.move_collider(collider, vector_of(place), sunder::Quatd(rotation)));
  });
}

}  // extern "C"
