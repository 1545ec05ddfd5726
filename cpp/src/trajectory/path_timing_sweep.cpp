#include "trajectory/path_timing_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "trajectory/path_timing_tool.hpp"

namespace viapoint::path_timing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Where a stretch is sampled, as shares of its length. On a straight one all that happens does so
/// near its ends, however long it is.
constexpr std::array<double, 15> kStraightPlaces{
    0.0,     1.0 / 128, 1.0 / 64,  1.0 / 32,  1.0 / 16,  1.0 / 8,     1.0 / 4, 1.0 / 2,
    3.0 / 4, 7.0 / 8,   15.0 / 16, 31.0 / 32, 63.0 / 64, 127.0 / 128, 1.0};
constexpr std::array<double, 5> kCurvedPlaces{0.0, 0.25, 0.5, 0.75, 1.0};

/// Where beside its ends such a stretch is sampled, too: at shares of the way from rest to the
/// highest speed.
constexpr std::array<double, 3> kRampShares{1.0 / 16, 1.0 / 4, 1.0};
static_assert(kStraightPlaces.size() + 2 * kRampShares.size() == kMostPlaces);

/// Growth of z = ṡ^{3/2} with s over that of a ramp from rest, √(9/2 s⃛): the rest of the jerk is
/// spent where acceleration turns over.
constexpr double kGrowth = 0.5;
/// Where jerk hardly counts, speed changes over ṡ² / 2s̈: w is at least this share of it.
constexpr double kChangeShare = 0.1;

/// x^{3/4}.
double three_quarters(double x) {
  const double root = std::sqrt(x);
  return root * std::sqrt(root);
}

Sample straight_sample(const Stretch& stretch, double s) {
  const double v = stretch.rate_limit;
  Sample sample{s, v * std::sqrt(v), stretch.change_limit, stretch.jerk_limit};
  sample.top = sample.z;
  return sample;
}

Sample curved_sample(const Course& course, size_t index, double s) {
  const Stretch& stretch = course.stretches()[index];
  JointRates rates;
  course.rates(index, s, rates);
  double v = 0.0, a = 0.0, j = 0.0, bend = 0.0, twist = 0.0;
  for (size_t i = 0; i < static_cast<size_t>(course.joints()); ++i) {
    v = std::max(v, std::abs(rates.velocity[i]));
    a = std::max(a, std::abs(rates.acceleration1[i]));
    j = std::max(j, std::abs(rates.jerk1[i]));
    bend = std::max(bend, std::abs(rates.acceleration2[i]));
    twist = std::max(twist, std::abs(rates.jerk3[i]));
  }
  if (stretch.tool != nullptr) {
    const ToolPlace tool = tool_at(stretch, s);
    v = std::max(v, tool.velocity);
    for (const ToolCone& cone : tool.cones) {
      a = std::max(a, cone.slope);
      bend = std::max(bend, std::hypot(cone.b, cone.normal));
    }
  }
  const double z =
      std::min({1.0 / (v * std::sqrt(v)), three_quarters(1.0 / bend), 1.0 / std::sqrt(twist)});
  Sample sample{s, z, 1.0 / a, 1.0 / j};
  if (stretch.tool != nullptr && z == 1.0 / (v * std::sqrt(v))) sample.top = z;
  return sample;
}

Sample sample_at(const Course& course, size_t index, double s) {
  const Stretch& stretch = course.stretches()[index];
  return stretch.straight ? straight_sample(stretch, s) : curved_sample(course, index, s);
}

double growth_for(double jerk) { return kGrowth * std::sqrt(4.5 * jerk); }

/// Places of one stretch in order.
class Places {
 public:
  Places(const Course& course, size_t index) {
    const Stretch& stretch = course.stretches()[index];
    const double length = stretch.length;
    if (!stretch.straight && stretch.tool == nullptr) {
      for (const double share : kCurvedPlaces) push(share * length);
      return;
    }
    // However slow the highest speed is, the way to it is seen.
    const double near = ramp(sample_at(course, index, 0.0)),
                 far = ramp(sample_at(course, index, length));
    const double least = 0.5 * kStraightPlaces[1] * length;
    push(0.0);
    for (const double share : kRampShares) {
      if (share * near > 0.0 && share * near < least) push(share * near);
    }
    for (size_t k = 1; k + 1 < kStraightPlaces.size(); ++k) push(kStraightPlaces[k] * length);
    for (size_t k = kRampShares.size(); k-- > 0;) {
      const double s = length - kRampShares[k] * far;
      if (s < length && s > length - least) push(s);
    }
    push(length);
  }

  [[nodiscard]] std::span<const double> all() const { return {s_.data(), count_}; }

 private:
  /// The way from rest to the highest speed.
  static double ramp(const Sample& sample) {
    const double by_change = sample.top * std::cbrt(sample.top) / (2.0 * sample.change);
    return std::max(sample.top / growth_for(sample.jerk), by_change);
  }
  void push(double s) { s_[count_++] = s; }

