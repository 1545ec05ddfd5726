// Motion programs: steps are appended from Python, which checks the arguments first.
#include <optional>
#include <tuple>

#include "bindings.hpp"

namespace viapoint::python {
namespace {

Zone zone_from(const std::string& kind, double size, std::optional<double> angle) {
  Zone zone;
  zone.size = size;
  if (angle) zone.angle = *angle;
  for (const auto& [name, means] : {std::pair{"fine", ZoneKind::kFine},
                                    {"radius", ZoneKind::kRadius},
                                    {"deviation", ZoneKind::kDeviation},
                                    {"joint_deviation", ZoneKind::kJointDeviation}}) {
    zone.kind = means;
    if (kind == name) return zone;
  }
  throw MotionError(ErrorCode::kBadArgument, "\"" + kind + "\" is no kind of zone.",
                    {"Use \"fine\", \"radius\", \"deviation\" or \"joint_deviation\"."});
}

Orientation orientation_from(const std::string& name) {
  if (name == "least") return Orientation::kLeast;
  if (name == "wrist") return Orientation::kWrist;
  if (name == "fixed") return Orientation::kFixed;
  if (name == "tangent") return Orientation::kTangent;
  if (name == "through") return Orientation::kThrough;
  if (name == "spin") return Orientation::kSpin;
  if (name == "free") return Orientation::kFree;
  throw MotionError(ErrorCode::kBadArgument, "\"" + name + "\" is no way of orientation.",
                    {R"(Use "least", "wrist", "fixed", "tangent", "through", "spin" or "free".)"});
}

SplineKind spline_kind_from(const std::string& name) {
  if (name == "cubic") return SplineKind::kCubic;
  if (name == "quintic") return SplineKind::kQuintic;
  if (name == "bezier") return SplineKind::kBezier;
  if (name == "b_spline") return SplineKind::kBSpline;
  throw MotionError(ErrorCode::kBadArgument, "\"" + name + "\" is no kind of spline.",
                    {R"(Use "cubic", "quintic", "bezier" or "b_spline".)"});
}

TimedSpace space_from(const std::string& name) {
  if (name == "joint") return TimedSpace::kJoint;
  if (name == "cartesian") return TimedSpace::kCartesian;
  throw MotionError(ErrorCode::kBadArgument, "\"" + name + "\" is no space of a timed program.",
                    {"Use \"joint\" or \"cartesian\"."});
}

using TargetRow = std::tuple<int, std::string, Eigen::MatrixXd>;

TargetRow row_of(int step, const Target& target) {
  if (const auto* joints = std::get_if<JointTarget>(&target)) return {step, "joints", joints->q};
  if (const auto* pose = std::get_if<PoseTarget>(&target)) {
    return {step, "pose", pose->pose_base_tool.matrix()};
  }
  return {step, "position", std::get<PositionTarget>(target).position};
}

std::vector<TargetRow> targets_of(const MotionProgram& program) {
  std::vector<TargetRow> rows;
  Pose frame = Pose::Identity();
  for (size_t i = 0; i < program.steps.size(); ++i) {
    const auto step = static_cast<int>(i);
    const Step base_step = in_base(program.steps[i], frame);
    const auto& what = base_step.what;
    if (const auto* set_frame = std::get_if<SetFrame>(&what)) {
      frame = set_frame->pose_base_frame;
    } else if (const auto* ptp = std::get_if<PtpMove>(&what)) {
      rows.push_back(row_of(step, ptp->target));
    } else if (const auto* lin = std::get_if<LinMove>(&what)) {
      rows.push_back(row_of(step, lin->target));
    } else if (const auto* circ = std::get_if<CircMove>(&what)) {
      rows.push_back(row_of(step, circ->via));
      rows.push_back(row_of(step, circ->target));
    } else if (const auto* spline = std::get_if<SplineMove>(&what)) {
      // The poses of a fit are many, and nobody gave them.
      const size_t first =
          spline->at.empty() || spline->points.empty() ? 0 : spline->points.size() - 1;
      for (size_t k = first; k < spline->points.size(); ++k) {
        rows.push_back(row_of(step, spline->points[k]));
      }
    } else if (const auto* timed = std::get_if<TimedMove>(&what)) {
      for (const TimedPoint& point : timed->points) rows.push_back(row_of(step, point.target));
    }
  }
  return rows;
}

using ToolRow = std::pair<int, std::optional<Eigen::Matrix4d>>;

std::vector<ToolRow> tools_of(const MotionProgram& program) {
  std::vector<ToolRow> rows;
  for (size_t i = 0; i < program.steps.size(); ++i) {
    const auto* tool = std::get_if<SetTool>(&program.steps[i].what);
    if (tool == nullptr) continue;
    ToolRow row{static_cast<int>(i), std::nullopt};
    if (tool->pose_flange_tool) row.second = tool->pose_flange_tool->matrix();
    rows.push_back(row);
  }
  return rows;
}

void append(MotionProgram& program, decltype(Step::what) what, const MoveOptions& options,
            std::string file, int line) {
  program.steps.push_back({std::move(what), options, {std::move(file), line}});
}

void bind_parts(py::module_& m) {
  py::class_<TargetHandle>(m, "Target", "Where a move goes.")
      .def_static(
          "joints",
          [](const Eigen::VectorXd& q) { return TargetHandle{JointTarget{joints_from(q, "q")}}; },
          py::arg("q"))
      .def_static(
          "pose",
          [](const Eigen::Matrix4d& pose, double correction) {
            return TargetHandle{PoseTarget{pose_from(pose), correction}};
          },
          py::arg("pose"), py::arg("correction") = 0.0,
          "A pose, and how far the matrix it was given as was from a rotation.")
      .def_static(
          "position",
          [](const Eigen::Vector3d& position) { return TargetHandle{PositionTarget{position}}; },
          py::arg("position"));
  py::class_<MoveOptions>(m, "MoveOptions", "Wishes of one move.")
      .def(py::init([](std::optional<double> speed, std::optional<double> acceleration,
                       std::optional<double> angular_speed,
                       std::optional<double> angular_acceleration,
                       std::optional<double> process_speed, std::optional<double> scale,
                       const std::string& zone, double size, std::optional<double> angle) {
             return MoveOptions{
                 speed,         acceleration,         scale,        zone_from(zone, size, angle),
                 angular_speed, angular_acceleration, process_speed};
           }),
           py::kw_only(), py::arg("speed") = py::none(), py::arg("acceleration") = py::none(),
           py::arg("angular_speed") = py::none(), py::arg("angular_acceleration") = py::none(),
           py::arg("process_speed") = py::none(), py::arg("scale") = py::none(),
           py::arg("zone") = "fine", py::arg("size") = 0.0, py::arg("angle") = py::none());
}

}  // namespace

void bind_program(py::module_& m) {
  bind_parts(m);
  py::class_<MotionProgram>(m, "MotionProgram", "Moves, waits and outputs, in order.")
      .def(
          "set_tolerance",
          [](MotionProgram& program, double position, double angle) {
            program.tolerance = {position, angle};
          },
          py::arg("position"), py::arg("angle"),
          "How far the tool may be from its lines and curves [m, rad].")
      .def(
          "copy", [](const MotionProgram& program) { return program; }, "The program as it is now.")
      .def(py::init([](const RobotHandle& robot, const Eigen::VectorXd& start) {
             return MotionProgram{robot.robot->name(),
                                  robot.robot->fingerprint(),
                                  joints_from(start, "start", robot.robot->joints()),
                                  {},
                                  {}};
           }),
           py::arg("robot"), py::arg("start"))
      .def_readonly("robot", &MotionProgram::robot)
      .def_readonly("robot_fingerprint", &MotionProgram::robot_fingerprint)
      .def_property_readonly("start",
                             [](const MotionProgram& p) { return Eigen::VectorXd(p.start); })
      .def("__len__", [](const MotionProgram& p) { return p.steps.size(); })
      .def("targets", &targets_of, "Step, kind of target and its array, for every target.")
      .def(
          "add_movej",
          [](MotionProgram& p, const TargetHandle& target, const MoveOptions& options,
             std::string file,
             int line) { append(p, PtpMove{target.target}, options, std::move(file), line); },
          py::arg("target"), py::arg("options"), py::arg("file"), py::arg("line"))
      .def(
          "add_movel",
          [](MotionProgram& p, const TargetHandle& target, const std::string& orientation,
             const MoveOptions& options, std::string file, int line) {
            append(p, LinMove{target.target, orientation_from(orientation)}, options,
                   std::move(file), line);
          },
          py::arg("target"), py::arg("orientation"), py::arg("options"), py::arg("file"),
          py::arg("line"))
      .def(
          "add_movec",
          [](MotionProgram& p, const TargetHandle& via, const TargetHandle& target,
             const std::string& orientation, const MoveOptions& options, std::string file,
             int line) {
            append(p, CircMove{via.target, target.target, orientation_from(orientation)}, options,
                   std::move(file), line);
          },
          py::arg("via"), py::arg("target"), py::arg("orientation"), py::arg("options"),
          py::arg("file"), py::arg("line"))
      .def(
          "add_turn",
          [](MotionProgram& p, const std::optional<Eigen::Vector3d>& center,
             const std::optional<Eigen::Vector3d>& axis, double angle, double pitch,
             const std::string& orientation, const MoveOptions& options, std::string file,
             int line) {
            append(p, TurnMove{center, axis, angle, pitch, orientation_from(orientation)}, options,
                   std::move(file), line);
          },
          py::arg("center"), py::arg("axis"), py::arg("angle"), py::arg("pitch"),
          py::arg("orientation"), py::arg("options"), py::arg("file"), py::arg("line"))
      .def(
          "add_spline",
          [](MotionProgram& p, const std::vector<TargetHandle>& points, const std::string& kind,
             bool of_joints, const std::string& orientation, const std::vector<double>& at,
             const std::optional<TargetHandle>& start, const MoveOptions& options, std::string file,
             int line) {
            SplineMove move;
            for (const TargetHandle& point : points) move.points.push_back(point.target);
            move.kind = spline_kind_from(kind);
            move.space = of_joints ? SplineSpace::kJoint : SplineSpace::kTool;
            move.orientation = orientation_from(orientation);
            move.at = at;
            if (start) move.start = start->target;
            append(p, std::move(move), options, std::move(file), line);
          },
          py::arg("points"), py::arg("kind"), py::arg("of_joints"), py::arg("orientation"),
          py::arg("at"), py::arg("start"), py::arg("options"), py::arg("file"), py::arg("line"))
      .def(
          "add_wait",
          [](MotionProgram& p, double seconds, std::string file, int line) {
            append(p, Wait{seconds}, {}, std::move(file), line);
          },
          py::arg("seconds"), py::arg("file"), py::arg("line"))
      .def(
          "add_set_do",
          [](MotionProgram& p, int index, bool value, double distance, double time,
             std::string file, int line) {
            append(p, SetOutput{index, value, distance, time}, {}, std::move(file), line);
          },
          py::arg("index"), py::arg("value"), py::arg("distance"), py::arg("time"), py::arg("file"),
          py::arg("line"))
      .def(
          "add_wait_di",
          [](MotionProgram& p, int index, bool value, std::optional<double> timeout,
             std::string file,
             int line) { append(p, WaitInput{index, value, timeout}, {}, std::move(file), line); },
          py::arg("index"), py::arg("value"), py::arg("timeout"), py::arg("file"), py::arg("line"))
      .def(
          "add_set_frame",
          [](MotionProgram& p, const Eigen::Matrix4d& pose, std::string name, std::string file,
             int line) {
            append(p, SetFrame{pose_from(pose), std::move(name)}, {}, std::move(file), line);
          },
          py::arg("pose"), py::arg("name"), py::arg("file"), py::arg("line"))
      .def(
          "add_set_tool",
          [](MotionProgram& p, const std::optional<Eigen::Matrix4d>& pose, std::string name,
             std::string file, int line) {
            std::optional<Pose> tool;
            if (pose) tool = pose_from(*pose);
            append(p, SetTool{tool, std::move(name)}, {}, std::move(file), line);
          },
          py::arg("pose"), py::arg("name"), py::arg("file"), py::arg("line"))
      .def("tools", &tools_of,
           "Step and pose_flange_tool, None for the robot's own, of every change.")
      .def(
          "add_timed",
          [](MotionProgram& p, const std::vector<std::pair<TargetHandle, double>>& points,
             double t_acc, const std::string& space, std::string file, int line) {
            TimedMove move{{}, t_acc, space_from(space)};
            for (const auto& [target, seconds] : points) {
              move.points.push_back({target.target, seconds});
            }
            append(p, std::move(move), {}, std::move(file), line);
          },
          py::arg("points"), py::arg("t_acc"), py::arg("space"), py::arg("file"), py::arg("line"))
      .def("to_json", [](const MotionProgram& p) { return to_json(p); })
      .def("save", &save_program, py::arg("path"));
  m.def("load_program", &load_program, py::arg("path"));
}

}  // namespace viapoint::python
