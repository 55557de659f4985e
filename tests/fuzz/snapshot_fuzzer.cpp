// A snapshot of a scene, whose checksum is made right: restored, saved again, and gone on with.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "fuzz/sealed_snapshot.h"
#include "fuzz/snapshot_scene.h"
#include "support/oracles/scene_laws.h"

namespace {

void require(bool holds, const char* law) {
  if (holds) return;
  std::fprintf(stderr, "%s\n", law);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sunder;
  static const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  const auto* const first = reinterpret_cast<const std::byte*>(data);
  const std::vector<std::byte> bytes = fuzz::sealed({first, first + size});
  Scene scene = fuzz::make_scene();
  const auto kept = scene.spawn(assets[0]);
  require(kept.has_value(), "no instance");
  RestoreOptions limits;
  limits.instances = 16;
  limits.operations = 32;
  limits.memory = std::size_t{64} << 20u;
  const Status status = scene.restore(bytes, assets, limits);
  require(status.code() != StatusCode::internal_error, "restoring fails inside");
  if (!status) {
    require(scene.contains(*kept) && scene.instance_count() == 1, "a failure changed the scene");
    return 0;
  }
  const auto saved = scene.save();
  require(saved.has_value(), "what was restored cannot be saved");
  Scene again = fuzz::make_scene();
  require(static_cast<bool>(again.restore(*saved, assets, limits)), "what was saved is refused");
  const auto twice = again.save();
  require(twice.has_value() && *twice == *saved, "the second snapshot differs");
  test::Random random(1);
  const std::vector<std::string> faults = test::play_on(scene, random);
  require(faults.empty(), faults.empty() ? "" : faults[0].c_str());
  return 0;
}
