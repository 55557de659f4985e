#include "io/gltf_write/mesh_writer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "io/gltf/accessors.h"
#include "io/gltf/refusal.h"
#include "io/gltf_write/appended_materials.h"

namespace sunder::gltf {
namespace {

constexpr std::array<const char*, 5> kTypes = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

template <class T>
constexpr ComponentType component_type() {
  if constexpr (sizeof(T) == 1)
    return ComponentType::u8;
  else if constexpr (sizeof(T) == 2)
    return ComponentType::u16;
  else
    return ComponentType::u32;
}

void check_material(const AppendedMaterial& material, Index index) {
  const Vec4f& colour = material.base_colour;
  for (const float share :
       {colour.x(), colour.y(), colour.z(), colour.w(), material.metallic, material.roughness})
    if (!(share >= 0 && share <= 1))
      refuse(StatusCode::invalid_argument, index,
             "save_glb: appended material %u '%.60s': %g is not in [0, 1]", index,
             material.name.c_str(), static_cast<double>(share));
}

std::string numbered(const char* name, std::size_t index) { return name + std::to_string(index); }

}  // namespace

void check_options(const SaveOptions& options, std::size_t mesh_count) {
  const std::uint32_t maximum = options.maximum_influences;
  if (maximum != 0 && maximum != 4 && maximum != 8 && maximum != kAllInfluences)
    refuse(StatusCode::invalid_argument, kNone,
           "save_glb: maximum_influences must be 0, 4, 8 or kAllInfluences, not %u", maximum);
  const auto check_format = [](WeightFormat format) {
    if (format > WeightFormat::unorm8)
      refuse(StatusCode::invalid_argument, kNone, "save_glb: unknown weight format %u",
             static_cast<unsigned>(format));
  };
  check_format(options.weights);
  if (!options.weights_of_mesh.empty() && options.weights_of_mesh.size() != mesh_count)
    refuse(StatusCode::size_mismatch, kNone,
           "save_glb: weight formats of %zu meshes, the character has %zu",
           options.weights_of_mesh.size(), mesh_count);
  for (const WeightFormat format : options.weights_of_mesh) check_format(format);
  for (Index i = 0; i < options.materials.size(); ++i) check_material(options.materials[i], i);
  for (Index i = 0; i < options.painted.size(); ++i) check_painted(options.painted[i], i);
}

InfluenceForm influence_form(const SaveOptions& options, std::uint32_t mesh,
                             std::uint32_t most_of_source) {
  InfluenceForm form;
  form.format = options.weights_of_mesh.empty() ? options.weights : options.weights_of_mesh[mesh];
  form.maximum = options.maximum_influences;
  if (form.maximum == kAllInfluences) form.maximum = 0;
  if (options.maximum_influences == 0 && most_of_source != 0)
    form.maximum = std::max(kInfluencesOfASet, most_of_source);
  return form;
}

std::uint32_t MeshWriter::add_accessor(Json accessor) {
  Json& accessors = draft_.json["accessors"];
  if (accessors.is_null()) accessors = Json::array();
  accessors.push_back(std::move(accessor));
  return static_cast<std::uint32_t>(accessors.size() - 1);
}

std::uint32_t MeshWriter::add_floats(std::span<const float> values, std::uint32_t components,
                                     Bounds bounds) {
  Json accessor = {
      {"bufferView", draft_.add_view(std::as_bytes(values), GlbDraft::ViewTarget::vertices)},
      {"componentType", static_cast<std::uint32_t>(ComponentType::f32)},
      {"count", values.size() / components},
      {"type", kTypes[components]}};
  if (bounds == Bounds::yes) {
    Json least = Json::array(), greatest = Json::array();
    for (std::size_t c = 0; c < components; ++c) {
      float low = values[c], high = values[c];
      for (std::size_t i = c; i < values.size(); i += components) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      least.push_back(static_cast<double>(low));
      greatest.push_back(static_cast<double>(high));
    }
    accessor["min"] = std::move(least);
    accessor["max"] = std::move(greatest);
  }
  return add_accessor(std::move(accessor));
}

template <class Vector>
std::uint32_t MeshWriter::add_vectors(const std::vector<Vector>& values, Bounds bounds) {
  constexpr std::uint32_t kComponents = Vector::RowsAtCompileTime;
  return add_floats({values.data()->data(), values.size() * kComponents}, kComponents, bounds);
}

template <class T>
std::uint32_t MeshWriter::add_integers(const std::vector<std::uint32_t>& values,
                                       std::uint32_t components, GlbDraft::ViewTarget target) {
  std::vector<T> narrow(values.size());
  std::transform(values.begin(), values.end(), narrow.begin(),
                 [](std::uint32_t value) { return static_cast<T>(value); });
  return add_accessor(
      {{"bufferView", draft_.add_view(std::as_bytes(std::span<const T>(narrow)), target)},
       {"componentType", static_cast<std::uint32_t>(component_type<T>())},
       {"count", values.size() / components},
       {"type", kTypes[components]}});
}

/// Labels stay 16-bit integers: readers recognise by this type that they must not be interpolated.
std::uint32_t MeshWriter::add_labels(const CustomAttribute& attribute) {
  const auto [least, greatest] =
      std::minmax_element(attribute.values.begin(), attribute.values.end());
  const bool is_signed = *least < 0.0f;
  const bool fits =
      is_signed ? *least >= -32768.0f && *greatest <= 32767.0f : *greatest <= 65535.0f;
  if (!fits) return add_floats(attribute.values, attribute.components);
  // glTF requires vertex data aligned to four bytes.
  const std::size_t components = attribute.components, stride = (components + 1) / 2 * 2,
                    count = attribute.values.size() / components;
  std::vector<std::uint16_t> labels(count * stride, 0);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < components; ++c)
      labels[i * stride + c] = static_cast<std::uint16_t>(
          static_cast<std::int32_t>(attribute.values[i * components + c]));
  const std::uint32_t view = draft_.add_view(
      std::as_bytes(std::span<const std::uint16_t>(labels)), GlbDraft::ViewTarget::vertices,
      static_cast<std::uint32_t>(stride * sizeof(std::uint16_t)));
  return add_accessor({{"bufferView", view},
                       {"componentType", static_cast<std::uint32_t>(
                                             is_signed ? ComponentType::i16 : ComponentType::u16)},
                       {"count", count},
                       {"type", kTypes[components]}});
}

