// Measures how long models take to load and to describe, beside assimp and tinygltf on the same
// files in the same run.

#include <sunder/io/character_file.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"
#include "bench/harness/process_times.h"
#include "bench/io/import_helper_times.h"
#include "bench/io/import_times.h"
#include "bench/io/io_files.h"
#include "bench/io/robot_kinematics.h"
#include "support/machine/temporary_folder.h"

namespace sunder::bench {
namespace {

constexpr const char* kHelp =
    "bench_io [--summary | --load FILE | --assimp FILE]\n"
    "\n"
    "Loads GLB files by load_character(), by assimp without post-processing and by tinygltf\n"
    "without decoding accessors or images, in turns, all from the disk cache; processor time.\n"
    "Without an option it prints tables: small animated characters, one character subdivided to a\n"
    "million vertices, `sunder info` beside a process that only loads. --load loads FILE and "
    "ends, --assimp reads it by assimp.\n"
    "--summary prints one JSON object:\n"
    "  glb_vs_assimp        ours / assimp on a GLB of about 170 thousand vertices\n"
    "  small_glb_vs_assimp  the same by name of small animated characters\n"
    "  info_vs_load         `sunder info` by a process that only loads, on the large file\n"
    "  growth               time per further vertex from 100 thousand vertices to a million, by "
    "that\n"
    "                       from 10 to 100 thousand\n"
    "  fbx_vs_assimp        a process that loads an FBX, with its helper process, by one that "
    "reads it\n"
    "                       by assimp alone; wall clock, by name\n"
    "  fbx_vs_warm_assimp   the same calls in a process that has read the file before\n"
    "  child_overhead_ms    what the helper process adds to an import\n"
    "  fk_ns_per_joint      forward kinematics of a robot, warm\n";

constexpr std::size_t kSmall = 10000, kLarge = 170000, kLargest = 1000000;

void print_imports(const IoFile& file, const ImportTimes& times) {
  std::printf("| %s | %zu | %zu | %.3g | %.3g | %.3g | %.2f |\n", file.name.c_str(), file.vertices,
              file.clips, 1e3 * times.ours, 1e3 * times.assimp, 1e3 * times.tinygltf,
              times.ours / times.assimp);
}

/// `sunder info`, and a process that only loads.
struct InfoTimes {
  ProcessTimes info, load;

