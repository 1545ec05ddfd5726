/// @file
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "remote/open_run.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/remote/tool_change.hpp"

namespace viapoint {

/// A run, and how it gets longer.
struct KeptRun {
  std::shared_ptr<Job> job;
  std::shared_ptr<OpenRun> open;  ///< null for one that is whole
  std::vector<ToolChange> tools{};
};

[[nodiscard]] bool has_ended(const Job& job);

/// The newest runs by their numbers, from 1. Threads: one at a time.
class RunBook {
 public:
  explicit RunBook(std::size_t kept) : kept_(kept) {}

  /// Returns its number.
  std::uint64_t add(KeptRun run);
  /// @throws MotionError(kBadArgument) for a run that is not kept
  [[nodiscard]] const KeptRun& find(std::uint64_t number) const { return runs_[place_of(number)]; }
  /// As ArmHost's.
  void add_tools(std::uint64_t number, const std::vector<ToolChange>& changes);
  [[nodiscard]] std::vector<ToolChange> tools(std::uint64_t number, std::size_t offset,
                                              std::size_t most) const;
  /// nullptr before the first.
  [[nodiscard]] const KeptRun* newest() const { return runs_.empty() ? nullptr : &runs_.back(); }
  [[nodiscard]] bool is_any_under_way() const {
    return newest() != nullptr && !has_ended(*newest()->job);
  }
  /// The newest one's number; 0 before the first.
  [[nodiscard]] std::uint64_t last() const { return last_; }

 private:
  [[nodiscard]] std::size_t place_of(std::uint64_t number) const;

  std::size_t kept_;
  std::deque<KeptRun> runs_;  ///< the last has number last_
  std::uint64_t last_ = 0;
};

}  // namespace viapoint
