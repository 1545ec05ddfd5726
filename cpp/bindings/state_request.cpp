#include "state_request.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace viapoint::python {
namespace {

/// Beyond these, squares and cubes of what is given leave the range of doubles.
constexpr double kMost = 1e30, kLeastLimit = 1e-30;
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

std::string written(double value) {
  std::ostringstream text;
  text.precision(7);
  text << value;
  return text.str();
}

[[noreturn]] void refuse_values(const char* name, const std::string& what) {
  throw MotionError(ErrorCode::kBadArgument, std::string(name) + what);
}

/// Another type than an array of doubles: a list, integers, single precision, or no numbers at all.
py::array converted(py::handle object, const char* name) {
  py::array any = py::array::ensure(object);
  if (!any) {
    PyErr_Clear();
    refuse_values(name, " is no array of numbers; it must be a number, or one a joint.");
  }
  if (std::string_view("iuf").find(any.dtype().kind()) == std::string_view::npos) {
    refuse_values(name, " is " + std::string(py::str(py::repr(object))).substr(0, 60) +
                            "; it must hold numbers only.");
  }
  return py::array_t<double, py::array::c_style | py::array::forcecast>(any);
}

/// Reads a list of floats, which needs no array on its way. @return whether it was one
bool read_floats(py::handle object, JointValues& values) {
  if (!PyList_CheckExact(object.ptr())) return false;
  const Py_ssize_t size = PyList_GET_SIZE(object.ptr());
  if (size < 1 || size > kMaxJoints) return false;
  for (Py_ssize_t i = 0; i < size; ++i) {
    PyObject* item = PyList_GET_ITEM(object.ptr(), i);
    if (!PyFloat_CheckExact(item)) return false;
    values.value[static_cast<size_t>(i)] = PyFloat_AS_DOUBLE(item);
  }
  values.size = static_cast<int>(size);
  return true;
}

/// Raises a refusal of one joint's value.
[[noreturn]] void refuse_joint(const StateRequest& request, ErrorCode code, const std::string& name,
                               size_t joint, double value, const std::string& rule,
                               std::vector<std::string> ways_out, std::optional<double> limit) {
  Problem problem;
  problem.code = code;
  problem.message = name + (request.scalar ? "" : "[" + std::to_string(joint) + "]") + " is " +
                    written(value) + "; " + rule;
  problem.ways_out = std::move(ways_out);
  if (!request.scalar) problem.joint = static_cast<int>(joint);
  problem.value = value;
  problem.limit = limit;
  throw MotionError(problem);
}

void require_states(const StateRequest& r) {
  const auto check = [&](const char* name, size_t joint, double value) {
    if (std::abs(value) <= kMost) return;
    refuse_joint(r, ErrorCode::kBadArgument, name, joint, value,
                 "it must be finite, and not beyond " + written(kMost) + ".", {}, std::nullopt);
  };
  for (size_t i = 0; i < r.joints; ++i) {
    check("q0", i, r.start[i].q);
    check("v0", i, r.start[i].qd);
    check("a0", i, r.start[i].qdd);
    check("q1", i, r.end[i].q);
    check("v1", i, r.end[i].qd);
    check("a1", i, r.end[i].qdd);
  }
}

void require_limits(const StateRequest& r) {
  const auto above = [&](const char* name, size_t joint, double value) {
    if (value >= kLeastLimit && value <= kMost) return;
    refuse_joint(
        r, ErrorCode::kBadLimits, name, joint, value,
        "it must be above 0 and finite, " + written(kLeastLimit) + " to " + written(kMost) + ".",
        {"Give the largest value that the joint may have."}, 0.0);
  };
  const auto below = [&](const char* name, size_t joint, double value) {
    if (-value >= kLeastLimit && -value <= kMost) return;
    refuse_joint(
        r, ErrorCode::kBadLimits, name, joint, value,
        "it must be below 0 and finite, " + written(-kMost) + " to " + written(-kLeastLimit) + ".",
        {"Give it with its sign, or leave it out for minus the maximum."}, 0.0);
  };
  for (size_t i = 0; i < r.joints; ++i) {
    const AxisLimits& l = r.limits[i];
    above("v_max", i, l.velocity_max);
    above("a_max", i, l.acceleration_max);
    above("j_max", i, l.jerk_max);
    below("v_min", i, l.velocity_min);
    below("a_min", i, l.acceleration_min);
    below("j_min", i, l.jerk_min);
    const auto nowhere = [&](const char* name, double value, const char* rule) {
      refuse_joint(r, ErrorCode::kBadLimits, name, i, value, rule,
                   {"Give a position, or leave out what is not limited."}, std::nullopt);
    };
    if (!(l.position_min < kUnlimited))
      nowhere("p_min", l.position_min, "it must be a position, or -inf.");
    if (!(l.position_max > -kUnlimited))
      nowhere("p_max", l.position_max, "it must be a position, or inf.");
    if (!(l.position_min <= l.position_max)) {
      refuse_joint(r, ErrorCode::kBadLimits, "p_min", i, l.position_min,
                   "it must not be above p_max, which is " + written(l.position_max) + ".",
                   {"Give the smallest position first, or leave out what is not limited."},
                   l.position_max);
    }
  }
}

void require_end_within(const StateRequest& r, size_t i) {
  const AxisLimits& l = r.limits[i];
  const auto [q, v, a, j] = r.end[i];
  if (v > l.velocity_max || v < l.velocity_min) {
    refuse_joint(
        r, ErrorCode::kVelocityLimit, "v1", i, v,
        "v_min to v_max is " + written(l.velocity_min) + " to " + written(l.velocity_max) + ".",
        {"End more slowly, or raise the velocity limit."},
        v > 0.0 ? l.velocity_max : l.velocity_min);
  }
  if (a > l.acceleration_max || a < l.acceleration_min) {
    refuse_joint(r, ErrorCode::kAccelerationLimit, "a1", i, a,
                 "a_min to a_max is " + written(l.acceleration_min) + " to " +
                     written(l.acceleration_max) + ".",
                 {"End with less acceleration, or raise its limit."},
                 a > 0.0 ? l.acceleration_max : l.acceleration_min);
  }
  const double jerk = a > 0.0 ? l.jerk_max : l.jerk_min;
  const double before = v - 0.5 * a * a / jerk;
  if (before > l.velocity_max || before < l.velocity_min) {
    refuse_joint(r, ErrorCode::kVelocityLimit, "a1", i, a,
                 "whatever arrives with it at v1 = " + written(v) + " had the velocity " +
                     written(before) + " before, and v_min to v_max is " + written(l.velocity_min) +
                     " to " + written(l.velocity_max) + ".",
                 {"End with less acceleration, at another velocity, or raise j_max."},
                 before > 0.0 ? l.velocity_max : l.velocity_min);
  }
}

/// Position limits are in the way. @throws MotionError(kJointLimit) always
[[noreturn]] void refuse_position(const StateRequest& r, MoveStatus status, size_t i) {
  const AxisState &from = r.start[i], &to = r.end[i];
  const AxisLimits& l = r.limits[i];
  const std::string range =
      "p_min to p_max is " + written(l.position_min) + " to " + written(l.position_max) + ".";
  const double nearest = to.q > l.position_max ? l.position_max : l.position_min;
  if (status == MoveStatus::kEndPosition) {
    refuse_joint(r, ErrorCode::kJointLimit, "q1", i, to.q, range,
                 {"End within the limits, or widen them."}, nearest);
  }
  const std::string way = std::string(to_string(status)) + "; ";
  if (status == MoveStatus::kStartTooFast) {
    refuse_joint(r, ErrorCode::kJointLimit, "v0", i, from.qd,
                 way + "q0 is " + written(from.q) + ", and " + range,
                 {"Start more slowly or farther away, or raise the limits of a and j."},
                 from.qd > 0.0 ? l.position_max : l.position_min);
  }
  refuse_joint(r, ErrorCode::kJointLimit, "v1", i, to.qd,
               way + "q1 is " + written(to.q) + ", and " + range,
               {"End more slowly, or widen the limits of the position."},
               to.qd > 0.0 ? l.position_min : l.position_max);
}

/// The joint would have to wait, and cannot. @throws MotionError(kBadArgument) always
[[noreturn]] void refuse_duration(const StateRequest& r, size_t i) {
  const AxisState &from = r.start[i], &to = r.end[i];
  const AxisLimits& l = r.limits[i];
  const bool by_start = std::abs(from.qd) >= std::abs(to.qd);
  refuse_joint(
      r, ErrorCode::kBadArgument, by_start ? "v0" : "v1", i, by_start ? from.qd : to.qd,
      "the joint is too fast to wait anywhere between p_min and p_max, " + written(l.position_min) +
          " to " + written(l.position_max) + ", and no motion found from q0 = " + written(from.q) +
          ", v0 = " + written(from.qd) + " to q1 = " + written(to.q) + ", v1 = " + written(to.qd) +
          " lasts as long as the other joints, least_duration or cycle ask for.",
      {"Start or end more slowly, or widen the limits of the position.",
       "Use sync=\"none\", or leave out least_duration and cycle.",
       "Raise the limits of the slower joints, or lower those of this one."},
      std::nullopt);
}

[[noreturn]] void refuse_line(const StateRequest& r, size_t joint) {
  const AxisState &from = r.start[joint], &to = r.end[joint];
  Problem problem;
  problem.code = ErrorCode::kBadArgument;
  problem.message = "there is no straight line from the start state to the end state: joint " +
                    std::to_string(joint) + " goes " + written(to.q - from.q) +
                    " with v0 = " + written(from.qd) + ", a0 = " + written(from.qdd) +
                    ", v1 = " + written(to.qd) + ", a1 = " + written(to.qdd) +
                    "; on a line each of v0, a0, v1, a1 is a multiple of q1 - q0.";
  problem.ways_out = {"Start and end at rest, or moving along q1 - q0.",
                      "Use sync=\"time\", which leaves the straight line."};
  problem.joint = static_cast<int>(joint);
  throw MotionError(problem);
}

}  // namespace

