#include "io/gltf_decoders/draco_primitives.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/compression/draco_stream.h"
#include "io/gltf/accessors.h"
#include "io/gltf/buffers.h"
#include "io/gltf/refusal.h"
#include "io/gltf_read/decoded_data.h"

namespace sunder::gltf {
namespace {

using compression::DracoMesh;
using DracoSize = unsigned long long;

constexpr const char* kName = "KHR_draco_mesh_compression";
constexpr std::uint64_t kTriangleMode = 4;

/// The accessor of an attribute, and the attribute's id in the Draco data.
struct AttributeSource {
  std::string name;
  std::uint32_t accessor = 0;
  std::uint32_t unique_id = 0;
};

std::uint32_t accessor_of(const SourceDocument& document, const Cursor& reference) {
  return reference.to_index(count_of(document.json, "accessors"), "accessor");
}

std::vector<AttributeSource> attribute_sources(const SourceDocument& document,
                                               const Cursor& primitive, const Cursor& extension) {
  std::vector<AttributeSource> sources;
  const Cursor ids = extension.member("attributes"), attributes = primitive.member("attributes");
  for (const auto& item : ids.json().items()) {
    const Cursor id(item.value(), ids.pointer() + "/" + item.key());
    const std::uint64_t unique_id = id.to_unsigned();
    if (unique_id >= kNone)
      refuse(StatusCode::malformed_file, kNone, "%.160s: the Draco data has no attribute %llu",
             id.pointer().c_str(), static_cast<DracoSize>(unique_id));
    sources.push_back({item.key(), accessor_of(document, attributes.member(item.key().c_str())),
                       static_cast<std::uint32_t>(unique_id)});
  }
  return sources;
}

std::uint32_t components_of(const Cursor& accessor) {
  constexpr std::array<std::string_view, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  const auto found = std::find(kTypes.begin(), kTypes.end(), accessor.member("type").to_string());
  return static_cast<std::uint32_t>(found - kTypes.begin()) + 1;
}

/// Decodes the primitives one by one into the document.
class Decoding {
 public:
  Decoding(SourceDocument& document, DecodedData& decoded)
      : document_(document), decoded_(decoded) {}

  void decode(std::size_t mesh, std::size_t primitive) {
    const Cursor at = entry(document_.json, "meshes", mesh).member("primitives").element(primitive);
    const Cursor extension = at.member("extensions").member(kName);
    const auto sources = attribute_sources(document_, at, extension);
    if (is_stored_uncompressed(at, sources)) return;
    const DracoMesh decoded = decode_stream(at, extension, sources);
    Json attributes = at.json()["attributes"];
    for (const AttributeSource& source : sources)
      attributes[source.name] = add_attribute(decoded, source, extension);
    const std::uint32_t indices = add_indices(decoded, at);
    Json& changed = document_.json["meshes"][mesh]["primitives"][primitive];
    changed["attributes"] = std::move(attributes);
    changed["indices"] = indices;
    changed.erase("mode");  // Draco data are triangles, also those of a strip.
  }

 private:
  [[nodiscard]] bool has_data(std::uint32_t accessor) const {
    return entry(document_.json, "accessors", accessor).find("bufferView").has_value();
  }

  [[nodiscard]] bool is_stored_uncompressed(const Cursor& primitive,
                                            const std::vector<AttributeSource>& sources) const {
    const auto indices = primitive.find("indices");
    return indices && has_data(accessor_of(document_, *indices)) &&
           std::all_of(sources.begin(), sources.end(),
                       [&](const AttributeSource& source) { return has_data(source.accessor); });
  }

  [[nodiscard]] std::uint64_t count_of_accessor(std::uint32_t accessor) const {
    return entry(document_.json, "accessors", accessor).member("count").to_unsigned();
  }

  [[nodiscard]] DracoMesh decode_stream(const Cursor& primitive, const Cursor& extension,
                                        const std::vector<AttributeSource>& sources) const {
    const std::uint32_t view =
        extension.member("bufferView")
            .to_index(count_of(document_.json, "bufferViews"), "buffer view");
    compression::DracoLimits limits{kNone / 3, 0, decoded_.bytes_left()};
    const auto indices = primitive.find("indices");
    if (indices && primitive.unsigned_or("mode", kTriangleMode) == kTriangleMode)
      limits.triangles = count_of_accessor(accessor_of(document_, *indices)) / 3;
    for (const AttributeSource& source : sources)
      limits.points = std::max(limits.points, count_of_accessor(source.accessor));
    auto decoded = DracoMesh::decode(bytes_of_view(document_, view), limits);
    if (!decoded)
      refuse(decoded.error().code(), kNone, "%s: %.160s", extension.pointer().c_str(),
             decoded.error().text().data());
    return std::move(*decoded);
  }

  template <class T>
  std::uint32_t add_values(const DracoMesh& mesh, const AttributeSource& source,
                           std::uint32_t components, const Cursor& extension) {
    const std::size_t count = std::size_t{mesh.point_count()} * components;
    const DecodedData::Buffer buffer = decoded_.add_buffer(count * sizeof(T), extension);
    const std::span<T> values(reinterpret_cast<T*>(buffer.bytes.data()), count);
    if (!mesh.read(source.unique_id, values))
      refuse(StatusCode::malformed_file, kNone,
             "%s/attributes/%.40s: values that the accessor's type cannot hold",
             extension.pointer().c_str(), source.name.c_str());
    if (source.name == "POSITION" && components == 3) note_bounds(std::span<const T>(values));
    return decoded_.add_view(buffer);
  }

