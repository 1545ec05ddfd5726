/// @file
#pragma once

#include <cstdint>
#include <string>
#include <thread>

#include "viapoint/remote/arm_host.hpp"

namespace viapoint::controller {

/// Writes the log of every run into a folder when the run has ended, from a thread of its own: a
/// file a run, named after the time and the run's number. A disk that is full or gone is said in
/// the process's log and disturbs nothing else.
class RunArchive {
 public:
  /// @param host outlives the archive
  /// @throws MotionError(kFile) for a folder that cannot be written into
  RunArchive(const ArmHost& host, const std::string& folder);
  /// Writes what has ended by then.
  ~RunArchive();
  RunArchive(const RunArchive&) = delete;
  RunArchive& operator=(const RunArchive&) = delete;

 private:
  void follow(const std::stop_token& stop);
  /// True once there is nothing left to write of run `number`.
  [[nodiscard]] bool archive(std::uint64_t number) const;

  const ArmHost& host_;
  std::string folder_;
  std::jthread thread_;
};

}  // namespace viapoint::controller
