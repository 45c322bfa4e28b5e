// What a cycle of the bus costs the cycle thread: Master::receive() + send() for 8, 64 and 200 slaves of 16 + 16 bytes, each slave
// a sync unit of its own (the default) and all in one unit. The simulated slaves answer between the cycles and are not counted.

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

#include "core/histogram.hpp"
#include "ecat/master.hpp"
#include "tests/bench/between_cycles.hpp"
#include "tests/bench/plain_bus.hpp"

namespace {

using namespace taktwerk;
using namespace std::chrono_literals;
using Stopwatch = std::chrono::steady_clock;

double us(Duration d) { return static_cast<double>(d.count()) / 1000.0; }

void run(std::size_t slaves, const std::string& unit, int cycles) {
    Instant now{1s};
    auto config = bench::terminals(slaves, unit);
    ecat::sim::SimNetwork network{now};
    bench::plug_in(network, config);
    bench::BetweenCycles wire{network};
    ecat::Master master{wire, config};
    Histogram receive, send, total;
    const auto cycle = [&](bool count) {
        now += 1ms;
        const auto begin = Stopwatch::now();
        master.receive(now);
        const auto middle = Stopwatch::now();
        master.send(now);
        const auto end = Stopwatch::now();
        if (count) {
            receive.record(middle - begin);
            send.record(end - middle);
            total.record(end - begin);
        }
        wire.deliver(now + 500us);
        master.step(now);
    };
    master.start();
    const auto wall = Stopwatch::now();
    while (master.phase() != ecat::Master::Phase::operational) {
        cycle(false);
        if (master.phase() == ecat::Master::Phase::failed || now > Instant{120s}) {
            fmt::print(stderr, "{} | {}\n", master.failure().text(), master.progress());
            std::exit(1);
        }
    }
    const double reached = std::chrono::duration<double>(now - Instant{1s}).count();
    for (int i = 0; i < 100; ++i) cycle(false);
    for (int i = 0; i < cycles; ++i) cycle(true);
    const double on_wire = static_cast<double>(wire.wire_bytes()) * 0.08;  // 80 ns a byte at 100 Mbit/s
    fmt::print("{:>6} {:<9} {:>6} {:>8.1f}   {:>8.2f} {:>8.2f}   {:>8.2f} {:>8.2f}   {:>8.2f} {:>8.2f} {:>8.2f}   {:>6.2f} s ({:.1f} s)\n",
               slaves, unit.empty() ? "per slave" : "one unit", wire.frames_sent(), on_wire, us(receive.percentile(50)),
               us(receive.percentile(99)), us(send.percentile(50)), us(send.percentile(99)), us(total.percentile(50)),
               us(total.percentile(99)), us(total.max()), reached, std::chrono::duration<double>(Stopwatch::now() - wall).count());
}

}  // namespace

int main() {
    fmt::print("Master::receive() and send() on the cycle thread, us; slaves of 16 + 16 bytes.\n");
    fmt::print("{:>6} {:<9} {:>6} {:>8}   {:>17}   {:>17}   {:>26}   {}\n", "slaves", "units", "frames", "wire us", "receive p50/p99",
               "send p50/p99", "total p50/p99/max", "to OP, machine time (all of it, wall)");
    for (const std::size_t slaves : {8, 64, 200})
        for (const auto* unit : {"", "all"}) run(slaves, unit, slaves > 100 ? 2000 : 10000);
    return 0;
}
