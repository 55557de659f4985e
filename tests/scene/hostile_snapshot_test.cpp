// Snapshots from strangers: every number may be any, and the checksum is right. What is refused
// changes nothing; what is accepted keeps the laws of a scene, whatever is done next.

#include <sunder/scene/scene.h>

#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "fuzz/sealed_snapshot.h"
#include "fuzz/snapshot_scene.h"
#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/oracles/scene_laws.h"

namespace sunder {
namespace {

using Bytes = std::vector<std::byte>;

Bytes value_of(Result<Bytes> result) {
  EXPECT_TRUE(result) << result.error().text();
  return std::move(*result);
}

/// Overwrites bytes by a number.
template <class Number>
void put(Number number, std::size_t at, Bytes& bytes) {
  if (at + sizeof number <= bytes.size()) std::memcpy(bytes.data() + at, &number, sizeof number);
}

/// Changes a few numbers, anywhere after the head.
Bytes mutated(Bytes bytes, test::Random& random) {
  constexpr std::uint32_t kIndices[] = {0, 1, 2, 7, 80, 1000, 0x7FFFFFFF, kNone - 1, kNone};
  constexpr double kDoubles[] = {0.0, -1.0, 1e-300, 1e9, -1e30, 1e300};
  constexpr float kFloats[] = {0.0f, -1.0f, 1.5f, 1e-30f, 1e9f, -1e30f};
  for (std::uint32_t n = 1 + random.index(2); n > 0; --n) {
    const std::size_t at = 16 + random.index(static_cast<std::uint32_t>(bytes.size() - 16));
    switch (random.index(8)) {
      case 0: put(kIndices[random.index(9)], at, bytes); break;
      case 1: put(kDoubles[random.index(6)], at, bytes); break;
      case 2: put(kFloats[random.index(6)], at, bytes); break;
      case 3: put(std::numeric_limits<double>::quiet_NaN(), at, bytes); break;
      case 4: bytes[at] ^= static_cast<std::byte>(1u << random.index(8)); break;
      case 5: bytes[at] = static_cast<std::byte>(random.index(256)); break;
      case 6: bytes[at] = static_cast<std::byte>(std::to_integer<int>(bytes[at]) + 1); break;
      default: {  // a number from elsewhere
        const std::size_t from = 16 + random.index(static_cast<std::uint32_t>(bytes.size() - 16));
        for (std::size_t i = 0; i < 4 && std::max(at, from) + i < bytes.size(); ++i)
          bytes[at + i] = bytes[from + i];
      }
    }
  }
  return bytes;
}

/// Tries a snapshot. @return whether it was accepted.
bool try_snapshot(const Bytes& bytes, const fuzz::SnapshotAssets& assets, std::uint64_t seed) {
  Scene scene = fuzz::make_scene();
  const auto kept = scene.spawn(assets[0]);
  RestoreOptions limits;
  limits.memory = std::size_t{64} << 20u;
  if (const Status status = scene.restore(bytes, assets, limits); !status) {
    EXPECT_FALSE(status.text().empty());
    EXPECT_NE(status.code(), StatusCode::internal_error) << status.text();
    EXPECT_TRUE(scene.contains(*kept) && scene.instance_count() == 1);
    return false;
  }
  test::Random random(seed);
  const std::vector<std::string> faults = test::play_on(scene, random);
  EXPECT_TRUE(faults.empty()) << faults[0];
  return true;
}

TEST(hostile_snapshot, the_checksum_is_that_of_its_standard) {
  const std::string text = "123456789";
  EXPECT_EQ(scene::checksum_of(std::as_bytes(std::span(text))), 0x995DC9BBDF1939FAu);
}

TEST(hostile_snapshot, changed_bytes_are_refused_by_the_checksum) {
  const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  const Bytes good = value_of(fuzz::make_rich_scene(assets).save());
  Scene scene = fuzz::make_scene();
  test::Random random(2);
  for (int i = 0; i < test::stressed(1000, 20000); ++i) {
    const Bytes bytes = mutated(good, random);
    if (bytes == good) continue;
    const Status status = scene.restore(bytes, assets);
    ASSERT_EQ(status.code(), StatusCode::malformed_file) << i;
    ASSERT_EQ(status.index(), 8u);
  }
  EXPECT_TRUE(scene.restore(good, assets));
}

TEST(hostile_snapshot, numbers_of_all_parts_are_checked) {
  const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  int accepted = 0, refused = 0;
  for (const bool is_rich : {false, true}) {
    const Bytes good =
        value_of((is_rich ? fuzz::make_rich_scene(assets) : fuzz::make_torn_scene(assets)).save());
    ASSERT_TRUE(try_snapshot(good, assets, 0));
    for (int i = 0; i < test::stressed(1000, 50000); ++i) {
      SCOPED_TRACE(i);
      const auto seed = static_cast<std::uint64_t>(i);
      test::Random random(seed);
      (try_snapshot(fuzz::sealed(mutated(good, random)), assets, seed) ? accepted : refused)++;
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(accepted, 50);
  EXPECT_GT(refused, 1000);
  RecordProperty("accepted", accepted);
}

/// An index that is replaced by another one that exists is the hardest to see: it may be wrong only
/// before an earlier operation, that is, after undo.
TEST(hostile_snapshot, indices_are_not_exchanged_for_others) {
  const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  const Bytes good = value_of(fuzz::make_rich_scene(assets).save());
  std::vector<std::size_t> places;
  for (std::size_t at = 16; at + 4 <= good.size(); ++at) {
    std::uint32_t number = 0;
    std::memcpy(&number, &good[at], sizeof number);
    if (number > 0 && number < 512) places.push_back(at);
  }
  ASSERT_GT(places.size(), 1000u);
  const std::size_t stride =
      places.size() / static_cast<std::size_t>(test::stressed(1500, 1000)) + 1;
  for (std::size_t i = 3; i < places.size(); i += stride) {
    SCOPED_TRACE(places[i]);
    Bytes bytes = good;
    bytes[places[i]] ^= std::byte{0xF0};
    (void)try_snapshot(fuzz::sealed(std::move(bytes)), assets, i);
    if (HasFailure()) return;
  }
}

TEST(hostile_snapshot, limits_name_what_was_found_and_what_is_allowed) {
  const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  const Bytes bytes = value_of(fuzz::make_rich_scene(assets).save());
  Scene scene = fuzz::make_scene();
  const auto refusal = [&](const RestoreOptions& limits) {
    const Status status = scene.restore(bytes, assets, limits);
    EXPECT_EQ(status.code(), StatusCode::limit_exceeded) << status.text();
    EXPECT_EQ(scene.instance_count(), 0u);
    return std::string(status.text());
  };
  RestoreOptions limits;
  limits.instances = 2;
  EXPECT_EQ(refusal(limits),
            "the snapshot has places for 3 instances; RestoreOptions::instances allows 2");
  limits = {};
  limits.operations = 4;
  EXPECT_NE(refusal(limits).find("RestoreOptions::operations allows 4"), std::string::npos);
  limits = {};
  limits.memory = 100'000;
  EXPECT_NE(refusal(limits).find("RestoreOptions::memory allows 100000"), std::string::npos);
  EXPECT_TRUE(scene.restore(bytes, assets));
}

/// A few bytes name an instance; the limit holds before all of them are made.
TEST(hostile_snapshot, a_small_snapshot_does_not_fill_the_memory) {
  const fuzz::SnapshotAssets assets = fuzz::make_snapshot_assets();
  Scene many = fuzz::make_scene();
  for (int i = 0; i < 300; ++i) {
    const auto id = many.spawn(assets[0]);
    ASSERT_TRUE(id && many.find(*id)->prepare_to_tear());
  }
  const Bytes bytes = value_of(many.save());
  const std::size_t needed = many.memory_bytes().instances;
  EXPECT_GT(needed, 20 * bytes.size());
  RestoreOptions limits;
  limits.memory = needed / 4;
  Scene scene = fuzz::make_scene();
  EXPECT_EQ(scene.restore(bytes, assets, limits).code(), StatusCode::limit_exceeded);
}

}  // namespace
}  // namespace sunder