  /// Quantised positions need not lie within the bounds of the original ones.
  template <class T>
  void note_bounds(std::span<const T> positions) {
    std::array<T, 3> least, largest;
    least.fill(std::numeric_limits<T>::max());
    largest.fill(std::numeric_limits<T>::lowest());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      least[i % 3] = std::min(least[i % 3], positions[i]);
      largest[i % 3] = std::max(largest[i % 3], positions[i]);
    }
    bounds_ = {{"min", least}, {"max", largest}};
  }

  std::uint32_t add_attribute(const DracoMesh& mesh, const AttributeSource& source,
                              const Cursor& extension) {
    const Cursor accessor = entry(document_.json, "accessors", source.accessor);
    const std::uint32_t components = components_of(accessor);
    if (components != mesh.components(source.unique_id))
      refuse(StatusCode::malformed_file, source.accessor,
             "%s/attributes/%.40s: the Draco data has %u numbers per vertex, the accessor %u",
             extension.pointer().c_str(), source.name.c_str(), mesh.components(source.unique_id),
             components);
    const std::uint64_t type = accessor.member("componentType").to_unsigned();
    bounds_ = nullptr;
    const auto add = [&]<class T>(T) { return add_values<T>(mesh, source, components, extension); };
    switch (static_cast<ComponentType>(type)) {
      case ComponentType::i8: return fill(source.accessor, add(std::int8_t{}), mesh.point_count());
      case ComponentType::u8: return fill(source.accessor, add(std::uint8_t{}), mesh.point_count());
      case ComponentType::i16:
        return fill(source.accessor, add(std::int16_t{}), mesh.point_count());
      case ComponentType::u16:
        return fill(source.accessor, add(std::uint16_t{}), mesh.point_count());
      case ComponentType::u32:
        return fill(source.accessor, add(std::uint32_t{}), mesh.point_count());
      case ComponentType::f32: return fill(source.accessor, add(0.0f), mesh.point_count());
    }
    refuse(StatusCode::malformed_file, source.accessor,
           "/accessors/%u/componentType: unknown component type %llu", source.accessor,
           static_cast<DracoSize>(type));
  }

  /// Gives an accessor its data; a copy of it, if it has other data already.
  std::uint32_t fill(std::uint32_t accessor, std::uint32_t view, std::uint64_t count) {
    Json& accessors = document_.json["accessors"];
    Json filled = accessors[accessor];
    const bool is_taken = filled.contains("bufferView");
    for (const char* const key : {"byteOffset", "sparse", "min", "max"}) filled.erase(key);
    filled["bufferView"] = view;
    filled["count"] = count;
    if (!bounds_.is_null()) filled.update(bounds_);
    if (!is_taken) {
      accessors[accessor] = std::move(filled);
      return accessor;
    }
    accessors.push_back(std::move(filled));
    return static_cast<std::uint32_t>(accessors.size() - 1);
  }

  std::uint32_t add_indices(const DracoMesh& mesh, const Cursor& primitive) {
    const std::vector<Triangle> triangles = mesh.triangles();
    const auto listed = primitive.find("indices");
    const std::uint32_t accessor = listed ? accessor_of(document_, *listed) : new_accessor();
    const DecodedData::Buffer buffer =
        decoded_.add_buffer(triangles.size() * sizeof(Triangle), primitive);
    const auto bytes = std::as_bytes(std::span(triangles));
    std::copy(bytes.begin(), bytes.end(), buffer.bytes.begin());
    bounds_ = nullptr;
    const std::uint32_t filled = fill(accessor, decoded_.add_view(buffer), triangles.size() * 3);
    Json& indices = document_.json["accessors"][filled];
    indices["componentType"] = static_cast<std::uint32_t>(ComponentType::u32);
    indices["type"] = "SCALAR";
    return filled;
  }

  std::uint32_t new_accessor() {
    Json& accessors = document_.json["accessors"];
    accessors.push_back(Json::object());
    return static_cast<std::uint32_t>(accessors.size() - 1);
  }

  SourceDocument& document_;
  DecodedData& decoded_;
  Json bounds_;  ///< Of the attribute that is added; null for others than positions.
};

/// The primitives with the extension, as indices of meshes and of their primitives.
std::vector<std::pair<std::size_t, std::size_t>> compressed_primitives(const Json& document) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t mesh = 0; mesh < count_of(document, "meshes"); ++mesh) {
    const Cursor primitives = entry(document, "meshes", mesh).member("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i)
      if (const auto extensions = primitives.element(i).find("extensions");
          extensions && extensions->find(kName))
        found.emplace_back(mesh, i);
  }
  return found;
}

}  // namespace

void decode_draco_primitives(SourceDocument& document, DecodedData& decoded, Notes& notes) {
  const auto primitives = compressed_primitives(document.json);
  if (primitives.empty()) return;
  Decoding decoding(document, decoded);
  for (const auto& [mesh, primitive] : primitives) decoding.decode(mesh, primitive);
  for (const auto& [mesh, primitive] : primitives) {
    Json& changed = document.json["meshes"][mesh]["primitives"][primitive];
    changed["extensions"].erase(kName);
    if (changed["extensions"].empty()) changed.erase("extensions");
  }
  unlist_extension(document.json, kName);
  notes.inform("primitives", "are compressed (Draco); saving writes them uncompressed",
               static_cast<std::uint32_t>(primitives.size()));
}

}  // namespace sunder::gltf
