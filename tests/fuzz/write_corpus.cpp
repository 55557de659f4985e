// Writes the seeds of the targets `glb`, `import_reply` and `snapshot`: write_fuzz_corpus
// tests/fuzz/corpus

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
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
  const auto asset = fuzz::make_snapshot_asset();
  write(folder + "empty.snapshot", *fuzz::make_scene().save());
  write(folder + "torn.snapshot", *fuzz::make_torn_scene(asset).save());
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
  write(folder + "strip.glb", sunder::test::skinned_strip().glb());
  // One of each kind of part: lines, an animation, a material with a texture, a matrix.
  for (const sunder::test::FaultyDocument& document : sunder::test::faulty_documents())
    for (const char* const name : {"lines_out_of_range", "spline_of_one_key",
                                   "broken_image_and_no_coordinates", "sheared_matrix"})
      if (document.name == name) write(folder + document.name + ".glb", document.builder.glb());
}