  std::array<double, kMostPlaces> s_{};
  size_t count_ = 0;
};

/// z after `distance` from one place to another.
double reachable(const Sample& from, const Sample& to, double start, double distance) {
  const double z = start + std::min(from.growth, to.growth) * distance;
  const double by_change = 2.0 * std::min(from.change, to.change) * distance;
  const double rate2 = z * std::cbrt(z), start2 = start * std::cbrt(start);
  return rate2 <= start2 + by_change ? z : three_quarters(start2 + by_change);
}

/// w of every sample. On a straight stretch at its highest speed, and at the highest speed of the
/// tool, nothing happens but near where it gets there: cells grow with the distance from it.
void set_widths(const Course& course, Samples& samples) {
  constexpr double kSteadyGrowth = 0.5, kCruiseGrowth = 0.15;
  for (Sample& sample : samples.all) {
    const double by_change = kChangeShare * sample.z * std::cbrt(sample.z) / (2.0 * sample.change);
    sample.width = std::max(kGrowth * sample.z / sample.growth, by_change);
  }
  const auto& stretches = course.stretches();
  auto& all = samples.all;
  // How far cruising has lasted at each sample, from either end: the less counts.
  std::vector<double> cruised(all.size());
  double lasted = 0.0;
  const auto go_on = [&](size_t from, size_t to) {
    const bool both = all[from].cruises() && all[to].cruises();
    lasted = both ? lasted + std::abs(all[to].s - all[from].s) : 0.0;
  };
  for (size_t k = 0; k < stretches.size(); ++k) {
    lasted *= stretches[k].gear;
    for (size_t i = samples.first[k]; i < samples.first[k + 1]; ++i) {
      if (i > samples.first[k]) go_on(i - 1, i);
      cruised[i] = lasted;
    }
  }
  lasted = 0.0;
  for (size_t k = stretches.size(); k-- > 0;) {
    for (size_t i = samples.first[k + 1]; i-- > samples.first[k];) {
      if (i + 1 < samples.first[k + 1]) go_on(i + 1, i);
      const double growth = stretches[k].straight ? kSteadyGrowth : kCruiseGrowth;
      all[i].width += growth * std::min(cruised[i], lasted);
    }
    lasted /= stretches[k].gear;
  }
}

}  // namespace

Samples sweep(const Course& course) {
  Samples samples;
  const auto& stretches = course.stretches();
  samples.first.reserve(stretches.size() + 1);
  samples.all.reserve(stretches.size() * kStraightPlaces.size());
  double least_z = kInfinite, least_change = kInfinite, least_jerk = kInfinite;
  for (size_t k = 0; k < stretches.size(); ++k) {
    samples.first.push_back(samples.all.size());
    const Places places(course, k);
    for (const double s : places.all()) {
      const Sample sample = sample_at(course, k, s);
      least_z = std::min(least_z, sample.z);
      least_change = std::min(least_change, sample.change);
      least_jerk = std::min(least_jerk, sample.jerk);
      samples.all.push_back(sample);
    }
  }
  samples.first.push_back(samples.all.size());
  // Where q' vanishes nothing bounds the speed: any ceiling will do, this far above the rest.
  constexpr double kDecades = 1e6;
  for (Sample& sample : samples.all) {
    sample.z = std::min(sample.z, kDecades * least_z);
    sample.change = std::min(sample.change, kDecades * least_change);
    sample.jerk = std::min(sample.jerk, kDecades * least_jerk);
    sample.growth = growth_for(sample.jerk);
  }
  auto& all = samples.all;
  all.front().z = all.back().z = 0.0;
  const auto gear_of_z = [&](size_t k) { return stretches[k].gear * std::sqrt(stretches[k].gear); };
  for (size_t k = 0; k < stretches.size(); ++k) {
    const size_t begin = samples.first[k], end = samples.first[k + 1];
    if (k > 0) all[begin].z = std::min(all[begin].z, gear_of_z(k) * all[begin - 1].z);
    for (size_t i = begin + 1; i < end; ++i) {
      const double distance = all[i].s - all[i - 1].s;
      all[i].z = std::min(all[i].z, reachable(all[i - 1], all[i], all[i - 1].z, distance));
    }
  }
  for (size_t k = stretches.size(); k-- > 0;) {
    const size_t begin = samples.first[k], end = samples.first[k + 1];
    for (size_t i = end - 1; i-- > begin;) {
      const double distance = all[i + 1].s - all[i].s;
      all[i].z = std::min(all[i].z, reachable(all[i + 1], all[i], all[i + 1].z, distance));
    }
    if (k > 0) all[begin - 1].z = std::min(all[begin - 1].z, all[begin].z / gear_of_z(k));
  }
  set_widths(course, samples);
  return samples;
}

}  // namespace viapoint::path_timing
