// `sunder tear` with operations that name bones.
#include "support/models/rigs.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using testing::AllOf;

class AimedCommand : public CactusSuite {
 protected:
  static CommandResult tear(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"tear", model(), "-o", path("aimed.glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }
};

TEST_F(AimedCommand, options_are_applied_in_order_after_the_log) {
  const std::string log = write("slash.json", R"({"sunder_operations": 1, "operations": [
      {"op": "slash", "around": "Trunk3", "at": 0.5, "turn": 30, "layers": "all"}]})");
  const CommandResult result =
      tear({"--sever", "Trunk4@0.5", "--slash", "Trunk2@0.5,from=back,length=0.4w,width=0.01",
            "--sever", "Trunk3@0.2,caps=false", "--ops", log, "--report", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json operations = json::parse(result.out)["operations"];
  ASSERT_EQ(operations.size(), 4u);
  EXPECT_EQ(operations[0]["op"], "tear");
  EXPECT_EQ(operations[1]["op"], "cut");
  EXPECT_EQ(operations[1]["caps"], 2);
  EXPECT_EQ(operations[2]["op"], "tear");
  EXPECT_GT(operations[2]["area_removed_posed"].get<double>(), 0.0);
  EXPECT_EQ(operations[3]["op"], "cut");
  EXPECT_EQ(operations[3]["caps"], 0);
  EXPECT_THAT(result.err, HasSubstr("sunder: /operations/0: tear at"));
  EXPECT_THAT(result.err, HasSubstr("sunder: --sever Trunk4@0.5: cut at"));
}

TEST_F(AimedCommand, the_saved_log_is_plain_and_gives_the_same_file) {
  const CommandResult first =
      tear({"--slash", "Trunk3@0.4,turn=40", "--puncture", "Trunk2@0.5,radius=0.02,through",
            "--pose", "Sway@0.8", "--save-log", path("plain.json")});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const json log = read_json("plain.json");
  ASSERT_EQ(log["operations"].size(), 2u);
  EXPECT_EQ(log["operations"][0]["op"], "tear");
  EXPECT_EQ(log["operations"][1]["op"], "drill");
  EXPECT_TRUE(log["operations"][0]["pose"].contains("matrices"));
  const CommandResult second =
      run_sunder({"tear", model(), "--ops", path("plain.json"), "-o", path("again.glb")});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(bytes("aimed.glb"), bytes("again.glb"));
}

TEST_F(AimedCommand, lengths_have_units_shares_per_cent_and_materials_indices) {
  const auto result_of = [](const std::string& slash, const std::string& sever) {
    const CommandResult result =
        tear({"--slash", slash, "--sever", sever, "--save-log", path("units.json"), "--force"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return std::pair(bytes("units.json"), bytes("aimed.glb"));
  };
  const auto plain =
      result_of("Trunk2@0.25,wall_depth=0.01,wall_material=1", "Trunk3@0.5,cap_material=0");
  EXPECT_EQ(plain,
            result_of("Trunk2@25%,wall_depth=10mm,wall_material=1", "Trunk3@50%,cap_material=0"));
  EXPECT_EQ(plain,
            result_of("Trunk2@0.25,wall_depth=1 cm,wall_material=1", "Trunk3@0.5,cap_material=0"));
  EXPECT_NE(plain,
            result_of("Trunk2@0.25,wall_depth=0.01,wall_material=0", "Trunk3@0.5,cap_material=1"));
  EXPECT_EQ(plain, result_of("Trunk2@0.25,wall_depth=0.01,wall_material=Flower",
                             "Trunk3@0.5,cap_material=Flesh"));
}

TEST_F(AimedCommand, every_length_may_be_in_widths_of_the_limb_and_angles_in_degrees) {
  const auto log_of = [](const std::string& slash) {
    const CommandResult result = tear({"--slash", slash, "--save-log", path("w.json"), "--force"});
    EXPECT_EQ(result.exit_code, 0) << slash << result.err;
    return read_json("w.json")["operations"][0];
  };
  EXPECT_EQ(log_of("Trunk3@0.5,length=50%,turn=30deg"), log_of("Trunk3@0.5,length=0.5w,turn=30"));
  EXPECT_EQ(log_of("Trunk3@0.5,depth=20%"), log_of("Trunk3@0.5,depth=0.2w"));
  const json log = log_of("Trunk3@0.5,width=2%,wall_depth=0.1w,lip_roll=0.01w");
  // One is a fifth of the other, whatever the limb's width is.
  EXPECT_NEAR(log["width"].get<double>(), 0.2 * log["wall_depth"].get<double>(), 1e-9);
  EXPECT_NEAR(log["lip_roll"].get<double>(), 0.1 * log["wall_depth"].get<double>(), 1e-9);
  EXPECT_EQ(log_of("Trunk3@0.5,width=10mm"), log_of("Trunk3@0.5,width=1 cm"));
}

TEST_F(AimedCommand, logs_name_materials_as_info_prints_them) {
  const auto torn = [](const std::string& material) {
    const std::string log = write("materials.json", R"({"sunder_operations": 1, "operations": [
      {"op": "sever", "bone": "Trunk3", "at": 0.5, "cap_material": )" +
                                                        material +
                                                        R"(},
      {"op": "slash", "around": "Trunk2", "at": 0.5, "wall_depth": 0.01, "wall_material": )" +
                                                        material + "}]}");
    return tear({"--ops", log});
  };
  const CommandResult by_index = torn("1");
  ASSERT_EQ(by_index.exit_code, 0) << by_index.err;
  const auto expected = bytes("aimed.glb");
  const CommandResult by_name = torn("\"Flower\"");
  ASSERT_EQ(by_name.exit_code, 0) << by_name.err;
  EXPECT_EQ(bytes("aimed.glb"), expected);
  const CommandResult unknown = torn("\"Flowre\"");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("materials.json: /operations/0/cap_material: the model has no "
                                     "material 'Flowre'; did you mean 'Flower'?"));
  const CommandResult absent = torn("99");
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_THAT(absent.err, HasSubstr("/operations/0: cap_material is 99; it must be from 0 to 3"));
}

TEST_F(AimedCommand, sizes_beyond_the_limb_are_refused_with_the_range) {
  const auto refusal = [](const std::string& option, const std::string& text) {
    const CommandResult result = tear({option, text});
    EXPECT_EQ(result.exit_code, 2) << text;
    return result.err;
  };
  for (const char* const field : {"length", "depth", "width", "wall_depth", "lip_roll"}) {
    const std::string name = field;
    EXPECT_THAT(refusal("--slash", "Trunk3@0.5," + name + "=20"),
                AllOf(HasSubstr(name + " is 20 m; it must be at most "), HasSubstr("limb")));
    EXPECT_THAT(refusal("--slash", "Trunk3," + name + "=20"), HasSubstr(name + " is 20 m"))
        << "no other share is tried";
    EXPECT_THAT(refusal("--slash", "Trunk3@0.5," + name + "=-1"),
                HasSubstr(name + " is -1 m; it must be "));
    for (const char* const odd : {"nan", "inf", "3kg", ""})
      EXPECT_THAT(refusal("--slash", "Trunk3@0.5," + name + "=" + odd),
                  HasSubstr(name + ": '" + odd + "' is no number; expected one, with m, cm, mm"));
    EXPECT_THAT(refusal("--slash", "Trunk3@0.5," + name + "=1e31"),
                HasSubstr(name + " is 1e+31 m; it must be "));
  }
  for (const char* const field : {"radius", "depth"})
    EXPECT_THAT(refusal("--puncture", std::string("Trunk3@0.5,") + field + "=20"),
                HasSubstr(std::string(field) + " is 20 m; it must be at most "));
  EXPECT_THAT(refusal("--puncture", "Trunk3@0.5,radius=0.02,chord_tolerance=1e-300"),
              HasSubstr("chord_tolerance is 1e-300 m; it must be from 5e-08 to 0.02 m, or 0"));
  EXPECT_FALSE(exists("aimed.glb.tmp"));
}

/// Clips in logs are found without their namespace, as those of --pose.
TEST_F(AimedCommand, logs_name_clips_without_their_namespace) {
  Character cactus = tools::make_cactus();
  cactus.clips[0].name = "Rig|Sway";
  ASSERT_TRUE(save_glb(path("spaced.glb"), cactus));
  const auto torn = [&](const char* clip) {
    const std::string log = write("clip.json", std::string(R"({"sunder_operations": 1,
      "operations": [{"op": "cut", "plane": {"point": [0, 1, 0], "normal": [0, 1, 0]}, "pose": {"clip": ")") +
                                                   clip + R"(", "time": 0.8}}]})");
    const CommandResult result =
        run_sunder({"tear", path("spaced.glb"), "--ops", log, "-o", path("spaced_torn.glb")});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes("spaced_torn.glb");
  };
  EXPECT_EQ(torn("Sway"), torn("Rig|Sway"));
}

TEST_F(AimedCommand, faults_name_the_option) {
  const auto expect_refusal = [](const std::vector<std::string>& options, const char* text) {
    const CommandResult result = tear(options);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_FALSE(exists("aimed.glb.tmp"));
  };
  expect_refusal({}, "--ops (or --slash");
  expect_refusal({"--pose", "rest"}, "--pose: needs --slash");
  expect_refusal({"--slash", "Trunk3@0.5,lenght=1"},
                 "unknown field 'lenght'; did you mean 'length'?");
  expect_refusal({"--slash", "Trunk3@1.5"},
                 "--slash Trunk3@1.5: at is 1.5; it must be from 0 to 1");
  expect_refusal({"--slash", "Trunk3@0.5,turn=1,turn=2"}, "'turn' is given twice");
  expect_refusal({"--slash", "Trunk3@0.5,from=above"}, "unknown side 'above'");
  expect_refusal({"--sever", "Trunc3@0.5"},
                 "--sever Trunc3@0.5: no bone is named 'Trunc3'; did you mean 'Trunk3'");
  expect_refusal({"--sever", "Trunk3@0.5", "--pose", "Swai@0.5"}, "did you mean 'Sway'?");
  for (const char* const pose : {"Sway", "Sway@", "Sway@-1", "Sway@nan", "Sway@inf", "", "Rest"})
    expect_refusal({"--sever", "Trunk3@0.5", "--pose", pose},
                   "is no pose; expected rest, bind or CLIP@TIME");
  expect_refusal({"--sever", "Trunk3@0.5,pose=bind"}, "'pose' is no field; give it as --pose");
  expect_refusal({"--slash", "Trunk3@0.5,turn=nan"},
                 "turn: 'nan' is no number; expected one, with or without deg behind it");
  expect_refusal({"--slash", "Trunk3@0.5,turn=10mm"}, "turn: '10mm' is no number");
  expect_refusal({"--slash", "Trunk3@150%"},
                 "--slash Trunk3@150%: at is 1.5; it must be from 0 to 1");
  expect_refusal({"--sever", "Trunk3@0.5,cap_material=leaf"},
                 "--sever Trunk3@0.5,cap_material=leaf: the model has no material 'leaf'");
  expect_refusal({"--slash", "Trunk3@0.5,wall_depth=1mm,wall_material=99"},
                 "wall_material is 99; it must be from 0 to 3");
}

/// Clips are found without their namespace: such a clip is no reason for another failure.
TEST_F(AimedCommand, a_fault_of_the_bone_does_not_blame_the_clip) {
  Character cactus = tools::make_cactus();
  cactus.clips[0].name = "Rig|Sway";
  ASSERT_TRUE(save_glb(path("namespace.glb"), cactus));
  const CommandResult result = run_sunder(
      {"tear", path("namespace.glb"), "--dry-run", "--sever", "Qqqq@0.5", "--pose", "Sway@0.2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("no bone is named 'Qqqq'"));
  EXPECT_THAT(result.err, HasSubstr("`sunder info MODEL --bones` lists the bones"));
  EXPECT_THAT(result.err, testing::Not(HasSubstr("did you mean")));
}

TEST_F(AimedCommand, logs_name_the_operation_that_misses) {
  const std::string log = write("unknown.json", R"({"sunder_operations": 1, "operations": [
      {"op": "sever", "bone": "Trunk3", "at": 0.5}, {"op": "sever", "bone": "Arm"}]})");
  const CommandResult result = tear({"--ops", log});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("unknown.json: /operations/1: no bone is named 'Arm'"));
}

TEST_F(AimedCommand, keep_going_leaves_out_what_cannot_be_applied) {
  const CommandResult stopped =
      tear({"--sever", "Trunc3@0.5", "--slash", "Trunk2@0.5", "--report", "-"});
  EXPECT_EQ(stopped.exit_code, 2);
  const CommandResult result = tear({"--keep-going", "--sever", "Trunc3@0.5", "--slash",
                                     "Trunk2@0.5", "--report", path("going.json")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("no bone is named 'Trunc3'"));
  const json operations = read_json("going.json")["operations"];
  ASSERT_EQ(operations.size(), 1u);
  EXPECT_EQ(operations[0]["op"], "tear");
  const CommandResult summary = tear({"--keep-going", "--sever", "Trunc3", "--slash", "Trunk2"});
  EXPECT_THAT(summary.out, HasSubstr("1 done, 1 left out"));
  EXPECT_EQ(tear({"--keep-going", "--slash", "Trunk2"}).exit_code, 0);
}

TEST_F(AimedCommand, a_severed_limb_is_taken_off_and_written) {
  const auto operations_of = [](const std::vector<std::string>& options) {
    std::vector<std::string> all = {"--report", path("off.json"), "--force"};
    all.insert(all.end(), options.begin(), options.end());
    const CommandResult result = tear(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const json report = read_json("off.json");
    std::vector<std::string> names;
    for (const json& operation : report["operations"]) names.push_back(operation["op"]);
    return names;
  };
  using testing::ElementsAre;
  EXPECT_THAT(operations_of({"--sever", "Trunk4@0.5"}), ElementsAre("cut"));
  EXPECT_THAT(operations_of({"--sever", "Trunk4@0.5,detach"}), ElementsAre("cut", "detach"));
  EXPECT_THAT(operations_of({"--sever", "Trunk4@0.5,detach=false", "--pieces", path("kept")}),
              ElementsAre("cut"));
  EXPECT_FALSE(exists("kept1.glb"));
  EXPECT_THAT(operations_of({"--sever", "Trunk4@0.5,parts=none", "--pieces", path("top")}),
              ElementsAre("cut", "detach"));
  EXPECT_TRUE(exists("top1.glb"));
  EXPECT_FALSE(exists("top2.glb"));
  EXPECT_THAT(operations_of({"--sever", "Trunk4@0.5,detach", "--picture", path("off.png")}),
              ElementsAre("cut", "detach"));
  EXPECT_TRUE(exists("off.png"));
  const CommandResult parts = tear({"--sever", "Trunk4@0.5,parts=some"});
  EXPECT_EQ(parts.exit_code, 2);
  EXPECT_THAT(parts.err, HasSubstr("parts: expected all or none"));
  EXPECT_THAT(tear({"--sever", "Trunk4@0.5,detach=maybe"}).err, HasSubstr("detach: expected"));
  EXPECT_THAT(tear({"--slash", "Trunk4@0.5,detach"}).err, HasSubstr("unknown field 'detach'"));
}

TEST_F(AimedCommand, a_limb_of_blocks_is_taken_off_without_a_cut) {
  ASSERT_TRUE(save_glb(path("blocks.glb"), test::make_block_figure()));
  const auto tear_head = [](const char* sever) {
    return run_sunder({"tear", path("blocks.glb"), "-o", path("headless.glb"), "--force", "--sever",
                       sever, "--report", path("headless.json")});
  };
  const CommandResult whole = tear_head("head,detach");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.err, HasSubstr("comes off without a cut"));
  const json operations = read_json("headless.json")["operations"];
  ASSERT_EQ(operations.size(), 1u);
  EXPECT_EQ(operations[0]["op"], "detach");
  EXPECT_EQ(tear_head("head@0.3,detach").exit_code, 0);
  EXPECT_EQ(read_json("headless.json")["operations"][0]["op"], "cut");
  EXPECT_EQ(tear_head("head,detach,tilt=10").exit_code, 0);
  EXPECT_EQ(read_json("headless.json")["operations"][0]["op"], "cut") << "a tilt asks for a cut";
  EXPECT_THAT(tear_head("head,detach,cap_material=7").err, HasSubstr("material"));
  const CommandResult cut = tear_head("head");
  EXPECT_EQ(cut.exit_code, 2);
  EXPECT_THAT(cut.err, HasSubstr("--sever head,detach takes them off"));
}

TEST_F(AimedCommand, says_where_the_character_faces) {
  const auto stroke_of = [](const std::vector<std::string>& options) {
    std::vector<std::string> all = {"--save-log", path("facing.json"), "--force"};
    all.insert(all.end(), options.begin(), options.end());
    const CommandResult result = tear(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_json("facing.json")["operations"][0]["stroke"];
  };
  const json back = stroke_of({"--slash", "Trunk2@0.5,from=back"});
  EXPECT_NE(stroke_of({"--slash", "Trunk2@0.5"}), back);
  EXPECT_EQ(stroke_of({"--slash", "Trunk2@0.5", "--facing", "-z"}), back);
  EXPECT_EQ(stroke_of({"--slash", "Trunk2@0.5,from=front", "--facing", "0/0/-3"}), back);
  const CommandResult uncertain = tear({"--slash", "Trunk2@0.5"});
  EXPECT_THAT(uncertain.err, HasSubstr("which way the character faces is uncertain"));
  EXPECT_THAT(tear({"--slash", "Trunk2@0.5", "--facing", "+z"}).err,
              testing::Not(HasSubstr("uncertain")));
  for (const char* const direction : {"up", "0/1/0", "1/2", "+y", ""})
    EXPECT_THAT(tear({"--slash", "Trunk2@0.5", "--facing", direction}).err,
                HasSubstr("is no direction"));
}

}  // namespace
}  // namespace sunder::command_test