JointValues joint_values(py::handle object, const char* name) {
  JointValues values;
  values.name = name;
  if (PyFloat_CheckExact(object.ptr())) {
    values.value[0] = PyFloat_AS_DOUBLE(object.ptr());
    return values;
  }
  if (read_floats(object, values)) return values;
  using Doubles = py::array_t<double, py::array::c_style>;
  const bool ready = Doubles::check_(object);
  const py::array array =
      ready ? py::reinterpret_borrow<py::array>(object) : converted(object, name);
  if (array.ndim() > 1) {
    refuse_values(name, " has " + std::to_string(array.ndim()) +
                            " dimensions; it must be () or (n,), one value a joint.");
  }
  if (array.ndim() == 1) {
    if (array.size() < 1 || array.size() > kMaxJoints) {
      refuse_values(name, " has " + std::to_string(array.size()) + " values; allowed are 1 to " +
                              std::to_string(kMaxJoints) + ".");
    }
    values.size = static_cast<int>(array.size());
  }
  const auto* data = static_cast<const double*>(array.data());
  for (py::ssize_t i = 0; i < array.size(); ++i) values.value[static_cast<size_t>(i)] = data[i];
  return values;
}

void require_range(const StateRequest& request) {
  require_states(request);
  require_limits(request);
}

