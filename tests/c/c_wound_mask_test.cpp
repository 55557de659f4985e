// The wounds in the texture, as C programs see them while a scene plays.

#include <sunder/tear/wound_mask.h>

#include <algorithm>

#include "c/c_twins.h"
#include "support/models/atlas_tube.h"

namespace sunder::test {
namespace {

constexpr std::uint32_t kSize = 128;

sunder_wound_mask mask_of(const Twins& twins) {
  sunder_wound_mask mask = {};
  mask.struct_size = sizeof mask;
  EXPECT_DONE(sunder_get_wound_mask(twins.c_scene, twins.c_id, 0, &mask));
  return mask;
}

/// Uploads the rectangle.
void upload(const sunder_wound_mask& mask, std::vector<float>& texture) {
  for (std::uint32_t row = mask.top; row < mask.top + mask.changed_height; ++row)
    std::copy_n(mask.distances + row * mask.width + mask.left, mask.changed_width,
                texture.begin() + row * mask.width + mask.left);
}

TEST(CWoundMask, rectangles_make_the_texture_that_is_painted_at_once) {
  Random random(9);
  Twins twins(make_atlas_tube(24, 12));
  twins.update();
  sunder_wound_mask_options options = sunder_default_wound_mask_options();
  options.width = options.height = kSize;
  options.reach = 0.1;
  EXPECT_DONE(sunder_begin_wound_mask(twins.c_scene, twins.c_id, 0, &options));
  sunder_wound_mask mask = mask_of(twins);
  EXPECT_EQ(mask.changed_width, kSize) << "at first, all of it";
  std::vector<float> texture(std::size_t{kSize} * kSize, -99.0f);
  upload(mask, texture);
  std::size_t wounded = 0, small = 0;
  for (int frame = 0; frame < 40; ++frame) {
    if (frame % 5 == 4)
      EXPECT_DONE(sunder_submit_undo(twins.c_scene, twins.c_id, nullptr));
    else
      submit_random(twins, random);
    EXPECT_DONE(sunder_update(twins.c_scene, 1.0 / 60));
    mask = mask_of(twins);
    upload(mask, texture);
    small += mask.changed_width > 0 && mask.changed_width < kSize / 2 ? 1 : 0;
    ASSERT_TRUE(std::equal(texture.begin(), texture.end(), mask.distances)) << frame;
    wounded = std::max<std::size_t>(
        wounded, std::ranges::count_if(texture, [&](float d) { return d < 0.05f; }));
    EXPECT_EQ(mask_of(twins).changed_width, 0u) << "nothing since the last call";
  }
  EXPECT_GT(wounded, 100u);
  EXPECT_GT(small, 3u) << "not all of it each time";
  // Painted at once, it has the same bits.
  const std::vector<float> followed = texture;
  EXPECT_DONE(sunder_begin_wound_mask(twins.c_scene, twins.c_id, 0, &options));
  upload(mask_of(twins), texture);
  EXPECT_EQ(texture, followed);
  EXPECT_DONE(sunder_end_wound_mask(twins.c_scene, twins.c_id, 0));
  mask.struct_size = sizeof mask;
  EXPECT_EQ(sunder_get_wound_mask(twins.c_scene, twins.c_id, 0, &mask), SUNDER_NOT_FOUND);
}

std::vector<float> channel_of(const Twins& twins, std::uint32_t channel) {
  const float* texels = nullptr;
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_wound_channel(twins.c_scene, twins.c_id, 0, channel, &texels, &count));
  return {texels, texels + count};
}

TEST(CWoundMask, channels_and_blood_have_the_bits_of_those_of_cpp) {
  Random random(12);
  Twins twins(make_atlas_tube(24, 12));
  twins.update();
  sunder_wound_mask_options options = sunder_default_wound_mask_options();
  EXPECT_EQ(options.operation_count, SUNDER_NONE);
  options.width = options.height = kSize;
  options.reach = 0.1;
  EXPECT_DONE(sunder_begin_wound_mask(twins.c_scene, twins.c_id, 0, &options));
  for (int frame = 0; frame < 8; ++frame) {
    submit_random(twins, random);
    twins.update();
  }
  CharacterInstance& cpp = *twins.scene->find(twins.id);
  WoundMaskOptions wanted;
  wanted.width = wanted.height = kSize;
  wanted.reach = 0.1;
  ASSERT_TRUE(cpp.begin_wound_mask(0, wanted));
  const WoundMask& mask = **cpp.peek_wound_mask(0);
  EXPECT_EQ(channel_of(twins, SUNDER_WOUND_AGE), *mask.channel(*cpp.model(), WoundChannel::age));
  EXPECT_EQ(channel_of(twins, SUNDER_WOUND_DEPTH),
            *mask.channel(*cpp.model(), WoundChannel::depth));
  EXPECT_EQ(channel_of(twins, SUNDER_WOUND_STRETCH),
            *mask.stretches(*cpp.model(), cpp.mesh(0).positions));
  EXPECT_GT(std::ranges::max(channel_of(twins, SUNDER_WOUND_AGE)), 0);
  EXPECT_EQ(mask_of(twins).changed_width, kSize) << "looking at channels keeps what changed";

  sunder_blood_flow_options flow = sunder_default_blood_flow_options();
  flow.length = 0.3;
  flow.seed = 5;
  const float* texels = nullptr;
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_flow_blood(twins.c_scene, twins.c_id, 0, &flow, &texels, &count));
  BloodFlowOptions cpp_flow;
  cpp_flow.length = 0.3;
  cpp_flow.seed = 5;
  EXPECT_EQ(std::vector(texels, texels + count), *mask.flow(*cpp.model(), cpp.pose(), cpp_flow));
  EXPECT_GT(*std::max_element(texels, texels + count), 0);

