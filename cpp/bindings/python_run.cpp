#include "python_run.hpp"

#include <string>
#include <utility>

namespace viapoint::python {

std::shared_ptr<py::object> held(py::object object) {
  return {new py::object(std::move(object)), [](const py::object* spent) {
            const py::gil_scoped_acquire gil;
            delete spent;
          }};
}

PythonError::PythonError(const py::error_already_set& error)
    : std::runtime_error("an error of Python's"), error_(held(error.value())) {}

void PythonError::raise() const {
  PyErr_SetObject(py::type::handle_of(*error_).ptr(), error_->ptr());
}

RunState PythonRun::state() const {
  const auto name = look<std::string>("state");
  for (auto state = RunState::kIdle; state <= RunState::kWaiting;
       state = static_cast<RunState>(static_cast<int>(state) + 1)) {
    if (name == to_string(state)) return state;
  }
  throw MotionError(ErrorCode::kInternal, "a run's state is \"" + name + "\", which is none",
                    {"use a client of the controller's version"});
}

void PythonRun::lengthen(std::shared_ptr<const Trajectory> next, double leave) {
  in_python([&] { run_->attr("lengthen")(MotionHandle{nullptr, std::move(next), {}, {}}, leave); });
}

LinkFate PythonRun::fate() {
  const int fate = in_python([&] { return run_->attr("fate")().cast<int>(); });
  return fate == 1 ? LinkFate::kTaken : fate == 2 ? LinkFate::kTooLate : LinkFate::kNotYet;
}

void PythonRun::close() {
  in_python([&] { run_->attr("close")(); });
}

}  // namespace viapoint::python