void refuse(const StateRequest& request, MoveStatus status, int culprit) {
  if (status == MoveStatus::kNotParallel) {
    refuse_line(request, static_cast<size_t>(std::max(culprit, 0)));
  }
  if (status >= MoveStatus::kEndPosition && status <= MoveStatus::kNoRoom) {
    refuse_position(request, status, static_cast<size_t>(std::max(culprit, 0)));
  }
  if (status == MoveStatus::kDurationImpossible) {
    refuse_duration(request, static_cast<size_t>(std::max(culprit, 0)));
  }
  if (culprit >= 0) require_end_within(request, static_cast<size_t>(culprit));
  for (size_t i = 0; i < request.joints; ++i) require_end_within(request, i);
  throw MotionError(ErrorCode::kBadArgument, std::string(to_string(status)) + ".");
}

void refuse_digits(const StateRequest& request, size_t joint) {
  const AxisLimits& l = request.limits[joint];
  Problem problem;
  problem.code = ErrorCode::kBadArgument;
  problem.message =
      (request.scalar ? "" : "joint " + std::to_string(joint) + ": ") +
      std::string("the motion cannot be held in double precision: it goes from ") +
      written(request.start[joint].q) + " to " + written(request.end[joint].q) +
      " with v_max = " + written(l.velocity_max) + ", a_max = " + written(l.acceleration_max) +
      ", j_max = " + written(l.jerk_max) + ", v0 = " + written(request.start[joint].qd) +
      ", a0 = " + written(request.start[joint].qdd) + ", too many decades apart.";
  problem.ways_out = {"Count in units in which these numbers are less far apart."};
  if (!request.scalar) problem.joint = static_cast<int>(joint);
  throw MotionError(problem);
}

}  // namespace viapoint::python
