// `sunder view`: the page in a browser, and whether operations placed by clicks meet the places
// that were clicked. The places are found again here, from the pixels' rays and the library's own
// poses.

#include <sunder/io/character_file.h>
#include <sunder/io/operation_log.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "support/machine/node_program.h"
#include "support/machine/stress.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "tools/command_fixture.h"
#include "tools/textured_squares.h"

namespace sunder::command_test {
namespace {

using test::run_node_program;
using test::run_sunder_without_page;

constexpr double kTolerance = 1e-4;  // of the model's diagonal

/// No name of a file may hold a slash.
constexpr const char* kHostileFile = "a\"><img src=x onerror=pwned=1>.glb";
/// It also turns the direction of writing, colours terminals and breaks lines.
constexpr const char* kHostileName =
    "</script><script>pwned=1</script><img src=x onerror=pwned=1>\u202e\x1b[31m\u009b\n\u2066";

bool has_chromium() { return std::system("command -v chromium > /dev/null 2>&1") == 0; }

/// The cactus, where names may say anything, and a second clip.
Character hostile_cactus() {
  Character cactus = tools::make_cactus();
  cactus.skeleton.bones[1].name = kHostileName;
  cactus.meshes[0].name = kHostileName;
  Clip other = cactus.clips.at(0);
  other.name = kHostileName;
  for (Channel& channel : other.channels)
    if (channel.interpolation == Interpolation::linear) channel.interpolation = Interpolation::step;
  cactus.clips.push_back(other);
  return cactus;
}

struct Ray {
  Vec3d eye, direction;
};

Vec3d vector_of(const json& numbers) {
  return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

/// Distance along a ray to a triangle; infinite beside it.
double distance_to(const Ray& ray, const std::array<Vec3d, 3>& corners) {
  Mat3d columns;
  columns << corners[1] - corners[0], corners[2] - corners[0], -ray.direction;
  if (columns.determinant() == 0) return std::numeric_limits<double>::infinity();
  const Vec3d found = columns.inverse() * Vec3d(ray.eye - corners[0]);
  const bool hits = found.x() >= 0 && found.y() >= 0 && found.x() + found.y() <= 1 && found.z() > 0;
  return hits ? found.z() : std::numeric_limits<double>::infinity();
}

/// A model in a pose, by the library's reference.
struct PosedModel {
  const Character& character;
  std::vector<std::vector<Vec3d>> positions;
  double diagonal;

  PosedModel(const Character& of, const PoseSpec& spec) : character(of) {
    const ModelPose pose = *make_pose(character, spec);
    for (Index mesh = 0; mesh < character.meshes.size(); ++mesh)
      positions.push_back(test::posed_positions(character, mesh, pose));
    diagonal = test::posed_diagonal(character, pose);
  }

  [[nodiscard]] Vec3d hit(const Ray& ray) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (Index mesh = 0; mesh < character.meshes.size(); ++mesh)
      for (const Triangle& triangle : character.meshes[mesh].triangles) {
        const auto& of = positions[mesh];
        nearest = std::min(nearest,
                           distance_to(ray, {of[triangle[0]], of[triangle[1]], of[triangle[2]]}));
      }
    EXPECT_TRUE(std::isfinite(nearest)) << "the click met nothing";
    return ray.eye + nearest * ray.direction;
  }
};

/// The vertices of a torn model that its source does not have, and the edges between them, posed.
struct NewSurface {
  std::vector<Vec3d> vertices;
  std::vector<std::array<Vec3d, 2>> edges;

  NewSurface(const Character& source, const PosedModel& torn) {
    for (Index m = 0; m < torn.character.meshes.size(); ++m) {
      const Mesh& mesh = torn.character.meshes[m];
      std::set<std::array<float, 3>> old;
      for (const Vec3f& position : source.meshes[m].positions)
        old.insert({position[0], position[1], position[2]});
      const auto is_new = [&](Index vertex) {
        const Vec3f& position = mesh.positions[vertex];
        return !old.contains({position[0], position[1], position[2]});
      };
      for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (is_new(v)) vertices.push_back(torn.positions[m][v]);
      for (const Triangle& triangle : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
          const Index a = triangle[i], b = triangle[(i + 1) % 3];
          if (is_new(a) && is_new(b)) edges.push_back({torn.positions[m][a], torn.positions[m][b]});
        }
    }
  }

