// Numbers of options that are out of range: each is refused with the value and the range, and
// nothing is written.
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using testing::AllOf;
using testing::AnyOf;

class NumberOptions : public CactusSuite {
 protected:
  /// The arguments of each verb before an option; the first word is the verb.
  static std::vector<std::string> begin(const std::string& verb) {
    if (verb == "tear") return {verb, model(), "--slash", "Trunk3", "-o", path("no.glb")};
    if (verb == "transfer") return {verb, model(), model(), "-o", path("no.glb")};
    if (verb == "bind") return {verb, model(), "--skeleton", model(), "-o", path("no.glb")};
    if (verb == "validate") return {verb, model(), model(), "--report", path("no.json")};
    return {verb, model()};
  }
  static CommandResult run(const std::string& verb, const std::string& option,
                           const std::string& value) {
    std::vector<std::string> arguments = begin(verb);
    arguments.insert(arguments.end(), {option, value});
    return run_sunder(arguments);
  }
};

struct Ranged {
  const char* verb;
  const char* option;
  std::vector<const char*> refused;  ///< Besides those that no option takes.
};

TEST_F(NumberOptions, out_of_range_are_refused_with_the_value_and_the_range) {
  for (const Ranged& of : std::vector<Ranged>{
           {"tear", "--max-seconds", {"0", "1e10"}},
           {"tear", "--max-memory", {"0", "1e7"}},
           {"tear", "--max-vertices", {"2.5", "1e10"}},
           {"tear", "--memory", {"0", "1e7"}},
           {"tear", "--import-seconds", {"0", "1e10"}},
           {"tear", "--refit-bound", {"1e10"}},
           {"transfer", "--distance", {"1e10"}},
           {"transfer", "--angle", {"181"}},
           {"transfer", "--smoothness", {"1e7"}},
           {"transfer", "--smoothing", {"2.5", "1e7"}},
           {"transfer", "--influences", {"2.5", "70000"}},
           {"transfer", "--mix", {"1.5", "150%"}},
           {"bind", "--heat", {"0", "1e10"}},
           {"bind", "--influences", {"2.5", "70000"}},
           {"validate", "--error-deviation", {"1e10"}},
           {"validate", "--jobs", {"0", "257"}},
           {"info", "--import-seconds", {"0"}},
       }) {
    std::vector<const char*> values = {"nan", "inf", "-inf", "-1", "1e300", "kg", "3kg", ""};
    values.insert(values.end(), of.refused.begin(), of.refused.end());
    for (const char* const value : values) {
      const CommandResult result = run(of.verb, of.option, value);
      EXPECT_EQ(result.exit_code, 2) << of.verb << " " << of.option << " " << value;
      EXPECT_THAT(result.err, AllOf(HasSubstr(of.option),
                                    AnyOf(HasSubstr("'" + std::string(value) + "' is no "),
                                          testing::ContainsRegex(" is .*; it must be "))));
      EXPECT_LT(result.err.size(), 300u) << result.err;
    }
    EXPECT_THAT(run(of.verb, of.option, "-1").err,
                testing::ContainsRegex("(is -1.*; it must be|expected one) (from|above) "));
  }
  EXPECT_FALSE(exists("no.glb"));
  EXPECT_FALSE(exists("no.json"));
}

TEST_F(NumberOptions, have_units) {
  for (const auto& [option, value] :
       {std::pair("--max-seconds", "2min"), std::pair("--import-seconds", "500 ms")})
    EXPECT_EQ(run("tear", option, value).exit_code, 0) << option;
  std::filesystem::remove(path("no.glb"));
  for (const auto& [option, value] : {std::pair("--mix", "100%"), std::pair("--distance", "5 %"),
                                      std::pair("--angle", "30 deg")}) {
    EXPECT_LE(run("transfer", option, value).exit_code, 1) << option;
    std::filesystem::remove(path("no.glb"));
  }
  EXPECT_EQ(run("validate", "--error-deviation", "2%").exit_code, 0);
}

}  // namespace
}  // namespace sunder::command_test
