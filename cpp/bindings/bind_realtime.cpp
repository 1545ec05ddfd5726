// The 2 ms loop on a simulated drive, its jobs and logs, and runs in virtual time.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

#include "bindings.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/log_csv.hpp"
#include "viapoint/realtime/virtual_jog.hpp"

namespace viapoint::python {
namespace {

using Vector = Eigen::VectorXd;
using Release = py::gil_scoped_release;

/// A loop that Python can close before the object itself goes. Shared, so that a thread that is
/// inside a call while another one closes keeps it alive until it is out.
struct LoopHandle {
  std::shared_ptr<ControllerLoop> loop;
  int joints = 0;

  [[nodiscard]] std::shared_ptr<ControllerLoop> open() const {
    if (loop == nullptr) {
      throw MotionError(ErrorCode::kDriveFault, "The arm is no longer connected.",
                        {"Connect again: viapoint.connect(...)."});
    }
    return loop;
  }
  /// A run under way is brought to rest first, which takes time: the GIL is not held meanwhile.
  void close() {
    std::shared_ptr<ControllerLoop> closing = std::move(loop);
    const Release release;
    closing.reset();
  }
};

struct JobHandle {
  std::shared_ptr<Job> job;
  int joints = 0;
};

/// The cycles of a run, kept in C++ until somebody asks for arrays or a file.
struct LogHandle {
  std::vector<LogRecord> records;
  int joints = 0;
};

GuardOptions guard_of(const RobotHandle& robot, double tool_speed, const Eigen::Vector3d& box_min,
                      const Eigen::Vector3d& box_max) {
  GuardOptions guard;
  if (robot.robot->has_kinematics()) guard.kinematics = robot.robot->forward();
  guard.tool_speed = tool_speed;
  guard.box_min = box_min;
  guard.box_max = box_max;
  return guard;
}

LoopHandle make_loop(const RobotHandle& robot, const Vector& start, double cycle, double tool_speed,
                     const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max) {
  if (!(cycle >= 1e-4) || !(cycle <= 1.0)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "cycle is " + std::to_string(cycle) + " s; allowed are 0.0001 s to 1 s.");
  }
  const int joints = robot.robot->joints();
  const JointVector q = joints_from(start, "start", joints);
  LoopOptions options;
  options.cycle = std::chrono::nanoseconds(std::llround(cycle * 1e9));
  options.guard = guard_of(robot, tool_speed, box_min, box_max);
  const Release release;
  return {std::make_shared<ControllerLoop>(std::make_unique<SimulatedDrive>(q),
                                           robot.robot->limits(), options),
          joints};
}

/// @param values the share of an override, the velocities of a jog, else nothing
TimedCommand command_from(double time, const std::string& kind, const Vector& values, int joints) {
  using Kind = TimedCommand::Kind;
  if (!std::isfinite(time) || time < 0.0) {
    throw MotionError(ErrorCode::kBadArgument,
                      "A command's time is " + std::to_string(time) + " s; it must be 0 or later.");
  }
  if (kind == "jog") {
    return {time, Kind::kJog, 0.0, joints_from(values, "a jog's velocity", joints)};
  }
  if (kind == "override") {
    const double value = values.size() == 1 ? values[0] : std::nan("");
    if (!(value >= 0.0 && value <= 1.0)) {
      throw MotionError(ErrorCode::kBadArgument,
                        "An override is " + std::to_string(value) + "; it must be in [0, 1].");
    }
    return {time, Kind::kOverride, value, {}};
  }
  if (kind == "pause") return {time, Kind::kPause, 0.0, {}};
  if (kind == "resume") return {time, Kind::kResume, 0.0, {}};
  if (kind == "stop") return {time, Kind::kStop, 0.0, {}};
  if (kind == "step") return {time, Kind::kStep, 0.0, {}};
  if (kind == "backward") return {time, Kind::kBackward, 0.0, {}};
  throw MotionError(ErrorCode::kBadArgument, "\"" + kind + "\" is no command.",
                    {"Use \"override\", \"pause\", \"resume\", \"stop\", \"step\", \"backward\" or "
                     "\"jog\"."});
}

template <typename T, typename Get>
py::array_t<T> column(const std::vector<LogRecord>& records, Get get) {
  py::array_t<T> out(static_cast<py::ssize_t>(records.size()));
  T* data = out.mutable_data();
  for (const LogRecord& record : records) *data++ = static_cast<T>(get(record));
  return out;
}

Array rows(const std::vector<LogRecord>& records, int joints, JointVector LogRecord::* member) {
  Array out({static_cast<py::ssize_t>(records.size()), static_cast<py::ssize_t>(joints)});
  double* data = out.mutable_data();
  for (const LogRecord& record : records) {
    const JointVector& values = record.*member;
    // A record without a value (nothing measured in a simulated run) reads as NaN.
    for (int i = 0; i < joints; ++i) *data++ = i < values.size() ? values[i] : std::nan("");
  }
  return out;
}

Columns columns_of(const LogHandle& log) {
  const std::vector<LogRecord>& records = log.records;
  const int joints = log.joints;
  Columns out;
  out["cycle"] = column<std::uint64_t>(records, [](const LogRecord& r) { return r.cycle; });
  out["stamp"] = column<std::int64_t>(records, [](const LogRecord& r) { return r.stamp; });
  out["latency"] = column<std::int64_t>(records, [](const LogRecord& r) { return r.latency; });
  out["compute"] = column<std::int64_t>(records, [](const LogRecord& r) { return r.compute; });
  out["nominal_time"] = column<double>(records, [](const LogRecord& r) { return r.nominal_time; });
  out["rate"] = column<double>(records, [](const LogRecord& r) { return r.rate; });
  out["move"] = column<std::int32_t>(records, [](const LogRecord& r) { return r.move; });
  out["state"] = column<std::uint8_t>(records, [](const LogRecord& r) { return r.state; });
  out["outputs"] = column<std::uint64_t>(records, [](const LogRecord& r) { return r.outputs; });
  out["q"] = rows(records, joints, &LogRecord::q);
  out["qd"] = rows(records, joints, &LogRecord::qd);
  out["qdd"] = rows(records, joints, &LogRecord::qdd);
  out["qddd"] = rows(records, joints, &LogRecord::qddd);
  out["measured"] = rows(records, joints, &LogRecord::measured);
  return out;
}

std::vector<std::string> run_states() {
  std::vector<std::string> states;
  for (int i = 0; i <= static_cast<int>(RunState::kReturning); ++i) {
    states.emplace_back(to_string(static_cast<RunState>(i)));
  }
  return states;
}

template <typename T>
py::array_t<T> column_named(const Columns& columns, const std::string& name,
                            std::vector<py::ssize_t> shape) {
  if (!columns.contains(name)) {
    throw MotionError(ErrorCode::kBadArgument, "The log lacks the column \"" + name + "\".");
  }
  const auto column =
      py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(columns[name.c_str()]);
  if (!column ||
      !std::equal(column.shape(), column.shape() + column.ndim(), shape.begin(), shape.end())) {
    throw MotionError(ErrorCode::kBadArgument,
                      "The log's column \"" + name + "\" does not fit the others in shape.");
  }
  return column;
}

/// The opposite of columns_of: a log that was read from a file.
LogHandle log_of(const Columns& columns) {
  const auto q = py::array::ensure(columns.contains("q") ? py::object(columns["q"]) : py::none());
  if (!q || q.ndim() != 2 || q.shape(1) < 1 || q.shape(1) > kMaxJoints) {
    throw MotionError(ErrorCode::kBadArgument, "The log's column \"q\" must be (k, n).");
  }
  const py::ssize_t count = q.shape(0);
  const py::ssize_t joints = q.shape(1);
  LogHandle log{std::vector<LogRecord>(static_cast<size_t>(count)), static_cast<int>(joints)};
  const auto fill = [&]<typename T>(const std::string& name, T LogRecord::* member) {
    const py::array_t<T> values = column_named<T>(columns, name, {count});
    for (size_t k = 0; k < log.records.size(); ++k) log.records[k].*member = values.data()[k];
  };
  fill("cycle", &LogRecord::cycle);
  fill("stamp", &LogRecord::stamp);
  fill("latency", &LogRecord::latency);
  fill("compute", &LogRecord::compute);
  fill("nominal_time", &LogRecord::nominal_time);
  fill("rate", &LogRecord::rate);
  fill("move", &LogRecord::move);
  fill("outputs", &LogRecord::outputs);
  const py::array_t<std::uint8_t> states = column_named<std::uint8_t>(columns, "state", {count});
  for (size_t k = 0; k < log.records.size(); ++k) {
    if (states.data()[k] > static_cast<std::uint8_t>(RunState::kReturning)) {
      throw MotionError(ErrorCode::kBadArgument, "The log's column \"state\" holds no state.");
    }
    log.records[k].state = static_cast<RunState>(states.data()[k]);
  }
  const auto fill_rows = [&](const std::string& name, JointVector LogRecord::* member) {
    const py::array_t<double> values = column_named<double>(columns, name, {count, joints});
    for (size_t k = 0; k < log.records.size(); ++k) {
      const Eigen::Map<const Eigen::VectorXd> row(
          values.data() + static_cast<py::ssize_t>(k) * joints, joints);
      // As rows() tells a record without a value.
      if (!row.array().isNaN().all()) log.records[k].*member = row;
    }
  };
  fill_rows("q", &LogRecord::q);
  fill_rows("qd", &LogRecord::qd);
  fill_rows("qdd", &LogRecord::qdd);
  fill_rows("qddd", &LogRecord::qddd);
  fill_rows("measured", &LogRecord::measured);
  return log;
}

void bind_log(py::module_& m) {
  py::class_<LogHandle>(m, "Log", "Every cycle of a run as it was executed.")
      .def("__len__", [](const LogHandle& log) { return log.records.size(); })
      .def("columns", &columns_of, "A dict of arrays, one row a cycle.")
      .def_static("of_columns", &log_of, py::arg("columns"),
                  "A log of what columns() returned, one row a cycle.")
      .def(
          "head",
          [](const LogHandle& log, size_t count) {
            const auto end = std::min(count, log.records.size());
            return LogHandle{{log.records.begin(), log.records.begin() + static_cast<long>(end)},
                             log.joints};
          },
          py::arg("count"), "The first `count` cycles.")
      .def(
          "save_csv",
          [](const LogHandle& log, const std::string& path) { write_log_csv(path, log.records); },
          py::arg("path"), py::call_guard<Release>(),
          "Writes the same table as viapoint-controller --log.");
}

void bind_job(py::module_& m) {
  py::class_<RunReport>(m, "RunReport", "Figures of one run; times in seconds.")
      .def_readonly("cycles", &RunReport::cycles)
      .def_readonly("overruns", &RunReport::overruns,
                    "Cycles that woke a whole cycle late or more.")
      .def_readonly("latency_p50", &RunReport::latency_p50)
      .def_readonly("latency_p99", &RunReport::latency_p99)
      .def_readonly("latency_max", &RunReport::latency_max)
      .def_readonly("compute_p50", &RunReport::compute_p50)
      .def_readonly("compute_p99", &RunReport::compute_p99)
      .def_readonly("compute_max", &RunReport::compute_max)
      .def_readonly("wall_time", &RunReport::wall_time, "First to last cycle.")
      .def_readonly("missed_cycles", &RunReport::missed_cycles,
                    "Cycles that overruns slept through.")
      .def_readonly("lost_records", &RunReport::lost_records,
                    "Cycles that found no room in the log.");
  py::class_<JobHandle>(m, "Job", "One motion under way.")
      .def(
          "wait", [](const JobHandle& j, double timeout) { return j.job->wait(timeout); },
          py::arg("timeout"), py::call_guard<Release>())
      .def(
          "pause", [](const JobHandle& j) { j.job->pause(); }, py::call_guard<Release>())
      .def(
          "resume", [](const JobHandle& j) { j.job->resume(); }, py::call_guard<Release>())
      .def(
          "step", [](const JobHandle& j) { j.job->step(); }, py::call_guard<Release>())
      .def(
          "backward", [](const JobHandle& j) { j.job->backward(); }, py::call_guard<Release>())
      .def(
          "stop",
          [](const JobHandle& j, int category) {
            j.job->stop(category == 1 ? StopCategory::kRelease : StopCategory::kHold);
          },
          py::arg("category"), py::call_guard<Release>())
      .def_property_readonly(
          "state", [](const JobHandle& j) { return std::string(to_string(j.job->state())); })
      .def_property_readonly("nominal_time",
                             [](const JobHandle& j) { return j.job->nominal_time(); })
      .def_property_readonly("duration", [](const JobHandle& j) { return j.job->duration(); })
      .def_property_readonly("overruns", [](const JobHandle& j) { return j.job->overruns(); })
      .def_property_readonly("move", [](const JobHandle& j) { return j.job->move(); })
      .def(
          "log", [](const JobHandle& j) { return LogHandle{j.job->log(), j.joints}; },
          py::call_guard<Release>())
      .def("report", [](const JobHandle& j) { return j.job->report(); }, py::call_guard<Release>());
}

}  // namespace

