// What was measured in the last cycles, read while the loop writes it.
#include "realtime/measurement_tape.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace viapoint {
namespace {

/// A cycle whose values all tell its number.
LoopCycle numbered(std::uint64_t number) {
  LoopCycle cycle;
  cycle.cycle = number;
  cycle.stamp = static_cast<std::int64_t>(number);
  cycle.outputs = number;
  cycle.measurement.inputs = number;
  cycle.measurement.q = JointVector::Constant(3, static_cast<double>(number));
  return cycle;
}

void expect_whole(const ObservedCycle& one) {
  EXPECT_EQ(one.stamp, static_cast<std::int64_t>(one.cycle));
  EXPECT_EQ(one.inputs, one.cycle);
  EXPECT_EQ(one.outputs, one.cycle);
  EXPECT_EQ(one.q, JointVector::Constant(3, static_cast<double>(one.cycle)));
}

TEST(MeasurementTape, GivesWhatIsStillThereInOrder) {
  MeasurementTape tape(3);
  EXPECT_TRUE(tape.read(0, 10).empty());
  for (std::uint64_t k = 1; k <= 10; ++k) tape.write(numbered(k));
  const std::vector<ObservedCycle> some = tape.read(4, 3);
  ASSERT_EQ(some.size(), 3U);
  for (std::size_t i = 0; i < some.size(); ++i) {
    EXPECT_EQ(some[i].cycle, 4 + i);
    expect_whole(some[i]);
  }
  EXPECT_EQ(tape.read(0, 100).size(), 10U);
  EXPECT_TRUE(tape.read(11, 100).empty());

  for (std::uint64_t k = 11; k <= MeasurementTape::kCycles + 5; ++k) tape.write(numbered(k));
  const std::vector<ObservedCycle> all = tape.read(0, 2 * MeasurementTape::kCycles);
  ASSERT_EQ(all.size(), MeasurementTape::kCycles);
  EXPECT_EQ(all.front().cycle, 6U);
  for (const ObservedCycle& one : all) expect_whole(one);
}

TEST(MeasurementTape, NeverGivesHalfACycleWhileItIsWritten) {
  MeasurementTape tape(3);
  constexpr std::uint64_t kLast = 200'000;
  std::atomic<bool> begins{false};
  std::thread writer([&] {
    while (!begins.load()) std::this_thread::yield();
    for (std::uint64_t k = 1; k <= kLast; ++k) tape.write(numbered(k));
  });
  begins.store(true);
  std::uint64_t next = 1, seen = 0;
  while (next <= kLast) {
    const std::vector<ObservedCycle> part = tape.read(next, 1000);
    for (const ObservedCycle& one : part) {
      ASSERT_GE(one.cycle, next);
      expect_whole(one);
      next = one.cycle + 1;
      ++seen;
    }
  }
  writer.join();
  EXPECT_GE(seen, MeasurementTape::kCycles / 2);
}

}  // namespace
}  // namespace viapoint
