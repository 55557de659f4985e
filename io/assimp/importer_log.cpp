#include "io/assimp/importer_log.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <mutex>
#include <string_view>
#include <utility>

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

/// Keeps the messages of one import.
class ImporterLog::Collector : public Assimp::LogStream {
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

  std::vector<std::string> messages;
  /// Held while the collector is attached to the program's logger, which sends it the messages of
  /// all threads.
  std::unique_lock<std::mutex> attached;
};

/// A logger that gives each thread's messages to the collector of that thread. It is never
/// removed, because importers in other threads may be using it.
class ImporterLog::ThreadLogger : public Assimp::Logger {
 public:
  static Collector*& collector() {
    thread_local Collector* of_thread = nullptr;
    return of_thread;
  }

  bool attachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }
  bool detachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }

 private:
  void OnDebug(const char* /*message*/) override {}
  void OnVerboseDebug(const char* /*message*/) override {}
  void OnInfo(const char* /*message*/) override {}
  void OnWarn(const char* message) override {
    if (collector() != nullptr) collector()->write(message);
  }
  void OnError(const char* message) override { OnWarn(message); }
};

ImporterLog::ImporterLog() : collector_(new Collector) {
  std::unique_lock<std::mutex> lock(log_mutex());
  if (Assimp::DefaultLogger::isNullLogger()) Assimp::DefaultLogger::set(new ThreadLogger);
  if (dynamic_cast<ThreadLogger*>(Assimp::DefaultLogger::get()) != nullptr) {
    ThreadLogger::collector() = collector_;
    return;
  }
  // A program that logs assimp itself keeps its logger.
  collector_->attached = std::move(lock);
  Assimp::DefaultLogger::get()->attachStream(collector_, kSeverities);
}

ImporterLog::~ImporterLog() {
  if (collector_->attached.owns_lock())
    Assimp::DefaultLogger::get()->detachStream(collector_, kSeverities);
  else
    ThreadLogger::collector() = nullptr;
  delete collector_;
}

const std::vector<std::string>& ImporterLog::messages() const { return collector_->messages; }

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
