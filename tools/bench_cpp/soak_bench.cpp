// The loop on the machine's clock for a long time, with everything that can be done to it done at
// random from four threads.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include "benches.hpp"
#include "planning/random_program.hpp"
#include "soak_figures.hpp"
#include "streaming/handed.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/drives/simulated_drive.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/planning/motion_planner.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/realtime/log_csv.hpp"
#include "viapoint/streaming/motion_stream.hpp"

namespace viapoint::bench {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr double kCycle = 2e-3;
constexpr int kInputs = 4;
/// Commands of one run; then it is let go to its end.
constexpr std::chrono::seconds kCommanded{15};
/// A run that has not ended so long after it was let go never will.
constexpr std::chrono::seconds kPatience{120};
constexpr milliseconds kLook{10};

/// Draws what one thread does.
class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  int whole(int below) { return std::uniform_int_distribution<int>(0, below - 1)(random_); }
  void sleep(int most_milliseconds) {
    std::this_thread::sleep_for(milliseconds(1 + whole(most_milliseconds)));
  }
  std::mt19937& engine() { return random_; }

 private:
  std::mt19937 random_;
};

class Soak {
 public:
  Soak()
      : robot_(RobotModel::make(load_description("ur5e"))),
        figures_(robot_->limits(), kCycle),
        log_file_(std::filesystem::temp_directory_path() /
                  ("viapoint-soak-" + std::to_string(getpid()) + ".csv")) {
    SimulatedDriveOptions drive;
    drive.lag = 0.01;
    drive.resolution = 1e-5;
    drive.noise = 2e-6;
    LoopOptions options;
    options.guard.kinematics = robot_->forward();
    const JointLimits& limits = robot_->limits();
    const JointVector start = 0.5 * (limits.position_min + limits.position_max);
    loop_ = std::make_unique<ControllerLoop>(
        std::make_unique<SimulatedDrive>(start, inputs_, drive), limits, options);
    for (const std::string& line : loop_->shortcomings()) std::cerr << "soak: " << line << '\n';
  }

  ~Soak() { std::filesystem::remove(log_file_); }
  Soak(const Soak&) = delete;
  Soak& operator=(const Soak&) = delete;

  void work(double seconds) {
    const auto begin = steady_clock::now();
    {
      const std::jthread speed([this] { press_buttons(); });
      const std::jthread hands([this] { use_hands(); });
      const std::jthread watcher([this] { watch(); });
      const auto end = begin + std::chrono::duration<double>(seconds);
      for (unsigned k = 0; steady_clock::now() < end && figures_.is_sound(); ++k) one_run();
      quits_ = true;
    }
    if (!loop_->fault().empty()) figures_.note(loop_->fault());
    const std::chrono::duration<double> took = steady_clock::now() - begin;
    figures_.print(loop_->newest_cycle().cycle, took.count());
  }

 private:
  void one_run() try {
    dice_.sleep(400);  // jogs between runs
    std::unique_lock lock(panel_);
    while (loop_->jogging()) std::this_thread::sleep_for(kLook);
    figures_.note_memory();
    const MotionProgram program = some_program();
    if (program.steps.empty()) return;
    stop_told_ = false;
    dice_.chance(0.4) ? stream(program, lock) : run(program, lock);
  } catch (const MotionError& error) {
    figures_.note(error.what());
  }

  /// From where the arm rests, moves of every kind; those that cannot be had are left out.
  MotionProgram some_program() {
    testing_planner::ProgramKind kind;
    kind.moves = 2 + static_cast<std::size_t>(dice_.whole(10));
    kind.wild = 0.0;
    MotionProgram program = testing_planner::random_program(*robot_, kind, dice_.engine());
    Step approach;
    approach.what = PtpMove{JointTarget{program.start}};
    program.steps.insert(program.steps.begin(), approach);
    program.start = loop_->position();
    while (testing_planner::leave_out_errors(program, MotionPlanner(robot_).check(program))) {
    }
    return program;
  }

  void run(const MotionProgram& program, std::unique_lock<std::mutex>& lock) {
    const auto way = std::make_shared<Trajectory>(MotionPlanner(robot_).plan(program).trajectory);
    job_ = loop_->run(way);
    lock.unlock();
    see_to_its_end(*job_, [] {});
    end_run(*way);
  }

  void stream(const MotionProgram& program, std::unique_lock<std::mutex>& lock) {
    MotionProgram beginning = program;
    beginning.steps.clear();
    Handed handed;
    MotionStream stream(
        robot_, beginning,
        [&](std::shared_ptr<const Trajectory> first) {
          handed.chunks.emplace_back(0.0, *first);
          const std::shared_ptr<OpenJob> begun = loop_->follow(std::move(first));
          job_ = begun;  // under the panel's lock, as the first hand_over() is
          return std::make_shared<Recorder>(begun, handed);
        },
        0.02);
    const auto hand_over = [&] { stream.hand_over(); };
    for (const Step& step : program.steps) {
      // Most come in time, some late. Nobody may jog before the motion begins.
      for (int k = dice_.chance(0.15) ? 100 : dice_.whole(20); k > 0; --k) {
        hand_over();
        if (job_ != nullptr && lock.owns_lock()) lock.unlock();
        std::this_thread::sleep_for(kLook);
      }
      stream.add(step);
    }
    stream.end();
    hand_over();
    if (lock.owns_lock()) lock.unlock();
    if (job_ == nullptr) return;
    see_to_its_end(*job_, hand_over);
    static_cast<void>(stream.run()->fate());  // of a chunk that came last
    end_run(ways(handed).back());
  }

