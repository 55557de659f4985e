// Operation logs that are refused, and what the error says.

#include <sunder/io/operation_log.h>

#include <string>

#include <gtest/gtest.h>

#include "io/operation_log_texts.h"

namespace sunder {
namespace {

using test::cut_with;
using test::drill_with;
using test::limit_with;
using test::log_text_of;
using test::refit_with;
using test::tear_with;
using test::weights_with;

struct Refusal {
  const char* what;
  std::string json;
  StatusCode code;
  const char* text;  ///< Must occur in the message.
};

std::ostream& operator<<(std::ostream& stream, const Refusal& refusal) {
  return stream << refusal.what;
}

class OperationLogRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(OperationLogRefuses, NamingThePlace) {
  const auto operations = parse_operations(GetParam().json);
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().code(), GetParam().code) << operations.error().text();
  EXPECT_NE(operations.error().text().find(GetParam().text), std::string_view::npos)
      << operations.error().text();
}

constexpr auto kMalformed = StatusCode::malformed_file;
constexpr auto kUnsupported = StatusCode::unsupported_feature;

INSTANTIATE_TEST_SUITE_P(
    Logs, OperationLogRefuses,
    testing::Values(
        Refusal{"no text", "", kMalformed, "line 1"},
        Refusal{"syntax", "{\n\"sunder_operations\": 1,\n oops}", kMalformed, "line 3, byte 27"},
        Refusal{"trailing text", log_text_of("") + " x", kMalformed, "line 1"},
        Refusal{"bad UTF-8", "{\"\xFF\": 1}", kMalformed, "invalid JSON"},
        Refusal{"not an object", "[]", kMalformed, "expected an object, found array"},
        Refusal{"no version", R"({"operations": []})", kMalformed,
                "'sunder_operations' is missing"},
        Refusal{"version as text", R"({"sunder_operations": "1", "operations": []})", kMalformed,
                "/sunder_operations"},
        Refusal{"another version", R"({"sunder_operations": 2, "anything": 0})", kUnsupported,
                "version 2"},
        Refusal{"no operations", R"({"sunder_operations": 1})", kMalformed,
                "'operations' is missing"},
        Refusal{"operations no array", R"({"sunder_operations": 1, "operations": {}})", kMalformed,
                "/operations: expected an array"},
        Refusal{"unknown field at the top",
                R"({"sunder_operations": 1, "operations": [], "author": ""})", kMalformed,
                "'author'"},
        Refusal{"a field twice", R"({"sunder_operations": 1, "operations": [], "operations": []})",
                kMalformed, "'operations' occurs twice"},
        Refusal{"operation no object", log_text_of("7"), kMalformed,
                "/operations/0: expected an object, found number"},
        Refusal{"operation without op", log_text_of("{}"), kMalformed,
                "/operations/0: field 'op' is missing"},
        Refusal{"unknown operation", log_text_of(R"({"op": "sew"})"), kUnsupported,
                "/operations/0/op"},
        Refusal{"no piece", log_text_of(R"({"op": "detach"})"), kMalformed, "'piece' is missing"},
        Refusal{"piece without a place", log_text_of(R"({"op": "detach", "piece": {"mesh": 1}})"),
                kMalformed, "'triangle' is missing"},
        Refusal{"piece at two places",
                log_text_of(R"({"op": "detach", "piece": {"near": [0, 0, 0], "triangle": 1}})"),
                kMalformed, "unknown field 'triangle'"},
        Refusal{"triangle below 0", log_text_of(R"({"op": "detach", "piece": {"triangle": -1}})"),
                kMalformed, "/operations/0/piece/triangle"},
        Refusal{"unknown field", tear_with(R"("depth": 1)"), kMalformed, "unknown field 'depth'"},
        Refusal{"no stroke", log_text_of(R"({"op": "tear"})"), kMalformed, "'stroke' is missing"},
        Refusal{"one blade",
                log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,1], "tip": [0,0,0]}]})"),
                kMalformed, "/operations/0/stroke"},
        Refusal{"blade without tip",
                log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,1]}, {}]})"), kMalformed,
                "/stroke/0: field 'tip'"},
        Refusal{"blade without length",
                log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,1], "tip": [0,0,1]}, {}]})"),
                kMalformed, "/operations/0/stroke/0: base and tip of a blade must differ"},
        Refusal{"two coordinates",
                log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0], "tip": [0,0,1]}, {}]})"),
                kMalformed, "/stroke/0/base"},
        Refusal{
            "coordinate as text",
            log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,"1"], "tip": [0,0,1]}, {}]})"),
            kMalformed, "/stroke/0/base/2: expected a number, found string"},
        Refusal{
            "NaN",
            log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,NaN], "tip": [0,0,1]}, {}]})"),
            kMalformed, "invalid JSON"},
        Refusal{
            "overflow",
            log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,1e999], "tip": [0,0,1]}, {}]})"),
            kMalformed, "1e999"},
        Refusal{
            "too large",
            log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,1e61], "tip": [0,0,1]}, {}]})"),
            kMalformed, "/stroke/0/base/2: number beyond 1e60"},
        Refusal{"negative width", tear_with(R"("width": -0.01)"), kMalformed,
                "width is -0.01 m; it must be from 0 to 1e+30 m"},
        Refusal{"negative depth of walls", tear_with(R"("wall_depth": -1)"), kMalformed,
                "/operations/0/wall_depth"},
        Refusal{"width as text", tear_with(R"("width": "0")"), kMalformed, "/operations/0/width"},
        Refusal{"unknown layers", tear_with(R"("layers": "odd")"), kUnsupported,
                "/operations/0/layers"},
        Refusal{"layers as number", tear_with(R"("layers": 1)"), kMalformed,
                "/operations/0/layers: expected a string"},
        Refusal{"unknown pose", tear_with(R"("pose": "t-pose")"), kMalformed, "/operations/0/pose"},
        Refusal{"pose as number", tear_with(R"("pose": 3)"), kMalformed, "/operations/0/pose"},
        Refusal{"clip without time", tear_with(R"("pose": {"clip": "Walk"})"), kMalformed,
                "'time' is missing"},
        Refusal{"negative time", tear_with(R"("pose": {"clip": "Walk", "time": -1})"), kMalformed,
                "/pose/time"},
        Refusal{"negative clip", tear_with(R"("pose": {"clip": -1, "time": 0})"), kMalformed,
                "/pose/clip"},
        Refusal{"clip index beyond 32 bits",
                tear_with(R"("pose": {"clip": 4294967295, "time": 0})"), kMalformed, "/pose/clip"},
        Refusal{"clip and bones", tear_with(R"("pose": {"clip": 0, "time": 0, "bones": {}})"),
                kMalformed, "unknown field"},
        Refusal{"unknown part of a bone", tear_with(R"("pose": {"bones": {"A/B": {"shear": 1}}})"),
                kMalformed, "/pose/bones/A~1B"},
        Refusal{"bone without name", tear_with(R"("pose": {"bones": {"": {}}})"), kMalformed,
                "must not be empty"},
        Refusal{"rotation of zero length",
                tear_with(R"("pose": {"bones": {"A": {"rotation": [0,0,0,0]}}})"), kMalformed,
                "/A/rotation"},
        Refusal{"the same bone twice", tear_with(R"("pose": {"bones": {"A": {}, "A": {}}})"),
                kMalformed, "'A' occurs twice"}));

