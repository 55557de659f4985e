#include "io/gltf_write/torn_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/gltf/accessors.h"
#include "io/gltf/file_identity.h"
#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

constexpr std::uint32_t kRecordVersion = 1;

/// A part of the view of a record, which becomes an accessor.
struct RecordColumn {
  const char* name;
  ComponentType type;
  const char* shape;
  std::size_t count;
  std::size_t offset;
};

/// The numbers of a record: columns of one buffer view, those of four bytes first.
class RecordBytes {
 public:
  template <class T>
  void add(const char* name, ComponentType type, const char* shape, std::size_t count,
           const std::vector<T>& values) {
    if (values.empty()) return;
    columns_.push_back({name, type, shape, count, bytes_.size()});
    const auto added = std::as_bytes(std::span(values));
    bytes_.insert(bytes_.end(), added.begin(), added.end());
  }

  /// As 16 bits if all are below `count` and that suffices.
  void add_indices(const char* name, const std::vector<std::uint32_t>& values, std::size_t count) {
    if (count <= std::numeric_limits<std::uint16_t>::max())
      add(name, ComponentType::u16, "SCALAR", values.size(),
          std::vector<std::uint16_t>(values.begin(), values.end()));
    else
      add(name, ComponentType::u32, "SCALAR", values.size(), values);
  }

  /// Appends the view and accessors, and writes their indices to a record.
  void append_to(GlbDraft& draft, Json& record) const {
    if (bytes_.empty()) return;
    const std::uint32_t view = draft.add_view(bytes_, GlbDraft::ViewTarget::none);
    Json& accessors = list_of(draft.json, "accessors");
    for (const RecordColumn& column : columns_) {
      record[column.name] = accessors.size();
      Json accessor = {{"bufferView", view},
                       {"componentType", static_cast<std::uint32_t>(column.type)},
                       {"count", column.count},
                       {"type", column.shape}};
      if (column.offset != 0) accessor["byteOffset"] = column.offset;
      accessors.push_back(std::move(accessor));
    }
  }

 private:
  std::vector<std::byte> bytes_;
  std::vector<RecordColumn> columns_;
};

/// FNV-1a (Fowler, Noll, Vo) of 32 bits. No change of a single byte leaves it as it was.
class ByteSum {
 public:
  void add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes)
      value_ = (value_ ^ std::to_integer<std::uint32_t>(byte)) * 0x01000193u;
  }
  [[nodiscard]] std::uint32_t value() const { return value_; }

 private:
  std::uint32_t value_ = 0x811C9DC5u;
};

/// The stored bytes of the elements of an accessor that is not sparse.
class StoredElements {
 public:
  StoredElements(const GlbDraft& draft, std::size_t accessor_index) {
    const Json& accessor = draft.json["accessors"][accessor_index];
    const auto view = accessor.find("bufferView");
    if (view == accessor.end()) return;
    bytes_ = draft.bytes_of_view(*view);
    count_ = accessor["count"].get<std::size_t>();
    const auto type = accessor["componentType"].get<std::uint32_t>();
    const auto shape = accessor["type"].get<std::string>();
    const std::size_t components = shape == "SCALAR" ? 1 : static_cast<std::size_t>(shape[3] - '0');
    size_ = components * (type <= 5121 ? 1 : type <= 5123 ? 2 : 4);
    const Json& of_view = draft.json["bufferViews"][view->get<std::size_t>()];
    stride_ = of_view.contains("byteStride") ? of_view["byteStride"].get<std::size_t>() : size_;
  }

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::span<const std::byte> operator[](std::size_t i) const {
    return bytes_.subspan(i * stride_, size_);
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t count_ = 0, size_ = 0, stride_ = 0;
};

/// The accessors of attributes in the order of their names, without tear sides.
std::vector<std::size_t> sorted_accessors(const Json& attributes) {
  std::map<std::string, std::size_t> by_name;
  for (const auto& [name, accessor] : attributes.items())
    if (name != kTearSideAttribute && name != kTearSideFeatureAttribute)
      by_name.emplace(name, accessor.get<std::size_t>());
  std::vector<std::size_t> accessors;
  for (const auto& [name, accessor] : by_name) accessors.push_back(accessor);
  return accessors;
}

/// Sums of the stored bytes of each vertex from `first` on: its attributes, then its morph targets.
std::vector<std::uint32_t> vertex_sums(const MeshWriter::Vertices& vertices, std::size_t first,
                                       std::size_t count, const GlbDraft& draft) {
  std::vector<ByteSum> sums(count);
  const auto add = [&](const Json& attributes) {
    for (const std::size_t accessor : sorted_accessors(attributes)) {
      const StoredElements elements(draft, accessor);
      for (std::size_t i = 0; i < count && first + i < elements.size(); ++i)
        sums[i].add(elements[first + i]);
    }
  };
  add(vertices.attributes);
  if (vertices.targets.is_array())
    for (const Json& target : vertices.targets) add(target);
  std::vector<std::uint32_t> values;
  for (const ByteSum& sum : sums) values.push_back(sum.value());
  return values;
}

/// A sum of what the source does not tell of any vertex: tear sides, and appended morph targets.
std::uint32_t sum_of_rest(const RecordedMesh& of, const GlbDraft& draft) {
  ByteSum sum;
  for (const CustomAttribute& attribute : of.mesh.custom_attributes)
    if (attribute.name == kTearSideAttribute && attribute.components == 1)
      sum.add(std::as_bytes(std::span(attribute.values)));
  if (!of.vertices.targets.is_array()) return sum.value();
  for (std::size_t t = of.source_targets; t < of.vertices.targets.size(); ++t)
    for (const std::size_t accessor : sorted_accessors(of.vertices.targets[t])) {
      const StoredElements elements(draft, accessor);
      for (std::size_t i = 0; i < elements.size(); ++i) sum.add(elements[i]);
    }
  return sum.value();
}

std::span<Json> array_in(Json& object, const char* name) {
  if (!object.is_object()) return {};
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array()) return {};
  return found->get_ref<Json::array_t&>();
}

