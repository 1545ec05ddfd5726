#include "rtde/session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <sstream>

#include "problem_count.hpp"
#include "rtde/rtde_fixture.hpp"

namespace viapoint::rtde {
namespace {

constexpr double kCycle = 0.002;

/// What the usual client of Python asks for when it is told nothing, with its comma at the end.
constexpr std::string_view kUsualNames =
    "timestamp,target_q,target_qd,target_qdd,target_current,target_moment,actual_q,actual_qd,"
    "actual_current,joint_control_output,actual_TCP_pose,actual_TCP_speed,actual_TCP_force,"
    "target_TCP_pose,target_TCP_speed,actual_digital_input_bits,joint_temperatures,"
    "actual_execution_time,robot_mode,joint_mode,safety_mode,actual_tool_accelerometer,"
    "speed_scaling,target_speed_fraction,actual_momentum,actual_main_voltage,"
    "actual_robot_voltage,actual_robot_current,actual_joint_voltage,actual_digital_output_bits,"
    "runtime_state,standard_analog_input0,standard_analog_input1,standard_analog_output0,"
    "standard_analog_output1,robot_status_bits,safety_status_bits,ft_raw_wrench,payload,"
    "payload_cog,payload_inertia,output_int_register_2,output_int_register_19,"
    "output_double_register_12,output_double_register_47,";

const std::map<std::string, std::size_t, std::less<>> kBytesOf{
    {"UINT8", 1},  {"UINT32", 4},    {"INT32", 4},     {"UINT64", 8},
    {"DOUBLE", 8}, {"VECTOR3D", 24}, {"VECTOR6D", 48}, {"VECTOR6INT32", 24}};

std::vector<std::string> split(std::string_view list) {
  std::vector<std::string> words;
  std::istringstream stream{std::string(list)};
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

class RtdeSession : public testing::Test {
 public:
  /// Sends, and returns the answers.
  std::vector<Package> ask(std::string_view bytes) {
    const auto packages = packages_in(session.receive(bytes));
    EXPECT_TRUE(packages.has_value());
    return packages.value_or(std::vector<Package>{});
  }
  /// The one answer to what is sent.
  Package ask_once(std::string_view bytes) {
    const std::vector<Package> packages = ask(bytes);
    EXPECT_EQ(packages.size(), 1U);
    return packages.size() == 1 ? packages.front() : Package{};
  }
  void greet() { EXPECT_EQ(ask_once(greeting()), (Package{'V', "\1"})); }
  void start(double hertz, std::string_view names) {
    greet();
    EXPECT_EQ(ask_once(output_setup(hertz, names)).payload[0], 1);
    EXPECT_EQ(ask_once(package(PackageType::kStart, "")), (Package{'S', "\1"}));
  }

  ShownArm arm;
  Session session{arm, kCycle};
};

TEST_F(RtdeSession, AgreesOnVersionTwoAndNoOther) {
  EXPECT_EQ(ask_once(package(PackageType::kProtocolVersion, {"\0\1", 2})),
            (Package{'V', Bytes(1, '\0')}));
  EXPECT_FALSE(session.has_greeted());
  greet();
  EXPECT_TRUE(session.has_greeted());
}

TEST_F(RtdeSession, SaysThatItIsOneOfThoseWithFiveHundredHertz) {
  Bytes version = ask_once(package(PackageType::kControllerVersion, "")).payload;
  ASSERT_EQ(version.size(), 16U);
  std::string_view rest = version;
  EXPECT_EQ(take<std::uint32_t>(rest), 5U);
}

TEST_F(RtdeSession, HasEveryVariableOfTheUsualRecipeAndSendsWhatItSaid) {
  start(500.0, kUsualNames);
  const Package reply = ask_once(output_setup(500.0, kUsualNames));
  const std::vector<std::string> types = split(std::string_view(reply.payload).substr(1));
  ASSERT_EQ(types.size(), split(kUsualNames).size());
  std::size_t bytes = 1;  // the recipe's number
  for (const std::string& type : types) {
    ASSERT_TRUE(kBytesOf.contains(type)) << type;
    bytes += kBytesOf.at(type);
  }
  ArmView view;
  view.cycle = arm.cycle;
  (void)ask_once(package(PackageType::kStart, ""));
  const auto packages = packages_in(session.data(view));
  ASSERT_TRUE(packages && packages->size() == 1);
  EXPECT_EQ(packages->front().type, 'U');
  EXPECT_EQ(packages->front().payload.size(), bytes);
}

TEST_F(RtdeSession, WritesTheValuesInTheOrderAskedFor) {
  start(500.0, "actual_digital_output_bits,target_q,runtime_state,timestamp");
  ArmView view;
  view.cycle = arm.cycle;
  view.time = 12.5;
  view.cycle.state = RunState::kRunning;
  view.cycle.outputs = 0x20005;
  for (int i = 0; i < 6; ++i) view.cycle.q[i] = 0.5 - i;
  const Bytes payload = packages_in(session.data(view))->front().payload;
  std::string_view rest = payload;
  EXPECT_EQ(take<std::uint8_t>(rest), 1U);
  EXPECT_EQ(take<std::uint64_t>(rest), 0x20005U);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(take<double>(rest), 0.5 - i);
  EXPECT_EQ(take<std::uint32_t>(rest), 2U);
  EXPECT_EQ(take<double>(rest), 12.5);
  EXPECT_TRUE(rest.empty());
}

TEST_F(RtdeSession, SaysWhatItHasNotAndDoesNotStart) {
  greet();
  EXPECT_EQ(ask_once(output_setup(125.0, "timestamp,colour,actual_q")),
            (Package{'O', Bytes(1, '\0') + "DOUBLE,NOT_FOUND,VECTOR6D"}));
  EXPECT_EQ(ask_once(package(PackageType::kStart, "")), (Package{'S', Bytes(1, '\0')}));
  EXPECT_FALSE(session.is_started());
  EXPECT_EQ(ask_once(input_setup("speed_slider_mask,output_int_register_1")),
            (Package{'I', Bytes(1, '\0') + "UINT32,NOT_FOUND"}));
}

TEST_F(RtdeSession, KeepsTheFrequencyAskedFor) {
  for (const double hertz : {1.0, 10.0, 125.0, 240.0, 500.0}) {
    start(hertz, "timestamp");
    ArmView view;
    view.cycle = arm.cycle;
    int count = 0;
    constexpr int kCycles = 10'000;
    for (int cycle = 0; cycle < kCycles; ++cycle) {
      // Woken up to a quarter of a cycle late.
      view.time = kCycle * (cycle + 0.25 * (cycle % 7) / 6.0);
      if (!session.is_due(view.time)) continue;
      (void)session.data(view);
      ++count;
    }
    EXPECT_NEAR(count, kCycles * kCycle * hertz, 1.0) << hertz;
  }
}

TEST_F(RtdeSession, MakesUpForNothing) {
  start(500.0, "timestamp");
  ArmView view;
  view.cycle = arm.cycle;
  ASSERT_TRUE(session.is_due(0.0));
  (void)session.data(view);
  view.time = 100.0;  // nothing was seen of the loop meanwhile
  ASSERT_TRUE(session.is_due(view.time));
  (void)session.data(view);
  EXPECT_FALSE(session.is_due(view.time));
}

TEST_F(RtdeSession, PausesWhatItSends) {
  start(500.0, "timestamp");
  EXPECT_TRUE(session.is_due(0.0));
  EXPECT_EQ(ask_once(package(PackageType::kPause, "")), (Package{'P', "\1"}));
  EXPECT_FALSE(session.is_due(1.0));
}

TEST_F(RtdeSession, TurnsTheSpeedOnlyByItsMask) {
  greet();
  EXPECT_EQ(ask_once(input_setup("input_int_register_23,speed_slider_mask,speed_slider_fraction,")),
            (Package{'I', "\1INT32,UINT32,DOUBLE"}));
  EXPECT_TRUE(ask(told(1, std::int32_t{22}, std::uint32_t{0}, 0.25)).empty());
  EXPECT_FALSE(arm.override_share.has_value());
  EXPECT_TRUE(ask(told(1, std::int32_t{22}, std::uint32_t{1}, 0.25)).empty());
  EXPECT_EQ(arm.override_share, 0.25);
  for (const double wrong : {-0.1, 1.5, std::nan(""), 1e300}) {
    EXPECT_EQ(ask_once(told(1, std::int32_t{22}, std::uint32_t{1}, wrong)).type, 'M');
  }
  EXPECT_EQ(arm.override_share, 0.25);
  EXPECT_FALSE(session.is_broken());
}

TEST_F(RtdeSession, SwitchesTheOutputsOfItsMasks) {
  greet();
  (void)ask_once(input_setup("standard_digital_output_mask,standard_digital_output"));
  (void)ask_once(input_setup("configurable_digital_output_mask,configurable_digital_output"));
  (void)ask_once(input_setup("tool_digital_output_mask,tool_digital_output"));
  (void)ask_once(input_setup("standard_digital_output_mask"));
  using Byte = std::uint8_t;
  EXPECT_TRUE(ask(told(1, Byte{0x0f}, Byte{0xff})).empty());
  EXPECT_EQ(arm.outputs, 0x0000fU);
  EXPECT_TRUE(ask(told(2, Byte{0x82}, Byte{0xff})).empty());
  EXPECT_EQ(arm.outputs, 0x0820fU);
  EXPECT_TRUE(ask(told(3, Byte{0xff}, Byte{0x02})).empty());
  EXPECT_EQ(arm.outputs, 0x2820fU);
  EXPECT_TRUE(ask(told(1, Byte{0x03}, Byte{0x02})).empty());
  EXPECT_EQ(arm.outputs, 0x2820eU);
  EXPECT_TRUE(ask(told(4, Byte{0xff})).empty()) << "a mask alone says neither on nor off";
  EXPECT_EQ(arm.outputs, 0x2820eU);
}

TEST_F(RtdeSession, EndsAtABreachOfTheProtocol) {
  const Bytes recipe = input_setup("speed_slider_mask");
  const auto refused = [](const Bytes& first, const Bytes& then) {
    ShownArm shown;
    Session other(shown, kCycle);
    (void)other.receive(first);
    const auto packages = packages_in(other.receive(then));
    const bool is_told = packages && !packages->empty() && packages->back().type == 'M';
    return other.is_broken() && is_told && other.receive(greeting()).empty();
  };
  EXPECT_TRUE(refused("", recipe)) << "no version yet";
  EXPECT_TRUE(refused(greeting(), {"\0\2U", 3})) << "shorter than its header";
  EXPECT_TRUE(refused(greeting(), {"\xff\xffU", 3})) << "longer than allowed";
  EXPECT_TRUE(refused(greeting(), {"\0\3?", 3})) << "no type";
  EXPECT_TRUE(refused(greeting(), package(PackageType::kProtocolVersion, "2")));
  EXPECT_TRUE(refused(greeting(), package(PackageType::kSetupOutputs, "timesta")));
  for (const double hertz : {0.0, -1.0, 501.0, std::nan("")}) {
    EXPECT_TRUE(refused(greeting(), output_setup(hertz, "timestamp"))) << hertz;
  }
  EXPECT_TRUE(refused(greeting(), output_setup(500.0, "")));
  EXPECT_TRUE(refused(greeting(), output_setup(500.0, Bytes(kMostVariables + 2, ','))));
  EXPECT_TRUE(refused(greeting(), input_setup(",")));
  EXPECT_TRUE(refused(greeting() + recipe, told(2, std::uint32_t{1})));
  EXPECT_TRUE(refused(greeting() + recipe, told(0, std::uint32_t{1})));
  EXPECT_TRUE(refused(greeting() + recipe, told(1, std::uint8_t{1})));
  EXPECT_TRUE(refused(greeting() + recipe, package(PackageType::kData, "")));
  Bytes many = greeting();
  for (std::size_t i = 0; i < kMostInputRecipes; ++i) many += recipe;
  EXPECT_TRUE(refused(many, recipe));
}

/// What a client might send, whole or spoilt.
Bytes random_message(std::mt19937_64& random) {
  const auto below = [&random](std::uint64_t bound) { return random() % bound; };
  static const std::vector<std::string> names = split(std::string(kUsualNames) +
                                                      "speed_slider_mask,speed_slider_fraction,"
                                                      "standard_digital_output_mask,nothing,,x");
  Bytes list;
  for (std::uint64_t i = below(5); i > 0; --i) list += names[below(names.size())] + ',';
  Bytes bytes;
  switch (below(8)) {
    case 0:
      bytes = output_setup(static_cast<double>(1 + below(500)), list);
      break;
    case 1:
      bytes = input_setup("speed_slider_mask,speed_slider_fraction");
      break;
    case 2:
      bytes = input_setup(list);
      break;
    case 3:
      bytes = told(1, static_cast<std::uint32_t>(below(2)), std::bit_cast<double>(random()));
      break;
    case 4:
      bytes = package(PackageType::kStart, "");
      break;
    case 5:
      bytes = greeting();
      break;
    case 6:
      bytes = package(PackageType::kPause, "");
      break;
    default:
      for (std::uint64_t i = below(40); i > 0; --i) bytes.push_back(static_cast<char>(random()));
  }
  if (below(4) == 0 && !bytes.empty()) bytes[below(bytes.size())] = static_cast<char>(random());
  if (below(16) == 0) bytes.resize(below(bytes.size() + 1));
  return bytes;
}

TEST(RtdeSessionAlone, AnswersRubbishInOrderAndBounded) {
  std::uint64_t messages = 0;
  for (std::uint64_t seed = 0; messages < 100'000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    ShownArm arm, arm_by_bytes;
    Session whole(arm, kCycle), by_bytes(arm_by_bytes, kCycle);
    ArmView view;
    view.cycle = arm.cycle;
    Bytes first = seed % 4 == 0 ? Bytes{} : greeting();
    for (int i = 0; i < 50 && !whole.is_broken(); ++i, ++messages) {
      const Bytes message = first + random_message(random);
      first.clear();
      const Bytes answers = whole.receive(message);
      Bytes same;
      for (const char byte : message) same += by_bytes.receive({&byte, 1});
      ASSERT_EQ(answers, same);
      const auto packages = packages_in(answers);
      ASSERT_TRUE(packages.has_value());
      ASSERT_LE(answers.size(), 3 * kMostPackageBytes);
      if (arm.override_share) {
        ASSERT_TRUE(*arm.override_share >= 0.0 && *arm.override_share <= 1.0);
      }
      if (whole.is_started()) {
        ASSERT_TRUE(packages_in(whole.data(view)).has_value());
      }
      ASSERT_TRUE(!whole.is_broken() || !whole.is_started());
    }
  }
}

}  // namespace
}  // namespace viapoint::rtde
