#include "io/compression/draco_stream.h"

#include <algorithm>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>
#include <string>
#include <type_traits>
#include <utility>

namespace sunder::compression {
namespace {

using DracoSize = unsigned long long;

constexpr int kVersionMajor = 2, kVersionMinor = 2;
// glTF has about 16 attributes of at most four numbers. Draco allows thousands of 255.
constexpr int kMostAttributes = 64, kMostComponents = 16;
// Tables of corners and of attribute seams, which the decoder fills per triangle.
constexpr std::uint64_t kBytesPerTriangle = 128;

/// Checks the claims of a stream in the places where Draco has parsed them and has not yet
/// allocated for them.
class ClaimCheck {
 public:
  explicit ClaimCheck(const DracoLimits& limits) : limits_(limits) {}

  [[nodiscard]] const Status& fault() const { return fault_; }

  bool accepts_triangles(std::uint64_t triangles, std::uint64_t points) {
    if (triangles == 0 || triangles > limits_.triangles)
      return refuse(StatusCode::malformed_file, "declares %llu triangles; the file's indices have",
                    triangles, limits_.triangles);
    if (points > std::max(limits_.points, 3 * triangles))
      return refuse(StatusCode::malformed_file, "declares %llu points; the file's vertices are",
                    points, limits_.points);
    if (triangles * kBytesPerTriangle > limits_.bytes)
      return refuse(StatusCode::limit_exceeded, "takes %llu bytes to decode; the limit is",
                    triangles * kBytesPerTriangle, limits_.bytes);
    return true;
  }

  bool accepts_attributes(const draco::PointCloud& cloud) {
    std::uint64_t bytes_per_point = 0;
    for (int i = 0; i < std::min(cloud.num_attributes(), kMostAttributes); ++i) {
      const draco::PointAttribute& attribute = *cloud.attribute(i);
      if (attribute.num_components() > kMostComponents)
        return refuse(StatusCode::malformed_file, "has an attribute of %llu numbers; expected",
                      static_cast<std::uint64_t>(attribute.num_components()), kMostComponents);
      // The decoder holds the numbers as integers first, then as what they are.
      bytes_per_point += static_cast<std::uint64_t>(attribute.num_components()) * 8 + 4;
    }
    if (cloud.num_attributes() > kMostAttributes)
      return refuse(StatusCode::malformed_file, "has %llu attributes; expected at most",
                    static_cast<std::uint64_t>(cloud.num_attributes()), kMostAttributes);
    const std::uint64_t bytes = bytes_per_point * cloud.num_points();
    if (bytes > limits_.bytes)
      return refuse(StatusCode::limit_exceeded, "takes %llu bytes to decode; the limit is", bytes,
                    limits_.bytes);
    return true;
  }

 private:
  bool refuse(StatusCode code, const char* format, std::uint64_t claimed, std::uint64_t limit) {
    const std::string text = std::string("the Draco data ") + format + " %llu";
    fault_ = Status::failure(code, kNone, text.c_str(), static_cast<DracoSize>(claimed),
                             static_cast<DracoSize>(limit));
    return false;
  }

  DracoLimits limits_;
  Status fault_;
};

/// Draco's decoder of one method, with the checks in between.
template <class Decoder>
class CheckedDecoder : public Decoder {
 public:
  explicit CheckedDecoder(ClaimCheck& check) : check_(check) {}

 protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead;  // a second reader at the same place
    ahead.Init(this->buffer()->data_head(),
               static_cast<std::size_t>(this->buffer()->remaining_size()),
               this->buffer()->bitstream_version());
    std::uint32_t first = 0, second = 0;
    if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead)) return false;
    const bool is_edgebreaker = std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>;
    const std::uint32_t triangles = is_edgebreaker ? second : first,
                        points = is_edgebreaker ? first : second;
    return check_.accepts_triangles(triangles, points) && Decoder::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    return check_.accepts_attributes(*this->point_cloud()) && Decoder::DecodeAllAttributes();
  }

 private:
  ClaimCheck& check_;
};

