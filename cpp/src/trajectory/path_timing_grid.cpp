#include "trajectory/path_timing_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "trajectory/path_timing_sweep.hpp"

namespace viapoint::path_timing {
namespace {

/// Length of a cell over w.
constexpr double kCellShare = 0.8;

/// The shortest ramp out of rest, of its stretch: one that is shorter, where jerk is next to free,
/// saves no time worth the name, and is lost in rounding.
constexpr double kLeastRamp = 1e-4;

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
  return std::min({0.1 * peak, std::max(0.4 * rise, kLeastRamp * first), 0.25 * first});
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
  std::array<double, kMostPlaces + 2> s{}, w{}, sum{};
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

/// How few and how many cells a stretch gets. A ceiling of the tool's speed is only followed, and
/// its acceleration only kept, by more than one or two.
std::pair<int, int> cells_of(const Stretch& stretch) {
  if (stretch.straight) return {1, 64};
  return stretch.tool != nullptr ? std::pair(4, 64) : std::pair(2, 16);
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
    const auto [fewest, most] = cells_of(stretch);
    cut(samples, k, from, to, floor, fewest, most, grid.cells);
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
