/// @file
#pragma once

#include <grpcpp/server_context.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "viapoint/controller.grpc.pb.h"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/remote/arm_host.hpp"

namespace viapoint::controller {

/// Answers the calls of proto/viapoint/controller.proto out of an ArmHost. Threads: the server's.
class ControllerService final : public v1::Controller::Service {
 public:
  /// @param host outlives the service
  /// @param inputs of a simulated drive, bit i for input i; null where the drive is a real one
  ControllerService(ArmHost& host, RobotPtr robot, std::chrono::nanoseconds cycle,
                    std::chrono::nanoseconds heartbeat,
                    std::shared_ptr<std::atomic<std::uint64_t>> inputs);

  using Context = grpc::ServerContext;
  grpc::Status GetRobot(Context* context, const v1::GetRobotRequest* request,
                        v1::RobotReply* reply) override;
  grpc::Status GetState(Context* context, const v1::GetStateRequest* request,
                        v1::ArmState* reply) override;
  grpc::Status GetRun(Context* context, const v1::GetRunRequest* request,
                      v1::RunState* reply) override;
  grpc::Status GetReport(Context* context, const v1::GetReportRequest* request,
                         v1::RunReport* reply) override;
  grpc::Status GetLog(Context* context, const v1::GetLogRequest* request,
                      v1::LogPart* reply) override;
  grpc::Status TakeControl(Context* context, const v1::TakeControlRequest* request,
                           v1::Control* reply) override;
  grpc::Status Beat(Context* context, const v1::BeatRequest* request,
                    v1::BeatReply* reply) override;
  grpc::Status GiveUpControl(Context* context, const v1::GiveUpControlRequest* request,
                             v1::GiveUpControlReply* reply) override;
  grpc::Status AddPieces(Context* context, const v1::AddPiecesRequest* request,
                         v1::AddPiecesReply* reply) override;
  grpc::Status Run(Context* context, const v1::RunRequest* request, v1::RunReply* reply) override;
  grpc::Status Follow(Context* context, const v1::RunRequest* request,
                      v1::RunReply* reply) override;
  grpc::Status Lengthen(Context* context, const v1::LengthenRequest* request,
                        v1::LengthenReply* reply) override;
  grpc::Status GetHandOver(Context* context, const v1::GetHandOverRequest* request,
                           v1::HandOver* reply) override;
  grpc::Status Close(Context* context, const v1::CloseRequest* request,
                     v1::CloseReply* reply) override;
  grpc::Status OnInput(Context* context, const v1::OnInputRequest* request,
                       v1::OnInputReply* reply) override;
  grpc::Status SetInputs(Context* context, const v1::SetInputsRequest* request,
                         v1::SetInputsReply* reply) override;
  grpc::Status Steer(Context* context, const v1::SteerRequest* request,
                     v1::SteerReply* reply) override;
  grpc::Status SetOverride(Context* context, const v1::SetOverrideRequest* request,
                           v1::SetOverrideReply* reply) override;
  grpc::Status Jog(Context* context, const v1::JogRequest* request, v1::JogReply* reply) override;

 private:
  void require_robot(const std::string& fingerprint) const;

  ArmHost& host_;
  RobotPtr robot_;
  std::chrono::nanoseconds cycle_, heartbeat_;
  std::shared_ptr<std::atomic<std::uint64_t>> inputs_;
};

}  // namespace viapoint::controller
