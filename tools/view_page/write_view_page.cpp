#include "tools/view_page/write_view_page.h"

#include "tools/page_parts/page_file.h"
#include "tools/view_page/view_data.h"

namespace sunder::tools {

Status write_view_page(const std::filesystem::path& file, const ViewInput& input) {
  if (Status status = has_pages(); !status) return status;
  const auto data = view_data(input);
  if (!data) return data.error();
  return write_page(file, view_page_template(), *data);
}

}  // namespace sunder::tools
