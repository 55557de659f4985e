#include "support/oracles/manifold_oracle.h"

#include <sstream>

#include "support/machine/node_program.h"
#include "support/machine/temporary_folder.h"

namespace sunder::test {
namespace {

template <std::size_t N, class T>
void write(std::ostream& out, const char* name, const std::vector<std::array<T, N>>& rows,
           bool nested) {
  out << '"' << name << "\": [";
  const char* separator = "";
  for (const auto& row : rows) {
    out << separator << (nested ? "[" : "");
    for (std::size_t i = 0; i < N; ++i) out << (i > 0 ? ", " : "") << row[i];
    out << (nested ? "]" : "");
    separator = ", ";
  }
  out << ']';
}

}  // namespace

bool has_manifold() {
  static const bool is_there = has_node_packages({"manifold-3d"});
  return is_there;
}

std::vector<SplitCells> split_by_manifold(const std::vector<SplitTask>& tasks) {
  std::ostringstream text;
  text.precision(17);
  text << '[';
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    text << (i > 0 ? ",\n{" : "{");
    write(text, "positions", tasks[i].positions, false);
    text << ", ";
    write(text, "triangles", tasks[i].triangles, false);
    text << ", ";
    write(text, "planes", tasks[i].planes, true);
    text << '}';
  }
  text << ']';
  const TemporaryFolder folder;
  const auto file = folder.write("tasks.json", text.str());
  const auto run = run_node_program("split.mjs", "'" + file.string() + "'");
  if (!run || !run->succeeded) return {};
  std::vector<SplitCells> cells(tasks.size());
  std::istringstream lines(run->output);
  std::size_t body = 0;
  std::string sides;
  SplitCell cell;
  while (lines >> body >> sides >> cell.volume >> cell.parts)
    if (body < cells.size()) cells[body][sides] = cell;
  return cells;
}

}  // namespace sunder::test
