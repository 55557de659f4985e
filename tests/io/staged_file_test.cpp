// What an output does with what stands under its name: files, links, devices, FIFOs.

#include "io/internal/staged_file.h"

#include <csignal>
#include <cstddef>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "io/files/stream_output.h"
#include "support/machine/temporary_folder.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

std::string text_of(const fs::path& file) {
  const std::vector<std::byte> bytes = test::read_bytes(file);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

mode_t mode_of(const fs::path& file) {
  struct stat about = {};
  EXPECT_EQ(lstat(file.c_str(), &about), 0);
  return about.st_mode;
}

class StagedFiles : public testing::Test {
 protected:
  [[nodiscard]] fs::path path(const char* name) const { return folder_.path() / name; }
  [[nodiscard]] std::size_t file_count() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_.path())) ++count;
    return count;
  }

  test::TemporaryFolder folder_;
};

TEST_F(StagedFiles, an_earlier_file_stays_until_the_commit) {
  folder_.write("a", "earlier");
  {
    StagedFile dropped(path("a"), bytes_of("dropped"));
    ASSERT_TRUE(dropped.status());
    EXPECT_EQ(file_count(), 2u);
    EXPECT_EQ(text_of(path("a")), "earlier");
  }
  EXPECT_EQ(file_count(), 1u);
  EXPECT_EQ(text_of(path("a")), "earlier");
  ASSERT_TRUE(write_file(path("a"), bytes_of("later")));
  EXPECT_EQ(text_of(path("a")), "later");
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(StagedFiles, mode_and_owner_are_kept) {
  for (const mode_t mode : {0600, 0640, 0644, 0755, 0444}) {
    folder_.write("a", "earlier");
    ASSERT_EQ(chmod(path("a").c_str(), mode), 0);
    ASSERT_TRUE(write_file(path("a"), bytes_of("later")));
    EXPECT_EQ(mode_of(path("a")) & 07777, mode);
    fs::remove(path("a"));
  }
  // A new file has the mode that the user's mask allows.
  const mode_t mask = umask(027);
  ASSERT_TRUE(write_file(path("new"), bytes_of("new")));
  umask(mask);
  EXPECT_EQ(mode_of(path("new")) & 07777, mode_t{0640});
  if (geteuid() != 0) return;
  ASSERT_EQ(chown(path("new").c_str(), 12345, 23456), 0);
  ASSERT_TRUE(write_file(path("new"), bytes_of("newer")));
  struct stat about = {};
  ASSERT_EQ(stat(path("new").c_str(), &about), 0);
  EXPECT_EQ(about.st_uid, 12345u);
  EXPECT_EQ(about.st_gid, 23456u);
  EXPECT_EQ(about.st_mode & 07777, mode_t{0640});
}

TEST_F(StagedFiles, a_link_is_replaced_and_never_followed) {
  folder_.write("precious", "precious");
  fs::create_symlink(path("precious"), path("out"));
  ASSERT_TRUE(write_file(path("out"), bytes_of("output")));
  EXPECT_EQ(text_of(path("precious")), "precious");
  EXPECT_TRUE(S_ISREG(mode_of(path("out"))));
  EXPECT_EQ(text_of(path("out")), "output");
  // A dangling one too: nothing appears where it leads.
  fs::create_symlink(path("absent"), path("dangling"));
  ASSERT_TRUE(write_file(path("dangling"), bytes_of("output")));
  EXPECT_FALSE(fs::exists(path("absent")));
  // And one to a device.
  fs::create_symlink("/dev/null", path("null"));
  ASSERT_TRUE(write_file(path("null"), bytes_of("output")));
  EXPECT_EQ(text_of(path("null")), "output");
  EXPECT_TRUE(S_ISCHR(mode_of("/dev/null")));
}

/// Names under which earlier versions wrote first.
TEST_F(StagedFiles, links_under_guessed_names_are_not_followed) {
  folder_.write("precious", "precious");
  fs::create_symlink(path("precious"), path("out.partial"));
  for (int i = 0; i < 200; ++i)
    fs::create_symlink(path("precious"), path(("out.part" + std::to_string(i)).c_str()));
  ASSERT_TRUE(write_file(path("out"), bytes_of("output")));
  EXPECT_EQ(text_of(path("out")), "output");
  EXPECT_EQ(text_of(path("precious")), "precious");
  EXPECT_TRUE(fs::is_symlink(path("out.partial")));
}

TEST_F(StagedFiles, devices_are_written_to_and_stay) {
  // Devices of our own: a fault must not take those of the machine.
  if (mknod(path("null").c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0 ||
      mknod(path("full").c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0)
    GTEST_SKIP() << "only root can make devices";
  ASSERT_TRUE(write_file(path("null"), bytes_of("output")));
  EXPECT_TRUE(S_ISCHR(mode_of(path("null"))));
  EXPECT_EQ(write_file(path("full"), bytes_of("output")).code(), StatusCode::file_unreadable);
  EXPECT_TRUE(S_ISCHR(mode_of(path("full"))));
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(StagedFiles, a_fifo_gets_all_bytes_if_somebody_reads_it) {
  ASSERT_EQ(mkfifo(path("fifo").c_str(), 0600), 0);
  const Status nobody = write_file(path("fifo"), bytes_of("output"));
  EXPECT_EQ(nobody.code(), StatusCode::file_unreadable);
  EXPECT_NE(nobody.text().find("nobody reads"), std::string_view::npos) << nobody.text();
  const std::string output(1'000'000, 'x');  // more than the system holds
  const int end = open(path("fifo").c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(end, 0);
  fcntl(end, F_SETFL, 0);
  std::string received;
  std::thread reader([&] {
    char part[4096];
    while (received.size() < output.size())
      if (const ssize_t count = read(end, part, sizeof part); count > 0)
        received.append(part, static_cast<std::size_t>(count));
      else
        usleep(1000);
  });
  EXPECT_TRUE(write_file(path("fifo"), bytes_of(output)));
  reader.join();
  close(end);
  EXPECT_EQ(received, output);
  EXPECT_TRUE(S_ISFIFO(mode_of(path("fifo"))));
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(StagedFiles, a_reader_that_goes_away_is_an_error_and_no_signal) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  close(ends[0]);
  const Status status =
      write_file("/dev/fd/" + std::to_string(ends[1]), bytes_of("output"));  // EPIPE
  EXPECT_EQ(status.code(), StatusCode::file_unreadable);
  close(ends[1]);
  sigset_t pending;
  sigpending(&pending);
  EXPECT_EQ(sigismember(&pending, SIGPIPE), 0);
}

/// Whatever stands behind them, also a file, is written to, and not replaced.
TEST_F(StagedFiles, a_limit_of_the_size_of_files_is_an_error_and_no_signal) {
  const std::filesystem::path file = folder_.path() / "large";
  const std::vector<std::byte> bytes(100'000);
  const pid_t child = fork();
  if (child == 0) {
    const rlimit limit{10'000, 10'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    _exit(write_file(file, bytes).code() == StatusCode::file_unreadable ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(StagedFiles, descriptors_of_the_process_are_written_to) {
  folder_.write("log", "earlier\n");
  const int log = open(path("log").c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  ASSERT_GE(log, 0);
  for (const char* const folder : {"/dev/fd/", "/proc/self/fd/"})
    EXPECT_TRUE(write_file(folder + std::to_string(log), bytes_of("more\n")));
  EXPECT_EQ(text_of(path("log")), "earlier\nmore\nmore\n");
  close(log);
  EXPECT_FALSE(write_file("/dev/fd/" + std::to_string(log), bytes_of("closed")));
  EXPECT_EQ(files::own_descriptor("/dev/stdout"), 1);
  EXPECT_EQ(files::own_descriptor("/dev/stderr"), 2);
  EXPECT_EQ(files::own_descriptor("/proc/1/fd/1"), std::nullopt);
  fs::create_symlink("/proc/self/fd/1", path("out"));
  EXPECT_EQ(files::own_descriptor(path("out")), std::nullopt) << "only those of the system";
}

TEST_F(StagedFiles, other_places_are_refused) {
  fs::create_directory(path("folder"));
  EXPECT_FALSE(write_file(path("folder"), bytes_of("output")));
  EXPECT_FALSE(write_file(path("absent") / "file", bytes_of("output")));
  EXPECT_FALSE(write_file(path("folder") / "", bytes_of("output")));
  EXPECT_FALSE(write_file("", bytes_of("output")));
  EXPECT_FALSE(write_file(path(std::string(300, 'n').c_str()), bytes_of("output")));
  const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = path("socket").string();
  ASSERT_LT(name.size(), sizeof address.sun_path);
  name.copy(address.sun_path, name.size());
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_FALSE(write_file(name, bytes_of("output")));
  EXPECT_TRUE(S_ISSOCK(mode_of(name)));
  close(listener);
  EXPECT_EQ(file_count(), 2u);
  // A name as long as the system allows is fine.
  EXPECT_TRUE(write_file(path(std::string(255, 'n').c_str()), bytes_of("output")));
}

TEST_F(StagedFiles, what_was_exchanged_before_the_commit_is_not_overwritten) {
  StagedFile staged(path("out"), bytes_of("output"));
  ASSERT_EQ(mkfifo(path("out").c_str(), 0600), 0);
  EXPECT_FALSE(staged.commit());
  EXPECT_TRUE(S_ISFIFO(mode_of(path("out"))));
}

/// Links in folders of /dev lead to disks and terminals.
TEST(StreamOutput, folders_of_the_system_are_known) {
  for (const char* const folder : {"/dev", "/dev/", "/dev/pts", "/proc", "/proc/self"})
    EXPECT_TRUE(files::is_of_system(folder)) << folder;
  for (const char* const folder : {"/", "/tmp", "/dev/shm", "/device"})
    EXPECT_FALSE(files::is_of_system(folder)) << folder;
}

}  // namespace
}  // namespace sunder
