/// @file
/// Proof that a stretch of code leaves the heap alone.
#pragma once

#include <cstdint>

namespace viapoint {

/// Counts this thread's calls of operator new and delete, and of malloc and its kin, while it
/// lives.
class NoAllocationScope {
 public:
  NoAllocationScope();
  ~NoAllocationScope();
  NoAllocationScope(const NoAllocationScope&) = delete;
  NoAllocationScope& operator=(const NoAllocationScope&) = delete;

  [[nodiscard]] std::uint64_t calls() const;
};

}  // namespace viapoint
