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

class Recorder final : public Follower {
 public:
  Recorder(std::shared_ptr<Follower> run, Handed& handed) : run_(std::move(run)), handed_(handed) {}
  [[nodiscard]] RunState state() const override { return run_->state(); }
  [[nodiscard]] double nominal_time() const override { return run_->nominal_time(); }
  [[nodiscard]] double duration() const override { return run_->duration(); }
  [[nodiscard]] int move() const override { return run_->move(); }
  void lengthen(std::shared_ptr<const Trajectory> next, double leave) override {
    offered_ = {leave, *next};
    run_->lengthen(std::move(next), leave);
  }
  [[nodiscard]] LinkFate fate() override {
    const LinkFate fate = run_->fate();
    if (fate == LinkFate::kTaken && offered_.second.joints() > 0) {
      handed_.chunks.push_back(std::exchange(offered_, {}));
    }
    return fate;
  }
  void close() override { run_->close(); }
  [[nodiscard]] double earliest_leave() const override { return run_->earliest_leave(); }
  [[nodiscard]] std::uint64_t waited_cycles() const override { return run_->waited_cycles(); }

 private:
  std::shared_ptr<Follower> run_;
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
