#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include "realtime/random_motion.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/realtime/controller_loop.hpp"

namespace viapoint {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;

const JointLimits kLimits = even_limits(2, 2.0, 20.0, 200.0);

std::shared_ptr<const Trajectory> move_to(double end) {
  std::vector<TrajectoryPiece> pieces;
  append_straight(pieces, JointVector::Zero(2), JointVector::Constant(2, end), kLimits, 0);
  return std::make_shared<Trajectory>(std::move(pieces), kLimits);
}

/// Wakes up to 3 ms late, by seed, and each tick takes up to 100 us.
class UnevenClock final : public Clock {
 public:
  explicit UnevenClock(unsigned seed) : random_(seed) {}
  [[nodiscard]] std::int64_t now() const noexcept override {
    return now_ += static_cast<std::int64_t>(random_() % 100'000U);
  }
  void sleep_until(std::int64_t instant) noexcept override {
    // Spread over all sizes, from nothing to milliseconds.
    const auto octave = random_() % 22U;
    now_ = std::max(now_, instant) + static_cast<std::int64_t>(random_() % (1U << octave));
  }
  [[nodiscard]] bool is_virtual() const noexcept override { return true; }

 private:
  mutable std::mt19937 random_;
  mutable std::int64_t now_ = 0;
};

std::unique_ptr<ControllerLoop> virtual_loop(
    const LoopOptions& options = {},
    std::unique_ptr<Clock> clock = std::make_unique<VirtualClock>()) {
  return std::make_unique<ControllerLoop>(std::make_unique<SimulatedDrive>(JointVector::Zero(2)),
                                          kLimits, options, std::move(clock));
}

/// Until `job` has left out `cycles` more at rest, or has ended, as the loop may do before this
/// thread gets to pause it; false if that takes too long.
bool rest(const Job& job, std::uint64_t cycles) {
  const std::uint64_t enough = job.report().rested_cycles + cycles;
  const auto deadline = steady_clock::now() + seconds(60);
  while (job.report().rested_cycles < enough && job.state() != RunState::kFinished) {
    if (steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

TEST(RunLog, ALongRestLeavesTwoRecordsAndIsCounted) {
  const auto loop = virtual_loop();
  loop->set_override(0.0);
  const auto trajectory = move_to(20.0);
  const auto job = loop->run(trajectory);
  ASSERT_TRUE(rest(*job, 20'000));
  EXPECT_EQ(job->log().size(), 2U);
  loop->set_override(1.0);
  while (job->nominal_time() < 0.1 && job->state() != RunState::kFinished) {
    std::this_thread::yield();
  }
  job->pause();
  const bool again = rest(*job, 20'000);
  job->resume();
  ASSERT_TRUE(again);
  ASSERT_TRUE(job->wait(20.0));

  const RunReport report = job->report();
  const auto log = job->log();
  EXPECT_EQ(report.cycles, log.size() + report.rested_cycles);
  EXPECT_EQ(report.cycles, log.back().cycle + 1);
  EXPECT_EQ(report.lost_records, 0U);
  EXPECT_NEAR(report.wall_time, 2e-3 * static_cast<double>(report.cycles - 1), 1e-9);
  for (std::size_t k = 1; k < log.size(); ++k) {
    SCOPED_TRACE(k);
    ASSERT_EQ(log[k].q, trajectory->at(log[k].nominal_time).q);
    if (log[k].cycle == log[k - 1].cycle + 1) continue;
    ASSERT_EQ(log[k - 1].state, RunState::kPaused);
    ASSERT_EQ(log[k - 2].state, RunState::kPaused);
    ASSERT_EQ(log[k - 1].measured, log[k - 1].q);
    ASSERT_EQ(log[k].q, log[k - 1].q) << "something happened while records were left out";
  }
}

TEST(RunLog, AFullLogKeepsTheNewestRecordsAndCountsTheOthers) {
  LoopOptions options;
  options.log_records = 100;
  const auto loop = virtual_loop(options);
  const auto trajectory = move_to(3.0);
  const auto job = loop->run(trajectory);
  ASSERT_TRUE(job->wait(20.0));
  const RunReport report = job->report();
  const auto log = job->log();
  ASSERT_EQ(log.size(), 100U);
  EXPECT_EQ(log.back().state, RunState::kFinished);
  EXPECT_EQ(log.front().cycle + 99, log.back().cycle);
  EXPECT_EQ(report.cycles, log.back().cycle + 1);
  EXPECT_EQ(report.lost_records, report.cycles - 100);
  EXPECT_NEAR(report.wall_time, trajectory->duration(), 2e-3);

  options.log_records = 0;
  EXPECT_THROW(virtual_loop(options), MotionError);
}

TEST(RunLog, IsReadInPartsByTheCycle) {
  const auto loop = virtual_loop();
  const auto job = loop->run(move_to(1.0));
  ASSERT_TRUE(job->wait(60.0));
  const std::vector<LogRecord> whole = job->log();
  std::vector<LogRecord> joined;
  for (;;) {
    const std::uint64_t from = joined.empty() ? 0 : joined.back().cycle + 1;
    const std::vector<LogRecord> part = job->log(from, 7);
    if (part.empty()) break;
    ASSERT_LE(part.size(), 7U);
    joined.insert(joined.end(), part.begin(), part.end());
  }
  ASSERT_EQ(joined.size(), whole.size());
  for (size_t k = 0; k < whole.size(); ++k) EXPECT_EQ(joined[k].cycle, whole[k].cycle);
  EXPECT_TRUE(job->log(0, 0).empty());
}

TEST(RunLog, QuantilesAreThoseOfTheCyclesWithinOneInSixtyFour) {
  const auto quantile = [](std::vector<std::int64_t> values, std::size_t percent) {
    std::ranges::sort(values);
    return 1e-9 * static_cast<double>(values[(values.size() - 1) * percent / 100]);
  };
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    const auto loop = virtual_loop({}, std::make_unique<UnevenClock>(seed));
    const auto job = loop->run(move_to(seed == 0 ? 0.001 : 2.0));
    ASSERT_TRUE(job->wait(20.0));
    std::vector<std::int64_t> latency, compute;
    for (const LogRecord& record : job->log()) {
      latency.push_back(record.latency);
      compute.push_back(record.compute);
    }
    const RunReport report = job->report();
    const auto check = [](double found, double exact) {
      EXPECT_GE(found, exact * (1.0 - 1e-12));
      EXPECT_LE(found, exact * (1.0 + 1.0 / 64.0));
    };
    check(report.latency_p50, quantile(latency, 50));
    check(report.latency_p99, quantile(latency, 99));
    check(report.compute_p50, quantile(compute, 50));
    check(report.compute_p99, quantile(compute, 99));
    EXPECT_DOUBLE_EQ(report.latency_max, quantile(latency, 100));
    EXPECT_DOUBLE_EQ(report.compute_max, quantile(compute, 100));
    EXPECT_LE(report.latency_p99, report.latency_max);
  }
}

}  // namespace
}  // namespace viapoint
