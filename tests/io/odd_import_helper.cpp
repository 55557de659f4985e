// A helper executable that misbehaves in the way that its name says, for contained_import_test.cpp.
// A model that has taken over the real helper could do the same.

#include <csignal>
#include <cstdint>
#include <cstring>
#include <string>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include "io/import_messages/messages.h"

namespace {

using namespace sunder::import_messages;

template <class T>
void put(const T& value) {
  (void)!send(kSocket, &value, sizeof value, MSG_NOSIGNAL);
}

void put(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t sent = send(kSocket, text.data() + at, text.size() - at, MSG_NOSIGNAL);
    if (sent <= 0) _exit(1);
    at += static_cast<std::size_t>(sent);
  }
}

void reply(const std::string& head, const std::string& body) {
  put(Request{.kind = RequestKind::reply, .first = head.size(), .second = body.size()});
  put(head);
  put(body);
}

void ask(const std::string& reference) {
  put(Request{.kind = RequestKind::open, .first = reference.size()});
  put(reference);
}

/// Opens the same file again and again, as if each of its copies were a file of the model.
void open_again(const std::string& reference) {
  for (int i = 0; i < 100; ++i) {
    ask(reference);
    Answer answer;
    // One that succeeded has no text.
    if (recv(kSocket, &answer, sizeof answer, MSG_WAITALL) != sizeof answer || answer.code != 0)
      _exit(1);
  }
}

/// The limit of memory that the caller may raise, in MiB.
rlim_t memory_limit() {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  return limit.rlim_cur >> 20;
}

void limit_memory() {
  const rlimit limit{rlim_t{1024} << 20, rlim_t{1} << 40};
  setrlimit(RLIMIT_AS, &limit);
}

const std::string kGoodHead =
    R"({"code":0,"index":0,"text":"","format":"F","space":"S","notes":[]})";

/// A GLB whose JSON needs much more memory.
std::string bomb() {
  const auto chunk = [](const std::string& type, std::string data) {
    data.resize((data.size() + 3) / 4 * 4, ' ');
    const auto bytes = static_cast<std::uint32_t>(data.size());
    return std::string(reinterpret_cast<const char*>(&bytes), 4) + type + data;
  };
  std::string json = R"({"asset":{"version":"2.0"},"extras":[0)";
  while (json.size() < (60u << 20)) json += ",{}";
  const std::string content = chunk("JSON", json + "]}");
  const std::uint32_t head[] = {2, static_cast<std::uint32_t>(content.size()) + 12};
  return "glTF" + std::string(reinterpret_cast<const char*>(head), 8) + content;
}

void misbehave(const std::string& how) {
  if (how == "exit") return;
  if (how == "segv") std::raise(SIGSEGV);
  if (how == "abort") std::raise(SIGABRT);
  if (how == "kill") std::raise(SIGKILL);
  if (how == "hang") pause();
  if (how == "close_and_hang") {
    close(kSocket);
    pause();
  }
  if (how == "tell_segv") put(Request{.kind = RequestKind::failed, .first = SIGSEGV});
  if (how == "tell_memory") put(Request{.kind = RequestKind::failed, .first = kOutOfMemory});
  if (how == "tell_nonsense") put(Request{.kind = RequestKind::failed, .first = ~0ull});
  if (how == "garbage") put(std::string(100'000, 'x'));
  if (how == "short") {
    put(Request{.kind = RequestKind::reply, .first = kGoodHead.size(), .second = 1000});
    put(kGoodHead + "glTF");
  }
  if (how == "oversized") put(Request{.kind = RequestKind::reply, .first = 2, .second = ~0ull / 2});
  if (how == "declared_1_gib") {
    put(Request{.kind = RequestKind::reply, .first = kGoodHead.size(), .second = 1u << 30});
    put(kGoodHead);
    for (int i = 0; i < 1024; ++i) put(std::string(1u << 20, 'x'));
  }
  if (how == "large") reply(kGoodHead, std::string(100u << 20, 'x'));
  if (how == "bomb") reply(kGoodHead, bomb());
  if (how == "oversized_head")
    put(Request{.kind = RequestKind::reply, .first = ~0ull, .second = 1});
  if (how == "no_json") reply("not JSON", "");
  if (how == "no_glb") reply(kGoodHead, "not a GLB");
  if (how == "good_without_filter") reply(kGoodHead, "not read by import_as_glb()");
  if (how == "empty_glb") reply(kGoodHead, "");
  if (how == "opens_again_for_memory") {
    limit_memory();
    open_again("side.bin");
    reply(R"({"code":1,"index":0,"text":")" + std::to_string(memory_limit()) +
              R"( MiB","format":"F","space":"S","notes":[]})",
          "");
  }
  if (how == "opens_again_for_reply") {
    open_again("side.bin");
    reply(kGoodHead, std::string(200u << 20, 'x'));
  }
  if (how == "unknown_request") put(Request{.kind = RequestKind{77}, .first = 10});
  if (how == "long_reference") ask(std::string(100'000, 'a'));
  if (how == "unread_answers")
    for (;;) ask("absent");
  if (how == "requests_without_end")
    for (std::vector<char> answer(65'536);; recv(kSocket, answer.data(), answer.size(), 0))
      ask("absent");
}

}  // namespace

int main(int, char** arguments) {
  const std::string path = arguments[0];
  const std::string how = path.substr(path.rfind('/') + 1);
  Job job;
  if (recv(kSocket, &job, sizeof job, MSG_WAITALL) != sizeof job) return 1;
  std::vector<char> name(job.name_bytes);
  if (recv(kSocket, name.data(), name.size(), MSG_WAITALL) <= 0) return 1;
  if (how == "not_ready") {
    put(std::string(1000, 'x'));
    return 0;
  }
  if (how == "never_ready") pause();
  Ready ready;
  ready.has_filter = 0;
  std::strcpy(ready.why_not.data(), "a test");
  put(ready);
  misbehave(how);
  return 0;
}
