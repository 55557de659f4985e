#pragma once

namespace sunder::tear {

/// Thrown where a model of fixed capacity has no room left for what an operation would append. The
/// operation is taken back.
struct CapacityExceeded {
  const char* what;
};

}  // namespace sunder::tear
