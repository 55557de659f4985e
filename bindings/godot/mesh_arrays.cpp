#include "bindings/godot/mesh_arrays.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

namespace sunder::godot {
namespace {

/// Numbers of Mesh.ArrayType.
enum : std::int64_t {
  kVertex = 0,
  kNormal = 1,
  kTangent = 2,
  kColour = 3,
  kUv = 4,
  kUv2 = 5,
  kBones = 10,
  kWeights = 11,
  kIndex = 12,
  kArrayCount = 13
};

/// Adds the numbers of a surface behind those of the surfaces before it. What some surfaces have
/// and others do not is filled.
void append(std::vector<float>& all, const std::vector<float>& own, std::size_t before,
            std::size_t vertices, std::initializer_list<float> fill) {
  const std::size_t width = fill.size();
  if (own.size() != vertices * width && all.empty()) return;
  const auto fill_to = [&](std::size_t count) {
    while (all.size() < count * width) all.insert(all.end(), fill);
  };
  fill_to(before);
  if (own.size() == vertices * width)
    all.insert(all.end(), own.begin(), own.end());
  else
    fill_to(before + vertices);
}

std::string at_surface(std::int64_t surface, const std::string& text) {
  return "surface " + std::to_string(surface) + ": " + text;
}

/// What a surface is made of if not of triangles; null if it is, or if this kind of mesh does not
/// say it.
const char* primitives_of(const Variant& mesh, std::int64_t surface) {
  constexpr std::array<const char*, 5> kNames = {"points", "lines", "a line strip", nullptr,
                                                 "a triangle strip"};  // Mesh.PrimitiveType
  const Variant type = mesh.call("surface_get_primitive_type", Variant(surface));
  if (type.is_nil()) return nullptr;
  const auto number = static_cast<std::uint64_t>(type.integer());
  return number < kNames.size() ? kNames[number] : "unknown primitives";
}

/// What a surface lacks of the last ones, if those before it had more.
void fill_to(std::vector<float>& all, std::size_t vertices, std::initializer_list<float> fill) {
  while (!all.empty() && all.size() < vertices * fill.size()) all.insert(all.end(), fill);
}

/// The influences of a vertex with positive weights, each slot once, that sum to one.
std::vector<sunder_influence> normalised(std::span<const std::int32_t> slots,
                                         std::span<const float> weights) {
  std::vector<sunder_influence> result;
  double sum = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!(weights[i] > 0)) continue;
    const auto slot = static_cast<std::uint32_t>(slots[i]);
    sum += static_cast<double>(weights[i]);
    const auto known = std::find_if(result.begin(), result.end(),
                                    [&](const sunder_influence& of) { return of.slot == slot; });
    if (known != result.end())
      known->weight += weights[i];
    else
      result.push_back({slot, weights[i]});
  }
  for (sunder_influence& influence : result)
    influence.weight = static_cast<float>(static_cast<double>(influence.weight) / sum);
  return result;
}

template <class Element>
void gather(std::vector<Element>& to, const Element* from, std::size_t width,
            const std::vector<std::uint32_t>& vertices) {
  for (const std::uint32_t vertex : vertices)
    to.insert(to.end(), from + width * vertex, from + width * (vertex + std::size_t{1}));
}

void set_gathered(Variant& arrays, std::int64_t place, Type type, const float* from,
                  std::size_t width, std::size_t element,
                  const std::vector<std::uint32_t>& vertices) {
  if (from == nullptr) return;
  std::vector<float> numbers;
  gather(numbers, from, width, vertices);
  arrays.set(place, Variant::packed(type, numbers, element));
}

void set_influences(Variant& arrays, const sunder_mesh& mesh, std::uint32_t most,
                    const std::vector<std::uint32_t>& vertices) {
  std::vector<std::int32_t> slots;
  std::vector<float> weights;
  for (const std::uint32_t vertex : vertices) {
    std::vector<sunder_influence> own(mesh.influences + mesh.first_influence[vertex],
                                      mesh.influences + mesh.first_influence[vertex + 1]);
    std::stable_sort(
        own.begin(), own.end(),
        [](const sunder_influence& a, const sunder_influence& b) { return a.weight > b.weight; });
    own.resize(std::min<std::size_t>(own.size(), most));
    double sum = 0;
    for (const sunder_influence& influence : own) sum += static_cast<double>(influence.weight);
    own.resize(most, {0, 0.0f});
    for (const sunder_influence& influence : own) {
      slots.push_back(static_cast<std::int32_t>(influence.slot));
      weights.push_back(static_cast<float>(static_cast<double>(influence.weight) / sum));
    }
  }
  arrays.set(kBones, Variant::packed(Type::packed_int32, slots));
  arrays.set(kWeights, Variant::packed(Type::packed_float32, weights));
}

}  // namespace

