#include "support/models/compressed_gltf.h"

#include <algorithm>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <map>
#include <meshoptimizer.h>
#include <set>
#include <stdexcept>

#include "support/machine/temporary_folder.h"

namespace sunder::test {
namespace {

std::size_t size_of_component(const Json& accessor) {
  const int type = accessor["componentType"];
  return type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
}

std::size_t components_of(const Json& accessor) {
  static const std::map<std::string, std::size_t> kComponents = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  return kComponents.at(accessor["type"]);
}

std::size_t size_of_element(const Json& accessor) {
  return size_of_component(accessor) * components_of(accessor);
}

/// Elements of an accessor, packed.
std::vector<std::uint8_t> elements_of(const GltfBuilder& builder, std::size_t index) {
  const Json& accessor = builder.json["accessors"][index];
  const Json& view = builder.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const std::size_t size = size_of_element(accessor), stride = view.value("byteStride", size),
                    first = view.value("byteOffset", std::size_t{0}) +
                            accessor.value("byteOffset", std::size_t{0});
  std::vector<std::uint8_t> elements;
  for (std::size_t i = 0; i < accessor["count"].get<std::size_t>(); ++i) {
    const auto* const at =
        reinterpret_cast<const std::uint8_t*>(builder.binary().data()) + first + i * stride;
    elements.insert(elements.end(), at, at + size);
  }
  return elements;
}

std::set<std::size_t> index_views(const Json& document) {
  std::set<std::size_t> views;
  for (const Json& mesh : document["meshes"])
    for (const Json& primitive : mesh["primitives"])
      views.insert(document["accessors"][primitive["indices"].get<std::size_t>()]["bufferView"]
                       .get<std::size_t>());
  return views;
}

std::vector<std::uint32_t> as_indices(const std::vector<std::uint8_t>& bytes, std::size_t size) {
  std::vector<std::uint32_t> indices(bytes.size() / size);
  for (std::size_t i = 0; i < indices.size(); ++i)
    std::memcpy(&indices[i], bytes.data() + i * size, size);  // little-endian
  return indices;
}

/// Compresses what one accessor has, and gives its view the extension.
class MeshoptPacker {
 public:
  MeshoptPacker(const GltfBuilder& source, const MeshoptPacking& packing)
      : source_(source), packing_(packing), index_views_(index_views(source.json)) {
    packed_.json = source.json;
    packed_.json["bufferViews"] = Json::array();
    for (const Json& view : source.json["bufferViews"]) views_.push_back(view);
  }

  GltfBuilder pack() {
    for (std::size_t i = 0; i < source_.json["accessors"].size(); ++i) pack_accessor(i);
    for (std::size_t view = 0; view < views_.size(); ++view) copy_image(view);
    packed_.json["bufferViews"] = views_;
    packed_.json["buffers"] = {{{"byteLength", packed_.binary().size()}},
                               {{"byteLength", fallback_size_},
                                {"extensions", {{packing_.extension, {{"fallback", true}}}}}}};
    for (const char* const list : {"extensionsUsed", "extensionsRequired"})
      packed_.json[list].push_back(packing_.extension);
    return std::move(packed_);
  }

 private:
  void pack_accessor(std::size_t index) {
    const Json& accessor = source_.json["accessors"][index];
    if (!accessor.contains("bufferView")) return;
    const auto view = accessor["bufferView"].get<std::size_t>();
    if (!done_.insert(view).second) return;
    const std::vector<std::uint8_t> bytes = elements_of(source_, index);
    const std::size_t stride = size_of_element(accessor), count = bytes.size() / stride;
    if (stride % 4 != 0 && !index_views_.contains(view)) {
      copy(view, bytes);
      return;
    }
    std::string mode = "ATTRIBUTES";
    if (index_views_.contains(view)) mode = packing_.as_sequences ? "INDICES" : "TRIANGLES";
    const std::vector<std::uint8_t> packed = encode(mode, bytes, count, stride);
    const std::size_t offset = take(packed);
    Json& json = views_[view];
    json["buffer"] = 1;
    json["byteOffset"] = fallback_size_;
    json["byteLength"] = bytes.size();
    json["extensions"][packing_.extension] = {
        {"buffer", 0},          {"byteOffset", offset}, {"byteLength", packed.size()},
        {"byteStride", stride}, {"count", count},       {"mode", mode}};
    fallback_size_ += (bytes.size() + 3) / 4 * 4;
  }

