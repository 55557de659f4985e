#include "tools/command_line/options.h"

namespace sunder::tools {

void add_strict(CLI::App& verb, bool& strict) {
  verb.add_flag("--strict", strict,
                "Refuse models with faults that loading would repair, or drop with a part");
}

}  // namespace sunder::tools
