// Whatever clients call, in whatever order and from however many threads: each call is done or
// refused by name, and the arm keeps its limits and its path.
#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <thread>

#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/remote/arm_host.hpp"
#include "viapoint/remote/control_seat.hpp"

namespace viapoint {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kJoints = 2;
constexpr int kCalls = 400;
constexpr double kFar = 1.5;  ///< from 0 that a sound motion takes the joints [rad]

JointLimits limits_of_two() {
  JointLimits limits;
  limits.position_min = JointVector::Constant(kJoints, -2.0);
  limits.position_max = JointVector::Constant(kJoints, 2.0);
  limits.velocity = JointVector::Constant(kJoints, 5.0);
  limits.acceleration = JointVector::Constant(kJoints, 50.0);
  limits.jerk = JointVector::Constant(kJoints, 2000.0);
  return limits;
}

const JointLimits kLimits = limits_of_two();

class Caller {
 public:
  Caller(ArmHost& host, unsigned seed, std::string token)
      : host_(host), random_(seed), token_(std::move(token)) {}

  /// Returns how many calls were done, the others were refused.
  int call() {
    int done = 0;
    for (int k = 0; k < kCalls; ++k) {
      try {
        call_one();
        ++done;
      } catch (const MotionError& error) {
        EXPECT_FALSE(error.problem().message.empty());
        EXPECT_NE(error.code(), ErrorCode::kInternal) << error.what();
      }
      if (random_() % 4 == 0) std::this_thread::sleep_for(milliseconds(random_() % 16));
    }
    return done;
  }

 private:
  double wild() {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    constexpr std::array<double, 10> kWild = {0.0,  -0.0, 1e-320, -1.0, 1e300,
                                              kInf, NAN,  1.0,    0.5,  1e18};
    return kWild[random_() % kWild.size()];
  }
  double between(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  std::uint64_t run_number() {
    const std::uint64_t last = host_.status().run;
    return random_() % 8 == 0 ? random_() : last - random_() % 2;
  }
  /// From where the arm is, mostly; and mostly as it has to be.
  std::vector<TrajectoryPiece> pieces() {
    const JointVector from = host_.status().setpoint;
    TrajectoryPiece piece;
    piece.joints = kJoints;
    piece.duration = random_() % 8 == 0 ? wild() : between(1.5, 2.0);
    for (Eigen::Index joint = 0; joint < kJoints; ++joint) {
      const auto j = static_cast<std::size_t>(joint);
      piece.path[0][j] = from[joint];
      piece.path[1][j] = between(-kFar, kFar) - from[joint];
      if (random_() % 16 == 0) piece.path[random_() % 6][j] = wild();
    }
    piece.timing = {0.0, 0.0, 0.0, 10.0, -15.0, 6.0};
    if (random_() % 16 == 0) piece.timing[random_() % 6] = wild();
    return {piece};
  }
  void call_one() {
    switch (random_() % 14) {
      case 0:
      case 1:
        return host_.add_pieces(token_, random_() % 8 == 0 ? random_() : 0, pieces());
      case 2:
        host_.add_pieces(token_, 0, pieces());
        return static_cast<void>(host_.run(token_));
      case 3:
        host_.add_pieces(token_, 0, pieces());
        return static_cast<void>(host_.follow(token_));
      case 4:
        return host_.lengthen(token_, run_number(), random_() % 2 == 0 ? wild() : between(0, 1));
      case 5:
        return host_.close(token_, run_number());
      case 6:
        return static_cast<void>(host_.hand_over(token_, run_number()));
      case 7:
      case 8: {
        constexpr std::array kWishes = {Steering::kPause,    Steering::kResume, Steering::kStep,
                                        Steering::kBackward, Steering::kStop,   Steering::kResume};
        return host_.steer(token_, run_number(), kWishes[random_() % kWishes.size()]);
      }
      case 9:
        return host_.set_override(token_, random_() % 4 == 0 ? wild() : between(0.1, 1.0));
      case 10: {
        if (random_() % 8 != 0) return host_.steer(token_, run_number(), Steering::kStop);
        JointVector velocity = JointVector::Constant(kJoints, between(-0.5, 0.5));
        if (random_() % 4 == 0) velocity[0] = wild();
        return host_.jog(token_, velocity);
      }
      case 11:
        return static_cast<void>(host_.take_control("mallory"));
      case 12:
        return static_cast<void>(host_.job(run_number())->log(random_(), 10));
      default:
        return host_.on_input(token_, run_number(),
                              {static_cast<std::int16_t>(random_() % 70), true, Wish::kPause});
    }
  }

  ArmHost& host_;
  std::mt19937_64 random_;
  const std::string token_;
};

TEST(ArmHost, KeepsTheArmWithinItsLimitsWhateverItsClientsCall) {
  for (unsigned seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(seed);
    ArmHost host(
        kLimits,
        [](const JointVector& rest) {
          const JointVector start =
              rest.size() == 0 ? JointVector(JointVector::Zero(kJoints)) : rest;
          return std::make_unique<ControllerLoop>(std::make_unique<SimulatedDrive>(start), kLimits);
        },
        seconds(600));
    const std::string token = host.take_control("alice");
    int done = 0;
    {
      const std::jthread same([&] { (void)Caller(host, 10 * seed + 1, token).call(); });
      const std::jthread stranger([&] { (void)Caller(host, 10 * seed + 2, "bob").call(); });
      done = Caller(host, 10 * seed + 3, token).call();
    }
    EXPECT_GT(done, kCalls / 8);
    EXPECT_GT(host.status().run, 0U);
    EXPECT_EQ(host.status().fault, "");  // the guard sees every setpoint
    EXPECT_EQ(host.status().operator_name, "alice");
    host.shut_down();
    EXPECT_FALSE(host.status().busy);
    EXPECT_EQ(host.status().fault, "");
    EXPECT_LE(host.status().setpoint.cwiseAbs().maxCoeff(), 2.0);
  }
}

}  // namespace
}  // namespace viapoint