/// Tear sides are plain floats, because tools that merge equal vertices compare these most
/// reliably. Most are zero, so the others alone take less space.
std::uint32_t MeshWriter::add_sides(const std::vector<float>& sides) {
  std::vector<std::uint32_t> indices;
  std::vector<float> values;
  for (std::uint32_t v = 0; v < sides.size(); ++v)
    if (sides[v] != 0.0f) {
      indices.push_back(v);
      values.push_back(sides[v]);
    }
  const bool is_short = sides.size() <= std::size_t{std::numeric_limits<std::uint16_t>::max()} + 1;
  const std::size_t sparse_bytes =
      indices.size() * (sizeof(float) + (is_short ? sizeof(std::uint16_t) : sizeof(std::uint32_t)));
  constexpr std::size_t kDescription = 256;  // what two views and the sparse part take in the JSON
  if (indices.empty() || sparse_bytes + kDescription >= sides.size() * sizeof(float))
    return add_floats(sides, 1);
  const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
  const std::uint32_t index_view = draft_.add_view(
      is_short ? std::as_bytes(std::span(narrow)) : std::as_bytes(std::span(indices)),
      GlbDraft::ViewTarget::none);
  const std::uint32_t value_view =
      draft_.add_view(std::as_bytes(std::span(values)), GlbDraft::ViewTarget::none);
  const auto index_type =
      static_cast<std::uint32_t>(is_short ? ComponentType::u16 : ComponentType::u32);
  return add_accessor({{"componentType", static_cast<std::uint32_t>(ComponentType::f32)},
                       {"count", sides.size()},
                       {"type", "SCALAR"},
                       {"sparse",
                        {{"count", indices.size()},
                         {"indices", {{"bufferView", index_view}, {"componentType", index_type}}},
                         {"values", {{"bufferView", value_view}}}}}});
}

bool MeshWriter::has_triangles(const Mesh& mesh) {
  return !std::all_of(mesh.triangles.begin(), mesh.triangles.end(), is_retired);
}

MeshWriter::Vertices MeshWriter::add_vertices(const Mesh& mesh,
                                              const SourceDocument::MeshOrigin& origin,
                                              InfluenceForm form) {
  Vertices vertices{Json::object(), nullptr};
  Json& attributes = vertices.attributes;
  attributes["POSITION"] = add_vectors(mesh.positions, Bounds::yes);
  if (!mesh.normals.empty()) attributes["NORMAL"] = add_vectors(mesh.normals);
  if (!mesh.tangents.empty()) attributes["TANGENT"] = add_vectors(mesh.tangents);
  for (std::size_t i = 0; i < mesh.uv_sets.size(); ++i)
    attributes[numbered("TEXCOORD_", i)] = add_vectors(mesh.uv_sets[i]);
  for (std::size_t i = 0; i < mesh.color_sets.size(); ++i) {
    const bool has_alpha = i >= origin.color_components.size() || origin.color_components[i] == 4;
    std::vector<Vec3f> rgb;
    if (!has_alpha)
      for (const Vec4f& color : mesh.color_sets[i]) rgb.push_back(color.head<3>());
    attributes[numbered("COLOR_", i)] =
        has_alpha ? add_vectors(mesh.color_sets[i]) : add_vectors(rgb);
  }
  for (const CustomAttribute& attribute : mesh.custom_attributes) {
    if (attribute.name == kTearSideAttribute && attribute.components == 1)
      attributes[attribute.name] = add_sides(attribute.values);
    else
      attributes[attribute.name] = attribute.interpolates
                                       ? add_floats(attribute.values, attribute.components)
                                       : add_labels(attribute);
  }
  if (const auto sides = attributes.find(kTearSideAttribute); sides != attributes.end()) {
    const Json accessor = *sides;  // The insertion moves it.
    attributes[kTearSideFeatureAttribute] = accessor;
  }
  if (origin.skinned) add_influences(mesh.weights, form, attributes);
  if (!mesh.morph_targets.empty()) vertices.targets = add_targets(mesh);
  return vertices;
}

