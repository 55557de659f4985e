// A snapshot of a scene: restored, saved again, and gone on with.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>

#include "fuzz/snapshot_scene.h"

namespace {

void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", law);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder;
  static const std::shared_ptr<const CharacterAsset> asset = fuzz::make_snapshot_asset();
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  Scene scene = fuzz::make_scene();
  const auto kept = scene.spawn(asset);
  require(kept.has_value(), "no instance");
  const Status status = scene.restore(bytes, {&asset, 1});
  require(status.code() != StatusCode::internal_error, "restoring fails inside");
  if (!status) {
    require(scene.contains(*kept) && scene.instance_count() == 1, "a failure changed the scene");
    return 0;
  }
  const auto saved = scene.save();
  require(saved.has_value(), "what was restored cannot be saved");
  Scene again = fuzz::make_scene();
  require(static_cast<bool>(again.restore(*saved, {&asset, 1})), "what was saved is refused");
  const auto twice = again.save();
  require(twice.has_value() && *twice == *saved, "the second snapshot differs");
  for (int i = 0; i < 2; ++i) (void)scene.update(1.0 / 64);
  return 0;
}
