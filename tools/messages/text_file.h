#pragma once

#include <sunder/core/status.h>

#include <filesystem>
#include <string>

namespace sunder::tools {

/// A text file that appears under its name when it is committed, and otherwise leaves nothing.
class StagedText {
 public:
  StagedText(std::filesystem::path file, const std::string& text);
  ~StagedText();
  StagedText(const StagedText&) = delete;
  StagedText& operator=(const StagedText&) = delete;

  [[nodiscard]] const Status& status() const { return status_; }
  [[nodiscard]] Status commit();

 private:
  std::filesystem::path file_, partial_;
  Status status_;
};

/// Writes the whole text or nothing.
[[nodiscard]] Status write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace sunder::tools
