#include "io/assimp/weld.h"

#include <cstring>
#include <unordered_set>

namespace sunder::assimp_import {
namespace {

class Vertices {
 public:
  explicit Vertices(const MeshPart& part) : part_(part) {}

  [[nodiscard]] std::size_t hash(std::uint32_t vertex) const {
    std::uint64_t state = 0xCBF2'9CE4'8422'2325u;
    const auto mix = [&](std::uint32_t word) {
      state = (state ^ word) * 0x9E37'79B9'7F4A'7C15u;
      state ^= state >> 32;
    };
    for (const Stream& stream : part_.streams) {
      for (int i = 0; i < stream.components; ++i) {
        std::uint32_t word = 0;
        std::memcpy(&word, values(stream, vertex) + i, sizeof word);
        mix(word);
      }
    }
    for (const Influence& influence : influences(vertex)) {
      std::uint32_t word = 0;
      std::memcpy(&word, &influence.weight, sizeof word);
      mix(influence.slot);
      mix(word);
    }
    return static_cast<std::size_t>(state);
  }

  [[nodiscard]] bool equal(std::uint32_t a, std::uint32_t b) const {
    for (const Stream& stream : part_.streams)
      if (std::memcmp(values(stream, a), values(stream, b),
                      sizeof(float) * static_cast<std::size_t>(stream.components)) != 0)
        return false;
    const auto of_a = influences(a), of_b = influences(b);
    return of_a.size() == of_b.size() &&
           (of_a.empty() || std::memcmp(of_a.data(), of_b.data(), of_a.size_bytes()) == 0);
  }

 private:
  static const float* values(const Stream& stream, std::uint32_t vertex) {
    return stream.values.data() + std::size_t{vertex} * static_cast<std::size_t>(stream.components);
  }
  [[nodiscard]] std::span<const Influence> influences(std::uint32_t vertex) const {
    return part_.weights.vertex_count() == 0 ? std::span<const Influence>()
                                             : part_.weights.of(vertex);
  }

  const MeshPart& part_;
};

void keep(Stream& stream, const std::vector<std::uint32_t>& old_from_new) {
  const auto width = static_cast<std::size_t>(stream.components);
  for (std::size_t i = 0; i < old_from_new.size(); ++i)
    std::memmove(stream.values.data() + i * width, stream.values.data() + old_from_new[i] * width,
                 width * sizeof(float));
  stream.values.resize(old_from_new.size() * width);
}

}  // namespace

std::uint32_t weld_identical(MeshPart& part) {
  const std::uint32_t count = part.vertex_count();
  const Vertices vertices(part);
  const auto hash = [&](std::uint32_t vertex) { return vertices.hash(vertex); };
  const auto equal = [&](std::uint32_t a, std::uint32_t b) { return vertices.equal(a, b); };
  std::unordered_set<std::uint32_t, decltype(hash), decltype(equal)> kept(count, hash, equal);

  std::vector<std::uint32_t> new_from_old(count), old_from_new;
  for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
    const auto [first, is_new] = kept.insert(vertex);
    if (is_new) {
      new_from_old[vertex] = static_cast<std::uint32_t>(old_from_new.size());
      old_from_new.push_back(vertex);
    } else {
      new_from_old[vertex] = new_from_old[*first];
    }
  }
  if (old_from_new.size() == count) return 0;

  for (Triangle& triangle : part.triangles)
    for (std::uint32_t& vertex : triangle) vertex = new_from_old[vertex];
  for (Stream& stream : part.streams) keep(stream, old_from_new);
  if (part.weights.vertex_count() != 0) {
    SkinWeights weights;
    for (const std::uint32_t vertex : old_from_new) weights.append(part.weights.of(vertex));
    part.weights = std::move(weights);
  }
  return count - static_cast<std::uint32_t>(old_from_new.size());
}

}  // namespace sunder::assimp_import
