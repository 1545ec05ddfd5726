#include "controller/wire.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "viapoint/core/number_text.hpp"

namespace viapoint::controller {
namespace {

constexpr int kPowers = 6;  ///< of a quintic

[[noreturn]] void refuse(const std::string& message) {
  throw MotionError(ErrorCode::kBadArgument, message, {"use a client of the same version"});
}

std::string count_of(int got, int expected) {
  return "has " + std::to_string(got) + " values; expected are " + std::to_string(expected);
}

TrajectoryPiece piece_of(const v1::Piece& piece, int joints, const std::string& name) {
  TrajectoryPiece out;
  if (piece.path_size() != kPowers * joints) {
    refuse(name + ": path " + count_of(piece.path_size(), kPowers * joints));
  }
  if (piece.timing_size() != kPowers) {
    refuse(name + ": timing " + count_of(piece.timing_size(), kPowers));
  }
  if (piece.outputs_size() > kMaxOutputsAPiece) {
    refuse(name + ": sets " + std::to_string(piece.outputs_size()) + " outputs; allowed are " +
           std::to_string(kMaxOutputsAPiece));
  }
  out.duration = piece.duration();
  out.joints = joints;
  out.move = piece.move();
  for (int k = 0; k < kPowers; ++k) {
    const auto power = static_cast<size_t>(k);
    out.timing[power] = piece.timing(k);
    for (int i = 0; i < joints; ++i) {
      out.path[power][static_cast<size_t>(i)] = piece.path(k * joints + i);
    }
  }
  for (const v1::OutputChange& change : piece.outputs()) {
    if (change.output() >= kDigitalOutputs) {
      refuse(name + ": sets output " + std::to_string(change.output()) + "; there are 0 to " +
             std::to_string(kDigitalOutputs - 1));
    }
    out.output[static_cast<size_t>(out.outputs++)] = {static_cast<std::int16_t>(change.output()),
                                                      change.value(), change.time()};
  }
  if (piece.has_wait()) {
    const v1::InputWait& wait = piece.wait();
    if (wait.input() >= kDigitalInputs) {
      refuse(name + ": waits for input " + std::to_string(wait.input()) + "; there are 0 to " +
             std::to_string(kDigitalInputs - 1));
    }
    out.wait.input = static_cast<std::int16_t>(wait.input());
    out.wait.value = wait.value();
    if (wait.has_timeout()) out.wait.timeout = wait.timeout();
  }
  return out;
}

void append(const JointVector& values, Eigen::Index joints, Doubles& to) {
  // A record without a value reads as NaN, as in Python's columns.
  for (Eigen::Index i = 0; i < joints; ++i) {
    to.Add(i < values.size() ? values[i] : std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace

JointVector joints_of(const Doubles& values, const char* name, int joints) {
  if (values.size() != joints) refuse(std::string(name) + ' ' + count_of(values.size(), joints));
  JointVector out(joints);
  for (int i = 0; i < joints; ++i) {
    if (!std::isfinite(values[i])) {
      refuse(std::string(name) + " of joint " + std::to_string(i + 1) + " is " +
             number_text(values[i]) + "; it must be finite");
    }
    out[i] = values[i];
  }
  return out;
}

std::vector<JointVector> rows_of(const Doubles& values, const char* name, int joints) {
  if (values.size() % joints != 0) {
    refuse(std::string(name) + " has " + std::to_string(values.size()) +
           " values; expected are whole rows of " + std::to_string(joints));
  }
  std::vector<JointVector> rows;
  for (int k = 0; k < values.size(); k += joints) {
    JointVector& row = rows.emplace_back(joints);
    for (int i = 0; i < joints; ++i) row[i] = values[k + i];
    if (!row.allFinite()) {
      refuse(std::string(name) + ": row " + std::to_string(k / joints) +
             " holds a value that is not finite");
    }
  }
  return rows;
}

std::vector<ToolChange> tools_of(const v1::ToolsPart& part) {
  constexpr int kValues = 16;
  if (part.tool_size() != kValues * part.move_size()) {
    refuse("tool " + count_of(part.tool_size(), kValues * part.move_size()));
  }
  std::vector<ToolChange> changes;
  for (int k = 0; k < part.move_size(); ++k) {
    ToolChange& change = changes.emplace_back();
    change.move = part.move(k);
    for (int i = 0; i < kValues; ++i) {
      const double value = part.tool(k * kValues + i);
      if (!std::isfinite(value)) refuse("tool " + std::to_string(k) + " is not finite");
      change.tool[static_cast<size_t>(i)] = value;
    }
  }
  return changes;
}

v1::ToolsPart wire_of(const std::vector<ToolChange>& changes) {
  v1::ToolsPart part;
  for (const ToolChange& change : changes) {
    part.add_move(change.move);
    for (const double value : change.tool) part.add_tool(value);
  }
  return part;
}

std::vector<TrajectoryPiece> pieces_of(const google::protobuf::RepeatedPtrField<v1::Piece>& pieces,
                                       int joints) {
  std::vector<TrajectoryPiece> out;
  out.reserve(static_cast<size_t>(pieces.size()));
  for (int i = 0; i < pieces.size(); ++i) {
    out.push_back(piece_of(pieces[i], joints, "piece " + std::to_string(i)));
  }
  return out;
}

Steering steering_of(v1::SteerRequest::Wish wish) {
  switch (wish) {
    case v1::SteerRequest::PAUSE:
      return Steering::kPause;
    case v1::SteerRequest::RESUME:
      return Steering::kResume;
    case v1::SteerRequest::STEP:
      return Steering::kStep;
    case v1::SteerRequest::BACKWARD:
      return Steering::kBackward;
    case v1::SteerRequest::STOP:
      return Steering::kStop;
    case v1::SteerRequest::STOP_AND_RELEASE:
      return Steering::kStopAndRelease;
    default:
      refuse("wish " + std::to_string(wish) + " is unknown");
  }
}

InputReaction reaction_of(int input, bool value, v1::SteerRequest::Wish wish) {
  if (input < -1 || input >= kDigitalInputs) {
    refuse("there is no input " + std::to_string(input) + "; inputs are 0 to " +
           std::to_string(kDigitalInputs - 1));
  }
  InputReaction reaction;
  reaction.input = static_cast<std::int16_t>(input);
  reaction.value = value;
  switch (wish) {
    case v1::SteerRequest::PAUSE:
      reaction.wish = Wish::kPause;
      return reaction;
    case v1::SteerRequest::RESUME:
      reaction.wish = Wish::kRun;
      return reaction;
    case v1::SteerRequest::STOP:
      reaction.wish = Wish::kStop;
      return reaction;
    default:
      refuse("an input cannot make wish " + std::to_string(wish) + "; it pauses, resumes or stops");
  }
}

v1::HandOver wire_of(const HandOver& hand_over) {
  v1::HandOver out;
  out.set_fate(hand_over.fate == LinkFate::kTaken     ? v1::HandOver::TAKEN
               : hand_over.fate == LinkFate::kTooLate ? v1::HandOver::TOO_LATE
                                                      : v1::HandOver::NOT_YET);
  out.set_earliest_leave(hand_over.earliest_leave);
  out.set_waited_cycles(hand_over.waited_cycles);
  return out;
}

v1::Problem wire_of(const Problem& problem) {
  v1::Problem out;
  out.set_code(std::string(to_string(problem.code)));
  out.set_message(problem.message);
  for (const std::string& way : problem.ways_out) out.add_ways_out(way);
  if (problem.move) out.set_move(*problem.move);
  out.set_file(problem.file);
  if (problem.line) out.set_line(*problem.line);
  if (problem.joint) out.set_joint(*problem.joint);
  if (problem.time) out.set_time(*problem.time);
  if (problem.share) out.set_share(*problem.share);
  if (problem.value) out.set_value(*problem.value);
  if (problem.limit) out.set_limit(*problem.limit);
  return out;
}

v1::ArmState wire_of(const HostStatus& status) {
  v1::ArmState out;
  append(status.setpoint, status.setpoint.size(), *out.mutable_setpoint());
  append(status.measured, status.measured.size(), *out.mutable_measured());
  out.set_override(status.override_share);
  out.set_busy(status.busy);
  out.set_jogging(status.jogging);
  out.set_jog_block(status.jog_block);
  out.set_fault(status.fault);
  for (const std::string& line : status.shortcomings) out.add_shortcomings(line);
  out.set_operator_(status.operator_name);
  out.set_control_loss(status.control_loss);
  out.set_run(status.run);
  out.set_stamp(status.stamp);
  out.set_inputs(status.inputs);
  out.set_outputs(status.outputs);
  out.set_cycle(status.cycle);
  out.set_guided(status.guided);
  return out;
}

v1::CyclesPart wire_of(std::span<const ObservedCycle> cycles) {
  v1::CyclesPart out;
  for (const ObservedCycle& one : cycles) {
    out.add_cycle(one.cycle);
    out.add_stamp(one.stamp);
    out.add_inputs(one.inputs);
    out.add_outputs(one.outputs);
    append(one.q, one.q.size(), *out.mutable_measured());
  }
  return out;
}

v1::RunReport wire_of(const RunReport& report) {
  v1::RunReport out;
  out.set_cycles(report.cycles);
  out.set_overruns(report.overruns);
  out.set_latency_p50(report.latency_p50);
  out.set_latency_p99(report.latency_p99);
  out.set_latency_max(report.latency_max);
  out.set_compute_p50(report.compute_p50);
  out.set_compute_p99(report.compute_p99);
  out.set_compute_max(report.compute_max);
  out.set_wall_time(report.wall_time);
  out.set_missed_cycles(report.missed_cycles);
  out.set_lost_records(report.lost_records);
  out.set_rested_cycles(report.rested_cycles);
  return out;
}

v1::LogPart wire_of(std::span<const LogRecord> records) {
  v1::LogPart out;
  for (const LogRecord& record : records) {
    const Eigen::Index joints = record.q.size();
    out.add_cycle(record.cycle);
    out.add_stamp(record.stamp);
    out.add_latency(record.latency);
    out.add_compute(record.compute);
    out.add_nominal_time(record.nominal_time);
    out.add_rate(record.rate);
    out.add_move(record.move);
    out.add_state(static_cast<std::uint32_t>(record.state));
    out.add_outputs(record.outputs);
    append(record.q, joints, *out.mutable_q());
    append(record.qd, joints, *out.mutable_qd());
    append(record.qdd, joints, *out.mutable_qdd());
    append(record.qddd, joints, *out.mutable_qddd());
    append(record.measured, joints, *out.mutable_measured());
  }
  return out;
}

grpc::Status status_of(const Problem& problem) {
  switch (problem.code) {
    case ErrorCode::kBadArgument:
      return {grpc::StatusCode::INVALID_ARGUMENT, problem.describe()};
    case ErrorCode::kInternal:
      return {grpc::StatusCode::INTERNAL, problem.describe()};
    default:
      return {grpc::StatusCode::FAILED_PRECONDITION, problem.describe()};
  }
}

}  // namespace viapoint::controller