INSTANTIATE_TEST_SUITE_P(
    Tears, OperationLogRefuses,
    testing::Values(
        Refusal{
            "pose of the first blade",
            log_text_of(
                R"({"op": "tear", "stroke": [{"base": [0,0,1], "tip": [0,0,0], "pose": "rest"}, {}]})"),
            kMalformed, "/operations/0/stroke/0/pose"},
        Refusal{"unknown pose of a blade",
                log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,1], "tip": [0,0,0]},
                                                    {"base": [0,0,1], "tip": [0,0,0], "pose": "t"}]})"),
                kMalformed, "/operations/0/stroke/1/pose"},
        Refusal{"unknown field of a blade",
                log_text_of(R"({"op": "tear", "stroke": [{"base": [0,0,1], "edge": 1}, {}]})"),
                kMalformed, "/operations/0/stroke/0: unknown field 'edge'"},
        Refusal{"stroke no array", log_text_of(R"({"op": "tear", "stroke": {}})"), kMalformed,
                "/operations/0/stroke: expected an array of blades, found object"},
        Refusal{"fields of a cut", tear_with(R"("caps": true)"), kMalformed,
                "unknown field 'caps'"},
        Refusal{"matrices no array", tear_with(R"("pose": {"matrices": 1})"), kMalformed,
                "/pose/matrices: expected an array"},
        Refusal{"a matrix too short",
                tear_with(R"("pose": {"matrices": [[1,0,0,0, 0,1,0,0, 0,0,1]]})"), kMalformed,
                "/pose/matrices/0: expected an array of 12 numbers"},
        Refusal{"a matrix of four rows",
                tear_with(R"("pose": {"matrices": [[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]]})"),
                kMalformed, "/pose/matrices/0: expected an array of 12 numbers"},
        Refusal{"a matrix with text",
                tear_with(R"("pose": {"matrices": [[1,0,0,0, 0,"1",0,0, 0,0,1,0]]})"), kMalformed,
                "/pose/matrices/0/5: expected a number, found string"},
        Refusal{"a matrix without number",
                tear_with(R"("pose": {"matrices": [[1,0,0,0, 0,null,0,0, 0,0,1,0]]})"), kMalformed,
                "/pose/matrices/0/5: expected a number, found null"},
        Refusal{"a matrix too large",
                tear_with(R"("pose": {"matrices": [[1,0,0,0, 0,1,0,0, 0,0,1,1.1e30]]})"),
                kMalformed, "/pose/matrices/0/11: number beyond 1e30"},
        Refusal{"morph weights too large",
                tear_with(R"("pose": {"matrices": [], "morph_weights": [0, 1e10]})"), kMalformed,
                "/pose/morph_weights/1: number beyond 1e9"},
        Refusal{"morph weights no array",
                tear_with(R"("pose": {"matrices": [], "morph_weights": 0})"), kMalformed,
                "/pose/morph_weights: expected an array"},
        Refusal{"morph weights alone", tear_with(R"("pose": {"morph_weights": [0]})"), kMalformed,
                "unknown field 'morph_weights'"},
        Refusal{"matrices and bones", tear_with(R"("pose": {"matrices": [], "bones": {}})"),
                kMalformed, "unknown field 'matrices'"}));

