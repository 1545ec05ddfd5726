#include "viapoint/realtime/log_csv.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

LogRecord record_of(double value) {
  LogRecord record;
  record.cycle = 3;
  record.stamp = 123456789012345;
  record.nominal_time = value;
  record.state = RunState::kRunning;
  record.q = record.qd = record.qdd = record.qddd = JointVector::Constant(2, value);
  return record;
}

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> found;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) found.push_back(field);
  return found;
}

TEST(LogCsv, NumbersReadBackToTheLastBit) {
  for (const double value : {0.1, 1.0 / 3.0, -1e-300, 6.02214076e23, 5e-324}) {
    const std::vector<LogRecord> log = {record_of(value)};
    std::istringstream text(log_to_csv(log));
    std::string header, row;
    std::getline(text, header);
    std::getline(text, row);
    const auto names = fields(header);
    const auto values = fields(row);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] != "q2" && names[i] != "qddd1" && names[i] != "nominal_time") continue;
      double back = 0.0;
      std::from_chars(values[i].data(), values[i].data() + values[i].size(), back);
      EXPECT_EQ(back, value) << names[i];
    }
    EXPECT_EQ(values[7], "running");
    EXPECT_EQ(names.size(), 9U + 5U * 2U);
    EXPECT_EQ(std::ranges::count(row, ','), std::ranges::count(header, ','));
  }
}

TEST(LogCsv, AnEmptyLogHasAHeaderOnly) {
  EXPECT_EQ(log_to_csv({}),
            "cycle,stamp_ns,latency_ns,compute_ns,nominal_time,rate,move,state,outputs\n");
}

TEST(LogCsv, WritesTheFileAndRefusesAFolderThatIsNotThere) {
  const auto path = std::filesystem::path(testing::TempDir()) / "log.csv";
  std::vector<LogRecord> log;  // some pieces long
  for (int i = 0; i < 10'000; ++i) log.push_back(record_of(i / 7.0));
  write_log_csv(path.string(), log);
  std::ifstream file(path);
  std::stringstream content;
  content << file.rdbuf();
  EXPECT_EQ(content.str(), log_to_csv(log));
  EXPECT_GT(content.str().size(), 1'000'000U);
  std::filesystem::remove(path);
  EXPECT_THROW(write_log_csv("/nowhere/at/all/log.csv", log), MotionError);
}

}  // namespace
}  // namespace viapoint
