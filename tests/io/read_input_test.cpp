// The inputs of strangers: what is opened is a regular file or, for a text, a pipe; it ends, in
// size and in time.
#include "io/internal/read_input.h"

#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>
#include <sunder/io/robot_file.h>
#include <sunder/io/trajectory_file.h>

#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/machine/watchdog.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::TemporaryFolder;
using testing::HasSubstr;

constexpr std::uint64_t kLimit = 1000000;
constexpr const char* kLog = R"({"sunder_operations": 1, "operations": [{"op": "undo"}]})";

fs::path make_pipe(const TemporaryFolder& folder, const std::string& name) {
  const fs::path pipe = folder.path() / name;
  EXPECT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  return pipe;
}

/// Opens a pipe and writes parts with breaks between them.
std::thread writer(const fs::path& pipe, std::vector<std::string> parts) {
  return std::thread([pipe, parts = std::move(parts)] {
    const int descriptor = open(pipe.c_str(), O_WRONLY);
    for (const std::string& part : parts) {
      std::this_thread::sleep_for(5ms);
      for (std::size_t done = 0; done < part.size();) {
        const ssize_t count = write(descriptor, part.data() + done, part.size() - done);
        if (count <= 0) break;
        done += static_cast<std::size_t>(count);
      }
    }
    close(descriptor);
  });
}

void expect_refused(const Status& status, StatusCode code, const char* text) {
  EXPECT_EQ(status.code(), code) << status.text();
  EXPECT_THAT(std::string(status.text()), HasSubstr(text));
}

TEST(ReadInput, reads_files_of_all_sizes) {
  const TemporaryFolder folder;
  for (const std::size_t size : {0u, 1u, 262143u, 262144u, 262145u, 999999u, 1000000u}) {
    std::string text(size, 'a');
    for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>('a' + i % 23);
    const fs::path file = folder.write("file", std::string_view(text));
    const auto read = read_input(file, kLimit);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(*read, text);
  }
  const fs::path file = folder.write("file", std::string_view(std::string(kLimit + 1, 'a')));
  expect_refused(read_input(file, kLimit).error(), StatusCode::limit_exceeded,
                 "file: 1000001 bytes; the limit is 1000000");
  EXPECT_TRUE(read_input(file, ~std::uint64_t{0}));
}

TEST(ReadInput, reads_files_that_hide_their_size) {
  const auto read = read_input("/proc/self/status", kLimit);
  ASSERT_TRUE(read);
  EXPECT_THAT(*read, HasSubstr("VmRSS"));
}

TEST(ReadInput, refuses_all_but_files_and_pipes) {
  const TemporaryFolder folder;
  fs::create_symlink("/dev/zero", folder.path() / "zero");
  expect_refused(read_input(folder.path(), kLimit).error(), StatusCode::file_unreadable,
                 "is a folder; expected a regular file or a pipe");
  for (const fs::path& device : {fs::path("/dev/zero"), folder.path() / "zero"})
    expect_refused(read_input(device, kLimit).error(), StatusCode::file_unreadable,
                   "'zero' is a device; expected a regular file or a pipe");
  expect_refused(read_input(folder.path() / "absent", kLimit).error(), StatusCode::file_not_found,
                 "no file 'absent'");
  if (geteuid() == 0) return;  // who may read all
  const fs::path file = folder.write("secret", std::string_view("1"));
  chmod(file.c_str(), 0);
  expect_refused(read_input(file, kLimit).error(), StatusCode::file_unreadable,
                 "cannot read 'secret'");
}

TEST(ReadInput, reads_a_pipe_to_its_end) {
  const TemporaryFolder folder;
  const fs::path pipe = make_pipe(folder, "pipe");
  const std::string large(300000, 'x');
  std::thread thread = writer(pipe, {"first,", large, ",last"});
  const auto read = read_input(pipe, kLimit, 20s);
  thread.join();
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(*read, "first," + large + ",last");
}

TEST(ReadInput, reads_what_a_writer_left_in_a_pipe) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  ASSERT_EQ(write(ends[1], "left", 4), 4);
  close(ends[1]);
  const auto read = read_input("/dev/fd/" + std::to_string(ends[0]), kLimit, 20s);
  close(ends[0]);
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(*read, "left");
}

TEST(ReadInput, a_pipe_without_end_is_left_in_time) {
  const TemporaryFolder folder;
  const test::Watchdog watchdog(20, "pipes");
  const fs::path pipe = make_pipe(folder, "pipe");
  expect_refused(read_input(pipe, kLimit, 30ms).error(), StatusCode::file_unreadable,
                 "pipe: no end of the pipe came in time; 0 bytes did");
  const int idle_writer = open(pipe.c_str(), O_RDWR);
  ASSERT_EQ(write(idle_writer, "four", 4), 4);
  expect_refused(read_input(pipe, kLimit, 100ms).error(), StatusCode::file_unreadable,
                 "no end of the pipe came in time; 4 bytes did");
  close(idle_writer);
}

TEST(ReadInput, a_pipe_without_limit_is_limited) {
  const TemporaryFolder folder;
  const fs::path pipe = make_pipe(folder, "pipe");
  const int keeps_it_open = open(pipe.c_str(), O_RDWR);  // the writer never fails
  std::thread thread = writer(pipe, {std::string(kLimit + 1, 'x')});
  expect_refused(read_input(pipe, kLimit, 20s).error(), StatusCode::limit_exceeded,
                 "pipe: more than 1000000 bytes, which are the limit");
  thread.join();
  close(keeps_it_open);
}

TEST(ReadInput, logs_and_trajectories_come_through_pipes) {
  const TemporaryFolder folder;
  const fs::path log = make_pipe(folder, "ops"), csv = make_pipe(folder, "motion.csv");
  std::thread of_log = writer(log, {kLog});
  const auto operations = load_operations(log);
  of_log.join();
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_EQ(operations->size(), 1u);
  std::thread of_csv = writer(csv, {"time,elbow\n", "0,1\n"});
  const auto trajectory = load_trajectory(csv);
  of_csv.join();
  ASSERT_TRUE(trajectory) << trajectory.error().text();
}

TEST(ReadInput, models_and_their_files_are_regular_files) {
  const TemporaryFolder folder;
  const test::Watchdog watchdog(20, "models");
  const auto refused = [](const Status& status, const char* text) {
    expect_refused(status, StatusCode::file_unreadable, text);
  };
  for (const char* const name : {"a.glb", "a.gltf", "a.fbx", "a.urdf"}) {
    refused(load_character(make_pipe(folder, name)).error(), "is a pipe; expected a regular file");
    fs::create_symlink("/dev/zero", folder.path() / (std::string("z") + name));
    refused(load_character(folder.path() / (std::string("z") + name)).error(), "is a device");
  }
  refused(load_robot(folder.path() / "a.urdf").error(), "is a pipe");

  make_pipe(folder, "data.bin");
  const fs::path gltf = folder.write("b.gltf", std::string_view(R"({"asset": {"version": "2.0"},
      "buffers": [{"uri": "data.bin", "byteLength": 12}], "bufferViews": [{"buffer": 0, "byteLength": 12}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 4}]}],
      "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0})"));
  refused(load_character(gltf).error(), "'data.bin' is a pipe; expected a regular file");
}

}  // namespace
}  // namespace sunder
