// Inverse kinematics, configurations, dexterity and reach.
#include <limits>

#include "bindings.hpp"
#include "viapoint/kinematics/dexterity.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/kinematics/pose_path.hpp"
#include "viapoint/kinematics/workspace.hpp"

namespace viapoint::python {
namespace {

using Vector = Eigen::VectorXd;

const InverseKinematics& inverse_of(const RobotHandle& self) {
  require_kinematics(*self.robot);
  return self.robot->inverse();
}

/// +1 or -1 by its word, 0 for None.
int side_from(const std::optional<std::string>& word, const char* name, const char* positive,
              const char* negative) {
  if (!word) return 0;
  if (*word == positive) return 1;
  if (*word == negative) return -1;
  throw MotionError(ErrorCode::kBadArgument, std::string(name) + " is \"" + *word +
                                                 "\"; it must be \"" + positive + "\", \"" +
                                                 negative + "\" or None.");
}

std::optional<std::string> word_of(int side, const char* positive, const char* negative) {
  if (side == 0) return std::nullopt;
  return side > 0 ? positive : negative;
}

void bind_configuration(py::module_& m) {
  py::class_<Configuration>(m, "Configuration", R"(On which side of its singularities an arm stands.

shoulder "front" or "back" (the wrist before or behind axis 1), elbow "up" or "down" (as seen with the
shoulder in front), wrist "noflip" or "flip" (the sign of the wrist's bend); turns, one int a joint: k
with q in (-pi, pi] + 2 pi k. None is at the singularity, or an arm without that choice; in a wish it
stands for any.)")
      .def(py::init([](const std::optional<std::string>& shoulder,
                       const std::optional<std::string>& elbow,
                       const std::optional<std::string>& wrist,
                       const std::optional<std::vector<int>>& turns) {
             Configuration wish;
             wish.shoulder = side_from(shoulder, "shoulder", "front", "back");
             wish.elbow = side_from(elbow, "elbow", "up", "down");
             wish.wrist = side_from(wrist, "wrist", "noflip", "flip");
             if (turns) {
               if (turns->size() > static_cast<size_t>(kMaxJoints)) {
                 throw MotionError(ErrorCode::kBadArgument, "turns has too many values.");
               }
               wish.turns = Eigen::Map<const Eigen::VectorXi>(
                   turns->data(), static_cast<Eigen::Index>(turns->size()));
             }
             return wish;
           }),
           py::kw_only(), py::arg("shoulder") = py::none(), py::arg("elbow") = py::none(),
           py::arg("wrist") = py::none(), py::arg("turns") = py::none())
      .def_property_readonly(
          "shoulder", [](const Configuration& c) { return word_of(c.shoulder, "front", "back"); },
          "\"front\", \"back\" or None.")
      .def_property_readonly(
          "elbow", [](const Configuration& c) { return word_of(c.elbow, "up", "down"); },
          "\"up\", \"down\" or None.")
      .def_property_readonly(
          "wrist", [](const Configuration& c) { return word_of(c.wrist, "noflip", "flip"); },
          "\"noflip\", \"flip\" or None.")
      .def_property_readonly(
          "turns",
          [](const Configuration& c) {
            return std::vector<int>(c.turns.data(), c.turns.data() + c.turns.size());
          },
          "Whole turns, one a joint; empty in a wish for any.")
      .def("fits", &Configuration::fits, py::arg("wish"),
           "True when every side and turn that the wish names is this one's.")
      .def("__repr__",
           [](const Configuration& c) { return "<Configuration " + c.describe() + ">"; });
}

using RowMajorPose = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// True for a pose that needs no correction.
bool is_exact(const Eigen::Map<const RowMajorPose>& matrix) {
  const Eigen::Matrix3d r = matrix.topLeftCorner<3, 3>();
  constexpr double kRounding = 1e-12;
  return ((r.transpose() * r - Eigen::Matrix3d::Identity()).array().abs() < kRounding).all() &&
         r.determinant() > 0.0 && matrix.topRightCorner<3, 1>().allFinite() &&
         matrix(3, 0) == 0.0 && matrix(3, 1) == 0.0 && matrix(3, 2) == 0.0 && matrix(3, 3) == 1.0;
}

Pose pose_of(const Eigen::Map<const RowMajorPose>& matrix) {
  Pose pose = Pose::Identity();
  pose.linear() = matrix.topLeftCorner<3, 3>();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

Array array_of(const JointVector& q) {
  Array out(q.size());
  std::copy(q.begin(), q.end(), out.mutable_data());
  return out;
}

/// Arrays of doubles in any order, without a conversion.
using AnyOrder = py::array_t<double, 0>;

/// What an ik call asks, of plain arrays that need no check beyond this one; None for all others.
struct PlainRequest {
  Pose pose;
  JointVector near;
};
std::optional<PlainRequest> plain_request(const RobotHandle& self, py::handle pose,
                                          py::handle near) {
  const int n = self.robot->joints();
  if (!AnyOrder::check_(pose) || !self.robot->has_kinematics()) return std::nullopt;
  const auto given = py::reinterpret_borrow<AnyOrder>(pose);
  if (given.ndim() != 2 || given.shape(0) != 4 || given.shape(1) != 4) return std::nullopt;
  RowMajorPose elements;
  const auto element = given.unchecked<2>();
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) elements(row, column) = element(row, column);
  }
  const Eigen::Map<const RowMajorPose> matrix(elements.data());
  if (!is_exact(matrix)) return std::nullopt;
  PlainRequest request{pose_of(matrix), JointVector::Zero(n)};
  if (near.is_none()) return request;
  if (!AnyOrder::check_(near)) return std::nullopt;
  const auto joints = py::reinterpret_borrow<AnyOrder>(near);
  if (joints.ndim() != 1 || joints.shape(0) != n) return std::nullopt;
  for (int i = 0; i < n; ++i) request.near[i] = joints.unchecked<1>()(i);
  if (!request.near.allFinite()) return std::nullopt;
  return request;
}

std::optional<Array> ik_quick(const RobotHandle& self, py::handle pose, py::handle near) {
  const auto request = plain_request(self, pose, near);
  if (!request) return std::nullopt;
  return array_of(self.robot->inverse().solve_near(request->pose, request->near));
}

std::optional<Array> ik_all_quick(const RobotHandle& self, py::handle pose, py::handle near) {
  const auto request = plain_request(self, pose, near);
  if (!request) return std::nullopt;
  std::vector<JointVector> all;
  {
    const py::gil_scoped_release release;
    all = self.robot->inverse().solve_all(request->pose, request->near);
  }
  return rows_of(all);
}

/// One pose a row, one answer a row; with `nan`, rows that have none are NaN.
Array ik_batch(const RobotHandle& self, const Array& poses, const Array& near, bool nan) {
  const InverseKinematics& inverse = inverse_of(self);
  const int n = self.robot->joints();
  if (poses.ndim() != 3 || poses.shape(1) != 4 || poses.shape(2) != 4) {
    throw MotionError(ErrorCode::kBadArgument, "poses must have the shape (k, 4, 4).");
  }
  const py::ssize_t count = poses.shape(0);
  if (near.ndim() != 2 || near.shape(1) != n || (near.shape(0) != 1 && near.shape(0) != count)) {
    throw MotionError(ErrorCode::kBadArgument, "near must have the shape (" + std::to_string(n) +
                                                   ",) or (k, " + std::to_string(n) + ").");
  }
  Array joints(std::vector<py::ssize_t>{count, n});
  const double* in = poses.data();
  const double* references = near.data();
  const py::ssize_t stride = near.shape(0) == 1 ? 0 : n;
  double* out = joints.mutable_data();
  const py::gil_scoped_release release;
  for (py::ssize_t k = 0; k < count; ++k) {
    const Eigen::Map<const RowMajorPose> matrix(in + 16 * k);
    Eigen::Map<Vector> row(out + k * n, n);
    try {
      const Pose pose = is_exact(matrix) ? pose_of(matrix) : pose_from(matrix);
      row = inverse.solve_near(pose, Eigen::Map<const Vector>(references + k * stride, n));
    } catch (const MotionError& error) {
      const ErrorCode code = error.code();
      const bool no_answer = code == ErrorCode::kUnreachable || code == ErrorCode::kOutsideLimits ||
                             code == ErrorCode::kUncontrolled;
      if (nan && no_answer) {
        row.setConstant(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      Problem problem = error.problem();
      problem.message = "poses[" + std::to_string(k) + "]: " + problem.message;
      throw MotionError(std::move(problem));
    }
  }
  return joints;
}

Array ik_path(const RobotHandle& self, const Array& poses, const Vector& start, double step) {
  if (poses.ndim() != 3 || poses.shape(1) != 4 || poses.shape(2) != 4) {
    throw MotionError(ErrorCode::kBadArgument, "poses must have the shape (k, 4, 4).");
  }
  require_kinematics(*self.robot);
  const JointVector first = joints_from(start, "start", self.robot->joints());
  std::vector<Pose> way;
  std::vector<JointVector> joints;
  {
    const py::gil_scoped_release release;
    for (py::ssize_t k = 0; k < poses.shape(0); ++k) {
      way.push_back(pose_from(Eigen::Map<const RowMajorPose>(poses.data() + 16 * k)));
    }
    joints = follow_poses(*self.robot, way, first, step);
  }
  return rows_of(joints);
}

void bind_dexterity(py::module_& m) {
  py::class_<VelocityEllipsoid>(m, "VelocityEllipsoid",
                                "The tool rates that joint rates of length 1 make.")
      .def_property_readonly(
          "axes", [](const VelocityEllipsoid& e) { return Eigen::Matrix3d(e.axes); },
          "Unit vectors in the base frame, columns, longest axis first, (3, 3).")
      .def_property_readonly(
          "lengths", [](const VelocityEllipsoid& e) { return Vector(e.lengths); },
          "Half-axes [m or rad, per unit joint rate], (3,).");
  py::class_<Dexterity>(m, "Dexterity", "How well an arm moves at one place.")
      .def_readonly("yoshikawa", &Dexterity::yoshikawa, "sqrt(det(J J^T)).")
      .def_readonly("asada", &Dexterity::asada,
                    "Least over greatest principal acceleration of the tool's point, 0 to 1.")
      .def_readonly("isotropy", &Dexterity::isotropy,
                    "Least over greatest singular value, metres over length, 0 to 1.")
      .def_readonly("condition", &Dexterity::condition, "1 / isotropy; inf at a singular pose.")
      .def_readonly("least", &Dexterity::least, "Least singular value, metres over length.")
      .def_readonly("length", &Dexterity::length, "Makes metres comparable with radians [m].")
      .def_readonly("linear", &Dexterity::linear, "Ellipsoid of the tool's point.")
      .def_readonly("angular", &Dexterity::angular, "Ellipsoid of the tool's orientation.")
      .def("__repr__", [](const Dexterity& d) {
        return "<Dexterity: yoshikawa " + std::to_string(d.yoshikawa) + ", condition " +
               std::to_string(d.condition) + ">";
      });
}

void bind_inverse(py::class_<RobotHandle>& robot) {
  robot
      .def_property_readonly(
          "ik_family", [](const RobotHandle& r) { return inverse_of(r).family(); },
          "Which inverse-kinematics solver serves this arm, and why.")
      .def_property_readonly(
          "redundancy", [](const RobotHandle& r) { return inverse_of(r).redundancy(); },
          "What a pose leaves open, or an empty text.")
      .def(
          "redundancy_of",
          [](const RobotHandle& r, const Vector& q) {
            return inverse_of(r).redundancy_of(joints_from(q, "q", r.robot->joints()));
          },
          py::arg("q"))
      .def(
          "configuration",
          [](const RobotHandle& r, const Vector& q) {
            return inverse_of(r).configuration(joints_from(q, "q", r.robot->joints()));
          },
          py::arg("q"))
      .def(
          "ik_all",
          [](const RobotHandle& r, const Eigen::Matrix4d& pose, const Vector& near,
             const Configuration& wish, std::optional<double> redundancy) {
            const Pose target = pose_from(pose);
            const JointVector reference = joints_from(near, "near", r.robot->joints());
            const InverseKinematics& inverse = inverse_of(r);
            std::vector<JointVector> all;
            {
              const py::gil_scoped_release release;
              all = redundancy ? inverse.solve_all_at(target, *redundancy, reference)
                               : inverse.solve_all(target, reference);
              all = inverse.in_configuration(std::move(all), wish);
            }
            return rows_of(all);
          },
          py::arg("pose"), py::arg("near"), py::arg("config"), py::arg("redundancy"))
      .def(
          "ik_all_position",
          [](const RobotHandle& r, const Eigen::Vector3d& position, const Vector& near,
             const Configuration& wish) {
            const JointVector reference = joints_from(near, "near", r.robot->joints());
            const InverseKinematics& inverse = inverse_of(r);
            std::vector<JointVector> all;
            {
              const py::gil_scoped_release release;
              all = inverse.in_configuration(inverse.solve_all(position, reference), wish);
            }
            return rows_of(all);
          },
          py::arg("position"), py::arg("near"), py::arg("config"))
      .def("ik_all_quick", &ik_all_quick, py::arg("pose"), py::arg("near"),
           "ik_all() for any configuration, of such arrays as ik_quick() takes; None for others.")
      .def("ik_quick", &ik_quick, py::arg("pose"), py::arg("near"),
           "ik_near() of arrays that need no conversion and no correction; None for others.")
      .def(
          "ik_near",
          [](const RobotHandle& r, const Eigen::Matrix4d& pose, const Vector& near) {
            const Pose target = pose_from(pose);
            const JointVector reference = joints_from(near, "near", r.robot->joints());
            const InverseKinematics& inverse = inverse_of(r);
            const py::gil_scoped_release release;
            return Vector(inverse.solve_near(target, reference));
          },
          py::arg("pose"), py::arg("near"))
      .def(
          "ik_near_position",
          [](const RobotHandle& r, const Eigen::Vector3d& position, const Vector& near) {
            const JointVector reference = joints_from(near, "near", r.robot->joints());
            const InverseKinematics& inverse = inverse_of(r);
            const py::gil_scoped_release release;
            return Vector(inverse.solve_near(position, reference));
          },
          py::arg("position"), py::arg("near"))
      .def("ik_path", &ik_path, py::arg("poses"), py::arg("start"), py::arg("largest_step"))
      .def("ik_batch", &ik_batch, py::arg("poses"), py::arg("near"), py::arg("nan"));
}

}  // namespace

void bind_kinematics(py::module_& m, py::class_<RobotHandle>& robot) {
  bind_configuration(m);
  bind_dexterity(m);
  bind_inverse(robot);
  m.attr("LARGEST_STEP") = kLargestStep;
  robot
      .def(
          "dexterity",
          [](const RobotHandle& r, const Vector& q) {
            require_kinematics(*r.robot);
            return dexterity(*r.robot, joints_from(q, "q", r.robot->joints()));
          },
          py::arg("q"))
      .def(
          "reach",
          [](const RobotHandle& r, const Eigen::Vector3d& direction, const Eigen::Vector3d& start,
             const std::optional<Eigen::Matrix3d>& rotation) {
            require_kinematics(*r.robot);
            std::vector<Stretch> found;
            {
              const py::gil_scoped_release release;
              found = reach(*r.robot, start, direction, rotation);
            }
            Array rows(std::vector<py::ssize_t>{static_cast<py::ssize_t>(found.size()), 2});
            double* out = rows.mutable_data();
            for (const Stretch& stretch : found) {
              *out++ = stretch.from;
              *out++ = stretch.to;
            }
            return rows;
          },
          py::arg("direction"), py::arg("start"), py::arg("rotation"));
}

}  // namespace viapoint::python
