/// @file
/// What is known of the steps of a program that is told while it runs, until their motion has been
/// handed out.
#pragma once

#include <deque>
#include <utility>

#include "planning/leg.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/trajectory/certificate.hpp"

namespace viapoint::planning {

class ToldSteps {
 public:
  /// @param step as steps are counted from the program's beginning, each one more
  void add(int step, SourceLine source) { told_.push_back({step, std::move(source)}); }
  /// How far the motion of a step is from what it tells, as far as known.
  void note(const Leg& leg);
  /// Nothing more is asked of the steps before this one.
  void drop_before(int step);
  /// Takes the deviations of the steps from `first` to `last` into a certificate.
  void add_deviations(Certificate& certificate, int first, int last) const;
  /// Says where in the script the step of a problem stands.
  void locate(Problem& problem) const;

 private:
  struct Told {
    int step = 0;
    SourceLine source;
    double position_deviation = 0.0, angle_deviation = 0.0;  ///< [m], [rad]
  };
  std::deque<Told> told_;
};

}  // namespace viapoint::planning