std::string MeshArrays::read(const Variant& mesh, std::uint32_t slot_count) {
  if (mesh.is_nil()) return "there is no mesh";
  if (mesh.call("get_blend_shape_count").integer() > 0)
    return "the mesh has blend shapes, which are not supported";
  const std::int64_t surfaces = mesh.call("get_surface_count").integer();
  for (std::int64_t surface = 0; surface < surfaces; ++surface) {
    if (const char* const primitives = primitives_of(mesh, surface); primitives != nullptr)
      return at_surface(surface, std::string("it is made of ") + primitives + ", not of triangles");
    const Variant arrays = mesh.call("surface_get_arrays", Variant(surface));
    std::string fault = read_surface(arrays, surface, slot_count);
    if (!fault.empty()) return at_surface(surface, fault);
    names_.push_back("surface " + std::to_string(surface));
  }
  if (triangles_.empty()) return "the mesh has no triangle";
  const std::size_t count = positions_.size() / 3;
  fill_to(normals_, count, {0, 1, 0});
  fill_to(tangents_, count, {1, 0, 0, 1});
  fill_to(colours_, count, {1, 1, 1, 1});
  for (std::vector<float>& uvs : uvs_) fill_to(uvs, count, {0, 0});
  if (!uvs_[1].empty() && uvs_[0].empty()) uvs_[0].resize(uvs_[1].size());
  for (const std::vector<float>& uvs : uvs_)
    if (!uvs.empty()) uv_pointers_.push_back(uvs.data());
  if (!colours_.empty()) colour_pointers_.push_back(colours_.data());
  for (std::uint32_t i = 0; i < names_.size(); ++i) submeshes_.push_back({names_[i].c_str(), i, 0});
  return {};
}

std::string MeshArrays::read_surface(const Variant& arrays, std::int64_t surface,
                                     std::uint32_t slot_count) {
  const std::size_t before = positions_.size() / 3;
  const std::vector<float> positions = arrays.at(kVertex).numbers<float>(Type::packed_vector3, 3);
  const std::size_t vertices = positions.size() / 3;
  append(normals_, arrays.at(kNormal).numbers<float>(Type::packed_vector3, 3), before, vertices,
         {0, 1, 0});
  append(tangents_, arrays.at(kTangent).numbers<float>(Type::packed_float32), before, vertices,
         {1, 0, 0, 1});
  append(colours_, arrays.at(kColour).numbers<float>(Type::packed_color, 4), before, vertices,
         {1, 1, 1, 1});
  append(uvs_[0], arrays.at(kUv).numbers<float>(Type::packed_vector2, 2), before, vertices, {0, 0});
  append(uvs_[1], arrays.at(kUv2).numbers<float>(Type::packed_vector2, 2), before, vertices,
         {0, 0});
  positions_.insert(positions_.end(), positions.begin(), positions.end());
  std::vector<std::int32_t> indices = arrays.at(kIndex).numbers<std::int32_t>(Type::packed_int32);
  if (indices.empty()) {
    indices.resize(vertices);
    std::iota(indices.begin(), indices.end(), 0);
  }
  if (indices.size() % 3 != 0) return "it is not made of triangles";
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    for (const std::size_t corner : {i, i + 2, i + 1}) {
      if (indices[corner] < 0 || static_cast<std::size_t>(indices[corner]) >= vertices)
        return "index " + std::to_string(indices[corner]) + " is no vertex";
      triangles_.push_back(static_cast<std::uint32_t>(before) +
                           static_cast<std::uint32_t>(indices[corner]));
    }
    triangle_submesh_.push_back(static_cast<std::uint32_t>(surface));
  }
  return read_influences(arrays, vertices, slot_count);
}

