// Robots: descriptions, limits and forward kinematics.
#include "bindings.hpp"
#include "viapoint/kinematics/robot_description.hpp"

namespace viapoint::python {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

JointLimits limits_from(const Vector& position_min, const Vector& position_max,
                        const Vector& velocity, const Vector& acceleration, const Vector& jerk,
                        const Matrix& coupling, const Vector& lower, const Vector& upper) {
  for (const Vector* v : {&position_min, &position_max, &velocity, &acceleration, &jerk}) {
    if (v->size() < 1 || v->size() > kMaxJoints) {
      throw MotionError(ErrorCode::kBadLimits, "A robot has 1 to " + std::to_string(kMaxJoints) +
                                                   " joints; the limits given have " +
                                                   std::to_string(v->size()) + " values.");
    }
  }
  if (coupling.rows() > kMaxCouplings || coupling.cols() > kMaxJoints ||
      lower.size() > kMaxCouplings || upper.size() > kMaxCouplings) {
    throw MotionError(ErrorCode::kBadLimits,
                      "The coupling matrix has " + std::to_string(coupling.rows()) +
                          " rows; allowed are at most " + std::to_string(kMaxCouplings) + ".");
  }
  JointLimits limits{position_min, position_max, velocity, acceleration,
                     jerk,         coupling,     lower,    upper};
  limits.validate();
  return limits;
}

/// One flat batch of joint vectors, (k, n), checked.
const double* batch_of(const Array& q, int joints, const char* name) {
  if (q.ndim() != 2 || q.shape(1) != joints) {
    throw MotionError(ErrorCode::kBadArgument, std::string(name) + " must have the shape (k, " +
                                                   std::to_string(joints) + ").");
  }
  return q.data();
}

JointVector row(const double* data, py::ssize_t k, int joints) {
  return Eigen::Map<const Vector>(data + k * joints, joints);
}

Array fk_batch(const RobotHandle& self, const Array& q) {
  const int n = self.robot->joints();
  const double* in = batch_of(q, n, "q");
  const py::ssize_t count = q.shape(0);
  Array poses(std::vector<py::ssize_t>{count, 4, 4});
  double* out = poses.mutable_data();
  {
    const py::gil_scoped_release release;
    const ForwardKinematics& forward = self.robot->forward();
    for (py::ssize_t k = 0; k < count; ++k) {
      Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(out + 16 * k) =
          forward.pose(row(in, k, n)).matrix();
    }
  }
  return poses;
}

/// Twist J q̇ and its rate J̇ q̇ + J q̈, (k, 6) each.
std::pair<Array, Array> tool_rates(const RobotHandle& self, const Array& q, const Array& qd,
                                   const Array& qdd) {
  const int n = self.robot->joints();
  const double* in_q = batch_of(q, n, "q");
  const double* in_qd = batch_of(qd, n, "qd");
  const double* in_qdd = batch_of(qdd, n, "qdd");
  const py::ssize_t count = q.shape(0);
  if (qd.shape(0) != count || qdd.shape(0) != count) {
    throw MotionError(ErrorCode::kBadArgument, "q, qd and qdd must have as many rows.");
  }
  Array twist(std::vector<py::ssize_t>{count, 6});
  Array rate(std::vector<py::ssize_t>{count, 6});
  double* out_twist = twist.mutable_data();
  double* out_rate = rate.mutable_data();
  {
    const py::gil_scoped_release release;
    const ForwardKinematics& forward = self.robot->forward();
    for (py::ssize_t k = 0; k < count; ++k) {
      const JointVector velocity = row(in_qd, k, n);
      const ChainFrames frames = forward.frames(row(in_q, k, n));
      const Jacobian jacobian = forward.jacobian(frames);
      Eigen::Map<Twist>(out_twist + 6 * k) = jacobian * velocity;
      Eigen::Map<Twist>(out_rate + 6 * k) =
          forward.jacobian_rate(frames, velocity) * velocity + jacobian * row(in_qdd, k, n);
    }
  }
  return {std::move(twist), std::move(rate)};
}

void bind_limits(py::module_& m) {
  py::class_<JointLimits>(m, "JointLimits", R"(What each joint may do [SI, rad].

position_min <= q <= position_max, |qd| <= velocity, |qdd| <= acceleration, |qddd| <= jerk,
coupling_lower <= coupling @ q <= coupling_upper. Arrays are copies: a robot's limits never change
(see Robot.with_limits).)")
      .def(py::init(&limits_from), py::kw_only(), py::arg("position_min"), py::arg("position_max"),
           py::arg("velocity"), py::arg("acceleration"), py::arg("jerk"), py::arg("coupling"),
           py::arg("coupling_lower"), py::arg("coupling_upper"))
      .def_property_readonly(
          "position_min", [](const JointLimits& l) { return Vector(l.position_min); }, "(n,)")
      .def_property_readonly(
          "position_max", [](const JointLimits& l) { return Vector(l.position_max); }, "(n,)")
      .def_property_readonly(
          "velocity", [](const JointLimits& l) { return Vector(l.velocity); }, "(n,)")
      .def_property_readonly(
          "acceleration", [](const JointLimits& l) { return Vector(l.acceleration); }, "(n,)")
      .def_property_readonly(
          "jerk", [](const JointLimits& l) { return Vector(l.jerk); }, "(n,)")
      .def_property_readonly(
          "coupling", [](const JointLimits& l) { return Matrix(l.coupling); }, "(m, n)")
      .def_property_readonly(
          "coupling_lower", [](const JointLimits& l) { return Vector(l.coupling_lower); }, "(m,)")
      .def_property_readonly(
          "coupling_upper", [](const JointLimits& l) { return Vector(l.coupling_upper); }, "(m,)")
      .def(
          "contains",
          [](const JointLimits& l, const Vector& q, double slack) {
            return l.contains(joints_from(q, "q", l.joints()), slack);
          },
          py::arg("q"), py::arg("slack") = 0.0,
          "True when every position and coupled limit holds at q (n,), within slack [rad or m].");
  py::class_<Singularity>(m, "Singularity", "How near the arm is to losing a direction.")
      .def_readonly("name", &Singularity::name,
                    "\"none\", \"shoulder\", \"elbow\", \"wrist\" or \"boundary\".")
      .def_readonly("distance", &Singularity::distance, "To the nearest singularity [rad or m].")
      .def_readonly("manipulability", &Singularity::manipulability, "sqrt(det(J J^T)).")
      .def("__repr__", [](const Singularity& s) {
        return "<Singularity " + s.name + ", distance " + std::to_string(s.distance) +
               ", manipulability " + std::to_string(s.manipulability) + ">";
      });
}

}  // namespace