  /// A view without accessors has an image.
  void copy_image(std::size_t view) {
    if (!done_.insert(view).second) return;
    const auto first = views_[view].value("byteOffset", std::size_t{0});
    const auto* const at = reinterpret_cast<const std::uint8_t*>(source_.binary().data()) + first;
    copy(view, {at, at + views_[view]["byteLength"].get<std::size_t>()});
  }

  /// Appends bytes to the BIN chunk. @return their offset.
  std::size_t take(const std::vector<std::uint8_t>& bytes) {
    return packed_.json["bufferViews"][packed_.add_view(bytes)]["byteOffset"];
  }

  void copy(std::size_t view, const std::vector<std::uint8_t>& bytes) {
    views_[view]["byteOffset"] = take(bytes);
    views_[view]["byteLength"] = bytes.size();
  }

  static std::vector<std::uint8_t> encode(const std::string& mode,
                                          const std::vector<std::uint8_t>& bytes, std::size_t count,
                                          std::size_t stride) {
    std::vector<std::uint8_t> packed;
    std::size_t size = 0;
    if (mode == "ATTRIBUTES") {
      packed.resize(meshopt_encodeVertexBufferBound(count, stride));
      size = meshopt_encodeVertexBuffer(packed.data(), packed.size(), bytes.data(), count, stride);
    } else {
      const std::vector<std::uint32_t> indices = as_indices(bytes, stride);
      const std::uint32_t vertices = *std::max_element(indices.begin(), indices.end()) + 1;
      if (mode == "TRIANGLES") {
        packed.resize(meshopt_encodeIndexBufferBound(count, vertices));
        size = meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), count);
      } else {
        packed.resize(meshopt_encodeIndexSequenceBound(count, vertices));
        size = meshopt_encodeIndexSequence(packed.data(), packed.size(), indices.data(), count);
      }
    }
    packed.resize(size);
    return packed;
  }

  const GltfBuilder& source_;
  MeshoptPacking packing_;
  std::set<std::size_t> index_views_, done_;
  GltfBuilder packed_;
  Json views_ = Json::array();
  std::size_t fallback_size_ = 0;
};

draco::DataType draco_type(const Json& accessor) {
  switch (accessor["componentType"].get<int>()) {
    case 5120: return draco::DT_INT8;
    case 5121: return draco::DT_UINT8;
    case 5122: return draco::DT_INT16;
    case 5123: return draco::DT_UINT16;
    case 5125: return draco::DT_UINT32;
    default: return draco::DT_FLOAT32;
  }
}

draco::GeometryAttribute::Type draco_kind(const std::string& name) {
  if (name == "POSITION") return draco::GeometryAttribute::POSITION;
  if (name == "NORMAL") return draco::GeometryAttribute::NORMAL;
  if (name.starts_with("TEXCOORD_")) return draco::GeometryAttribute::TEX_COORD;
  if (name.starts_with("COLOR_")) return draco::GeometryAttribute::COLOR;
  return draco::GeometryAttribute::GENERIC;
}

class DracoPacker {
 public:
  DracoPacker(const GltfBuilder& source, const DracoPacking& packing)
      : source_(source), packing_(packing) {
    packed_ = source;
  }

  GltfBuilder pack() {
    for (Json& mesh : packed_.json["meshes"])
      for (Json& primitive : mesh["primitives"]) pack_primitive(primitive);
    for (const char* const list : {"extensionsUsed", "extensionsRequired"})
      packed_.json[list].push_back("KHR_draco_mesh_compression");
    return std::move(packed_);
  }

