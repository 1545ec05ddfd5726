/// @file
/// A run that Python drives, as C++ sees it: that of a controller in another process.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>

#include "bindings.hpp"
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

/// Asks a Python object for everything, by the names of `RemoteOpenRun` in _remote_stream.py. It
/// takes the GIL for as long as each call lasts, so that callers may hold it or not. What Python
/// raises goes on up.
class PythonRun final : public Follower {
 public:
  /// @pre the GIL is held
  explicit PythonRun(py::object run) : run_(held(std::move(run))) {}

  [[nodiscard]] RunState state() const override;
  [[nodiscard]] double nominal_time() const override { return look<double>("nominal_time"); }
  [[nodiscard]] double duration() const override { return look<double>("duration"); }
  [[nodiscard]] int move() const override { return look<int>("move"); }
  void lengthen(std::shared_ptr<const Trajectory> next, double leave) override;
  [[nodiscard]] LinkFate fate() override;
  void close() override;
  [[nodiscard]] double earliest_leave() const override { return look<double>("earliest_leave"); }
  [[nodiscard]] std::uint64_t waited_cycles() const override {
    return look<std::uint64_t>("waited_cycles");
  }

 private:
  template <typename T>
  [[nodiscard]] T look(const char* attribute) const {
    return in_python([&] { return run_->attr(attribute).template cast<T>(); });
  }

  std::shared_ptr<py::object> run_;
};

}  // namespace viapoint::python
