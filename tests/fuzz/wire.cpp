#include "controller/wire.hpp"

#include <google/protobuf/stubs/logging.h>

#include <memory>
#include <string>
#include <vector>

#include "cpp/trajectory/trajectory_fixtures.hpp"
#include "fuzz/broken_promise.hpp"
#include "fuzz/targets.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/virtual_loop.hpp"

namespace viapoint::fuzz {
namespace {

constexpr int kJoints = 2;
/// Enough of a run to see that it begins well.
constexpr int kCycles = 300;

JointLimits limits() { return testing::uniform_limits(kJoints, 3.0, 2.0, 20.0, 200.0); }

/// As the controller does: what it takes it proves, and what it has proven it runs.
void run(const v1::AddPiecesRequest& request) {
  auto motion = std::make_shared<const Trajectory>(controller::pieces_of(request.pieces(), kJoints),
                                                   limits());
  promise(motion->duration() <= Trajectory::kMostDuration, "a motion without an end");
  const JointVector start = motion->at(0.0).q;
  VirtualLoop loop(std::make_unique<SimulatedDrive>(start), limits());
  const std::shared_ptr<Job> job = loop.run(motion);
  loop.pass(kCycles);
  promise(loop.fault().empty(), "the guard stops a motion that was admitted: " + loop.fault());
}

template <typename Message>
[[nodiscard]] Message parsed(std::string_view bytes, bool& is_one) {
  Message message;
  is_one = message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
  return message;
}

}  // namespace

void wire(std::string_view bytes) {
  if (bytes.empty()) return;
  const char kind = bytes.front();
  bytes.remove_prefix(1);
  bool is_one = false;
  const google::protobuf::LogSilencer quiet;  // it tells of every text that is none
  try {
    if (kind == 'j') {
      const auto jog = parsed<v1::JogRequest>(bytes, is_one);
      if (!is_one) return;
      const JointVector velocity = controller::joints_of(jog.velocity(), "velocity", kJoints);
      promise(velocity.allFinite(), "a jog that is not finite");
      admit_jog(velocity, limits());
    } else if (kind == 's') {
      const auto steer = parsed<v1::SteerRequest>(bytes, is_one);
      if (is_one) static_cast<void>(controller::steering_of(steer.wish()));
    } else if (kind == 'g') {
      const auto guide = parsed<v1::GuideRequest>(bytes, is_one);
      if (!is_one) return;
      for (const JointVector& row : controller::rows_of(guide.positions(), "positions", kJoints)) {
        promise(row.size() == kJoints && row.allFinite(), "a hand that is nowhere");
      }
    } else if (kind == 't') {
      const auto told = parsed<v1::AddToolsRequest>(bytes, is_one);
      if (!is_one) return;
      const std::vector<ToolChange> taken = controller::tools_of(told.tools());
      const std::vector<ToolChange> again = controller::tools_of(controller::wire_of(taken));
      promise(again.size() == taken.size(), "tools that change on their way");
    } else if (kind == 'i') {
      const auto reaction = parsed<v1::OnInputRequest>(bytes, is_one);
      if (!is_one) return;
      const InputReaction taken =
          controller::reaction_of(reaction.input(), reaction.value(), reaction.wish());
      promise(taken.input >= -1 && taken.input < kDigitalInputs, "a reaction to no input");
    } else {
      const auto pieces = parsed<v1::AddPiecesRequest>(bytes, is_one);
      if (is_one) run(pieces);
    }
  } catch (const MotionError& error) {
    promise(!error.problem().message.empty(), "a refusal without words");
  }
}

}  // namespace viapoint::fuzz
