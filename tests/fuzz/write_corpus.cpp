// Writes the seeds of tests/fuzz/corpus/glb: write_fuzz_corpus <folder>

#include <cstdio>
#include <fstream>
#include <string>

#include "io/faulty_documents.h"
#include "support/gltf_builder.h"

namespace {

void write(const std::string& file, const std::vector<std::byte>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s <folder>\n", arguments[0]);
    return 2;
  }
  const std::string folder = std::string(arguments[1]) + "/";
  write(folder + "strip.glb", sunder::test::skinned_strip().glb());
  // One of each kind of part: lines, an animation, a material with a texture, a matrix.
  for (const sunder::test::FaultyDocument& document : sunder::test::faulty_documents())
    for (const char* const name : {"lines_out_of_range", "spline_of_one_key",
                                   "broken_image_and_no_coordinates", "sheared_matrix"})
      if (document.name == name) write(folder + document.name + ".glb", document.builder.glb());
}