template <class Decoder>
Status decode_by(std::span<const std::byte> stream, const DracoLimits& limits, draco::Mesh& mesh) {
  ClaimCheck check(limits);
  CheckedDecoder<Decoder> decoder(check);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  const draco::DecoderOptions options;
  const draco::Status status = decoder.Decode(options, &buffer, &mesh);
  if (!check.fault()) return check.fault();
  if (!status.ok())
    return Status::failure(StatusCode::malformed_file, kNone, "the Draco data is damaged: %.80s",
                           status.error_msg());
  return {};
}

bool has_valid_triangles(const draco::Mesh& mesh) {
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
    for (const draco::PointIndex& point : mesh.face(face))
      if (point.value() >= mesh.num_points()) return false;
  return true;
}

}  // namespace

Result<DracoMesh> DracoMesh::decode(std::span<const std::byte> stream, const DracoLimits& limits) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  draco::DracoHeader header;
  if (const draco::Status status = draco::PointCloudDecoder::DecodeHeader(&buffer, &header);
      !status.ok())
    return Status::failure(StatusCode::malformed_file, kNone, "no Draco data: %.80s",
                           status.error_msg());
  if (header.encoder_type != draco::TRIANGULAR_MESH || header.version_major != kVersionMajor ||
      header.version_minor != kVersionMinor)
    return Status::failure(StatusCode::unsupported_feature, kNone,
                           "Draco data of version %u.%u and type %u; expected meshes of 2.2",
                           header.version_major, header.version_minor, header.encoder_type);
  auto mesh = std::make_unique<draco::Mesh>();
  const Status status = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                            ? decode_by<draco::MeshEdgebreakerDecoder>(stream, limits, *mesh)
                        : header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING
                            ? decode_by<draco::MeshSequentialDecoder>(stream, limits, *mesh)
                            : Status::failure(StatusCode::malformed_file, kNone,
                                              "unknown Draco method %u", header.encoder_method);
  if (!status) return status;
  if (!has_valid_triangles(*mesh))
    return Status::failure(StatusCode::malformed_file, kNone,
                           "the Draco data has triangles of points that do not exist");
  return DracoMesh(std::move(mesh));
}

DracoMesh::DracoMesh(std::unique_ptr<draco::Mesh> mesh) : mesh_(std::move(mesh)) {}
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;
DracoMesh& DracoMesh::operator=(DracoMesh&&) noexcept = default;
DracoMesh::~DracoMesh() = default;

std::uint32_t DracoMesh::point_count() const { return mesh_->num_points(); }

std::vector<Triangle> DracoMesh::triangles() const {
  std::vector<Triangle> triangles(mesh_->num_faces());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner)
      triangles[t][corner] = mesh_->face(draco::FaceIndex(t))[corner].value();
  return triangles;
}

std::uint32_t DracoMesh::components(std::uint32_t unique_id) const {
  const draco::PointAttribute* const attribute = mesh_->GetAttributeByUniqueId(unique_id);
  return attribute == nullptr ? 0 : static_cast<std::uint32_t>(attribute->num_components());
}

template <class T>
bool DracoMesh::read(std::uint32_t unique_id, std::span<T> out) const {
  const draco::PointAttribute& attribute = *mesh_->GetAttributeByUniqueId(unique_id);
  const auto components = static_cast<std::int8_t>(attribute.num_components());
  const auto per_point = static_cast<std::size_t>(components);
  if (!attribute.is_mapping_identity() && attribute.indices_map_size() < mesh_->num_points())
    return false;
  for (draco::PointIndex point(0); point < mesh_->num_points(); ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(point);
    if (value.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(value, components, &out[point.value() * per_point]))
      return false;
  }
  return true;
}

template bool DracoMesh::read(std::uint32_t, std::span<std::int8_t>) const;
template bool DracoMesh::read(std::uint32_t, std::span<std::uint8_t>) const;
template bool DracoMesh::read(std::uint32_t, std::span<std::int16_t>) const;
template bool DracoMesh::read(std::uint32_t, std::span<std::uint16_t>) const;
template bool DracoMesh::read(std::uint32_t, std::span<std::uint32_t>) const;
template bool DracoMesh::read(std::uint32_t, std::span<float>) const;

}  // namespace sunder::compression