/// A place between three vertices.
struct Place {
  Triangle parents;
  std::array<double, 3> parts;

  auto operator<=>(const Place&) const = default;
};

/// The places of appended vertices, each once: vertices refer to them, those inside of walls and
/// caps to the end of the list.
class Places {
 public:
  Places(const std::vector<VertexOrigin>& origins, std::uint32_t first_vertex) {
    std::map<Place, std::uint32_t> known;
    for (const VertexOrigin& origin : origins) {
      if (origin.values == VertexOrigin::Values::none) {
        of_vertices_.push_back(kNone);
        continue;
      }
      const std::uint32_t parent = origin.parents[0];
      if (origin.values == VertexOrigin::Values::motion && parent >= first_vertex &&
          of_vertices_[parent - first_vertex] != kNone) {
        of_vertices_.push_back(of_vertices_[parent - first_vertex]);
        continue;
      }
      const Place place{origin.parents, origin.parts};
      const auto [at, is_new] = known.try_emplace(place, static_cast<std::uint32_t>(list_.size()));
      if (is_new) list_.push_back(place);
      of_vertices_.push_back(at->second);
    }
    const auto none = static_cast<std::uint32_t>(list_.size());
    std::replace(of_vertices_.begin(), of_vertices_.end(), kNone, none);
  }

  [[nodiscard]] const std::vector<Place>& list() const { return list_; }
  [[nodiscard]] const std::vector<std::uint32_t>& of_vertices() const { return of_vertices_; }

 private:
  std::vector<Place> list_;
  std::vector<std::uint32_t> of_vertices_;
};

std::uint8_t kind_of(const VertexOrigin& origin) {
  return static_cast<std::uint8_t>(origin.policy | static_cast<unsigned>(origin.values) << 2 |
                                   (origin.is_limited ? 16u : 0u));
}

/// Whether every value of the vertex follows from its parents.
bool is_derived(const VertexOrigin& origin) {
  return origin.values == VertexOrigin::Values::all && (origin.policy == 0 || origin.policy == 3);
}

/// The origins of all appended vertices: those without one are their own parents.
std::vector<VertexOrigin> all_origins(const MeshOrigins& origins, std::uint32_t vertex_count) {
  std::vector<VertexOrigin> all = origins.vertices;
  for (auto v = origins.first_vertex + static_cast<std::uint32_t>(all.size()); v < vertex_count;
       ++v)
    all.push_back({{v, v, v}, {1, 0, 0}, VertexOrigin::Values::none});
  return all;
}

void check_origin(const VertexOrigin& origin, std::uint32_t mesh, std::uint32_t vertex) {
  double sum = 0;
  bool is_valid = origin.policy < 4 && origin.values <= VertexOrigin::Values::none;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t parent = origin.parents[k];
    is_valid &=
        parent < vertex || (parent == vertex && origin.values == VertexOrigin::Values::none);
    is_valid &= origin.parts[k] >= 0;
    sum += origin.parts[k];
  }
  if (origin.values == VertexOrigin::Values::motion) is_valid &= origin.parts[0] == 1.0;
  if (!is_valid || !(std::abs(sum - 1.0) < 1e-6))
    refuse(StatusCode::invalid_argument, vertex,
           "save_glb: origins: mesh %u: vertex %u: expected older parents, parts >= 0 that sum to "
           "one, and a policy below 4",
           mesh, vertex);
}

}  // namespace

