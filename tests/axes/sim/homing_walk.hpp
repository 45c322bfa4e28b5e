#pragma once
// Where each homing method must end and which way it must set out, typed from the standard's and the manuals' tables for one bench, and a
// walk that finds out what a simulated drive does. Sources: CiA 402-2 figures of the methods; SV33-E 3.4.3(9) tables 3-77 to 3-92;
// SE-808X 3.2.7 (17 to 22); SV-DA200 3.4.6 (1 to 4, 17 to 20, 35).
//
//    stop  switch                      home switch                     switch  stop
//    -60k   -50k                       0 ........ 25k                    50k    60k
//       pulse every 10k:   ... -47k ... -7k   3k   13k   23k   33k   43k ...

#include <array>
#include <cmath>
#include <cstdint>

#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim::walk {

constexpr double fast = 40000, slow = 8000, acceleration = 400000;
constexpr std::int64_t home_offset = 700;

inline PlantConfig rail(double start) {
    PlantConfig plant;
    plant.counts_per_revolution = 10000;
    plant.negative_stop = -60000;
    plant.positive_stop = 60000;
    plant.negative_limit = -50000;
    plant.positive_limit = 50000;
    plant.home_from = 0;
    plant.home_to = 25000;
    plant.index_pulse = 3000;
    plant.start = start;
    return plant;
}

constexpr double left = -20000, on = 12500, right = 40000;
constexpr std::array<double, 7> starts{left, on, right, -50100, -51000, 50100, 51000};

/// It fails: at a limit switch that it neither looks for nor turns at. No manual says so of SV33-E and SE-808X; see homing_run.hpp.
constexpr double fails = 1e9;

/// First way ('+', '-', '0': none) and end, in counts of the rail.
struct Expected {
    char way;
    double end;
};
struct Row {
    int method;
    Expected left, on, right;
    Expected negative, positive;  ///< at that limit switch, or beyond it
};

// clang-format off
inline constexpr Row oracle[] = {
    // first pulse beside a limit switch
    {1,  {'-', -47000}, {'-', -47000}, {'-', -47000}, {'+', -47000}, {'-', -47000}},
    {2,  {'+', 43000},  {'+', 43000},  {'+', 43000},  {'+', 43000},  {'-', 43000}},
    // first pulse beside the lower edge (a switch at the positive end): 3 outside, 4 inside; upper edge: 5 outside, 6 inside
    {3,  {'+', -7000},  {'-', -7000},  {'+', fails},  {'+', -7000},  {'0', fails}},
    {4,  {'+', 3000},   {'-', 3000},   {'+', fails},  {'+', 3000},   {'0', fails}},
    {5,  {'-', fails},  {'+', 33000},  {'-', 33000},  {'0', fails},  {'-', 33000}},
    {6,  {'-', fails},  {'+', 23000},  {'-', 23000},  {'0', fails},  {'-', 23000}},
    // first forward, turning at the positive limit: pulses left and right of the lower edge, left and right of the upper one
    {7,  {'+', -7000},  {'-', -7000},  {'+', -7000},  {'+', -7000},  {'-', -7000}},
    {8,  {'+', 3000},   {'-', 3000},   {'+', 3000},   {'+', 3000},   {'-', 3000}},
    {9,  {'+', 23000},  {'+', 23000},  {'+', 23000},  {'+', 23000},  {'-', 23000}},
    {10, {'+', 33000},  {'+', 33000},  {'+', 33000},  {'+', 33000},  {'-', 33000}},
    // first in reverse, turning at the negative limit: right and left of the upper edge, right and left of the lower one
    {11, {'-', 33000},  {'+', 33000},  {'-', 33000},  {'+', 33000},  {'-', 33000}},
    {12, {'-', 23000},  {'+', 23000},  {'-', 23000},  {'+', 23000},  {'-', 23000}},
    {13, {'-', 3000},   {'-', 3000},   {'-', 3000},   {'+', 3000},   {'-', 3000}},
    {14, {'-', -7000},  {'-', -7000},  {'-', -7000},  {'+', -7000},  {'-', -7000}},
    // the edges themselves
    {17, {'-', -50000}, {'-', -50000}, {'-', -50000}, {'+', -50000}, {'-', -50000}},
    {18, {'+', 50000},  {'+', 50000},  {'+', 50000},  {'+', 50000},  {'-', 50000}},
    {19, {'+', 0},      {'-', 0},      {'+', fails},  {'+', 0},      {'0', fails}},
    {20, {'+', 0},      {'-', 0},      {'+', fails},  {'+', 0},      {'0', fails}},
    {21, {'-', fails},  {'+', 25000},  {'-', 25000},  {'0', fails},  {'-', 25000}},
    {22, {'-', fails},  {'+', 25000},  {'-', 25000},  {'0', fails},  {'-', 25000}},
    {23, {'+', 0},      {'-', 0},      {'+', 0},      {'+', 0},      {'-', 0}},
    {24, {'+', 0},      {'-', 0},      {'+', 0},      {'+', 0},      {'-', 0}},
    {25, {'+', 25000},  {'+', 25000},  {'+', 25000},  {'+', 25000},  {'-', 25000}},
    {26, {'+', 25000},  {'+', 25000},  {'+', 25000},  {'+', 25000},  {'-', 25000}},
    {27, {'-', 25000},  {'+', 25000},  {'-', 25000},  {'+', 25000},  {'-', 25000}},
    {28, {'-', 25000},  {'+', 25000},  {'-', 25000},  {'+', 25000},  {'-', 25000}},
    {29, {'-', 0},      {'-', 0},      {'-', 0},      {'+', 0},      {'-', 0}},
    {30, {'-', 0},      {'-', 0},      {'-', 0},      {'+', 0},      {'-', 0}},
    // next pulse in reverse, forward
    {33, {'-', -27000}, {'-', 3000},   {'-', 33000},  {'0', fails},  {'-', 43000}},
    {34, {'+', -17000}, {'+', 13000},  {'+', 43000},  {'+', -47000}, {'0', fails}},
    // against the mechanics; with limit switches in front of them they fail there
    {-1, {'-', fails},  {'-', fails},  {'-', fails},  {'0', fails},  {'-', fails}},
    {-2, {'+', fails},  {'+', fails},  {'+', fails},  {'+', fails},  {'0', fails}},
};
// clang-format on

