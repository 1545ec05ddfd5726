/// @file
/// The subcommands. Each prints one JSON object a case.
#pragma once

namespace viapoint::bench {

/// Computing time of the interpolator's tick, in virtual time. @param ticks to measure a case
void bench_tick(int ticks);
/// Random motions under random commands (override, pause, step, backward), replayed against their
/// geometry and limits. @param sequences to run
void bench_commands(int sequences);
/// Planning time a move. @param programs to plan a case
void bench_plan(int programs);
/// Time of the certificate a piece. @param programs whose motions are certified
void bench_certificate(int programs);
/// Random walks in joint space, corners rounded: how much of the time of stopping at every point is
/// left, and what planning costs a point. @param paths to plan a case
void bench_walk(int paths);
/// Programs of 10, 100, … moves: time and memory a move, each size in a process of its own.
/// @param moves of the longest program
void bench_growth(int moves);
/// Streams of a hundredth of `moves`, a tenth and all, run in virtual time: time and memory, each
/// in a process of its own. @param moves of the longest stream, at least 100
void bench_stream(int moves);
/// Lines, and arcs, helices and splines, at random on five arms as joints: how many can be
/// followed, and whether any of 1000 places of every piece is beyond what was proven; then the
/// knots of lines beside Taylor's.
/// @param problems of each of the three kinds for each arm
void bench_insertion(int problems);
/// Inverse kinematics of every built-in arm at random poses within its limits: times, poses left
/// unsolved, and branches that miss the joints that made the pose. @param poses for each arm
void bench_kinematics(int poses);
/// Random straight lines, half of them through a singular wrist, followed pose by pose: steps that
/// fail, jumps, and lines that no choice of branch follows. @param lines for each arm
void bench_tracking(int lines);

/// Programs and streams one after the other on the loop with the machine's clock, random commands,
/// jogs, inputs and outputs from three threads meanwhile, and a fourth that watches: every logged
/// cycle against limits and path. @param seconds that it takes, at least
void bench_soak(int seconds);

/// Prints random programs for four arms, each with its robot and seed, to be planned by who reads
/// them. @param programs in all
void print_random_programs(int programs);
/// Prints stops from random moments of random motions, each with limits and path, so that who reads
/// them can look for a shorter one. @param stops to try on each of four arms, and under random
/// limits; those that
///   the motion's end forestalls are left out
void print_stops(int stops);

}  // namespace viapoint::bench
