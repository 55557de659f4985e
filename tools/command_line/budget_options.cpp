#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"

namespace sunder::tools {

void add_budget(CLI::App& verb, BudgetLimits& limits) {
  takes(verb.add_option(
            "--max-seconds", limits.seconds,
            "Time limit for the work, up to where files are written; beyond: exit code 4"),
        kSeconds, Quantity::time)
      ->type_name("SECONDS")
      ->capture_default_str();
  takes(verb.add_option("--max-memory", limits.megabytes,
                        "Limit for the memory of the whole command, likewise"),
        kMegabytes)
      ->type_name("MEGABYTES")
      ->capture_default_str();
}

void add_budget_of_operations(CLI::App& verb, BudgetLimits& limits) {
  add_budget(verb, limits);
  takes_count(verb.add_option("--max-vertices", limits.vertices,
                              "Limit for the vertices that operations add to a mesh; four times as "
                              "many triangles; beyond: exit code 4"),
              0, kMostVertices)
      ->type_name("N")
      ->capture_default_str();
}

}  // namespace sunder::tools
