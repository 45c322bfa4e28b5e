// What motion costs an axis in each cycle: N axes at 1 kHz, each going to and fro between 0 and 500 u for ever (400 u/s, 500 u/s2) by
// its own MC_MoveAbsolute, with MC_Power and MC_ReadStatus beside it. The drives are virtual: the figures are axis, blocks and planner.
// Then the worst case for real time: every axis gets a new target in the same cycle; and what a slave of a gear, of a cam, and a superimposed
// motion cost. Nothing may be allocated while it is measured: the guard ends the program.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/guard/allocation_guard.hpp"
#include "tests/bench/moving_axes.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::bench;

double timed(const auto& work) {
    const NoAllocationScope guard{NoAllocationScope::On::allocation_abort};
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
}

struct Spread {
    explicit Spread(std::vector<double> all) : ns(std::move(all)) { std::sort(ns.begin(), ns.end()); }
    [[nodiscard]] double at(double part) const { return ns[static_cast<std::size_t>(part * static_cast<double>(ns.size() - 1))]; }
    std::vector<double> ns;
};

void ping_pong(std::size_t count) {
    Shuttles shuttles{count};
    const std::size_t cycles = std::max<std::size_t>(4000, 400'000 / count);
    std::vector<double> ns;
    ns.reserve(cycles);
    std::size_t moving = 0;
    for (std::size_t i = 0; i < cycles; ++i) {
        ns.push_back(timed([&] { shuttles.cycle(count); }) / static_cast<double>(count));
        if (i % 64 == 0) moving += shuttles.in_motion();
    }
    const Spread spread{std::move(ns)};
    const double share = 100.0 * static_cast<double>(moving) / static_cast<double>(count * ((cycles + 63) / 64));
    fmt::print("{:>6} {:>10.1f} {:>10.1f} {:>10.1f} {:>12.1f} {:>11.1f}\n", count, spread.at(0.5), spread.at(0.99), spread.at(0.999),
               spread.at(1), share);
}

void burst(std::size_t count) {
    Shuttles shuttles{count};
    std::vector<double> us;
    for (int i = 0; i < 2000; ++i) {
        for (int k = 0; k < 137; ++k) shuttles.cycle(count);
        shuttles.command_all = true;
        us.push_back(timed([&] { shuttles.cycle(count); }) / 1000);
    }
    const Spread spread{std::move(us)};
    fmt::print("{:>6} {:>10.1f} {:>10.1f} {:>10.1f}\n", count, spread.at(0.5), spread.at(0.99), spread.at(1));
}

void following(std::string_view what, const auto& begin) {
    constexpr std::size_t count = 64;
    Followers followers{count};
    begin(followers);
    std::vector<double> ns;
    for (int i = 0; i < 10000; ++i) ns.push_back(timed([&] { followers.cycle(); }) / static_cast<double>(count + 1));
    const Spread spread{std::move(ns)};
    fmt::print("{:<14} {:>8.1f} {:>10.1f} {:>10.1f}\n", what, spread.at(0.5), spread.at(0.99), spread.at(1));
}

}  // namespace

int main() {
    fmt::print("To and fro with MC_Power, MC_MoveAbsolute, MC_ReadStatus: ns per axis and cycle\n\n");
    fmt::print("{:>6} {:>10} {:>10} {:>10} {:>12} {:>11}\n", "axes", "p50", "p99", "p99.9", "max", "moving %");
    for (const std::size_t count : {1, 8, 32, 128, 512}) ping_pong(count);
    fmt::print("\nAll axes re-commanded in one cycle, from wherever they are: us per cycle\n\n");
    fmt::print("{:>6} {:>10} {:>10} {:>10}\n", "axes", "p50", "p99", "max");
    burst(64);
    fmt::print("\n64 axes after a master, without blocks: ns per axis and cycle\n\n");
    fmt::print("{:<14} {:>8} {:>10} {:>10}\n", "", "p50", "p99", "max");
    following("standing", [](Followers&) {});
    following("at velocity", [](Followers& f) { f.run_all(); });
    following("geared", [](Followers& f) { f.run_master(), f.gear(); });
    following("on a cam", [](Followers& f) { f.run_master(), f.cam(); });
    following("superimposed", [](Followers& f) { f.run_all(), f.superimpose(); });
    return 0;
}