 private:
  /// A copy of an accessor that has no data, as Draco wants it.
  std::size_t without_data(std::size_t index, std::size_t count) {
    Json accessor = packed_.json["accessors"][index];
    accessor.erase("bufferView");
    accessor["count"] = count;
    packed_.json["accessors"].push_back(accessor);
    return packed_.json["accessors"].size() - 1;
  }

  void pack_primitive(Json& primitive) {
    const auto indices_at = primitive["indices"].get<std::size_t>();
    const auto indices = as_indices(elements_of(source_, indices_at),
                                    size_of_element(source_.json["accessors"][indices_at]));
    draco::Mesh mesh;
    mesh.SetNumFaces(indices.size() / 3);
    for (std::uint32_t i = 0; i < indices.size() / 3; ++i)
      mesh.SetFace(draco::FaceIndex(i),
                   {{draco::PointIndex(indices[3 * i]), draco::PointIndex(indices[3 * i + 1]),
                     draco::PointIndex(indices[3 * i + 2])}});
    Json ids = Json::object();
    for (const auto& item : primitive["attributes"].items())
      ids[item.key()] = add_attribute(mesh, item.key(), item.value().get<std::size_t>());
    draco::ExpertEncoder encoder(mesh);
    encoder.SetTrackEncodedProperties(true);
    encoder.SetEncodingMethod(packing_.is_sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                     : draco::MESH_EDGEBREAKER_ENCODING);
    for (int i = 0; i < mesh.num_attributes(); ++i)
      if (packing_.bits > 0 && mesh.attribute(i)->data_type() == draco::DT_FLOAT32)
        encoder.SetAttributeQuantization(i, packing_.bits);
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok())
      throw std::runtime_error(status.error_msg_string());
    const std::size_t view =
        packed_.add_view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
    for (auto& item : primitive["attributes"].items())
      item.value() = without_data(item.value().get<std::size_t>(), encoder.num_encoded_points());
    primitive["indices"] = without_data(indices_at, encoder.num_encoded_faces() * 3);
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                             {"attributes", ids}};
  }

  std::uint32_t add_attribute(draco::Mesh& mesh, const std::string& name, std::size_t index) {
    const Json& accessor = source_.json["accessors"][index];
    const std::vector<std::uint8_t> elements = elements_of(source_, index);
    const std::size_t size = size_of_element(accessor);
    const auto count = static_cast<std::uint32_t>(elements.size() / size);
    draco::GeometryAttribute described;
    described.Init(draco_kind(name), nullptr, static_cast<std::uint8_t>(components_of(accessor)),
                   draco_type(accessor), accessor.value("normalized", false),
                   static_cast<std::int64_t>(size), 0);
    mesh.set_num_points(count);
    const int id = mesh.AddAttribute(described, true, count);
    for (std::uint32_t v = 0; v < count; ++v)
      mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v),
                                            elements.data() + v * size);
    const auto unique_id = static_cast<std::uint32_t>(100 - 7 * id);
    mesh.attribute(id)->set_unique_id(unique_id);
    return unique_id;
  }

  const GltfBuilder& source_;
  DracoPacking packing_;
  GltfBuilder packed_;
};

}  // namespace

GltfBuilder built_from(const Character& character) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "built.glb";
  if (const Status status = save_glb(file, character); !status)
    throw std::runtime_error(std::string(status.text()));
  return GltfBuilder::from_glb(read_bytes(file));
}

GltfBuilder packed_by_meshopt(const GltfBuilder& source, const MeshoptPacking& packing) {
  return MeshoptPacker(source, packing).pack();
}

GltfBuilder packed_by_draco(const GltfBuilder& source, const DracoPacking& packing) {
  return DracoPacker(source, packing).pack();
}

}  // namespace sunder::test
