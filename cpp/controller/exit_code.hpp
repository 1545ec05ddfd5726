/// @file
#pragma once

namespace viapoint::controller {

/// How viapoint-controller ends, for scripts that call it.
enum ExitCode : int {
  kFinished = 0,  ///< the motion ran to its end
  kRefused = 1,   ///< the program or the motion was refused; nothing moved
  kUsage = 2,     ///< wrong command line
  kUnreadable =
      3,  ///< a file that cannot be read, or a log that cannot be written, before or after
  kDriveFault = 4,  ///< the drive failed during the run
  kStopped = 5,     ///< a signal stopped the run; the arm rests on its path
};

}  // namespace viapoint::controller