  [[nodiscard]] double distance_to_vertex(const Vec3d& place) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec3d& vertex : vertices) nearest = std::min(nearest, (vertex - place).norm());
    return nearest;
  }
  [[nodiscard]] double distance_to_edge(const Vec3d& place) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& [from, to] : edges) {
      const Vec3d along = to - from;
      const double squared = along.squaredNorm();
      const double share =
          squared > 0 ? std::clamp((place - from).dot(along) / squared, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, (from + share * along - place).norm());
    }
    return nearest;
  }
};

/// A page in which every tool was used, and the logs that it saved.
class ViewPage : public CommandSuite {
 protected:
  static void SetUpTestSuite() {
    CommandSuite::SetUpTestSuite();
    cactus_ = std::make_unique<Character>(hostile_cactus());
    const Status saved = save_glb(model(), *cactus_);
    ASSERT_TRUE(saved) << saved.text();
    loaded_ = std::make_unique<LoadedCharacter>(*load_character(model()));
    const CommandResult result = run_sunder({"view", model(), "-o", path("view.html")});
    if (result.exit_code == 2) return;  // built without pages
    ASSERT_EQ(result.exit_code, 0) << result.err;
    can_run_ = test::has_node_packages({"puppeteer-core"}) && has_chromium();
  }
  static void TearDownTestSuite() {
    cactus_.reset();
    loaded_.reset();
    CommandSuite::TearDownTestSuite();
  }
  void SetUp() override {
    if (!can_run_)
      GTEST_SKIP() << "needs the pages (scripts/setup page), chromium and puppeteer-core "
                      "(scripts/setup test)";
  }

  static std::string model() { return path(kHostileFile); }
  static const Character& source() { return *loaded_->character; }

  static json used(const std::string& mode, const std::string& page, const std::string& folder) {
    const auto run = run_node_program("view_page.mjs", mode + " '" + page + "' '" + folder + "'");
    EXPECT_TRUE(run && run->succeeded) << (run ? run->output : "");
    const json facts = json::parse(run->output, nullptr, false);
    EXPECT_EQ(facts["errors"], json::array()) << run->output;
    EXPECT_EQ(facts["requests"], json::array());
    return facts;
  }

  /// Tears the model by a saved log, new points exact in the pose of the operation.
  static LoadedCharacter torn_by(const std::string& name) {
    const std::string log = path("saved/" + name + ".json"), torn = path(name + ".glb");
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", log, "-o", torn, "--weights", "pose_exact"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    return *load_character(torn);
  }

  static PoseSpec pose_of(const json& used_tool) {
    return ClipPose{"Sway", used_tool["time"].get<double>()};
  }

  static std::vector<Vec3d> clicked_places(const json& used_tool, const PosedModel& posed) {
    std::vector<Vec3d> places;
    for (const json& ray : used_tool["rays"])
      places.push_back(posed.hit({vector_of(ray["eye"]), vector_of(ray["direction"])}));
    return places;
  }

  /// Whether a bore of the page has its axis through the place that was clicked.
  static void expect_bore(const std::string& name, const PoseSpec& pose) {
    const json& used_tool = facts_[name];
    EXPECT_EQ(used_tool["saved"], true) << name;
    const PosedModel posed(source(), pose);
    const Vec3d place = clicked_places(used_tool, posed).at(0);
    const json operation = read_json("saved/" + name + ".json")["operations"][0];
    const Vec3d origin = vector_of(operation["axis"]["origin"]),
                direction = vector_of(operation["axis"]["direction"]).normalized();
    const auto from_axis = [&](const Vec3d& of) { return (of - origin).cross(direction).norm(); };
    EXPECT_LT(from_axis(place), kTolerance * posed.diagonal) << name;
    const double along = (place - origin).dot(direction);
    EXPECT_GT(along, 0) << name << ": the axis begins outside";
    const LoadedCharacter torn = torn_by(name);
    const NewSurface made(source(), PosedModel(*torn.character, pose));
    ASSERT_FALSE(made.vertices.empty()) << name;
    const double radius = operation["radius"];
    for (const Vec3d& vertex : made.vertices) {
      EXPECT_LT(from_axis(vertex), radius + kTolerance * posed.diagonal) << name;
      EXPECT_GT(from_axis(vertex), 0.98 * radius - kTolerance * posed.diagonal) << name;
    }
  }

