// A character from arrays instead of a file (samples/tube.h fills them): a tube of two bones, bent
// at its joint and torn along its front.

#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <cstdio>
#include <memory>

#include "samples/tube.h"

int main() {
  const auto character = std::make_shared<const sunder::Character>(samples::make_tube());
  if (const sunder::Status status = validate_character(*character); !status)
    return std::printf("%s\n", status.text().data()), 1;

  auto torn = sunder::TornModel::create(character);
  if (!torn) return std::printf("%s\n", torn.error().text().data()), 1;
  const sunder::Stroke stroke = {{{0.02, 0.25, 0.5}, {0.02, 0.25, 0.0}},
                                 {{0.01, 0.40, 0.5}, {0.01, 0.40, 0.0}},
                                 {{-0.03, 0.55, 0.6}, {-0.03, 0.55, 0.1}}};
  const auto report = torn->tear(samples::bent(*character, 0.8), stroke);
  if (!report) return std::printf("%s\n", report.error().text().data()), 1;

  const auto before = count_topology(*character), after = count_topology(torn->character());
  if (!before || !after) return std::puts("out of memory"), 1;
  std::printf("segments %u, faces crossed %u, length %.3f m\n", report->segments,
              report->faces_crossed, report->length_posed);
  std::printf("points %u -> %u, triangles %u -> %u, boundary loops %u -> %u\n", before->points,
              after->points, before->triangles, after->triangles, before->boundary_loops,
              after->boundary_loops);
  return report->runs > 0 && after->boundary_loops == before->boundary_loops + 1 ? 0 : 1;
}
