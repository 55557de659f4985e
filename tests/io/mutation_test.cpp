// Damaged files: every sample model, truncated and with flipped bits. Whatever the damage, reading
// ends soon, within a bound on memory, with a cause or with a valid character; and what is written
// of an accepted one is a file without faults. SUNDER_STRESS=1 tries far more.

#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "io/assimp_text_models.h"
#include "support/machine/gltf_validator.h"
#include "support/machine/peak_memory.h"
#include "support/machine/stress.h"
#include "support/machine/temporary_folder.h"
#include "support/machine/watchdog.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

#if defined(__SANITIZE_ADDRESS__)
constexpr double kLongest = 50.0;
#else
constexpr double kLongest = 5.0;
#endif
constexpr std::uint64_t kLeastMemory = std::uint64_t{64} << 20, kTimesFile = 20;

bool is_stress() { return std::getenv("SUNDER_STRESS") != nullptr; }

/// Files that this process and its sanitizer can read many times in a minute.
std::vector<fs::path> gltf_samples() {
  std::vector<fs::path> files = rigged_gltf_models();
  const auto append = [&](const fs::path& folder) {
    if (folder.empty() || !fs::exists(folder)) return;
    const auto found = files_below(folder, {".glb", ".gltf"});
    files.insert(files.end(), found.begin(), found.end());
  };
  if (!shared_models().empty()) append(shared_models() / "bad");
  append(assimp_models());
  if (!is_stress())
    std::erase_if(files, [](const fs::path& file) { return fs::file_size(file) > 400'000; });
  return files;
}

Bytes truncated(const Bytes& bytes, std::size_t size) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)};
}

/// One to four bits flipped; every second time in the first kilobytes, where the structure is.
Bytes flipped(Bytes bytes, std::mt19937& random) {
  const std::size_t end =
      random() % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 4096);
  for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
    bytes[random() % end] ^= static_cast<std::byte>(1u << random() % 8);
  return bytes;
}

class Damage {
 public:
  explicit Damage(const fs::path& source)
      : name_("damaged" + source.extension().string()), folder_of_source_(source.parent_path()) {}

  /// Reads such a file and checks what must hold. @return the character, if it was accepted.
  std::optional<LoadedCharacter> read(const Bytes& bytes) {
    const fs::path file = folder_.write(name_, bytes);
    const Watchdog watchdog(kLongest, name_);
    LoadOptions options;
    options.import_seconds = 5.0;
    const PeakMemory memory;
    auto loaded = load_character(file, options);
    if (PeakMemory::is_measured()) {
      EXPECT_LE(memory.bytes(), std::max<std::uint64_t>(kLeastMemory, kTimesFile * bytes.size()));
    }
    EXPECT_EQ(read_bytes(file), bytes) << "reading changed the file";
    if (!loaded) {
      EXPECT_FALSE(loaded.error().text().empty());
      EXPECT_NE(loaded.error().code(), StatusCode::internal_error) << loaded.error().text();
      return {};
    }
    const Status status = validate_character(*loaded->character);
    EXPECT_TRUE(status) << status.text();
    return std::move(*loaded);
  }

  /// The written file has no fault that reading would report.
  void write(const LoadedCharacter& loaded, const fs::path& file) {
    const Status status = save_glb(file, *loaded.character, loaded);
    ASSERT_TRUE(status) << status.text();
    LoadOptions strict;
    strict.strict = true;
    const auto again = load_character(file, strict);
    // References to images outside the folder stay, and so do points and lines.
    const bool is_other_part = again.error().code() == StatusCode::path_not_allowed ||
                               again.error().code() == StatusCode::unsupported_feature;
    ASSERT_TRUE(again || is_other_part) << again.error().text();
  }

 private:
  std::string name_;
  fs::path folder_of_source_;
  TemporaryFolder folder_;
};

std::vector<std::string> files_with_errors(const fs::path& folder) {
  std::vector<std::string> faulty;
  const auto files = files_below(folder, {".glb"});
  const auto reports = validate_glbs_of(folder);
  EXPECT_EQ(files.size(), reports.size());
  for (std::size_t i = 0; i < std::min(files.size(), reports.size()); ++i)
    if (reports[i].errors != 0 && reports[i].output.find("IO_ERROR") == std::string::npos)
      faulty.push_back(files[i].filename().string() + ": " + reports[i].output);
  return faulty;
}

