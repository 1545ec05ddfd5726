// A program that is run while it is told, on either loop.
#include <pybind11/typing.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "python_run.hpp"
#include "run_handles.hpp"
#include "viapoint/streaming/motion_stream.hpp"

namespace viapoint::python {
namespace {

using Release = py::gil_scoped_release;

/// One thread tells the steps while another hands motion over.
class StreamHandle {
 public:
  template <typename Loop>
  StreamHandle(const HandleOf<Loop>& loop, const RobotHandle& robot, const MotionProgram& program,
               double margin)
      : StreamHandle(
            robot, program, margin,
            // An arm that is disconnected is not held by its streams.
            [this, to = std::weak_ptr<Loop>(loop.open())](std::shared_ptr<const Trajectory> first) {
              std::shared_ptr<OpenJob> job =
                  HandleOf<Loop>{to.lock(), 0, {}}.open()->follow(std::move(first));
              job_ = job;
              return job;
            }) {}
  StreamHandle(const RobotHandle& robot, const MotionProgram& program, double margin,
               MotionStream::Follow follow)
      : joints_(robot.robot->joints()), stream_(robot.robot, program, std::move(follow), margin) {}

  /// Takes the steps of `program` from `kept` on, and drops them there.
  void take(MotionProgram& program, size_t kept) {
    if (kept > program.steps.size()) {
      throw MotionError(ErrorCode::kBadArgument, std::to_string(kept) +
                                                     " steps are to be kept of " +
                                                     std::to_string(program.steps.size()));
    }
    const auto first = program.steps.begin() + static_cast<std::ptrdiff_t>(kept);
    const std::vector<Step> steps(first, program.steps.end());
    program.steps.erase(first, program.steps.end());
    const Release release;
    const std::lock_guard lock(mutex_);
    for (const Step& step : steps) stream_.add(step);
  }
  void end() {
    const Release release;
    const std::lock_guard lock(mutex_);
    stream_.end();
  }
  void hand_over() {
    const Release release;
    const std::lock_guard lock(mutex_);
    stream_.hand_over();
  }
  [[nodiscard]] int steps_ahead() {
    const Release release;
    const std::lock_guard lock(mutex_);
    return stream_.steps_ahead();
  }
  [[nodiscard]] bool wants_steps() {
    const Release release;
    const std::lock_guard lock(mutex_);
    return stream_.wants_steps();
  }
  [[nodiscard]] std::optional<JobHandle> job() {
    const Release release;
    const std::lock_guard lock(mutex_);
    if (job_ == nullptr) return std::nullopt;
    return JobHandle{job_, joints_};
  }
  [[nodiscard]] std::optional<std::string> state() {
    const Release release;
    const std::lock_guard lock(mutex_);
    if (stream_.run() == nullptr) return std::nullopt;
    return std::string(to_string(stream_.run()->state()));
  }
  [[nodiscard]] std::uint64_t late_count() {
    const Release release;
    const std::lock_guard lock(mutex_);
    return stream_.late_count();
  }
  /// (step, file, line, cycles waited), the newest last.
  [[nodiscard]] std::vector<std::tuple<int, std::string, int, std::uint64_t>> late() {
    const Release release;
    const std::lock_guard lock(mutex_);
    std::vector<std::tuple<int, std::string, int, std::uint64_t>> steps;
    for (const LateStep& late : stream_.late()) {
      steps.emplace_back(late.step, late.source.file, late.source.line, late.waited_cycles);
    }
    return steps;
  }
  [[nodiscard]] std::vector<CornerOutcome> take_corners() {
    const Release release;
    const std::lock_guard lock(mutex_);
    return stream_.take_corners();
  }
  [[nodiscard]] std::vector<Problem> take_warnings() {
    const Release release;
    const std::lock_guard lock(mutex_);
    return stream_.take_warnings();
  }

 private:
  int joints_;
  std::mutex mutex_;
  std::shared_ptr<Job> job_;  ///< null for a run of another process
  MotionStream stream_;
};

template <typename Loop>
std::unique_ptr<StreamHandle> make_stream(const HandleOf<Loop>& loop, const RobotHandle& robot,
                                          const MotionProgram& program, double margin) {
  return std::make_unique<StreamHandle>(loop, robot, program, margin);
}

/// @param follow begins a run with the motion it is given, and returns it
std::unique_ptr<StreamHandle> make_stream_by(py::typing::Callable<py::object(MotionHandle)> follow,
                                             const RobotHandle& robot, const MotionProgram& program,
                                             double margin) {
  const std::shared_ptr<py::object> kept = held(std::move(follow));
  return std::make_unique<StreamHandle>(
      robot, program, margin, [kept](std::shared_ptr<const Trajectory> first) {
        return in_python([&] {
          return std::make_shared<PythonRun>(
              (*kept)(MotionHandle{nullptr, std::move(first), {}, {}}));
        });
      });
}

}  // namespace

void bind_motion_stream(py::module_& m) {
  // NOLINTNEXTLINE(performance-unnecessary-value-param): that is how translators are called
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const PythonError& error) {
      error.raise();
    }
  });
  py::class_<StreamHandle>(m, "MotionStream", "Runs a program while it is told. Threads: any.")
      .def(py::init(&make_stream<ControllerLoop>), py::arg("loop"), py::arg("robot"),
           py::arg("program"), py::kw_only(), py::arg("margin"))
      .def(py::init(&make_stream<VirtualLoop>), py::arg("loop"), py::arg("robot"),
           py::arg("program"), py::kw_only(), py::arg("margin"))
      .def(py::init(&make_stream_by), py::arg("follow"), py::arg("robot"), py::arg("program"),
           py::kw_only(), py::arg("margin"))
      .def("take", &StreamHandle::take, py::arg("program"), py::arg("kept"),
           "Take the steps of a program from the number kept on, and drop them there.")
      .def("end", &StreamHandle::end, "No step follows.")
      .def("hand_over", &StreamHandle::hand_over, "Hand over what is due.")
      .def_property_readonly("steps_ahead", &StreamHandle::steps_ahead,
                             "Steps told that the arm has not begun.")
      .def_property_readonly("wants_steps", &StreamHandle::wants_steps,
                             "What was told gives the arm no motion more.")
      .def_property_readonly("state", &StreamHandle::state, "Of the run, once it has begun.")
      .def_property_readonly("job", &StreamHandle::job,
                             "The run, once it has begun, of a loop of this process.")
      .def_property_readonly("late_count", &StreamHandle::late_count)
      .def_property_readonly("late", &StreamHandle::late,
                             "(step, file, line, cycles waited) of the newest late steps.")
      .def("take_corners", &StreamHandle::take_corners, "Corners decided since the last call.")
      .def("take_warnings", &StreamHandle::take_warnings, "Warnings met since the last call.");
}

}  // namespace viapoint::python
