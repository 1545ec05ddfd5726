/// @file
/// What crosses the wire, in our types and in those of proto/viapoint/controller.proto.
#pragma once

#include <google/protobuf/repeated_field.h>
#include <grpcpp/support/status.h>

#include <span>
#include <vector>

#include "viapoint/controller.pb.h"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/remote/arm_host.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::controller {

using Doubles = google::protobuf::RepeatedField<double>;

/// One value a joint. @throws MotionError(kBadArgument) unless there are `joints`, finite
[[nodiscard]] JointVector joints_of(const Doubles& values, const char* name, int joints);
/// Row by row. @throws MotionError(kBadArgument) unless they are whole rows of `joints`, finite
[[nodiscard]] std::vector<JointVector> rows_of(const Doubles& values, const char* name, int joints);
/// @throws MotionError(kBadArgument) naming the first piece that is none for so many joints
[[nodiscard]] std::vector<TrajectoryPiece> pieces_of(
    const google::protobuf::RepeatedPtrField<v1::Piece>& pieces, int joints);
/// @throws MotionError(kBadArgument) for a wish that is unknown
[[nodiscard]] Steering steering_of(v1::SteerRequest::Wish wish);

/// @throws MotionError(kBadArgument) for a wish that an input cannot make
[[nodiscard]] InputReaction reaction_of(int input, bool value, v1::SteerRequest::Wish wish);

/// @throws MotionError(kBadArgument) for other than 16 finite values a change
[[nodiscard]] std::vector<ToolChange> tools_of(const v1::ToolsPart& part);
[[nodiscard]] v1::Problem wire_of(const Problem& problem);
[[nodiscard]] v1::HandOver wire_of(const HandOver& hand_over);
[[nodiscard]] v1::ArmState wire_of(const HostStatus& status);
[[nodiscard]] v1::RunReport wire_of(const RunReport& report);
[[nodiscard]] v1::ToolsPart wire_of(const std::vector<ToolChange>& changes);
[[nodiscard]] v1::CyclesPart wire_of(std::span<const ObservedCycle> cycles);
[[nodiscard]] v1::LogPart wire_of(std::span<const LogRecord> records);

/// The status that tells a client of a refusal.
[[nodiscard]] grpc::Status status_of(const Problem& problem);

}  // namespace viapoint::controller