/// Nothing: no such method in the standard or in a manual.
inline const Row* row(int method) {
    for (const auto& r : oracle)
        if (r.method == method) return &r;
    return nullptr;
}
inline Expected expected(const Row& r, double start) {
    if (start == left) return r.left;
    if (start == on) return r.on;
    if (start == right) return r.right;
    return start < 0 ? r.negative : r.positive;
}

struct Seen {
    bool attained = false, target_reached = false, error = false, faulted = false;
    std::uint16_t code = 0;
    char way = '0';
    double end = 0;                    ///< where the axis says home is, counts of the rail
    double fastest = 0, steepest = 0;  ///< counts/s, counts/s2
};

/// Homes as a careful master does and says what was seen.
inline Seen home(const PlantConfig& plant, const DriveProfile& profile, int method, const SimulatedMotor& motor = {}) {
    Bench b{plant, profile, motor};
    b.in.homing = {.method = method, .fast = fast, .slow = slow, .acceleration = acceleration};
    b.in.home_offset = home_offset;
    b.enable();
    b.in.mode = 6;
    b.run(300);
    b.in.control = 0x1F;
    Seen seen;
    const double before = b.axis.plant().position();
    double last = 0;
    const auto over = [&] { return (b.out.status & 0x3000u) != 0 || (b.out.status & 0x08u) != 0; };
    for (int i = 0; i < 30000 && !over(); ++i) {
        b.cycle();
        const double moved = b.axis.plant().position() - before, speed = b.axis.plant().velocity();
        if (seen.way == '0' && std::abs(moved) > 20) seen.way = moved > 0 ? '+' : '-';
        seen.fastest = std::max(seen.fastest, std::abs(speed));
        seen.steepest = std::max(seen.steepest, std::abs(speed - last) / 1e-3);
        last = speed;
    }
    b.run(300);
    seen.attained = (b.out.status & (1u << 12)) != 0;
    seen.target_reached = (b.out.status & (1u << 10)) != 0;
    seen.error = (b.out.status & (1u << 13)) != 0;
    seen.faulted = (b.out.status & 0x08u) != 0;
    seen.code = b.out.error_code;
    // Home has the coordinate of 607Ch (60E6h = 0), so the actual position tells where the axis takes home to be.
    seen.end = b.axis.plant().position() - static_cast<double>(b.out.position - home_offset);
    return seen;
}

}  // namespace taktwerk::axes::sim::walk