void MeshWriter::add_influences(const SkinWeights& weights, InfluenceForm form, Json& attributes) {
  switch (form.format) {
    case WeightFormat::float32:
      return add_sets(make_influence_sets<float>(weights, form.maximum), attributes);
    case WeightFormat::unorm16:
      return add_sets(make_influence_sets<std::uint16_t>(weights, form.maximum), attributes);
    case WeightFormat::unorm8:
      return add_sets(make_influence_sets<std::uint8_t>(weights, form.maximum), attributes);
  }
}

template <class Weight>
void MeshWriter::add_sets(const InfluenceSets<Weight>& sets, Json& attributes) {
  const bool fits_a_byte = std::all_of(
      sets.slots.begin(), sets.slots.end(), [](const std::vector<std::uint32_t>& slots) {
        return std::all_of(slots.begin(), slots.end(),
                           [](std::uint32_t slot) { return slot < 256; });
      });
  for (std::size_t set = 0; set < sets.slots.size(); ++set) {
    const std::vector<std::uint32_t>& slots = sets.slots[set];
    attributes[numbered("JOINTS_", set)] =
        fits_a_byte ? add_integers<std::uint8_t>(slots, 4, GlbDraft::ViewTarget::vertices)
                    : add_integers<std::uint16_t>(slots, 4, GlbDraft::ViewTarget::vertices);
    attributes[numbered("WEIGHTS_", set)] = add_weights(sets.weights[set]);
  }
}

template <class Weight>
std::uint32_t MeshWriter::add_weights(const std::vector<Weight>& weights) {
  if constexpr (std::is_same_v<Weight, float>)
    return add_floats(weights, 4);
  else
    return add_accessor({{"bufferView", draft_.add_view(std::as_bytes(std::span(weights)),
                                                        GlbDraft::ViewTarget::vertices)},
                         {"componentType", static_cast<std::uint32_t>(component_type<Weight>())},
                         {"normalized", true},
                         {"count", weights.size() / 4},
                         {"type", "VEC4"}});
}

Json MeshWriter::add_targets(const Mesh& mesh) {
  Json targets = Json::array();
  for (const MorphTarget& target : mesh.morph_targets) {
    Json deltas = Json::object();
    if (!target.position_deltas.empty())
      deltas["POSITION"] = add_vectors(target.position_deltas, Bounds::yes);
    // Deltas of an attribute that the mesh does not have are not valid glTF.
    if (!target.normal_deltas.empty() && !mesh.normals.empty())
      deltas["NORMAL"] = add_vectors(target.normal_deltas);
    if (!target.tangent_deltas.empty() && !mesh.tangents.empty())
      deltas["TANGENT"] = add_vectors(target.tangent_deltas);
    // A target without deltas is not valid either; an accessor of zeros takes no space.
    if (deltas.empty()) deltas["POSITION"] = add_zeros(mesh.positions.size());
    targets.push_back(std::move(deltas));
  }
  return targets;
}

std::uint32_t MeshWriter::add_zeros(std::size_t count) {
  return add_accessor({{"componentType", static_cast<std::uint32_t>(ComponentType::f32)},
                       {"count", count},
                       {"type", "VEC3"},
                       {"min", {0.0, 0.0, 0.0}},
                       {"max", {0.0, 0.0, 0.0}}});
}

void MeshWriter::fill_targets(Json& primitive, std::size_t count) {
  const std::size_t present = primitive.contains("targets") ? primitive["targets"].size() : 0;
  if (present >= count) return;
  const auto positions = primitive["attributes"]["POSITION"].get<std::size_t>();
  const std::uint32_t zeros =
      add_zeros(draft_.json["accessors"][positions]["count"].get<std::size_t>());
  Json& targets = list_of(primitive, "targets");
  while (targets.size() < count) targets.push_back({{"POSITION", zeros}});
}

std::uint32_t MeshWriter::add_indices(const Mesh& mesh, std::uint32_t submesh) {
  std::vector<std::uint32_t> indices;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.triangle_submesh[t] == submesh && !is_retired(mesh.triangles[t]))
      indices.insert(indices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  if (indices.empty()) return kNone;
  // The largest value of each integer type means "restart".
  return mesh.positions.size() < std::numeric_limits<std::uint16_t>::max()
             ? add_integers<std::uint16_t>(indices, 1, GlbDraft::ViewTarget::indices)
             : add_integers<std::uint32_t>(indices, 1, GlbDraft::ViewTarget::indices);
}

}  // namespace sunder::gltf
