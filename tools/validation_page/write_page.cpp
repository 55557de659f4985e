#include "tools/validation_page/write_page.h"

#include <string>
#include <string_view>

#include "tools/text_file.h"
#include "tools/validation_page/base64.h"
#include "tools/validation_page/page_data.h"
#include "tools/validation_page/page_template.h"

namespace sunder::tools {

Status has_page() {
  if (!page_template().empty()) return {};
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "this build has no HTML page: run scripts/setup page, configure and "
                         "build again");
}

Status write_validation_page(const std::filesystem::path& file, const PageInput& input) {
  if (const Status status = has_page(); !status) return status;
  const auto data = page_data(input);
  if (!data) return data.error();
  std::string text;
  for (const std::string_view piece : page_template()) text += piece;
  text.replace(text.find(kPageDataMark), kPageDataMark.size(), base64(*data));
  return write_text(file, text);
}

}  // namespace sunder::tools
