// What `sunder tear` says: the lines of operations, misses and their causes, warnings, refusals.

#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <sstream>

#include "support/machine/random.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::Not;

class TearMessages : public CactusSuite {
 protected:
  /// A log with one operation that shares the fields of kOneTear's, with changes.
  static std::string changed(const std::string& name, const json& changes) {
    json log = json::parse(kOneTear);
    log["operations"][0].update(changes);
    return write(name, log.dump());
  }
  /// The stroke of kOneTear with each blade changed.
  template <class Change>
  static json stroke(const Change& change) {
    json blades = json::parse(kOneTear)["operations"][0]["stroke"];
    for (json& blade : blades) change(blade);
    return {{"stroke", blades}};
  }
  static CommandResult tear(const std::string& operations,
                            const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"tear",     model(), "--ops",
                                          operations, "-o",    path("m.glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }
};

TEST_F(TearMessages, one_line_per_operation_says_what_and_where) {
  const CommandResult result = tear(write("all.json", kAll));
  EXPECT_EQ(result.exit_code, 1);
  std::istringstream lines(result.err);
  std::size_t index = 0;
  for (std::string line; std::getline(lines, line); ++index)
    EXPECT_THAT(line, HasSubstr("/operations/" + std::to_string(index) + ": "));
  EXPECT_EQ(index, 11u);
  EXPECT_THAT(
      result.err,
      ContainsRegex("/operations/0: tear at \\(.*\\) on 'Trunk[0-9]': [0-9]+ faces crossed, "
                    "0\\.[0-9]+ m long, [0-9.]+ ms"));
  EXPECT_THAT(result.err, ContainsRegex("/operations/3: cut at .*, 2 pieces, [0-9.]+ ms"));
  EXPECT_THAT(result.err, ContainsRegex("/operations/7: undo: undone, "));
  EXPECT_THAT(result.err, ContainsRegex(": drill at .* crossed, [0-9.e-]+ m2 removed"));
  EXPECT_THAT(result.err, Not(HasSubstr(" 0 m long")));
}

TEST_F(TearMessages, quiet_says_nothing_but_errors_and_misses) {
  const CommandResult one = tear(write("one.json", kOneTear), {"-q"});
  EXPECT_EQ(one.exit_code, 0);
  EXPECT_THAT(one.out, IsEmpty());
  EXPECT_THAT(one.err, IsEmpty());
  const CommandResult result = tear(write("all.json", kAll), {"-q"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, AllOf(HasSubstr("/operations/9: cut missed"),
                                HasSubstr("/operations/10: drill missed")));
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 2);
  const CommandResult failed =
      tear(changed("q.json", {{"pose", {{"clip", "Fly"}, {"time", 0}}}}), {"-q"});
  EXPECT_EQ(failed.exit_code, 2);
  EXPECT_THAT(failed.err, HasSubstr("Fly"));
}

TEST_F(TearMessages, verbose_adds_details_and_durations) {
  const CommandResult result = tear(write("one.json", kOneTear), {"-v"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("0 places blocked; weights: "), HasSubstr("loading "),
                                HasSubstr("operations "), HasSubstr("saving "),
                                ContainsRegex("[0-9]+ % in loading, operations and saving")));
}

TEST_F(TearMessages, without_a_report_a_summary_goes_to_stdout) {
  const CommandResult result = tear(write("all.json", kAll));
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("operations  9 done, 2 missed\n"), HasSubstr(" faces crossed, "),
                    HasSubstr(" vertices added, "), HasSubstr("weights     barycentric"),
                    HasSubstr("written     " + path("m.glb"))));
  EXPECT_LT(result.out.size(), 1000u);
}

TEST_F(TearMessages, a_dry_run_says_all_and_writes_nothing) {
  const std::string log = write("all.json", kAll);
  std::filesystem::remove(path("m.glb"));
  const CommandResult wet = tear(log, {"--report", "-"});
  std::filesystem::remove(path("m.glb"));
  const CommandResult dry = run_sunder({"tear", model(), "--ops", log, "--dry-run", "--save-log",
                                        path("dry.json"), "--report", "-"});
  EXPECT_EQ(dry.exit_code, 1);
  EXPECT_EQ(json::parse(dry.out)["result"], json::parse(wet.out)["result"]);
  EXPECT_FALSE(exists("dry.json"));
  const CommandResult summed = tear(log, {"--dry-run"});
  EXPECT_THAT(summed.out, HasSubstr("a dry run"));
  EXPECT_FALSE(exists("m.glb"));
  const CommandResult nowhere = run_sunder({"tear", model(), "--ops", log});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("--output"));
}

