// Imports in the helper process: that it is found, what it may read, and that nothing it does
// harms the caller.

#include <sunder/io/character_file.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <dirent.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "io/assimp_text_models.h"
#include "io/contained_import/import_as_glb.h"
#include "io/contained_import/memory_limit.h"
#include "io/import_helper/sandbox.h"
#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;
using contained_import::import_as_glb;

int open_descriptors() {
  int count = 0;
  DIR* const folder = opendir("/proc/self/fd");
  while (folder != nullptr && readdir(folder) != nullptr) ++count;
  if (folder != nullptr) closedir(folder);
  return count;
}

/// Child processes and descriptors that a call left open.
class LeavesNothingBehind {
 public:
  LeavesNothingBehind() : descriptors_(open_descriptors()) {}
  ~LeavesNothingBehind() {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child was not reaped";
    EXPECT_EQ(open_descriptors(), descriptors_);
  }

 private:
  int descriptors_;
};

/// Runs `work` in a fork of this process, which it may change. @return its exit code.
int exit_code_in_fork(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// An OBJ file with one polygon of that many corners.
std::string polygon(int corners) {
  std::string text, face = "f";
  for (int i = 0; i < corners; ++i) {
    const double angle = 6.283185307179586 * i / corners;
    text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  return text + face + "\n";
}

class ContainedImport : public testing::Test {
 protected:
  fs::path model() { return folder_.write("square.off", std::string_view(test::kSquareOff)); }

  /// A helper that misbehaves in this way.
  Status import_by(const std::string& how, double seconds = 100.0) {
    const fs::path helper = folder_.path() / how;
    if (!fs::exists(helper)) fs::create_symlink(SUNDER_ODD_IMPORT_HELPER, helper);
    LoadOptions options;
    options.import_helper = helper;
    options.import_seconds = seconds;
    const auto loaded = load_character(model(), options);
    EXPECT_FALSE(loaded) << how;
    return loaded.error();
  }

  test::TemporaryFolder folder_;
};

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

TEST_F(ContainedImport, BothPlacesGiveTheSameBytes) {
  std::vector<fs::path> files = {model(),
                                 folder_.write("sail.dae", std::string_view(test::kSixBoneCollada)),
                                 folder_.write("strip.x", std::string_view(test::kSkinnedX)),
                                 folder_.write("torn.ply", std::string_view(test::kTornPly))};
  for (const fs::path& file : test::rigged_models({".fbx", ".dae", ".x", ".b3d"}))
    files.push_back(file);
  for (const fs::path& file :
       test::files_below(test::assimp_models(), {".fbx", ".md5mesh", ".ms3d", ".smd", ".3ds"}))
    files.push_back(file);
  LoadOptions here;
  here.import_place = ImportPlace::in_process;
  for (const fs::path& file : files) {
    const auto contained = import_as_glb(file, {});
    if (contained.error().text().find("crashed") != std::string_view::npos) continue;
    const auto in_process = import_as_glb(file, here);
    ASSERT_EQ(contained.has_value(), in_process.has_value()) << file;
    EXPECT_EQ(contained.error().text(), in_process.error().text()) << file;
    if (!contained) continue;
    EXPECT_EQ(contained->glb, in_process->glb) << file;
    EXPECT_EQ(contained->report.format, in_process->report.format);
    EXPECT_EQ(contained->report.space, in_process->report.space);
  }
}

TEST_F(ContainedImport, MisbehaviourIsAnErrorWithACause) {
  const LeavesNothingBehind check;
  struct Case {
    const char* how;
    StatusCode code;
    const char* text;
  };
  for (const Case& one :
       {Case{"exit", StatusCode::malformed_file, "ended without a result"},
        Case{"segv", StatusCode::malformed_file, "SIGSEGV"},
        Case{"abort", StatusCode::malformed_file, "SIGABRT"},
        Case{"kill", StatusCode::limit_exceeded, "short of memory"},
        Case{"close_and_hang", StatusCode::limit_exceeded, "killed"},
        Case{"tell_segv", StatusCode::malformed_file, "SIGSEGV"},
        Case{"tell_memory", StatusCode::limit_exceeded, "256 MiB of memory"},
        Case{"tell_nonsense", StatusCode::malformed_file, "ended without a result"},
        Case{"garbage", StatusCode::malformed_file, "ended without a result"},
        Case{"short", StatusCode::malformed_file, "ended without a result"},
        Case{"oversized", StatusCode::limit_exceeded, "LoadOptions::import_memory"},
        Case{"oversized_head", StatusCode::limit_exceeded, "LoadOptions::import_memory"},
        Case{"no_json", StatusCode::malformed_file, "reply is not valid"},
        Case{"no_glb", StatusCode::malformed_file, ""},
        Case{"empty_glb", StatusCode::malformed_file, ""},
        Case{"unknown_request", StatusCode::malformed_file, "ended without a result"},
        Case{"long_reference", StatusCode::malformed_file, "ended without a result"},
        Case{"requests_without_end", StatusCode::limit_exceeded, "4096 times"},
        Case{"not_ready", StatusCode::file_unreadable, "not a sunder-import"}}) {
    const Status status = import_by(one.how);
    EXPECT_EQ(status.code(), one.code) << one.how << ": " << status.text();
    EXPECT_TRUE(contains(status.text(), one.text)) << one.how << ": " << status.text();
  }
}

// A file of 5 MiB raises the memory of an import from 256 to 320 MiB, and that of its reply to the
// half. If it counted again with each of a hundred requests, both would grow to 4 GiB.
TEST_F(ContainedImport, AFileThatIsOpenedAgainRaisesNoLimit) {
  const LeavesNothingBehind check;
  folder_.write("side.bin", std::string(5u << 20, 'x'));
  const Status of_memory = import_by("opens_again_for_memory");
  const long limit = std::strtol(of_memory.text().data(), nullptr, 10);
  EXPECT_GE(limit, 1024) << of_memory.text();
  EXPECT_LE(limit, 1024 + 65) << of_memory.text();
  const Status of_reply = import_by("opens_again_for_reply");
  EXPECT_EQ(of_reply.code(), StatusCode::limit_exceeded) << of_reply.text();
  EXPECT_TRUE(contains(of_reply.text(), "more than 1677")) << of_reply.text();
}

TEST_F(ContainedImport, AHangEndsAtTheTimeLimit) {
  const LeavesNothingBehind check;
  for (const char* const how : {"hang", "never_ready", "unread_answers"}) {
    const auto begin = std::chrono::steady_clock::now();
    const Status status = import_by(how, 0.5);
    EXPECT_EQ(status.code(), StatusCode::limit_exceeded) << how << status.text();
    EXPECT_TRUE(contains(status.text(), "within 0.5 seconds")) << status.text();
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(60));
  }
}

TEST_F(ContainedImport, TheHelperMustBeThere) {
  const LeavesNothingBehind check;
  LoadOptions options;
  options.import_helper = folder_.path() / "absent";
  EXPECT_EQ(load_character(model(), options).error().code(), StatusCode::file_not_found);
  EXPECT_TRUE(contains(load_character(model(), options).error().text(), "import_helper"));
  options.import_helper = folder_.write("text", std::string_view("no program"));
  EXPECT_EQ(load_character(model(), options).error().code(), StatusCode::file_unreadable);
  fs::permissions(options.import_helper, fs::perms::owner_all);
  EXPECT_EQ(load_character(model(), options).error().code(), StatusCode::file_unreadable);
  options.import_helper = "/bin/true";
  const auto by_another_program = load_character(model(), options);
  EXPECT_EQ(by_another_program.error().code(), StatusCode::file_unreadable);
  EXPECT_TRUE(contains(by_another_program.error().text(), "/bin/true"));
  options.import_helper = SUNDER_IMPORT_HELPER;
  EXPECT_TRUE(load_character(model(), options));
}

TEST_F(ContainedImport, TheHelperIsFoundInTheBuildTree) { EXPECT_TRUE(load_character(model())); }

/// The warning of a helper that runs without a filter of system calls.
bool warns_of_filter(const LoadReport& report) {
  for (const LoadNote& note : report.notes)
    if (note.kind == LoadNote::Kind::warning && contains(note.text, "without a filter"))
      return true;
  return false;
}

bool can_filter() {
  return exit_code_in_fork(
             [] { return import_helper::filter_system_calls()[0] == '\0' ? 0 : 1; }) == 0;
}

TEST_F(ContainedImport, AMissingFilterIsAWarning) {
  const fs::path helper = folder_.path() / "good_without_filter";
  fs::create_symlink(SUNDER_ODD_IMPORT_HELPER, helper);
  LoadOptions options;
  options.import_helper = helper;
  const auto odd = import_as_glb(model(), options);
  ASSERT_TRUE(odd) << odd.error().text();
  EXPECT_TRUE(warns_of_filter(odd->report));
  const auto own = import_as_glb(model(), {});
  ASSERT_TRUE(own) << own.error().text();
  EXPECT_EQ(warns_of_filter(own->report), !can_filter());
}

TEST_F(ContainedImport, AMissingFilterIsRefusedOnRequest) {
  const LeavesNothingBehind check;
  const fs::path helper = folder_.path() / "good_without_filter";
  fs::create_symlink(SUNDER_ODD_IMPORT_HELPER, helper);
  for (const bool is_strict : {false, true}) {
    LoadOptions options;
    (is_strict ? options.strict : options.requires_filter) = true;
    const auto own = import_as_glb(model(), options);
    EXPECT_EQ(own.has_value(), can_filter()) << own.error().text();
    options.import_helper = helper;
    const auto odd = import_as_glb(model(), options);
    EXPECT_EQ(odd.error().code(), StatusCode::unsupported_feature) << odd.error().text();
    EXPECT_TRUE(contains(odd.error().text(), "filter")) << odd.error().text();
    EXPECT_TRUE(contains(odd.error().text(), is_strict ? "strict" : "requires_filter"));
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/// The most memory, in MiB, that a program had which imports by this helper.
long peak_mebibytes(const std::function<void()>& import) {
  int results[2];
  if (pipe(results) != 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    import();
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const long mebibytes = usage.ru_maxrss >> 10;
    _exit(write(results[1], &mebibytes, sizeof mebibytes) == sizeof mebibytes ? 0 : 1);
  }
  close(results[1]);
  long mebibytes = -1;
  if (read(results[0], &mebibytes, sizeof mebibytes) != sizeof mebibytes) mebibytes = -1;
  close(results[0]);
  waitpid(child, nullptr, 0);
  return mebibytes;
}

TEST_F(ContainedImport, AReplyTakesNoMoreMemoryThanTheImportMay) {
  const long before = peak_mebibytes([] {});
  ASSERT_GT(before, 0);
  // For a small model the limit is 256 MiB, and half of it for the reply.
  EXPECT_LT(peak_mebibytes([&] { (void)import_by("declared_1_gib"); }), before + 20);
  const long of_large = peak_mebibytes([&] { (void)import_by("large"); });
  EXPECT_LT(of_large, before + 130);
  EXPECT_GT(of_large, before + 90) << "the reply was not read";
  EXPECT_LT(peak_mebibytes([&] { (void)import_by("bomb"); }), before + 400);
  EXPECT_EQ(import_by("declared_1_gib").code(), StatusCode::limit_exceeded);
  EXPECT_EQ(import_by("bomb").code(), StatusCode::limit_exceeded);
}
#endif

TEST_F(ContainedImport, WorksWhenChildrenAreIgnored) {
  const fs::path file = model();
  EXPECT_EQ(exit_code_in_fork([&] {
              std::signal(SIGCHLD, SIG_IGN);
              return load_character(file) ? 0 : 1;
            }),
            0);
  // The cause of a crash arrives although the wait status is lost.
  const fs::path helper = folder_.path() / "tell_segv";
  fs::create_symlink(SUNDER_ODD_IMPORT_HELPER, helper);
  EXPECT_EQ(exit_code_in_fork([&] {
              std::signal(SIGCHLD, SIG_IGN);
              LoadOptions options;
              options.import_helper = helper;
              const auto loaded = load_character(file, options);
              return !loaded && contains(loaded.error().text(), "SIGSEGV") ? 0 : 1;
            }),
            0);
}

TEST_F(ContainedImport, WorksWhenTheProgramReapsAllChildren) {
  const fs::path file = model();
  EXPECT_EQ(exit_code_in_fork([&] {
              std::signal(SIGCHLD, [](int) {
                while (waitpid(-1, nullptr, WNOHANG) > 0) continue;
              });
              return load_character(file) ? 0 : 1;
            }),
            0);
}

TEST_F(ContainedImport, WorksWithoutStandardStreams) {
  const fs::path file = model();
  EXPECT_EQ(exit_code_in_fork([&] {
              for (int standard = 0; standard < 3; ++standard) close(standard);
              const auto loaded = load_character(file);
              // None of them was left open in their place.
              for (int standard = 0; standard < 3; ++standard)
                if (close(standard) == 0) return 2;
              return loaded ? 0 : 1;
            }),
            0);
}

TEST_F(ContainedImport, WorksWithAlmostNoDescriptorsOrFails) {
  const fs::path file = model();
  for (rlim_t most = 4; most < 16; ++most)
    EXPECT_EQ(exit_code_in_fork([&] {
                const rlimit limit{most, most};
                setrlimit(RLIMIT_NOFILE, &limit);
                const auto loaded = load_character(file);
                return loaded || loaded.error().code() != StatusCode::internal_error ? 0 : 1;
              }),
              0);
}

TEST_F(ContainedImport, WorksInManyThreads) {
  const LeavesNothingBehind check;
  const fs::path file = folder_.write("sail.dae", std::string_view(test::kSixBoneCollada));
  const auto expected = import_as_glb(file, {});
  ASSERT_TRUE(expected) << expected.error().text();
  LoadOptions here;
  here.import_place = ImportPlace::in_process;
  std::vector<std::thread> threads;
  std::vector<char> same(6, 0);
  for (std::size_t t = 0; t < same.size(); ++t)
    threads.emplace_back([&, t] {
      bool all = true;
      for (int i = 0; i < 8; ++i) {
        const auto imported = import_as_glb(file, t % 3 == 0 ? here : LoadOptions{});
        all = all && imported && imported->glb == expected->glb;
      }
      same[t] = all;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(same, std::vector<char>(same.size(), 1));
}

/// The children of a process; empty if the system does not list them.
std::string children_of(pid_t process) {
  const std::string id = std::to_string(process);
  std::ifstream list("/proc/" + id + "/task/" + id + "/children");
  std::string first;
  list >> first;
  return first;
}

bool runs(const std::string& process) {
  std::ifstream about("/proc/" + process + "/stat");
  std::string number, name, state;
  about >> number >> name >> state;
  return !state.empty() && state != "Z" && state != "X";
}

TEST_F(ContainedImport, LeavesNoHelperWhenTheProgramDies) {
  const fs::path file = folder_.write("large.obj", polygon(16'000));
  const pid_t program = fork();
  if (program == 0) _exit(load_character(file) ? 0 : 1);
  std::string helper;
  for (int i = 0; i < 2000 && helper.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    helper = children_of(program);
  }
  kill(program, SIGKILL);
  waitpid(program, nullptr, 0);
  if (helper.empty()) GTEST_SKIP() << "the system does not list the children of a process";
  for (int i = 0; i < 10'000 && runs(helper); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_FALSE(runs(helper));
}

TEST_F(ContainedImport, ReadsFromFurtherRoots) {
  const LeavesNothingBehind check;
  fs::create_directory(folder_.path() / "models");
  fs::create_directory(folder_.path() / "materials");
  folder_.write("materials/square.mtl", std::string_view(test::kSquareMtl));
  const fs::path file = folder_.write("models/square.obj", std::string_view(test::kSquareObj));
  std::string text = test::kSquareObj;
  text.replace(text.find("square.mtl"), 10, "../materials/square.mtl");
  const fs::path above = folder_.write("models/above.obj", std::string_view(text));

  const auto color_of = [&](const fs::path& model, const LoadOptions& options) {
    const auto imported = import_as_glb(model, options);
    if (!imported) return std::string(status_name(imported.error().code()));
    const std::string_view glb(reinterpret_cast<const char*>(imported->glb.data()),
                               imported->glb.size());
    return std::string(contains(glb, "[0.5,0.25,0.125,1.0]") ? "red" : "plain");
  };
  for (const ImportPlace place : {ImportPlace::helper_process, ImportPlace::in_process}) {
    LoadOptions options;
    options.import_place = place;
    EXPECT_EQ(color_of(file, options), "plain");
    EXPECT_EQ(color_of(above, options), "path_not_allowed");
    options.roots = {folder_.path() / "absent", folder_.path() / "materials"};
    EXPECT_EQ(color_of(file, options), "red");
    EXPECT_EQ(color_of(above, options), "red");
    options.maximum_bytes = fs::file_size(file) + 10;
    EXPECT_EQ(color_of(file, options), "limit_exceeded");
  }
  fs::remove(folder_.path() / "materials/square.mtl");
  fs::create_symlink("/etc/passwd", folder_.path() / "materials/square.mtl");
  LoadOptions options;
  options.roots = {folder_.path() / "materials"};
  EXPECT_EQ(color_of(file, options), "path_not_allowed");
  fs::remove(folder_.path() / "materials/square.mtl");
  fs::create_directory(folder_.path() / "materials/square.mtl");
  EXPECT_EQ(color_of(file, options), "plain");  // no regular file
}

TEST_F(ContainedImport, MemoryIsLimitedByTheSizeOfTheFiles) {
  using contained_import::import_memory_of;
  const std::uint64_t mebibyte = 1u << 20;
  LoadOptions options;
  EXPECT_EQ(import_memory_of(1, options), 256 * mebibyte);
  EXPECT_EQ(import_memory_of(10 * mebibyte, options), 640 * mebibyte);
  EXPECT_EQ(import_memory_of(1000 * mebibyte, options), options.import_memory);
  EXPECT_EQ(import_memory_of(~std::uint64_t{0}, options), options.import_memory);
  options.import_memory = mebibyte;
  EXPECT_EQ(import_memory_of(10 * mebibyte, options), mebibyte);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(ContainedImport, TooMuchMemoryIsAnError) {
  const LeavesNothingBehind check;
  LoadOptions options;
  options.import_memory = 1u << 20;
  std::string points;
  for (int i = 0; i < 500'000; ++i) points += "v 1 2 3\n";
  const auto little = load_character(folder_.write("large.obj", points + "f 1 2 3\n"), options);
  EXPECT_EQ(little.error().code(), StatusCode::limit_exceeded) << little.error().text();
  EXPECT_TRUE(contains(little.error().text(), "1 MiB of memory")) << little.error().text();

  // Ten instances of a node with ten instances of a node …
  std::string bomb = R"(<?xml version="1.0"?><COLLADA version="1.4.1"><library_nodes>)";
  for (int i = 0; i < 9; ++i) {
    bomb += "<node id=\"a" + std::to_string(i) + "\">";
    for (int k = 0; k < 10 && i < 8; ++k)
      bomb += "<instance_node url=\"#a" + std::to_string(i + 1) + "\"/>";
    bomb += "</node>";
  }
  bomb += R"(</library_nodes><library_visual_scenes><visual_scene id="s"><node id="b">)"
          R"(<instance_node url="#a0"/></node></visual_scene></library_visual_scenes>)"
          R"(<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  LoadOptions patient;  // On a busy machine, memory takes its time to fill.
  patient.import_seconds = 120;
  const auto exploded = load_character(folder_.write("bomb.dae", std::string_view(bomb)), patient);
  EXPECT_EQ(exploded.error().code(), StatusCode::limit_exceeded) << exploded.error().text();
  EXPECT_TRUE(contains(exploded.error().text(), "memory")) << exploded.error().text();
}
#endif

}  // namespace
}  // namespace sunder