  inline static std::unique_ptr<Character> cactus_;
  inline static std::unique_ptr<LoadedCharacter> loaded_;
  inline static bool can_run_ = false;
  inline static json facts_;

  // What is asked of a page in which every tool was used: facts_.
  static void names_stay_text();
  static void draws_every_clip_where_the_processor_poses_the_model();
  static void a_stroke_tears_through_the_places_that_were_clicked();
  static void a_plane_cuts_through_two_places_in_the_line_of_sight();
  static void a_bounded_plane_cuts_through_three_places();
  static void a_bore_has_its_axis_through_the_place_that_was_clicked();
  static void aimed_operations_name_the_bone_under_the_pointer();
  static void an_incision_names_places_of_the_surface();
  static void what_would_open_is_drawn_where_it_opens();
  static void saved_logs_follow_the_schema();
  static void undo_and_redo_change_the_list();
  static void can_be_used_without_a_mouse_and_on_a_narrow_screen();
};

TEST_F(ViewPage, makes_operations_that_meet_the_places_that_were_clicked) {
  std::filesystem::create_directory(path("saved"));
  facts_ = used("place", path("view.html"), path("saved"));
  names_stay_text();
  draws_every_clip_where_the_processor_poses_the_model();
  a_stroke_tears_through_the_places_that_were_clicked();
  a_plane_cuts_through_two_places_in_the_line_of_sight();
  a_bounded_plane_cuts_through_three_places();
  a_bore_has_its_axis_through_the_place_that_was_clicked();
  aimed_operations_name_the_bone_under_the_pointer();
  an_incision_names_places_of_the_surface();
  what_would_open_is_drawn_where_it_opens();
  saved_logs_follow_the_schema();
  undo_and_redo_change_the_list();
  can_be_used_without_a_mouse_and_on_a_narrow_screen();
}

void ViewPage::names_stay_text() {
  EXPECT_EQ(facts_["title"], kHostileFile);
  EXPECT_EQ(facts_["injected"], json({nullptr, 0}));
  EXPECT_EQ(facts_["runs_other_scripts"], false) << "the policy names the page's own scripts alone";
  EXPECT_EQ(facts_["shown_error"]["parts"], 0) << "a message of an error is no HTML";
  EXPECT_TRUE(facts_["shown_error"]["text"].get<std::string>().starts_with(kHostileFile));
  EXPECT_EQ(facts_["unseen"], 0) << "control characters of names are shown as escapes";
}

void ViewPage::draws_every_clip_where_the_processor_poses_the_model() {
  ASSERT_EQ(facts_["clips"].size(), cactus_->clips.size());
  for (std::size_t clip = 0; clip < cactus_->clips.size(); ++clip) {
    EXPECT_LT(facts_["clips"][clip]["outline_distance"], 2.5) << "pixels";
    EXPECT_GT(facts_["clips"][clip]["share"], 0.03);
    EXPECT_NEAR(facts_["clips"][clip]["time"].get<double>(), 0.37 * cactus_->clips[clip].duration,
                1e-3);
  }
  EXPECT_LT(facts_["rest"], 2.5);
  EXPECT_LT(facts_["bind"], 2.5);
  EXPECT_EQ(facts_["is_playing"], false);
}

void ViewPage::a_stroke_tears_through_the_places_that_were_clicked() {
  EXPECT_EQ(facts_["pending"], 3);
  EXPECT_EQ(facts_["tear"]["saved"], true);
  const PosedModel posed(source(), pose_of(facts_["tear"]));
  const LoadedCharacter torn = torn_by("tear");
  const NewSurface made(source(), PosedModel(*torn.character, pose_of(facts_["tear"])));
  const NewSurface at_rest(source(), PosedModel(*torn.character, RestPose{}));
  double at_rest_distance = 0;
  for (const Vec3d& place : clicked_places(facts_["tear"], posed)) {
    EXPECT_LT(made.distance_to_vertex(place), kTolerance * posed.diagonal);
    at_rest_distance = std::max(at_rest_distance, at_rest.distance_to_vertex(place));
  }
  EXPECT_GT(at_rest_distance, 10 * kTolerance * posed.diagonal)
      << "the pose is so near rest that a wrong pose would not be seen";
}

