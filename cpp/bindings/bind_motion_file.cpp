// Everything that a motion file holds, as plain arrays: the pieces that run, the curves they were
// made for, and the chain of the arm.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "bindings.hpp"
#include "viapoint/planning/wanted_legs.hpp"

namespace viapoint::python {
namespace {

Array vector_array(const Eigen::VectorXd& values) {
  Array out(static_cast<py::ssize_t>(values.size()));
  std::copy(values.begin(), values.end(), out.mutable_data());
  return out;
}

Array matrix_array(const Eigen::MatrixXd& values) {
  Array out({static_cast<py::ssize_t>(values.rows()), static_cast<py::ssize_t>(values.cols())});
  double* at = out.mutable_data();
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) *at++ = values(row, column);
  }
  return out;
}

/// Stacked along a new first axis, (k, rows, columns).
template <typename Of, typename Get>
Array stacked(const std::vector<Of>& items, py::ssize_t rows, py::ssize_t columns, const Get& get) {
  Array out({static_cast<py::ssize_t>(items.size()), rows, columns});
  double* at = out.mutable_data();
  for (const Of& item : items) {
    const Eigen::MatrixXd values = get(item);
    for (Eigen::Index row = 0; row < rows; ++row) {
      for (Eigen::Index column = 0; column < columns; ++column) *at++ = values(row, column);
    }
  }
  return out;
}

Columns chain_columns(const JointPath& path, py::ssize_t dimension) {
  Columns out;
  Array lengths(static_cast<py::ssize_t>(path.pieces().size()));
  std::transform(path.pieces().begin(), path.pieces().end(), lengths.mutable_data(),
                 [](const JointPiece& piece) { return piece.length; });
  out["lengths"] = lengths;
  out["coefficients"] = stacked(path.pieces(), 6, dimension, [](const JointPiece& piece) {
    return Eigen::MatrixXd(piece.coefficients);
  });
  return out;
}

[[noreturn]] void refuse_unknown_curve() {
  throw MotionError(ErrorCode::kInternal, "a tool curve of a kind that motion files cannot hold");
}

Columns position_columns(const TaskCurve& curve) {
  Columns out;
  const auto* tool = dynamic_cast<const ToolCurve*>(&curve);
  if (tool == nullptr) {
    if (dynamic_cast<const LineCurve*>(&curve) == nullptr) refuse_unknown_curve();
    const CurvePoint start = curve.at(0.0);
    out["from"] = vector_array(start.p);
    out["direction"] = vector_array(start.p1);
    return out;
  }
  if (const auto* spline = dynamic_cast<const SplineCurve*>(&tool->position())) {
    return chain_columns(spline->path(), 3);
  }
  const auto* helix = dynamic_cast<const HelixCurve*>(&tool->position());
  if (helix == nullptr) refuse_unknown_curve();
  const Eigen::Vector3d radial = helix->at(0.0).p - helix->center();
  out["center"] = vector_array(helix->center());
  out["radial"] = vector_array(radial);
  out["tangential"] = vector_array(helix->axis().cross(radial));
  out["travel"] = vector_array(helix->axis() * helix->rise());
  out["rate"] = vector_array(
      Eigen::VectorXd::Constant(1, helix->length() > 0.0 ? helix->angle() / helix->length() : 0.0));
  return out;
}

Columns orientation_columns(const TaskCurve& curve) {
  Columns out;
  const auto* tool = dynamic_cast<const ToolCurve*>(&curve);
  if (tool != nullptr) {
    if (const auto* spline = dynamic_cast<const OrientationSpline*>(&tool->orientation())) {
      out = chain_columns(spline->vectors(), 3);
      out["bases"] = stacked(spline->bases(), 3, 3,
                             [](const Eigen::Matrix3d& base) { return Eigen::MatrixXd(base); });
      return out;
    }
    if (dynamic_cast<const SteadyTurn*>(&tool->orientation()) == nullptr) refuse_unknown_curve();
  }
  const CurvePoint start = curve.at(0.0);
  out["from"] = matrix_array(start.rotation);
  out["rate"] = vector_array(start.w);
  return out;
}

std::string hold_name(Hold hold) {
  switch (hold) {
    case Hold::kPose:
      return "pose";
    case Hold::kAxis:
      return "axis";
    case Hold::kPosition:
      return "position";
    case Hold::kWrist:
      return "wrist";
  }
  return "pose";
}

