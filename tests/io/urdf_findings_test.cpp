// Each code that loading a URDF file can find, and what it makes of the robot.

#include <sunder/io/robot_file.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/urdf/finding_kinds.h"
#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Loaded {
  Result<LoadedRobot> robot = Status();
  std::vector<RobotFinding> findings;
};

Loaded load(const std::string& text, const RobotLoadOptions& options = {}) {
  const TemporaryFolder folder;
  Loaded loaded;
  loaded.robot = load_robot(folder.write("robot.urdf", text), options, &loaded.findings);
  return loaded;
}

std::string robot(const std::string& content) {
  return "<robot name=\"r\">\n" + content + "</robot>\n";
}

/// Links a, b and c, and joints j between a and b, k between b and c.
std::string arm(const std::string& of_j, const std::string& of_k = "",
                const std::string& type = "revolute") {
  const auto joint = [&](const char* name, const char* ends, const std::string& content) {
    return std::string("<joint name=\"") + name + "\" type=\"" + type + "\">" + ends + content +
           "</joint>\n";
  };
  return robot("<link name=\"a\"/>\n<link name=\"b\"/>\n<link name=\"c\"/>\n" +
               joint("j", "<parent link=\"a\"/><child link=\"b\"/>", of_j) +
               joint("k", "<parent link=\"b\"/><child link=\"c\"/>", of_k));
}

const std::string kLimit = "<limit lower=\"-1\" upper=\"2\" effort=\"1\" velocity=\"1\"/>";

std::string link_with(const std::string& visual) {
  return robot("<link name=\"a\"><visual>" + visual + "</visual></link>\n");
}

std::string mesh_named(const std::string& filename) {
  return link_with("<geometry><mesh filename=\"" + filename + "\"/></geometry>");
}

auto has(std::string_view code, RobotSeverity severity) {
  return Contains(
      testing::AllOf(Field(&RobotFinding::code, code), Field(&RobotFinding::severity, severity)));
}

const RobotFinding& finding(const Loaded& loaded, std::string_view code) {
  const auto found = std::find_if(loaded.findings.begin(), loaded.findings.end(),
                                  [&](const RobotFinding& f) { return f.code == code; });
  static const RobotFinding none;
  EXPECT_NE(found, loaded.findings.end()) << code;
  return found == loaded.findings.end() ? none : *found;
}

// ---- The text, the tree, numbers: refused

struct Refused {
  std::string_view code;
  StatusCode status;
  std::uint32_t line;  ///< 0: of the file.
  std::string text;
};

class RefusedUrdf : public testing::TestWithParam<Refused> {};

TEST_P(RefusedUrdf, is_an_error_with_code_and_line) {
  const Refused& expected = GetParam();
  const Loaded loaded = load(expected.text);
  ASSERT_FALSE(loaded.robot);
  EXPECT_EQ(loaded.robot.error().code(), expected.status) << loaded.robot.error().text();
  EXPECT_THAT(loaded.findings, has(expected.code, RobotSeverity::error));
  EXPECT_EQ(finding(loaded, expected.code).line, expected.line)
      << finding(loaded, expected.code).text;
  EXPECT_FALSE(finding(loaded, expected.code).text.empty());
}

std::string nested(std::size_t depth) {
  std::string text;
  for (std::size_t i = 0; i < depth; ++i) text += "<x>";
  for (std::size_t i = 0; i < depth; ++i) text += "</x>";
  return text;
}

const std::string kJoint =
    "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>\n";
const std::string kOther =
    "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/></joint>\n";
const std::string kLinks = "<link name=\"a\"/>\n<link name=\"b\"/>\n<link name=\"c\"/>\n";

