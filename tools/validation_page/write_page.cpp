#include "tools/validation_page/write_page.h"

#include "tools/page_parts/page_file.h"
#include "tools/validation_page/page_data.h"

namespace sunder::tools {

Status write_validation_page(const std::filesystem::path& file, const PageInput& input) {
  if (Status status = has_pages(); !status) return status;
  const auto data = page_data(input);
  if (!data) return data.error();
  return write_page(file, validation_page_template(), *data);
}

}  // namespace sunder::tools