/// The tool in the frame of the last joint; the identity without kinematics.
Array tool_of(const RobotModel& robot) {
  const RobotDescription& description = robot.description();
  return matrix_array((description.flange * description.tool).matrix());
}

/// The chain from the frame that poses are told in, as the fingerprint counts it.
Columns chain_of(const RobotHandle& handle) {
  const RobotDescription& description = handle.robot->description();
  std::vector<ChainJoint> chain = description.chain;
  if (!chain.empty() && description.base.matrix() != Eigen::Matrix4d::Identity()) {
    chain.front().before = description.base * chain.front().before;
  }
  Columns out;
  Array prismatic(static_cast<py::ssize_t>(chain.size()));
  std::transform(chain.begin(), chain.end(), prismatic.mutable_data(), [](const ChainJoint& joint) {
    return joint.type == JointType::kPrismatic ? 1.0 : 0.0;
  });
  out["prismatic"] = prismatic;
  out["before"] = stacked(
      chain, 4, 4, [](const ChainJoint& joint) { return Eigen::MatrixXd(joint.before.matrix()); });
  out["axis"] =
      stacked(chain, 3, 1, [](const ChainJoint& joint) { return Eigen::MatrixXd(joint.axis); });
  out["tool"] = tool_of(*handle.robot);
  return out;
}

/// Pieces in time order, and the geometry that neighbours share.
class MotionPieces {
 public:
  explicit MotionPieces(const MotionHandle& motion)
      : pieces_(motion.trajectory->pieces()), motion_(motion) {
    for (const TrajectoryPiece& piece : pieces_) {
      if (paths_.empty() || paths_.back()->path != piece.path) paths_.push_back(&piece);
      path_of_.push_back(static_cast<int>(paths_.size()) - 1);
    }
  }

  [[nodiscard]] Array coefficients() const {
    const auto joints = static_cast<py::ssize_t>(motion_.trajectory->joints());
    return stacked(paths_, 6, joints, [joints](const TrajectoryPiece* piece) {
      Eigen::MatrixXd values(6, joints);
      for (Eigen::Index k = 0; k < 6; ++k) {
        for (Eigen::Index i = 0; i < joints; ++i) {
          values(k, i) = piece->path[static_cast<size_t>(k)][static_cast<size_t>(i)];
        }
      }
      return values;
    });
  }
  [[nodiscard]] const std::vector<int>& path_of() const { return path_of_; }
  [[nodiscard]] Array durations() const {
    Array out(static_cast<py::ssize_t>(pieces_.size()));
    std::transform(pieces_.begin(), pieces_.end(), out.mutable_data(),
                   [](const TrajectoryPiece& piece) { return piece.duration; });
    return out;
  }
  [[nodiscard]] Array timing() const {
    Array out({static_cast<py::ssize_t>(pieces_.size()), py::ssize_t{6}});
    double* at = out.mutable_data();
    for (const TrajectoryPiece& piece : pieces_) {
      at = std::copy(piece.timing.begin(), piece.timing.end(), at);
    }
    return out;
  }
  [[nodiscard]] std::vector<int> moves() const {
    std::vector<int> out;
    for (const TrajectoryPiece& piece : pieces_) out.push_back(piece.move);
    return out;
  }
  /// (piece, output, value, time) of every change.
  [[nodiscard]] std::vector<std::tuple<int, int, bool, double>> outputs() const {
    std::vector<std::tuple<int, int, bool, double>> out;
    for (size_t k = 0; k < pieces_.size(); ++k) {
      for (int i = 0; i < pieces_[k].outputs; ++i) {
        const OutputChange& change = pieces_[k].output[static_cast<size_t>(i)];
        out.emplace_back(static_cast<int>(k), change.index, change.value, change.time);
      }
    }
    return out;
  }
  /// (piece, input, value, time-out or none) of every wait for an input.
  [[nodiscard]] std::vector<std::tuple<int, int, bool, std::optional<double>>> waits() const {
    std::vector<std::tuple<int, int, bool, std::optional<double>>> out;
    for (const size_t k : motion_.trajectory->waits()) {
      const InputWait& wait = pieces_[k].wait;
      std::optional<double> timeout;
      if (std::isfinite(wait.timeout)) timeout = wait.timeout;
      out.emplace_back(static_cast<int>(k), wait.input, wait.value, timeout);
    }
    return out;
  }