void ViewPage::a_plane_cuts_through_two_places_in_the_line_of_sight() {
  const json& used_tool = facts_["cut"];
  EXPECT_EQ(used_tool["saved"], true);
  const PosedModel posed(source(), pose_of(used_tool));
  const auto places = clicked_places(used_tool, posed);
  const Vec3d eye = vector_of(used_tool["rays"][1]["eye"]);
  const Vec3d normal = Vec3d(places[0] - eye).cross(Vec3d(places[1] - eye)).normalized();
  const LoadedCharacter torn = torn_by("cut");
  const NewSurface made(source(), PosedModel(*torn.character, pose_of(used_tool)));
  ASSERT_FALSE(made.vertices.empty());
  for (const Vec3d& vertex : made.vertices)
    EXPECT_LT(std::abs((vertex - eye).dot(normal)), kTolerance * posed.diagonal);
  for (const Vec3d& place : places)
    EXPECT_LT(made.distance_to_edge(place), kTolerance * posed.diagonal);
}

void ViewPage::a_bounded_plane_cuts_through_three_places() {
  const json& used_tool = facts_["disc"];
  EXPECT_EQ(used_tool["saved"], true);
  const PosedModel posed(source(), pose_of(used_tool));
  const auto places = clicked_places(used_tool, posed);
  const LoadedCharacter torn = torn_by("disc");
  const NewSurface made(source(), PosedModel(*torn.character, pose_of(used_tool)));
  for (const Vec3d& place : places)
    EXPECT_LT(made.distance_to_edge(place), kTolerance * posed.diagonal);
  const Vec3d centre = (places[0] + places[1] + places[2]) / 3;
  double radius = 0;
  for (const Vec3d& place : places) radius = std::max(radius, (place - centre).norm());
  for (const Vec3d& vertex : made.vertices) EXPECT_LT((vertex - centre).norm(), 1.1 * radius);
}

void ViewPage::a_bore_has_its_axis_through_the_place_that_was_clicked() {
  expect_bore("drill", pose_of(facts_["drill"]));
  expect_bore("drill_rest", RestPose{});
  expect_bore("drill_bind", BindPose{});
}

/// The bone that moves the place most that a ray meets first, from the influences in the file.
std::string bone_under(const Ray& ray, const PosedModel& posed) {
  double nearest = std::numeric_limits<double>::infinity();
  std::map<std::string, double> shares;
  for (Index m = 0; m < posed.character.meshes.size(); ++m) {
    const Mesh& mesh = posed.character.meshes[m];
    const auto& of = posed.positions[m];
    for (const Triangle& triangle : mesh.triangles) {
      const double found = distance_to(ray, {of[triangle[0]], of[triangle[1]], of[triangle[2]]});
      if (found >= nearest) continue;
      nearest = found;
      shares.clear();
      for (const Index vertex : triangle)
        for (const Influence& influence : mesh.weights.of(vertex))
          shares[posed.character.skeleton
                     .bones[posed.character.skins[mesh.skin].bones[influence.slot]]
                     .name] += influence.weight;
    }
  }
  return std::ranges::max_element(shares, {}, [](const auto& of) { return of.second; })->first;
}

void ViewPage::aimed_operations_name_the_bone_under_the_pointer() {
  for (const char* const name : {"slash", "sever", "puncture"}) {
    const json& used_tool = facts_[name];
    EXPECT_EQ(used_tool["saved"], true) << name;
    const PosedModel posed(source(), pose_of(used_tool));
    const json& ray = used_tool["rays"][0];
    const std::string bone =
        bone_under({vector_of(ray["eye"]), vector_of(ray["direction"])}, posed);
    const json operation = read_json(std::string("saved/") + name + ".json")["operations"][0];
    EXPECT_EQ(operation["op"], name);
    EXPECT_EQ(operation[operation["op"] == "sever" ? "bone" : "around"], bone);
    const LoadedCharacter torn = torn_by(name);
    const NewSurface made(source(), PosedModel(*torn.character, pose_of(used_tool)));
    EXPECT_FALSE(made.vertices.empty()) << name;
    // It lies about where the click was: at the limb, at that share.
    const Vec3d place = clicked_places(used_tool, posed).at(0);
    EXPECT_LT(made.distance_to_vertex(place), 0.15 * posed.diagonal) << name;
  }
}

