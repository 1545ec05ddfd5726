#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <type_traits>

#include "rtde/variables.hpp"

namespace viapoint::rtde {
namespace {

// What the numbers of the protocol mean, as far as they are used here.
enum class Runtime : std::uint32_t { kStopping, kStopped, kPlaying, kPausing, kPaused, kResuming };
constexpr std::int32_t kRobotPowerOff = 3, kRobotRunning = 7;
constexpr std::int32_t kJointPowerOff = 239, kJointFault = 252, kJointRunning = 253;
constexpr std::int32_t kSafetyNormal = 1, kSafetyProtectiveStop = 3;
constexpr std::uint32_t kPowerOnBit = 1U << 0, kProgramRunningBit = 1U << 1;
constexpr std::uint32_t kNormalBit = 1U << 0, kProtectiveStopBit = 1U << 2,
                        kStoppedForSafetyBit = 1U << 10;

Runtime runtime_of(RunState state) {
  switch (state) {
    case RunState::kRunning:
    case RunState::kWaiting:
      return Runtime::kPlaying;
    case RunState::kPausing:
      return Runtime::kPausing;
    case RunState::kPaused:
      return Runtime::kPaused;
    case RunState::kReturning:
      return Runtime::kResuming;
    case RunState::kStopping:
      return Runtime::kStopping;
    case RunState::kIdle:
    case RunState::kStopped:
    case RunState::kFinished:
    case RunState::kFault:
    case RunState::kJogging:
      break;
  }
  return Runtime::kStopped;
}

bool failed(const ArmView& view) { return view.cycle.state == RunState::kFault; }

std::int32_t safety_of(const ArmView& view) {
  return failed(view) ? kSafetyProtectiveStop : kSafetyNormal;
}

std::uint32_t status_of(const ArmView& view) {
  const bool runs = runtime_of(view.cycle.state) != Runtime::kStopped;
  return (view.has_power ? kPowerOnBit : 0U) | (runs ? kProgramRunningBit : 0U);
}

std::int32_t joint_mode_of(const ArmView& view) {
  if (failed(view)) return kJointFault;
  return view.has_power ? kJointRunning : kJointPowerOff;
}

std::int32_t robot_mode_of(const ArmView& view) {
  return view.has_power ? kRobotRunning : kRobotPowerOff;
}

std::uint32_t runtime_state_of(const ArmView& view) {
  return static_cast<std::uint32_t>(runtime_of(view.cycle.state));
}

std::uint32_t safety_bits_of(const ArmView& view) {
  return failed(view) ? kProtectiveStopBit | kStoppedForSafetyBit : kNormalBit;
}

/// How far the motion is from the speed that the slider asks for: the two multiplied are its rate.
double scaling_of(const ArmView& view) {
  const double share = view.cycle.override_share;
  return share > 0.0 ? std::abs(view.cycle.rate) / share : 0.0;
}

template <typename T, int Count>
void put_zeros(const ArmView& /*view*/, Bytes& bytes) {
  for (int i = 0; i < Count; ++i) put(bytes, T{});
}
constexpr auto kZero = &put_zeros<double, 1>;
constexpr auto kZero3 = &put_zeros<double, 3>;
constexpr auto kZero6 = &put_zeros<double, 6>;

/// Writes what `Of` finds in the view, a number or a vector.
template <auto Of>
void write(const ArmView& view, Bytes& bytes) {
  const auto value = Of(view);
  if constexpr (std::is_arithmetic_v<decltype(value)>) {
    put(bytes, value);
  } else {
    for (const double element : value) put(bytes, element);
  }
}

void write_joint_modes(const ArmView& view, Bytes& bytes) {
  for (int i = 0; i < kAxes; ++i) put(bytes, joint_mode_of(view));
}

// Plain members of the view.
double time_of(const ArmView& view) { return view.time; }
double slider_of(const ArmView& view) { return view.cycle.override_share; }
double rate_of(const ArmView& view) { return std::abs(view.cycle.rate); }
std::uint64_t inputs_of(const ArmView& view) { return view.cycle.measurement.inputs; }
std::uint64_t outputs_of(const ArmView& view) { return view.cycle.outputs; }
JointVector target_q(const ArmView& view) { return view.cycle.q; }
JointVector target_qd(const ArmView& view) { return view.cycle.qd; }
JointVector target_qdd(const ArmView& view) { return view.cycle.qdd; }
Vector6 target_tool(const ArmView& view) { return view.target_tool; }
Vector6 target_tool_speed(const ArmView& view) { return view.target_tool_speed; }
JointVector actual_q(const ArmView& view) { return view.cycle.measurement.q; }
Vector6 actual_qd(const ArmView& view) { return view.actual_qd; }
Vector6 actual_tool(const ArmView& view) { return view.actual_tool; }
Vector6 actual_tool_speed(const ArmView& view) { return view.actual_tool_speed; }

/// In the order of their names.
constexpr std::array kOutputs{
    OutputVariable{"actual_TCP_force", "VECTOR6D", kZero6},
    OutputVariable{"actual_TCP_pose", "VECTOR6D", &write<actual_tool>},
    OutputVariable{"actual_TCP_speed", "VECTOR6D", &write<actual_tool_speed>},
    OutputVariable{"actual_current", "VECTOR6D", kZero6},
    OutputVariable{"actual_digital_input_bits", "UINT64", &write<inputs_of>},
    OutputVariable{"actual_digital_output_bits", "UINT64", &write<outputs_of>},
    OutputVariable{"actual_execution_time", "DOUBLE", kZero},
    OutputVariable{"actual_joint_voltage", "VECTOR6D", kZero6},
    OutputVariable{"actual_main_voltage", "DOUBLE", kZero},
    OutputVariable{"actual_momentum", "DOUBLE", kZero},
    OutputVariable{"actual_q", "VECTOR6D", &write<actual_q>},
    OutputVariable{"actual_qd", "VECTOR6D", &write<actual_qd>},
    OutputVariable{"actual_robot_current", "DOUBLE", kZero},
    OutputVariable{"actual_robot_voltage", "DOUBLE", kZero},
    OutputVariable{"actual_tool_accelerometer", "VECTOR3D", kZero3},
    OutputVariable{"ft_raw_wrench", "VECTOR6D", kZero6},
    OutputVariable{"joint_control_output", "VECTOR6D", kZero6},
    OutputVariable{"joint_mode", "VECTOR6INT32", &write_joint_modes},
    OutputVariable{"joint_temperatures", "VECTOR6D", kZero6},
    OutputVariable{"payload", "DOUBLE", kZero},
    OutputVariable{"payload_cog", "VECTOR3D", kZero3},
    OutputVariable{"payload_inertia", "VECTOR6D", kZero6},
    OutputVariable{"robot_mode", "INT32", &write<robot_mode_of>},
    OutputVariable{"robot_status_bits", "UINT32", &write<status_of>},
    OutputVariable{"runtime_state", "UINT32", &write<runtime_state_of>},
    OutputVariable{"safety_mode", "INT32", &write<safety_of>},
    OutputVariable{"safety_status", "INT32", &write<safety_of>},
    OutputVariable{"safety_status_bits", "UINT32", &write<safety_bits_of>},
    OutputVariable{"speed_scaling", "DOUBLE", &write<scaling_of>},
    OutputVariable{"speed_scaling_combined", "DOUBLE", &write<rate_of>},
    OutputVariable{"standard_analog_input0", "DOUBLE", kZero},
    OutputVariable{"standard_analog_input1", "DOUBLE", kZero},
    OutputVariable{"standard_analog_output0", "DOUBLE", kZero},
    OutputVariable{"standard_analog_output1", "DOUBLE", kZero},
    OutputVariable{"target_TCP_pose", "VECTOR6D", &write<target_tool>},
    OutputVariable{"target_TCP_speed", "VECTOR6D", &write<target_tool_speed>},
    OutputVariable{"target_current", "VECTOR6D", kZero6},
    OutputVariable{"target_moment", "VECTOR6D", kZero6},
    OutputVariable{"target_q", "VECTOR6D", &write<target_q>},
    OutputVariable{"target_qd", "VECTOR6D", &write<target_qd>},
    OutputVariable{"target_qdd", "VECTOR6D", &write<target_qdd>},
    OutputVariable{"target_speed_fraction", "DOUBLE", &write<slider_of>},
    OutputVariable{"timestamp", "DOUBLE", &write<time_of>},
};
static_assert(std::is_sorted(kOutputs.begin(), kOutputs.end(),
                             [](const OutputVariable& a, const OutputVariable& b) {
                               return a.name < b.name;
                             }));

/// Registers that no program writes: clients ask for them, and read zero.
constexpr OutputVariable kIntRegister{"output_int_register_", "INT32", &put_zeros<std::int32_t, 1>};
constexpr OutputVariable kDoubleRegister{"output_double_register_", "DOUBLE", kZero};

}  // namespace

const OutputVariable* find_output(std::string_view name) {
  const auto* const found =
      std::lower_bound(kOutputs.begin(), kOutputs.end(), name,
                       [](const OutputVariable& variable, std::string_view wanted) {
                         return variable.name < wanted;
                       });
  if (found != kOutputs.end() && found->name == name) return found;
  for (const OutputVariable* family : {&kIntRegister, &kDoubleRegister}) {
    if (is_register(name, family->name)) return family;
  }
  return nullptr;
}

}  // namespace viapoint::rtde
