// Round trip and CPU of a master at 1 ms over a veth pair, the simulated slaves on a thread at its other end: what kernel, socket
// and scheduler of this machine add. Makes its own network namespace (root, or a user namespace). Arguments: seconds (30).
//
// Google Benchmark's arguments, which `./dev bench` hands to every program, are ignored.

#include <poll.h>
#include <sched.h>
#include <sys/utsname.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/histogram.hpp"
#include "ecat/master.hpp"
#include "ecat/transport/raw_socket.hpp"
#include "tests/bench/plain_bus.hpp"
#include "tests/ecat/transport/veth_pair.hpp"

namespace {

using namespace taktwerk;
using namespace std::chrono_literals;
using Stopwatch = std::chrono::steady_clock;

double us(Duration d) { return static_cast<double>(d.count()) / 1000.0; }

/// Priority as the runtime asks for; whether it was granted belongs to the figures.
bool realtime(int priority) {
    sched_param parameters{};
    parameters.sched_priority = priority;
    return ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

/// Answers until told to stop, as `taktwerk sim --nic` does.
void play_slaves(const ecat::BusConfig& config, ecat::RawSocketTransport& nic, const std::atomic<bool>& stop) {
    realtime(60);
    SystemClock clock;
    ecat::sim::SimNetwork network{clock.now()};
    bench::plug_in(network, config);
    std::array<std::byte, ecat::max_frame_size> buffer{};
    while (!stop.load()) {
        pollfd wait{nic.descriptor(), POLLIN, 0};
        ::poll(&wait, 1, 1);
        while (const auto received = nic.receive(buffer, clock.now())) {
            const std::span<std::byte> frame{buffer.data(), received->size};
            const Instant now = clock.now();
            network.advance(now);
            if (network.process(frame, now)) nic.send(frame, now);
        }
        network.advance(clock.now());
    }
}

void run(std::size_t slaves, int seconds) {
    const auto config = bench::terminals(slaves);
    auto master_nic = ecat::RawSocketTransport::open("ecat0");
    auto slave_nic = ecat::RawSocketTransport::open("ecat1");
    if (!master_nic || !slave_nic) {
        fmt::print(stderr, "{}\n", (master_nic ? slave_nic : master_nic).error().text());
        std::exit(1);
    }
    for (const auto& text : (*master_nic)->report().refused) fmt::print("  {}\n", text);
    std::atomic<bool> stop{false};
    std::thread other_end{[&] { play_slaves(config, **slave_nic, stop); }};

    SystemClock clock;
    ecat::Master master{**master_nic, config};
    Histogram round_trip, cpu, late;
    Instant wake = clock.now();
    std::uint64_t lost_before = 0;
    const auto cycle = [&](bool count) {
        wake += 1ms;
        clock.sleep_until(wake);
        const Instant now = clock.now();
        master.receive(now);
        master.send(clock.now());
        const Instant done = clock.now();
        if (count) {
            late.record(now - wake);
            cpu.record(done - now);
            round_trip.record(master.statistics().round_trip);
        }
        master.step(done);
        if (now - wake > 5ms) wake = now;  // a stall is measured once
    };
    master.start();
    (*master_nic)->refresh();
    for (int i = 0; i < 60'000 && master.phase() != ecat::Master::Phase::operational && master.phase() != ecat::Master::Phase::failed; ++i)
        cycle(false);
    if (master.phase() == ecat::Master::Phase::operational) {
        for (int i = 0; i < 500; ++i) cycle(false);
        lost_before = master.statistics().frames_lost;
        for (int i = 0; i < seconds * 1000; ++i) {
            cycle(true);
            if (i % 100 == 0) (*master_nic)->refresh();
        }
        const auto row = [&](const char* what, const Histogram& h) {
            fmt::print("{:>6} {:<28} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f}\n", slaves, what, us(h.percentile(50)), us(h.percentile(99)),
                       us(h.percentile(99.9)), us(h.max()));
        };
        row("round trip", round_trip);
        row("receive + send, wall", cpu);
        row("wake-up late", late);
        const auto& seen = master.statistics();
        fmt::print("{:>6} {} cycles: {} frames lost, {} late, {} dropped by the socket, {} working counters wrong; stamps: {}\n", slaves,
                   seconds * 1000, seen.frames_lost - lost_before, seen.frames_late, (*master_nic)->statistics().dropped,
                   seen.working_counter_errors, (*master_nic)->report().time_stamps);
    } else {
        fmt::print(stderr, "no OP: {} | {}\n", master.failure().text(), master.progress());
    }
    stop = true;
    other_end.join();
}

}  // namespace

int main(int argc, char** argv) {
    const int given = argc > 1 ? std::atoi(argv[1]) : 0;
    const int seconds = given > 0 ? given : 30;
    if (const auto& problem = ecat::test::veth_network(); !problem.empty()) {
        fmt::print("round trip: skipped, {}\n", problem);
        return 0;
    }
    utsname system{};
    ::uname(&system);
    fmt::print("Round trip over veth at 1 ms, {} s each, us; Linux {}, {} CPUs, {}.\n", seconds, system.release,
               std::thread::hardware_concurrency(), realtime(70) ? "SCHED_FIFO" : "no real-time priority");
    fmt::print("{:>6} {:<28} {:>9} {:>9} {:>9} {:>9}\n", "slaves", "", "p50", "p99", "p99.9", "max");
    for (const std::size_t slaves : {8, 64}) run(slaves, seconds);
    return 0;
}
