/// @file
/// A run that Python drives, as C++ sees it: that of a controller in another process.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "run_handles.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint::python {

/// Keeps a Python object whose last owner may let go of it without the GIL. @pre the GIL is held
[[nodiscard]] std::shared_ptr<py::object> held(py::object object);

/// What Python raised, to be thrown as often as need be: pybind11's own can be raised but once.
class PythonError final : public std::runtime_error {
 public:
  /// @pre the GIL is held
  explicit PythonError(const py::error_already_set& error);
  /// Raises it in Python again. @pre the GIL is held
  void raise() const;

 private:
  std::shared_ptr<py::object> error_;
};

/// Calls into Python with the GIL held. @throws PythonError
template <typename Call>
auto in_python(const Call& call) {
  const py::gil_scoped_acquire gil;
  try {
    return call();
  } catch (const py::error_already_set& error) {
    throw PythonError(error);
  }
}

/// Asks a Python object for everything, by the names of `OpenExecution` in _stream.py. It takes the
/// GIL for as long as each call lasts, so that callers may hold it or not. What Python raises goes
/// on up.
class PythonRun final : public OpenJob {
 public:
  /// @pre the GIL is held
  explicit PythonRun(py::object run) : run_(held(std::move(run))) {}

  bool wait(double timeout) override { return ask<bool>("wait", timeout); }
  void pause() override { tell("pause"); }
  void resume() override { tell("resume"); }
  void step() override { tell("step"); }
  void backward() override { tell("backward"); }
  void stop(StopCategory category) override { tell("stop", static_cast<int>(category)); }
  void on_input(const InputReaction& reaction) override;
  [[nodiscard]] RunState state() const override;
  [[nodiscard]] double nominal_time() const override { return look<double>("nominal_time"); }
  [[nodiscard]] double duration() const override { return look<double>("duration"); }
  [[nodiscard]] std::uint64_t overruns() const override { return look<std::uint64_t>("overruns"); }
  [[nodiscard]] int move() const override { return look<int>("move"); }
  /// Of a run in another process that is not told.
  [[nodiscard]] std::optional<InputWait> awaited() const override { return std::nullopt; }
  [[nodiscard]] std::vector<LogRecord> log() const override;
  [[nodiscard]] std::vector<LogRecord> log(std::uint64_t from, std::size_t count) const override;
  [[nodiscard]] RunReport report() const override;
  void lengthen(std::shared_ptr<const Trajectory> next, double leave) override;
  [[nodiscard]] LinkFate fate() override;
  void close() override { tell("close"); }
  [[nodiscard]] double earliest_leave() const override { return look<double>("earliest_leave"); }
  [[nodiscard]] std::uint64_t waited_cycles() const override {
    return look<std::uint64_t>("waited_cycles");
  }

 private:
  template <typename... Args>
  void tell(const char* method, Args... args) const {
    in_python([&] { run_->attr(method)(args...); });
  }
  template <typename T, typename... Args>
  [[nodiscard]] T ask(const char* method, Args... args) const {
    return in_python([&] { return run_->attr(method)(args...).template cast<T>(); });
  }
  template <typename T>
  [[nodiscard]] T look(const char* attribute) const {
    return in_python([&] { return run_->attr(attribute).template cast<T>(); });
  }

  std::shared_ptr<py::object> run_;
};

}  // namespace viapoint::python
