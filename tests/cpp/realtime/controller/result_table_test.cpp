#include "controller/result_table.hpp"

#include <gtest/gtest.h>

namespace viapoint::controller {
namespace {

/// A run that has ended with the figures given.
class EndedJob final : public Job {
 public:
  explicit EndedJob(RunReport report) : report_(report) {}
  bool wait(double) override { return true; }
  void pause() override {}
  void resume() override {}
  void step() override {}
  void backward() override {}
  void stop(StopCategory) override {}
  void on_input(const InputReaction&) override {}
  [[nodiscard]] RunState state() const override { return RunState::kFinished; }
  [[nodiscard]] std::optional<InputWait> awaited() const override { return std::nullopt; }
  [[nodiscard]] double nominal_time() const override { return 1.0; }
  [[nodiscard]] double duration() const override { return 1.0; }
  [[nodiscard]] std::uint64_t overruns() const override { return report_.overruns; }
  [[nodiscard]] int move() const override { return 0; }
  [[nodiscard]] std::vector<LogRecord> log() const override { return {}; }
  [[nodiscard]] std::vector<LogRecord> log(std::uint64_t, std::size_t) const override { return {}; }
  [[nodiscard]] RunReport report() const override { return report_; }

 private:
  RunReport report_;
};

TEST(ResultTable, TellsWhatIsMissingInTheLog) {
  RunReport report;
  report.cycles = 501;
  const auto table = [&] { return result_table(Trajectory(), EndedJob(report)); };
  EXPECT_NE(table().find("finished"), std::string::npos);
  EXPECT_EQ(table().find("lost"), std::string::npos) << table();
  EXPECT_EQ(table().find("at rest"), std::string::npos) << table();
  report.overruns = 3;
  report.missed_cycles = 17;
  report.lost_records = 42;
  report.rested_cycles = 1234;
  EXPECT_NE(table().find("501 (3 overruns, 17 missed)"), std::string::npos) << table();
  EXPECT_NE(table().find("42 missing in the log"), std::string::npos) << table();
  EXPECT_NE(table().find("1234 at rest"), std::string::npos) << table();
}

}  // namespace
}  // namespace viapoint::controller
