// `sunder studio`: what it serves, to whom, and how it ends. The page is a short one of the test.

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using test::read_text;
using testing::StartsWith;

constexpr const char* kPage = "<!doctype html><title>studio</title>";

/// A request of one line and these headers. @return the whole answer; empty if there is none
std::string ask(std::uint16_t port, const std::string& line, const std::string& headers) {
  const int connection = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  void* const place = &address;
  std::string answer;
  if (connect(connection, static_cast<sockaddr*>(place), sizeof address) == 0) {
    const std::string request = line + " HTTP/1.1\r\nConnection: close\r\n" + headers + "\r\n";
    EXPECT_EQ(send(connection, request.data(), request.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(request.size()));
    char part[4096];
    for (ssize_t size = 0; (size = recv(connection, part, sizeof part, 0)) > 0;)
      answer.append(part, static_cast<std::size_t>(size));
  }
  close(connection);
  return answer;
}

int status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.") && answer.size() > 12 ? std::atoi(answer.c_str() + 9) : 0;
}
std::string content_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n");
  return end == std::string::npos ? std::string() : answer.substr(end + 4);
}

/// The command while it serves.
class Studio {
 public:
  /// @param path  of programs; empty: that of the test
  explicit Studio(const std::vector<std::string>& arguments, const std::string& path = {},
                  std::string program = SUNDER_COMMAND) {
    int ends[2];
    if (pipe(ends) != 0) return;
    std::vector<std::string> texts = {program, "studio"};
    texts.insert(texts.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& text : texts) argv.push_back(text.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      close(ends[0]);
      if (!path.empty()) setenv("PATH", path.c_str(), 1);
      execv(program.c_str(), argv.data());
      _exit(127);
    }
    close(ends[1]);
    for (char letter = 0; read(ends[0], &letter, 1) == 1 && letter != '\n';) address_ += letter;
    close(ends[0]);
  }
  ~Studio() {
    if (child_ > 0) end(SIGKILL);
  }
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  /// "http://127.0.0.1:8000/?model=…"
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] std::uint16_t port() const {
    const std::string before = "http://127.0.0.1:";
    return address_.starts_with(before)
               ? static_cast<std::uint16_t>(std::atoi(address_.c_str() + before.size()))
               : std::uint16_t{0};
  }
  [[nodiscard]] std::string get(const std::string& path) const {
    return ask(port(), "GET " + path, "Host: 127.0.0.1:" + std::to_string(port()) + "\r\n");
  }
  /// @return the exit code; -1: the signal ended it.
  int end(int signal) {
    int state = 0;
    kill(child_, signal);
    waitpid(child_, &state, 0);
    child_ = 0;
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  }

 private:
  pid_t child_ = 0;
  std::string address_;
};

class StudioCommand : public CactusSuite {
 protected:
  static std::string page() { return write("page.html", kPage); }
};

TEST_F(StudioCommand, serves_the_page_and_the_model_until_ctrl_c) {
  Studio studio({model(), "--page", page(), "--no-open"});
  ASSERT_NE(studio.port(), 0);
  EXPECT_THAT(studio.address(), HasSubstr("/?model=/model.glb&name=cactus"));
  const std::string shown = studio.get("/?model=/model.glb&name=cactus");
  EXPECT_EQ(status_of(shown), 200);
  EXPECT_EQ(content_of(shown), kPage);
  EXPECT_THAT(shown, HasSubstr("Content-Type: text/html; charset=utf-8\r\n"));
  EXPECT_THAT(shown, HasSubstr("X-Content-Type-Options: nosniff\r\n"));
  const std::string file = studio.get("/model.glb");
  EXPECT_EQ(content_of(file), read_text(model()));
  EXPECT_THAT(file, HasSubstr("Content-Type: model/gltf-binary\r\n"));
  EXPECT_EQ(studio.end(SIGINT), 0);
}

