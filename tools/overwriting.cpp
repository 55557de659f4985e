#include "tools/overwriting.h"

#include <system_error>

namespace sunder::tools {

bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const std::filesystem::path canonical_a = std::filesystem::weakly_canonical(a, error);
  if (error) return false;
  const std::filesystem::path canonical_b = std::filesystem::weakly_canonical(b, error);
  return !error && canonical_a == canonical_b;
}

std::string overwriting(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs,
                        bool may_overwrite_inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedFile& output = outputs[i];
    for (std::size_t j = 0; j < i; ++j)
      if (is_one_file(output.file, outputs[j].file))
        return output.option + " " + output.file.string() + ": would overwrite the file of " +
               outputs[j].option;
    if (may_overwrite_inputs) continue;
    for (const NamedFile& input : inputs)
      if (is_one_file(output.file, input.file))
        return output.option + " " + output.file.string() + ": would overwrite " + input.option +
               " " + input.file.string() + "; --force allows it";
  }
  return {};
}

}  // namespace sunder::tools
