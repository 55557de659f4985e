// Logs with coupled refits: `sunder` does not link Ceres, and becomes the program that does.

#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

namespace fs = std::filesystem;

class CoupledRefitCommand : public CactusSuite {
 protected:
  static std::string log(const std::string& name, bool is_coupled) {
    return write(name, R"({"sunder_operations": 1, "operations": [
      {"op": "tear", "pose": {"clip": "Sway", "time": 0.8},
       "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.25, 2], "tip": [-0.12, 1.25, 0]}]},
      {"op": "weights", "weights": {"policy": "refit"}, "refit": {"poses": {"clip_samples": 8}, "coupled": )" +
                           std::string(is_coupled ? "true" : "false") + "}}]}");
  }

  /// Runs a copy of the command, in a folder of its own.
  static CommandResult run_copy(const fs::path& folder, const std::string& operations) {
    fs::create_directories(folder);
    fs::copy_file(SUNDER_COMMAND, folder / "sunder", fs::copy_options::overwrite_existing);
    return test::run_program((folder / "sunder").c_str(),
                             {"tear", model(), "--ops", operations, "-o", path("copy.glb")},
                             {{"PATH", (folder.parent_path() / "elsewhere").string()}});
  }

  /// A program that says that it ran.
  static void write_program(const fs::path& file) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "#!/bin/sh\necho another program \"$@\"\n";
    fs::permissions(file, fs::perms::owner_all);
  }
};

/// The libraries that a program loads.
std::string libraries_of(const char* program) {
  return test::run_program("/usr/bin/ldd", {program}).out;
}

TEST_F(CoupledRefitCommand, the_command_loads_no_library_under_the_gpl) {
  const std::string libraries = libraries_of(SUNDER_COMMAND);
  ASSERT_THAT(libraries, HasSubstr("libstdc++"));
  for (const char* const name : {"ceres", "cholmod", "spqr", "cxsparse", "lapack"})
    EXPECT_THAT(libraries, testing::Not(HasSubstr(name)));
}

TEST_F(CoupledRefitCommand, a_coupled_refit_runs_in_the_other_program) {
  if (!fs::exists(SUNDER_COUPLED_COMMAND)) GTEST_SKIP() << "built without Ceres (SUNDER_CERES)";
  const std::string together = log("together.json", true), alone = log("alone.json", false);
  for (const std::string& operations : {together, alone}) {
    const CommandResult torn = run_sunder(
        {"tear", model(), "--ops", operations, "-o", operations + ".glb", "--report", "-"});
    ASSERT_EQ(torn.exit_code, 0) << torn.err;
    EXPECT_EQ(json::parse(torn.out)["operations"].size(), 2u);
  }
  EXPECT_NE(bytes("together.json.glb"), bytes("alone.json.glb"));
  const CommandResult direct = test::run_program(
      SUNDER_COUPLED_COMMAND, {"tear", model(), "--ops", together, "-o", path("direct.glb")});
  ASSERT_EQ(direct.exit_code, 0) << direct.err;
  EXPECT_EQ(bytes("direct.glb"), bytes("together.json.glb"));
}

TEST_F(CoupledRefitCommand, without_the_other_program_a_coupled_refit_is_refused) {
  const fs::path folder = path("lone/bin");
  const CommandResult refused = run_copy(folder, log("lone.json", true));
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("sunder-coupled-refit"));
  EXPECT_EQ(run_copy(folder, log("lone_alone.json", false)).exit_code, 0);
}

TEST_F(CoupledRefitCommand, only_a_program_of_the_installation_is_run) {
  const std::string operations = log("places.json", true);
  write_program(path("places/elsewhere/sunder-coupled-refit"));  // a folder of PATH
  write_program(path("places/sunder-coupled-refit"));
  const fs::path folder = path("places/bin");
  const CommandResult refused = run_copy(folder, operations);
  EXPECT_EQ(refused.exit_code, 2) << refused.out << refused.err;

  const fs::path installed = path("places/libexec/sunder-coupled-refit");
  write_program(installed);
  const CommandResult replaced = run_copy(folder, operations);
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_THAT(replaced.out, HasSubstr("another program tear"));
  fs::permissions(installed, fs::perms::others_write, fs::perm_options::add);
  const CommandResult writable = run_copy(folder, operations);
  EXPECT_EQ(writable.exit_code, 3) << writable.out << writable.err;
  EXPECT_THAT(writable.err, HasSubstr("is refused: another user"));
  if (geteuid() != 0) return;
  fs::permissions(installed, fs::perms::others_write, fs::perm_options::remove);
  for (const fs::path& of : {installed, installed.parent_path()}) {
    ASSERT_EQ(chown(of.c_str(), 12345, 12345), 0);
    const CommandResult of_another_user = run_copy(folder, operations);
    EXPECT_EQ(of_another_user.exit_code, 3) << of_another_user.out;
    ASSERT_EQ(chown(of.c_str(), 0, 0), 0);
  }
}

/// Without /proc, and for a program that was deleted while it ran, the system does not say where
/// the program is.
TEST_F(CoupledRefitCommand, the_current_folder_is_not_searched_if_the_own_one_is_unknown) {
  const fs::path folder = path("replaced/bin"), models = path("replaced/models");
  const std::string pipe = path("replaced_log");
  fs::create_directories(folder);
  fs::copy_file(SUNDER_COMMAND, folder / "sunder", fs::copy_options::overwrite_existing);
  for (const fs::path& planted : {models, models.parent_path() / "libexec"})
    write_program(planted / "sunder-coupled-refit");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  // The log comes when the program has opened the pipe, and is gone.
  const std::string script =
      "cd '" + models.string() + "' && { { exec 3>'" + pipe + "'; rm '" +
      (folder / "sunder").string() + "'; cat '" + log("replaced.json", true) + "' >&3; } & '" +
      (folder / "sunder").string() + "' tear '" + model() + "' --ops '" + pipe + "' -o copy.glb; }";
  const CommandResult refused = test::run_program("/bin/sh", {"-c", script});
  EXPECT_EQ(refused.exit_code, 2) << refused.err;
  EXPECT_THAT(refused.out, testing::Not(HasSubstr("another program"))) << refused.err;
}

}  // namespace
}  // namespace sunder::command_test