  /// With commands for a while, and then without.
  template <typename Meanwhile>
  void see_to_its_end(Job& job, const Meanwhile& meanwhile) {
    const auto let_go_at = steady_clock::now() + kCommanded;
    bool is_let_go = false;
    while (!job.wait(0.01)) {
      meanwhile();
      const auto now = steady_clock::now();
      if (!is_let_go && now > let_go_at) {
        const std::lock_guard lock(panel_);
        may_press_ = false;
        for (const Wish wish : {Wish::kPause, Wish::kRun, Wish::kStop}) {
          job.on_input({-1, true, wish});
        }
        loop_->set_override(1.0);
        job.resume();
        is_let_go = true;
      }
      if (now > let_go_at + kPatience) {
        throw MotionError(ErrorCode::kInternal,
                          std::string("a run is ") + to_string(job.state()) + " for ever");
      }
    }
  }

  void end_run(const Trajectory& way) {
    const std::lock_guard lock(panel_);
    figures_.judge(*job_, way, stop_told_);
    job_ = nullptr;
    may_press_ = true;
  }

  /// Calls `press` again and again, but when nobody may. @param most pause between [ms]
  template <typename Press>
  void repeat(int most, Dice& dice, const Press& press) {
    while (!quits_) {
      dice.sleep(most);
      const std::lock_guard lock(panel_);
      if (!may_press_) continue;
      try {
        press();
      } catch (const MotionError& error) {
        // A jog while a run is under way.
        if (error.code() != ErrorCode::kBusy) figures_.note(error.what());
      }
    }
  }

  /// Override, pause, resume, step, backward; seldom a stop.
  void press_buttons() {
    Dice dice(2);
    repeat(150, dice, [&] {
      if (dice.chance(0.3)) {
        return loop_->set_override(dice.chance(0.3)   ? 1.0
                                   : dice.chance(0.1) ? 0.0
                                                      : dice.uniform(0.0, 1.0));
      }
      if (job_ == nullptr) return;
      switch (dice.whole(10)) {
        case 0:
        case 1:
          return job_->pause();
        case 2:
          return job_->step();
        case 3:
          return job_->backward();
        case 4:
          if (!dice.chance(0.1)) return;
          stop_told_ = true;
          return job_->stop();
        default:
          return job_->resume();
      }
    });
  }

  /// Jogs, inputs and what a run is to do on them, outputs.
  void use_hands() {
    Dice dice(3);
    repeat(60, dice, [&] {
      const InputReaction reaction{static_cast<std::int16_t>(dice.whole(kInputs)), dice.chance(0.5),
                                   dice.chance(0.3) ? Wish::kPause : Wish::kRun};
      switch (dice.whole(4)) {
        case 0:
          if (job_ != nullptr && job_->state() == RunState::kPaused) job_->pause();
          return loop_->jog(some_velocity(dice));
        case 1:
          inputs_->fetch_xor(std::uint64_t{1} << dice.whole(kInputs));
          return;
        case 2:
          return loop_->switch_outputs(std::uint64_t{1} << dice.whole(64), dice.engine()());
        default:
          if (job_ != nullptr) job_->on_input(reaction);
      }
    });
  }

  JointVector some_velocity(Dice& dice) const {
    JointVector velocity = robot_->limits().velocity;
    for (double& value : velocity) value *= 0.2 * dice.uniform(-1.0, 1.0);
    return velocity;
  }

  /// Reads whatever can be read, and writes the log of the run under way once a second.
  void watch() {
    std::uint64_t seen = 0;
    auto written = steady_clock::now();
    while (!quits_) {
      std::this_thread::sleep_for(milliseconds(1));
      const LoopCycle now = loop_->newest_cycle();
      if (now.cycle < seen) figures_.note("the newest cycle was an older one");
      seen = now.cycle;
      static_cast<void>(loop_->measured());
      std::shared_ptr<Job> job;
      {
        const std::lock_guard lock(panel_);
        job = job_;
      }
      if (job == nullptr) continue;
      static_cast<void>(job->report());
      if (steady_clock::now() < written + std::chrono::seconds(1)) continue;
      write_log_csv(log_file_, job->log());
      written = steady_clock::now();
    }
  }

  RobotPtr robot_;
  SoakFigures figures_;
  std::string log_file_;
  Dice dice_{1};
  std::shared_ptr<std::atomic<std::uint64_t>> inputs_ =
      std::make_shared<std::atomic<std::uint64_t>>(0);
  std::unique_ptr<ControllerLoop> loop_;
  std::mutex panel_;  ///< held by who presses; guards what follows
  std::shared_ptr<Job> job_;
  bool may_press_ = true;
  bool stop_told_ = false;  ///< in the run under way
  std::atomic<bool> quits_{false};
};

}  // namespace

void bench_soak(int seconds) { Soak().work(seconds); }

}  // namespace viapoint::bench