void ViewPage::an_incision_names_places_of_the_surface() {
  const json& used_tool = facts_["incision"];
  EXPECT_EQ(used_tool["saved"], true);
  EXPECT_GT(facts_["pending_preview"], 0);
  EXPECT_EQ(facts_["without_operations"], 0);
  const PosedModel posed(source(), pose_of(used_tool));
  const json operation = read_json("saved/incision.json")["operations"][0];
  const std::vector<Vec3d> places = clicked_places(used_tool, posed);
  ASSERT_EQ(operation["points"].size(), places.size());
  const LoadedCharacter torn = torn_by("incision");
  const NewSurface made(source(), PosedModel(*torn.character, pose_of(used_tool)));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const json& point = operation["points"][i];
    const Index mesh = point["mesh"];
    const Triangle& triangle =
        source().meshes[mesh].triangles[point["triangle"].get<std::size_t>()];
    Vec3d place = Vec3d::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      place += point["barycentrics"][k].get<double>() * posed.positions[mesh][triangle[k]];
    EXPECT_LT((place - places[i]).norm(), kTolerance * posed.diagonal);
    EXPECT_LT(made.distance_to_edge(place), 0.01 * posed.diagonal);
  }
}

/// The segments that the page draws for a stroke and a plane lie on the lips that tearing makes.
/// The stroke passes from a branch to the trunk behind it, and there both are drawn.
void ViewPage::what_would_open_is_drawn_where_it_opens() {
  for (const char* const name : {"tear", "cut"}) {
    const json& used_tool = facts_[name];
    ASSERT_FALSE(used_tool["opened"].empty()) << name;
    const PoseSpec pose = pose_of(used_tool);
    const LoadedCharacter torn = torn_by(name);
    const PosedModel posed(*torn.character, pose);
    const NewSurface made(source(), posed);
    double length = 0, on_lips = 0;
    for (const json& segment : used_tool["opened"]) {
      const Vec3d from = vector_of(segment[0]), to = vector_of(segment[1]);
      length += (to - from).norm();
      // Snapping moves a lip.
      if (made.distance_to_edge(0.5 * (from + to)) < 2e-3 * posed.diagonal)
        on_lips += (to - from).norm();
    }
    EXPECT_GT(length, 0.02 * posed.diagonal) << name;
    EXPECT_GT(on_lips, (std::string(name) == "cut" ? 0.999 : 0.8) * length) << name;
  }
}

void ViewPage::saved_logs_follow_the_schema() {
  for (const char* const name : {"tear", "cut", "disc", "drill", "drill_rest", "drill_bind",
                                 "slash", "sever", "puncture", "incision"}) {
    const auto run =
        run_node_program("schema.mjs", "'" SUNDER_SOURCE_DIR "/docs/operation_log.schema.json' '" +
                                           path(std::string("saved/") + name + ".json") + "'");
    ASSERT_TRUE(run && run->succeeded) << (run ? run->output : "");
    EXPECT_EQ(json::parse(run->output), json::array()) << name;
  }
  json spoiled = read_json("saved/drill.json");
  spoiled["operations"][0]["radius"] = 0;
  const auto run =
      run_node_program("schema.mjs", "'" SUNDER_SOURCE_DIR "/docs/operation_log.schema.json' '" +
                                         write("spoiled.json", spoiled.dump()) + "'");
  EXPECT_FALSE(json::parse(run->output).empty()) << "the check can fail";
}

void ViewPage::undo_and_redo_change_the_list() {
  EXPECT_EQ(facts_["undo"], json({3, 2, 1, 2, 1, 2, 2, 0, 1}));
  EXPECT_EQ(facts_["typed"], json({"tear", 0.125}));
  EXPECT_THAT(facts_["beside"].get<std::string>(), HasSubstr("no surface"));
  EXPECT_EQ(facts_["dropped"], 0) << "points of another pose";
  EXPECT_EQ(facts_["copied"], "The log is in the clipboard.");
}