INSTANTIATE_TEST_SUITE_P(
    Cuts, OperationLogRefuses,
    testing::Values(
        Refusal{"no plane", log_text_of(R"({"op": "cut"})"), kMalformed,
                "/operations/0: field 'plane' is missing"},
        Refusal{"plane no object", log_text_of(R"({"op": "cut", "plane": [0,0,1,0]})"), kMalformed,
                "/operations/0/plane: expected an object"},
        Refusal{"no point", log_text_of(R"({"op": "cut", "plane": {"normal": [0,0,1]}})"),
                kMalformed, "'point' is missing"},
        Refusal{"no normal", log_text_of(R"({"op": "cut", "plane": {"point": [0,0,1]}})"),
                kMalformed, "'normal' is missing"},
        Refusal{"normal of zero length",
                log_text_of(R"({"op": "cut", "plane": {"point": [0,0,1], "normal": [0,-0.0,0]}})"),
                kMalformed, "/plane/normal: normal of zero length"},
        Refusal{"unknown field of the plane",
                log_text_of(R"({"op": "cut", "plane": {"distance": 1}})"), kMalformed,
                "/plane: unknown field 'distance'"},
        Refusal{"two corners", cut_with(R"("bounds": [[0,0,0], [1,0,0]])"), kMalformed,
                "/bounds: bounds need at least three"},
        Refusal{"no corners", cut_with(R"("bounds": [])"), kMalformed,
                "/bounds: bounds need at least three"},
        Refusal{"bounds no array", cut_with(R"("bounds": true)"), kMalformed,
                "/bounds: expected an array of points"},
        Refusal{"a corner of two numbers", cut_with(R"("bounds": [[0,0,0], [1,0], [0,0,1]])"),
                kMalformed, "/bounds/1: expected an array of 3"},
        Refusal{"no sections", cut_with(R"("sections": [])"), kMalformed,
                "/sections: sections need at least one place"},
        Refusal{"a section of two numbers", cut_with(R"("sections": [[0,0,0], [1,0]])"), kMalformed,
                "/sections/1: expected an array of 3"},
        Refusal{"a ray without direction", cut_with(R"("first_hit": {"origin": [0,0,0]})"),
                kMalformed, "/first_hit: field 'direction' is missing"},
        Refusal{"a ray of no length",
                cut_with(R"("first_hit": {"origin": [0,0,0], "direction": [0,0,0]})"), kMalformed,
                "/first_hit/direction"},
        Refusal{"a bone by number", cut_with(R"("bone": 3)"), kMalformed, "/bone: expected"},
        Refusal{"caps as number", cut_with(R"("caps": 1)"), kMalformed,
                "/caps: expected true or false, found number"},
        Refusal{"pose of a cut", cut_with(R"("pose": "t-pose")"), kMalformed, "/operations/0/pose"},
        Refusal{"width of a cut", cut_with(R"("width": 0)"), kMalformed, "unknown field 'width'"}));

