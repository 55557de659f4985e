// A character plays its first clip; a hand is pulled aside, the poses are kept as key frames of a
// new clip, which plays at once, fades in over the old one, and is written with the torn model:
// key_frames MODEL OUT.glb
#include <sunder/animation/clip_editor.h>
#include <sunder/animation/clip_player.h>
#include <sunder/animation/pull.h>
#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

/// The value of a call that must not fail here.
template <class T>
T expect(sunder::Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "%s\n", result.error().text().data());
  std::exit(1);
}
void expect(const sunder::Status& status) {
  if (status) return;
  std::fprintf(stderr, "%s\n", status.text().data());
  std::exit(1);
}

/// A bone and its parents, the nearest ones first.
std::vector<std::uint32_t> bones_above(const sunder::Skeleton& skeleton, std::uint32_t bone) {
  std::vector<std::uint32_t> bones;
  for (; bone != sunder::kNone; bone = skeleton.bones[bone].parent) bones.push_back(bone);
  return bones;
}

/// The bone that has most bones above it, of those that move a mesh: a hand, a foot, or a head.
std::uint32_t deepest_bone(const sunder::Character& model) {
  std::uint32_t deepest = 0;
  for (const sunder::Skin& skin : model.skins)
    for (const std::uint32_t bone : skin.bones)
      if (bones_above(model.skeleton, bone).size() > bones_above(model.skeleton, deepest).size())
        deepest = bone;
  return deepest;
}

void play_frames(sunder::ClipPlayer& player, int frames, sunder::Pose& pose) {
  for (int frame = 0; frame < frames; ++frame) {
    expect(player.advance(1.0 / 60));
    if (player.has_changed()) expect(player.evaluate(pose));
    // compute_model_pose() and CharacterInstance::advance() come here.
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: key_frames MODEL OUT.glb\n", stderr), 2;
  const sunder::LoadedCharacter loaded = expect(sunder::load_character(argv[1]));
  const sunder::Character& model = *loaded.character;
  sunder::ClipPlayer player = expect(sunder::ClipPlayer::create(loaded.character));
  if (!model.clips.empty()) expect(player.play(sunder::clip_of(loaded.character, 0)));
  sunder::Pose pose = expect(sunder::local_rest_pose(model));
  play_frames(player, 30, pose);

  // The pose of the moment is the first key; then the hand is pulled, in steps as a mouse gives
  // them.
  sunder::ClipEditor editor = expect(sunder::ClipEditor::create(loaded.character, "pulled"));
  expect(editor.insert(0.0, pose));
  const std::uint32_t hand = deepest_bone(model);
  std::vector<std::uint32_t> arm = bones_above(model.skeleton, hand);
  arm.resize(std::min<std::size_t>(arm.size(), 4));
  sunder::PosePuller puller = expect(sunder::PosePuller::create(model.skeleton, arm));
  const sunder::PullHandle handle = sunder::handle_on_bone(hand);
  sunder::ModelPose model_pose;
  expect(sunder::compute_model_pose(model.skeleton, pose, model_pose));
  const sunder::Vec3d from = model_pose.model_from_bone[hand].translation();
  double error = 0;
  for (int step = 1; step <= 10; ++step) {
    const sunder::PullTarget target = {&handle, from + sunder::Vec3d(0, 0.01, 0.01) * step, 1.0};
    error = expect(puller.pull({&target, 1}, pose)).error;
  }
  expect(editor.insert(0.5, pose));
  std::printf("'%s' pulled by %.2f m, %.4f m off; ", model.skeleton.bones[hand].name.c_str(), 0.14,
              error);

  // The new clip fades in over what plays. A further key joins it while it does.
  sunder::LayerOptions options;
  options.mode = sunder::PlayMode::ping_pong;
  options.fade_in = 0.3;
  const sunder::LayerId layer = expect(player.cross_fade(expect(editor.snapshot()), options));
  play_frames(player, 30, pose);
  expect(editor.insert(1.0, expect(sunder::local_rest_pose(model))));
  expect(player.replace_clip(layer, expect(editor.snapshot())));
  play_frames(player, 30, pose);
  std::printf("%zu keys, %u layer\n", editor.key_times().size(), player.layer_count());

  sunder::TornModel torn = expect(sunder::TornModel::create(loaded.character));
  expect(sunder::compute_model_pose(model.skeleton, pose, model_pose));
  expect(torn.tear(model_pose, sunder::Stroke{{{-0.10, 1.15, 2.0}, {-0.10, 1.15, 0.0}},
                                              {{-0.12, 1.25, 2.0}, {-0.12, 1.25, 0.0}}}));
  sunder::Character with_clip = torn.character();
  with_clip.clips.push_back(*expect(editor.snapshot()));
  expect(sunder::save_glb(argv[2], with_clip, loaded));
  return 0;
}