TEST_F(StudioCommand, gives_nothing_else_and_nothing_to_other_hosts) {
  const Studio studio({"--page", page(), "--no-open"});
  ASSERT_NE(studio.port(), 0);
  const std::string own = "Host: localhost:" + std::to_string(studio.port()) + "\r\n";
  const auto status = [&](const std::string& line, const std::string& headers) {
    return status_of(ask(studio.port(), line, headers));
  };
  EXPECT_EQ(status("GET /", own), 200);
  for (const char* const path :
       {"/model.glb", "/page.html", "/..", "/../page.html", "/%2e%2e/page.html", "//", "/./",
        "/../../../../../../etc/passwd", "/index.html"})
    EXPECT_EQ(status(std::string("GET ") + path, own), 404) << path;
  EXPECT_EQ(status("GET /", "Host: elsewhere.example\r\n"), 403);
  EXPECT_EQ(status("GET /", "Host: elsewhere.example:" + std::to_string(studio.port()) + "\r\n"),
            403);
  EXPECT_EQ(status("GET /", "Host: localhost\r\n"), 403);
  EXPECT_EQ(status("GET /", ""), 403);
  EXPECT_EQ(status("GET http://elsewhere.example/", "Host: elsewhere.example\r\n"), 403);
  for (const char* const method : {"POST", "PUT", "DELETE", "OPTIONS", "HEAD"})
    EXPECT_GE(status(std::string(method) + " /", own + "Content-Length: 0\r\n"), 400) << method;
  EXPECT_EQ(status("GET /", own), 200);  // and goes on
}

TEST_F(StudioCommand, opens_the_address_unless_told_not_to) {
  const std::string folder = path("programs"), opened = path("opened");
  std::filesystem::create_directory(folder);
  const std::string opener = folder + "/xdg-open";
  std::ofstream(opener) << "#!/bin/sh\necho \"$1\" > " << opened << ".new\n/bin/mv " << opened
                        << ".new " << opened << "\n";
  std::filesystem::permissions(opener, std::filesystem::perms::owner_all);
  const Studio studio({"--page", page()}, folder);
  ASSERT_NE(studio.port(), 0);
  for (int i = 0; i < 600 && !exists("opened"); ++i) usleep(50'000);
  EXPECT_EQ(read_text(opened), studio.address() + "\n");
  std::filesystem::remove(opened);
  const Studio quiet({"--page", page(), "--no-open"}, folder);
  ASSERT_NE(quiet.port(), 0);
  EXPECT_EQ(status_of(quiet.get("/")), 200);
  EXPECT_FALSE(exists("opened"));
}

TEST_F(StudioCommand, a_port_that_is_taken_is_refused) {
  const Studio studio({"--page", page(), "--no-open"});
  ASSERT_NE(studio.port(), 0);
  const std::string taken = std::to_string(studio.port());
  const CommandResult second =
      run_sunder({"studio", "--page", page(), "--no-open", "--port", taken});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, HasSubstr("port " + taken));
  EXPECT_THAT(second.out, IsEmpty());
}

TEST_F(StudioCommand, what_cannot_be_shown_is_refused_before_anything_is_served) {
  const auto refused = [](const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {"studio", "--no-open"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run_sunder(all);
    EXPECT_THAT(result.out, IsEmpty());
    return std::to_string(result.exit_code) + " " + result.err;
  };
  EXPECT_THAT(refused({path("absent.glb"), "--page", page()}),
              testing::AllOf(StartsWith("3 "), HasSubstr("absent.glb")));
  EXPECT_THAT(refused({write("text.glb", "no model"), "--page", page()}),
              testing::AllOf(StartsWith("3 "), HasSubstr("text.glb")));
  EXPECT_THAT(refused({write("notes.txt", "no model"), "--page", page()}), StartsWith("3 "));
  EXPECT_THAT(refused({"--page", path("absent.html")}),
              testing::AllOf(StartsWith("3 "), HasSubstr("absent.html")));
  EXPECT_THAT(refused({"--page", page(), "--port", "70000"}), StartsWith("2 "));
}

TEST_F(StudioCommand, an_installed_command_shows_the_installed_page) {
  const std::filesystem::path prefix = path("prefix");
  std::filesystem::create_directories(prefix / "bin");
  std::filesystem::create_directories(prefix / "share/sunder/studio");
  std::filesystem::copy_file(SUNDER_COMMAND, prefix / "bin/sunder");
  std::ofstream(prefix / "share/sunder/studio/index.html") << "installed";
  const Studio studio({"--no-open"}, {}, (prefix / "bin/sunder").string());
  ASSERT_NE(studio.port(), 0);
  EXPECT_EQ(content_of(studio.get("/")), "installed");
}

/// What is not a GLB goes to the page as one.
TEST_F(StudioCommand, other_formats_are_imported) {
  const std::string triangle = write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Studio studio({triangle, "--page", page(), "--no-open"});
  ASSERT_NE(studio.port(), 0);
  const std::string file = content_of(studio.get("/model.glb"));
  std::ofstream(path("served.glb"), std::ios::binary) << file;
  const auto loaded = load_character(path("served.glb"));
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->character->meshes.at(0).triangles.size(), 1u);
}

}  // namespace
}  // namespace sunder::command_test
