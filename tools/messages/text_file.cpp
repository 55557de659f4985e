#include "tools/messages/text_file.h"

#include <fstream>
#include <system_error>
#include <utility>

namespace sunder::tools {

StagedText::StagedText(std::filesystem::path file, const std::string& text)
    : file_(std::move(file)), partial_(file_) {
  partial_ += ".partial";
  std::ofstream stream(partial_, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream)
    status_ = Status::failure(StatusCode::file_unreadable, kNone, "cannot write this file");
}

StagedText::~StagedText() {
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

Status StagedText::commit() {
  if (!status_) return status_;
  std::error_code error;
  std::filesystem::rename(partial_, file_, error);
  return error ? Status::failure(StatusCode::file_unreadable, kNone, "cannot write this file")
               : Status();
}

Status write_text(const std::filesystem::path& file, const std::string& text) {
  return StagedText(file, text).commit();
}

}  // namespace sunder::tools
