#include <fstream>
#include <sstream>

#include "bench/cut_share/cut_sides.h"
#include "support/machine/node_program.h"
#include "support/machine/temporary_folder.h"

namespace sunder::bench {
namespace {

template <class Rows>
void write_rows(std::ostream& out, const Rows& rows) {
  const char* separator = "";
  for (const auto& row : rows)
    for (std::size_t i = 0; i < 3; ++i) {
      out << separator << row[i];
      separator = ",";
    }
}

std::string text_of(const std::vector<test::HardCut>& cuts) {
  std::ostringstream text;
  text.precision(17);
  const char* separator = "[";
  for (const test::HardCut& cut : cuts) {
    text << separator << "{\"positions\":[";
    write_rows(text, cut.body.positions);
    text << "],\"triangles\":[";
    write_rows(text, cut.body.triangles);
    text << "],\"plane\":[" << cut.normal.x() << ',' << cut.normal.y() << ',' << cut.normal.z()
         << ',' << cut.normal.dot(cut.point) << "]}";
    separator = ",\n";
  }
  text << ']';
  return text.str();
}

bool read_solid(std::istream& in, test::Solid& solid) {
  std::size_t positions = 0, triangles = 0;
  if (!(in >> positions >> triangles)) return false;
  solid.positions.resize(positions);
  solid.triangles.resize(triangles);
  for (Vec3d& at : solid.positions) in >> at.x() >> at.y() >> at.z();
  for (Triangle& t : solid.triangles) in >> t[0] >> t[1] >> t[2];
  return static_cast<bool>(in);
}

}  // namespace

std::optional<CutSidesOfAll> cut_by_manifold(const std::vector<test::HardCut>& cuts) {
  if (!test::has_node_packages({"manifold-3d"})) return std::nullopt;
  const test::TemporaryFolder folder;
  const auto input = folder.write("cuts.json", text_of(cuts));
  const auto output = folder.path() / "sides.txt";
  const auto run =
      test::run_node_program("sides.mjs", "'" + input.string() + "' '" + output.string() + "'");
  if (!run || !run->succeeded) return std::nullopt;
  std::ifstream in(output);
  CutSidesOfAll all(cuts.size());
  for (auto& sides : all) {
    sides.emplace();
    for (test::Solid& solid : *sides)
      if (!read_solid(in, solid)) return std::nullopt;
  }
  return all;
}

}  // namespace sunder::bench
