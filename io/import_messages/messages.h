#pragma once

#include <array>
#include <cstdint>

namespace sunder::import_messages {

// The caller and the helper process talk through one stream socket. Both run on one machine and are
// of one build; kProtocol changes with every change of a message.
//
//   caller: Job, name of the model; with the descriptor of the model
//   helper: Ready, before it reads a byte of the model
//   helper: Request, reference     caller: Answer, text; with a descriptor if it opened a file
//   helper: Request `reply` and the reply, or `failed`

inline constexpr std::uint32_t kProtocol = 0x534E4402;

/// The descriptor of the socket in the helper process.
inline constexpr int kSocket = 3;

inline constexpr std::uint64_t kMostReferenceBytes = 4096;
inline constexpr std::uint64_t kMostRequests = 4'096;

struct Job {
  std::uint32_t protocol = kProtocol;
  std::uint32_t name_bytes = 0;
  std::uint64_t model_bytes = 0;
  std::uint64_t maximum_bytes = 0;   ///< LoadOptions::maximum_bytes.
  std::uint64_t memory = 0;          ///< Address space beyond what the helper needs to start.
  std::uint64_t largest_memory = 0;  ///< To which the caller may raise it.
  std::uint32_t cpu_seconds = 0;
  std::int32_t caller = 0;  ///< Process id.
  std::uint32_t strict = 0;
  std::uint32_t requires_filter = 0;  ///< The helper ends before it reads the model if it has none.
};

struct Ready {
  std::uint32_t protocol = kProtocol;
  std::uint32_t has_filter = 0;     ///< Whether system calls are filtered.
  std::array<char, 120> why_not{};  ///< Ends with 0.
};

enum class RequestKind : std::uint32_t { look_up = 1, open = 2, reply = 3, failed = 4 };

/// Causes for `failed`, in Request::first: a signal's number, or one of these.
inline constexpr std::uint64_t kOutOfMemory = 1000;
inline constexpr std::uint64_t kException = 1001;

struct Request {
  std::uint32_t protocol = kProtocol;
  RequestKind kind = RequestKind::look_up;
  std::uint64_t first = 0;   ///< Bytes of the reference, or of the reply's head; cause of `failed`.
  std::uint64_t second = 0;  ///< Bytes of the reply's GLB.
};

struct Answer {
  std::uint32_t code = 0;  ///< StatusCode.
  std::uint32_t text_bytes = 0;
  std::uint64_t bytes = 0;  ///< Size of the opened file.
};

}  // namespace sunder::import_messages