 private:
  const std::vector<TrajectoryPiece>& pieces_;
  MotionHandle motion_;  ///< keeps pieces_ alive
  std::vector<const TrajectoryPiece*> paths_;
  std::vector<int> path_of_;
};

}  // namespace

void bind_motion_file(py::module_& m) {
  py::class_<MotionPieces>(m, "MotionPieces", "What of a motion runs, as arrays.")
      .def(py::init<const MotionHandle&>(), py::arg("motion"))
      .def_property_readonly("coefficients", &MotionPieces::coefficients,
                             "Of u^k, joint by joint, of every stretch of path, (m, 6, n).")
      .def_property_readonly("path_of", &MotionPieces::path_of, "Path of every piece, (k,).")
      .def_property_readonly("durations", &MotionPieces::durations, "[s], (k,).")
      .def_property_readonly("timing", &MotionPieces::timing, "Of x^k of every piece, (k, 6).")
      .def_property_readonly("moves", &MotionPieces::moves, "Program step, (k,).")
      .def_property_readonly("outputs", &MotionPieces::outputs,
                             "Piece, output, value and time [s] of every change.")
      .def_property_readonly("waits", &MotionPieces::waits,
                             "Piece, input, value and time-out [s] of every wait for an input.");
  py::class_<WantedLeg>(m, "WantedLeg", "What a program asks of one move.")
      .def_readonly("move", &WantedLeg::move, "Program step.")
      .def_property_readonly(
          "path",
          [](const WantedLeg& leg) {
            return chain_columns(leg.path, static_cast<py::ssize_t>(leg.robot->joints()));
          },
          "lengths (m,) of s and coefficients (m, 6, n).")
      .def_property_readonly(
          "on_curve", [](const WantedLeg& leg) { return leg.curve != nullptr; },
          "True where the tool follows a curve, and not the joints a line or spline.")
      .def_property_readonly(
          "position", [](const WantedLeg& leg) { return position_columns(*leg.curve); },
          "Line, helix or quintics of the tool point over s; only where on_curve.")
      .def_property_readonly(
          "orientation", [](const WantedLeg& leg) { return orientation_columns(*leg.curve); },
          "Steady turn or spline of the tool over s; only where on_curve.")
      .def_property_readonly(
          "merged",
          [](const WantedLeg& leg) {
            std::vector<std::tuple<CornerOutcome, Array, Array>> points;
            for (const MergedPoint& point : leg.merged) {
              points.emplace_back(point.outcome, vector_array(point.at),
                                  matrix_array(point.rotation));
            }
            return points;
          },
          "The points that it passes without a corner: what became of the zone, joints (n,) or "
          "tool "
          "point (3,), and the tool's rotation (3, 3) as they were told.")
      .def_property_readonly(
          "hold", [](const WantedLeg& leg) { return hold_name(leg.hold); },
          "\"pose\", \"axis\", \"position\" or \"wrist\".")
      .def_property_readonly(
          "tool", [](const WantedLeg& leg) { return tool_of(*leg.robot); },
          "In the frame of the last joint, (4, 4).")
      .def_property_readonly(
          "speed",
          [](const WantedLeg& leg) {
            return leg.options.process_speed ? leg.options.process_speed : leg.options.speed;
          },
          "The tool's largest, a process speed too [m/s].")
      .def_property_readonly("acceleration",
                             [](const WantedLeg& leg) { return leg.options.acceleration; })
      .def_property_readonly("angular_speed",
                             [](const WantedLeg& leg) { return leg.options.angular_speed; })
      .def_property_readonly("angular_acceleration",
                             [](const WantedLeg& leg) { return leg.options.angular_acceleration; })
      .def_property_readonly("scale", [](const WantedLeg& leg) { return leg.options.scale; });
  m.def(
      "wanted_legs",
      [](const RobotHandle& robot, const MotionProgram& program) {
        return wanted_legs(robot.robot, program);
      },
      py::arg("robot"), py::arg("program"), py::call_guard<py::gil_scoped_release>(),
      "What a program asks of every move, in order; raises the first error of its report.");
  m.def("chain_of", &chain_of, py::arg("robot"),
        "prismatic (n,), before (n, 4, 4), axis (n, 3, 1), tool (4, 4).");
}

}  // namespace viapoint::python
