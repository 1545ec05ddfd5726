// The drives that a loop in Python's own process may have.
#include <string>
#include <utility>

#include "drive_setup.hpp"

namespace viapoint::python {
namespace {

using Vector = Eigen::VectorXd;

/// Makes the drive of each kind of setup.
struct Maker {
  int joints;
  std::chrono::nanoseconds cycle;
  DriveLinks& links;

  std::unique_ptr<Drive> operator()(const SimulatedSetup& setup) const {
    if (setup.start.size() != joints) {
      throw MotionError(ErrorCode::kBadArgument, "start has " + std::to_string(setup.start.size()) +
                                                     " values, the robot " +
                                                     std::to_string(joints) + " joints");
    }
    SimulatedDriveOptions options = setup.options;
    options.cycle = cycle;
    links.inputs = std::make_shared<std::atomic<std::uint64_t>>(0);
    links.hand = std::make_shared<GuidingHand>();
    return std::make_unique<SimulatedDrive>(setup.start, links.inputs, options, links.hand);
  }
  std::unique_ptr<Drive> operator()(UdpDriveOptions options) const {
    options.joints = joints;
    links.traffic = std::make_shared<UdpTraffic>();
    return std::make_unique<UdpDrive>(std::move(options), links.traffic);
  }
};

}  // namespace

std::unique_ptr<Drive> make_drive(const DriveSetup& setup, int joints,
                                  std::chrono::nanoseconds cycle, DriveLinks& links) {
  return std::visit(Maker{joints, cycle, links}, setup);
}

py::typing::Dict<py::str, py::int_> counts_of(const UdpTraffic& traffic) {
  py::typing::Dict<py::str, py::int_> counts;
  counts["sent"] = traffic.sent.load();
  counts["unsent"] = traffic.unsent.load();
  counts["answered"] = traffic.answered.load();
  counts["silent"] = traffic.silent.load();
  counts["wrong_size"] = traffic.wrong_size.load();
  counts["wrong_magic"] = traffic.wrong_magic.load();
  counts["wrong_version"] = traffic.wrong_version.load();
  counts["wrong_joints"] = traffic.wrong_joints.load();
  counts["not_finite"] = traffic.not_finite.load();
  counts["old"] = traffic.old.load();
  return counts;
}

void bind_drives(py::module_& m) {
  py::class_<SimulatedSetup>(m, "SimulatedSetup", "An arm simulated in this process.")
      .def(py::init([](const Vector& start, double lag, double resolution, double noise,
                       std::uint64_t seed) {
             SimulatedSetup setup{joints_from(start, "start"), {}};
             setup.options.lag = lag;
             setup.options.resolution = resolution;
             setup.options.noise = noise;
             setup.options.seed = seed;
             return setup;
           }),
           py::arg("start"), py::kw_only(), py::arg("lag") = 0.0, py::arg("resolution") = 0.0,
           py::arg("noise") = 0.0, py::arg("seed") = 0);
  py::class_<UdpDriveOptions>(m, "UdpSetup", "A device that takes setpoints over UDP.")
      .def(py::init([](std::string host, int port, double patience) {
             UdpDriveOptions options;
             options.host = std::move(host);
             options.port = port;
             options.patience =
                 std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * patience));
             return options;
           }),
           py::arg("host"), py::arg("port"), py::kw_only(), py::arg("patience"));
}

}  // namespace viapoint::python
