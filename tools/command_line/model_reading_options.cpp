#include "tools/command_line/number_option.h"
#include "tools/command_line/options.h"

namespace sunder::tools {

void add_model_reading(CLI::App& verb, ModelReading& reading) {
  verb.add_flag("--strict", reading.strict,
                "Refuse models with faults that loading would repair, or drop with a part");
  verb.add_option("--package-root", reading.package_roots,
                  "Folder of packages that the robot's file names. Repeatable")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  takes(verb.add_option("--import-seconds", reading.import_seconds,
                        "Time limit for formats that are read in the helper process"),
        kSeconds, Quantity::time)
      ->type_name("SECONDS")
      ->capture_default_str();
  takes(verb.add_option("--memory", reading.memory,
                        "Limit for the memory that reading glTF takes; without it 20 times the "
                        "files, at least 64"),
        kMegabytes)
      ->type_name("MEGABYTES");
}

}  // namespace sunder::tools
