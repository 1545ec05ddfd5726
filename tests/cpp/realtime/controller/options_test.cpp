#include "controller/options.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "controller/exit_code.hpp"

namespace viapoint::controller {
namespace {

CommandLine read(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "viapoint-controller");
  return read_command_line(static_cast<int>(arguments.size()), arguments.data());
}

TEST(Options, TakeEverythingFromTheCommandLine) {
  const CommandLine line = read(
      {"--robot", "r", "--program", "p.json", "--log", "l.csv", "--cycle-ms", "0.5", "--virtual"});
  ASSERT_TRUE(line.options);
  EXPECT_EQ(line.options->robot, "r");
  EXPECT_EQ(line.options->program, "p.json");
  EXPECT_EQ(line.options->log, "l.csv");
  EXPECT_EQ(line.options->cycle.count(), 500'000);
  EXPECT_TRUE(line.options->virtual_time);
}

TEST(Options, TheCycleIsTwoMillisecondsOnTheMachinesClock) {
  const CommandLine line = read({"--robot", "r", "--program", "p", "--log", "l"});
  ASSERT_TRUE(line.options);
  EXPECT_EQ(line.options->cycle.count(), 2'000'000);
  EXPECT_FALSE(line.options->virtual_time);
}

TEST(Options, MistakesEndWithTheCodeOfUsage) {
  for (const auto& bad : std::vector<std::vector<const char*>>{
           {},
           {"--robot", "r", "--program", "p"},
           {"--robot", "r", "--program", "p", "--log", "l", "--cycle-ms", "0"},
           {"--robot", "r", "--program", "p", "--log", "l", "--cycle-ms", "nan"},
           {"--robot", "r", "--program", "p", "--log", "l", "--faster"},
           {"--config", "c", "--robot", "r", "--program", "p", "--log", "l"},
           {"--config", "c", "--virtual"}}) {
    const CommandLine line = read(bad);
    EXPECT_FALSE(line.options);
    EXPECT_EQ(line.exit_code, kUsage);
  }
}

TEST(Options, AConfigurationIsEnough) {
  const CommandLine line = read({"--config", "c.yaml"});
  ASSERT_TRUE(line.options);
  EXPECT_EQ(line.options->config, "c.yaml");
}

TEST(Options, HelpIsNoMistake) {
  const CommandLine line = read({"--help"});
  EXPECT_FALSE(line.options);
  EXPECT_EQ(line.exit_code, kFinished);
}

}  // namespace
}  // namespace viapoint::controller
