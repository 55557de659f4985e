// The notes of a load report: io/gltf_read/notes.h.
#include "io/gltf_read/notes.h"

#include <gtest/gtest.h>

namespace sunder::gltf {
namespace {

TEST(LoadNotes, equal_texts_about_one_place_are_counted) {
  LoadReport report;
  Notes notes(report, false);
  const auto repaired = [&](const char* place, const char* text, std::uint32_t count) {
    notes.repaired(StatusCode::malformed_file, kNone, place, text, count);
  };
  repaired("clip 'Walk'", "keys were merged", 118);
  repaired("clip 'Walk'", "keys were merged", 20);
  repaired("clip 'Run'", "keys were merged", 3);
  notes.dropped(StatusCode::malformed_file, kNone, "clip 'Run'", "keys were merged", 4);
  repaired("clip 'Run'", "keys were sorted", 5);
  ASSERT_EQ(report.notes.size(), 4u);
  EXPECT_EQ(report.notes[0].place, "clip 'Walk'");
  EXPECT_EQ(report.notes[0].count, 138u);
  EXPECT_EQ(report.notes[1].count, 3u);
  EXPECT_EQ(report.notes[2].kind, LoadNote::Kind::dropped);
  EXPECT_EQ(report.notes[3].text, "keys were sorted");
}

}  // namespace
}  // namespace sunder::gltf
