/// @file
#pragma once

#include <grpcpp/generic/async_generic_service.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "controller/call_lane.hpp"
#include "controller/call_table.hpp"
#include "controller/hand_motion.hpp"
#include "viapoint/controller.pb.h"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/remote/arm_host.hpp"

namespace viapoint::controller {

/// What a simulated drive is told by who plays the world; null where the drive is a real one.
struct SimulatedWorld {
  std::shared_ptr<std::atomic<std::uint64_t>> inputs;  ///< bit i for input i
  std::shared_ptr<GuidingHand> hand;
};

/// Answers the calls of proto/viapoint/controller.proto out of an ArmHost. Beats, commands, and
/// what anybody may ask have lanes of their own, so that neither a crowd that looks on nor a long
/// proof keeps the others waiting.
class ControllerService {
 public:
  /// @param host outlives the service
  ControllerService(ArmHost& host, RobotPtr robot, std::chrono::nanoseconds cycle,
                    std::chrono::nanoseconds heartbeat, SimulatedWorld world);

  /// For the server.
  [[nodiscard]] grpc::CallbackGenericService& calls() { return calls_; }

 private:
  template <typename Request, typename Reply>
  void serve(const std::string& method, CallLane& lane,
             void (ControllerService::*call)(const Request&, Reply&));
  void serve_all();

  // The calls, by their names in the proto file.
  void get_robot(const v1::GetRobotRequest& request, v1::RobotReply& reply);
  void get_state(const v1::GetStateRequest& request, v1::ArmState& reply);
  void get_run(const v1::GetRunRequest& request, v1::RunState& reply);
  void get_report(const v1::GetReportRequest& request, v1::RunReport& reply);
  void get_log(const v1::GetLogRequest& request, v1::LogPart& reply);
  void get_tools(const v1::GetToolsRequest& request, v1::ToolsPart& reply);
  void get_fault_cycles(const v1::GetFaultCyclesRequest& request, v1::LogPart& reply);
  void get_cycles(const v1::GetCyclesRequest& request, v1::CyclesPart& reply);
  void take_control(const std::string& peer, const v1::TakeControlRequest& request,
                    v1::Control& reply);
  void beat(const v1::BeatRequest& request, v1::BeatReply& reply);
  void give_up_control(const v1::GiveUpControlRequest& request, v1::GiveUpControlReply& reply);
  void add_pieces(const v1::AddPiecesRequest& request, v1::AddPiecesReply& reply);
  void run(const v1::RunRequest& request, v1::RunReply& reply);
  void follow(const v1::RunRequest& request, v1::RunReply& reply);
  void lengthen(const v1::LengthenRequest& request, v1::LengthenReply& reply);
  void get_hand_over(const v1::GetHandOverRequest& request, v1::HandOver& reply);
  void close(const v1::CloseRequest& request, v1::CloseReply& reply);
  void add_tools(const v1::AddToolsRequest& request, v1::AddToolsReply& reply);
  void on_input(const v1::OnInputRequest& request, v1::OnInputReply& reply);
  void set_inputs(const v1::SetInputsRequest& request, v1::SetInputsReply& reply);
  void set_outputs(const v1::SetOutputsRequest& request, v1::SetOutputsReply& reply);
  void steer(const v1::SteerRequest& request, v1::SteerReply& reply);
  void set_override(const v1::SetOverrideRequest& request, v1::SetOverrideReply& reply);
  void jog(const v1::JogRequest& request, v1::JogReply& reply);
  void guide(const v1::GuideRequest& request, v1::GuideReply& reply);
  void let_go(const v1::LetGoRequest& request, v1::LetGoReply& reply);
  void require_robot(const std::string& fingerprint) const;

  ArmHost& host_;
  RobotPtr robot_;
  std::chrono::nanoseconds cycle_, heartbeat_;
  std::shared_ptr<std::atomic<std::uint64_t>> inputs_;
  HandMotion hand_;
  CallTable calls_;
  CallLane beats_, commands_, looks_;
};

}  // namespace viapoint::controller
