#include "trajectory/path_timing_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

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

std::span<const double> places(const Stretch& stretch) {
  if (stretch.straight || stretch.tool != nullptr) return kStraightPlaces;
  return kCurvedPlaces;
}

/// Growth of z = ṡ^{3/2} with s over that of a ramp from rest, √(9/2 s⃛): the rest of the jerk is
/// spent where acceleration turns over.
constexpr double kGrowth = 0.5;
/// Length of a cell over w.
constexpr double kCellShare = 0.8;

/// What the limits allow at one place, by the simplest of arguments.
struct Sample {
  double s;
  double z;  ///< ṡ^{3/2} at which a constant speed keeps every limit; after the sweeps, reachable
  double change;           ///< |s̈| where q'' does not count
  double jerk;             ///< |s⃛| where q'' and q''' do not count
  double growth = 0.0;     ///< of z with s, likewise
  double width = 0.0;      ///< w
  double top = kInfinite;  ///< z that a steady ceiling on the speed allows, where that rules

  [[nodiscard]] bool cruises() const { return z >= top; }
};

struct Samples {
  std::vector<Sample> all;
  std::vector<size_t> first;  ///< of each stretch, and the end

  [[nodiscard]] const Sample* of(size_t stretch) const { return &all[first[stretch]]; }
  [[nodiscard]] size_t parts(size_t stretch) const {
    return first[stretch + 1] - first[stretch] - 1;
  }
};

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
  double v = 0.0, a = 0.0, j = 0.0, bend = 0.0, twist = 0.0, steady = kInfinite;
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
    steady = tool.velocity;
    for (const ToolCone& cone : tool.cones) {
      a = std::max(a, cone.slope);
      bend = std::max(bend, std::hypot(cone.b, cone.normal));
    }
  }
  const double z =
      std::min({1.0 / (v * std::sqrt(v)), three_quarters(1.0 / bend), 1.0 / std::sqrt(twist)});
  Sample sample{s, z, 1.0 / a, 1.0 / j};
  if (v == steady && z == 1.0 / (v * std::sqrt(v))) sample.top = z;
  return sample;
}

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
  constexpr double kCruise = 0.5;
  for (Sample& sample : samples.all) sample.width = kGrowth * sample.z / sample.growth;
  for (size_t k = 0; k < course.stretches().size(); ++k) {
    const size_t begin = samples.first[k], end = samples.first[k + 1];
    for (size_t first = begin; first < end; ++first) {
      if (!samples.all[first].cruises()) continue;
      size_t last = first;
      while (last + 1 < end && samples.all[last + 1].cruises()) ++last;
      for (size_t i = first; i <= last; ++i) {
        Sample& sample = samples.all[i];
        const double from = samples.all[first].s, to = samples.all[last].s;
        sample.width += kCruise * std::min(sample.s - from, to - sample.s);
      }
      first = last;
    }
  }
}

