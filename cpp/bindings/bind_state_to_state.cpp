// State-to-state motion in the submodule `profile`: one call from arrays to a finished motion.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "state_request.hpp"
#include "state_soundness.hpp"
#include "viapoint/profile/polynomial.hpp"

namespace viapoint::python {
namespace {

constexpr double kMostSeconds = 1e30;

/// A finished motion, compact: only the joints there are.
struct StateMotion {
  std::vector<AxisMove> axes;
  double duration = 0.0;
  bool scalar = true;

  [[nodiscard]] AxisState at(const AxisMove& move, double t) const {
    return t > move.total ? move.after_end(t - move.total) : move.at(t);
  }
};

/// The phases of a joint as polynomials of time since each began, to the end of the whole motion.
/// @param visit called with the times of begin and end and the polynomial
template <typename Visit>
void for_each_part(const StateMotion& motion, const AxisMove& move, Visit visit) {
  const auto cubic = [](const AxisState& s, double t) {
    Polynomial part;
    part.t1 = t;
    part.c[0] = s.q;
    part.c[1] = s.qd;
    part.c[2] = s.qdd / 2.0;
    part.c[3] = s.qddd / 6.0;
    return part;
  };
  double begin = 0.0;
  for (int i = 0; i < move.phases; ++i) {
    const auto& [duration, from] = move.phase[static_cast<size_t>(i)];
    // The durations sum up to the total but for rounding.
    const double end = i + 1 < move.phases ? std::min(begin + duration, move.total) : move.total;
    visit(begin, end, cubic(from, duration));
    begin = end;
  }
  if (motion.duration > move.total) {
    visit(move.total, motion.duration, cubic(move.after_end(0.0), motion.duration - move.total));
  }
}

using Parts = std::vector<std::tuple<double, double, std::array<double, 4>>>;

Parts parts(const StateMotion& motion, int joint) {
  if (joint < 0 || joint >= static_cast<int>(motion.axes.size())) {
    throw MotionError(ErrorCode::kBadArgument, "there is no joint " + std::to_string(joint) +
                                                   "; there are 0 to " +
                                                   std::to_string(motion.axes.size() - 1) + ".");
  }
  Parts all;
  for_each_part(motion, motion.axes[static_cast<size_t>(joint)],
                [&](double begin, double end, const Polynomial& p) {
                  all.emplace_back(begin, end,
                                   std::array<double, 4>{p.c[0], p.c[1], p.c[2], p.c[3]});
                });
  return all;
}

/// Rows low, low_time, high, high_time; (4, n).
py::array_t<double> extremes(const StateMotion& motion, int derivative) {
  if (derivative < 0 || derivative > 3) {
    throw MotionError(ErrorCode::kBadArgument,
                      "derivative is " + std::to_string(derivative) + "; it must be 0 to 3.");
  }
  py::array_t<double> out({py::ssize_t{4}, static_cast<py::ssize_t>(motion.axes.size())});
  auto rows = out.mutable_unchecked<2>();
  for (size_t i = 0; i < motion.axes.size(); ++i) {
    const AxisState& end = motion.axes[i].end;
    const double rest = std::array{end.q, end.qd, end.qdd, 0.0}[static_cast<size_t>(derivative)];
    std::optional<Extremes> all;
    for_each_part(motion, motion.axes[i],
                  [&](double begin, double end_time, const Polynomial& part) {
                    Extremes found = part.extremes(derivative);
                    found.low_time = std::min(begin + found.low_time, end_time);
                    found.high_time = std::min(begin + found.high_time, end_time);
                    if (!all) all = found;
                    if (found.low < all->low)
                      std::tie(all->low, all->low_time) = {found.low, found.low_time};
                    if (found.high > all->high) {
                      std::tie(all->high, all->high_time) = {found.high, found.high_time};
                    }
                  });
    const Extremes e = all.value_or(Extremes{rest, 0.0, rest, 0.0});
    const auto column = static_cast<py::ssize_t>(i);
    rows(0, column) = e.low;
    rows(1, column) = e.low_time;
    rows(2, column) = e.high;
    rows(3, column) = e.high_time;
  }
  return out;
}

using Columns4 =
    std::tuple<py::array_t<double>, py::array_t<double>, py::array_t<double>, py::array_t<double>>;

/// q and its derivatives, each of the shape of `t` and then of the joints.
Columns4 sample(const StateMotion& motion, const Array& times) {
  if (times.ndim() > 1) {
    throw MotionError(ErrorCode::kBadArgument, "t has " + std::to_string(times.ndim()) +
                                                   " dimensions; it must be () or (k,).");
  }
  std::vector<py::ssize_t> shape(times.shape(), times.shape() + times.ndim());
  if (!motion.scalar) shape.push_back(static_cast<py::ssize_t>(motion.axes.size()));
  std::array<py::array_t<double>, 4> out;
  std::array<double*, 4> to{};
  for (size_t k = 0; k < 4; ++k) {
    out[k] = py::array_t<double>(shape);
    to[k] = out[k].mutable_data();
  }
  const double slack = 1e-12 * motion.duration;
  for (py::ssize_t row = 0; row < times.size(); ++row) {
    const double t = times.data()[row];
    if (!(t >= -slack && t <= motion.duration + slack)) {
      Problem problem;
      problem.code = ErrorCode::kBadArgument;
      problem.message = "t is " + std::to_string(t) + " s; the motion lasts from 0 to " +
                        std::to_string(motion.duration) + " s.";
      problem.value = t;
      problem.limit = t < 0.0 ? 0.0 : motion.duration;
      throw MotionError(problem);
    }
    const double inside = std::clamp(t, 0.0, motion.duration);
    for (const AxisMove& move : motion.axes) {
      const AxisState s = motion.at(move, inside);
      *to[0]++ = s.q;
      *to[1]++ = s.qd;
      *to[2]++ = s.qdd;
      *to[3]++ = s.qddd;
    }
  }
  return {out[0], out[1], out[2], out[3]};
}

py::array_t<double> durations(const StateMotion& motion) {
  py::array_t<double> out(static_cast<py::ssize_t>(motion.axes.size()));
  double* to = out.mutable_data();
  for (const AxisMove& move : motion.axes) *to++ = move.total;
  return out;
}

/// Brings all values to one number of joints. @throws MotionError(kBadArgument)
void set_joints(StateRequest& request, std::span<const JointValues> values) {
  const JointValues* given = nullptr;
  for (const JointValues& v : values) {
    if (v.size == 0) continue;
    if (given == nullptr) given = &v;
    if (v.size == given->size) continue;
    throw MotionError(ErrorCode::kBadArgument,
                      std::string(v.name) + " has " + std::to_string(v.size) + " values, " +
                          given->name + " has " + std::to_string(given->size) +
                          "; give each one value, or all the same number.");
  }
  request.scalar = given == nullptr;
  request.joints = given == nullptr ? 1 : static_cast<size_t>(given->size);
}

Synchronization synchronization_of(py::handle word, bool to_velocity) {
  if (word.is_none()) return to_velocity ? Synchronization::kNone : Synchronization::kTime;
  const std::string text = py::repr(word);
  if (text == "'time'") return Synchronization::kTime;
  if (text == "'line'") return Synchronization::kLine;
  if (text == "'none'") return Synchronization::kNone;
  throw MotionError(
      ErrorCode::kBadArgument,
      "sync is " + text.substr(0, 60) + "; it must be one of \"time\", \"line\", \"none\".");
}

/// A number of seconds above 0, or none given.
double seconds(py::handle object, const char* name) {
  if (object.is_none()) return 0.0;
  const JointValues given = joint_values(object, name);
  const double value = given[0];
  if (given.size == 0 && value > 0.0 && value <= kMostSeconds) return value;
  Problem problem;
  problem.code = ErrorCode::kBadArgument;
  problem.message = std::string(name) + " is " + std::string(py::str(object)).substr(0, 60) +
                    "; it must be one finite number of seconds above 0 and not beyond 1e30.";
  problem.value = value;
  problem.limit = 0.0;
  throw MotionError(problem);
}

StateMotion plan_positions(const StateRequest& request, const StateToStateOptions& options) {
  thread_local StateToState planner;  // large; its content does not outlive the call
  const MoveStatus status =
      planner.plan(request.starts(), request.ends(), request.all_limits(), options);
  if (status != MoveStatus::kSolved) refuse(request, status, planner.culprit());
  StateMotion motion;
  motion.axes.reserve(request.joints);
  for (size_t i = 0; i < request.joints; ++i) {
    motion.axes.push_back(planner.axis(static_cast<int>(i)));
  }
  motion.duration = planner.duration();
  return motion;
}

StateMotion plan_velocities(const StateRequest& request) {
  StateMotion motion;
  motion.axes.resize(request.joints);
  for (size_t i = 0; i < request.joints; ++i) {
    const MoveStatus status = quickest_velocity_change(request.start[i], request.end[i],
                                                       request.limits[i], motion.axes[i]);
    if (status != MoveStatus::kSolved) refuse(request, status, static_cast<int>(i));
    motion.duration = std::max(motion.duration, motion.axes[i].total);
  }
  return motion;
}

StateMotion state_to_state(const Given& q0, const Given& q1, const Given& v0, const Given& a0,
                           const Given& v1, const Given& a1, const Given& v_max, const Given& a_max,
                           const Given& j_max, const Given& v_min, const Given& a_min,
                           const Given& j_min, const Given& p_min, const Given& p_max,
                           const Given& sync, const Given& least_duration, const Given& cycle) {
  // In the order of StateRequest's fields; a minimum not given is minus the maximum.
  const std::array<JointValues, 14> given{
      joint_values(q0, "q0"),
      q1.is_none() ? JointValues{} : joint_values(q1, "q1"),
      joint_values(v0, "v0"),
      joint_values(a0, "a0"),
      joint_values(v1, "v1"),
      joint_values(a1, "a1"),
      joint_values(v_max, "v_max"),
      joint_values(a_max, "a_max"),
      joint_values(j_max, "j_max"),
      v_min.is_none() ? JointValues{} : joint_values(v_min, "v_min"),
      a_min.is_none() ? JointValues{} : joint_values(a_min, "a_min"),
      j_min.is_none() ? JointValues{} : joint_values(j_min, "j_min"),
      p_min.is_none() ? JointValues{} : joint_values(p_min, "p_min"),
      p_max.is_none() ? JointValues{} : joint_values(p_max, "p_max"),
  };
  StateRequest request;
  request.to_velocity = q1.is_none();
  set_joints(request, given);
  const auto minimum = [](py::handle object, const JointValues& low, const JointValues& high,
                          size_t i) { return object.is_none() ? -high[i] : low[i]; };
  for (size_t i = 0; i < request.joints; ++i) {
    request.start[i] = {given[0][i], given[2][i], given[3][i], 0.0};
    request.end[i] = {request.to_velocity ? given[0][i] : given[1][i], given[4][i], given[5][i],
                      0.0};
    AxisLimits& l = request.limits[i];
    l.velocity_max = given[6][i];
    l.acceleration_max = given[7][i];
    l.jerk_max = given[8][i];
    l.velocity_min = minimum(v_min, given[9], given[6], i);
    l.acceleration_min = minimum(a_min, given[10], given[7], i);
    l.jerk_min = minimum(j_min, given[11], given[8], i);
    if (!p_min.is_none()) l.position_min = given[12][i];
    if (!p_max.is_none()) l.position_max = given[13][i];
  }

  require_range(request);

  StateToStateOptions options;
  options.synchronization = synchronization_of(sync, request.to_velocity);
  options.least_duration = seconds(least_duration, "least_duration");
  options.cycle = seconds(cycle, "cycle");
  if (request.to_velocity) {
    if (options.synchronization != Synchronization::kNone || !least_duration.is_none() ||
        !cycle.is_none() || !p_min.is_none() || !p_max.is_none()) {
      throw MotionError(ErrorCode::kBadArgument,
                        "a motion to a velocity (q1 is None) takes each joint as long and as far "
                        "as it needs; sync "
                        "must be \"none\", and least_duration, cycle, p_min and p_max None.",
                        {"Leave them out.", "Give the position q1."});
    }
  }
  StateMotion motion =
      request.to_velocity ? plan_velocities(request) : plan_positions(request, options);
  motion.scalar = request.scalar;
  for (size_t i = 0; i < request.joints; ++i) {
    if (!is_sound(motion.axes[i], request.start[i], request.limits[i])) {
      refuse_digits(request, i);
    }
  }
  return motion;
}

}  // namespace

void bind_state_to_state(py::module_& profile) {
  py::class_<StateMotion>(profile, "StateMotion", "A motion from state to state.")
      .def_property_readonly(
          "joints", [](const StateMotion& m) { return m.axes.size(); }, "Number of joints.")
      .def_readonly("scalar", &StateMotion::scalar, "True for one joint given by numbers.")
      .def_readonly("duration", &StateMotion::duration, "[s]")
      .def_property_readonly("durations", &durations, "Of each joint [s], (n,).")
      .def("at", &sample, py::arg("t"),
           "q, qd, qdd, qddd at t, () or (k,); times outside are refused.")
      .def("extremes", &extremes, py::arg("derivative"),
           "Smallest value, its time, largest value, its time; (4, n).")
      .def("parts", &parts, py::arg("joint"),
           "(begin, end, coefficients of (t - begin)^k) of each phase of a joint.");
  profile.def("state_to_state", &state_to_state, py::arg("q0"), py::arg("q1"), py::arg("v0"),
              py::arg("a0"), py::arg("v1"), py::arg("a1"), py::arg("v_max"), py::arg("a_max"),
              py::arg("j_max"), py::arg("v_min"), py::arg("a_min"), py::arg("j_min"),
              py::arg("p_min"), py::arg("p_max"), py::arg("sync"), py::arg("least_duration"),
              py::arg("cycle"),
              "The quickest motion from state to state, or with q1 None to a velocity.");
}

}  // namespace viapoint::python
