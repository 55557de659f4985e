#include "tools/tear/operation_line.h"

#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

/// "1 piece", "2 pieces".
std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

bool opens_surface(const OperationOutcome& outcome) { return outcome.tear.runs > 0; }

}  // namespace

std::string operation_line(const OperationOutcome& outcome, const std::optional<TornPlace>& place) {
  std::string line = outcome.op;
  if (place)
    line += " at " + point_text(place->centre) +
            (place->bone.empty() ? "" : " on '" + place->bone + "'");
  const TearReport& tear = outcome.tear;
  if (opens_surface(outcome)) {
    line += outcome.threads > 0 ? ": " + counted(outcome.threads, "thread", "threads")
                                : ": " + counted(tear.faces_crossed, "face", "faces") + " crossed";
    // A bore takes surface away and opens no line.
    if (tear.length_posed > 0) line += printed(", %.4g m long", tear.length_posed);
    if (tear.area_removed_posed > 0) line += printed(", %.4g m2 removed", tear.area_removed_posed);
    if (!tear.pieces.empty()) line += ", " + counted(tear.pieces.size(), "piece", "pieces");
    if (tear.caps > 0) line += ", " + counted(tear.caps, "cap", "caps");
    if (tear.open_sections > 0)
      line += ", " + counted(tear.open_sections, "section", "sections") + " left open";
    if (tear.segments_missed > 0)
      line += ", " + std::to_string(tear.segments_missed) + " of " +
              counted(tear.segments, "segment", "segments") + " missed";
    if (tear.blocked > 0) line += ", " + counted(tear.blocked, "place", "places") + " blocked";
  } else {
    line += std::string(": ") + outcome.done;
    if (!tear.pieces.empty())
      line += ", " + counted(tear.pieces[0].triangle_count, "triangle", "triangles");
    if (tear.weights.points > 0) line += ", " + counted(tear.weights.points, "point", "points");
  }
  return line + printed(", %.3g ms", 1000 * outcome.seconds);
}

std::string operation_details(const OperationOutcome& outcome) {
  const TearReport& tear = outcome.tear;
  const WeightReport& weights = tear.weights;
  std::string text = counted(tear.runs, "run", "runs") + ", " +
                     counted(tear.segments, "segment", "segments") + ", " +
                     counted(tear.points_added, "point", "points") + ", " +
                     counted(tear.vertices_added, "vertex", "vertices") + " and " +
                     counted(tear.triangles_added, "triangle", "triangles") + " added, " +
                     counted(tear.triangles_retired, "triangle", "triangles") + " retired, " +
                     counted(tear.blocked, "place", "places") + " blocked";
  text += "; weights: " + counted(weights.points, "point", "points") + " weighed";
  if (weights.pruned > 0) text += ", " + std::to_string(weights.pruned) + " pruned";
  if (weights.ill_conditioned > 0)
    text += ", " + std::to_string(weights.ill_conditioned) + " ill-conditioned";
  if (weights.refitted > 0) text += ", " + std::to_string(weights.refitted) + " refitted";
  if (weights.uncertified > 0)
    text += ", " + std::to_string(weights.uncertified) + " without a certificate";
  return text;
}

}  // namespace sunder::tools
