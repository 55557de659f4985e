// The command with files of strangers: what is executed, what is written, what a terminal gets.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <vector>

#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

namespace fs = std::filesystem;

/// The content of all files of a folder.
std::map<std::string, std::string> content_of(const fs::path& folder) {
  std::map<std::string, std::string> content;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    content[entry.path().filename().string()] = test::read_text(entry.path());
  return content;
}

class HostileFolder : public CactusSuite {
 protected:
  /// A new folder of its own.
  static fs::path folder(const std::string& name) {
    fs::create_directory(path(name));
    return path(name);
  }
  static void write_program(const fs::path& file, const std::string& script) {
    std::ofstream(file) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }
};

/// Started by its bare name, the command has this name alone as its argv[0].
TEST_F(HostileFolder, a_planted_helper_is_not_executed) {
  const fs::path models = folder("planted");
  std::ofstream(models / "triangle.off") << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  fs::create_directories(models / "libexec");
  for (const char* const name : {"sunder", "sunder-import", "libexec/sunder-import"})
    write_program(models / name, "touch '" + (models / "was_executed").string() + "'");
  const std::string tools = fs::path(SUNDER_COMMAND).parent_path().string();
  const std::string begin = "cd '" + models.string() + "' && PATH='" + tools + "':\"$PATH\" ";
  EXPECT_EQ(std::system((begin + "sunder info triangle.off > out 2> err").c_str()), 0)
      << test::read_text(models / "err");
  EXPECT_THAT(test::read_text(models / "out"), HasSubstr("OFF"));
  EXPECT_FALSE(fs::exists(models / "was_executed"));
  // The same for a name that is a path into the folder.
  EXPECT_EQ(
      std::system(
          (begin + "bash -c 'exec -a ./sunder sunder info triangle.off' > out 2> err").c_str()),
      0)
      << test::read_text(models / "err");
  EXPECT_FALSE(fs::exists(models / "was_executed"));
}

