#include "controller/controller_service.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "controller/wire.hpp"
#include "viapoint/kinematics/robot_description.hpp"
#include "viapoint/remote/control_seat.hpp"

namespace viapoint::controller {
namespace {

constexpr std::size_t kMostName = 200;
constexpr std::size_t kMostRecords = 1000;

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

/// The problem goes with the status, for clients that want more than its text.
void tell(const Problem& problem, grpc::ServerContext& context) {
  context.AddTrailingMetadata("viapoint-problem-bin", wire_of(problem).SerializeAsString());
}

/// Runs a call; what it throws is its refusal.
template <typename Call>
grpc::Status answer(grpc::ServerContext* context, const Call& call) {
  try {
    call();
    return grpc::Status::OK;
  } catch (const NotInControl& error) {
    tell(error.problem(), *context);
    return {grpc::StatusCode::PERMISSION_DENIED, error.problem().describe()};
  } catch (const MotionError& error) {
    tell(error.problem(), *context);
    return status_of(error.problem());
  } catch (const std::exception& error) {
    spdlog::error("a call failed: {}", error.what());
    Problem problem;
    problem.code = ErrorCode::kInternal;
    problem.message = std::string("the controller could not answer: ") + error.what();
    tell(problem, *context);
    return status_of(problem);
  }
}

/// Text that people will read: bounded, and nothing in it that acts on a terminal.
std::string name_of(const std::string& name) {
  if (name.size() > kMostName) {
    throw MotionError(ErrorCode::kBadArgument, "a name has " + std::to_string(name.size()) +
                                                   " characters; allowed are " +
                                                   std::to_string(kMostName));
  }
  std::string shown = name;
  std::replace_if(
      shown.begin(), shown.end(),
      [](char letter) { return static_cast<unsigned char>(letter) < ' ' || letter == '\x7f'; },
      '?');
  return shown;
}

/// "0.1" of "0.1.0".
std::string major_and_minor(const std::string& version) {
  const std::size_t first = version.find('.');
  return first == std::string::npos ? version : version.substr(0, version.find('.', first + 1));
}

/// One that tells no version is not of this package, and answers for what it sends by itself.
void require_this_version(const std::string& version) {
  if (version.empty() || major_and_minor(version) == major_and_minor(VIAPOINT_VERSION)) return;
  throw MotionError(ErrorCode::kBadArgument,
                    "the script has viapoint " + name_of(version) + ", the controller " +
                        VIAPOINT_VERSION + "; the first two numbers have to be the same",
                    {"install the controller's version of the package where the script runs"});
}

void describe(Job& job, v1::RunState& reply) {
  try {
    // The log is complete only once a wait for the end comes back.
    reply.set_ended(job.wait(0.0));
  } catch (const MotionError& error) {
    reply.set_ended(true);
    *reply.mutable_fault() = wire_of(error.problem());
  }
  reply.set_state(to_string(job.state()));
  reply.set_nominal_time(job.nominal_time());
  reply.set_duration(job.duration());
  reply.set_move(job.move());
  reply.set_overruns(job.overruns());
}

}  // namespace

ControllerService::ControllerService(ArmHost& host, RobotPtr robot, std::chrono::nanoseconds cycle,
                                     std::chrono::nanoseconds heartbeat,
                                     std::shared_ptr<std::atomic<std::uint64_t>> inputs)
    : host_(host),
      robot_(std::move(robot)),
      cycle_(cycle),
      heartbeat_(heartbeat),
      inputs_(std::move(inputs)) {}

grpc::Status ControllerService::GetRobot(Context* context, const v1::GetRobotRequest* /*request*/,
                                         v1::RobotReply* reply) {
  return answer(context, [&] {
    reply->set_version(VIAPOINT_VERSION);
    reply->set_description(to_yaml(robot_->description()));
    reply->set_fingerprint(robot_->fingerprint());
    reply->set_cycle(seconds(cycle_));
    reply->set_heartbeat(seconds(heartbeat_));
  });
}

grpc::Status ControllerService::GetState(Context* context, const v1::GetStateRequest* /*request*/,
                                         v1::ArmState* reply) {
  return answer(context, [&] { *reply = wire_of(host_.status()); });
}

grpc::Status ControllerService::GetRun(Context* context, const v1::GetRunRequest* request,
                                       v1::RunState* reply) {
  return answer(context, [&] { describe(*host_.job(request->run()), *reply); });
}

grpc::Status ControllerService::GetReport(Context* context, const v1::GetReportRequest* request,
                                          v1::RunReport* reply) {
  return answer(context, [&] { *reply = wire_of(host_.job(request->run())->report()); });
}

grpc::Status ControllerService::GetLog(Context* context, const v1::GetLogRequest* request,
                                       v1::LogPart* reply) {
  return answer(context, [&] {
    const std::size_t count = std::min<std::size_t>(request->count(), kMostRecords);
    *reply = wire_of(host_.job(request->run())->log(request->from_cycle(), count));
  });
}

grpc::Status ControllerService::TakeControl(Context* context, const v1::TakeControlRequest* request,
                                            v1::Control* reply) {
  return answer(context, [&] {
    require_this_version(request->version());
    const std::string name = name_of(request->name());
    if (name.empty()) throw MotionError(ErrorCode::kBadArgument, "who asks gives no name");
    reply->set_token(host_.take_control(name));
    reply->set_heartbeat(seconds(heartbeat_));
    spdlog::info("\"{}\" has control ({})", name, context->peer());
  });
}

grpc::Status ControllerService::Beat(Context* context, const v1::BeatRequest* request,
                                     v1::BeatReply* /*reply*/) {
  return answer(context, [&] { host_.beat(request->token()); });
}

grpc::Status ControllerService::GiveUpControl(Context* context,
                                              const v1::GiveUpControlRequest* request,
                                              v1::GiveUpControlReply* /*reply*/) {
  return answer(context, [&] { host_.give_up_control(request->token()); });
}

grpc::Status ControllerService::AddPieces(Context* context, const v1::AddPiecesRequest* request,
                                          v1::AddPiecesReply* /*reply*/) {
  return answer(context, [&] {
    host_.add_pieces(request->token(), request->offset(),
                     pieces_of(request->pieces(), robot_->joints()));
  });
}

void ControllerService::require_robot(const std::string& fingerprint) const {
  if (fingerprint == robot_->fingerprint()) return;
  throw MotionError(ErrorCode::kBadArgument,
                    "the motion was planned for another robot (fingerprint " +
                        name_of(fingerprint) + "), the arm is \"" + robot_->name() + "\" (" +
                        robot_->fingerprint() + ")",
                    {"plan it for the robot of this arm: arm.robot"});
}

grpc::Status ControllerService::Run(Context* context, const v1::RunRequest* request,
                                    v1::RunReply* reply) {
  return answer(context, [&] {
    require_robot(request->fingerprint());
    reply->set_run(host_.run(request->token()));
  });
}

grpc::Status ControllerService::Follow(Context* context, const v1::RunRequest* request,
                                       v1::RunReply* reply) {
  return answer(context, [&] {
    require_robot(request->fingerprint());
    reply->set_run(host_.follow(request->token()));
  });
}

grpc::Status ControllerService::Lengthen(Context* context, const v1::LengthenRequest* request,
                                         v1::LengthenReply* /*reply*/) {
  return answer(context,
                [&] { host_.lengthen(request->token(), request->run(), request->leave()); });
}

grpc::Status ControllerService::GetHandOver(Context* context, const v1::GetHandOverRequest* request,
                                            v1::HandOver* reply) {
  return answer(context, [&] {
    *reply = wire_of(host_.hand_over(request->token(), request->run()));
    describe(*host_.job(request->run()), *reply->mutable_run());
  });
}

grpc::Status ControllerService::Close(Context* context, const v1::CloseRequest* request,
                                      v1::CloseReply* /*reply*/) {
  return answer(context, [&] { host_.close(request->token(), request->run()); });
}

grpc::Status ControllerService::OnInput(Context* context, const v1::OnInputRequest* request,
                                        v1::OnInputReply* /*reply*/) {
  return answer(context, [&] {
    host_.on_input(request->token(), request->run(),
                   reaction_of(request->input(), request->value(), request->wish()));
  });
}

grpc::Status ControllerService::SetInputs(Context* context, const v1::SetInputsRequest* request,
                                          v1::SetInputsReply* /*reply*/) {
  return answer(context, [&] {
    host_.require_control(request->token());
    if (inputs_ == nullptr) {
      throw MotionError(ErrorCode::kBusy, "the inputs are a real drive's",
                        {"switch what is wired to them"});
    }
    std::uint64_t present = inputs_->load();
    const auto switched = [&] {
      return (present & ~request->mask()) | (request->values() & request->mask());
    };
    while (!inputs_->compare_exchange_weak(present, switched())) {
    }
  });
}

grpc::Status ControllerService::Steer(Context* context, const v1::SteerRequest* request,
                                      v1::SteerReply* /*reply*/) {
  return answer(context, [&] {
    host_.steer(request->token(), request->run(), steering_of(request->wish()));
  });
}

grpc::Status ControllerService::SetOverride(Context* context, const v1::SetOverrideRequest* request,
                                            v1::SetOverrideReply* /*reply*/) {
  return answer(context, [&] { host_.set_override(request->token(), request->share()); });
}

grpc::Status ControllerService::Jog(Context* context, const v1::JogRequest* request,
                                    v1::JogReply* /*reply*/) {
  return answer(context, [&] {
    host_.jog(request->token(), joints_of(request->velocity(), "velocity", robot_->joints()));
  });
}

}  // namespace viapoint::controller
