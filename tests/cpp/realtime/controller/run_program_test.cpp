#include "controller/run_program.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "controller/exit_code.hpp"
#include "viapoint/core/atomic_file.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/program/motion_program.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/log_csv.hpp"

namespace viapoint::controller {
namespace {

namespace fs = std::filesystem;

class RunProgram : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        (std::string("viapoint-") + testing::UnitTest::GetInstance()->current_test_info()->name() +
         "-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    options_.robot = "two_link";
    options_.program = (folder_ / "program.json").string();
    options_.log = (folder_ / "log.csv").string();
    options_.virtual_time = true;
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] MotionProgram program(double wait = 0.05) const {
    MotionProgram program;
    program.robot = robot_->name();
    program.robot_fingerprint = robot_->fingerprint();
    program.start = JointVector::Constant(robot_->joints(), 0.1);
    Step move;
    move.what = PtpMove{JointTarget{JointVector::Constant(robot_->joints(), 0.4)}};
    Step pause;
    pause.what = Wait{wait};
    program.steps = {move, pause};
    return program;
  }
  /// Runs `program` and returns the exit code, as main() would.
  int run(const MotionProgram& program) {
    save_program(program, options_.program);
    try {
      return run_program(options_, out_);
    } catch (const MotionError& error) {
      message_ = error.problem().describe();
      return exit_code_of(error);
    }
  }
  [[nodiscard]] std::string written_log() const {
    std::ifstream file(options_.log);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }

