/// @file
/// Where in a cell the timing looks: the places of its jerk rows, and those of its quadrature.
#pragma once

#include <array>

#include "trajectory/path_timing_newton.hpp"

namespace viapoint::path_timing {

/// b, h b', h² b'' at a place, by the cell's four numbers.
struct Place {
  double at;
  Four value = basis(at), slope = basis_slope(at), bend = basis_bend(at);
};
/// Of the jerk rows.
inline constexpr std::array<Place, 3> kCurvedPlaces{{{0.0}, {0.5}, {1.0}}};
inline constexpr std::array<Place, 3> kStraightPlaces{{{0.0}, {0.5}, {1.0}}};
/// Of the row of acceleration inside a straight cell; nodes have their own.
inline constexpr Place kMiddle{0.5};

/// Gauss–Legendre on [0, 1].
struct Quadrature {
  double at, weight;
  Four value = basis(at);
};
inline constexpr std::array<Quadrature, 3> kGauss3{
    {{0.1127016653792583, 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.8872983346207417, 5.0 / 18.0}}};
inline constexpr std::array<Quadrature, 5> kGauss5{{{0.046910077030668, 0.1184634425280945},
                                                    {0.2307653449471585, 0.2393143352496832},
                                                    {0.5, 0.2844444444444444},
                                                    {0.7692346550528415, 0.2393143352496832},
                                                    {0.953089922969332, 0.1184634425280945}}};

}  // namespace viapoint::path_timing