INSTANTIATE_TEST_SUITE_P(
    text, RefusedUrdf,
    testing::Values(
        Refused{"xml_too_deep", StatusCode::limit_exceeded, 2, robot(nested(100))},
        Refused{"xml_too_deep", StatusCode::limit_exceeded, 2, robot(nested(200'000))},
        Refused{"xml_too_large", StatusCode::limit_exceeded, 1,
                "<robot name=\"r\">" +
                    [] {
                      std::string tags;
                      for (int i = 0; i < 600'000; ++i) tags += "<a/>";
                      return tags;
                    }() +
                    "</robot>"},
        Refused{"xml_malformed", StatusCode::malformed_file, 0, ""},
        Refused{"xml_malformed", StatusCode::malformed_file, 0, std::string("<robot\0>", 8)},
        Refused{"xml_malformed", StatusCode::malformed_file, 0, "\xFF\xFE<\0r\0"},
        Refused{"xml_malformed", StatusCode::malformed_file, 1, "<robot"},
        Refused{"xml_malformed", StatusCode::malformed_file, 1, "<!-- a comment"},
        Refused{"xml_malformed", StatusCode::malformed_file, 1,
                "<robot name=\"r\"><link name=\"a\"></robot>"},
        Refused{"xml_entity", StatusCode::unsupported_feature, 2,
                "<?xml version=\"1.0\"?>\n<!DOCTYPE robot [<!ENTITY a \"aaaaaaaaaa\">"
                "<!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>\n<robot name=\"&b;\"/>"},
        Refused{"not_urdf", StatusCode::unsupported_format, 2,
                "<?xml version=\"1.0\"?>\n<sdf version=\"1.6\"><model name=\"m\"/></sdf>"},
        Refused{"xacro_not_expanded", StatusCode::unsupported_feature, 2,
                robot("<xacro:include filename=\"a.xacro\"/>\n" + kLinks)},
        Refused{"xacro_not_expanded", StatusCode::unsupported_feature, 2,
                link_with("<geometry><box size=\"${width} 1 1\"/></geometry>")},
        Refused{"xacro_not_expanded", StatusCode::unsupported_feature, 2,
                mesh_named("$(find robot)/a.stl")},
        Refused{"name_missing", StatusCode::malformed_file, 2, robot("<link/>\n")},
        Refused{"name_missing", StatusCode::malformed_file, 5,
                robot(kLinks +
                      "<joint type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/>"
                      "</joint>\n" +
                      kOther)},
        Refused{"duplicate_name", StatusCode::malformed_file, 5,
                robot(kLinks + "<link name=\"a\"/>\n" + kJoint + kOther)},
        Refused{"duplicate_name", StatusCode::malformed_file, 6,
                robot(kLinks + kJoint +
                      "<joint name=\"j\" type=\"fixed\"><parent link=\"b\"/>"
                      "<child link=\"c\"/></joint>\n")}));

INSTANTIATE_TEST_SUITE_P(
    tree, RefusedUrdf,
    testing::Values(
        Refused{"no_link", StatusCode::empty_input, 0, "<robot name=\"r\"/>"},
        Refused{"joint_incomplete", StatusCode::malformed_file, 6,
                robot(kLinks + kJoint +
                      "<joint name=\"k\" type=\"fixed\"><child link=\"c\"/></joint>\n")},
        Refused{"link_missing", StatusCode::not_found, 6,
                robot(kLinks + kJoint +
                      "<joint name=\"k\" type=\"fixed\"><parent link=\"z\"/>"
                      "<child link=\"c\"/></joint>\n")},
        Refused{"joint_type_unknown", StatusCode::unsupported_feature, 5, arm("", "", "spherical")},
        Refused{"two_parents", StatusCode::not_a_tree, 4,
                robot(kLinks + kJoint + kOther +
                      "<joint name=\"l\" type=\"fixed\"><parent link=\"a\"/><child link=\"c\"/>"
                      "</joint>\n")},
        Refused{"several_roots", StatusCode::not_a_tree, 4, robot(kLinks + kJoint)},
        Refused{"circle", StatusCode::not_a_tree, 2,
                robot(kLinks + kJoint + kOther +
                      "<joint name=\"l\" type=\"fixed\"><parent link=\"c\"/><child link=\"a\"/>"
                      "</joint>\n")},
        Refused{"circle", StatusCode::not_a_tree, 3,
                robot(kLinks + kOther +
                      "<joint name=\"l\" type=\"fixed\"><parent link=\"c\"/><child link=\"b\"/>"
                      "</joint>\n")},
        Refused{"axis_zero", StatusCode::invalid_argument, 5,
                arm(kLimit + "<axis xyz=\"0 0 0\"/>", kLimit)}));

INSTANTIATE_TEST_SUITE_P(
    numbers, RefusedUrdf,
    testing::Values(Refused{"number_not_finite", StatusCode::non_finite_value, 5,
                            arm(kLimit + "<axis xyz=\"nan 0 1\"/>", kLimit)},
                    Refused{"number_not_finite", StatusCode::non_finite_value, 5,
                            arm(kLimit + "<origin xyz=\"inf 0 1\"/>", kLimit)},
                    Refused{"number_not_finite", StatusCode::non_finite_value, 5,
                            arm(kLimit + "<origin rpy=\"1e999 0 1\"/>", kLimit)},
                    Refused{"number_not_finite", StatusCode::non_finite_value, 5,
                            arm(kLimit + "<origin xyz=\"0 1e39 0\"/>", kLimit)},
                    Refused{"number_not_finite", StatusCode::non_finite_value, 5,
                            arm("<limit lower=\"1e39\" upper=\"1e40\"/>", kLimit, "prismatic")},
                    Refused{"number_malformed", StatusCode::malformed_file, 5,
                            arm(kLimit + "<origin xyz=\"0,5 0 1\"/>", kLimit)},
                    Refused{"number_malformed", StatusCode::malformed_file, 5,
                            arm(kLimit + "<origin xyz=\"0.5abc 0 1\"/>", kLimit)},
                    Refused{"number_malformed", StatusCode::malformed_file, 5,
                            arm(kLimit + "<origin xyz=\"1 2\"/>", kLimit)},
                    Refused{
                        "number_malformed", StatusCode::malformed_file, 5,
                        arm("<limit lower=\"\" upper=\"1\" effort=\"1\" velocity=\"1\"/>", kLimit)},
                    Refused{"number_malformed", StatusCode::malformed_file, 2,
                            link_with("<geometry><sphere/></geometry>")}));

// ---- Warnings, which strict options refuse

struct Warned {
  std::string_view code;
  std::string place;
  std::string text;
};

class WarnedUrdf : public testing::TestWithParam<Warned> {};

TEST_P(WarnedUrdf, loads_and_is_refused_by_strict_options) {
  const Warned& expected = GetParam();
  const Loaded loaded = load(expected.text);
  ASSERT_TRUE(loaded.robot) << loaded.robot.error().text();
  EXPECT_THAT(loaded.findings, has(expected.code, RobotSeverity::warning));
  EXPECT_EQ(finding(loaded, expected.code).place, expected.place);
  EXPECT_GT(finding(loaded, expected.code).line, 0u);
  EXPECT_TRUE(validate_robot(loaded.robot->robot));
  RobotLoadOptions strict;
  strict.strict = true;
  const Loaded refused = load(expected.text, strict);
  EXPECT_FALSE(refused.robot);
  EXPECT_THAT(refused.findings, has(expected.code, RobotSeverity::error));
}

std::string limit(const char* lower, const char* upper) {
  return std::string("<limit lower=\"") + lower + "\" upper=\"" + upper +
         "\" effort=\"1\" velocity=\"1\"/>";
}

INSTANTIATE_TEST_SUITE_P(
    joints, WarnedUrdf,
    testing::Values(
        Warned{"axis_not_unit", "joint 'j'", arm(kLimit + "<axis xyz=\"0 0 5\"/>", kLimit)},
        Warned{"limits_missing", "joint 'k'", arm(kLimit, "")},
        Warned{"limits_missing", "joint 'j'", arm("", kLimit, "prismatic")},
        Warned{"limits_inverted", "joint 'j'", arm(limit("2", "-1"), kLimit)},
        Warned{"limits_zero", "joint 'j'", arm(limit("0", "0"), kLimit)},
        Warned{"limits_zero", "joint 'j'", arm("<limit effort=\"1\" velocity=\"1\"/>", kLimit)},
        Warned{"mimic_broken_reference", "joint 'k'", arm(kLimit, kLimit + "<mimic joint=\"z\"/>")},
        Warned{"mimic_self", "joint 'k'", arm(kLimit, kLimit + "<mimic joint=\"k\"/>")},
        Warned{"mimic_chain", "joint 'j'",
               arm(kLimit + "<mimic joint=\"k\"/>", kLimit + "<mimic joint=\"j\"/>")},
        Warned{"mimic_unsupported", "joint 'k'", arm("", "<mimic joint=\"j\"/>", "planar")},
        Warned{"tag_repeated", "joint 'j'", arm(kLimit + limit("-3", "3"), kLimit)},
        Warned{"tag_repeated", "joint 'k'",
               arm(kLimit, kLimit + "<axis xyz=\"0 0 1\"/><axis xyz=\"0 1 0\"/>")},
        Warned{"tag_repeated", "", robot("<link name=\"a\"/>") + robot("<link name=\"b\"/>")},
        Warned{"quaternion_ignored", "joint 'j'",
               arm(kLimit + "<origin xyz=\"1 0 0\" quat_xyzw=\"1 0 0 0\"/>", kLimit)}));

INSTANTIATE_TEST_SUITE_P(
    shapes, WarnedUrdf,
    testing::Values(
        Warned{"geometry_missing", "link 'a'", link_with("<origin xyz=\"0 0 1\"/>")},
        Warned{"geometry_unknown", "link 'a'",
               link_with("<geometry><capsule radius=\"1\" length=\"2\"/></geometry>")},
        Warned{"tag_repeated", "link 'a'",
               link_with("<geometry><box size=\"1 1 1\"/><sphere radius=\"1\"/></geometry>")},
        Warned{"tag_repeated", "link 'a'",
               link_with("<geometry><box size=\"1 1 1\"/></geometry><origin xyz=\"0 0 1\"/>"
                         "<origin xyz=\"0 0 2\"/>")},
        Warned{"geometry_size", "link 'a'",
               link_with("<geometry><box size=\"1 1 -1\"/></geometry>")},
        Warned{"geometry_size", "link 'a'",
               link_with("<geometry><box size=\"1 1e300 1\"/></geometry>")},
        Warned{"package_unknown", "link 'a'", mesh_named("package://nowhere/a.stl")},
        Warned{"mesh_not_found", "link 'a'", mesh_named("a.stl")},
        Warned{"mesh_not_found", "link 'a'", mesh_named("")},
        Warned{"mesh_path_not_allowed", "link 'a'", mesh_named("../../../../etc/passwd")},
        Warned{"mesh_path_not_allowed", "link 'a'", mesh_named("/etc/passwd")},
        Warned{"mesh_path_not_allowed", "link 'a'", mesh_named("file:///etc/passwd")},
        Warned{"mesh_path_not_allowed", "link 'a'", mesh_named("http://example.com/a.stl")},
        Warned{"mesh_path_not_allowed", "link 'a'", mesh_named("package://../a.stl")},
        Warned{"mesh_unreadable", "link 'a'", mesh_named("robot.urdf")},
        Warned{"mesh_scale_zero", "link 'a'",
               link_with("<geometry><mesh filename=\"a.stl\" scale=\"1 0 1\"/></geometry>")}));

TEST(UrdfFindings, a_mimic_of_a_fixed_joint_stands_still) {
  const Loaded loaded =
      load(robot(kLinks + kJoint +
                 "<joint name=\"k\" type=\"prismatic\"><parent link=\"b\"/>"
                 "<child link=\"c\"/><axis xyz=\"0 0 1\"/>" +
                 kLimit + "<mimic joint=\"j\" multiplier=\"3\" offset=\"0.5\"/></joint>\n"));
  ASSERT_TRUE(loaded.robot) << loaded.robot.error().text();
  EXPECT_THAT(loaded.findings, has("mimic_fixed_target", RobotSeverity::warning));
  EXPECT_THAT(loaded.robot->robot.values, IsEmpty());
  EXPECT_EQ(loaded.robot->robot.joints[1].offset, 0.5);
  EXPECT_EQ(loaded.robot->robot.joints[1].first_value, kNone);
}

TEST(UrdfFindings, chains_of_mimic_joints_are_resolved) {
  const std::string joint_l =
      "<joint name=\"l\" type=\"revolute\"><parent link=\"c\"/>"
      "<child link=\"d\"/>" +
      kLimit + "<mimic joint=\"k\" multiplier=\"3\" offset=\"5\"/></joint>\n";
  std::string text = arm(kLimit, kLimit + "<mimic joint=\"j\" multiplier=\"-2\" offset=\"1\"/>");
  text.insert(text.find("</robot>"), "<link name=\"d\"/>\n" + joint_l);
  const Loaded loaded = load(text);
  ASSERT_TRUE(loaded.robot) << loaded.robot.error().text();
  EXPECT_THAT(loaded.findings, has("mimic_chain_resolved", RobotSeverity::information));
  const Robot& robot = loaded.robot->robot;
  ASSERT_EQ(robot.values.size(), 1u);
  EXPECT_EQ(robot.joints[2].mimicked_joint, 1u);
  EXPECT_EQ(robot.joints[2].first_value, 0u);
  EXPECT_EQ(robot.joints[2].multiplier, -6.0);
  EXPECT_EQ(robot.joints[2].offset, 8.0);
}

TEST(UrdfFindings, repaired_limits_are_those_that_the_text_says) {
  Loaded loaded = load(arm("", limit("2", "-1")));
  ASSERT_TRUE(loaded.robot);
  const Robot& robot = loaded.robot->robot;
  EXPECT_EQ(robot.joints[0].type, RobotJointType::continuous);
  EXPECT_TRUE(std::isinf(robot.values[0].upper));
  EXPECT_EQ(robot.values[1].lower, -1.0);
  EXPECT_EQ(robot.values[1].upper, 2.0);
  loaded = load(arm(limit("0.5", "2"), limit("-2", "-0.5")));
  ASSERT_TRUE(loaded.robot);
  EXPECT_EQ(rest_values(loaded.robot->robot), (std::vector<double>{0.5, -0.5}));
}

TEST(UrdfFindings, of_repeated_tags_the_first_counts) {
  const Loaded loaded = load(
      arm(kLimit + "<limit lower=\"-9\" upper=\"9\"/><axis xyz=\"0 0 1\"/><axis xyz=\"0 1 0\"/>"
                   "<origin xyz=\"1 0 0\"/><origin xyz=\"2 0 0\"/>",
          kLimit + "<mimic joint=\"j\" multiplier=\"2\"/><mimic joint=\"k\" multiplier=\"3\"/>"));
  ASSERT_TRUE(loaded.robot) << loaded.robot.error().text();
  const std::vector<RobotJoint>& joints = loaded.robot->robot.joints;
  EXPECT_EQ(joints[0].axis, Vec3d(0, 0, 1));
  EXPECT_EQ(joints[0].upper, 2.0);
  EXPECT_EQ(joints[0].parent_from_joint.translation(), Vec3d(1, 0, 0));
  EXPECT_EQ(joints[1].multiplier, 2.0);
  EXPECT_EQ(std::count_if(loaded.findings.begin(), loaded.findings.end(),
                          [](const RobotFinding& f) { return f.code == "tag_repeated"; }),
            4);
}

TEST(UrdfFindings, faults_of_xml_are_told_in_words) {
  for (const char* text : {"<robot name=\"r\"><link name=\"a\"></robot></link>",
                           "<robot name=\"r\"><link name=\"a\" name=\"b\"/></robot>",
                           "<robot name=\"r\"><link name=\"a\"/>", "<robot>text",
                           "<!-- a --><?xml version=\"1.0\"?><robot name=\"r\"/>"}) {
    const Loaded loaded = load(text);
    EXPECT_FALSE(loaded.robot);
    EXPECT_THAT(finding(loaded, "xml_malformed").text, Not(HasSubstr("XML_"))) << text;
  }
}

TEST(UrdfFindings, too_many_links_in_a_row_name_the_link) {
  const auto chain = [](int links, const std::string& of_first) {
    std::string text = "<link name=\"l0\">" + of_first + "</link>\n";
    for (int i = 1; i < links; ++i) {
      const std::string self = std::to_string(i), parent = std::to_string(i - 1);
      text += "<link name=\"l" + self + "\"/><joint name=\"j" + self +
              "\" type=\"fixed\"><parent link=\"l" + parent + "\"/><child link=\"l" + self +
              "\"/></joint>\n";
    }
    return robot(text);
  };
  const std::string box = "<visual><geometry><box size=\"1 1 1\"/></geometry></visual>";
  EXPECT_TRUE(load(chain(1024, box)).robot);
  EXPECT_TRUE(load(chain(1025, "")).robot);
  const Loaded refused = load(chain(1025, box));
  ASSERT_FALSE(refused.robot);
  EXPECT_EQ(refused.robot.error().code(), StatusCode::limit_exceeded);
  EXPECT_THAT(refused.robot.error().text(), HasSubstr("link 'l1024'"));
}

TEST(UrdfFindings, ignored_tags_are_told_once_each) {
  const Loaded loaded = load(robot(
      kLinks + kJoint + kOther +
      "<transmission name=\"t\"/><transmission name=\"u\"/><gazebo reference=\"a\"/><gazebo/>\n"));
  ASSERT_TRUE(loaded.robot);
  const auto count = std::count_if(loaded.findings.begin(), loaded.findings.end(),
                                   [](const RobotFinding& f) { return f.code == "tag_ignored"; });
  EXPECT_EQ(count, 2);
  EXPECT_THAT(loaded.findings, has("tag_ignored", RobotSeverity::information));
}

TEST(UrdfFindings, other_information_refuses_nothing_even_if_strict) {
  RobotLoadOptions strict;
  strict.strict = true;
  const auto expect = [&](std::string_view code, const std::string& text) {
    const Loaded loaded = load(text, strict);
    EXPECT_TRUE(loaded.robot) << code << ": " << loaded.robot.error().text();
    EXPECT_THAT(loaded.findings, has(code, RobotSeverity::information));
  };
  expect("xml_encoding", "<!-- J\xFCrgen -->" + robot("<link name=\"a\"/>"));
  expect("limits_ignored", arm(kLimit, "", "continuous"));
  expect("geometry_empty", link_with("<geometry><sphere radius=\"0\"/></geometry>"));
  expect("geometry_empty", link_with("<geometry><sphere radius=\"1e-50\"/></geometry>"));
  expect("material_unknown", link_with("<geometry><sphere radius=\"1\"/></geometry>"
                                       "<material name=\"red\"/>"));
}

TEST(UrdfFindings, inertia_never_refuses) {
  const std::string link = "<link name=\"a\"><inertial>";
  for (const char* const inertial :
       {"", "<mass value=\"-3\"/>", "<mass/>", "<mass value=\"3\"/>", "<inertia ixx=\"abc\"/>",
        "<mass value=\"1\"/><inertia ixx=\"-1\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\"/>"}) {
    const Loaded loaded = load(robot(link + inertial + "</inertial></link>"));
    EXPECT_TRUE(loaded.robot) << inertial << ": " << loaded.robot.error().text();
    EXPECT_THAT(loaded.findings, IsEmpty()) << inertial;
  }
}

TEST(UrdfFindings, the_locale_does_not_matter) {
  const char* const before = std::setlocale(LC_ALL, nullptr);
  const std::string saved = before == nullptr ? "C" : before;
  for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    const Loaded loaded = load(arm(kLimit + "<origin xyz=\"0.5 1e-3 +2.25\"/>", kLimit));
    ASSERT_TRUE(loaded.robot) << name;
    EXPECT_EQ(loaded.robot->robot.joints[0].parent_from_joint.translation(),
              Vec3d(0.5, 1e-3, 2.25));
  }
  std::setlocale(LC_ALL, saved.c_str());
}

TEST(UrdfFindings, many_of_one_code_are_counted) {
  std::string links;
  for (int i = 0; i < 1000; ++i)
    links += "<link name=\"l" + std::to_string(i) + "\"><visual/></link>\n";
  const Loaded loaded = load(robot(links));
  EXPECT_FALSE(loaded.robot);  // several roots
  EXPECT_LT(loaded.findings.size(), 110u);
}

TEST(UrdfFindings, docs_list_every_code_with_its_severity) {
  std::ifstream page(std::string(SUNDER_SOURCE_DIR) + "/docs/robot.md");
  ASSERT_TRUE(page);
  std::set<std::string> rows, expected;
  for (std::string line; std::getline(page, line);) {
    std::istringstream cells(line);
    std::string bar, code, severity;
    if (cells >> bar >> code >> bar >> severity && line.starts_with("| `") &&
        (severity == "error" || severity == "warning" || severity == "information"))
      rows.insert(code + " " + severity);
  }
  for (const urdf::FindingKind& kind : urdf::finding_kinds())
    expected.insert("`" + std::string(kind.code) + "` " +
                    std::string(robot_severity_name(kind.severity)));
  EXPECT_EQ(rows, expected);
}

// ---- The shared files

TEST(UrdfFiles, bad_files_of_the_shared_models) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const auto bad = shared_models() / "bad";
  std::vector<RobotFinding> findings;
  const auto cycle = load_robot(bad / "cycle.urdf", {}, &findings);
  EXPECT_EQ(cycle.error().code(), StatusCode::not_a_tree);
  EXPECT_THAT(findings, has("circle", RobotSeverity::error));
  const auto no_limit = load_robot(bad / "no_limit.urdf", {}, &findings);
  ASSERT_TRUE(no_limit) << no_limit.error().text();
  EXPECT_THAT(findings, has("limits_missing", RobotSeverity::warning));
  const auto missing = load_robot(bad / "missing_mesh.urdf", {}, &findings);
  ASSERT_TRUE(missing) << missing.error().text();
  EXPECT_EQ(missing->robot.links.size(), 1u);
  EXPECT_THAT(findings, has("package_unknown", RobotSeverity::warning));
}

TEST(UrdfFiles, good_files_of_the_shared_models_have_no_warning) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  RobotLoadOptions strict;
  strict.strict = true;
  strict.meshes.import_place = ImportPlace::in_process;  // sanitizers cannot filter
  strict.package_roots = {shared_models() / "urdf"};
  for (const auto& file : files_below(shared_models() / "urdf", {".urdf"})) {
    std::vector<RobotFinding> findings;
    const auto loaded = load_robot(file, strict, &findings);
    EXPECT_TRUE(loaded) << file << ": " << loaded.error().text();
  }
}

TEST(UrdfFiles, a_missing_file_is_not_found) {
  std::vector<RobotFinding> findings = {{}};
  EXPECT_EQ(load_robot("/nowhere/robot.urdf", {}, &findings).error().code(),
            StatusCode::file_not_found);
  EXPECT_THAT(findings, IsEmpty());
}

TEST(UrdfFiles, a_file_above_the_limit_is_refused) {
  RobotLoadOptions options;
  options.maximum_urdf_bytes = 20;
  EXPECT_EQ(load(robot(kLinks), options).robot.error().code(), StatusCode::limit_exceeded);
}

}  // namespace
}  // namespace sunder::test
