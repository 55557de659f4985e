// What C programs see of a transfer is what C++ programs see.

#include <sunder/io/character_bytes.h>
#include <sunder/validation/transfer.h>

#include <numeric>
#include <string>

#include "c/c_objects.h"
#include "c/c_twins.h"

namespace sunder::test {
namespace {

std::vector<Influence> influences_of(sunder_character character, std::uint32_t mesh) {
  sunder_character_data data = sunder_default_character_data();
  EXPECT_DONE(sunder_get_character(character, &data));
  const sunder_mesh& of = data.meshes[mesh];
  std::vector<Influence> influences;
  for (std::uint32_t i = 0; i < of.first_influence[of.vertex_count]; ++i)
    influences.push_back({of.influences[i].slot, of.influences[i].weight});
  return influences;
}

TEST(CTransfer, weights_and_figures_are_those_of_the_library) {
  const Character source = make_tube(24, 12, 5), target = make_tube(31, 17, 5);
  const std::uint32_t count = target.meshes[0].vertex_count();
  Random random(5);
  std::vector<std::uint8_t> locked(count);
  for (std::uint8_t& one : locked) one = random.index(4) == 0 ? 1 : 0;
  for (const TransferMethod method : {TransferMethod::closest_point, TransferMethod::inpainting}) {
    TransferOptions wanted;
    wanted.method = method;
    wanted.distance = 0.002;
    wanted.maximum_influences = 3;
    wanted.locked.emplace_back(locked.begin(), locked.end());
    const auto expected = transfer_weights(source, target, wanted);
    ASSERT_TRUE(expected) << expected.error().text();

    const sunder_character from = create(source), to = create(target);
    sunder_transfer_options options = sunder_default_transfer_options();
    options.method = static_cast<std::uint32_t>(method);
    options.distance = 0.002;
    options.maximum_influences = 3;
    options.locked = locked.data();
    options.locked_count = count;
    sunder_character result = 0;
    sunder_transfer_info info = {};
    info.struct_size = sizeof info;
    std::vector<std::uint8_t> outcomes(count, 99);
    ASSERT_EQ(sunder_transfer(from, to, &options, &result, &info, outcomes.data()), SUNDER_OK)
        << sunder_last_error();
    EXPECT_EQ(influences_of(result, 0), expected->character.meshes[0].weights.influences);
    EXPECT_EQ(info.vertex_count, count);
    EXPECT_EQ(info.matched, expected->matched);
    EXPECT_EQ(info.coincident, expected->coincident);
    EXPECT_EQ(info.inpainted, expected->inpainted);
    EXPECT_EQ(info.nearest, expected->nearest);
    EXPECT_EQ(info.locked, expected->locked);
    EXPECT_GT(info.locked, 10u);
    EXPECT_EQ(info.too_far, expected->too_far);
    EXPECT_GT(info.too_far, 0u);
    EXPECT_EQ(info.matched_share, expected->matched_share());
    EXPECT_EQ(info.largest_distance, expected->largest_distance);
    for (std::uint32_t v = 0; v < count; ++v)
      ASSERT_EQ(outcomes[v], static_cast<std::uint8_t>(expected->outcomes[0][v]));
    EXPECT_DONE(sunder_destroy_character(from));
    EXPECT_DONE(sunder_destroy_character(to));
    EXPECT_DONE(sunder_destroy_character(result));
  }
}

TEST(CTransfer, names_of_bones_are_read) {
  const Character source = make_tube(12, 8, 4);
  Character target = source;
  for (Bone& bone : target.skeleton.bones) bone.name = "other " + bone.name;
  const sunder_character from = create(source), to = create(target);
  std::vector<sunder_bone_names> names;
  for (std::size_t i = 0; i < source.skeleton.bones.size(); ++i)
    names.push_back({target.skeleton.bones[i].name.c_str(), source.skeleton.bones[i].name.c_str()});
  sunder_transfer_options options = sunder_default_transfer_options();
  options.bone_names = names.data();
  options.bone_name_count = static_cast<std::uint32_t>(names.size());
  sunder_character result = 0;
  sunder_transfer_info info = {};
  info.struct_size = sizeof info;
  ASSERT_EQ(sunder_transfer(from, to, &options, &result, &info, nullptr), SUNDER_OK)
      << sunder_last_error();
  EXPECT_EQ(info.has_adopted_skeleton, 0u);
  TransferOptions wanted;
  for (std::size_t i = 0; i < names.size(); ++i)
    wanted.bone_names.push_back({names[i].target, names[i].source});
  const auto expected = transfer_weights(source, target, wanted);
  ASSERT_TRUE(expected) << expected.error().text();
  EXPECT_EQ(influences_of(result, 0), expected->character.meshes[0].weights.influences);
  for (const sunder_character one : {from, to, result}) EXPECT_DONE(sunder_destroy_character(one));
}

TEST(CTransfer, a_file_has_the_weights_that_were_transferred) {
  const Character source = make_tube(12, 8, 4);
  Character target = source;
  SkinWeights& weights = target.meshes[0].weights;  // all hangs on the first bone
  weights.influences.assign(target.meshes[0].vertex_count(), {0, 1.0f});
  std::iota(weights.first.begin(), weights.first.end(), 0u);
  const auto glb = save_glb(target);
  ASSERT_TRUE(glb);
  const sunder_character from = create(source);
  sunder_character to = 0, result = 0;
  ASSERT_EQ(sunder_load_glb(glb->data(), glb->size(), nullptr, &to), SUNDER_OK);
  ASSERT_EQ(sunder_transfer(from, to, nullptr, &result, nullptr, nullptr), SUNDER_OK)
      << sunder_last_error();
  sunder_bytes written = 0;
  ASSERT_EQ(sunder_save_glb(result, nullptr, &written), SUNDER_OK) << sunder_last_error();
  const std::string bytes = take_bytes(written);
  const auto span = std::as_bytes(std::span(bytes));
  const auto loaded = load_glb({span.begin(), span.end()});
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_NE(influences_of(result, 0), influences_of(to, 0));
  EXPECT_EQ(loaded->character->meshes[0].weights.influences, influences_of(result, 0));
  for (const sunder_character one : {from, to, result}) EXPECT_DONE(sunder_destroy_character(one));
}

TEST(CTransfer, what_cannot_be_done_is_refused_and_makes_nothing) {
  const sunder_character rig = create(make_tube(12, 8, 4));
  sunder_character result = 77;
  const auto refuses = [&](sunder_status status, auto change) {
    sunder_transfer_options options = sunder_default_transfer_options();
    change(options);
    EXPECT_EQ(sunder_transfer(rig, rig, &options, &result, nullptr, nullptr), status)
        << sunder_last_error();
    EXPECT_EQ(result, 77u);
  };
  refuses(SUNDER_INVALID_ARGUMENT, [](auto& options) { options.method = 2; });
  refuses(SUNDER_INVALID_ARGUMENT, [](auto& options) { options.mix = 2; });
  refuses(SUNDER_INVALID_STRUCT, [](auto& options) { options.struct_size = 4; });
  refuses(SUNDER_NULL_POINTER, [](auto& options) { options.bone_count = 1; });
  refuses(SUNDER_NULL_POINTER, [](auto& options) { options.locked_count = 1; });
  const std::uint8_t one = 1;
  refuses(SUNDER_SIZE_MISMATCH, [&](auto& options) {
    options.locked = &one;
    options.locked_count = 1;
  });
  const char* const nobody = "nobody";
  refuses(SUNDER_NOT_FOUND, [&](auto& options) {
    options.bones = &nobody;
    options.bone_count = 1;
  });
  EXPECT_EQ(sunder_transfer(rig, rig, nullptr, nullptr, nullptr, nullptr), SUNDER_NULL_POINTER);
  EXPECT_EQ(sunder_transfer(rig, 12345, nullptr, &result, nullptr, nullptr), SUNDER_INVALID_HANDLE);
  EXPECT_DONE(sunder_destroy_character(rig));
}

}  // namespace
}  // namespace sunder::test