void ViewPage::can_be_used_without_a_mouse_and_on_a_narrow_screen() {
  EXPECT_EQ(facts_["bone"]["shown"], facts_["bone"]["name"]);
  EXPECT_GT(facts_["changed_by_overlays"], 0);
  EXPECT_GT(facts_["changed_by_colours"], 0.02);
  EXPECT_EQ(facts_["nameless"], json::array());
  EXPECT_EQ(facts_["help"], true);
  EXPECT_LE(facts_["narrow"], 400);
  EXPECT_GT(facts_["narrow_share"], 0.03);
  EXPECT_LT(facts_["bytes"], 3 << 20);
}

/// A tear, and a bounded cut that takes off an arm's end or the top: whatever is separated.
constexpr const char* kOperations = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "pose": {"clip": "Sway", "time": 0.8},
   "stroke": [{"base": [-0.1, 0.85, 2], "tip": [-0.1, 0.85, 0]}, {"base": [-0.12, 0.95, 2], "tip": [-0.12, 0.95, 0]},
              {"base": [-0.1, 1.1, 2], "tip": [-0.1, 1.1, 0]}]},
  {"op": "cut", "plane": {"point": [0, 1.3, 0], "normal": [0, 1, 0.1]}, "pose": {"clip": 0, "time": 1.3}},
  {"op": "undo"}, {"op": "redo"}]})";

