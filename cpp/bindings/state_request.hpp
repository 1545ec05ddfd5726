/// @file
/// What Python asks of state_to_state, read without detours, and why it was refused.
#pragma once

#include <array>
#include <span>

#include "bindings.hpp"
#include "viapoint/profile/state_to_state.hpp"

namespace viapoint::python {

/// An argument as it came: a number, an array, a list, or None where that is allowed.
class Given : public py::object {
 public:
  PYBIND11_OBJECT_DEFAULT(Given, py::object, anything)

 private:
  static bool anything(PyObject* /*object*/) { return true; }
};

/// Values of one keyword: one for all joints, or one a joint.
struct JointValues {
  const char* name = "";
  std::array<double, kMaxJoints> value{};
  int size = 0;  ///< 0 where one value stands for all joints

  [[nodiscard]] double operator[](size_t i) const { return value[size == 0 ? 0 : i]; }
};

/// @throws MotionError(kBadArgument) for no numbers, another shape than () or (n,), n > kMaxJoints
[[nodiscard]] JointValues joint_values(py::handle object, const char* name);

/// Start, end and limits of every joint, checked for shape only.
struct StateRequest {
  bool to_velocity = false;  ///< no position is aimed at
  bool scalar = true;        ///< one joint given by plain numbers
  size_t joints = 1;
  std::array<AxisState, kMaxJoints> start, end;
  std::array<AxisLimits, kMaxJoints> limits;

  [[nodiscard]] std::span<const AxisState> starts() const { return {start.data(), joints}; }
  [[nodiscard]] std::span<const AxisState> ends() const { return {end.data(), joints}; }
  [[nodiscard]] std::span<const AxisLimits> all_limits() const { return {limits.data(), joints}; }
};

/// Refuses what is not finite, limits without sense, and what no double can be reckoned with.
/// @throws MotionError(kBadArgument, kBadLimits)
void require_range(const StateRequest& request);

/// The request was refused with `status`, by joint `culprit` where that is not negative.
/// @throws MotionError always: what was wrong, with the keyword, value, range and ways out
[[noreturn]] void refuse(const StateRequest& request, MoveStatus status, int culprit);

/// Doubles cannot hold the motion of `joint`. @throws MotionError always
[[noreturn]] void refuse_digits(const StateRequest& request, size_t joint);

}  // namespace viapoint::python

/// What the type stubs say.
template <>
struct pybind11::detail::handle_type_name<viapoint::python::Given> {
  // pybind11's name for it. NOLINTNEXTLINE(readability-identifier-naming)
  static constexpr auto name = const_name("numpy.typing.ArrayLike | None");
};
