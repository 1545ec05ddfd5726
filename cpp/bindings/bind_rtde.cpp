// RTDE clients of the loop in this process.
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "run_handles.hpp"
#include "viapoint/rtde/rtde_arm.hpp"
#include "viapoint/rtde/rtde_server.hpp"

namespace viapoint::python {
namespace {

/// The loop for as long as Python keeps it open; then its last cycle.
class OpenArm final : public RtdeArm {
 public:
  explicit OpenArm(const std::shared_ptr<ControllerLoop>& loop)
      : loop_(loop), last_(loop->newest_cycle()) {}

  [[nodiscard]] LoopCycle newest_cycle() override {
    if (const auto loop = loop_.lock()) last_ = loop->newest_cycle();
    return last_;
  }
  void set_override(double share) override {
    if (const auto loop = loop_.lock()) loop->set_override(share);
  }
  void switch_outputs(std::uint64_t mask, std::uint64_t values) override {
    if (const auto loop = loop_.lock()) loop->switch_outputs(mask, values);
  }

 private:
  std::weak_ptr<ControllerLoop> loop_;
  LoopCycle last_;
};

class RtdeService {
 public:
  RtdeService(const LoopHandle& loop, const RobotHandle& robot, const RtdeOptions& options)
      : arm_(std::make_unique<OpenArm>(loop.open())),
        server_(std::make_unique<RtdeServer>(
            *arm_, robot.robot->has_kinematics() ? robot.robot->forward() : ForwardKinematics(),
            options)) {}

  [[nodiscard]] int port() const { return server_ == nullptr ? 0 : server_->port(); }
  void close() {
    const py::gil_scoped_release release;
    server_.reset();
  }

 private:
  std::unique_ptr<OpenArm> arm_;
  std::unique_ptr<RtdeServer> server_;
};

}  // namespace

void bind_rtde(py::module_& m) {
  py::class_<RtdeService>(m, "RtdeService", "Serves RTDE clients until it is closed.")
      .def(py::init([](const LoopHandle& loop, const RobotHandle& robot, const std::string& address,
                       int port, bool other_machines, double cycle) {
             const auto period = std::chrono::nanoseconds(std::llround(cycle * 1e9));
             return std::make_unique<RtdeService>(
                 loop, robot, RtdeOptions{address, port, period, other_machines});
           }),
           py::arg("loop"), py::arg("robot"), py::arg("address"), py::arg("port"),
           py::arg("other_machines"), py::arg("cycle"))
      .def_property_readonly("port", &RtdeService::port)
      .def("close", &RtdeService::close);
}

}  // namespace viapoint::python