/// The least height of the cactus above a plane is known from its bounds.
TEST_F(TearMessages, a_miss_says_its_distance_and_the_bounds) {
  const json bounds = json::parse(run_sunder({"info", model(), "--json"}).out)["bounds"];
  const double top = bounds["max"][1];
  const std::string log = write("above.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0, 2.5, 0], "normal": [0, -3, 0]}},
    {"op": "cut", "plane": {"point": [0, 2.5, 0], "normal": [0, 1, 0]},
     "bounds": [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]]},
    {"op": "drill", "axis": {"origin": [-9, 2.5, 0], "direction": [1, 0, 0]}, "radius": 0.02, "depth": 18},
    {"op": "tear", "stroke": [{"base": [-9, 2.5, 9], "tip": [-9, 2.5, -9]}, {"base": [9, 2.5, 9], "tip": [9, 2.5, -9]}]}]})");
  const CommandResult result = tear(log, {"--report", "-"});
  EXPECT_EQ(result.exit_code, 1);
  const json operations = json::parse(result.out)["operations"];
  ASSERT_EQ(operations.size(), 4u);
  for (const std::size_t i : {0u, 1u, 3u})
    EXPECT_NEAR(operations[i]["miss"]["distance"].get<double>(), 2.5 - top, 1e-4) << i;
  EXPECT_GE(operations[2]["miss"]["distance"].get<double>(), 2.5 - top - 1e-6);
  EXPECT_LT(operations[2]["miss"]["distance"].get<double>(), 2.5 - top + 0.3);
  for (const char* const side : {"min", "max"})
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(operations[0]["miss"]["bounds"][side][axis].get<double>(),
                  bounds[side][axis].get<double>(), 1e-4);
  EXPECT_THAT(result.err, HasSubstr("cut missed: the plane passes 0.7"));
  EXPECT_THAT(result.err, HasSubstr("the plane, within its bounds, passes 0.7"));
  EXPECT_THAT(result.err, HasSubstr("the axis of the bore passes 0.7"));
  EXPECT_THAT(result.err, HasSubstr("the blade passes 0.7"));
  EXPECT_THAT(result.err, HasSubstr("m from the surface, which spans ("));
  EXPECT_THAT(result.err, Not(HasSubstr("it would meet")));
}

TEST_F(TearMessages, a_miss_writes_no_weights_and_says_so) {
  const std::string log = write("above.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0, 99, 0], "normal": [0, 1, 0]}}]})");
  const CommandResult result = tear(log, {"--weights-as", "u8"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.out, HasSubstr("those of the model; no mesh changed"));
  EXPECT_THAT(result.out, Not(HasSubstr("u8")));
}

TEST_F(TearMessages, a_miss_in_centimetres_is_recognised) {
  const auto scale = [](double factor) {
    return stroke([factor](json& blade) {
      for (auto& point : blade)
        for (json& number : point) number = factor * number.get<double>();
    });
  };
  const CommandResult centimetres = tear(changed("cm.json", scale(100)));
  EXPECT_EQ(centimetres.exit_code, 1);
  EXPECT_THAT(centimetres.err, AllOf(HasSubstr("scaled by 0.01"), HasSubstr("centimetres")));
  EXPECT_THAT(tear(changed("mm.json", scale(1000))).err,
              AllOf(HasSubstr("scaled by 0.001"), HasSubstr("millimetres")));
  EXPECT_THAT(tear(changed("small.json", scale(0.01))).err, HasSubstr("scaled by 100 "));
}

/// The tip of the highest arm stands elsewhere in the clip than at rest.
TEST_F(TearMessages, a_miss_in_the_wrong_pose_is_recognised) {
  const auto bounds_at = [&](const json& pose) {
    const std::string log =
        write("probe.json", json{{"sunder_operations", 1},
                                 {"operations",
                                  {{{"op", "cut"},
                                    {"pose", pose},
                                    {"plane", {{"point", {90, 0, 0}}, {"normal", {1, 0, 0}}}}}}}}
                                .dump());
    return json::parse(
               tear(log, {"--report", "-"}).out)["operations"][0]["miss"]["bounds"]["max"][0]
        .get<double>();
  };
  const json still = "rest", swaying = {{"clip", "Sway"}, {"time", 0.4}};
  const double at_rest = bounds_at(still), in_clip = bounds_at(swaying);
  ASSERT_GT(std::abs(at_rest - in_clip), 0.004);
  const double between = (at_rest + in_clip) / 2;
  const json missing = at_rest < in_clip ? still : swaying;
  const std::string log =
      write("pose.json", json{{"sunder_operations", 1},
                              {"operations",
                               {{{"op", "cut"},
                                 {"pose", missing},
                                 {"plane", {{"point", {between, 0, 0}}, {"normal", {1, 0, 0}}}}}}}}
                             .dump());
  const CommandResult result = tear(log);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("it would meet: is its pose right?"));
}