void bind_realtime(py::module_& m) {
  m.attr("CYCLE") = std::chrono::duration<double>(LoopOptions{}.cycle).count();
  bind_log(m);
  bind_job(m);
  py::class_<LoopHandle>(m, "ControllerLoop", "The 2 ms loop over a simulated drive.")
      .def(py::init(&make_loop), py::arg("robot"), py::arg("start"), py::kw_only(),
           py::arg("cycle"), py::arg("tool_speed"), py::arg("box_min"), py::arg("box_max"))
      .def(
          "run",
          [](const LoopHandle& l, const MotionHandle& motion) {
            const std::shared_ptr<ControllerLoop> loop = l.open();
            const Release release;
            return JobHandle{loop->run(motion.trajectory), l.joints};
          },
          py::arg("motion"), py::keep_alive<0, 1>())
      .def(
          "jog",
          [](const LoopHandle& l, const Vector& velocity) {
            const std::shared_ptr<ControllerLoop> loop = l.open();
            const JointVector wished = joints_from(velocity, "velocity", l.joints);
            const Release release;
            loop->jog(wished);
          },
          py::arg("velocity"), "Joint velocities for the next 250 ms.")
      .def_property_readonly("jogging", [](const LoopHandle& l) { return l.open()->jogging(); })
      .def_property_readonly("jog_block", [](const LoopHandle& l) { return l.open()->jog_block(); })
      .def_property(
          "override", [](const LoopHandle& l) { return l.open()->override_share(); },
          [](const LoopHandle& l, double share) { l.open()->set_override(share); })
      .def_property_readonly("measured",
                             [](const LoopHandle& l) { return Vector(l.open()->measured().q); })
      .def_property_readonly("position",
                             [](const LoopHandle& l) { return Vector(l.open()->position()); })
      .def_property_readonly("busy", [](const LoopHandle& l) { return l.open()->busy(); })
      .def_property_readonly("fault", [](const LoopHandle& l) { return l.open()->fault(); })
      .def_property_readonly(
          "fault_cycles",
          [](const LoopHandle& l) { return LogHandle{l.open()->fault_cycles(), l.joints}; })
      .def_property_readonly("is_open", [](const LoopHandle& l) { return l.loop != nullptr; })
      .def_property_readonly("shortcomings",
                             [](const LoopHandle& l) { return l.open()->shortcomings(); })
      .def("close", &LoopHandle::close);
  py::class_<VirtualJog>(m, "VirtualJog", "Hold-to-run in virtual time.")
      .def(py::init([](const RobotHandle& robot, const Vector& start, double cycle) {
             return VirtualJog(robot.robot->limits(),
                               joints_from(start, "start", robot.robot->joints()),
                               std::chrono::nanoseconds(std::llround(cycle * 1e9)));
           }),
           py::arg("robot"), py::arg("start"), py::kw_only(), py::arg("cycle"))
      .def(
          "jog",
          [](VirtualJog& j, const Vector& velocity) {
            j.jog(joints_from(velocity, "velocity", static_cast<int>(j.position().size())));
          },
          py::arg("velocity"))
      .def("pass_cycles", &VirtualJog::pass, py::arg("count"))
      .def_property_readonly("position", [](const VirtualJog& j) { return Vector(j.position()); })
      .def_property_readonly("jogging", &VirtualJog::jogging)
      .def_property_readonly("jog_block", &VirtualJog::block);
  m.def(
      "admit",
      [](const MotionHandle& motion, const Vector& position) {
        admit(*motion.trajectory, motion.robot->limits(),
              joints_from(position, "position", motion.robot->joints()));
      },
      py::arg("motion"), py::arg("position"),
      "Raises the first reason why the motion must not run from `position`.");
  m.def(
      "simulate",
      [](const MotionHandle& motion,
         const std::vector<std::tuple<double, std::string, Vector>>& commands, double cycle) {
        std::vector<TimedCommand> timed;
        for (const auto& [time, kind, values] : commands) {
          timed.push_back(command_from(time, kind, values, motion.trajectory->joints()));
        }
        const Release release;
        return LogHandle{simulate(*motion.trajectory, motion.robot->limits(), std::move(timed),
                                  std::chrono::nanoseconds(std::llround(cycle * 1e9))),
                         motion.trajectory->joints()};
      },
      py::arg("motion"), py::arg("commands"), py::arg("cycle"),
      "The interpolator in virtual time: one record a cycle.");
  m.def(
      "simulate_jog",
      [](const RobotHandle& robot, const Vector& start,
         const std::vector<std::tuple<double, Vector>>& calls, double cycle) {
        const int joints = robot.robot->joints();
        std::vector<TimedJog> timed;
        for (const auto& [time, velocity] : calls) {
          timed.push_back({time, joints_from(velocity, "velocity", joints)});
        }
        const JointVector q = joints_from(start, "start", joints);
        const Release release;
        return LogHandle{simulate_jog(robot.robot->limits(), q, std::move(timed),
                                      std::chrono::nanoseconds(std::llround(cycle * 1e9))),
                         joints};
      },
      py::arg("robot"), py::arg("start"), py::arg("calls"), py::arg("cycle"),
      "A jog in virtual time: one record a cycle.");
  m.def("run_states", &run_states, "Every state's name, in the order of the C++ enum.");
}

}  // namespace viapoint::python
