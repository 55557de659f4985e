// What a character becomes as USD: names, numbers, subsets, influences, packages; how the file
// moves is in acceptance/usd_files_test.cpp.
#include <sunder/io/usd_file.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>
#include <zlib.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/internal/base_colours.h"
#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"
#include "support/models/rich_mesh.h"
#include "support/models/rigs.h"
#include "tools/textured_squares.h"

namespace sunder {
namespace {

using command_test::OrderedJson;
using test::Random;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string text_of(const Character& character, const SaveOptions& options = {}) {
  const auto layer = usd_layer(character, {}, options);
  EXPECT_TRUE(layer) << layer.error().text();
  return layer ? layer->text : std::string();
}

/// What stands behind "declaration = " the first time, to the end of its line; empty without one.
std::string value_of(const std::string& text, const std::string& declaration) {
  const std::size_t begin = text.find(declaration + " = ");
  if (begin == std::string::npos) return {};
  const std::size_t value = begin + declaration.size() + 3;
  return text.substr(value, text.find('\n', value) - value);
}

/// All numbers of an array, whatever brackets are around them.
template <class Number>
std::vector<Number> numbers_of(const std::string& array) {
  std::vector<Number> numbers;
  for (const char* at = array.data(); at < array.data() + array.size();) {
    Number number = 0;
    const auto read = std::from_chars(at, array.data() + array.size(), number);
    if (read.ec == std::errc()) numbers.push_back(number);
    at = read.ec == std::errc() ? read.ptr : at + 1;
  }
  return numbers;
}

std::vector<std::string> strings_of(const std::string& array) {
  std::vector<std::string> found;
  static const std::regex literal("\"((?:[^\"\\\\]|\\\\.)*)\"");
  for (std::sregex_iterator it(array.begin(), array.end(), literal), end; it != end; ++it)
    found.push_back((*it)[1]);
  return found;
}

TEST(UsdFile, numbers_have_the_bits_of_the_model) {
  Random random(3);
  Character character = test::make_tube(40, 40, 3);
  Mesh& mesh = character.meshes[0];
  mesh.uv_sets.clear();
  for (Vec3f& position : mesh.positions)
    for (int i = 0; i < 3; ++i) {
      float value = 0;
      do {
        value = std::bit_cast<float>(random.index(0xffffffffu));
      } while (!std::isfinite(value));
      position[i] = value;
    }
  const std::string text = text_of(character);
  const std::vector<float> found = numbers_of<float>(value_of(text, "point3f[] points"));
  ASSERT_EQ(found.size(), mesh.positions.size() * 3);
  EXPECT_EQ(std::memcmp(found.data(), mesh.positions.data(), found.size() * sizeof(float)), 0);
  EXPECT_EQ(text.find("inf"), std::string::npos);
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(UsdFile, the_same_character_gives_the_same_bytes) {
  const Character character = test::make_tube(9, 8, 3);
  EXPECT_EQ(text_of(character), text_of(Character(character)));
}

TEST(UsdFile, names_are_identifiers_and_kept_beside_them) {
  Character character = test::make_two_tubes(4, 5);
  const std::vector<std::string> names = {"1 spine",   "K\xc3\xb6pfe", "a b", "a_b",
                                          "quo\"te\\", "line\nbreak",  "a/b", "."};
  ASSERT_LE(character.skeleton.bones.size(), names.size());
  for (std::size_t i = 0; i < character.skeleton.bones.size(); ++i)
    character.skeleton.bones[i].name = names[i];
  character.meshes[0].name.clear();
  character.meshes[1].name = "Skeleton";  // as a prim of the file is called
  character.name = "3 <tubes>";
  const std::string text = text_of(character);
  EXPECT_THAT(text,
              AllOf(HasSubstr("def SkelRoot \"_3__tubes_\" (\n    displayName = \"3 <tubes>\""),
                    HasSubstr("defaultPrim = \"_3__tubes_\""), HasSubstr("def Mesh \"Mesh\""),
                    HasSubstr("def Mesh \"Skeleton_2\"")));
  const std::regex path("([A-Za-z_][A-Za-z0-9_]*/)*[A-Za-z_][A-Za-z0-9_]*");
  const std::vector<std::string> joints = strings_of(value_of(text, "uniform token[] joints"));
  std::set<std::string> leaves;
  for (const std::string& joint : joints) {
    EXPECT_TRUE(std::regex_match(joint, path)) << joint;
    EXPECT_TRUE(leaves.insert(joint.substr(joint.rfind('/') + 1)).second) << joint;
  }
  EXPECT_EQ(joints.size(), character.skeleton.bones.size());
  EXPECT_EQ(value_of(text_of(test::make_tube(4, 5, 2)), "uniform token[] jointNames"), "")
      << "the joints are called as the bones";
  const std::vector<std::string> kept = strings_of(value_of(text, "uniform token[] jointNames"));
  ASSERT_EQ(kept.size(), joints.size());
  EXPECT_EQ(kept[0], "1 spine");
  EXPECT_EQ(kept[1], "K\xc3\xb6pfe");
}

TEST(UsdFile, a_hundred_thousand_equal_names_take_no_time) {
  Character character = test::make_sheet(1);
  for (int i = 0; i < 100'000; ++i) character.clips.push_back({"Walk", 0, {}});
  EXPECT_THAT(text_of(character), HasSubstr("\"Walk_100000\""));
}

TEST(UsdFile, every_face_is_in_one_subset) {
  Character character = test::make_tube(6, 7, 3);
  Mesh& mesh = character.meshes[0];
  mesh.triangles[4] = {1, 1, 1};  // retired
  ASSERT_EQ(mesh.submeshes.size(), 2u);
  const std::string text = text_of(character);
  EXPECT_EQ(numbers_of<int>(value_of(text, "int[] faceVertexCounts")).size(),
            mesh.triangles.size() - 1);
  std::vector<int> faces;
  std::size_t subsets = 0;
  for (std::size_t at = text.find("def GeomSubset"); at != std::string::npos;
       at = text.find("def GeomSubset", at + 1), ++subsets) {
    const std::vector<int> own = numbers_of<int>(value_of(text.substr(at), "int[] indices"));
    faces.insert(faces.end(), own.begin(), own.end());
  }
  EXPECT_EQ(subsets, 2u);
  std::sort(faces.begin(), faces.end());
  ASSERT_EQ(faces.size(), mesh.triangles.size() - 1);
  for (std::size_t i = 0; i < faces.size(); ++i) EXPECT_EQ(faces[i], static_cast<int>(i));
}

TEST(UsdFile, influences_are_as_many_as_asked_for) {
  Character character = test::make_tube(6, 7, 9);
  Mesh& mesh = character.meshes[0];
  SkinWeights weights;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    std::vector<Influence> influences;
    for (std::uint32_t slot = 0; slot < 7; ++slot)
      influences.push_back({slot, (slot == 0 ? 2.0f : 1.0f) / 8.0f});
    weights.append(influences);
  }
  mesh.weights = weights;
  for (const auto& [maximum, written] :
       std::map<std::uint32_t, std::size_t>{{0, 7}, {4, 4}, {8, 7}, {kAllInfluences, 7}}) {
    SaveOptions options;
    options.maximum_influences = maximum;
    const std::string text = text_of(character, options);
    const auto found = numbers_of<float>(value_of(text, "float[] primvars:skel:jointWeights"));
    ASSERT_EQ(found.size(), mesh.vertex_count() * written);
    EXPECT_THAT(text, HasSubstr("elementSize = " + std::to_string(written)));
    float sum = 0;
    for (std::size_t i = 0; i < written; ++i) sum += found[i];
    EXPECT_NEAR(sum, 1, 1e-6);
  }
}

TEST(UsdFile, texture_coordinates_count_upwards_and_attributes_of_all_kinds_are_kept) {
  Character character = test::make_tube(5, 7, 4);
  character.meshes[0] = test::rich_mesh();
  const Mesh& mesh = character.meshes[0];
  const std::string text = text_of(character);
  const auto st = numbers_of<float>(value_of(text, "texCoord2f[] primvars:st"));
  ASSERT_EQ(st.size(), mesh.uv_sets[0].size() * 2);
  for (std::size_t v = 0; v < mesh.uv_sets[0].size(); ++v) {
    EXPECT_EQ(st[2 * v], mesh.uv_sets[0][v].x());
    EXPECT_EQ(st[2 * v + 1], 1 - mesh.uv_sets[0][v].y());
  }
  EXPECT_EQ(numbers_of<float>(value_of(text, "color3f[] primvars:displayColor")).size(),
            mesh.positions.size() * 3);
  EXPECT_EQ(numbers_of<float>(value_of(text, "float2[] primvars:_HEAT")),
            mesh.custom_attributes[0].values);
  EXPECT_EQ(numbers_of<float>(value_of(text, "float[] primvars:_PART")),
            mesh.custom_attributes[1].values);
  EXPECT_EQ(value_of(text, "float[] primvars:displayOpacity"), "") << "all are opaque";
}

TEST(UsdFile, one_clip_is_bound_and_several_are_variants) {
  Character character = test::make_tube(6, 7, 3);
  ASSERT_EQ(character.clips.size(), 1u);
  EXPECT_THAT(text_of(character),
              AllOf(HasSubstr("rel skel:animationSource = </"), Not(HasSubstr("variant"))));
  character.clips.push_back(character.clips[0]);
  EXPECT_THAT(text_of(character),
              AllOf(HasSubstr("string clip = \"Bend\""),
                    HasSubstr("over \"Skeleton\" {\n                rel skel:animationSource = </"),
                    HasSubstr("/Clips/Bend_2>")));
}

TEST(UsdFile, time_codes_are_whole_where_the_keys_allow_it) {
  Character character = test::make_sheet(2);
  Channel channel{ChannelTarget::translation, 0, 3, Interpolation::linear, {}, {}};
  for (int frame = 0; frame < 300; ++frame) {
    channel.times.push_back(static_cast<float>(frame) / 30.0f);
    channel.values.insert(channel.values.end(), 3, static_cast<float>(frame % 7));
  }
  character.clips.push_back({"Walk", channel.times.back(), {channel}});
  const std::string text = text_of(character);
  EXPECT_THAT(text, AllOf(HasSubstr("timeCodesPerSecond = 30\n"), HasSubstr("endTimeCode = 299\n"),
                          HasSubstr("\n                299: [("), Not(HasSubstr("299.0"))));
}

TEST(UsdFile, keys_at_times_of_their_own_make_no_flood_of_samples) {
  Character character = test::make_tube(4, 5, 80);
  Random random(6);
  Clip clip;
  clip.name = "Wave";
  for (std::uint32_t bone = 0; bone < 80; ++bone) {
    Channel channel{ChannelTarget::rotation, bone, 4, Interpolation::linear, {}, {}};
    for (int key = 0; key < 300; ++key) {
      const double time = (key + random.uniform(0, 0.9)) / 60;
      const double angle = 0.3 * std::sin(2 * time + bone);
      channel.times.push_back(static_cast<float>(time));
      for (const double value : {std::sin(angle / 2), 0.0, 0.0, std::cos(angle / 2)})
        channel.values.push_back(static_cast<float>(value));
    }
    clip.duration = std::max(clip.duration, channel.times.back());
    clip.channels.push_back(std::move(channel));
  }
  character.clips = {clip};
  const std::string text = text_of(character);
  EXPECT_LT(text.size(), 10'000'000u) << "of all keys there would be 24,000 x 80 rotations";
  const std::size_t begin = text.find("quatf[] rotations.timeSamples");
  const std::string samples = text.substr(begin, text.find('}', begin) - begin);
  const auto rate = numbers_of<double>(value_of("x" + text, "timeCodesPerSecond")).at(0);
  std::size_t count = 0;
  double largest = 0;
  for (std::size_t line = samples.find('\n'); line != std::string::npos;
       line = samples.find('\n', line + 1)) {
    const auto numbers =
        numbers_of<double>(samples.substr(line + 1, samples.find('\n', line + 1) - line - 1));
    if (numbers.size() != 321) continue;
    ++count;
    const double seconds = numbers[0] / rate;
    if (seconds < 1.0 / 60 || seconds > 299.0 / 60) continue;  // a first or last key is held there
    for (std::uint32_t bone = 0; bone < 80; ++bone) {
      const double angle = 2 * std::atan2(numbers[4 * bone + 2], numbers[4 * bone + 1]);
      largest = std::max(largest, std::abs(angle - 0.3 * std::sin(2 * seconds + bone)));
    }
  }
  EXPECT_GT(count, 50u);
  EXPECT_LT(count, 3000u);
  EXPECT_LT(largest, 1e-3) << "the keys themselves are 1/60 s apart";

  // A clip that no file should hold.
  for (Channel& channel : character.clips[0].channels) {
    channel.times.clear();
    channel.values.clear();
    for (int key = 0; key < 3000; ++key) {
      channel.times.push_back(static_cast<float>((key + random.uniform(0, 0.9)) / 60));
      for (const float value : {0.0f, 0.0f, 0.0f, 1.0f}) channel.values.push_back(value);
    }
  }
  character.clips[0].duration = 50;
  for (const Channel& channel : character.clips[0].channels)
    character.clips[0].duration = std::max(character.clips[0].duration, channel.times.back());
  const auto refused = usd_layer(character, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code(), StatusCode::limit_exceeded) << refused.error().text();
}

/// Keys of one bone make samples of all bones that the clip moves, and so do those of one weight.
TEST(UsdFile, samples_are_counted_as_they_are_written) {
  const auto channel = [](ChannelTarget target, std::uint32_t index, std::uint32_t width,
                          int keys) {
    Channel made{target, index, width, Interpolation::linear, {}, {}};
    for (int key = 0; key < keys; ++key) {
      made.times.push_back(static_cast<float>(key) / 32.0f);
      made.values.insert(made.values.end(), width - 1, 0.0f);
      made.values.push_back(1);
    }
    return made;
  };
  const auto clip_of = [](std::vector<Channel> channels) {
    float duration = 0;
    for (const Channel& of : channels) duration = std::max(duration, of.times.back());
    return Clip{"Clip", duration, std::move(channels)};
  };
  Character character = test::make_tube(4, 5, 1000);
  character.clips.clear();
  std::vector<Channel> channels;
  for (std::uint32_t bone = 0; bone < 1000; ++bone)
    channels.push_back(channel(ChannelTarget::translation, bone, 3, 1));
  channels.push_back(channel(ChannelTarget::rotation, 7, 4, 17'000));
  character.clips = {clip_of(channels)};
  const auto bones = usd_layer(character, {});
  ASSERT_FALSE(bones);
  EXPECT_EQ(bones.error().code(), StatusCode::limit_exceeded);
  EXPECT_THAT(bones.error().text(), HasSubstr("1000 values at 17000 times"));

  channels.back() = channel(ChannelTarget::rotation, 7, 4, 400);
  character.clips.assign(50, clip_of(channels));
  const auto clips = usd_layer(character, {});  // each of them has 402,000
  ASSERT_FALSE(clips);
  EXPECT_THAT(clips.error().text(), HasSubstr("clips before it 16"));
  character.clips.resize(1);
  EXPECT_TRUE(usd_layer(character, {}));

  Character face = test::make_sheet(2);
  face.rest_morph_weights.assign(1000, 0.0f);
  face.meshes[0].morph_targets.assign(
      1000, {"shape", std::vector<Vec3f>(face.meshes[0].positions.size(), Vec3f::Zero()), {}, {}});
  face.clips = {clip_of({channel(ChannelTarget::morph_weights, 3, 1, 17'000)})};
  const auto weights = usd_layer(face, {});
  ASSERT_FALSE(weights);
  EXPECT_THAT(weights.error().text(), HasSubstr("1000 values at 17000 times"));
}

TEST(UsdFile, faults_are_named) {
  const Character character = test::make_tube(4, 5, 2);
  SaveOptions options;
  options.weights = WeightFormat::unorm8;
  EXPECT_THAT(std::string(usd_layer(character, {}, options).error().text()), HasSubstr("floats"));
  options = {};
  options.maximum_influences = 5;
  EXPECT_EQ(usd_layer(character, {}, options).error().code(), StatusCode::invalid_argument);
  Character broken = character;
  broken.meshes[0].positions[3].x() = std::nanf("");
  EXPECT_EQ(usd_layer(broken, {}).error().code(), StatusCode::non_finite_value);
  options = {};
  options.materials = {{"Flesh"}};
  Character other = character;
  other.meshes[0].submeshes[0].material = 1;
  EXPECT_EQ(usd_layer(other, {}, options).error().code(), StatusCode::index_out_of_range);

  const test::TemporaryFolder folder;
  const auto unknown = save_usd(folder.path() / "a.usdc", character);
  EXPECT_EQ(unknown.error().code(), StatusCode::unsupported_format);
  const auto nowhere = save_usd(folder.path() / "none" / "a.usda", character);
  EXPECT_EQ(nowhere.error().code(), StatusCode::file_unreadable);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

/// A square with a material of everything that glTF knows.
test::GltfBuilder everything() {
  test::GltfBuilder builder;
  const OrderedJson place = {
      {"KHR_texture_transform",
       {{"offset", {0.3, -0.2}}, {"rotation", 0.7}, {"scale", {2.0, -0.5}}}}};
  const std::size_t first = command_test::add_texture(builder, command_test::Texel{1, 2, 3, 255}),
                    second = command_test::add_texture(builder, command_test::Texel{4, 5, 6, 255});
  OrderedJson material = {{"name", "Skin & bone"},
                          {"alphaMode", "MASK"},
                          {"alphaCutoff", 0.25},
                          {"doubleSided", true},
                          {"emissiveFactor", {0.1, 0.2, 0.3}}};
  material["pbrMetallicRoughness"] = {
      {"baseColorFactor", {0.5, 0.25, 1.0, 0.75}},
      {"metallicFactor", 0.125},
      {"roughnessFactor", 0.375},
      {"baseColorTexture", {{"index", first}, {"extensions", place}}},
      {"metallicRoughnessTexture", {{"index", second}}}};
  material["normalTexture"] = {{"index", second}, {"scale", 0.5}};
  material["occlusionTexture"] = {{"index", second}, {"strength", 0.75}};
  builder.json["extensionsUsed"] = OrderedJson::array({"KHR_texture_transform"});
  command_test::add_square(builder, 0, 0, material);
  return builder;
}

/// The block of a prim of a type and name.
std::string prim(const std::string& text, const std::string& head) {
  const std::size_t begin = text.find("def " + head);
  return begin == std::string::npos ? std::string()
                                    : text.substr(begin, text.find("}\n", begin) - begin);
}

TEST(UsdFile, materials_become_preview_surfaces) {
  const auto loaded = everything().load();
  ASSERT_TRUE(loaded) << loaded.error().text();
  const auto layer = usd_layer(*loaded->character, *loaded, {}, "pictures");
  ASSERT_TRUE(layer) << layer.error().text();
  const std::string& text = layer->text;
  EXPECT_EQ(layer->textures.size(), 2u);
  for (const UsdLayer::Texture& texture : layer->textures)
    EXPECT_THAT(text, HasSubstr("@./" + texture.path + "@"));
  EXPECT_THAT(
      text,
      AllOf(HasSubstr("def Material \"Skin___bone\""), HasSubstr("displayName = \"Skin & bone\""),
            HasSubstr("rel material:binding = <"), HasSubstr("uniform bool doubleSided = 1")));
  const std::string surface = prim(text, "Shader \"Surface\"");
  EXPECT_THAT(
      surface,
      AllOf(HasSubstr("/BaseColour.outputs:rgb>"), HasSubstr("/BaseColour.outputs:a>"),
            HasSubstr("inputs:opacityThreshold = 0.25"), HasSubstr("inputs:roughness.connect = <"),
            HasSubstr("/MetallicRoughness.outputs:g>"), HasSubstr("/MetallicRoughness.outputs:b>"),
            HasSubstr("/Normal.outputs:rgb>"), HasSubstr("/Occlusion.outputs:r>"),
            HasSubstr("inputs:emissiveColor = (0.1, 0.2, 0.3)")));
  EXPECT_THAT(prim(text, "Shader \"BaseColour\""),
              AllOf(HasSubstr("inputs:scale = (0.5, 0.25, 1, 0.75)"), HasSubstr("\"sRGB\"")));
  EXPECT_THAT(prim(text, "Shader \"MetallicRoughness\""),
              AllOf(HasSubstr("inputs:scale = (1, 0.375, 0.125, 1)"), HasSubstr("\"raw\"")));
  EXPECT_THAT(prim(text, "Shader \"Normal\""),
              AllOf(HasSubstr("inputs:scale = (1, 1, 2, 1)"),
                    HasSubstr("inputs:bias = (-0.5, -0.5, -1, 0)")));
  EXPECT_THAT(prim(text, "Shader \"Occlusion\""),
              AllOf(HasSubstr("inputs:scale = (0.75, 0.75, 0.75, 1)"),
                    HasSubstr("inputs:bias = (0.25, 0.25, 0.25, 0)")));
}

TEST(UsdFile, the_folder_of_textures_is_made_and_taken_back_only_where_it_was_absent) {
  const auto loaded = everything().load();
  ASSERT_TRUE(loaded) << loaded.error().text();
  const test::TemporaryFolder folder;
  const auto save = [&](const char* name) {
    return save_usd(folder.path() / name, *loaded->character, *loaded);
  };
  // A folder that has the name of the file makes a save fail when textures are already staged.
  for (const char* const name : {"absent.usda", "empty.usda", "link.usda"})
    std::filesystem::create_directory(folder.path() / name);
  std::filesystem::create_directory(folder.path() / "empty_textures");
  std::filesystem::create_directory(folder.path() / "elsewhere");
  std::filesystem::create_directory_symlink("elsewhere", folder.path() / "link_textures");
  for (const char* const name : {"absent.usda", "empty.usda", "link.usda"})
    EXPECT_EQ(save(name).error().code(), StatusCode::file_unreadable);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "absent_textures"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "empty_textures"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link_textures"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "elsewhere"));

  std::filesystem::remove(folder.path() / "link.usda");
  ASSERT_TRUE(save("link.usda"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link_textures"));
  EXPECT_FALSE(std::filesystem::is_empty(folder.path() / "elsewhere"));
}

TEST(UsdFile, moved_textures_lie_where_gltf_puts_them) {
  const auto loaded = everything().load();
  ASSERT_TRUE(loaded) << loaded.error().text();
  const auto colours = read_base_colours(*loaded->source, kMostImageBytes);
  ASSERT_TRUE(colours);
  const std::string moved =
      prim(usd_layer(*loaded->character, *loaded)->text, "Shader \"BaseColourCoordinates\"");
  const auto value = [&](const char* declaration) {
    return numbers_of<double>(value_of(moved, declaration));
  };
  const auto scale = value("float2 inputs:scale"), shift = value("float2 inputs:translation");
  ASSERT_EQ(scale.size() + shift.size(), 4u) << moved;
  const double angle = value("float inputs:rotation").at(0) * 3.14159265358979 / 180;
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const float u = static_cast<float>(random.uniform(-2, 2)),
                v = static_cast<float>(random.uniform(-2, 2));
    const Vec2f image = colours->materials[0].image_from_uv * Vec3f(u, v, 1);
    // UsdTransform2d: scaled, then turned counter-clockwise, then moved.
    const double s = scale[0] * static_cast<double>(u), t = scale[1] * (1 - static_cast<double>(v));
    EXPECT_NEAR(std::cos(angle) * s - std::sin(angle) * t + shift[0],
                static_cast<double>(image.x()), 1e-5);
    EXPECT_NEAR(std::sin(angle) * s + std::cos(angle) * t + shift[1],
                1 - static_cast<double>(image.y()), 1e-5);
  }
}

TEST(UsdFile, a_package_of_more_files_than_a_zip_counts_is_refused) {
  UsdLayer layer;
  for (int i = 0; i < 65'534; ++i) layer.textures.push_back({"t" + std::to_string(i), {}});
  EXPECT_TRUE(usdz_package(layer, "torn.usda")) << "65,535 with the text";
  layer.textures.push_back({"one more", {}});
  const auto refused = usdz_package(layer, "torn.usda");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code(), StatusCode::limit_exceeded);
  EXPECT_THAT(refused.error().text(), HasSubstr("65535 files"));
}

std::uint32_t number_at(const std::vector<std::byte>& bytes, std::size_t at, std::size_t size) {
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < size; ++i)
    number |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return number;
}

TEST(UsdFile, a_package_is_a_stored_zip_at_multiples_of_64) {
  Random random(5);
  UsdLayer layer;
  layer.text = "#usda 1.0\n";
  for (std::size_t i = 0; i < 70; ++i) {
    std::vector<std::byte> bytes(random.index(300));
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.index(256));
    layer.textures.push_back({"textures/image_" + std::string(i, 'x') + ".png", bytes});
  }
  const auto zip = usdz_package(layer, "torn.usda");
  ASSERT_TRUE(zip);
  const std::size_t end = zip->size() - 22;
  ASSERT_EQ(number_at(*zip, end, 4), 0x06054b50u);
  const std::uint32_t count = number_at(*zip, end + 10, 2);
  ASSERT_EQ(count, 71u);
  std::size_t entry = number_at(*zip, end + 16, 4);
  EXPECT_EQ(entry + number_at(*zip, end + 12, 4), end);
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(number_at(*zip, entry, 4), 0x02014b50u);
    const std::size_t name_size = number_at(*zip, entry + 28, 2),
                      local = number_at(*zip, entry + 42, 4), size = number_at(*zip, entry + 24, 4);
    const std::string name(reinterpret_cast<const char*>(zip->data() + entry + 46), name_size);
    EXPECT_EQ(name, i == 0 ? "torn.usda" : layer.textures[i - 1].path);
    EXPECT_EQ(number_at(*zip, local, 4), 0x04034b50u);
    EXPECT_EQ(number_at(*zip, local + 8, 2), 0u) << "compressed";
    const std::size_t extra = number_at(*zip, local + 28, 2);
    EXPECT_EQ(number_at(*zip, local + 30 + name_size + 2, 2) + 4, extra);
    const std::size_t data = local + 30 + name_size + extra;
    EXPECT_EQ(data % 64, 0u) << name;
    const std::span<const std::byte> wanted =
        i == 0 ? std::as_bytes(std::span(layer.text))
               : std::span<const std::byte>(layer.textures[i - 1].bytes);
    ASSERT_EQ(size, wanted.size());
    EXPECT_TRUE(
        std::equal(wanted.begin(), wanted.end(), zip->begin() + static_cast<std::ptrdiff_t>(data)));
    EXPECT_EQ(number_at(*zip, entry + 16, 4),
              crc32_z(0, reinterpret_cast<const Bytef*>(wanted.data()), wanted.size()));
    entry += 46 + name_size;
  }
  EXPECT_EQ(entry, end);
}

}  // namespace
}  // namespace sunder