TEST_F(TearMessages, blades_that_point_away_or_end_early_are_recognised) {
  const CommandResult away =
      tear(changed("away.json", stroke([](json& blade) { blade["tip"][2] = 4.0; })));
  EXPECT_EQ(away.exit_code, 1);
  EXPECT_THAT(away.err, HasSubstr("points away from it: are base and tip swapped?"));
  const CommandResult early =
      tear(changed("early.json", stroke([](json& blade) { blade["tip"][2] = 1.0; })));
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_THAT(early.err, HasSubstr("the blade is too short to reach it"));
}

TEST_F(TearMessages, a_stroke_that_is_too_small_for_its_face_is_recognised) {
  const CommandResult result = run_sunder(
      {"tear", model(), "--dry-run", "--slash", "Trunk3@0.5,length=0.00001", "--report", "-"});
  EXPECT_EQ(result.exit_code, 1);
  const json miss = json::parse(result.out)["operations"][0]["miss"];
  EXPECT_EQ(miss["distance"], 0.0);
  EXPECT_THAT(result.err, HasSubstr("the blade passes, without opening a face, along the surface"));
  EXPECT_THAT(result.err, HasSubstr("it is too small for the faces there"));
}

/// The operation with the correction that a cause proposes; null if it proposes none of these.
json corrected(json operation, const std::string& cause) {
  std::smatch match;
  if (std::regex_search(cause, match, std::regex("scaled by ([0-9.]+) it"))) {
    const double factor = std::stod(match[1]);
    for (json& number : operation["axis"]["origin"]) number = factor * number.get<double>();
    for (const char* const field : {"radius", "depth"})
      operation[field] = factor * operation[field].get<double>();
  } else if (std::regex_search(cause, match, std::regex("in the (rest|bind) pose it"))) {
    operation["pose"] = match[1].str();
  } else if (std::regex_search(cause, match, std::regex("at (.*) s of clip '(.*)' it"))) {
    operation["pose"] = {{"clip", match[2].str()}, {"time", std::stod(match[1])}};
  } else {
    const double way = cause.find("points away") == std::string::npos ? 1.0 : -1.0;
    for (json& number : operation["axis"]["direction"]) number = way * number.get<double>();
    operation["depth"] = 50.0;
  }
  return operation;
}