std::string MeshArrays::read_influences(const Variant& arrays, std::size_t vertices,
                                        std::uint32_t slot_count) {
  const std::vector<std::int32_t> slots =
      arrays.at(kBones).numbers<std::int32_t>(Type::packed_int32);
  const std::vector<float> weights = arrays.at(kWeights).numbers<float>(Type::packed_float32);
  if (vertices == 0) return {};
  const std::size_t width = slots.size() / vertices;
  if ((width != 4 && width != 8) || slots.size() != width * vertices ||
      weights.size() != slots.size())
    return "its vertices have no bones and weights, 4 or 8 of each";
  for (const std::int32_t slot : slots)
    if (slot < 0 || static_cast<std::uint32_t>(slot) >= slot_count)
      return "bone " + std::to_string(slot) + " is not among the " + std::to_string(slot_count) +
             " binds of the skin";
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto own = normalised(std::span(slots).subspan(v * width, width),
                                std::span(weights).subspan(v * width, width));
    if (own.empty()) return "vertex " + std::to_string(v) + " has no weight";
    influences_.insert(influences_.end(), own.begin(), own.end());
    first_influence_.push_back(static_cast<std::uint32_t>(influences_.size()));
  }
  return {};
}

sunder_mesh MeshArrays::mesh() const {
  const auto or_null = [](const std::vector<float>& numbers) {
    return numbers.empty() ? nullptr : numbers.data();
  };
  sunder_mesh mesh = {};
  mesh.name = "mesh";
  mesh.positions = positions_.data();
  mesh.normals = or_null(normals_);
  mesh.tangents = or_null(tangents_);
  mesh.uv_sets = uv_pointers_.data();
  mesh.color_sets = colour_pointers_.data();
  mesh.first_influence = first_influence_.data();
  mesh.influences = influences_.data();
  mesh.triangles = triangles_.data();
  mesh.triangle_submesh = triangle_submesh_.data();
  mesh.submeshes = submeshes_.data();
  mesh.vertex_count = static_cast<std::uint32_t>(positions_.size() / 3);
  mesh.triangle_count = static_cast<std::uint32_t>(triangles_.size() / 3);
  mesh.uv_set_count = static_cast<std::uint32_t>(uv_pointers_.size());
  mesh.color_set_count = static_cast<std::uint32_t>(colour_pointers_.size());
  mesh.submesh_count = static_cast<std::uint32_t>(submeshes_.size());
  return mesh;
}

std::uint32_t most_influences(const sunder_mesh& mesh) {
  std::uint32_t most = 0;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    most = std::max(most, mesh.first_influence[v + 1] - mesh.first_influence[v]);
  return most;
}

Variant surface_arrays(const sunder_mesh& mesh, std::uint32_t submesh, std::uint32_t influences) {
  std::vector<std::uint32_t> vertices, place_of(mesh.vertex_count, SUNDER_NONE);
  std::vector<std::int32_t> indices;
  for (std::uint32_t t = 0; t < mesh.triangle_count; ++t) {
    const std::uint32_t* const corners = mesh.triangles + std::size_t{3} * t;
    const bool is_removed = corners[0] == corners[1] && corners[1] == corners[2];
    if (mesh.triangle_submesh[t] != submesh || is_removed) continue;
    for (const std::uint32_t vertex : {corners[0], corners[2], corners[1]}) {
      if (place_of[vertex] == SUNDER_NONE) {
        place_of[vertex] = static_cast<std::uint32_t>(vertices.size());
        vertices.push_back(vertex);
      }
      indices.push_back(static_cast<std::int32_t>(place_of[vertex]));
    }
  }
  if (indices.empty()) {  // a host refuses a surface without triangles
    vertices = {0};
    indices = {0, 0, 0};
  }
  Variant arrays = Variant::empty(Type::array);
  arrays.call("resize", Variant(std::int64_t{kArrayCount}));
  set_gathered(arrays, kVertex, Type::packed_vector3, mesh.positions, 3, 3, vertices);
  set_gathered(arrays, kNormal, Type::packed_vector3, mesh.normals, 3, 3, vertices);
  set_gathered(arrays, kTangent, Type::packed_float32, mesh.tangents, 4, 1, vertices);
  if (mesh.color_set_count > 0)
    set_gathered(arrays, kColour, Type::packed_color, mesh.color_sets[0], 4, 4, vertices);
  for (std::uint32_t set = 0; set < std::min(mesh.uv_set_count, 2u); ++set)
    set_gathered(arrays, kUv + set, Type::packed_vector2, mesh.uv_sets[set], 2, 2, vertices);
  set_influences(arrays, mesh, influences, vertices);
  arrays.set(kIndex, Variant::packed(Type::packed_int32, indices));
  return arrays;
}

}  // namespace sunder::godot
