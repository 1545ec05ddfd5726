#include "trajectory/path_timing_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viapoint::path_timing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// Samples of a path piece are this many and one.
constexpr int kParts = 8;
/// Length of a cell over w.
constexpr double kCellShare = 0.55;

/// What the limits allow at one place, by the simplest of arguments.
struct Sample {
  size_t piece;
  double s;       ///< within the piece
  double b;       ///< ṡ² at which a constant speed keeps every limit; after the sweeps, reachable
  double change;  ///< |s̈| where q'' does not count
  double jerk;    ///< |s⃛| where q'' and q''' do not count
};

Sample sample_at(const JointPath& path, const JointLimits& limits, size_t index, double s) {
  const JointPiece& piece = path.pieces()[index];
  const PathPoint p = piece.at(s);
  double v = 1.0 / piece.rate_limit, a = 1.0 / piece.rate_change_limit;
  double j = 0.0, bend = 0.0, twist = 0.0;
  for (int i = 0; i < piece.joints(); ++i) {
    const double q1 = std::abs(p.q1[i]) / piece.scale;
    v = std::max(v, q1 / limits.velocity[i]);
    a = std::max(a, q1 / limits.acceleration[i]);
    j = std::max(j, q1 / limits.jerk[i]);
    bend = std::max(bend, std::abs(p.q2[i]) / (limits.acceleration[i] * piece.scale));
    twist = std::max(twist, std::abs(p.q3[i]) / (limits.jerk[i] * piece.scale));
  }
  const double b = std::min({1.0 / (v * v), 1.0 / bend, 1.0 / std::cbrt(twist * twist)});
  return {index, s, b, 1.0 / a, 1.0 / j};
}

/// ṡ² after `distance` at no more than the jerk and acceleration of a place.
double reachable(double b, double distance, double change, double jerk) {
  const double z = std::pow(b, 0.75) + std::sqrt(4.5 * jerk) * distance;
  return std::min(std::pow(z, 4.0 / 3.0), b + 2.0 * change * distance);
}

double scale_length(const Sample& sample) {
  return std::pow(sample.b, 0.75) / std::sqrt(4.5 * sample.jerk);
}

std::vector<Sample> sweep(const JointPath& path, const JointLimits& limits) {
  std::vector<Sample> samples;
  const size_t pieces = path.pieces().size();
  samples.reserve(pieces * (kParts + 1));
  double least_b = kInfinite, least_change = kInfinite, least_jerk = kInfinite;
  for (size_t k = 0; k < pieces; ++k) {
    for (int part = 0; part <= kParts; ++part) {
      samples.push_back(sample_at(path, limits, k, path.pieces()[k].length * part / kParts));
      least_b = std::min(least_b, samples.back().b);
      least_change = std::min(least_change, samples.back().change);
      least_jerk = std::min(least_jerk, samples.back().jerk);
    }
  }
  // Where q' vanishes nothing bounds the speed: any ceiling will do, this far above the rest.
  constexpr double kDecades = 1e6;
  for (Sample& sample : samples) {
    sample.b = std::min(sample.b, kDecades * least_b);
    sample.change = std::min(sample.change, kDecades * least_change);
    sample.jerk = std::min(sample.jerk, kDecades * least_jerk);
  }
  const auto step = [](const Sample& from, Sample& to) {
    const double distance = from.piece == to.piece ? std::abs(to.s - from.s) : 0.0;
    to.b = std::min(to.b, reachable(from.b, distance, std::min(from.change, to.change),
                                    std::min(from.jerk, to.jerk)));
  };
  samples.front().b = samples.back().b = 0.0;
  for (size_t k = 1; k < samples.size(); ++k) step(samples[k - 1], samples[k]);
  for (size_t k = samples.size() - 1; k-- > 0;) step(samples[k + 1], samples[k]);
  return samples;
}