/// Bores that pass near the surface, in wrong units and poses: whoever follows the advice hits.
TEST_F(TearMessages, every_cause_of_a_miss_is_true) {
  test::Random random(3);
  int causes = 0;
  const auto miss_of = [](const json& operation) {
    const json log = {{"sunder_operations", 1}, {"operations", {operation}}};
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", write("random.json", log.dump()), "--dry-run", "--report", "-"});
    const json outcome = json::parse(result.out)["operations"][0];
    return outcome.contains("miss") ? outcome["miss"] : json();
  };
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const double unit = std::array{1.0, 1.0, 1.0, 100.0, 0.01, 1000.0}[random.index(6)];
    json operation = {{"op", "drill"}, {"radius", random.uniform(0.02, 0.25) * unit}};
    operation["axis"]["origin"] = {unit * random.uniform(-0.6, 0.6), unit * random.uniform(0, 2),
                                   unit * random.uniform(-0.5, 0.5)};
    operation["axis"]["direction"] = {random.uniform(-1, 1), random.uniform(-1, 1), 0.3};
    operation["depth"] = unit * random.uniform(0.02, 0.3);
    if (random.index(2) == 0)
      operation["pose"] = {{"clip", "Sway"}, {"time", random.uniform(0, 2)}};
    const json miss = miss_of(operation);
    if (miss.is_null() || miss["cause"].is_null()) continue;
    ++causes;
    const std::string cause = miss["cause"];
    EXPECT_TRUE(miss_of(corrected(operation, cause)).is_null()) << cause << operation;
  }
  EXPECT_GT(causes, 10);
}

TEST_F(TearMessages, swapped_base_and_tip_are_warned_of) {
  const CommandResult result = tear(
      changed("swap.json", stroke([](json& blade) { std::swap(blade["base"], blade["tip"]); })));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("warning: /operations/0: "), HasSubstr("are base and tip swapped?")));
  EXPECT_THAT(tear(write("one.json", kOneTear)).err, Not(HasSubstr("warning")));
}

TEST_F(TearMessages, a_time_beyond_the_end_of_the_clip_is_warned_of) {
  const CommandResult result =
      tear(changed("late.json", {{"pose", {{"clip", "Sway"}, {"time", 99}}}}));
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err,
              HasSubstr("the time 99 s is beyond the end of clip 'Sway', which lasts 2 s"));
  EXPECT_THAT(tear(changed("end.json", {{"pose", {{"clip", "Sway"}, {"time", 2}}}})).err,
              Not(HasSubstr("beyond")));
}

TEST_F(TearMessages, a_gap_wider_than_the_body_is_warned_of) {
  const CommandResult result = tear(changed("wide.json", {{"width", 5}}));
  EXPECT_THAT(result.err,
              ContainsRegex("the gap is 5 m wide, but the body there is only 0\\.[0-9]+ m wide"));
  EXPECT_THAT(tear(changed("narrow.json", {{"width", 0.05}})).err, Not(HasSubstr("wide")));
}

TEST_F(TearMessages, a_name_that_is_not_glb_is_warned_of) {
  const std::string log = write("one.json", kOneTear);
  const CommandResult result = run_sunder({"tear", model(), "--ops", log, "-o", path("x.fbx")});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err,
              AllOf(HasSubstr("warning: --output"), HasSubstr("x.fbx"), HasSubstr(".glb")));
  EXPECT_THAT(run_sunder({"tear", model(), "--ops", log, "-o", path("x.GLB")}).err,
              Not(HasSubstr("warning")));
}

TEST_F(TearMessages, outputs_that_cannot_be_files_are_refused_before_anything_is_torn) {
  const std::string log = write("one.json", kOneTear);
  const auto expect_refusal = [&](const char* option, const std::string& file, const char* text) {
    std::vector<std::string> arguments = {"tear", model(), "--ops", log, option, file};
    if (option != std::string("-o")) arguments.insert(arguments.end(), {"-o", path("none.glb")});
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, AllOf(HasSubstr(text), Not(HasSubstr("/operations/0"))));
    EXPECT_FALSE(exists("none.glb"));
  };
  std::filesystem::create_directory(path("folder"));
  for (const char* const option : {"-o", "--report", "--save-log", "--picture"}) {
    expect_refusal(option, path("absent/x.glb"), "absent'");
    expect_refusal(option, path("folder"), "is a folder; expected a file");
  }
  expect_refusal("-o", "", "--output: expected the name of a file");
}

TEST_F(TearMessages, a_picture_that_failed_does_not_count_as_written) {
  const std::string log =
      write("nothing.json", R"({"sunder_operations": 1, "operations": []})");  // to be drawn
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", log, "-o", path("m.glb"), "--picture", path("m.jpg")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("m.glb"), Not(HasSubstr("m.jpg"))));
  EXPECT_THAT(result.err, HasSubstr("the file is written as PNG, but its name does not end in"));
}

