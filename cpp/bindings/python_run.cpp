#include "python_run.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace viapoint::python {
namespace {

const char* action_of(Wish wish) {
  return wish == Wish::kPause ? "pause" : wish == Wish::kStop ? "stop" : "resume";
}

}  // namespace

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

void PythonRun::on_input(const InputReaction& reaction) {
  tell("on_input", static_cast<int>(reaction.input), reaction.value, action_of(reaction.wish));
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

std::vector<LogRecord> PythonRun::log() const {
  return in_python([&] { return run_->attr("log")().cast<LogHandle>().records; });
}

std::vector<LogRecord> PythonRun::log(std::uint64_t from, std::size_t count) const {
  const std::vector<LogRecord> whole = log();
  const auto first = std::ranges::lower_bound(whole, from, {}, &LogRecord::cycle);
  const auto left = static_cast<std::size_t>(whole.end() - first);
  return {first, first + static_cast<std::ptrdiff_t>(std::min(count, left))};
}

RunReport PythonRun::report() const {
  return in_python([&] {
    const py::object told = run_->attr("report")();
    const auto number = [&](const char* name) { return told.attr(name).cast<double>(); };
    const auto count = [&](const char* name) { return told.attr(name).cast<std::uint64_t>(); };
    RunReport report;
    report.cycles = count("cycles");
    report.overruns = count("overruns");
    report.latency_p50 = number("latency_p50");
    report.latency_p99 = number("latency_p99");
    report.latency_max = number("latency_max");
    report.compute_p50 = number("compute_p50");
    report.compute_p99 = number("compute_p99");
    report.compute_max = number("compute_max");
    report.wall_time = number("wall_time");
    report.missed_cycles = count("missed_cycles");
    report.lost_records = count("lost_records");
    report.rested_cycles = count("rested_cycles");
    return report;
  });
}

void PythonRun::lengthen(std::shared_ptr<const Trajectory> next, double leave) {
  in_python([&] { run_->attr("lengthen")(MotionHandle{nullptr, std::move(next), {}, {}}, leave); });
}

LinkFate PythonRun::fate() {
  const int fate = ask<int>("fate");
  return fate == 1 ? LinkFate::kTaken : fate == 2 ? LinkFate::kTooLate : LinkFate::kNotYet;
}

}  // namespace viapoint::python
