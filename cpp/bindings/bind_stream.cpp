// Programs planned while they are told: one chunk of motion after the other.
#include <optional>
#include <string>

#include "bindings.hpp"
#include "viapoint/planning/stream_planner.hpp"

namespace viapoint::python {
namespace {

/// A motion that ends at rest, and when the one before it is left for it.
struct ChunkHandle {
  MotionHandle motion;
  double begin = 0.0;
  bool last = false;
};

class Stream {
 public:
  Stream(const RobotHandle& robot, const MotionProgram& program)
      : robot_(robot.robot), planner_(robot.robot, program) {}

  /// Takes the steps of `program` from `kept` on, and drops them there.
  void take(MotionProgram& program, size_t kept) {
    if (kept > program.steps.size()) {
      throw MotionError(ErrorCode::kBadArgument,
                        "kept is " + std::to_string(kept) + "; the program has " +
                            std::to_string(program.steps.size()) + " steps",
                        {"take what follows the steps that the stream began with"});
    }
    const auto first = program.steps.begin() + static_cast<std::ptrdiff_t>(kept);
    const std::vector<Step> steps(std::make_move_iterator(first),
                                  std::make_move_iterator(program.steps.end()));
    program.steps.erase(first, program.steps.end());
    for (const Step& step : steps) planner_.add(step);
  }
  void end() { planner_.end(); }
  std::optional<ChunkHandle> next(double not_before) {
    std::optional<MotionChunk> chunk = planner_.next(not_before);
    if (!chunk) return std::nullopt;
    ChunkHandle handle;
    handle.motion.robot = robot_;
    handle.motion.trajectory = std::make_shared<const Trajectory>(std::move(chunk->motion));
    handle.motion.corners = std::move(chunk->corners);
    handle.motion.process_stretches = std::move(chunk->process_stretches);
    handle.motion.problems = std::move(chunk->warnings);
    handle.begin = chunk->begin;
    handle.last = chunk->last;
    return handle;
  }
  [[nodiscard]] int stops() const { return planner_.stops(); }

 private:
  RobotPtr robot_;
  StreamPlanner planner_;
};

}  // namespace

void bind_stream(py::module_& m) {
  py::class_<ChunkHandle>(m, "Chunk", "A motion to rest, and when the one before is left for it.")
      .def_readonly("motion", &ChunkHandle::motion)
      .def_readonly("begin", &ChunkHandle::begin, "[s] of the chunk before")
      .def_readonly("last", &ChunkHandle::last);
  py::class_<Stream>(m, "Stream", "Plans a program while it is told.")
      .def(py::init<const RobotHandle&, const MotionProgram&>(), py::arg("robot"),
           py::arg("program"))
      .def("take", &Stream::take, py::arg("program"), py::arg("kept"),
           py::call_guard<py::gil_scoped_release>(),
           "Take the steps of a program from the number kept on, and drop them there.")
      .def("end", &Stream::end, "No step follows.")
      .def("next", &Stream::next, py::arg("not_before") = 0.0,
           py::call_guard<py::gil_scoped_release>(), "The next chunk, if it can be made already.")
      .def_property_readonly("stops", &Stream::stops,
                             "Rests where a longer view would have gone on.");
}

}  // namespace viapoint::python
