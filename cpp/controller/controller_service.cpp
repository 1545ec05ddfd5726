#include "controller/controller_service.hpp"

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/proto_buffer_reader.h>
#include <grpcpp/support/slice.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <utility>

#include "controller/wire.hpp"
#include "viapoint/kinematics/robot_description.hpp"
#include "viapoint/remote/control_seat.hpp"

namespace viapoint::controller {
namespace {

constexpr const char* kService = "/viapoint.v1.Controller/";
constexpr std::size_t kMostName = 200;
constexpr std::size_t kMostRecords = 1000;
/// Of answers for clients to read: 128 of the largest, thousands of most.
constexpr UnreadBounds kUnread{
    .calls = 64, .patience = std::chrono::seconds(1), .bytes = 64U << 20};
/// A motion may take seconds to prove, a drive to enable.
constexpr int kBeatThreads = 1, kCommandThreads = 4, kLookThreads = 2;
constexpr std::size_t kMostWaiting = 128;  ///< calls of a lane

double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

template <typename Message>
Message message_of(const grpc::ByteBuffer& bytes) {
  Message message;
  grpc::ByteBuffer copy(bytes);  // of references; the reader wants to own them
  grpc::ProtoBufferReader reader(&copy);
  if (reader.status().ok() && message.ParseFromZeroCopyStream(&reader)) return message;
  throw MotionError(ErrorCode::kBadArgument,
                    "the bytes sent are no " + Message::descriptor()->name(),
                    {"use a client of the controller's version"});
}

template <typename Message>
grpc::ByteBuffer bytes_of(const Message& message) {
  const grpc::Slice slice(message.SerializeAsString());
  return {&slice, 1};
}

/// Text that people will read: bounded, and nothing in it that acts on a terminal.
std::string name_of(const std::string& name) {
  if (name.size() > kMostName) {
    throw MotionError(ErrorCode::kBadArgument, "a name has " + std::to_string(name.size()) +
                                                   " characters; allowed are " +
                                                   std::to_string(kMostName));
  }
  std::string shown = name;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto letter = static_cast<unsigned char>(shown[i]);
    const unsigned char before = i == 0 ? 0 : static_cast<unsigned char>(shown[i - 1]);
    // U+0080 to U+009F act on terminals, too: in UTF-8 they are 0xc2 and a second byte below 0xa0.
    const bool is_second = before == 0xc2 && letter >= 0x80 && letter < 0xa0;
    if (is_second) shown[i - 1] = '?';
    if (is_second || letter < ' ' || letter == 0x7f) shown[i] = '?';
  }
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
                                     std::chrono::nanoseconds heartbeat, SimulatedWorld world)
    : host_(host),
      robot_(std::move(robot)),
      cycle_(cycle),
      heartbeat_(heartbeat),
      inputs_(std::move(world.inputs)),
      hand_(std::move(world.hand)),
      calls_(kUnread),
      beats_(kBeatThreads, kMostWaiting),
      commands_(kCommandThreads, kMostWaiting),
      looks_(kLookThreads, kMostWaiting) {
  serve_all();
}

template <typename Request, typename Reply>
void ControllerService::serve(const std::string& method, CallLane& lane,
                              void (ControllerService::*call)(const Request&, Reply&)) {
  calls_.add(kService + method, lane,
             [this, call](const std::string& /*peer*/, const grpc::ByteBuffer& request) {
               Reply reply;
               (this->*call)(message_of<Request>(request), reply);
               return bytes_of(reply);
             });
}

void ControllerService::serve_all() {
  serve("GetRobot", looks_, &ControllerService::get_robot);
  serve("GetState", looks_, &ControllerService::get_state);
  serve("GetRun", looks_, &ControllerService::get_run);
  serve("GetReport", looks_, &ControllerService::get_report);
  serve("GetLog", looks_, &ControllerService::get_log);
  serve("GetTools", looks_, &ControllerService::get_tools);
  serve("GetFaultCycles", looks_, &ControllerService::get_fault_cycles);
  serve("GetCycles", looks_, &ControllerService::get_cycles);
  serve("Beat", beats_, &ControllerService::beat);
  serve("GiveUpControl", commands_, &ControllerService::give_up_control);
  serve("AddPieces", commands_, &ControllerService::add_pieces);
  serve("Run", commands_, &ControllerService::run);
  serve("Follow", commands_, &ControllerService::follow);
  serve("Lengthen", commands_, &ControllerService::lengthen);
  serve("GetHandOver", commands_, &ControllerService::get_hand_over);
  serve("Close", commands_, &ControllerService::close);
  serve("AddTools", commands_, &ControllerService::add_tools);
  serve("OnInput", commands_, &ControllerService::on_input);
  serve("SetInputs", commands_, &ControllerService::set_inputs);
  serve("SetOutputs", commands_, &ControllerService::set_outputs);
  serve("Steer", commands_, &ControllerService::steer);
  serve("SetOverride", commands_, &ControllerService::set_override);
  serve("Jog", commands_, &ControllerService::jog);
  serve("Guide", commands_, &ControllerService::guide);
  serve("LetGo", commands_, &ControllerService::let_go);
  calls_.add(std::string(kService) + "TakeControl", commands_,
             [this](const std::string& peer, const grpc::ByteBuffer& request) {
               v1::Control reply;
               take_control(peer, message_of<v1::TakeControlRequest>(request), reply);
               return bytes_of(reply);
             });
}

void ControllerService::get_robot(const v1::GetRobotRequest& /*request*/, v1::RobotReply& reply) {
  reply.set_version(VIAPOINT_VERSION);
  reply.set_description(to_yaml(robot_->description()));
  reply.set_fingerprint(robot_->fingerprint());
  reply.set_cycle(seconds(cycle_));
  reply.set_heartbeat(seconds(heartbeat_));
}

void ControllerService::get_state(const v1::GetStateRequest& /*request*/, v1::ArmState& reply) {
  reply = wire_of(host_.status());
}

void ControllerService::get_cycles(const v1::GetCyclesRequest& request, v1::CyclesPart& reply) {
  const std::size_t count = std::min<std::size_t>(request.count(), kMostRecords);
  reply = wire_of(host_.observed(request.from_cycle(), count));
}

void ControllerService::get_tools(const v1::GetToolsRequest& request, v1::ToolsPart& reply) {
  const std::size_t count = std::min<std::size_t>(request.count(), kMostRecords);
  reply = wire_of(host_.tools(request.run(), request.offset(), count));
}

void ControllerService::get_fault_cycles(const v1::GetFaultCyclesRequest& /*request*/,
                                         v1::LogPart& reply) {
  reply = wire_of(host_.fault_cycles());
}

void ControllerService::get_run(const v1::GetRunRequest& request, v1::RunState& reply) {
  describe(*host_.job(request.run()), reply);
}

void ControllerService::get_report(const v1::GetReportRequest& request, v1::RunReport& reply) {
  reply = wire_of(host_.job(request.run())->report());
}

void ControllerService::get_log(const v1::GetLogRequest& request, v1::LogPart& reply) {
  const std::size_t count = std::min<std::size_t>(request.count(), kMostRecords);
  reply = wire_of(host_.job(request.run())->log(request.from_cycle(), count));
}

void ControllerService::take_control(const std::string& peer, const v1::TakeControlRequest& request,
                                     v1::Control& reply) {
  require_this_version(request.version());
  const std::string name = name_of(request.name());
  if (name.empty()) throw MotionError(ErrorCode::kBadArgument, "who asks gives no name");
  reply.set_token(host_.take_control(name));
  reply.set_heartbeat(seconds(heartbeat_));
  spdlog::info("\"{}\" has control ({})", name, peer);
}

void ControllerService::beat(const v1::BeatRequest& request, v1::BeatReply& /*reply*/) {
  host_.beat(request.token());
}

void ControllerService::give_up_control(const v1::GiveUpControlRequest& request,
                                        v1::GiveUpControlReply& /*reply*/) {
  host_.give_up_control(request.token());
}

void ControllerService::add_pieces(const v1::AddPiecesRequest& request,
                                   v1::AddPiecesReply& /*reply*/) {
  host_.add_pieces(request.token(), request.offset(),
                   pieces_of(request.pieces(), robot_->joints()));
}

void ControllerService::require_robot(const std::string& fingerprint) const {
  if (fingerprint == robot_->fingerprint()) return;
  throw MotionError(ErrorCode::kBadArgument,
                    "the motion was planned for another robot (fingerprint " +
                        name_of(fingerprint) + "), the arm is \"" + robot_->name() + "\" (" +
                        robot_->fingerprint() + ")",
                    {"plan it for the robot of this arm: arm.robot"});
}

void ControllerService::run(const v1::RunRequest& request, v1::RunReply& reply) {
  require_robot(request.fingerprint());
  reply.set_run(host_.run(request.token()));
}

void ControllerService::follow(const v1::RunRequest& request, v1::RunReply& reply) {
  require_robot(request.fingerprint());
  reply.set_run(host_.follow(request.token()));
}

void ControllerService::lengthen(const v1::LengthenRequest& request, v1::LengthenReply& /*reply*/) {
  host_.lengthen(request.token(), request.run(), request.leave());
}

void ControllerService::get_hand_over(const v1::GetHandOverRequest& request, v1::HandOver& reply) {
  reply = wire_of(host_.hand_over(request.token(), request.run()));
  describe(*host_.job(request.run()), *reply.mutable_run());
}

void ControllerService::close(const v1::CloseRequest& request, v1::CloseReply& /*reply*/) {
  host_.close(request.token(), request.run());
}

void ControllerService::add_tools(const v1::AddToolsRequest& request,
                                  v1::AddToolsReply& /*reply*/) {
  host_.add_tools(request.token(), request.run(), tools_of(request.tools()));
}

void ControllerService::on_input(const v1::OnInputRequest& request, v1::OnInputReply& /*reply*/) {
  host_.on_input(request.token(), request.run(),
                 reaction_of(request.input(), request.value(), request.wish()));
}

void ControllerService::set_inputs(const v1::SetInputsRequest& request,
                                   v1::SetInputsReply& /*reply*/) {
  host_.require_control(request.token());
  if (inputs_ == nullptr) {
    throw MotionError(ErrorCode::kBusy, "the inputs are a real drive's",
                      {"switch what is wired to them"});
  }
  std::uint64_t present = inputs_->load();
  const auto switched = [&] {
    return (present & ~request.mask()) | (request.values() & request.mask());
  };
  while (!inputs_->compare_exchange_weak(present, switched())) {
  }
}

void ControllerService::set_outputs(const v1::SetOutputsRequest& request,
                                    v1::SetOutputsReply& /*reply*/) {
  host_.require_power(request.token());
  host_.switch_outputs(request.mask(), request.values());
}

void ControllerService::steer(const v1::SteerRequest& request, v1::SteerReply& /*reply*/) {
  host_.steer(request.token(), request.run(), steering_of(request.wish()));
}

void ControllerService::set_override(const v1::SetOverrideRequest& request,
                                     v1::SetOverrideReply& /*reply*/) {
  host_.set_override(request.token(), request.share());
}

void ControllerService::jog(const v1::JogRequest& request, v1::JogReply& /*reply*/) {
  host_.jog(request.token(), joints_of(request.velocity(), "velocity", robot_->joints()));
}

void ControllerService::guide(const v1::GuideRequest& request, v1::GuideReply& /*reply*/) {
  host_.require_power(request.token());
  hand_.add(request.offset(), rows_of(request.positions(), "positions", robot_->joints()));
  if (request.begins()) hand_.begin(host_, request.token());
}

void ControllerService::let_go(const v1::LetGoRequest& request, v1::LetGoReply& /*reply*/) {
  host_.require_control(request.token());
  hand_.let_go();
}

}  // namespace viapoint::controller
