#include "viapoint/remote/control_seat.hpp"

#include <gtest/gtest.h>

#include <set>

namespace viapoint {
namespace {

using std::chrono::milliseconds;
using Time = ControlSeat::Time;

constexpr milliseconds kSilence{90};

std::string text_of_refusal(const ControlSeat& seat, const std::string& token) {
  try {
    seat.require(token);
  } catch (const NotInControl& refusal) {
    return refusal.problem().message;
  }
  return {};
}

TEST(ControlSeat, GoesToOneAtATime) {
  ControlSeat seat(kSilence);
  const std::string alice = seat.take("alice", Time{});
  EXPECT_EQ(seat.name(), "alice");
  EXPECT_THROW((void)seat.take("bob", Time{}), NotInControl);
  seat.leave(alice);
  EXPECT_FALSE(seat.taken());
  const std::string bob = seat.take("bob", Time{});
  EXPECT_TRUE(seat.holds(bob));
  EXPECT_EQ(text_of_refusal(seat, alice), "\"alice\" gave up control");
}

TEST(ControlSeat, IsKeptByBeatsAndLostInSilence) {
  ControlSeat seat(kSilence);
  const std::string token = seat.take("alice", Time{});
  for (int k = 1; k <= 10; ++k) {
    EXPECT_FALSE(seat.expire(Time{} + k * milliseconds(80)));
    seat.beat(token, Time{} + k * milliseconds(80));
  }
  EXPECT_EQ(seat.deadline(), Time{} + milliseconds(890));
  EXPECT_FALSE(seat.expire(Time{} + milliseconds(889)));
  EXPECT_TRUE(seat.expire(Time{} + milliseconds(890)));
  EXPECT_FALSE(seat.expire(Time{} + milliseconds(2000)));
  EXPECT_EQ(seat.deadline(), std::nullopt);
  EXPECT_EQ(text_of_refusal(seat, token),
            "control was lost: nothing was heard of \"alice\" for 0.09 s");
  EXPECT_THROW(seat.beat(token, Time{}), NotInControl);
}

TEST(ControlSeat, AFreeSeatHasNoToken) {
  ControlSeat seat(kSilence);
  EXPECT_NE(text_of_refusal(seat, ""), "");
  EXPECT_FALSE(seat.holds(""));
  const std::string token = seat.take("alice", Time{});
  seat.leave(token);
  EXPECT_NE(text_of_refusal(seat, ""), "");
  EXPECT_FALSE(seat.holds(token));
}

TEST(ControlSeat, TokensDiffer) {
  ControlSeat seat(kSilence);
  std::set<std::string> tokens;
  for (int k = 0; k < 100; ++k) {
    const std::string token = seat.take("alice", Time{});
    EXPECT_EQ(token.size(), 32U);
    EXPECT_TRUE(tokens.insert(token).second);
    seat.leave(token);
  }
}

}  // namespace
}  // namespace viapoint