Array rows_of(const std::vector<JointVector>& vectors) {
  const auto joints = vectors.empty() ? py::ssize_t{0} : py::ssize_t{vectors.front().size()};
  Array rows({static_cast<py::ssize_t>(vectors.size()), joints});
  double* out = rows.mutable_data();
  for (const JointVector& values : vectors) {
    for (const double value : values) *out++ = value;
  }
  return rows;
}

void require_kinematics(const RobotModel& robot) {
  if (robot.has_kinematics()) return;
  throw MotionError(
      ErrorCode::kUncontrolled,
      "The robot \"" + robot.name() + "\" has joints but no kinematics, so it has no tool pose.",
      {"Load a robot with a description: load_robot(\"puma560\") or a .yaml file."});
}

void bind_robot(py::module_& m) {
  bind_limits(m);
  py::class_<RobotHandle> robot(m, "RobotModel", "An arm: chain, limits and kinematics.");
  robot.def_property_readonly("name", [](const RobotHandle& r) { return r.robot->name(); })
      .def_property_readonly("title",
                             [](const RobotHandle& r) { return r.robot->description().title; })
      .def_property_readonly("joints", [](const RobotHandle& r) { return r.robot->joints(); })
      .def_property_readonly(
          "joint_names", [](const RobotHandle& r) { return r.robot->description().joint_names; })
      .def_property_readonly(
          "prismatic",
          [](const RobotHandle& r) {
            std::vector<bool> flags;
            for (int i = 0; i < r.robot->joints(); ++i) {
              flags.push_back(r.robot->has_kinematics() &&
                              r.robot->forward().type(i) == JointType::kPrismatic);
            }
            return flags;
          })
      .def_property_readonly("sources",
                             [](const RobotHandle& r) { return r.robot->description().sources; })
      .def_property_readonly("chosen",
                             [](const RobotHandle& r) { return r.robot->description().chosen; })
      .def_property_readonly("limits", [](const RobotHandle& r) { return r.robot->limits(); })
      .def_property_readonly("has_kinematics",
                             [](const RobotHandle& r) { return r.robot->has_kinematics(); })
      .def_property_readonly("fingerprint",
                             [](const RobotHandle& r) { return r.robot->fingerprint(); })
      .def(
          "to_yaml", [](const RobotHandle& r) { return to_yaml(r.robot->description()); },
          "The description as a .yaml file that reads back to the same numbers.")
      .def(
          "with_limits",
          [](const RobotHandle& r, const JointLimits& limits) {
            return RobotHandle{r.robot->with_limits(limits)};
          },
          py::arg("limits"))
      .def(
          "with_tool",
          [](const RobotHandle& r, const Eigen::Matrix4d& pose) {
            return RobotHandle{r.robot->with_tool(pose_from(pose))};
          },
          py::arg("pose"))
      .def(
          "with_base",
          [](const RobotHandle& r, const Eigen::Matrix4d& pose) {
            return RobotHandle{r.robot->with_base(pose_from(pose))};
          },
          py::arg("pose"))
      .def_property_readonly("base",
                             [](const RobotHandle& r) {
                               return Eigen::Matrix4d(r.robot->description().base.matrix());
                             })
      .def_property_readonly("tool",
                             [](const RobotHandle& r) {
                               return Eigen::Matrix4d(r.robot->description().tool.matrix());
                             })
      .def(
          "fk",
          [](const RobotHandle& r, const Vector& q) {
            require_kinematics(*r.robot);
            return Eigen::Matrix4d(r.robot->fk(joints_from(q, "q", r.robot->joints())).matrix());
          },
          py::arg("q"))
      .def(
          "fk_batch",
          [](const RobotHandle& r, const Array& q) {
            require_kinematics(*r.robot);
            return fk_batch(r, q);
          },
          py::arg("q"))
      .def(
          "tool_rates",
          [](const RobotHandle& r, const Array& q, const Array& qd, const Array& qdd) {
            require_kinematics(*r.robot);
            return tool_rates(r, q, qd, qdd);
          },
          py::arg("q"), py::arg("qd"), py::arg("qdd"))
      .def(
          "jacobian",
          [](const RobotHandle& r, const Vector& q) {
            require_kinematics(*r.robot);
            return Matrix(r.robot->jacobian(joints_from(q, "q", r.robot->joints())));
          },
          py::arg("q"))
      .def(
          "manipulability",
          [](const RobotHandle& r, const Vector& q) {
            require_kinematics(*r.robot);
            return r.robot->manipulability(joints_from(q, "q", r.robot->joints()));
          },
          py::arg("q"))
      .def(
          "singularity",
          [](const RobotHandle& r, const Vector& q) {
            require_kinematics(*r.robot);
            return r.robot->singularity(joints_from(q, "q", r.robot->joints()));
          },
          py::arg("q"));
  bind_kinematics(m, robot);
  m.def(
      "load_robot",
      [](const std::string& name_or_path, const std::string& tip) {
        return RobotHandle{RobotModel::make(load_description(name_or_path, tip))};
      },
      py::arg("name_or_path"), py::arg("tip") = "",
      "A built-in robot by name, or a .yaml or .urdf file; tip: the link of a URDF that carries "
      "the "
      "tool.");
  m.def(
      "robot_from_yaml",
      [](const std::string& text, const std::string& source) {
        return RobotHandle{RobotModel::make(description_from_yaml(text, source))};
      },
      py::arg("text"), py::arg("source"), "The robot that to_yaml wrote; source: for errors.");
  m.def(
      "joint_robot",
      [](const JointLimits& limits) { return RobotHandle{RobotModel::joint_robot(limits)}; },
      py::arg("limits"), "Joints with limits and no kinematics.");
  m.def("builtin_robots", &builtin_robots, "Names of the built-in robots, sorted.");
}

}  // namespace viapoint::python
