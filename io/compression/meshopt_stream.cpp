#include "io/compression/meshopt_stream.h"

#include <meshoptimizer.h>

namespace sunder::compression {
namespace {

using Mode = MeshoptStream::Mode;
using Filter = MeshoptStream::Filter;
using MeshoptSize = unsigned long long;

constexpr std::uint64_t kLargestStride = 256;
// The vertex codec spends at least two bits on 16 bytes of output, the others a byte per triangle
// or index.
constexpr std::uint64_t kLargestRatio = 64;
constexpr std::uint64_t kTriangleTail = 17, kIndexTail = 5;
constexpr int kWrongHeader = -1;

bool is_possible_stride(const MeshoptStream& stream) {
  const std::uint64_t stride = stream.stride;
  if (stream.mode != Mode::attributes) return stride == 2 || stride == 4;
  if (stride == 0 || stride % 4 != 0 || stride > kLargestStride) return false;
  switch (stream.filter) {
    case Filter::octahedral: return stride == 4 || stride == 8;
    case Filter::quaternion: return stride == 8;
    case Filter::none:
    case Filter::exponential: return true;
  }
  return false;
}

/// No more elements than this can be encoded in the stream's bytes.
std::uint64_t largest_count(const MeshoptStream& stream) {
  const std::uint64_t size = stream.bytes.size();
  switch (stream.mode) {
    case Mode::attributes: return size * kLargestRatio / stream.stride;
    case Mode::triangles: return size < kTriangleTail ? 0 : (size - kTriangleTail) * 3;
    case Mode::indices: return size < kIndexTail ? 0 : size - kIndexTail;
  }
  return 0;
}

int decode(const MeshoptStream& stream, std::span<std::byte> out) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(stream.bytes.data());
  switch (stream.mode) {
    case Mode::attributes:
      return meshopt_decodeVertexBuffer(out.data(), stream.count, stream.stride, bytes,
                                        stream.bytes.size());
    case Mode::triangles:
      return meshopt_decodeIndexBuffer(out.data(), stream.count, stream.stride, bytes,
                                       stream.bytes.size());
    case Mode::indices:
      return meshopt_decodeIndexSequence(out.data(), stream.count, stream.stride, bytes,
                                         stream.bytes.size());
  }
  return kWrongHeader;
}

}  // namespace

Status check_stream(const MeshoptStream& stream) {
  if (stream.mode != Mode::attributes && stream.filter != Filter::none)
    return Status::failure(StatusCode::malformed_file, kNone, "a filter of indices");
  if (!is_possible_stride(stream))
    return Status::failure(StatusCode::malformed_file, kNone,
                           "elements of %llu bytes are not possible with this mode and filter",
                           static_cast<MeshoptSize>(stream.stride));
  if (stream.mode == Mode::triangles && stream.count % 3 != 0)
    return Status::failure(StatusCode::malformed_file, kNone,
                           "%llu indices are no whole number of triangles",
                           static_cast<MeshoptSize>(stream.count));
  if (stream.count == 0 || stream.count > largest_count(stream))
    return Status::failure(StatusCode::malformed_file, kNone,
                           "%llu elements of %llu bytes cannot be compressed in %zu bytes",
                           static_cast<MeshoptSize>(stream.count),
                           static_cast<MeshoptSize>(stream.stride), stream.bytes.size());
  return {};
}

Status decode_stream(const MeshoptStream& stream, std::span<std::byte> out) {
  const int error = decode(stream, out);
  if (error == kWrongHeader)
    return Status::failure(StatusCode::unsupported_feature, kNone,
                           "the compressed data is of another mode, or of a codec version that "
                           "meshoptimizer %d.%d does not read",
                           MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100);
  if (error != 0)
    return Status::failure(StatusCode::malformed_file, kNone, "the compressed data is damaged");
  switch (stream.filter) {
    case Filter::none: break;
    case Filter::octahedral:
      meshopt_decodeFilterOct(out.data(), stream.count, stream.stride);
      break;
    case Filter::quaternion:
      meshopt_decodeFilterQuat(out.data(), stream.count, stream.stride);
      break;
    case Filter::exponential:
      meshopt_decodeFilterExp(out.data(), stream.count, stream.stride);
      break;
  }
  return {};
}

}  // namespace sunder::compression