TEST_F(TearMessages, an_output_may_be_named_vrm_which_is_glb) {
  const std::string log = write("one_vrm.json", kOneTear);
  const CommandResult as_vrm = run_sunder({"tear", model(), "--ops", log, "-o", path("m.vrm")}),
                      as_glb = run_sunder({"tear", model(), "--ops", log, "-o", path("same.glb")});
  EXPECT_EQ(as_vrm.exit_code, as_glb.exit_code) << as_vrm.err;
  EXPECT_THAT(as_vrm.err, Not(HasSubstr("does not end in")));
  EXPECT_EQ(bytes("m.vrm"), bytes("same.glb"));
  EXPECT_EQ(run_sunder({"info", path("m.vrm")}).exit_code, 0);
}

TEST_F(TearMessages, more_influences_than_the_source_has_are_warned_of) {
  const std::string log = write("one.json", kOneTear);
  EXPECT_THAT(tear(log, {"--influences", "8"}).err,
              AllOf(HasSubstr("warning: --influences 8"), HasSubstr("at most 7")));
  EXPECT_THAT(tear(log, {"--influences", "4"}).err, Not(HasSubstr("warning")));
}

/// What was just written passes `sunder validate` without warnings, or writing it said why not.
TEST_F(TearMessages, a_file_that_validate_warns_of_is_announced) {
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{},
                                             {"--open"},
                                             {"--open=baked"},
                                             {"--influences", "4"},
                                             {"--weights-as", "u8"},
                                             {"--weights-as", "u16"},
                                             {"--max-error", "2cm"},
                                             {"--weights", "pose_exact"}}) {
    std::vector<std::string> arguments = {"tear",       model(), "--slash",
                                          "Trunk3@0.5", "-o",    path("announced.glb")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult torn = run_sunder(arguments);
    ASSERT_EQ(torn.exit_code, 0) << torn.err;
    const CommandResult valid = run_sunder({"validate", model(), path("announced.glb")});
    const bool passes = valid.out.find(": 0 errors, 0 warnings") != std::string::npos;
    const bool is_announced = torn.err.find("`sunder validate`") != std::string::npos;
    EXPECT_TRUE(passes || is_announced)
        << (options.empty() ? "plain" : options[0]) << valid.out << torn.err;
    if (options.empty()) {
      EXPECT_TRUE(passes && !is_announced) << valid.out << torn.err;
    }
    EXPECT_THAT(valid.out, testing::ContainsRegex("verdict +(PASS|FAIL): .* worst deviation"));
  }
}

TEST_F(TearMessages, no_output_overwrites_an_input) {
  namespace fs = std::filesystem;
  const std::string log = write("one.json", kOneTear);
  const std::vector<std::byte> before = bytes("cactus.glb");
  fs::remove(path("symbolic.glb")), fs::remove(path("hard.glb"));
  fs::create_symlink("cactus.glb", path("symbolic.glb"));
  fs::create_hard_link(model(), path("hard.glb"));
  fs::create_directory(path("folder"));
  for (const std::string& file :
       {model(), path("symbolic.glb"), path("hard.glb"), path("folder/../cactus.glb"), log})
    for (const char* const option : {"-o", "--report", "--save-log", "--picture"}) {
      std::vector<std::string> arguments = {"tear", model(), "--ops", log, option, file};
      if (option != std::string("-o")) arguments.insert(arguments.end(), {"-o", path("m.glb")});
      const CommandResult result = run_sunder(arguments);
      EXPECT_EQ(result.exit_code, 2) << option << file;
      EXPECT_THAT(result.err, AllOf(HasSubstr("would overwrite"), HasSubstr("--force")));
      EXPECT_THAT(result.out, IsEmpty());
    }
  EXPECT_EQ(bytes("cactus.glb"), before);
  EXPECT_THAT(tear(log, {"--report", path("m.glb"), "--force"}).err,
              HasSubstr("would overwrite the file of --output"));

  fs::copy_file(model(), path("own.glb"), fs::copy_options::overwrite_existing);
  const CommandResult forced =
      run_sunder({"tear", path("own.glb"), "--ops", log, "-o", path("own.glb"), "--force"});
  EXPECT_EQ(forced.exit_code, 0) << forced.err;
  EXPECT_NE(bytes("own.glb"), before);
}