INSTANTIATE_TEST_SUITE_P(
    Drills, OperationLogRefuses,
    testing::Values(
        Refusal{"no axis", log_text_of(R"({"op": "drill", "radius": 1, "depth": 1})"), kMalformed,
                "'axis' is missing"},
        Refusal{"no origin",
                log_text_of(
                    R"({"op": "drill", "axis": {"direction": [0,0,1]}, "radius": 1, "depth": 1})"),
                kMalformed, "'origin' is missing"},
        Refusal{
            "no direction",
            log_text_of(R"({"op": "drill", "axis": {"origin": [0,0,1]}, "radius": 1, "depth": 1})"),
            kMalformed, "'direction' is missing"},
        Refusal{
            "direction of zero length",
            log_text_of(
                R"({"op": "drill", "axis": {"origin": [0,0,1], "direction": [0,0,0]}, "radius": 1, "depth": 1})"),
            kMalformed, "/axis/direction: direction of zero length"},
        Refusal{"unknown field of the axis",
                log_text_of(R"({"op": "drill", "axis": {"angle": 1}, "radius": 1, "depth": 1})"),
                kMalformed, "/axis: unknown field 'angle'"},
        Refusal{"no radius", drill_with(R"("depth": 1)"), kMalformed, "'radius' is missing"},
        Refusal{"radius 0", drill_with(R"("radius": 0, "depth": 1)"), kMalformed,
                "/operations/0/radius: radius is 0 m; it must be above 1e-30 and at most 1e+30 m"},
        Refusal{"negative radius", drill_with(R"("radius": -1, "depth": 1)"), kMalformed,
                "/operations/0/radius"},
        Refusal{"no depth", drill_with(R"("radius": 1)"), kMalformed, "'depth' is missing"},
        Refusal{"depth 0", drill_with(R"("radius": 1, "depth": 0)"), kMalformed,
                "/operations/0/depth: depth is 0 m; it must be above 1e-30 and at most 1e+30 m"},
        Refusal{"negative chord tolerance",
                drill_with(R"("radius": 1, "depth": 1, "chord_tolerance": -1)"), kMalformed,
                "chord_tolerance is -1 m; it must be from 2.5e-06 to 1 m, or 0"},
        Refusal{"wall as text", drill_with(R"("radius": 1, "depth": 1, "wall": "yes")"), kMalformed,
                "/operations/0/wall: expected true or false, found string"},
        Refusal{"unknown field", drill_with(R"("radius": 1, "depth": 1, "walls": true)"),
                kMalformed, "unknown field 'walls'"}));

INSTANTIATE_TEST_SUITE_P(
    Steps, OperationLogRefuses,
    testing::Values(Refusal{"count 0", log_text_of(R"({"op": "undo", "count": 0})"), kMalformed,
                            "/operations/0/count: expected at least 1"},
                    Refusal{"negative count", log_text_of(R"({"op": "redo", "count": -1})"),
                            kMalformed, "/operations/0/count: expected"},
                    Refusal{"half a count", log_text_of(R"({"op": "undo", "count": 1.5})"),
                            kMalformed, "/operations/0/count: expected"},
                    Refusal{"count beyond 32 bits",
                            log_text_of(R"({"op": "undo", "count": 4294967295})"), kMalformed,
                            "/operations/0/count: expected at most 4294967294"},
                    Refusal{"undo in a pose", log_text_of(R"({"op": "undo", "pose": "rest"})"),
                            kMalformed, "unknown field 'pose'"},
                    Refusal{"redo in a pose", log_text_of(R"({"op": "redo", "pose": "rest"})"),
                            kMalformed, "unknown field 'pose'"}));

