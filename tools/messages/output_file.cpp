#include "tools/messages/output_file.h"

#include <algorithm>
#include <cctype>
#include <system_error>

namespace sunder::tools {
namespace {

template <class Convert>
std::string converted(std::string text, const Convert& convert) {
  std::ranges::transform(text, text.begin(),
                         [&](unsigned char letter) { return static_cast<char>(convert(letter)); });
  return text;
}

}  // namespace

std::string impossible_output(const std::vector<NamedFile>& outputs) {
  std::error_code error;
  for (const NamedFile& output : outputs) {
    if (output.file.empty()) return output.option + ": expected the name of a file, found nothing";
    const std::string begin = output.option + " " + output.file.string() + ": ";
    if (!output.file.has_filename() || std::filesystem::is_directory(output.file, error))
      return begin + "is a folder; expected a file";
    const std::filesystem::path folder = output.file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder, error))
      return begin + "there is no folder '" + folder.string() + "'";
  }
  return {};
}

std::string other_ending(const NamedFile& output, const std::string& ending) {
  const std::string found = converted(output.file.extension().string(),
                                      [](unsigned char letter) { return std::tolower(letter); });
  if (found == "." + ending || (ending == "glb" && found == ".vrm")) return {};
  const std::string format =
      converted(ending, [](unsigned char letter) { return std::toupper(letter); });
  return output.option + " " + output.file.string() + ": the file is written as " + format +
         ", but its name does not end in ." + ending;
}

}  // namespace sunder::tools