TEST(Mutations, truncated_gltf_files_end_with_a_cause_or_a_character) {
  for (const fs::path& source : gltf_samples()) {
    SCOPED_TRACE(source);
    const Bytes bytes = read_bytes(source);
    Damage damage(source);
    const std::size_t cuts = bytes.size() / 64;
    const std::size_t stride = is_stress() ? 1 : std::max<std::size_t>(1, cuts / 24);
    for (std::size_t cut = 0; cut <= cuts; cut += stride)
      static_cast<void>(damage.read(truncated(bytes, cut * 64)));
  }
}

TEST(Mutations, gltf_files_with_flipped_bits_end_with_a_cause_or_a_character) {
  const TemporaryFolder written;
  std::mt19937 random(20'261'122);
  std::size_t accepted = 0, number = 0;
  for (const fs::path& source : gltf_samples()) {
    SCOPED_TRACE(source);
    const Bytes bytes = read_bytes(source);
    if (bytes.empty()) continue;
    Damage damage(source);
    const int rounds = stressed(fs::file_size(source) > 100'000 ? 12 : 30, 40);
    for (int round = 0; round < rounds; ++round) {
      const Bytes mutant = flipped(bytes, random);
      const auto loaded = damage.read(mutant);
      if (!loaded || accepted++ % (is_stress() ? 1 : 4) != 0) continue;
      SCOPED_TRACE(round);
      const fs::path file = written.path() / (std::to_string(100'000 + number++) + ".glb");
      damage.write(*loaded, file);
    }
  }
  EXPECT_GT(accepted, 20u);
  if (has_gltf_validator()) {
    EXPECT_EQ(files_with_errors(written.path()), std::vector<std::string>());
  }
}

struct TextSample {
  const char* name;
  std::string content;
};

std::vector<TextSample> text_samples() {
  return {{"square.obj", kSquareObj},
          {"square.off", kSquareOff},
          {"torn.ply", kTornPly},
          {"skinned.x", kSkinnedX},
          {"bones.dae", kSixBoneCollada}};
}

Bytes bytes_of(const std::string& text) {
  const auto* const first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

TEST(Mutations, other_formats_end_with_a_cause_or_a_character) {
  std::mt19937 random(7);
  std::vector<std::pair<fs::path, Bytes>> samples;
  for (const TextSample& sample : text_samples())
    samples.emplace_back(sample.name, bytes_of(sample.content));
  for (const fs::path& file : rigged_models({".fbx", ".dae", ".x", ".b3d"}))
    samples.emplace_back(file, read_bytes(file));
  for (const auto& [source, bytes] : samples) {
    SCOPED_TRACE(source);
    Damage damage(source);
    const int rounds = stressed(bytes.size() > 10'000 ? 3 : 8, 30);
    for (int round = 0; round < rounds; ++round) {
      static_cast<void>(damage.read(flipped(bytes, random)));
      const std::size_t cut = random() % (bytes.size() / 64 + 1) * 64;
      static_cast<void>(damage.read(truncated(bytes, cut)));
    }
  }
}

constexpr const char* kLog = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "width": 0.01, "stroke": [{"base": [0, 1, 2], "tip": [0, 1, 0]}, {"base": [0.1, 1.2, 2], "tip": [0.1, 1.2, 0]}]},
  {"op": "cut", "plane": {"point": [0, 0.5, 0], "normal": [0, 1, 0.1]}, "pose": {"clip": 0, "time": 0.3}},
  {"op": "undo"}, {"op": "redo"},
  {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.03, "depth": 4}]})";

TEST(Mutations, operation_logs_end_with_a_cause_or_operations) {
  const Bytes bytes = bytes_of(kLog);
  std::mt19937 random(3);
  const auto check = [](const Bytes& mutant) {
    const Watchdog watchdog(kLongest, "operation log");
    const PeakMemory memory;
    const auto operations =
        parse_operations({reinterpret_cast<const char*>(mutant.data()), mutant.size()});
    if (PeakMemory::is_measured()) {
      EXPECT_LE(memory.bytes(), kLeastMemory);
    }
    if (!operations) {
      EXPECT_FALSE(operations.error().text().empty());
      EXPECT_NE(operations.error().code(), StatusCode::internal_error);
      return;
    }
    const auto text = format_operations(*operations);
    ASSERT_TRUE(text);
    const auto again = parse_operations(*text);
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(*format_operations(*again), *text);
  };
  for (std::size_t size = 0; size <= bytes.size(); size += is_stress() ? 1 : 16)
    check(truncated(bytes, size));
  for (int round = 0; round < stressed(2'000, 50); ++round) check(flipped(bytes, random));
}

}  // namespace
}  // namespace sunder::test