Samples sweep(const Course& course) {
  Samples samples;
  const auto& stretches = course.stretches();
  samples.first.reserve(stretches.size() + 1);
  samples.all.reserve(stretches.size() * kStraightPlaces.size());
  double least_z = kInfinite, least_change = kInfinite, least_jerk = kInfinite;
  for (size_t k = 0; k < stretches.size(); ++k) {
    samples.first.push_back(samples.all.size());
    const Stretch& stretch = stretches[k];
    for (const double place : places(stretch)) {
      const double s = stretch.length * place;
      const Sample sample =
          stretch.straight ? straight_sample(stretch, s) : curved_sample(course, k, s);
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
    sample.growth = kGrowth * std::sqrt(4.5 * sample.jerk);
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

/// Length of the ramp out of rest: constant jerk is best up to there.
double ramp_length(const Samples& samples, bool from_end) {
  const size_t count = samples.all.size();
  const auto at = [&](size_t k) -> const Sample& {
    return samples.all[from_end ? count - 1 - k : k];
  };
  double peak = 0.0;
  for (size_t k = 1; k < count && at(k).width >= peak; ++k) peak = at(k).width;
  const Sample& near = at(1);
  const double rise = near.change * near.change * near.change / (6.0 * near.jerk * near.jerk);
  const size_t parts = samples.parts(from_end ? samples.first.size() - 2 : 0);
  const double first = std::abs(at(parts).s - at(0).s);
  return std::min({0.1 * peak, 0.4 * rise, 0.25 * first});
}

/// z between samples, by share.
struct Between {
  const Sample* before;
  double share;
};

Between find(const Samples& samples, size_t stretch, double s) {
  const Sample* first = samples.of(stretch);
  const Sample* before = first;
  const Sample* last = first + samples.parts(stretch) - 1;
  while (before != last && before[1].s <= s) ++before;
  return {before, std::clamp((s - before[0].s) / (before[1].s - before[0].s), 0.0, 1.0)};
}

/// Cuts [from, to] of one stretch into cells of equal ∫ ds / w.
void cut(const Samples& samples, size_t stretch, double from, double to, double floor, int least,
         int most, std::vector<Cell>& cells) {
  const Sample* first = samples.of(stretch);
  std::array<double, kStraightPlaces.size() + 2> s{}, w{}, sum{};
  size_t count = 0;
  const auto push = [&](double x) {
    const auto [before, share] = find(samples, stretch, x);
    const double width = (1 - share) * before[0].width + share * before[1].width;
    s[count] = x;
    w[count++] = std::max(floor, width);
  };
  push(from);
  for (size_t k = 1; k < samples.parts(stretch); ++k) {
    if (first[k].s > from && first[k].s < to) push(first[k].s);
  }
  push(to);
  // w is linear between samples, so its inverse integrates to a logarithm.
  for (size_t k = 1; k < count; ++k) {
    const double ratio = w[k] / w[k - 1];
    const double inverse =
        std::abs(ratio - 1.0) < 1e-6 ? 1.0 / w[k] : std::log(ratio) / (w[k] - w[k - 1]);
    sum[k] = sum[k - 1] + (s[k] - s[k - 1]) * inverse;
  }
  const double total = sum[count - 1];
  // Speeds that leave the range of doubles leave no widths to cut by.
  if (!std::isfinite(total)) {
    cells.push_back({stretch, from, to});
    return;
  }
  const int n =
      static_cast<int>(std::clamp(std::ceil(total / kCellShare), double(least), double(most)));
  double start = from;
  size_t at = 1;
  for (int k = 1; k <= n; ++k) {
    const double want = total * k / n;
    while (at + 1 < count && sum[at] < want) ++at;
    const double t = (want - sum[at - 1]) / (sum[at] - sum[at - 1]);
    const double ratio = w[at] / w[at - 1];
    const double part =
        std::abs(ratio - 1.0) < 1e-6 ? t : (std::pow(ratio, t) - 1.0) / (ratio - 1.0);
    const double end = k == n ? to : s[at - 1] + part * (s[at] - s[at - 1]);
    cells.push_back({stretch, start, end});
    start = end;
  }
}

bool is_positive(double x) { return std::isfinite(x) && x > 0.0; }

/// The guess: the swept speed, its valleys and peaks smoothed over neighbours.
std::vector<double> guess(const Samples& samples, const std::vector<Cell>& cells) {
  const size_t nodes = cells.size() - 1;
  std::vector<double> z(nodes), gear(nodes);  // gear: of z, into the cell after the node
  for (size_t k = 0; k < nodes; ++k) {
    const auto [before, share] = find(samples, cells[k].piece, cells[k].s1);
    z[k] = (1 - share) * before[0].z + share * before[1].z;
    gear[k] = cells[k + 1].gear == 1.0 ? 1.0 : cells[k + 1].gear * std::sqrt(cells[k + 1].gear);
  }
  for (int pass = 0; pass < 2; ++pass) {
    double before = z.front();
    for (size_t k = 1; k + 1 < nodes; ++k) {
      const double here = z[k];
      z[k] = 0.25 * before * gear[k - 1] + 0.5 * here + 0.25 * z[k + 1] / gear[k];
      before = here;
    }
  }
  for (double& value : z) value *= std::cbrt(value);
  return z;
}

}  // namespace

Grid make_grid(const Course& course) {
  const Samples samples = sweep(course);
  const double start = ramp_length(samples, false);
  const double end = ramp_length(samples, true);
  if (!is_positive(start) || !is_positive(end)) return {};
  const double floor = 0.5 * std::min(start, end);
  Grid grid;
  const size_t count = course.stretches().size();
  for (size_t k = 0; k < count; ++k) {
    const Stretch& stretch = course.stretches()[k];
    const size_t begin = grid.cells.size();
    double from = 0.0, to = stretch.length;
    if (k == 0) {
      grid.cells.push_back({0, 0.0, start});
      from = start;
    }
    if (k + 1 == count) to -= end;
    cut(samples, k, from, to, floor, stretch.straight ? 1 : 2,
        stretch.straight || stretch.tool != nullptr ? 64 : 16, grid.cells);
    if (k + 1 == count) grid.cells.push_back({k, to, stretch.length});
    grid.cells[begin].gear = stretch.gear;
  }
  constexpr size_t kFewestCells = 3;  // two nodes between them
  const bool cut_well = std::all_of(grid.cells.begin(), grid.cells.end(),
                                    [](const Cell& cell) { return is_positive(cell.length()); });
  if (!cut_well || grid.cells.size() < kFewestCells) return {};
  grid.square_rate = guess(samples, grid.cells);
  if (!std::all_of(grid.square_rate.begin(), grid.square_rate.end(), is_positive)) return {};
  return grid;
}

Grid refine(const Grid& grid, const std::vector<bool>& split, SquareRate& rate) {
  Grid finer;
  SquareRate between;
  for (size_t k = 0; k < grid.cells.size(); ++k) {
    Cell cell = grid.cells[k];
    if (k > 0 && k + 1 < grid.cells.size() && split[k]) {
      Cell half = cell;
      half.s1 = cell.s0 = 0.5 * (cell.s0 + cell.s1);
      cell.gear = 1.0;
      const double h = grid.cells[k].length(), gear = half.gear;
      const Four x{gear * gear * rate[k - 1].value, h * gear * rate[k - 1].slope, rate[k].value,
                   h * rate[k].slope};
      finer.cells.push_back(half);
      between.push_back({dot(basis(0.5), x), dot(basis_slope(0.5), x) / h});
    }
    finer.cells.push_back(cell);
    if (k + 1 < grid.cells.size()) between.push_back(rate[k]);
  }
  rate = std::move(between);
  for (const NodeRate& node : rate) finer.square_rate.push_back(node.value);
  return finer;
}

}  // namespace viapoint::path_timing
