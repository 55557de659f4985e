#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/files/allowed_files.h"
#include "io/import_messages/messages.h"
#include "io/import_messages/socket.h"

namespace sunder::contained_import {

enum class Outcome {
  replied,
  ended,  ///< The socket was closed, or a message was not valid.
  timed_out,
  too_large,     ///< The reply is above the limit.
  insatiable,    ///< It asked for files too often.
  failed,        ///< The helper told the cause.
  wrong_helper,  ///< The first message was not that of a helper of this version.
  unfiltered,    ///< It has no filter of system calls, and the caller requires one.
};

struct Conversation {
  Outcome outcome = Outcome::ended;
  import_messages::Ready ready;
  std::uint64_t cause = 0;  ///< Of `failed`.
  std::string head;
  std::vector<std::byte> body;
};

struct ConversationRules {
  bool requires_filter = false;
  /// The most bytes of the GLB; asked for when the reply begins, and checked before memory is
  /// taken.
  std::function<std::uint64_t()> maximum_reply;
  /// Is called with the size of each opened file, once per file, before it is sent.
  std::function<void(std::uint64_t)> file_opened;
};

/// Answers the helper's requests until it replies, ends, or the socket's deadline passes. Nothing
/// that the helper sends is trusted after `ready`. Holds at most the bytes that arrived, within the
/// limit. Throws std::bad_alloc.
[[nodiscard]] Conversation serve(import_messages::Socket& socket, files::AllowedFiles& allowed,
                                 const ConversationRules& rules);

}  // namespace sunder::contained_import