TEST_F(HostileFolder, a_picture_touches_no_file_but_its_own) {
  const fs::path models = folder("pictures");
  fs::copy(model(), models / "in.scene.glb");
  std::ofstream(models / "in.png.partial") << "mine";
  auto expected = content_of(models);
  const CommandResult result = run_sunder({"picture", (models / "in.scene.glb").string(), "-o",
                                           (models / "in.png").string(), "--size", "64x48"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  auto found = content_of(models);
  EXPECT_TRUE(found["in.png"].starts_with("\x89PNG"));
  found.erase("in.png");
  EXPECT_EQ(found, expected);
}

TEST_F(HostileFolder, an_earlier_picture_survives_a_failure) {
  const fs::path models = folder("failure");
  std::ofstream(models / "out.png") << "earlier";
  const CommandResult result =
      run_sunder({"picture", model(), "-o", (models / "out.png").string(), "--max-memory", "1"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_EQ(test::read_text(models / "out.png"), "earlier") << result.err;
  EXPECT_EQ(content_of(models).size(), 1u);
}

TEST_F(HostileFolder, a_planted_link_is_not_written_through) {
  const fs::path models = folder("links");
  const fs::path report = models / "report.json", output = models / "torn.glb";
  for (const fs::path& file : {report, output}) {
    const fs::path precious = models / ("precious_" + file.stem().string());
    std::ofstream(precious) << "precious";
    fs::create_symlink(precious, file);
    for (const char* const ending : {".partial", ".part0", ".part1", ".part2"})
      fs::create_symlink(precious, fs::path(file) += ending);
  }
  const std::string ops = write("one_tear.json", kOneTear);
  const CommandResult result = run_sunder({"tear", model(), "--ops", ops, "-o", output.string(),
                                           "--report", report.string(), "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(test::read_text(models / "precious_report"), "precious");
  EXPECT_EQ(test::read_text(models / "precious_torn"), "precious");
  EXPECT_TRUE(test::read_text(output).starts_with("glTF"));
  EXPECT_TRUE(json::accept(test::read_text(report)));
}

TEST_F(HostileFolder, modes_and_devices_stay) {
  const fs::path models = folder("modes");
  const fs::path report = models / "report.json", output = models / "torn.glb";
  for (const fs::path& file : {report, output}) {
    std::ofstream(file) << "earlier";
    fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  }
  const std::string ops = write("one_tear.json", kOneTear);
  const auto tear_to = [&](const std::string& to, const std::string& report_to) {
    return run_sunder({"tear", model(), "--ops", ops, "-o", to, "--report", report_to, "--quiet"});
  };
  EXPECT_EQ(tear_to(output.string(), report.string()).exit_code, 0);
  for (const fs::path& file : {report, output})
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  // A device like /dev/null, which the machine can lose.
  const fs::path null = models / "null";
  if (mknod(null.c_str(), S_IFCHR | 0666, makedev(1, 3)) == 0) {
    EXPECT_EQ(tear_to(null.string(), report.string()).exit_code, 0);
    EXPECT_TRUE(fs::is_character_file(null));
    EXPECT_EQ(tear_to(output.string(), null.string()).exit_code, 0);
    EXPECT_TRUE(fs::is_character_file(null));
  }
  // Into a pipe.
  const std::string piped = (models / "piped").string();
  const std::string command = std::string("'") + SUNDER_COMMAND + "' tear '" + model() +
                              "' --ops '" + ops + "' -o /dev/fd/1 --quiet | cat > '" + piped + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_TRUE(test::read_text(piped).starts_with("glTF"));
  EXPECT_EQ(test::read_text(piped), test::read_text(output));
}

/// Ends lines, begins commands of CI services, colours, and turns the direction of writing.
constexpr const char* kForging =
    "\n::error::forged\r\x1b[31m\xc2\x9b"
    "31m\u202e\u2066##[error]forged\x7f##vso[task]";

/// The cactus, whose names all end in this.
Character named_cactus(const std::string& ending) {
  Character cactus = tools::make_cactus();
  for (Bone& bone : cactus.skeleton.bones) bone.name += ending;
  for (Skin& skin : cactus.skins) skin.name += ending;
  for (Clip& clip : cactus.clips) clip.name += ending;
  for (Mesh& mesh : cactus.meshes) {
    mesh.name += ending;
    for (Submesh& submesh : mesh.submeshes) submesh.name += ending;
    for (MorphTarget& target : mesh.morph_targets) target.name += ending;
  }
  return cactus;
}

std::size_t line_count(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

void expect_harmless(const std::string& text) {
  for (const char* const sign : {"\x1b", "\r", "\x7f", "\xc2\x9b", "\u202e", "\u2066", "##"})
    EXPECT_EQ(text.find(sign), std::string::npos) << text;
  EXPECT_EQ(("\n" + text).find("\n::"), std::string::npos) << text;
}

class HostileNames : public CommandSuite {
 protected:
  static void SetUpTestSuite() {
    CommandSuite::SetUpTestSuite();
    ASSERT_TRUE(save_glb(path("plain.glb"), named_cactus("~")));
    // A file may be named like that too.
    ASSERT_TRUE(save_glb(path(hostile_file()), named_cactus(kForging)));
    write("ops.json", kOps);
  }
  static std::string hostile_file() {
    std::string name = std::string("a") + kForging + ".glb";
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
  }

  /// The same verb with both models; "MODEL" stands for one, "~" in arguments for the ending.
  static void compare(const std::vector<std::string>& arguments) {
    const CommandResult plain = run(arguments, "plain.glb", "~"),
                        hostile = run(arguments, hostile_file(), kForging);
    EXPECT_EQ(hostile.exit_code, plain.exit_code) << hostile.err;
    expect_harmless(hostile.out);
    expect_harmless(hostile.err);
    EXPECT_EQ(line_count(hostile.out), line_count(plain.out)) << hostile.out;
    EXPECT_EQ(line_count(hostile.err), line_count(plain.err)) << hostile.err;
    EXPECT_GT(line_count(plain.out) + line_count(plain.err), 0u);
  }

 private:
  static constexpr const char* kOps = R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0, 0.5, 0], "normal": [0, 1, 0.1]}},
    {"op": "cut", "plane": {"point": [0, 9, 0], "normal": [0, 1, 0]}},
    {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4}]})";

  static CommandResult run(std::vector<std::string> arguments, const std::string& file,
                           const std::string& ending) {
    for (std::string& argument : arguments) {
      if (argument == "MODEL") argument = path(file);
      if (const auto place = argument.find('~'); place != std::string::npos)
        argument.replace(place, 1, ending);
    }
    return run_sunder(arguments);
  }
};

TEST_F(HostileNames, forge_nothing_in_what_is_printed) {
  const std::string ops = path("ops.json"), out = path("out.glb");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"info", "MODEL"},
           {"info", "MODEL", "--bones"},
           {"info", "MODEL", "--json"},
           {"info", "MODEL", "--pose", "Swaz~@0.5"},
           {"info", "absent~.glb"},
           {"info", "MODEL", "--no-such-option~"},
           {"tear", "MODEL", "--ops", ops, "-o", out},
           {"tear", "MODEL", "--ops", ops, "-o", out, "--verbose"},
           {"tear", "MODEL", "--ops", ops, "-o", out, "--report", "-"},
           {"tear", "MODEL", "--ops", ops, "-o", path("absent~") + "/out.glb"},
           {"validate", "MODEL", "MODEL"},
           {"validate", "MODEL", "MODEL", "--json-lines"},
           {"transfer", "MODEL", "MODEL", "-o", out},
           {"bind", "MODEL", "--skeleton", "MODEL", "-o", out},
           {"picture", "MODEL", "-o", path("p.png"), "--bone", "trunk~x", "--size", "64x48"}}) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    compare(arguments);
  }
}

TEST_F(HostileNames, are_whole_in_json) {
  const Character cactus = named_cactus(kForging);
  const CommandResult result = run_sunder({"info", path(hostile_file()), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json info = json::parse(result.out);
  EXPECT_EQ(info["model"], path(hostile_file()));
  std::vector<std::string> expected;
  for (const Bone& bone : cactus.skeleton.bones) expected.push_back(bone.name);
  EXPECT_THAT(info["bones"].get<std::vector<std::string>>(), testing::IsSupersetOf(expected));
  EXPECT_EQ(info["clips"][0]["name"], cactus.clips[0].name);
}

}  // namespace
}  // namespace sunder::command_test
