#include <sunder/io/character_bytes.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <numeric>

#include "c/c_objects.h"

namespace sunder::test {
namespace {

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The character that a GLB of C holds.
Character reread(sunder_character handle) {
  sunder_bytes glb = 0;
  EXPECT_DONE(sunder_save_glb(handle, nullptr, &glb));
  const std::string bytes = take_bytes(glb);
  const auto span = std::as_bytes(std::span(bytes));
  const auto loaded = load_glb({span.begin(), span.end()});
  EXPECT_TRUE(loaded) << loaded.error().text();
  return loaded ? *loaded->character : Character();
}

TEST(CCharacter, arrays_go_in_and_come_out) {
  const Character character = rich_character();
  const sunder_character first = create(character);
  sunder_character_data view = sunder_default_character_data();
  ASSERT_EQ(sunder_get_character(first, &view), SUNDER_OK);
  EXPECT_EQ(view.bone_count, character.skeleton.bones.size());
  EXPECT_EQ(view.meshes[0].vertex_count, character.meshes[0].vertex_count());
  EXPECT_EQ(view.meshes[0].attribute_count, 2u);
  EXPECT_EQ(view.meshes[0].attributes[1].is_label, 1u);

  // A second character from the view of the first is the same, in all that a GLB holds.
  sunder_character second = 0;
  ASSERT_EQ(sunder_create_character(&view, &second), SUNDER_OK) << sunder_last_error();
  const auto expected = save_glb(character);
  ASSERT_TRUE(expected);
  for (const sunder_character handle : {first, second}) {
    sunder_bytes glb = 0;
    EXPECT_DONE(sunder_save_glb(handle, nullptr, &glb));
    EXPECT_EQ(take_bytes(glb), text_of(*expected));
    EXPECT_DONE(sunder_destroy_character(handle));
  }
}

TEST(CCharacter, a_glb_is_read_and_stays_as_it_was) {
  const auto glb = save_glb(rich_character());
  ASSERT_TRUE(glb);
  sunder_character handle = 0;
  ASSERT_EQ(sunder_load_glb(glb->data(), glb->size(), nullptr, &handle), SUNDER_OK);
  sunder_bytes again = 0;
  EXPECT_DONE(sunder_save_glb(handle, nullptr, &again));
  EXPECT_EQ(take_bytes(again), text_of(*glb));
  EXPECT_EQ(reread(handle), *load_glb(*glb)->character);
  std::uint32_t index = 77;
  EXPECT_DONE(
      sunder_find_bone(handle, "bone2", &index) == SUNDER_OK
          ? SUNDER_OK
          : sunder_find_bone(handle, rich_character().skeleton.bones[2].name.c_str(), &index));
  EXPECT_EQ(sunder_find_clip(handle, "no such clip", &index), SUNDER_NOT_FOUND);
  EXPECT_DONE(sunder_destroy_character(handle));
}

/// glTF text whose buffer is another file.
std::string text_with_buffer(const std::vector<std::byte>& glb, std::string& buffer,
                             const std::string& uri = "mesh.bin") {
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + 12, 4);
  const std::string all = text_of(glb);
  std::string json = all.substr(20, json_bytes);
  buffer = all.substr(20 + json_bytes + 8);
  const std::string place = "\"buffers\":[{";
  json.insert(json.find(place) + place.size(), "\"uri\":\"" + uri + "\",");
  return json;
}

/// Adds `_STRENGTH` to a mesh. @return the new character, 0 if that failed.
sunder_character painted(sunder_character of, std::uint32_t mesh, const std::vector<float>& values,
                         const char* name = "_STRENGTH") {
  sunder_character made = 0;
  EXPECT_DONE(sunder_add_attribute(of, mesh, name, values.data(),
                                   static_cast<std::uint32_t>(values.size()), &made));
  return made;
}

std::vector<float> ascending(const Mesh& mesh, float first) {
  std::vector<float> values(mesh.vertex_count());
  std::iota(values.begin(), values.end(), first);
  return values;
}

TEST(CCharacter, files_have_attributes_that_were_added) {
  const Character of_arrays = rich_character();
  const auto glb = save_glb(of_arrays);
  ASSERT_TRUE(glb);
  sunder_character loaded = 0;
  ASSERT_EQ(sunder_load_glb(glb->data(), glb->size(), nullptr, &loaded), SUNDER_OK);
  for (const sunder_character before : {create(of_arrays), loaded}) {
    Character expected = reread(before);
    const std::vector<float> first = ascending(expected.meshes[0], 0),
                             second = ascending(expected.meshes[0], 7);
    const sunder_character once = painted(before, 0, first);
    const sunder_character twice = painted(once, 0, second);  // in place of the first
    expected.meshes[0].custom_attributes.push_back({"_STRENGTH", 1, true, second});
    Character read = reread(twice);
    for (Character* const one : {&expected, &read})
      std::ranges::sort(one->meshes[0].custom_attributes, {}, &CustomAttribute::name);
    EXPECT_EQ(read, expected);
    for (const sunder_character one : {before, once, twice})
      EXPECT_DONE(sunder_destroy_character(one));
  }
}

TEST(CCharacter, walls_get_no_materials_that_a_file_lacks) {
  const Character tube = make_tube(6, 5, 3);
  const sunder_character before = create(tube);
  std::vector<float> materials(tube.meshes[0].vertex_count(), -1);
  materials[2] = 60000;
  const sunder_character with = painted(before, 0, materials, "_WALL_MATERIAL");
  const Character read = reread(with);
  const CustomAttribute& found = read.meshes[0].custom_attributes.back();
  EXPECT_EQ(found.name, "_WALL_MATERIAL");
  EXPECT_FALSE(found.interpolates);
  EXPECT_EQ(found.values[2], -1.0f);
  for (const sunder_character one : {before, with}) EXPECT_DONE(sunder_destroy_character(one));
}

TEST(CCharacter, attributes_that_do_not_fit_are_refused) {
  const sunder_character tube = create(make_tube(6, 5, 3));
  const std::vector<float> values = ascending(make_tube(6, 5, 3).meshes[0], 0);
  const auto count = static_cast<std::uint32_t>(values.size());
  sunder_character made = 77;
  EXPECT_EQ(sunder_add_attribute(tube, 1, "_A", values.data(), count, &made),
            SUNDER_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(sunder_add_attribute(tube, 0, "A", values.data(), count, &made),
            SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(sunder_add_attribute(tube, 0, "_A", values.data(), count - 1, &made),
            SUNDER_SIZE_MISMATCH);
  EXPECT_EQ(sunder_add_attribute(tube, 0, nullptr, values.data(), count, &made),
            SUNDER_NULL_POINTER);
  EXPECT_EQ(sunder_add_attribute(tube, 0, "_A", nullptr, count, &made), SUNDER_NULL_POINTER);
  std::vector<float> infinite = values;
  infinite[3] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(sunder_add_attribute(tube, 0, "_A", infinite.data(), count, &made),
            SUNDER_NON_FINITE_VALUE);
  EXPECT_EQ(made, 77u);
  EXPECT_DONE(sunder_destroy_character(tube));
}

struct OneFile {
  std::string name, bytes;
  int open = 0;
};

sunder_status read_one(void* context, const char* uri, const uint8_t** data, uint64_t* size) {
  auto* const file = static_cast<OneFile*>(context);
  if (file->name != uri) return SUNDER_FILE_NOT_FOUND;
  *data = reinterpret_cast<const uint8_t*>(file->bytes.data());
  *size = file->bytes.size();
  ++file->open;
  return SUNDER_OK;
}

void release_one(void* context, const uint8_t* /*data*/) { --static_cast<OneFile*>(context)->open; }

TEST(CCharacter, other_files_come_from_the_program) {
  const Character character = make_tube(6, 5, 3);
  OneFile file{"mesh.bin", {}, 0};
  const std::string json = text_with_buffer(*save_glb(character), file.bytes);
  sunder_character handle = 0;
  EXPECT_EQ(sunder_load_glb(json.data(), json.size(), nullptr, &handle), SUNDER_PATH_NOT_ALLOWED);
  sunder_load_options options = sunder_default_load_options();
  options.read_file = read_one;
  options.release_file = release_one;
  options.file_context = &file;
  ASSERT_EQ(sunder_load_glb(json.data(), json.size(), &options, &handle), SUNDER_OK)
      << sunder_last_error();
  EXPECT_EQ(file.open, 0);
  EXPECT_EQ(reread(handle), *load_glb(*save_glb(character))->character);
  EXPECT_DONE(sunder_destroy_character(handle));

  file.name = "other.bin";
  EXPECT_EQ(sunder_load_glb(json.data(), json.size(), &options, &handle), SUNDER_FILE_NOT_FOUND);
  file.name = "mesh.bin";
  options.maximum_bytes = json.size() + 1;
  EXPECT_EQ(sunder_load_glb(json.data(), json.size(), &options, &handle), SUNDER_LIMIT_EXCEEDED);
  EXPECT_EQ(file.open, 0);
}

TEST(CCharacter, no_file_is_asked_for_by_a_part_of_its_name) {
  OneFile file{"mesh.bin", {}, 0};
  const std::string json =
      text_with_buffer(*save_glb(make_tube(6, 5, 3)), file.bytes, "mesh.bin\\u0000.png");
  sunder_load_options options = sunder_default_load_options();
  options.read_file = read_one;
  options.file_context = &file;
  sunder_character handle = 0;
  EXPECT_EQ(sunder_load_glb(json.data(), json.size(), &options, &handle), SUNDER_PATH_NOT_ALLOWED);
  EXPECT_EQ(file.open, 0);
}

TEST(CCharacter, missing_arrays_are_named) {
  const Character character = rich_character();
  const CArrays arrays(character);
  sunder_character handle = 77;
  const auto refused = [&](const char* name, const auto& change) {
    sunder_character_data data = arrays.data;
    sunder_mesh mesh = *data.meshes;
    sunder_clip clip = *data.clips;
    sunder_channel channel = *clip.channels;
    sunder_attribute attribute = *mesh.attributes;
    change(data, mesh, attribute, channel);
    if (data.meshes != nullptr) data.meshes = &mesh;
    mesh.attributes = &attribute;
    mesh.attribute_count = 1;
    clip.channels = &channel;
    clip.channel_count = 1;
    data.clips = &clip;
    EXPECT_NE(sunder_create_character(&data, &handle), SUNDER_OK) << name;
    EXPECT_NE(std::string(sunder_last_error()).find(name), std::string::npos)
        << name << ": " << sunder_last_error();
    EXPECT_EQ(handle, 77u);
  };
  refused("bones", [](auto& data, auto&, auto&, auto&) { data.bones = nullptr; });
  refused("meshes", [](auto& data, auto&, auto&, auto&) { data.meshes = nullptr; });
  refused("positions", [](auto&, auto& mesh, auto&, auto&) { mesh.positions = nullptr; });
  refused("uv_sets", [](auto&, auto& mesh, auto&, auto&) { mesh.uv_sets = nullptr; });
  refused("first_influence",
          [](auto&, auto& mesh, auto&, auto&) { mesh.first_influence = nullptr; });
  refused("influences", [](auto&, auto& mesh, auto&, auto&) { mesh.influences = nullptr; });
  refused("triangles", [](auto&, auto& mesh, auto&, auto&) { mesh.triangles = nullptr; });
  refused("triangle_submesh",
          [](auto&, auto& mesh, auto&, auto&) { mesh.triangle_submesh = nullptr; });
  refused("components", [](auto&, auto&, auto& one, auto&) { one.components = 5; });
  refused("values", [](auto&, auto&, auto& one, auto&) { one.values = nullptr; });
  refused("times", [](auto&, auto&, auto&, auto& channel) { channel.times = nullptr; });
  refused("target", [](auto&, auto&, auto&, auto& channel) { channel.target = 9; });
  refused("interpolation", [](auto&, auto&, auto&, auto& channel) { channel.interpolation = 9; });
  // Faults of the content have the text of validate_character().
  refused("skin", [](auto&, auto& mesh, auto&, auto&) { mesh.skin = 9; });
}

TEST(CCharacter, poses_have_the_bits_of_the_library) {
  const Character character = make_tube(12, 8, 5);
  const sunder_character handle = create(character);
  for (const double time : {-1.0, 0.0, 0.37, 1.9, 5.0}) {
    std::vector<sunder_transform> transforms(5);
    std::vector<float> weights(character.rest_morph_weights.size());
    std::vector<double> matrices(5 * 12);
    EXPECT_DONE(sunder_sample_clip(handle, 0, time, transforms.data(), weights.data()));
    EXPECT_DONE(sunder_compute_matrices(handle, transforms.data(), matrices.data()));
    Pose pose = *local_rest_pose(character);
    ASSERT_TRUE(sample_clip(character.clips[0], time, pose));
    ModelPose expected;
    ASSERT_TRUE(compute_model_pose(character.skeleton, pose, expected));
    EXPECT_EQ(0, std::memcmp(matrices.data(), expected.model_from_bone[0].data(),
                             matrices.size() * sizeof(double)));
    EXPECT_EQ(weights, pose.morph_weights);
  }
  sunder_transform transform;
  EXPECT_EQ(sunder_sample_clip(handle, 9, 0.0, &transform, nullptr), SUNDER_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(sunder_last_error_index(), 9u);
  EXPECT_DONE(sunder_destroy_character(handle));
}

}  // namespace
}  // namespace sunder::test
