#include "io/assimp/importer_log.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <mutex>
#include <string_view>

#include <assimp/DefaultLogger.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/Logger.hpp>

namespace sunder::assimp_import {
namespace {

constexpr unsigned kSeverities = Assimp::Logger::Warn | Assimp::Logger::Err;
constexpr std::size_t kMostMessages = 32, kLongestMessage = 200;

std::mutex& log_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Texts of assimp's importers about indices and counts, in lower case.
bool tells_of_loss(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 10> kWords = {
      "out of range",   "out-of-range",     "out of bounds",       "invalid index",
      "index overflow", "index is invalid", "indices are invalid", "too large",
      "not referenced", "incorrect"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

}  // namespace

class ImporterLog::Stream : public Assimp::LogStream {
 public:
  void write(const char* text) override {
    if (messages.size() >= kMostMessages) return;
    std::string message = text;
    // "Warn,  T0: " or "Error, T0: "
    if (const std::size_t colon = message.find(": "); colon != std::string::npos && colon < 16)
      message.erase(0, colon + 2);
    while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back())) != 0)
      message.pop_back();
    message.resize(std::min(message.size(), kLongestMessage));
    if (!message.empty() && std::find(messages.begin(), messages.end(), message) == messages.end())
      messages.push_back(valid_utf8(message));
  }

  std::lock_guard<std::mutex> lock{log_mutex()};
  std::vector<std::string> messages;
  bool has_own_logger = false;
};

ImporterLog::ImporterLog() : stream_(new Stream) {
  // A program that logs assimp itself keeps its logger.
  stream_->has_own_logger = Assimp::DefaultLogger::isNullLogger();
  if (stream_->has_own_logger) Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
  Assimp::DefaultLogger::get()->attachStream(stream_, kSeverities);
}

ImporterLog::~ImporterLog() {
  Assimp::DefaultLogger::get()->detachStream(stream_, kSeverities);
  if (stream_->has_own_logger) Assimp::DefaultLogger::kill();
  delete stream_;
}

const std::vector<std::string>& ImporterLog::messages() const { return stream_->messages; }

void add_notes(const std::vector<std::string>& messages, Notes& notes) {
  for (const std::string& message : messages) {
    const std::string text = "the importer says: " + message;
    if (tells_of_loss(message))
      notes.dropped(StatusCode::index_out_of_range, "file", text);
    else
      notes.inform("file", text);
  }
}

}  // namespace sunder::assimp_import