/// Length of the ramp out of rest: constant jerk is best up to there.
double ramp_length(const std::vector<Sample>& samples, bool from_end) {
  const size_t count = samples.size();
  const auto at = [&](size_t k) -> const Sample& { return samples[from_end ? count - 1 - k : k]; };
  double peak = 0.0;
  for (size_t k = 1; k < count && scale_length(at(k)) >= peak; ++k) peak = scale_length(at(k));
  const Sample& near = at(1);
  const double rise = near.change * near.change * near.change / (6.0 * near.jerk * near.jerk);
  const double first = std::abs(at(kParts).s - at(0).s);
  return std::min({0.1 * peak, 0.4 * rise, 0.25 * first});
}

/// Cuts [from, to] of one piece into cells of equal ∫ ds / w.
void cut(const std::vector<Sample>& samples, size_t piece, double from, double to, double floor,
         int least, int most, std::vector<Cell>& cells) {
  const Sample* first = &samples[piece * (kParts + 1)];
  std::array<double, kParts + 3> s{}, w{}, sum{};
  size_t count = 0;
  const auto width_at = [&](double x) {
    const double step = first[1].s - first[0].s;
    const auto k = static_cast<size_t>(std::clamp(x / step, 0.0, kParts - 1.0));
    const double t = std::clamp((x - first[k].s) / step, 0.0, 1.0);
    return std::max(floor, (1 - t) * scale_length(first[k]) + t * scale_length(first[k + 1]));
  };
  const auto push = [&](double x) {
    s[count] = x;
    w[count++] = width_at(x);
  };
  push(from);
  for (int k = 1; k < kParts; ++k) {
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
    cells.push_back({piece, from, to});
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
    cells.push_back({piece, start, end});
    start = end;
  }
}

bool is_positive(double x) { return std::isfinite(x) && x > 0.0; }

}  // namespace

Grid make_grid(const JointPath& path, const JointLimits& limits) {
  const std::vector<Sample> samples = sweep(path, limits);
  const double start = ramp_length(samples, false);
  const double end = ramp_length(samples, true);
  if (!is_positive(start) || !is_positive(end)) return {};
  const double floor = 0.5 * std::min(start, end);
  Grid grid;
  const size_t pieces = path.pieces().size();
  for (size_t k = 0; k < pieces; ++k) {
    const JointPiece& piece = path.pieces()[k];
    double from = 0.0, to = piece.length;
    if (k == 0) {
      grid.cells.push_back({0, 0.0, start});
      from = start;
    }
    if (k + 1 == pieces) to -= end;
    const bool curved = piece.kind != PieceKind::kJointLine;
    cut(samples, k, from, to, floor, curved ? 4 : 2, curved ? 16 : 64, grid.cells);
    if (k + 1 == pieces) grid.cells.push_back({k, to, piece.length});
  }
  constexpr size_t kFewestCells = 3;  // two nodes between them
  const bool cut_well = std::all_of(grid.cells.begin(), grid.cells.end(),
                                    [](const Cell& cell) { return is_positive(cell.length()); });
  if (!cut_well || grid.cells.size() < kFewestCells) return {};
  // The guess: the swept speed, its valleys and peaks smoothed over neighbours.
  const size_t nodes = grid.cells.size() - 1;
  std::vector<double> z(nodes);
  for (size_t k = 0; k < nodes; ++k) {
    const Cell& cell = grid.cells[k];
    const Sample* first = &samples[cell.piece * (kParts + 1)];
    const double step = first[1].s - first[0].s;
    const auto index = static_cast<size_t>(std::clamp(cell.s1 / step, 0.0, kParts - 1.0));
    const double t = std::clamp((cell.s1 - first[index].s) / step, 0.0, 1.0);
    z[k] = (1 - t) * std::pow(first[index].b, 0.75) + t * std::pow(first[index + 1].b, 0.75);
  }
  for (int pass = 0; pass < 2; ++pass) {
    double before = z.front();
    for (size_t k = 1; k + 1 < nodes; ++k) {
      const double here = z[k];
      z[k] = 0.25 * before + 0.5 * here + 0.25 * z[k + 1];
      before = here;
    }
  }
  grid.square_rate.resize(nodes);
  for (size_t k = 0; k < nodes; ++k) grid.square_rate[k] = std::pow(z[k], 4.0 / 3.0);
  if (!std::all_of(grid.square_rate.begin(), grid.square_rate.end(), is_positive)) return {};
  return grid;
}

}  // namespace viapoint::path_timing
