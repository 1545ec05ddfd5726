/// @file
/// What Python holds of loops, runs and logs.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "drive_setup.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint::python {

/// A loop that Python can close before the object itself goes. Shared, so that a thread that is
/// inside a call while another one closes keeps it alive until it is out.
template <typename Loop>
struct HandleOf {
  std::shared_ptr<Loop> loop;
  int joints = 0;
  DriveLinks links;

  [[nodiscard]] std::shared_ptr<Loop> open() const {
    if (loop == nullptr) {
      throw MotionError(ErrorCode::kDriveFault, "The arm is no longer connected.",
                        {"Connect again: viapoint.connect(...)."});
    }
    return loop;
  }
  /// A run under way is brought to rest first, which takes time: the GIL is not held meanwhile.
  void close() {
    std::shared_ptr<Loop> closing = std::move(loop);
    const py::gil_scoped_release release;
    closing.reset();
  }
};
using LoopHandle = HandleOf<ControllerLoop>;
using VirtualLoopHandle = HandleOf<VirtualLoop>;

struct JobHandle {
  std::shared_ptr<Job> job;
  int joints = 0;
};

/// The cycles of a run, kept in C++ until somebody asks for arrays or a file.
struct LogHandle {
  std::vector<LogRecord> records;
  int joints = 0;
};

/// Log, RunReport and Job.
void bind_run(py::module_& m);
/// A program that is run while it is told, on either loop.
void bind_motion_stream(py::module_& m);

}  // namespace viapoint::python
