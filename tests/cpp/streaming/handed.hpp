/// @file
/// What a stream has handed to the arm, chunk by chunk.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "planning/path_timer.hpp"
#include "viapoint/realtime/controller_loop.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// Hands on to a job, and keeps what it is handed.
struct Handed {
  std::vector<std::pair<double, Trajectory>> chunks;  ///< with when the one before is left
};

class Recorder final : public OpenJob {
 public:
  Recorder(std::shared_ptr<OpenJob> job, Handed& handed) : job_(std::move(job)), handed_(handed) {}
  bool wait(double timeout) override { return job_->wait(timeout); }
  void pause() override { job_->pause(); }
  void resume() override { job_->resume(); }
  void step() override { job_->step(); }
  void backward() override { job_->backward(); }
  void stop(StopCategory category) override { job_->stop(category); }
  void on_input(const InputReaction& reaction) override { job_->on_input(reaction); }
  [[nodiscard]] RunState state() const override { return job_->state(); }
  [[nodiscard]] std::optional<InputWait> awaited() const override { return job_->awaited(); }
  [[nodiscard]] double nominal_time() const override { return job_->nominal_time(); }
  [[nodiscard]] double duration() const override { return job_->duration(); }
  [[nodiscard]] std::uint64_t overruns() const override { return job_->overruns(); }
  [[nodiscard]] int move() const override { return job_->move(); }
  [[nodiscard]] std::vector<LogRecord> log() const override { return job_->log(); }
  [[nodiscard]] std::vector<LogRecord> log(std::uint64_t from, std::size_t count) const override {
    return job_->log(from, count);
  }
  [[nodiscard]] RunReport report() const override { return job_->report(); }
  void lengthen(std::shared_ptr<const Trajectory> next, double leave) override {
    offered_ = {leave, *next};
    job_->lengthen(std::move(next), leave);
  }
  [[nodiscard]] LinkFate fate() override {
    const LinkFate fate = job_->fate();
    if (fate == LinkFate::kTaken && offered_.second.joints() > 0) {
      handed_.chunks.push_back(std::exchange(offered_, {}));
    }
    return fate;
  }
  void close() override { job_->close(); }
  [[nodiscard]] double earliest_leave() const override { return job_->earliest_leave(); }
  [[nodiscard]] std::uint64_t waited_cycles() const override { return job_->waited_cycles(); }

 private:
  std::shared_ptr<OpenJob> job_;
  Handed& handed_;
  std::pair<double, Trajectory> offered_;
};

/// What the arm has to follow after each chunk that it was handed: the last one is all of it.
inline std::vector<Trajectory> ways(const Handed& handed) {
  std::vector<Trajectory> ways;
  double begin = 0.0;
  for (const auto& [leave, chunk] : handed.chunks) {
    begin += leave;
    ways.push_back(ways.empty() ? chunk : ways.back().continued(0, begin, chunk));
  }
  return ways;
}

/// All of it as the pieces of one motion.
inline std::vector<TrajectoryPiece> told(const Handed& handed) {
  std::vector<TrajectoryPiece> pieces;
  for (std::size_t k = 0; k < handed.chunks.size(); ++k) {
    const bool is_last = k + 1 == handed.chunks.size();
    const Trajectory& chunk = handed.chunks[k].second;
    planning::append_until(pieces, chunk.pieces(),
                           is_last ? chunk.duration() : handed.chunks[k + 1].first);
  }
  return pieces;
}

}  // namespace viapoint