  RobotPtr robot_ = RobotModel::make(load_description("two_link"));
  fs::path folder_;
  Options options_;
  std::ostringstream out_;
  std::string message_;
};

/// Drops what a run on a clock adds to a simulated one: stamps, times and measurements.
std::vector<std::string> setpoints(const std::string& csv, int joints) {
  std::vector<std::string> rows;
  std::istringstream text(csv);
  for (std::string line; std::getline(text, line);) {
    std::istringstream fields(line);
    std::string row, field;
    for (int i = 0; std::getline(fields, field, ',') && i < 9 + 4 * joints; ++i) {
      if (i < 1 || i > 3) row += field + ',';
    }
    rows.push_back(row);
  }
  return rows;
}

TEST_F(RunProgram, GivesTheSetpointsOfTheInterpolatorToTheLastBit) {
  ASSERT_EQ(run(program()), kFinished) << message_;
  const Trajectory trajectory = MotionPlanner(robot_).plan(program()).trajectory;
  const auto simulated = simulate(trajectory, robot_->limits(), {}, options_.cycle);
  const auto expected = setpoints(log_to_csv(simulated), robot_->joints());
  EXPECT_GT(expected.size(), 50U);
  EXPECT_EQ(setpoints(written_log(), robot_->joints()), expected);
  EXPECT_NE(out_.str().find("finished"), std::string::npos);
}

TEST_F(RunProgram, RefusesAProgramForAnotherRobotByBothNames) {
  MotionProgram other = program();
  other.robot = "three_link";
  other.robot_fingerprint = "0123456789abcdef";
  EXPECT_EQ(run(other), kUnreadable);
  EXPECT_NE(message_.find("three_link"), std::string::npos) << message_;
  EXPECT_NE(message_.find("two_link"), std::string::npos) << message_;
  EXPECT_FALSE(fs::exists(options_.log));
}

TEST_F(RunProgram, RefusesAStartForAnotherNumberOfJointsByTheFile) {
  MotionProgram longer = program();
  longer.start = JointVector::Zero(3);
  EXPECT_EQ(run(longer), kUnreadable);
  EXPECT_NE(message_.find("program.json: the start has 3 values"), std::string::npos) << message_;
  EXPECT_NE(message_.find("way out"), std::string::npos) << message_;
}

TEST_F(RunProgram, RefusesWhatCannotBePlannedAndWritesNothing) {
  MotionProgram far = program();
  std::get<PtpMove>(far.steps[0].what).target = JointTarget{JointVector::Constant(2, 100.0)};
  EXPECT_EQ(run(far), kRefused);
  EXPECT_FALSE(message_.empty());
  EXPECT_FALSE(fs::exists(options_.log));
}

TEST_F(RunProgram, TellsAFileThatIsNotThere) {
  options_.robot = "no_such_robot";
  EXPECT_EQ(run(program()), kUnreadable);
  options_.robot = "two_link";
  options_.program = (folder_ / "missing.json").string();
  try {
    static_cast<void>(run_program(options_, out_));
    FAIL() << "nothing was refused";
  } catch (const MotionError& error) {
    EXPECT_EQ(exit_code_of(error), kUnreadable);
  }
}

TEST_F(RunProgram, ALogThatCannotBeWrittenIsFoundBeforeAnythingElse) {
  MotionProgram far = program();
  std::get<PtpMove>(far.steps[0].what).target = JointTarget{JointVector::Constant(2, 100.0)};
  std::ofstream(folder_ / "file") << "in the way";
  for (const fs::path& log : {folder_ / "missing" / "log.csv", folder_ / "file" / "log.csv",
                              folder_, folder_ / "", fs::path()}) {
    SCOPED_TRACE(log);
    options_.log = log.string();
    // Were it found later, the program would be refused first.
    EXPECT_EQ(run(far), kUnreadable);
    EXPECT_NE(message_.find("log cannot be written"), std::string::npos) << message_;
    EXPECT_NE(message_.find(options_.log), std::string::npos) << message_;
  }
}

TEST_F(RunProgram, ARefusedProgramLeavesTheLogOfTheRunBefore) {
  std::ofstream(options_.log) << "of the run before";
  MotionProgram far = program();
  std::get<PtpMove>(far.steps[0].what).target = JointTarget{JointVector::Constant(2, 100.0)};
  EXPECT_EQ(run(far), kRefused);
  EXPECT_EQ(written_log(), "of the run before");
  const auto files = std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  EXPECT_EQ(files, 2) << "something beside the program and the log was left";
}

TEST_F(RunProgram, ALogThatWouldOverwriteWhatIsReadIsRefusedBeforeAnythingMoves) {
  const fs::path link = folder_ / "link.json";
  fs::create_symlink(options_.program, link);
  const fs::path robot = folder_ / "arm.yaml";
  const std::string description = to_yaml(load_description("two_link"));
  write_file_atomically(robot.string(), description);
  for (const fs::path& log : {fs::path(options_.program), folder_ / "." / "program.json",
                              fs::relative(options_.program), link, robot}) {
    SCOPED_TRACE(log);
    options_.robot = robot.string();
    options_.log = log.string();
    EXPECT_EQ(run(program()), kUnreadable);
    EXPECT_NE(message_.find("would overwrite"), std::string::npos) << message_;
    EXPECT_EQ(out_.str(), "");
    EXPECT_EQ(load_program(options_.program).steps.size(), 2U);
    EXPECT_EQ(read_file(robot.string()), description);
  }
}

TEST_F(RunProgram, ALogThatFailsAfterTheMotionLeavesTheTableAndIsToldByTheExitCode) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  // SIG_IGN is the C library's macro: a handler made of a number.
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);  // NOLINT(performance-no-int-to-ptr)
  const rlimit small{4096, before.rlim_max};           // the program fits, the log does not
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const int code = run(program());
  setrlimit(RLIMIT_FSIZE, &before);
  static_cast<void>(std::signal(SIGXFSZ, handler));
  EXPECT_EQ(code, kUnreadable) << message_;
  EXPECT_NE(out_.str().find("finished"), std::string::npos) << out_.str();
  EXPECT_FALSE(fs::exists(options_.log));
}

TEST_F(RunProgram, ASignalBringsTheArmToRestAndTheLogIsWritten) {
  options_.virtual_time = false;
  sigset_t terminate, before;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  // As in the executable, where no other thread could take the signal either.
  pthread_sigmask(SIG_BLOCK, &terminate, &before);
  std::jthread sender([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    kill(getpid(), SIGTERM);
  });
  EXPECT_EQ(run(program(600.0)), kStopped) << message_;
  sender.join();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_NE(written_log().find("stopped"), std::string::npos);
  EXPECT_NE(out_.str().find("stopped"), std::string::npos);
}

}  // namespace
}  // namespace viapoint::controller
