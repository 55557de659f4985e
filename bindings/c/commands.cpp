// Operations as commands: structs of C become those of <sunder/scene/scene_command.h>.

#include <sunder/scene/scene_command.h>

#include <utility>
#include <vector>

#include "bindings/c/numbers.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

Blade blade_of(const sunder_blade& blade) { return {vector_of(blade.base), vector_of(blade.tip)}; }

sunder_status read_places(const double* numbers, std::uint32_t count, const char* name,
                          std::vector<Vec3d>& places) {
  if (count > 0 && numbers == nullptr) return null_pointer(name);
  for (std::uint32_t i = 0; i < count; ++i)
    places.push_back(vector_of(numbers + 3 * std::size_t{i}));
  return SUNDER_OK;
}

sunder_status read_weights(std::int32_t policy, std::uint32_t maximum_influences,
                           std::optional<WeightOptions>& weights) {
  const auto read = weights_of(policy, maximum_influences);
  if (!read) return report(read.error());
  weights = *read;
  return SUNDER_OK;
}

sunder_status read_options(const sunder_tear_options* from, TearOptions& options) {
  if (from == nullptr) return SUNDER_OK;
  SUNDER_C_TRY(check_struct(from, "options"));
  SUNDER_C_TRY(check_enum(from->layers, SUNDER_LAYERS_ALL, "layers"));
  options.width = from->width;
  options.layers = static_cast<Layers>(from->layers);
  options.wall_depth = from->wall_depth;
  options.lip_roll = from->lip_roll;
  options.wall_material = from->wall_material;
  return read_weights(from->weight_policy, from->maximum_influences, options.weights);
}

sunder_status read_cut(const sunder_cut* from, PlaneCut& cut) {
  SUNDER_C_TRY(check_struct(from, "cut"));
  cut.point = vector_of(from->point);
  cut.normal = vector_of(from->normal);
  SUNDER_C_TRY(read_places(from->bounds, from->bound_count, "bounds", cut.bounds));
  SUNDER_C_TRY(read_places(from->sections, from->section_count, "sections", cut.sections));
  cut.caps = from->has_caps != 0;
  cut.cap_material = from->cap_material;
  if (from->bone != nullptr) cut.bone = from->bone;
  if (from->has_first_hit != 0)
    cut.first_hit = SectionRay{vector_of(from->ray_origin), vector_of(from->ray_direction)};
  return read_weights(from->weight_policy, from->maximum_influences, cut.weights);
}

sunder_status read_bore(const sunder_bore* from, Bore& bore) {
  SUNDER_C_TRY(check_struct(from, "bore"));
  bore.origin = vector_of(from->origin);
  bore.direction = vector_of(from->direction);
  bore.radius = from->radius;
  bore.depth = from->depth;
  bore.chord_tolerance = from->chord_tolerance;
  bore.wall = from->has_wall != 0;
  bore.wall_material = from->wall_material;
  return read_weights(from->weight_policy, from->maximum_influences, bore.weights);
}

sunder_status read_detach(const sunder_detach* from, DetachCommand& command) {
  SUNDER_C_TRY(check_struct(from, "detach"));
  SUNDER_C_TRY(check_enum(from->motion, SUNDER_PIECE_VANISHES, "motion"));
  SUNDER_C_TRY(check_enum(from->axes, SUNDER_AXES_MODEL, "axes"));
  SUNDER_C_TRY(check_enum(from->open_surfaces, SUNDER_SOLID_SHELL, "open_surfaces"));
  if (from->triangle != kNone)
    command.piece = PieceOfTriangle{from->mesh, from->triangle};
  else
    command.piece =
        PieceNear{vector_of(from->point), from->bone == nullptr ? std::string() : from->bone};
  command.options.motion = static_cast<PieceMotion>(from->motion);
  command.options.axes = static_cast<PieceAxes>(from->axes);
  command.options.mass = {from->density, static_cast<SolidRule>(from->open_surfaces),
                          from->shell_thickness};
  return SUNDER_OK;
}

