#include <sunder/io/robot_file.h>

#include <string>
#include <utility>
#include <vector>

#include "io/gltf/refusal.h"
#include "io/gltf_files/folder_files.h"
#include "io/urdf/findings.h"
#include "io/urdf/read_robot.h"

namespace sunder {
namespace {

/// Whether a warning is about a shape that was left out.
bool is_loss(std::string_view code) {
  return code != "mesh_huge" && (code.starts_with("mesh_") || code.starts_with("geometry_") ||
                                 code.starts_with("package_"));
}

LoadNote note_of(const RobotFinding& finding) {
  LoadNote note;
  if (finding.code == "import_unfiltered")
    note.kind = LoadNote::Kind::warning;
  else if (finding.severity == RobotSeverity::information)
    note.kind = LoadNote::Kind::information;
  else
    note.kind = is_loss(finding.code) ? LoadNote::Kind::dropped : LoadNote::Kind::repaired;
  note.place = finding.place.empty() ? "robot" : finding.place;
  note.text = std::string(finding.code) + ": " + finding.text;
  return note;
}

std::string read_text(const std::filesystem::path& file, std::uint64_t maximum_bytes) {
  const std::vector<std::byte> bytes = gltf::read_file(file, maximum_bytes, "file");
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

std::string_view robot_severity_name(RobotSeverity severity) {
  switch (severity) {
    case RobotSeverity::information: return "information";
    case RobotSeverity::warning: return "warning";
    case RobotSeverity::error: return "error";
  }
  return "unknown";
}

Result<LoadedRobot> load_robot(const std::filesystem::path& file, const RobotLoadOptions& options,
                               std::vector<RobotFinding>* findings) {
  return gltf::without_exceptions<LoadedRobot>([&]() -> Result<LoadedRobot> {
    if (findings != nullptr) findings->clear();
    urdf::Findings found(options.strict);
    Result<LoadedRobot> loaded =
        urdf::read_robot(read_text(file, options.maximum_urdf_bytes), file, options, found);
    std::vector<RobotFinding> all = found.take();
    if (findings != nullptr) *findings = all;
    if (!loaded) return loaded;
    for (const RobotFinding& finding : all) loaded->model.report.notes.push_back(note_of(finding));
    loaded->findings = std::move(all);
    return loaded;
  });
}

}  // namespace sunder