void check_origins(const Character& character, const Character& source,
                   const std::vector<MeshOrigins>& origins) {
  if (origins.empty()) return;
  if (origins.size() != character.meshes.size())
    refuse(StatusCode::size_mismatch, kNone,
           "save_glb: origins of %zu meshes, the character has %zu", origins.size(),
           character.meshes.size());
  for (std::uint32_t m = 0; m < origins.size(); ++m) {
    const MeshOrigins& of = origins[m];
    const std::uint32_t of_source = source.meshes[m].vertex_count(),
                        of_torn = character.meshes[m].vertex_count();
    if (of.first_vertex != of_source || of.vertices.size() > of_torn - of.first_vertex)
      refuse(StatusCode::size_mismatch, m,
             "save_glb: origins: mesh %u: vertices %u to %zu; it has %u, the source %u", m,
             of.first_vertex, of.first_vertex + of.vertices.size(), of_torn, of_source);
    for (std::uint32_t i = 0; i < of.vertices.size(); ++i)
      check_origin(of.vertices[i], m, of.first_vertex + i);
    for (const ReducedTriangle& reduced : of.reduced)
      if (reduced.triangle >= source.meshes[m].triangle_count() ||
          !(reduced.remaining >= 0 && reduced.remaining <= 1))
        refuse(StatusCode::index_out_of_range, reduced.triangle,
               "save_glb: origins: mesh %u: triangle %u with the share %g; the source has %u", m,
               reduced.triangle, reduced.remaining, source.meshes[m].triangle_count());
  }
}

void remove_torn_record(Json& document) {
  const auto remove = [](Json& object) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return;
    extensions->erase(kTornMesh);
    if (extensions->empty()) object.erase("extensions");
  };
  remove(document);
  for (Json& mesh : array_in(document, "meshes"))
    for (Json& primitive : array_in(mesh, "primitives"))
      if (primitive.is_object()) remove(primitive);
  const auto used = document.find("extensionsUsed");
  if (used == document.end() || !used->is_array()) return;
  used->erase(std::remove(used->begin(), used->end(), Json(kTornMesh)), used->end());
  if (used->empty()) document.erase("extensionsUsed");
}

Json add_origins(const MeshOrigins& origins, const RecordedMesh& of, GlbDraft& draft) {
  const std::vector<VertexOrigin> all = all_origins(origins, of.mesh.vertex_count());
  const Places places(all, origins.first_vertex);
  std::vector<float> parts, remaining;
  std::vector<std::uint32_t> parents, reduced;
  std::vector<std::uint8_t> kinds;
  for (const Place& place : places.list()) {
    for (const double part : place.parts) parts.push_back(static_cast<float>(part));
    parents.insert(parents.end(), place.parents.begin(), place.parents.end());
  }
  for (const VertexOrigin& origin : all) kinds.push_back(kind_of(origin));
  for (const ReducedTriangle& triangle : origins.reduced) {
    reduced.push_back(triangle.triangle);
    remaining.push_back(static_cast<float>(triangle.remaining));
  }
  RecordBytes bytes;
  bytes.add("parts", ComponentType::f32, "VEC3", places.list().size(), parts);
  bytes.add("reduced", ComponentType::u32, "SCALAR", reduced.size(), reduced);
  bytes.add("remaining", ComponentType::f32, "SCALAR", reduced.size(), remaining);
  if (!std::all_of(all.begin(), all.end(), is_derived))
    bytes.add("sums", ComponentType::u32, "SCALAR", all.size(),
              vertex_sums(of.vertices, origins.first_vertex, all.size(), draft));
  bytes.add_indices("parents", parents, of.mesh.vertex_count());
  bytes.add_indices("places", places.of_vertices(), places.list().size() + 1);
  bytes.add("kinds", ComponentType::u8, "SCALAR", kinds.size(), kinds);
  Json record = {{"firstVertex", origins.first_vertex},
                 {"influences", of.maximum_influences},
                 {"restSum", sum_of_rest(of, draft)}};
  bytes.append_to(draft, record);
  return record;
}

void set_origins(const Json& of_mesh, const SourceDocument::MeshOrigin& origin,
                 std::uint32_t source_primitive, const GlbDraft& draft, Json& primitive) {
  Json record = of_mesh;
  record["sourceMesh"] = origin.mesh;
  record["sourcePrimitives"] = origin.primitives;
  if (source_primitive != kNone) record["sourcePrimitive"] = source_primitive;
  ByteSum sum;
  const StoredElements indices(draft, primitive["indices"].get<std::size_t>());
  for (std::size_t i = 0; i < indices.size(); ++i) sum.add(indices[i]);
  record["indexSum"] = sum.value();
  primitive["extensions"][kTornMesh] = std::move(record);
}

void add_source_of_record(const LoadedCharacter& loaded, const SaveOptions& options,
                          const Json& gone, Json& document) {
  const FileIdentity file = identity_of(*loaded.source);
  Json record = {
      {"version", kRecordVersion},
      {"source",
       {{"sha256", file.sha256}, {"bytes", file.bytes}, {"format", loaded.report.format}}}};
  if (options.certified_bound) record["certifiedBound"] = *options.certified_bound;
  if (options.place_bound) record["placeBound"] = *options.place_bound;
  if (!gone.empty()) record["gone"] = gone;
  document["extensions"][kTornMesh] = std::move(record);
  Json& used = list_of(document, "extensionsUsed");
  if (std::find(used.begin(), used.end(), Json(kTornMesh)) == used.end()) used.push_back(kTornMesh);
}

}  // namespace sunder::gltf
