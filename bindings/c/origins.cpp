#include "bindings/c/numbers.h"
#include "bindings/c/scene.h"
#include "bindings/c/structs.h"

namespace sunder::c {
namespace {

sunder_status model_of(const Found& found, const TornModel*& model) {
  model = found.instance->model();
  if (model != nullptr) return SUNDER_OK;
  return fail(SUNDER_NOT_FOUND, kNone,
              "nothing was torn: needs an operation, or sunder_prepare_to_tear()");
}

/// Finds the torn model of an instance that has this mesh.
sunder_status find_model(sunder_scene scene, sunder_instance instance, std::uint32_t mesh,
                         const TornModel*& model) {
  Found found;
  SUNDER_C_TRY(find_mesh(scene, instance, mesh, found));
  return model_of(found, model);
}

/// Writes origin_of(index) of the elements from `first` on, at most `most`, and their number.
template <class Origin, class OriginOf>
sunder_status write_origins(const char* what, std::uint32_t first, std::uint32_t least,
                            std::uint32_t end, Origin* origins, std::uint32_t most,
                            std::uint32_t* count, const OriginOf& origin_of) {
  if (count == nullptr) return null_pointer("count");
  if (origins == nullptr && most > 0) return null_pointer("origins");
  if (first < least || first > end)
    return fail(SUNDER_INDEX_OUT_OF_RANGE, first, "%s %u; expected one from %u to %u", what, first,
                least, end);
  for (std::uint32_t i = 0; i < most && first + i < end; ++i) origins[i] = origin_of(first + i);
  *count = end - first;
  return SUNDER_OK;
}

}  // namespace
}  // namespace sunder::c

using namespace sunder::c;

extern "C" {

sunder_status sunder_get_vertex_origins(sunder_scene scene, sunder_instance instance, uint32_t mesh,
                                        uint32_t first, sunder_vertex_origin* origins,
                                        uint32_t most, uint32_t* count) {
  return guarded([&]() -> sunder_status {
    const sunder::TornModel* model = nullptr;
    SUNDER_C_TRY(find_model(scene, instance, mesh, model));
    const sunder::Mesh& source = model->source().meshes[mesh];
    const auto origin_of = [&](std::uint32_t vertex) {
      const sunder::Birth birth = model->birth(mesh, vertex);
      sunder_vertex_origin origin = {};
      for (std::size_t k = 0; k < 3; ++k) origin.barycentric[k] = birth.barycentric[k];
      origin.triangle = birth.triangle < source.triangle_count() ? birth.triangle : SUNDER_NONE;
      return origin;
    };
    return write_origins("vertex", first, source.vertex_count(),
                         model->character().meshes[mesh].vertex_count(), origins, most, count,
                         origin_of);
  });
}

sunder_status sunder_get_triangle_origins(sunder_scene scene, sunder_instance instance,
                                          uint32_t mesh, uint32_t first,
                                          sunder_triangle_origin* origins, uint32_t most,
                                          uint32_t* count) {
  return guarded([&]() -> sunder_status {
    const sunder::TornModel* model = nullptr;
    SUNDER_C_TRY(find_model(scene, instance, mesh, model));
    const sunder::Mesh& torn = model->character().meshes[mesh];
    const std::uint32_t source_count = model->source().meshes[mesh].triangle_count();
    const auto origin_of = [&](std::uint32_t triangle) {
      const std::uint32_t source = model->source_triangle(mesh, triangle);
      const sunder::Triangle& corners = torn.triangles[triangle];
      const bool is_removed = sunder::is_retired(corners);
      sunder_triangle_origin origin = {};
      origin.triangle = source < source_count ? source : SUNDER_NONE;
      for (std::uint32_t k = 0; k < 3; ++k)
        origin.points[k] = is_removed ? SUNDER_NONE : model->point_at(mesh, triangle, k);
      return origin;
    };
    return write_origins("triangle", first, 0, torn.triangle_count(), origins, most, count,
                         origin_of);
  });
}

sunder_status sunder_get_scars(sunder_scene scene, sunder_instance instance,
                               const uint32_t** points, uint32_t* count) {
  return guarded([&]() -> sunder_status {
    Found found;
    const sunder::TornModel* model = nullptr;
    SUNDER_C_TRY(find_instance(scene, instance, found));
    SUNDER_C_TRY(model_of(found, model));
    if (points == nullptr) return null_pointer("points");
    if (count == nullptr) return null_pointer("count");
    const auto scars = sunder::scars_of(*model);
    *points = numbers_of(scars);
    *count = count_of(scars);
    return SUNDER_OK;
  });
}

}  // extern "C"
