#include <sunder/tear/blade_force.h>
#include <sunder/tear/contact.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "bindings/c/numbers.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

sunder_contact contact_of(const SurfaceContact& from) {
  sunder_contact to = {};
  std::copy_n(from.place.data(), 3, to.place);
  std::copy_n(from.normal.data(), 3, to.normal);
  to.distance = from.distance;
  to.depth = from.depth;
  std::copy_n(from.barycentric.data(), 3, to.barycentric);
  to.mesh = from.mesh;
  to.triangle = from.triangle;
  to.submesh = from.submesh;
  to.material = from.material;
  to.bone = from.bone;
  to.enters = from.enters ? 1 : 0;
  return to;
}

/// The query of an instance, made and brought up to date where it has to be.
/// @return SUNDER_OK, with `query` written.
sunder_status find_query(sunder_scene scene, sunder_instance instance, SurfaceQuery*& query) {
  Found found;
  SUNDER_C_TRY(find_instance(scene, instance, found));
  const TornModel* const model = found.instance->model();
  if (model == nullptr)
    return fail(SUNDER_NOT_FOUND, kNone, "nothing was torn yet: call sunder_prepare_to_tear()");
  auto& queries = found.scene->queries;
  auto known = queries.find(instance);
  if (known != queries.end() && known->second.model == model &&
      known->second.change == found.scene->change) {
    query = &known->second.query;
    return SUNDER_OK;
  }
  if (known == queries.end() || known->second.model != model) {
    auto created = SurfaceQuery::create(*model);
    if (!created) return report(created.error());
    known =
        queries.insert_or_assign(instance, InstanceQuery{std::move(*created), {}, model, 0}).first;
  }
  InstanceQuery& of = known->second;
  of.displacements.clear();
  for (std::uint32_t m = 0; m < model->character().meshes.size(); ++m)
    of.displacements.push_back(found.instance->displacements(m));
  ContactOptions options;
  options.displacements = of.displacements;
  if (const Status status = of.query.set_pose(found.instance->pose(), options); !status) {
    queries.erase(known);
    return report(status);
  }
  of.change = found.scene->change;
  query = &of.query;
  return SUNDER_OK;
}

sunder_status write_contact(const Result<std::optional<SurfaceContact>>& found,
                            sunder_contact* contact, std::uint32_t* has_hit) {
  if (!found) return report(found.error());
  *has_hit = found->has_value() ? 1 : 0;
  if (*found) *contact = contact_of(**found);
  return SUNDER_OK;
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_status sunder_cast_ray(sunder_scene scene, sunder_instance instance, const double origin[3],
                              const double direction[3], double length, sunder_contact* contact,
                              uint32_t* has_hit) {
  return guarded([&]() -> sunder_status {
    if (origin == nullptr) return null_pointer("origin");
    if (direction == nullptr) return null_pointer("direction");
    if (contact == nullptr) return null_pointer("contact");
    if (has_hit == nullptr) return null_pointer("has_hit");
    sunder::SurfaceQuery* query = nullptr;
    SUNDER_C_TRY(find_query(scene, instance, query));
    return write_contact(query->cast_ray({vector_of(origin), vector_of(direction), length}),
                         contact, has_hit);
  });
}

sunder_status sunder_find_nearest(sunder_scene scene, sunder_instance instance,
                                  const double point[3], double most_distance,
                                  sunder_contact* contact, uint32_t* has_hit) {
  return guarded([&]() -> sunder_status {
    if (point == nullptr) return null_pointer("point");
    if (contact == nullptr) return null_pointer("contact");
    if (has_hit == nullptr) return null_pointer("has_hit");
    sunder::SurfaceQuery* query = nullptr;
    SUNDER_C_TRY(find_query(scene, instance, query));
    return write_contact(query->find_nearest(vector_of(point), most_distance), contact, has_hit);
  });
}

sunder_status sunder_find_blade_contacts(sunder_scene scene, sunder_instance instance,
                                         const sunder_blade* blade, sunder_contact* contacts,
                                         uint32_t capacity, uint32_t* count) {
  return guarded([&]() -> sunder_status {
    if (blade == nullptr) return null_pointer("blade");
    if (contacts == nullptr && capacity > 0) return null_pointer("contacts");
    if (count == nullptr) return null_pointer("count");
    sunder::SurfaceQuery* query = nullptr;
    SUNDER_C_TRY(find_query(scene, instance, query));
    std::vector<sunder::SurfaceContact> found;
    const auto status =
        query->find_blade_contacts({vector_of(blade->base), vector_of(blade->tip)}, found);
    if (!status) return report(status);
    *count = static_cast<uint32_t>(found.size());
    std::transform(found.begin(), found.begin() + std::min<std::size_t>(found.size(), capacity),
                   contacts, contact_of);
    return SUNDER_OK;
  });
}

sunder_cutting_resistance sunder_default_cutting_resistance(void) {
  const sunder::CuttingResistance from;
  return {sizeof(sunder_cutting_resistance),
          0,
          from.toughness,
          from.thickness,
          from.friction,
          from.greatest};
}

sunder_status sunder_blade_force(const sunder_cutting_resistance* tissue, double length_torn,
                                 double depth, const double motion[3], double force[3]) {
  SUNDER_C_TRY(check_struct(tissue, "tissue"));
  if (motion == nullptr) return null_pointer("motion");
  if (force == nullptr) return null_pointer("force");
  const auto found = sunder::blade_force(
      {tissue->toughness, tissue->thickness, tissue->friction, tissue->greatest},
      {length_torn, depth, vector_of(motion)});
  if (!found) return report(found.error());
  const sunder::Vec3d newtons = found->newtons * found->direction;
  std::copy_n(newtons.data(), 3, force);
  return SUNDER_OK;
}

}  // extern "C"
