#include "viapoint/trajectory/timed_changes.hpp"

namespace viapoint {
namespace {

template <typename Visit>
void for_each_change(std::span<const TrajectoryPiece> pieces, const Visit& visit) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (int i = 0; i < pieces[k].outputs; ++i) {
      visit(k, pieces[k].output[static_cast<std::size_t>(i)]);
    }
  }
}

}  // namespace

TimedChanges::TimedChanges(std::span<const TrajectoryPiece> pieces, std::span<const double> starts,
                           std::uint64_t also)
    : outputs_(also) {
  for_each_change(pieces, [&](std::size_t /*piece*/, const OutputChange& change) {
    if (change.time != 0.0) outputs_ |= std::uint64_t{1} << change.index;
  });
  if (outputs_ == 0) return;

  const auto belongs = [&](const OutputChange& change) {
    return (outputs_ >> change.index & 1U) != 0;
  };
  std::array<std::size_t, kDigitalOutputs> count{};
  for_each_change(pieces, [&](std::size_t /*piece*/, const OutputChange& change) {
    if (belongs(change)) ++count[static_cast<std::size_t>(change.index)];
  });
  for (std::size_t i = 0; i < count.size(); ++i) begins_[i + 1] = begins_[i] + count[i];
  changes_.resize(begins_.back());
  std::array<std::size_t, kDigitalOutputs + 1> next = begins_;
  for_each_change(pieces, [&](std::size_t piece, const OutputChange& change) {
    if (!belongs(change)) return;
    changes_[next[static_cast<std::size_t>(change.index)]++] = {starts[piece], change.time, piece,
                                                                change.value};
  });
}

}  // namespace viapoint