TEST_F(ViewPage, shows_lips_and_pieces_of_a_torn_model_and_continues_its_log) {
  const std::string log = write("ops.json", kOperations), torn = path("torn.glb");
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", log, "-o", torn}).exit_code, 0);
  const auto result = run_sunder({"view", model(), torn, "--ops", log, "-o", path("torn.html")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json facts = used("torn", path("torn.html"), "");
  EXPECT_EQ(facts["which"], "target") << "the torn model is shown first";
  // Some pixels of the pink flowers have the colour of lips.
  const double lips_of_source = facts["source"]["lips"];
  EXPECT_LT(lips_of_source, 1e-4);
  EXPECT_GT(facts["torn"]["lips"], lips_of_source + 1e-4);
  EXPECT_GT(facts["torn"]["piece"], 1e-3);
  EXPECT_EQ(facts["source"]["piece"], 0.0);
  EXPECT_LT(facts["torn"]["outline_distance"], 4.0) << "lips stand out by half of their width";
  EXPECT_THAT(facts["facts"].get<std::string>(), HasSubstr("piece 1"));
  EXPECT_EQ(facts["listed"].size(), 4u);
  EXPECT_THAT(facts["listed"][0].get<std::string>(), HasSubstr("0.80 s of Sway"));
  EXPECT_EQ(facts["pose"], json({0, 0.8, nullptr})) << "a click goes to the pose of an operation";
  // The log that the page holds makes the same model.
  const std::string again = write("again.json", facts["text"].get<std::string>());
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", again, "-o", path("again.glb")}).exit_code, 0);
  EXPECT_EQ(bytes("again.glb"), bytes("torn.glb"));
}

TEST_F(ViewPage, goes_to_every_kind_of_pose_of_a_log) {
  BonesPose bent;
  bent.bones.push_back({source().skeleton.bones[2].name, Vec3f(0.1f, 0.5f, 0.0f),
                        Quatf(0.8f, 0.6f, 0.0f, 0.0f), Vec3f(1.0f, 1.2f, 0.9f)});
  bent.bones.push_back({source().skeleton.bones[1].name, {}, Quatf(0.6f, 0.0f, 0.0f, 0.8f), {}});
  const std::vector<PoseSpec> poses = {
      RestPose{},         BindPose{}, ClipPose{"Sway", 0.7},
      ClipPose{1u, 0.55}, bent,       *make_pose(source(), ClipPose{"Sway", 1.1})};
  Bore bore;
  bore.radius = 0.1;
  bore.depth = 1.0;
  std::vector<Operation> operations;
  for (const PoseSpec& pose : poses) operations.push_back(DrillOperation{pose, bore});
  operations.push_back(DrillOperation{ClipPose{"No such", 0.0}, bore});
  ASSERT_TRUE(save_operations(path("given.json"), operations));
  ASSERT_EQ(run_sunder({"view", model(), "--ops", path("given.json"), "-o", path("given.html")})
                .exit_code,
            0);
  const json facts = used("given", path("given.html"), "");
  ASSERT_EQ(facts["positions"].size(), operations.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PosedModel posed(source(), poses[i]);
    std::size_t at = 0;
    double worst = 0;
    for (const auto& positions : posed.positions)
      for (const Vec3d& position : positions)
        for (int axis = 0; axis < 3; ++axis)
          worst =
              std::max(worst, std::abs(facts["positions"][i][at++].get<double>() - position[axis]));
    EXPECT_EQ(at, facts["positions"][i].size());
    EXPECT_LT(worst, 1e-6 * posed.diagonal) << "pose " << i;
  }
  EXPECT_THAT(facts["said"].get<std::string>(), HasSubstr("no clip 'No such'"));
}

/// The channel of a pixel that is clearly the largest: 0, 1, 2; otherwise -1, as of grey.
int hue_of(const json& pixel) {
  for (std::size_t c = 0; c < 3; ++c) {
    const int other = std::max(pixel[(c + 1) % 3].get<int>(), pixel[(c + 2) % 3].get<int>());
    if (pixel[c].get<int>() > 2 * other) return static_cast<int>(c);
  }
  return -1;
}

TEST_F(ViewPage, a_texture_transform_moves_and_turns_the_image) {
  constexpr Texel kRed = {200, 0, 0, 255}, kGreen = {0, 200, 0, 255}, kBlue = {0, 0, 200, 255},
                  kGrey = {90, 90, 90, 255};
  test::GltfBuilder builder;
  builder.json["scene"] = 0;
  builder.json["extensionsUsed"] = OrderedJson::array({"KHR_texture_transform"});
  // From the upper left: red, green, blue, grey.
  OrderedJson material = textured(add_texture(builder, {kRed, kGreen, kBlue, kGrey}));
  add_square(builder, 0, 0, material);
  OrderedJson& reference = material["pbrMetallicRoughness"]["baseColorTexture"];
  reference["extensions"]["KHR_texture_transform"] = {{"offset", {0.75, 0.25}}, {"scale", {0, 0}}};
  add_square(builder, 1, 0, material);
  // A quarter turn: (u, v) -> (v, -u), which repeats.
  reference["extensions"]["KHR_texture_transform"] = {{"rotation", 1.5707963267948966}};
  add_square(builder, 2, 0, material);
  const std::vector<std::byte> glb = builder.glb();
  write("turned.glb", {reinterpret_cast<const char*>(glb.data()), glb.size()});
  ASSERT_EQ(run_sunder({"view", path("turned.glb"), "-o", path("turned.html")}).exit_code, 0);
  // In each square: the middles of the texels from the upper left, if nothing is turned.
  std::string places;
  for (const double square : {0.0, 1.0, 2.0})
    for (const double v : {0.25, 0.75})
      for (const double u : {0.25, 0.75})
        places += std::to_string(square + u) + "," + std::to_string(1 - v) + ",0/";
  places.pop_back();
  const json facts = used("colours", path("turned.html"), places);
  std::vector<int> hues;
  for (const json& pixel : facts["colours"]) hues.push_back(hue_of(pixel));
  // Turned: (0.25, 0.25) -> (0.25, 0.75), (0.75, 0.25) -> (0.25, 0.25), (0.25, 0.75) -> (0.75,
  // 0.75).
  EXPECT_EQ(hues, (std::vector<int>{0, 1, 2, -1, 1, 1, 1, 1, 2, 0, -1, 1}));
}

TEST_F(ViewPage, says_that_its_data_cannot_be_read) {
  std::ostringstream text;
  text << std::ifstream(path("view.html")).rdbuf();
  std::string page = text.str();
  const std::string mark = "type=\"text/plain\">";
  page.replace(page.find(mark) + mark.size(), 4, "AAAA");
  const json facts = used("broken", write("broken.html", page), "");
  EXPECT_THAT(facts["error"].get<std::string>(), HasSubstr("This is not the data of a page"));
}

/// Distance of a place from the line through two points.
double from_line(const Vec3d& place, const Vec3d& a, const Vec3d& b) {
  return (place - a).cross((b - a).normalized()).norm();
}

/// The largest distance of what the tools of a page made from the places that were clicked, found
/// again by the library's pose, as a share of the model's diagonal.
double largest_miss(const Character& model, const json& facts) {
  const bool has_clips = facts["has_clips"];
  const PosedModel posed(
      model, has_clips ? PoseSpec(ClipPose{facts["clip"].get<Index>(), facts["time"].get<double>()})
                       : PoseSpec(RestPose{}));
  const json &operations = facts["log"]["operations"], &axis = operations[0]["axis"],
             &plane = operations[1]["plane"], &stroke = operations[2]["stroke"];
  const auto place = [&](const char* tool, std::size_t click) {
    const json& ray = facts[tool][click];
    return posed.hit({vector_of(ray["eye"]), vector_of(ray["direction"])});
  };
  const Vec3d origin = vector_of(axis["origin"]);
  double miss = from_line(place("drill", 0), origin, origin + vector_of(axis["direction"]));
  for (const std::size_t click : {0, 1}) {
    miss = std::max(
        miss,
        std::abs(vector_of(plane["normal"]).dot(place("cut", click) - vector_of(plane["point"]))));
    const json& blade = click == 0 ? stroke.front() : stroke.back();
    miss = std::max(
        miss, from_line(place("tear", click), vector_of(blade["base"]), vector_of(blade["tip"])));
  }
  return miss / posed.diagonal;
}

TEST_F(ViewPage, clicks_meet_the_surface_of_real_models) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  // Base colours, textures, morph targets, no clips; read from GLB, FBX and COLLADA.
  const std::vector<const char*> names = {"robot_expressive.glb", "vr_glove.fbx", "fox.glb",
                                          "cesium_man.dae",       "cactoro.glb",  "mannequiny.glb"};
  for (const char* const name :
       std::span(names).first(static_cast<std::size_t>(test::stressed(3, 2)))) {
    const auto file = test::shared_models() / "rigged" / name;
    ASSERT_EQ(run_sunder({"view", file.string(), "-o", path("real.html")}).exit_code, 0) << name;
    const json facts = used("probe", path("real.html"), "");
    const auto loaded = load_character(file);
    ASSERT_TRUE(loaded) << name;
    EXPECT_LT(largest_miss(*loaded->character, facts), 1e-6) << name;
    EXPECT_LT(facts["outline_distance"], 2.5) << name;
    const std::string log = write("real.json", facts["log"].dump());
    EXPECT_LE(run_sunder({"tear", file.string(), "--ops", log, "-o", path("real.glb")}).exit_code,
              1)
        << name;
  }
}

using View = CactusSuite;

TEST_F(View, refuses_what_it_cannot_show) {
  const auto exit_code = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"-o", path("refused.html")});
    return run_sunder(arguments).exit_code;
  };
  EXPECT_EQ(run_sunder({"view", model()}).exit_code, 2) << "no output";
  EXPECT_EQ(run_sunder({"view"}).exit_code, 2);
  if (run_sunder({"view", model(), "-o", path("shown.html")}).exit_code == 2)
    GTEST_SKIP() << "built without pages (scripts/setup page)";
  EXPECT_EQ(exit_code({"view", path("absent.glb")}), 3);
  EXPECT_EQ(exit_code({"view", model(), path("absent.glb")}), 3);
  EXPECT_EQ(exit_code({"view", model(), "--ops", path("absent.json")}), 3);
  EXPECT_EQ(exit_code({"view", model(), "--ops", write("bad.json", "{}")}), 2);
  EXPECT_FALSE(exists("refused.html"));
  const auto model_bytes = bytes("cactus.glb");
  EXPECT_EQ(run_sunder({"view", model(), "-o", model()}).exit_code, 2) << "the model itself";
  EXPECT_EQ(bytes("cactus.glb"), model_bytes);
  EXPECT_EQ(run_sunder({"view", model(), "-o", path("no/such/folder.html")}).exit_code, 3);
}

TEST_F(View, needs_a_build_with_pages) {
  const auto result = run_sunder_without_page({"view", model(), "-o", path("none.html")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("scripts/setup page"));
  EXPECT_FALSE(exists("none.html"));
}

}  // namespace
}  // namespace sunder::command_test
