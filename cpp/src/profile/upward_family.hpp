/// @file
/// For every duration, the motion between two velocities and accelerations that gains the most
/// position.
///
/// Between given velocities and accelerations the motion that gains the most in a given time raises
/// the acceleration, lowers it and raises it again, each at full jerk, holding the acceleration
/// limits in between (Pontryagin's principle for a chain of three integrators: the jerk has two
/// switches). It is laid out here on two *sides*: the way from the start up to the top velocity u,
/// where the acceleration crosses zero, and the way down from u to the end. Continue the rising
/// line of acceleration through the start backwards (through the end forwards) to zero
/// acceleration: the velocity there is the side's `v`, v_s = v − a²/2j_up. With
/// H = (1/j_up + 1/j_down)/2 a side whose acceleration peaks at x (x > 0 from the start,
/// −acceleration at the end) reaches u = v_s + H x², and lasts 2 H x from zero to zero. Both sides
/// meet at u, so x_outer² − x_inner² = K = (v_inner − v_outer)/H >= 0; the inner side is the one
/// that starts at the higher v_s. The whole family has one parameter:
///   - x_inner < 0: the acceleration does not reach zero between the peaks (the velocity is
///     monotone there), and u is where the line would reach it;
///   - x_inner >= 0 up to the u that is the velocity limit; then a cruise of any length.
/// With S = x_outer + x_inner, the time is 2 H S + const without a hold, so that the duration gives
/// the member in closed form, and the gain is const + α S + β S³/3 − γ/S. The slope of gain over
/// duration is w = u + x_outer x_inner/(2 j_down).
#pragma once

namespace viapoint {

/// Limits of a motion that goes up, all > 0.
struct UpwardLimits {
  double velocity;  ///< at the top
  double rise;      ///< acceleration
  double fall;      ///< −acceleration
  double jerk_up;
  double jerk_down;  ///< −jerk
};

/// One motion of the family.
struct UpwardMember {
  double outer, inner;            ///< peaks of the two sides, as above
  double sum;                     ///< of the two: what the falling jerk takes off in between
  double outer_hold, inner_hold;  ///< time at the acceleration limits [s]
  double cruise;                  ///< time at the velocity limit [s]
  double duration, gain;
};

/// The family between (v0, a0) and (v1, a1). Real-time: safe. Threads: const after construction.
class UpwardFamily {
 public:
  UpwardFamily() = default;
  /// @pre accelerations within the limits, and the top velocities v + a|a|/2j of both ends, too
  UpwardFamily(double v0, double a0, double v1, double a1, const UpwardLimits& limits) noexcept;

  /// The quickest member: the quickest change of velocity and acceleration there is.
  [[nodiscard]] UpwardMember quickest() const noexcept {
    return has_monotone_ ? of_inner(inner_.lead) : crest_start_;
  }
  /// Where the durations have a gap, (last before, first after); both zero where there is none.
  /// Members before it are monotone in velocity, those after reach zero acceleration between.
  [[nodiscard]] bool has_gap() const noexcept { return has_gap_; }
  [[nodiscard]] double gap_begin() const noexcept { return gap_begin_; }
  [[nodiscard]] double gap_end() const noexcept { return crest_start_.duration; }
  [[nodiscard]] const UpwardMember& after_gap() const noexcept { return crest_start_; }

  /// The member that lasts `duration`. @pre not shorter than the quickest, not inside the gap
  [[nodiscard]] UpwardMember lasting(double duration) const noexcept;

  /// The quickest member after `from` that gains `gain`, before any gap; false where there is none.
  /// @pre from.gain <= gain
  [[nodiscard]] bool reach(double gain, const UpwardMember& from,
                           UpwardMember& found) const noexcept;
  /// The quickest member after any gap that gains `gain`. @pre after_gap().gain <= gain
  [[nodiscard]] UpwardMember reach_after_gap(double gain) const noexcept {
    return reach_from(gain, crest_start_);
  }

  /// The velocity limit, at which the cruise runs.
  [[nodiscard]] double top() const noexcept { return top_; }
  /// Peaks in the order of time.
  [[nodiscard]] double first_peak(const UpwardMember& m) const noexcept {
    return first_is_outer_ ? m.outer : m.inner;
  }
  [[nodiscard]] double last_peak(const UpwardMember& m) const noexcept {
    return first_is_outer_ ? m.inner : m.outer;
  }
  [[nodiscard]] double first_hold(const UpwardMember& m) const noexcept {
    return first_is_outer_ ? m.outer_hold : m.inner_hold;
  }
  [[nodiscard]] double last_hold(const UpwardMember& m) const noexcept {
    return first_is_outer_ ? m.inner_hold : m.outer_hold;
  }

 private:
  struct Side {
    double v;      ///< velocity where the line through the given state crosses a = 0
    double lead;   ///< the peak cannot be lower than the given acceleration
    double cap;    ///< nor higher than this
    double given;  ///< the given velocity
  };

  [[nodiscard]] UpwardMember of_inner(double inner) const noexcept;
  [[nodiscard]] UpwardMember of_sum(double sum) const noexcept;
  /// By the top velocity less inner_.v.
  [[nodiscard]] UpwardMember of_excess(double excess) const noexcept;
  [[nodiscard]] bool reach_monotone(double gain, const UpwardMember& from,
                                    UpwardMember& found) const noexcept;
  /// From a member whose inner peak is not negative on. @pre from.gain <= gain
  [[nodiscard]] UpwardMember reach_from(double gain, const UpwardMember& from) const noexcept;
  [[nodiscard]] UpwardMember reach_free(double gain, const UpwardMember& from,
                                        double high_sum) const noexcept;
  [[nodiscard]] double reach_held(double wanted, double v, double cap, double low,
                                  double high) const noexcept;
  [[nodiscard]] UpwardMember reach_inner_held(double gain, const UpwardMember& low,
                                              double low_excess, double high_excess) const noexcept;
  void settle(UpwardMember& m) const noexcept;

  // Not initialised by default: many wait in arrays for few that are used.
  Side outer_, inner_;
  bool first_is_outer_, has_monotone_, has_gap_;
  double per_up_, per_down_;  ///< 1/jerk
  double half_;               ///< H
  double cubic_;              ///< a side gains v·2Hx + cubic x³
  double k_;
  double time_offset_, gain_offset_;
  double top_;               ///< the velocity limit
  double lowest_, highest_;  ///< excesses of the first member after the gap, the last
  double monotone_end_;      ///< greatest inner peak before the gap
  double gap_begin_;
  UpwardMember crest_start_;  ///< the first member with inner peak >= 0
};

}  // namespace viapoint
