// The planner, planned motions and their proof, and sampling into numpy at C++ speed.
#include <cmath>

#include "bindings.hpp"

namespace viapoint::python {
namespace {

using Vector = Eigen::VectorXd;

/// A step shorter than this share of dt is rounding, and merges with the last one.
constexpr double kStepRounding = 1e-9;

struct SampleArrays {
  Array t, q, qd, qdd, qddd;
  py::array_t<std::int32_t> move;

  SampleArrays(py::ssize_t count, py::ssize_t joints)
      : t(count),
        q({count, joints}),
        qd({count, joints}),
        qdd({count, joints}),
        qddd({count, joints}),
        move(count) {}

  [[nodiscard]] Columns dict() const {
    Columns out;
    out["t"] = t;
    out["q"] = q;
    out["qd"] = qd;
    out["qdd"] = qdd;
    out["qddd"] = qddd;
    out["move"] = move;
    return out;
  }
};

/// Writes the states at `times` (ascending, within the motion), walking the pieces once.
void fill(const Trajectory& trajectory, SampleArrays& arrays, double* times, py::ssize_t count) {
  const auto joints = static_cast<py::ssize_t>(trajectory.joints());
  double* q = arrays.q.mutable_data();
  double* qd = arrays.qd.mutable_data();
  double* qdd = arrays.qdd.mutable_data();
  double* qddd = arrays.qddd.mutable_data();
  std::int32_t* move = arrays.move.mutable_data();
  const py::gil_scoped_release release;
  const std::vector<TrajectoryPiece>& pieces = trajectory.pieces();
  size_t at = 0;
  for (py::ssize_t k = 0; k < count; ++k) {
    while (at + 1 < pieces.size() && times[k] >= trajectory.start_of(at + 1)) ++at;
    const double tau = std::min(times[k] - trajectory.start_of(at), pieces[at].duration);
    const JointState state = pieces[at].at(tau);
    const py::ssize_t begin = k * joints;
    Eigen::Map<Vector>(q + begin, joints) = state.q;
    Eigen::Map<Vector>(qd + begin, joints) = state.qd;
    Eigen::Map<Vector>(qdd + begin, joints) = state.qdd;
    Eigen::Map<Vector>(qddd + begin, joints) = state.qddd;
    move[k] = pieces[at].move;
  }
}

/// A program that only waits for no time plans to a motion without pieces.
void require_pieces(const MotionHandle& motion) {
  if (motion.trajectory->pieces().empty()) {
    throw MotionError(ErrorCode::kEmptyProgram, "The motion has no duration, so no states.",
                      {"Add a move or a wait to the program."});
  }
}

/// 0, dt, 2 dt, … and the exact end; the last step may be shorter.
Columns sample(const MotionHandle& motion, double dt) {
  require_pieces(motion);
  if (!(dt > 0.0) || !std::isfinite(dt)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "dt is " + std::to_string(dt) + " s; it must be positive and finite.");
  }
  const double duration = motion.trajectory->duration();
  const double steps = std::ceil(duration / dt - kStepRounding);
  constexpr double kMostSamples = 1e8;
  if (steps > kMostSamples) {
    throw MotionError(ErrorCode::kBadArgument,
                      "dt is " + std::to_string(dt) + " s, which asks for more than 1e8 samples.");
  }
  const auto count = static_cast<py::ssize_t>(steps) + 1;
  SampleArrays arrays(count, motion.trajectory->joints());
  double* t = arrays.t.mutable_data();
  for (py::ssize_t k = 0; k + 1 < count; ++k) t[k] = static_cast<double>(k) * dt;
  t[count - 1] = duration;
  fill(*motion.trajectory, arrays, t, count);
  return arrays.dict();
}

/// At the given instants [s], ascending; outside the motion the ends hold.
Columns sample_at(const MotionHandle& motion, const Vector& times) {
  require_pieces(motion);
  const auto count = static_cast<py::ssize_t>(times.size());
  SampleArrays arrays(count, motion.trajectory->joints());
  double* t = arrays.t.mutable_data();
  for (py::ssize_t k = 0; k < count; ++k) {
    if (!std::isfinite(times[k]) || (k > 0 && times[k] < times[k - 1])) {
      throw MotionError(ErrorCode::kBadArgument, "times must be finite and ascending; value " +
                                                     std::to_string(k) + " is " +
                                                     std::to_string(times[k]) + ".");
    }
    t[k] = std::min(std::max(times[k], 0.0), motion.trajectory->duration());
  }
  fill(*motion.trajectory, arrays, t, count);
  return arrays.dict();
}

/// Timing cuts a piece of path into several of the trajectory; they share its coefficients.
int path_pieces(const MotionHandle& motion) {
  int count = 0;
  const TrajectoryPiece* before = nullptr;
  for (const TrajectoryPiece& piece : motion.trajectory->pieces()) {
    if (before == nullptr || before->path != piece.path) ++count;
    before = &piece;
  }
  return count;
}

template <typename Member>
Vector column(const std::vector<Extremum>& extrema, Member member) {
  Vector out(static_cast<Eigen::Index>(extrema.size()));
  for (size_t i = 0; i < extrema.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = extrema[i].*member;
  return out;
}

std::string zone_name(ZoneKind kind) {
  switch (kind) {
    case ZoneKind::kFine:
      return "fine";
    case ZoneKind::kRadius:
      return "radius";
    case ZoneKind::kDeviation:
      return "deviation";
    case ZoneKind::kJointDeviation:
      return "joint_deviation";
  }
  return "fine";
}

void bind_certificate(py::module_& m) {
  py::class_<Extremum>(m, "Extremum", "The worst of one quantity of one joint.")
      .def_readonly("value", &Extremum::value, "Largest magnitude [SI, rad].")
      .def_readonly("share", &Extremum::share, "Value over its limit.")
      .def_readonly("time", &Extremum::time, "Where [s].")
      .def_readonly("move", &Extremum::move, "Program step it happens in.")
      .def("__repr__", [](const Extremum& e) {
        return "<Extremum " + std::to_string(e.value) + ", share " + std::to_string(e.share) +
               ", t " + std::to_string(e.time) + " s, move " + std::to_string(e.move) + ">";
      });
  py::class_<ToolExtrema>(m, "ToolExtrema",
                          "The worst of the tool, against the limits that each move gives it; zero "
                          "where no move limits it.")
      .def_readonly("speed", &ToolExtrema::speed, "Of the tool point [m/s].")
      .def_readonly("acceleration", &ToolExtrema::acceleration, "Of the tool point [m/s²].")
      .def_readonly("angular_speed", &ToolExtrema::angular_speed, "[rad/s]")
      .def_readonly("angular_acceleration", &ToolExtrema::angular_acceleration, "[rad/s²]");
  py::class_<Certificate>(m, "Certificate", "Proven bounds over a whole motion.")
      .def_readonly("velocity", &Certificate::velocity, "One Extremum a joint.")
      .def_readonly("acceleration", &Certificate::acceleration, "One Extremum a joint.")
      .def_readonly("jerk", &Certificate::jerk, "One Extremum a joint.")
      .def_property_readonly(
          "velocity_share",
          [](const Certificate& c) { return column(c.velocity, &Extremum::share); },
          "(n,) worst share of the velocity limit")
      .def_property_readonly(
          "acceleration_share",
          [](const Certificate& c) { return column(c.acceleration, &Extremum::share); },
          "(n,) worst share of the acceleration limit")
      .def_property_readonly(
          "jerk_share", [](const Certificate& c) { return column(c.jerk, &Extremum::share); },
          "(n,) worst share of the jerk limit")
      .def_readonly("tool", &Certificate::tool,
                    "Speeds and accelerations of the tool, where moves limit them.")
      .def_property_readonly(
          "position_min", [](const Certificate& c) { return Vector(c.position_min); },
          "(n,) least joint position reached [rad or m]")
      .def_property_readonly(
          "position_max", [](const Certificate& c) { return Vector(c.position_max); },
          "(n,) largest joint position reached [rad or m]")
      .def_readonly("start_speed", &Certificate::start_speed, "Largest |qd| at the start.")
      .def_readonly("end_speed", &Certificate::end_speed, "Largest |qd| at the end.")
      .def_readonly("start_acceleration", &Certificate::start_acceleration)
      .def_readonly("end_acceleration", &Certificate::end_acceleration)
      .def_readonly("position_jump", &Certificate::position_jump, "Largest step between pieces.")
      .def_readonly("velocity_jump", &Certificate::velocity_jump)
      .def_readonly("acceleration_jump", &Certificate::acceleration_jump)
      .def_readonly("path_deviation", &Certificate::path_deviation, "Proven, outside zones [m].")
      .def_readonly("angle_deviation", &Certificate::angle_deviation,
                    "Proven, outside zones [rad].")
      .def_readonly("zone_deviation", &Certificate::zone_deviation,
                    "Largest cut of a corner at the tool [m].")
      .def_readonly("manipulability", &Certificate::manipulability,
                    "Smallest found along the motion.")
      .def_readonly("problems", &Certificate::problems, "Everything that is broken, worst first.")
      .def_property_readonly("holds", &Certificate::holds, "True when the motion may run.");
  py::class_<CornerOutcome>(m, "Corner", "What became of the zone of one move.")
      .def_readonly("move", &CornerOutcome::move, "Index of the move, from 0.")
      .def_property_readonly(
          "kind", [](const CornerOutcome& c) { return zone_name(c.asked.kind); },
          "\"fine\", \"radius\", \"deviation\" or \"joint_deviation\".")
      .def_property_readonly(
          "asked", [](const CornerOutcome& c) { return c.asked.size; }, "Size asked for.")
      .def_readonly("stopped", &CornerOutcome::stopped, "The arm stops at the point.")
      .def_readonly("used", &CornerOutcome::used, "Size really used, in the zone's own unit.")
      .def_property_readonly(
          "asked_angle",
          [](const CornerOutcome& c) {
            return c.asked.bounds_angle() ? std::optional(c.asked.angle) : std::nullopt;
          },
          "Angle asked for [rad]; None for a zone without.")
      .def_readonly("used_angle", &CornerOutcome::used_angle,
                    "Angle really used, proven [rad]; 0 for a zone without.")
      .def_readonly("angle_rules", &CornerOutcome::angle_rules,
                    "The angle was used up before the size.")
      .def_readonly("merged_into", &CornerOutcome::merged_into,
                    "Index of the move whose straight leg the point lies so near, by `used`, that "
                    "it makes no corner; or None.")
      .def_readonly("cut", &CornerOutcome::cut, "Proven largest distance from the legs [m].")
      .def_readonly("reason", &CornerOutcome::reason, "Why shrunk or stopped.")
      .def("__repr__", [](const CornerOutcome& c) {
        return "<Corner move " + std::to_string(c.move) + ", " + zone_name(c.asked.kind) +
               (c.stopped ? ", stops" : ", used " + std::to_string(c.used)) + ">";
      });
  py::class_<ProcessStretch>(
      m, "ProcessStretch", "A stretch of motion in which a move could not hold its process speed.")
      .def_readonly("move", &ProcessStretch::move, "Index of the move, from 0.")
      .def_readonly("start", &ProcessStretch::from, "Where it begins [s].")
      .def_readonly("end", &ProcessStretch::to, "Where it ends [s].")
      .def_readonly("start_length", &ProcessStretch::from_length,
                    "Way of the tool since the process began, where it begins [m].")
      .def_readonly("end_length", &ProcessStretch::to_length, "The same where it ends [m].")
      .def_readonly("process_speed", &ProcessStretch::process_speed, "Asked for [m/s].")
      .def_readonly("lowest_speed", &ProcessStretch::lowest_speed, "[m/s]")
      .def_readonly("limit", &ProcessStretch::limit,
                    "What rules there: \"rest\" where the arm starts or stops, else the limit; "
                    "\"timing\" where none asks for less.")
      .def_readonly("joint", &ProcessStretch::joint, "Whose limit that is, from 0; or None.")
      .def("__repr__", [](const ProcessStretch& s) {
        return "<ProcessStretch move " + std::to_string(s.move) + ", " + std::to_string(s.from) +
               " to " + std::to_string(s.to) + " s, lowest " + std::to_string(s.lowest_speed) +
               " m/s, " + s.limit + ">";
      });
}

}  // namespace

void bind_planning(py::module_& m) {
  bind_certificate(m);
  py::class_<MotionHandle>(m, "PlannedMotion", "A finished motion and its proof.")
      .def_property_readonly("duration",
                             [](const MotionHandle& p) { return p.trajectory->duration(); })
      .def_property_readonly("joints", [](const MotionHandle& p) { return p.trajectory->joints(); })
      .def_property_readonly("pieces",
                             [](const MotionHandle& p) { return p.trajectory->pieces().size(); })
      .def_property_readonly("path_pieces", &path_pieces)
      .def_property_readonly("certificate",
                             [](const MotionHandle& p) { return p.trajectory->certificate(); })
      .def_readonly("corners", &MotionHandle::corners)
      .def_readonly("problems", &MotionHandle::problems)
      .def_readonly("process_stretches", &MotionHandle::process_stretches)
      .def("sample", &sample, py::arg("dt"))
      .def("sample_at", &sample_at, py::arg("times"));
  m.def(
      "check",
      [](const RobotHandle& robot, const MotionProgram& program) {
        return MotionPlanner(robot.robot).check(program).problems;
      },
      py::arg("robot"), py::arg("program"), py::call_guard<py::gil_scoped_release>(),
      "Every problem of a program, in program order.");
  m.def(
      "plan",
      [](const RobotHandle& robot, const MotionProgram& program) {
        PlannedMotion planned = MotionPlanner(robot.robot).plan(program);
        return MotionHandle{robot.robot,
                            std::make_shared<const Trajectory>(std::move(planned.trajectory)),
                            std::move(planned.corners), std::move(planned.report.problems),
                            std::move(planned.process_stretches)};
      },
      py::arg("robot"), py::arg("program"), py::call_guard<py::gil_scoped_release>(),
      "Plans; raises the first error of the report.");
  const LineTolerance defaults;
  m.attr("MOST_OUTPUT_TIME") = kMostOutputTime;
  m.attr("POSITION_TOLERANCE") = defaults.position;
  m.attr("ANGLE_TOLERANCE") = defaults.angle;
}

}  // namespace viapoint::python