sunder_status submit(sunder_scene scene, sunder_instance instance, SceneCommand command,
                     std::uint32_t flags, sunder_command* number) {
  SceneObject* const object = find<SceneObject>(scene);
  if (object == nullptr) return SUNDER_INVALID_HANDLE;
  if ((flags & ~std::uint32_t{SUNDER_IN_BACKGROUND}) != 0)
    return fail(SUNDER_INVALID_ARGUMENT, kNone, "`flags` is 0x%x", flags);
  CommandOptions options;
  options.wants_changes = object->wants_changes;
  options.in_background = (flags & SUNDER_IN_BACKGROUND) != 0;
  const auto submitted = object->scene.submit(instance_of(instance), std::move(command), options);
  if (!submitted) return report(submitted.error());
  if (number != nullptr) *number = *submitted;
  return SUNDER_OK;
}

/// Submits a command without arguments.
template <class Command>
sunder_status submit_plain(sunder_scene scene, sunder_instance instance, sunder_command* number) {
  return guarded([&] { return submit(scene, instance, Command(), 0, number); });
}

/// The places of a weld or suture.
template <class Closing>
sunder_status read_wounds(const Closing& from, std::vector<sunder::Vec3d>& places) {
  if (from.places != nullptr && from.place_count == 0)
    return report(sunder::Status::failure(sunder::StatusCode::invalid_argument, sunder::kNone,
                                          "places of wounds are none; null means all wounds"));
  return read_places(from.places, from.place_count, "places", places);
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_tear_options sunder_default_tear_options(void) {
  sunder_tear_options options = {};
  options.struct_size = sizeof options;
  options.wall_material = SUNDER_NONE;
  options.weight_policy = SUNDER_WEIGHTS_OF_MODEL;
  return options;
}

sunder_cut sunder_default_cut(void) {
  sunder_cut cut = {};
  cut.struct_size = sizeof cut;
  cut.normal[2] = 1.0;
  cut.cap_material = SUNDER_NONE;
  cut.weight_policy = SUNDER_WEIGHTS_OF_MODEL;
  cut.ray_direction[0] = 1.0;
  return cut;
}

sunder_bore sunder_default_bore(void) {
  sunder_bore bore = {};
  bore.struct_size = sizeof bore;
  bore.direction[2] = -1.0;
  bore.wall_material = SUNDER_NONE;
  bore.weight_policy = SUNDER_WEIGHTS_OF_MODEL;
  return bore;
}

sunder_weld sunder_default_weld(void) { return {sizeof(sunder_weld), 0, nullptr, 0.0}; }

sunder_suture sunder_default_suture(void) {
  const sunder::Suture defaults;
  return {sizeof(sunder_suture),
          0,
          nullptr,
          defaults.reach,
          defaults.spacing,
          defaults.stiffness,
          defaults.tension,
          defaults.strength};
}

sunder_detach sunder_default_detach(void) {
  const sunder::DetachOptions defaults;
  sunder_detach detach = {};
  detach.struct_size = sizeof detach;
  detach.triangle = SUNDER_NONE;
  detach.motion = static_cast<uint32_t>(defaults.motion);
  detach.axes = static_cast<uint32_t>(defaults.axes);
  detach.open_surfaces = static_cast<uint32_t>(defaults.mass.open_surfaces);
  detach.density = defaults.mass.density;
  detach.shell_thickness = defaults.mass.shell_thickness;
  return detach;
}

sunder_stroke_sampling sunder_default_stroke_sampling(void) {
  return {sizeof(sunder_stroke_sampling), 0, 0.0, 0.0};
}

sunder_status sunder_submit_tear(sunder_scene scene, sunder_instance instance,
                                 const sunder_blade* blades, uint32_t blade_count,
                                 const sunder_tear_options* options, uint32_t flags,
                                 sunder_command* command) {
  return guarded([&]() -> sunder_status {
    if (blades == nullptr) return null_pointer("blades");
    sunder::TearCommand tear;
    SUNDER_C_TRY(read_options(options, tear.options));
    tear.stroke.reserve(blade_count);
    for (uint32_t i = 0; i < blade_count; ++i) tear.stroke.push_back(blade_of(blades[i]));
    return submit(scene, instance, std::move(tear), flags, command);
  });
}

sunder_status sunder_submit_cut(sunder_scene scene, sunder_instance instance, const sunder_cut* cut,
                                uint32_t flags, sunder_command* command) {
  return guarded([&]() -> sunder_status {
    sunder::PlaneCut plane;
    SUNDER_C_TRY(read_cut(cut, plane));
    return submit(scene, instance, std::move(plane), flags, command);
  });
}

sunder_status sunder_submit_drill(sunder_scene scene, sunder_instance instance,
                                  const sunder_bore* bore, uint32_t flags,
                                  sunder_command* command) {
  return guarded([&]() -> sunder_status {
    sunder::Bore hole;
    SUNDER_C_TRY(read_bore(bore, hole));
    return submit(scene, instance, hole, flags, command);
  });
}

sunder_status sunder_submit_weld(sunder_scene scene, sunder_instance instance,
                                 const sunder_weld* weld, uint32_t flags, sunder_command* command) {
  return guarded([&]() -> sunder_status {
    SUNDER_C_TRY(check_struct(weld, "weld"));
    sunder::Weld wanted;
    wanted.reach = weld->reach;
    SUNDER_C_TRY(read_wounds(*weld, wanted.places));
    return submit(scene, instance, std::move(wanted), flags, command);
  });
}

sunder_status sunder_submit_suture(sunder_scene scene, sunder_instance instance,
                                   const sunder_suture* suture, uint32_t flags,
                                   sunder_command* command) {
  return guarded([&]() -> sunder_status {
    SUNDER_C_TRY(check_struct(suture, "suture"));
    sunder::Suture wanted;
    SUNDER_C_TRY(read_wounds(*suture, wanted.places));
    wanted.reach = suture->reach;
    wanted.spacing = suture->spacing;
    wanted.stiffness = suture->stiffness;
    wanted.tension = suture->tension;
    wanted.strength = suture->strength;
    return submit(scene, instance, std::move(wanted), flags, command);
  });
}

sunder_status sunder_submit_begin_stroke(sunder_scene scene, sunder_instance instance,
                                         const sunder_blade* blade,
                                         const sunder_tear_options* options,
                                         const sunder_stroke_sampling* sampling,
                                         sunder_command* command) {
  return guarded([&]() -> sunder_status {
    if (blade == nullptr) return null_pointer("blade");
    SUNDER_C_TRY(check_options(sampling, "sampling"));
    sunder::BeginStrokeCommand begin;
    begin.blade = blade_of(*blade);
    SUNDER_C_TRY(read_options(options, begin.options));
    if (sampling != nullptr)
      begin.sampling = {sampling->minimum_distance, sampling->minimum_seconds};
    return submit(scene, instance, std::move(begin), 0, command);
  });
}

sunder_status sunder_submit_extend_stroke(sunder_scene scene, sunder_instance instance,
                                          const sunder_blade* blade, double seconds,
                                          sunder_command* command) {
  return guarded([&]() -> sunder_status {
    if (blade == nullptr) return null_pointer("blade");
    return submit(scene, instance, sunder::ExtendStrokeCommand{blade_of(*blade), seconds}, 0,
                  command);
  });
}

sunder_status sunder_submit_end_stroke(sunder_scene scene, sunder_instance instance,
                                       sunder_command* command) {
  return submit_plain<sunder::EndStrokeCommand>(scene, instance, command);
}

sunder_status sunder_submit_cancel_stroke(sunder_scene scene, sunder_instance instance,
                                          sunder_command* command) {
  return submit_plain<sunder::CancelStrokeCommand>(scene, instance, command);
}

sunder_status sunder_submit_detach(sunder_scene scene, sunder_instance instance,
                                   const sunder_detach* detach, sunder_command* command) {
  return guarded([&]() -> sunder_status {
    sunder::DetachCommand piece;
    SUNDER_C_TRY(read_detach(detach, piece));
    return submit(scene, instance, std::move(piece), 0, command);
  });
}

sunder_status sunder_submit_undo(sunder_scene scene, sunder_instance instance,
                                 sunder_command* command) {
  return submit_plain<sunder::UndoCommand>(scene, instance, command);
}

sunder_status sunder_submit_redo(sunder_scene scene, sunder_instance instance,
                                 sunder_command* command) {
  return submit_plain<sunder::RedoCommand>(scene, instance, command);
}

}  // extern "C"