  EXPECT_EQ(sunder_get_wound_channel(twins.c_scene, twins.c_id, 0, 3, &texels, &count),
            SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(sunder_get_wound_channel(twins.c_scene, twins.c_id, 0, 0, nullptr, &count),
            SUNDER_NULL_POINTER);
  flow.width = 0;
  EXPECT_EQ(sunder_flow_blood(twins.c_scene, twins.c_id, 0, &flow, &texels, &count),
            SUNDER_INVALID_ARGUMENT);

  options.first_operation = 1;
  options.operation_count = 1;
  EXPECT_DONE(sunder_begin_wound_mask(twins.c_scene, twins.c_id, 0, &options));
  wanted.first_operation = wanted.operation_count = 1;
  const auto of_one = WoundMask::create(*cpp.model(), 0, wanted);
  EXPECT_TRUE(
      std::ranges::equal(of_one->distances(), std::span(mask_of(twins).distances, kSize * kSize)));
  EXPECT_DONE(sunder_end_wound_mask(twins.c_scene, twins.c_id, 0));
  EXPECT_EQ(sunder_get_wound_channel(twins.c_scene, twins.c_id, 0, 0, &texels, &count),
            SUNDER_NOT_FOUND);
  EXPECT_EQ(sunder_flow_blood(twins.c_scene, twins.c_id, 0, nullptr, &texels, &count),
            SUNDER_NOT_FOUND);
}

TEST(CWoundMask, options_out_of_range_are_refused) {
  Twins twins(make_tube(8, 6, 3));
  const auto begin = [&](auto change) {
    sunder_wound_mask_options options = sunder_default_wound_mask_options();
    change(options);
    return sunder_begin_wound_mask(twins.c_scene, twins.c_id, 0, &options);
  };
  EXPECT_EQ(begin([](auto& options) { options.width = 0; }), SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(begin([](auto& options) { options.reach = -1; }), SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(begin([](auto& options) { options.dilation = 65; }), SUNDER_INVALID_ARGUMENT);
  EXPECT_EQ(begin([](auto& options) { options.uv_set = 7; }), SUNDER_NOT_FOUND);
  EXPECT_EQ(begin([](auto& options) { options.struct_size = 3; }), SUNDER_INVALID_STRUCT);
  EXPECT_EQ(sunder_begin_wound_mask(twins.c_scene, twins.c_id, 5, nullptr),
            SUNDER_INDEX_OUT_OF_RANGE);
  sunder_wound_mask mask = {};
  mask.struct_size = sizeof mask;
  EXPECT_EQ(sunder_get_wound_mask(twins.c_scene, twins.c_id, 0, &mask), SUNDER_NOT_FOUND);
}

}  // namespace
}  // namespace sunder::test
