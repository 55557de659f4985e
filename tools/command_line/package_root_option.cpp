#include "tools/command_line/options.h"

namespace sunder::tools {

void add_package_roots(CLI::App& verb, std::vector<std::filesystem::path>& package_roots) {
  // Another part of the verb may read robots too.
  if (verb.get_option_no_throw("--package-root") == nullptr)
    verb.add_option("--package-root", package_roots,
                    "Folder of packages that the robot's file names. Repeatable")
        ->type_name("FOLDER")
        ->allow_extra_args(false);
}

}  // namespace sunder::tools
