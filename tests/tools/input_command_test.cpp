// What the command reads: pipes, and nothing that has no end.
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

class InputCommand : public CactusSuite {};

/// Runs the command by bash; "$0" is the command, "$1" the model and "$2" the folder.
CommandResult run_by_shell(const std::string& script, const std::string& model,
                           const std::string& folder) {
  return test::run_program("/bin/bash", {"-c", script, SUNDER_COMMAND, model, folder});
}

TEST_F(InputCommand, takes_operations_from_pipes) {
  write("ops.json", kOneTear);
  for (const char* const script :
       {R"("$0" tear "$1" --ops <(cat "$2/ops.json") -o "$2/torn.glb")",
        R"(cat "$2/ops.json" | "$0" tear "$1" --ops /dev/stdin -o "$2/torn.glb" --force)",
        R"("$0" tear "$1" --ops /dev/stdin -o "$2/torn.glb" --force < "$2/ops.json")"}) {
    const CommandResult result = run_by_shell(script, model(), path("."));
    EXPECT_EQ(result.exit_code, 0) << script << result.err;
    EXPECT_THAT(result.err, HasSubstr("/operations/0: tear at"));
  }
}

TEST_F(InputCommand, devices_and_folders_are_no_texts) {
  write("ops.json", kOneTear);
  const std::vector<std::vector<std::string>> commands = {
      {"tear", model(), "--ops", "/dev/zero", "-o", path("no.glb")},
      {"tear", model(), "--ops", path("ops.json"), "--max-error", "1mm", "--limits", "/dev/zero",
       "-o", path("no.glb")},
      {"validate", model(), model(), "--bone-names", "/dev/zero"},
      {"validate", model(), model(), "--limits", "/dev/zero"},
      {"validate", "--manifest", "/dev/zero"},
      {"transfer", model(), model(), "-o", path("no.glb"), "--vertices", "/dev/zero"},
      {"bind", model(), "--skeleton", model(), "-o", path("no.glb"), "--map", "/dev/zero"},
      {"picture", model(), "--ops", "/dev/zero", "-o", path("no.png")}};
  for (const auto& command : commands) {
    const CommandResult result = run_sunder(command);
    EXPECT_EQ(result.exit_code, 3) << command[0] << result.err;
    EXPECT_THAT(result.err, HasSubstr("'zero' is a device; expected a regular file or a pipe"));
  }
  const CommandResult folder =
      run_sunder({"validate", model(), model(), "--bone-names", path(".")});
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_THAT(folder.err, HasSubstr("is a folder"));
  EXPECT_FALSE(exists("no.glb"));
}

TEST_F(InputCommand, faults_of_a_text_have_their_line) {
  write("names.json", "{\"a\": \"b\",\n \"a\": \"c\"}");
  const CommandResult twice =
      run_sunder({"validate", model(), model(), "--bone-names", path("names.json")});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("field 'a' occurs twice"));
  write("names.json", "{\"a\": \"b\",\n oops}");
  const CommandResult syntax =
      run_sunder({"validate", model(), model(), "--bone-names", path("names.json")});
  EXPECT_EQ(syntax.exit_code, 2);
  EXPECT_THAT(syntax.err, HasSubstr("invalid JSON: line 2"));
}

}  // namespace
}  // namespace sunder::command_test