  [[nodiscard]] double ratio() const { return info.cpu / load.cpu; }
};

InfoTimes time_info(const IoFile& file, const std::string& program, int rounds) {
  const auto times = time_processes(
      {{SUNDER_COMMAND, "info", file.path.string()}, {program, "--load", file.path.string()}},
      rounds);
  return {times[0], times[1]};
}

void print_tables(const std::string& program) {
  const test::TemporaryFolder folder;
  const auto small = small_characters(folder.path());
  std::printf(
      "| file | vertices | clips | ours, ms | assimp | tinygltf | ours / assimp |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const IoFile& file : small) print_imports(file, time_imports(file.path, 30));

  const auto growing = growing_files(folder.path(), kLargest);
  for (const IoFile& file : growing) print_imports(file, time_imports(file.path, 10));

  std::printf(
      "\n| file | vertices | `sunder info`, wall clock, ms | load | processor time, ms | load | "
      "info / "
      "load |\n|---|---|---|---|---|---|---|\n");
  std::vector<IoFile> all = small;
  all.insert(all.end(), growing.begin(), growing.end());
  for (const IoFile& file : all) {
    const InfoTimes times = time_info(file, program, 15);
    std::printf("| %s | %zu | %.3g | %.3g | %.3g | %.3g | %.1f |\n", file.name.c_str(),
                file.vertices, 1e3 * times.info.wall, 1e3 * times.load.wall, 1e3 * times.info.cpu,
                1e3 * times.load.cpu, times.ratio());
  }
}

/// A real FBX file, and two written by assimp: a character, and the same with many vertices.
std::vector<std::filesystem::path> fbx_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files = {fbx_file()};
  for (const std::size_t vertices : {kSmall, kLarge})
    files.push_back(write_fbx(large_file(folder, vertices).path, folder));
  std::erase(files, std::filesystem::path());
  return files;
}

/// Wall clock of a process that loads the file, by one that reads it by assimp alone.
double fbx_ratio(const std::filesystem::path& file, const std::string& program) {
  const auto times =
      time_processes({{program, "--load", file.string()}, {program, "--assimp", file.string()}}, 9);
  return times[0].wall / times[1].wall;
}

void print_fbx(const std::string& program) {
  const test::TemporaryFolder folder;
  std::printf(
      "\n| FBX | corners | ours, ms | in the process | assimp | ours / assimp | whole processes |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const std::filesystem::path& file : fbx_files(folder.path())) {
    const FbxTimes times = time_fbx(file, 7);
    std::printf("| %s | %zu | %.3g | %.3g | %.3g | %.2f | %.2f |\n", times.file.c_str(),
                times.vertices, 1e3 * times.ours, 1e3 * times.in_process, 1e3 * times.assimp,
                times.ours / times.assimp, fbx_ratio(file, program));
  }
}

/// How much more a vertex costs in the larger half of the sizes than in the smaller half: what does
/// not depend on the size, such as clips, counts in neither.
double growth(const std::vector<IoFile>& files) {
  std::vector<double> seconds;
  for (const IoFile& file : files) seconds.push_back(time_imports(file.path, 9).ours);
  const auto per_vertex = [&](std::size_t from, std::size_t to) {
    return (seconds[to] - seconds[from]) /
           static_cast<double>(files[to].vertices - files[from].vertices);
  };
  const std::size_t middle = files.size() / 2, last = files.size() - 1;
  return per_vertex(middle, last) / per_vertex(0, middle);
}

void add_fbx(JsonObject& object, const std::string& program, const std::filesystem::path& folder) {
  std::vector<std::pair<std::string, double>> ratios, warm;
  double overhead = 0;
  for (const std::filesystem::path& file : fbx_files(folder)) {
    const FbxTimes times = time_fbx(file, 7);
    warm.emplace_back(file.stem().string(), times.ours / times.assimp);
    ratios.emplace_back(file.stem().string(), fbx_ratio(file, program));
    if (ratios.size() == 1) overhead = 1e3 * times.child_overhead;
  }
  object.add("fbx_vs_assimp", ratios);
  object.add("fbx_vs_warm_assimp", warm);
  object.add("child_overhead_ms", overhead);
}

/// The humanoid of the shared models, or a chain without them.
void add_kinematics(JsonObject& object) {
  const std::filesystem::path humanoid =
      std::filesystem::path(SUNDER_SHARED_MODELS) / "urdf/simple_humanoid/simple_humanoid.urdf";
  const auto time = std::filesystem::exists(humanoid) ? time_robot(humanoid) : time_chain();
  object.add("fk_ns_per_joint", time ? std::optional(time->ns_per_joint) : std::nullopt);
}

void print_summary(const std::string& program) {
  const test::TemporaryFolder folder;
  const IoFile large = large_file(folder.path(), kLarge);
  const ImportTimes times = time_imports(large.path, 15);
  std::vector<std::pair<std::string, double>> small_ratios;
  for (const IoFile& file : small_characters(folder.path())) {
    const ImportTimes of_small = time_imports(file.path, 30);
    small_ratios.emplace_back(file.name, of_small.ours / of_small.assimp);
  }
  const InfoTimes info = time_info(large, program, 15);

  JsonObject object;
  object.add("vertices", static_cast<double>(large.vertices));
  object.add("glb_ms", 1e3 * times.ours);
  object.add("glb_vs_assimp", times.ours / times.assimp);
  object.add("glb_vs_tinygltf", times.ours / times.tinygltf);
  object.add("small_glb_vs_assimp", small_ratios);
  object.add("info_vs_load", info.ratio());
  object.add("growth", growth(growing_files(folder.path(), kLargest)));
  add_fbx(object, program, folder.path());
  add_kinematics(object);
  object.end();
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  using namespace sunder::bench;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  if (argc == 3 && std::strcmp(argv[1], "--load") == 0)
    return sunder::load_character(argv[2]) ? 0 : 1;
  if (argc == 3 && std::strcmp(argv[1], "--assimp") == 0) return read_by_assimp(argv[2]) ? 0 : 1;
  if (argc == 1) {
    print_tables(program);
    print_fbx(program);
    return 0;
  }
  if (argc == 2 && std::strcmp(argv[1], "--summary") == 0) {
    print_summary(program);
    return 0;
  }
  const bool asked = argc == 2 && std::strcmp(argv[1], "--help") == 0;
  std::fputs(kHelp, asked ? stdout : stderr);
  return asked ? 0 : 2;
}
