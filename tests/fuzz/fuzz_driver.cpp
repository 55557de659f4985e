// Runs a fuzz target without libFuzzer: over the files of its corpus, and over seeded mutations of
// them. Usage: <program> <folder of the corpus> [mutations per file]
// An input that makes the target abort is kept in the file failing_input.

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Input = std::vector<std::uint8_t>;

std::vector<Input> read_corpus(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Input> inputs;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return inputs;
}

/// Flips, overwrites, inserts, removes or copies some bytes, as fuzzers do.
void mutate(Input& input, const Input& other, std::mt19937& random) {
  constexpr std::uint8_t kInteresting[] = {0,   1,   0x7F, 0x80, 0xFF, '0', '1', '9',
                                           '-', '.', 'e',  '"',  '{',  '}', '[', ']'};
  for (unsigned edits = 1 + random() % 4; edits > 0 && !input.empty(); --edits) {
    const std::size_t at = random() % input.size();
    const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t length = std::min<std::size_t>(1 + random() % 16, input.size() - at);
    switch (random() % 6) {
      case 0: input[at] ^= static_cast<std::uint8_t>(1u << random() % 8); break;
      case 1: input[at] = static_cast<std::uint8_t>(random()); break;
      case 2: input[at] = kInteresting[random() % std::size(kInteresting)]; break;
      case 3: input.erase(place, place + static_cast<std::ptrdiff_t>(length)); break;
      case 4: input.insert(place, kInteresting[random() % std::size(kInteresting)]); break;
      default:
        if (!other.empty())
          for (std::size_t i = 0; i < length; ++i) input[at + i] = other[(at + i) % other.size()];
    }
  }
}

Input current_input;

void try_input(Input input) {
  current_input = std::move(input);
  LLVMFuzzerTestOneInput(current_input.data(), current_input.size());
}

void keep_current_input(int) {
  constexpr char kFile[] = "failing_input";
  std::ofstream(kFile, std::ios::binary)
      .write(reinterpret_cast<const char*>(current_input.data()),
             static_cast<std::streamsize>(current_input.size()));
  std::fprintf(stderr, "the input is in %s\n", kFile);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: %s <folder> [mutations per file]\n", arguments[0]);
    return 2;
  }
  const std::vector<Input> corpus = read_corpus(arguments[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: no files\n", arguments[1]);
    return 1;
  }
  const bool is_stress = std::getenv("SUNDER_STRESS") != nullptr;
  const long mutations = (count > 2 ? std::atol(arguments[2]) : 500) * (is_stress ? 100 : 1);
  std::mt19937 random(1);
  std::signal(SIGABRT, keep_current_input);
  try_input({});
  for (const Input& seed : corpus) {
    try_input(seed);
    for (long i = 0; i < mutations; ++i) {
      Input mutant = seed;
      mutate(mutant, corpus[random() % corpus.size()], random);
      try_input(std::move(mutant));
    }
  }
  std::printf("%zu files, %ld mutations of each\n", corpus.size(), mutations);
  return 0;
}
