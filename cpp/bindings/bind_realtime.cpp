// The 2 ms loop on its drive, on the clock and in virtual time.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "run_handles.hpp"

namespace viapoint::python {
namespace {

using Vector = Eigen::VectorXd;
using Release = py::gil_scoped_release;

GuardOptions guard_of(const RobotHandle& robot, double tool_speed, const Eigen::Vector3d& box_min,
                      const Eigen::Vector3d& box_max) {
  GuardOptions guard;
  if (robot.robot->has_kinematics()) guard.kinematics = robot.robot->forward();
  guard.tool_speed = tool_speed;
  guard.box_min = box_min;
  guard.box_max = box_max;
  return guard;
}

/// @param speed, low, high what the guard holds at the tool
template <typename Loop>
HandleOf<Loop> make_loop(const RobotHandle& robot, const DriveSetup& drive, double cycle,
                         int silent_cycles, double speed, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high, std::optional<int> processor) {
  if (!(cycle >= 1e-4) || !(cycle <= 1.0)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "cycle is " + std::to_string(cycle) + " s; allowed are 0.0001 s to 1 s.");
  }
  const int joints = robot.robot->joints();
  LoopOptions options;
  options.cycle = std::chrono::nanoseconds(std::llround(cycle * 1e9));
  options.guard = guard_of(robot, speed, low, high);
  options.guard.silent_cycles = silent_cycles;
  options.processor = processor;
  DriveLinks links;
  const Release release;
  auto loop = std::make_shared<Loop>(make_drive(drive, joints, options.cycle, links),
                                     robot.robot->limits(), options);
  return {std::move(loop), joints, std::move(links)};
}

/// @throws MotionError(kBadArgument) where the drive has no such thing
template <typename Link>
Link& simulated(const std::shared_ptr<Link>& link, const char* what) {
  if (link == nullptr) {
    throw MotionError(ErrorCode::kBadArgument,
                      std::string("Only a simulated drive has ") + what + " that a script moves.",
                      {"Connect to a simulated arm: viapoint.connect(\"sim://...\")."});
  }
  return *link;
}

using Bits = Eigen::Matrix<std::uint64_t, Eigen::Dynamic, 1>;
using Stamps = Eigen::Matrix<std::int64_t, Eigen::Dynamic, 1>;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Cycle, stamp, joints, inputs and outputs, a row a cycle.
std::tuple<Bits, Stamps, Rows, Bits, Bits> arrays_of(const std::vector<ObservedCycle>& cycles,
                                                     int joints) {
  const auto count = static_cast<Eigen::Index>(cycles.size());
  std::tuple<Bits, Stamps, Rows, Bits, Bits> out{Bits(count), Stamps(count), Rows(count, joints),
                                                 Bits(count), Bits(count)};
  auto& [number, stamp, q, inputs, outputs] = out;
  for (Eigen::Index k = 0; k < count; ++k) {
    const ObservedCycle& one = cycles[static_cast<std::size_t>(k)];
    number[k] = one.cycle;
    stamp[k] = one.stamp;
    q.row(k) = one.q.transpose();
    inputs[k] = one.inputs;
    outputs[k] = one.outputs;
  }
  return out;
}

/// What both loops have.
template <typename Loop>
py::class_<HandleOf<Loop>> bind_loop(py::module_& m, const char* name, const char* doc) {
  using Handle = HandleOf<Loop>;
  py::class_<Handle> loop(m, name, doc);
  loop.def(py::init(&make_loop<Loop>), py::arg("robot"), py::arg("drive"), py::kw_only(),
           py::arg("cycle"), py::arg("silent_cycles"), py::arg("tool_speed"), py::arg("box_min"),
           py::arg("box_max"), py::arg("processor") = py::none())
      .def(
          "run",
          [](const Handle& l, const MotionHandle& motion) {
            const std::shared_ptr<Loop> open = l.open();
            const Release release;
            return JobHandle{open->run(motion.trajectory), l.joints};
          },
          py::arg("motion"), py::keep_alive<0, 1>())
      .def(
          "jog",
          [](const Handle& l, const Vector& velocity) {
            const std::shared_ptr<Loop> open = l.open();
            const JointVector wished = joints_from(velocity, "velocity", l.joints);
            const Release release;
            open->jog(wished);
          },
          py::arg("velocity"), "Joint velocities for the next 250 ms.")
      .def_property_readonly("inputs", [](const Handle& l) { return l.open()->measured().inputs; })
      .def(
          "set_inputs",
          [](const Handle& l, std::uint64_t changed, std::uint64_t on) {
            std::atomic<std::uint64_t>& inputs = simulated(l.links.inputs, "inputs");
            std::uint64_t present = inputs.load();
            while (!inputs.compare_exchange_weak(present, (present & ~changed) | on)) {
            }
          },
          py::arg("changed"), py::arg("on"), "Switch inputs of the simulated drive, bit by bit.")
      .def_property_readonly("outputs",
                             [](const Handle& l) { return l.open()->newest_cycle().outputs; })
      .def(
          "switch_outputs",
          [](const Handle& l, std::uint64_t changed, std::uint64_t on) {
            l.open()->require_power();
            l.open()->switch_outputs(changed, on);
          },
          py::arg("changed"), py::arg("on"), "Switch outputs by hand from the next cycle on.")
      .def(
          "guide",
          [](const Handle& l, const std::vector<Vector>& positions) {
            const std::shared_ptr<Loop> open = l.open();
            std::vector<JointVector> way;
            way.reserve(positions.size());
            for (const Vector& q : positions) way.push_back(joints_from(q, "q", l.joints));
            GuidingHand& hand = simulated(l.links.hand, "an arm");
            const Release release;
            open->admit_hand([&](const Measurement& /*now*/) { hand.guide(std::move(way)); });
          },
          py::arg("positions"), "A hand takes the simulated arm there, a position a cycle.")
      .def(
          "let_go", [](const Handle& l) { simulated(l.links.hand, "an arm").let_go(); },
          "The hand lets go of the simulated arm.")
      .def_property_readonly("guided", [](const Handle& l) { return l.open()->guided(); })
      .def_property_readonly("newest_cycle",
                             [](const Handle& l) { return l.open()->newest_cycle().cycle; })
      .def(
          "observed",
          [](const Handle& l, std::uint64_t from, std::size_t most) {
            return arrays_of(l.open()->observed(from, most), l.joints);
          },
          py::arg("from_cycle"), py::arg("most"),
          "Of cycles that are still kept: numbers, stamps [ns], joints (k, n), inputs, outputs.")
      .def_property_readonly("datagrams",
                             [](const Handle& l) {
                               if (l.links.traffic != nullptr) return counts_of(*l.links.traffic);
                               return py::typing::Dict<py::str, py::int_>();
                             })
      .def_property_readonly("jogging", [](const Handle& l) { return l.open()->jogging(); })
      .def_property_readonly("jog_block", [](const Handle& l) { return l.open()->jog_block(); })
      .def_property(
          "override", [](const Handle& l) { return l.open()->override_share(); },
          [](const Handle& l, double share) { l.open()->set_override(share); })
      .def_property_readonly("measured",
                             [](const Handle& l) { return Vector(l.open()->measured().q); })
      .def_property_readonly("position",
                             [](const Handle& l) { return Vector(l.open()->position()); })
      .def_property_readonly("busy", [](const Handle& l) { return l.open()->busy(); })
      .def_property_readonly("fault", [](const Handle& l) { return l.open()->fault(); })
      .def("fault_cycles",
           [](const Handle& l) { return LogHandle{l.open()->fault_cycles(), l.joints}; })
      .def_property_readonly("is_open", [](const Handle& l) { return l.loop != nullptr; })
      .def("close", &Handle::close);
  return loop;
}

/// @param values the share of an override, the velocities of a jog, an input and its value
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
  if (kind == "input" && values.size() == 2) {
    return {time, Kind::kInput, values[1], {}, static_cast<int>(values[0])};
  }
  if (kind == "pause") return {time, Kind::kPause, 0.0, {}};
  if (kind == "resume") return {time, Kind::kResume, 0.0, {}};
  if (kind == "stop") return {time, Kind::kStop, 0.0, {}};
  if (kind == "step") return {time, Kind::kStep, 0.0, {}};
  if (kind == "backward") return {time, Kind::kBackward, 0.0, {}};
  throw MotionError(ErrorCode::kBadArgument, "\"" + kind + "\" is no command.",
                    {"Use \"override\", \"pause\", \"resume\", \"stop\", \"step\", \"backward\", "
                     "\"jog\" or \"input\"."});
}

}  // namespace

void bind_realtime(py::module_& m) {
  m.attr("CYCLE") = std::chrono::duration<double>(LoopOptions{}.cycle).count();
  bind_run(m);
  bind_drives(m);
  bind_loop<ControllerLoop>(m, "ControllerLoop", "The 2 ms loop over a drive.")
      .def_property_readonly("shortcomings",
                             [](const LoopHandle& l) { return l.open()->shortcomings(); });
  bind_loop<VirtualLoop>(m, "VirtualLoop", "The same in virtual time.")
      .def(
          "pass_cycles",
          [](const VirtualLoopHandle& l, int count) { return l.open()->pass(count); },
          py::arg("count"), py::call_guard<Release>(),
          "Let cycles pass until a run ends or nothing moves; how many have passed.");
  bind_motion_stream(m);
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
}

}  // namespace viapoint::python