INSTANTIATE_TEST_SUITE_P(
    Weights, OperationLogRefuses,
    testing::Values(
        Refusal{"weights of a tear as text", tear_with(R"("weights": "exact")"), kMalformed,
                "/operations/0/weights: expected an object, found string"},
        Refusal{"unknown field", cut_with(R"("weights": {"refit": {}})"), kMalformed,
                "/operations/0/weights: unknown field 'refit'"},
        Refusal{"unknown policy",
                drill_with(R"("radius": 1, "depth": 1, "weights": {"policy": "linear"})"),
                kUnsupported, "/operations/0/weights/policy: unknown policy 'linear'"},
        Refusal{"policy as number", tear_with(R"("weights": {"policy": 3})"), kMalformed,
                "/operations/0/weights/policy: expected a string"},
        Refusal{
            "negative influences", tear_with(R"("weights": {"influences": -1})"), kMalformed,
            "/operations/0/weights/influences: expected influences, 0 for all, an integer from 0"},
        Refusal{"half an influence", tear_with(R"("weights": {"influences": 0.5})"), kMalformed,
                "/operations/0/weights/influences"},
        Refusal{"influences beyond 32 bits", tear_with(R"("weights": {"influences": 4294967296})"),
                kMalformed, "/operations/0/weights/influences: expected at most 4294967295"},
        Refusal{"four influences of exact",
                tear_with(R"("weights": {"policy": "exact", "influences": 4})"), kMalformed,
                "/operations/0/weights/influences: the policy 'exact' keeps all"},
        Refusal{"no weights", log_text_of(R"({"op": "weights"})"), kMalformed,
                "/operations/0: field 'weights' is missing"},
        Refusal{"weights no object", weights_with("[]"), kMalformed,
                "/operations/0/weights: expected an object"},
        Refusal{"unknown field of the operation", weights_with(R"({}, "policy": "exact")"),
                kMalformed, "/operations/0: unknown field 'policy'"},
        Refusal{"negative first", weights_with(R"({}, "first": -1)"), kMalformed,
                "/operations/0/first: expected an operation's index"},
        Refusal{"first beyond 32 bits", weights_with(R"({}, "first": 4294967295)"), kMalformed,
                "/operations/0/first: expected at most"},
        Refusal{"no operations", weights_with(R"({}, "count": 0)"), kMalformed,
                "/operations/0/count: expected at least 1"},
        Refusal{
            "count as text", weights_with(R"({}, "count": "all")"), kMalformed,
            "/operations/0/count: expected how many operations, an integer from 1, found string"},
        Refusal{"a pose for exact", weights_with(R"({"policy": "exact"}, "pose": "bind")"),
                kMalformed, "/operations/0/pose: only the policy 'pose_exact'"},
        Refusal{"unknown pose", weights_with(R"({"policy": "pose_exact"}, "pose": "t-pose")"),
                kMalformed, "/operations/0/pose"},
        Refusal{"a refit that is barycentric", weights_with(R"({}, "refit": {})"), kMalformed,
                "/operations/0/refit: only the policy 'refit'"},
        Refusal{"a refit that is exact in a pose",
                weights_with(R"({"policy": "pose_exact"}, "refit": {})"), kMalformed,
                "/operations/0/refit: only the policy 'refit'"}));

