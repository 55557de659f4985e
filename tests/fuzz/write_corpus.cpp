// Writes the seeds of the targets `glb`, `import_reply`, `operations` and `snapshot`:
// write_fuzz_corpus tests/fuzz/corpus

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

#include "fuzz/snapshot_scene.h"
#include "io/faulty_documents.h"
#include "io/import_messages/reply.h"
#include "support/models/gltf_builder.h"

namespace {

void write(const std::string& file, const std::vector<std::byte>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

/// As import_reply_fuzzer.cpp divides its input: the length of the head, the head, the GLB.
std::vector<std::byte> reply(const std::string& head, const std::vector<std::byte>& glb) {
  const auto length = static_cast<std::uint32_t>(head.size());
  std::vector<std::byte> bytes(sizeof length);
  std::memcpy(bytes.data(), &length, sizeof length);
  for (const char c : head) bytes.push_back(static_cast<std::byte>(c));
  bytes.insert(bytes.end(), glb.begin(), glb.end());
  return bytes;
}

void write_replies(const std::string& folder) {
  using namespace sunder;
  LoadReport report{.format = "FBX by assimp", .space = "metres, y up", .notes = {}};
  report.notes.push_back(
      {LoadNote::Kind::repaired, "mesh 0 'Body'", "weights did not sum to one", 7});
  write(folder + "strip.reply",
        reply(import_messages::encode_head({}, report), test::skinned_strip().glb()));
  const Status failure = Status::failure(StatusCode::malformed_file, 3, "no mesh");
  write(folder + "failure.reply", reply(import_messages::encode_head(failure, {}), {}));
}

void write_snapshots(const std::string& folder) {
  using namespace sunder;
  const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  write(folder + "empty.snapshot", *fuzz::make_scene().save());
  write(folder + "torn.snapshot", *fuzz::make_torn_scene(assets).save());
  write(folder + "rich.snapshot", *fuzz::make_rich_scene(assets).save());
}

/// As operations_of_bytes.h divides its input.
class TrialBytes {
 public:
  TrialBytes(std::uint32_t bones, std::uint32_t vertices, std::uint32_t triangles) {
    add({bones - 1, vertices - 3, triangles - 1});
  }
  /// Places are in 1/16.
  void add(std::initializer_list<std::uint32_t> numbers) {
    for (const std::uint32_t number : numbers) bytes_.push_back(static_cast<std::byte>(number));
  }
  [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

/// 3 x 3 squares in the plane z = 0 with a side of 3, pulled by the middle bone.
std::vector<std::byte> torn_grid() {
  TrialBytes grid(3, 16, 18);
  for (std::uint32_t v = 0; v < 16; ++v) grid.add({v % 4 * 16, v / 4 * 16, 0, v / 4 * 33});
  for (std::uint32_t square = 0; square < 9; ++square) {
    const std::uint32_t v = square % 3 + square / 3 * 4;
    grid.add({v, v + 1, v + 5, v, v + 5, v + 4});
  }
  // A tear of two blades through a square, another through vertices, across the first, with walls;
  // a bore.
  grid.add({2, 0, 0, 0, 0, 8, 8, 8, 0, 8, 8, 248, 40, 8, 8, 0, 40, 8, 248});
  grid.add({3, 0, 26, 0, 0xC3, 16, 0, 8, 0, 16, 0, 248, 16, 48, 8, 0, 16, 48, 248, 3, 5});
  grid.add({1, 0, 0, 0, 1, 24, 24, 16, 0, 0, 0, 240, 8, 32});
  return grid.bytes();
}

/// An octahedron cut through four vertices, then next to one, and capped.
std::vector<std::byte> cut_octahedron() {
  TrialBytes body(2, 6, 8);
  for (std::uint32_t v = 0; v < 6; ++v) {
    std::array<std::uint32_t, 3> place = {0, 0, 0};
    place[v / 2] = v % 2 == 0 ? 32 : 224;
    body.add({place[0], place[1], place[2], v * 16});
  }
  for (std::uint32_t face = 0; face < 8; ++face) {
    const std::uint32_t x = face & 1, y = 2 + (face >> 1 & 1), z = 4 + (face >> 2 & 1);
    if (x + y + z == 6 || x + y + z == 8)
      body.add({x, y, z});
    else
      body.add({x, z, y});
  }
  body.add({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 16, 0});
  body.add({0, 0, 7, 0, 1, 31, 0, 0, 0x8C, 16, 0, 0, 0});
  return body.bytes();
}

void write_trials(const std::string& folder) {
  write(folder + "torn_grid.trial", torn_grid());
  write(folder + "cut_octahedron.trial", cut_octahedron());
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s <folder>\n", arguments[0]);
    return 2;
  }
  const std::string corpus = std::string(arguments[1]) + "/", folder = corpus + "glb/";
  write_replies(corpus + "import_reply/");
  write_snapshots(corpus + "snapshot/");
  write_trials(corpus + "operations/");
  write(folder + "strip.glb", sunder::test::skinned_strip().glb());
  // One of each kind of part: lines, an animation, a material with a texture, a matrix.
  for (const sunder::test::FaultyDocument& document : sunder::test::faulty_documents())
    for (const char* const name : {"lines_out_of_range", "spline_of_one_key",
                                   "broken_image_and_no_coordinates", "sheared_matrix"})
      if (document.name == name) write(folder + document.name + ".glb", document.builder.glb());
}