TEST_F(TearMessages, unknown_names_come_with_the_nearest_ones) {
  const CommandResult clip =
      tear(changed("clip.json", {{"pose", {{"clip", "sawy"}, {"time", 0}}}}));
  EXPECT_EQ(clip.exit_code, 2);
  EXPECT_THAT(clip.err, AllOf(HasSubstr("sawy"), HasSubstr("did you mean 'Sway'?")));
  const CommandResult bone =
      tear(changed("bone.json", {{"pose", {{"bones", {{"Trnk2", json::object()}}}}}}));
  EXPECT_EQ(bone.exit_code, 2);
  EXPECT_THAT(bone.err, AllOf(HasSubstr("Trnk2"), HasSubstr("did you mean 'Trunk2'")));
  const CommandResult far =
      tear(changed("far.json", {{"pose", {{"clip", "Zzzzzzzz"}, {"time", 0}}}}));
  EXPECT_THAT(far.err, AllOf(HasSubstr("its clips: 'Sway'"), Not(HasSubstr("did you mean"))));
  const CommandResult refit =
      tear(write("one.json", kOneTear), {"--weights", "refit", "--refit-over", "clips:Swya=2"});
  EXPECT_EQ(refit.exit_code, 2);
  EXPECT_THAT(refit.err, AllOf(HasSubstr("--refit-over"), HasSubstr("'Swya'"),
                               HasSubstr("did you mean 'Sway'?")));
}

TEST_F(TearMessages, weight_errors_are_measured_on_request_on_a_sample) {
  json log = json::parse(kOneTear);
  const CommandResult plain = tear(write("one.json", kOneTear), {"--report", "-"});
  EXPECT_FALSE(json::parse(plain.out).contains("weight_errors"));
  EXPECT_FALSE(json::parse(plain.out)["operations"][0]["weights"].contains("error_max"));
  for (int i = 0; i < 40; ++i) {
    const double y = 0.1 + 0.015 * i;
    log["operations"].push_back(
        {{"op", "cut"}, {"plane", {{"point", {0, y, 0}}, {"normal", {0.1, 1, 0}}}}});
  }
  const std::string many = write("many.json", log.dump());
  const json first =
      json::parse(tear(many, {"--report", "-", "--weight-errors"}).out)["weight_errors"];
  ASSERT_TRUE(first.contains("clips"));
  EXPECT_LT(first["clips"]["points"], first["clips"]["points_of"]);
  EXPECT_LE(first["clips"]["poses"], first["clips"]["poses_of"]);
  EXPECT_EQ(json::parse(tear(many, {"--report", "-", "--weight-errors"}).out)["weight_errors"],
            first);
  EXPECT_EQ(tear(many, {"--weight-errors"}).exit_code, 2);
}

TEST_F(TearMessages, colours_are_for_terminals) {
  const std::string swapped =
      changed("swap.json", stroke([](json& blade) { std::swap(blade["base"], blade["tip"]); }));
  const std::vector<std::string> warned = {"tear", model(), "--ops", swapped, "--dry-run"};
  const std::vector<std::string> failing = {"tear", model(), "--ops", path("no such.json"),
                                            "--dry-run"};
  EXPECT_THAT(test::run_sunder_on_terminal(warned).err, HasSubstr("\x1b[33msunder: warning:"));
  EXPECT_THAT(test::run_sunder_on_terminal(failing).err, HasSubstr("\x1b[31msunder: "));
  EXPECT_THAT(test::run_sunder_on_terminal({"tear"}).err, HasSubstr("\x1b[31m"));
  EXPECT_THAT(test::run_sunder_on_terminal(warned, {{"NO_COLOR", "1"}}).err,
              AllOf(HasSubstr("warning"), Not(HasSubstr("\x1b[3"))));
  EXPECT_THAT(run_sunder(warned).err, AllOf(HasSubstr("warning"), Not(HasSubstr("\x1b"))));
}

}  // namespace
}  // namespace sunder::command_test