INSTANTIATE_TEST_SUITE_P(
    Refits, OperationLogRefuses,
    testing::Values(
        Refusal{"refit no object", refit_with("true"), kMalformed,
                "/operations/0/refit: expected an object"},
        Refusal{"unknown field", refit_with(R"({"is_coupled": true})"), kMalformed,
                "/operations/0/refit: unknown field 'is_coupled'"},
        Refusal{"moves_bind as number", refit_with(R"({"moves_bind": 1})"), kMalformed,
                "/operations/0/refit/moves_bind: expected true or false"},
        Refusal{"coupled as text", refit_with(R"({"coupled": "yes"})"), kMalformed,
                "/operations/0/refit/coupled: expected true or false"},
        Refusal{"negative smoothness", refit_with(R"({"smoothness": -0.1})"), kMalformed,
                "/refit/smoothness: smoothness is -0.1; it must be from 0 to 1e+09"},
        Refusal{"poses no object", refit_with(R"({"poses": ["rest"]})"), kMalformed,
                "/operations/0/refit/poses: expected an object"},
        Refusal{"unknown field of the poses", refit_with(R"({"poses": {"clips": 8}})"), kMalformed,
                "/operations/0/refit/poses: unknown field 'clips'"},
        Refusal{"a bound below one", refit_with(R"({"bound": 0.5})"), kMalformed,
                "/refit/bound: bound is 0.5; it must be from 1 to 1e+09, or 0"},
        Refusal{"a negative importance", refit_with(R"({"importance": {"clips": -1}})"), kMalformed,
                "/refit/importance/clips"},
        Refusal{"an importance without a clip",
                refit_with(R"({"importance": {"of_clip": [{"factor": 2}]}})"), kMalformed,
                "/refit/importance/of_clip/0"},
        Refusal{"negative samples", refit_with(R"({"poses": {"clip_samples": -8}})"), kMalformed,
                "/refit/poses/clip_samples: expected samples a clip, an integer from 0"},
        Refusal{"too many samples", refit_with(R"({"poses": {"clip_samples": 65537}})"), kMalformed,
                "/refit/poses/clip_samples: expected at most 65536"},
        Refusal{"range of motion as number", refit_with(R"({"poses": {"range_of_motion": 1}})"),
                kMalformed, "/refit/poses/range_of_motion: expected true or false"},
        Refusal{"limits no array", refit_with(R"({"poses": {"joint_limits": {}}})"), kMalformed,
                "/refit/poses/joint_limits: expected an array"},
        Refusal{"bone by name",
                limit_with(R"("bone": "Arm", "axis": [1,0,0], "lower": 0, "upper": 1)"), kMalformed,
                "/joint_limits/0/bone: expected a bone's index"},
        Refusal{"no bone", limit_with(R"("axis": [1,0,0], "lower": 0, "upper": 1)"), kMalformed,
                "/joint_limits/0: field 'bone' is missing"},
        Refusal{"axis of zero length",
                limit_with(R"("bone": 0, "axis": [0,0,0], "lower": 0, "upper": 1)"), kMalformed,
                "/joint_limits/0/axis: axis of zero length"},
        Refusal{"no upper limit", limit_with(R"("bone": 0, "axis": [1,0,0], "lower": 0)"),
                kMalformed, "'upper' is missing"},
        Refusal{"limits the wrong way round",
                limit_with(R"("bone": 0, "axis": [1,0,0], "lower": 1, "upper": 0)"), kMalformed,
                "/joint_limits/0: 'lower' is above 'upper'"},
        Refusal{"unknown field of a limit", limit_with(R"("bone": 0, "angle": 1)"), kMalformed,
                "unknown field 'angle'"},
        Refusal{"given poses no array", refit_with(R"({"poses": {"poses": "rest"}})"), kMalformed,
                "/refit/poses/poses: expected an array"},
        Refusal{"a given pose unknown", refit_with(R"({"poses": {"poses": ["rest", "t-pose"]}})"),
                kMalformed, "/refit/poses/poses/1: expected \"rest\" or \"bind\""}));

TEST(OperationLog, IndexIsTheOperation) {
  const std::string good = std::string(R"({"op": "tear", "stroke": )") + test::kBlades + "}";
  const auto operations = parse_operations(log_text_of(good + "," + R"({"op": "tear"})"));
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().index(), 1u);
}

TEST(OperationLog, DeepNestingIsALimit) {
  const auto operations = parse_operations(std::string(100'000, '['));
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().code(), StatusCode::limit_exceeded);
}

TEST(OperationLog, SizeIsALimit) {
  const auto operations = parse_operations(std::string((std::size_t{64} << 20) + 1, ' '));
  ASSERT_FALSE(operations);
  EXPECT_EQ(operations.error().code(), StatusCode::limit_exceeded);
}

/// An operation takes a hundred times the memory of its text, and so does an empty value.
TEST(OperationLog, WhatATextBecomesIsALimit) {
  const auto repeated = [](const std::string& begin, std::string_view one, std::size_t count,
                           const std::string& end) {
    std::string text = begin;
    text.reserve(begin.size() + one.size() * count + end.size());
    for (std::size_t i = 0; i < count; ++i) text += one;
    return text + end;
  };
  const std::string head = R"({"sunder_operations": 1, "operations": [)";
  const std::string_view undo = R"({"op":"undo"},)";
  const auto many = parse_operations(repeated(head, undo, 1'000'000, R"({"op":"undo"}]})"));
  ASSERT_FALSE(many);
  EXPECT_EQ(many.error().code(), StatusCode::limit_exceeded);
  EXPECT_NE(many.error().text().find("1000001 operations"), std::string_view::npos);
  for (const std::string_view one : {"{},", R"("",)"}) {
    const auto values = parse_operations(repeated(head, one, 20'000'000, "0]}"));
    ASSERT_FALSE(values);
    EXPECT_EQ(values.error().code(), StatusCode::limit_exceeded) << one;
  }
}

}  // namespace
}  // namespace sunder
