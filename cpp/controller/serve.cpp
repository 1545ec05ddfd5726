#include "controller/serve.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "controller/config.hpp"
#include "controller/controller_service.hpp"
#include "controller/exit_code.hpp"
#include "controller/remote_server.hpp"
#include "controller/rtde_panel.hpp"
#include "controller/run_archive.hpp"
#include "controller/stop_signals.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/drives/udp_drive.hpp"
#include "viapoint/kinematics/robot_description.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/remote/arm_host.hpp"

namespace viapoint::controller {
namespace {

/// Memory is locked as a whole: stacks of the usual 8 MiB would all be taken at once.
constexpr std::size_t kStack = 512U << 10;

void make_threads_small() {
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) != 0) return;
  if (pthread_attr_setstacksize(&attributes, kStack) == 0) {
    pthread_setattr_default_np(&attributes);
  }
  pthread_attr_destroy(&attributes);
}

JointVector start_of(const Config& config, const RobotModel& robot) {
  if (config.start.size() == 0) return JointVector::Zero(robot.joints());
  if (config.start.size() != robot.joints()) {
    throw MotionError(ErrorCode::kFile, "start has " + std::to_string(config.start.size()) +
                                            " values, \"" + robot.name() + "\" has " +
                                            std::to_string(robot.joints()) + " joints");
  }
  for (int i = 0; i < robot.joints(); ++i) {
    const double least = robot.limits().position_min[i], most = robot.limits().position_max[i];
    if (config.start[i] >= least && config.start[i] <= most) continue;
    throw MotionError(ErrorCode::kFile, "start of joint " + std::to_string(i + 1) + " is " +
                                            number_text(config.start[i]) + "; allowed are " +
                                            number_text(least) + " to " + number_text(most));
  }
  return config.start;
}

/// @param start where a simulated arm stands
std::unique_ptr<Drive> drive_of(const Config& config, const JointVector& start,
                                const SimulatedWorld& world) {
  if (config.device) {
    UdpDriveOptions device = *config.device;
    device.joints = static_cast<int>(start.size());
    return std::make_unique<UdpDrive>(std::move(device));
  }
  SimulatedDriveOptions options = config.simulated;
  options.cycle = config.cycle;
  return std::make_unique<SimulatedDrive>(start, world.inputs, options, world.hand);
}

LoopOptions options_of(const Config& config, const RobotModel& robot) {
  LoopOptions options;
  options.cycle = config.cycle;
  options.guard = config.guard;
  options.processor = config.processor;
  options.keep_awake = config.keep_awake;
  if (robot.has_kinematics()) options.guard.kinematics = robot.forward();
  return options;
}

}  // namespace

int serve(const std::string& config_path) {
  const Config config = load_config(config_path);
  const RobotPtr robot = RobotModel::make(load_description(config.robot));
  const JointVector start = start_of(config, *robot);
  const LoopOptions options = options_of(config, *robot);
  make_threads_small();
  StopSignals signals;
  std::optional<RunArchive> archive;
  if (!config.logs.empty()) archive.emplace(config.logs);

  SimulatedWorld world;
  if (!config.device) {
    world.inputs = std::make_shared<std::atomic<std::uint64_t>>(0);
    world.hand = std::make_shared<GuidingHand>();
  }
  ArmHost host(
      robot->limits(),
      [&](const JointVector& rest) {
        return std::make_unique<ControllerLoop>(
            drive_of(config, rest.size() == 0 ? start : rest, world), robot->limits(), options);
      },
      config.heartbeat,
      [&](std::uint64_t number, const std::shared_ptr<Job>& job) {
        if (archive) archive->add(number, job);
      },
      [&] {
        if (world.hand) world.hand->let_go();
      });
  for (const std::string& line : host.status().shortcomings) spdlog::warn("{}", line);
  ControllerService service(host, robot, config.cycle, config.heartbeat, world);
  const RemoteServer server(service, config);
  spdlog::info("\"{}\" is served at {}:{}{}", robot->name(), config.host, server.port(),
               config.tls ? ", to clients with a certificate" : "");

  std::optional<RtdePanel> panel;
  if (config.rtde) {
    panel.emplace(host, *robot, *config.rtde, config.cycle);
    spdlog::info("RTDE is served at {} port {}", config.rtde->address, panel->port());
  }

  signals.wait();
  spdlog::info("stopping on the path");
  host.shut_down();
  return kFinished;
}

}  // namespace viapoint::controller
