#pragma once

#include <sunder/core/status.h>

#include <sys/types.h>

#include "io/contained_import/find_helper.h"
#include "io/import_messages/socket.h"
#include "io/internal/descriptor.h"

namespace sunder::contained_import {

/// A running helper. It is killed, if it still runs, and reaped at the end of the scope.
class HelperProcess {
 public:
  /// Starts `helper` with one end of a socket, /dev/null as its standard streams, no other
  /// descriptor, an environment of LD_LIBRARY_PATH and settings of malloc, in a session of its own.
  /// @return file_unreadable if it cannot be executed, limit_exceeded if there are no descriptors
  ///         or processes.
  [[nodiscard]] static Result<HelperProcess> start(const OwnProgram& helper,
                                                   import_messages::Clock::time_point deadline);

  HelperProcess(HelperProcess&& other) noexcept;
  HelperProcess& operator=(HelperProcess&&) = delete;
  ~HelperProcess();

  [[nodiscard]] import_messages::Socket& socket() { return socket_; }
  [[nodiscard]] pid_t id() const { return id_; }

  /// Waits until the process has ended, or kills it at `deadline`, and reaps it.
  /// @return the wait status, or -1 if the program ignores SIGCHLD, or waits for all its children,
  ///         and so the status is lost.
  int finish(import_messages::Clock::time_point deadline);

 private:
  HelperProcess(pid_t id, import_messages::Socket socket);
  void kill_now() const;

  pid_t id_ = -1;              ///< -1: reaped.
  files::Descriptor process_;  ///< Refers to this process even after its number is used again.
  import_messages::Socket socket_;
};

}  // namespace sunder::contained_import
