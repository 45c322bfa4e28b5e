// How late the runtime's cycle wakes beside what cyclictest measures: windows in turn, on the same CPU, at the same priority, each ms. Three of them: a
// whole machine on its real-time runner (eight axes that move), cyclictest's method as `taktwerk doctor` has it, and cyclictest itself where it is
// installed (package rt-tests). What travels from one computer to another is the ratio of their p99.9.
//
// Arguments: seconds of a window (5), windows of each (6), CPU (the last). Google Benchmark's arguments are ignored.

#include <sys/mman.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "apps/doctor/lateness.hpp"
#include "core/histogram.hpp"
#include "fb_library/all_blocks.hpp"
#include "runtime/run/realtime_runner.hpp"
#include "tests/bench/shuttle_machine.hpp"

namespace {

using namespace taktwerk;
using namespace std::chrono_literals;

constexpr int priority = 80;
constexpr std::size_t axes = 8;

/// Counts by whole us, as cyclictest prints them; from the machine's own histogram by the upper edge of each bucket (1/16 wide), rounded down.
using Counts = std::vector<std::uint64_t>;
constexpr std::size_t longest = 100'000;

void add(Counts& to, std::size_t us, std::uint64_t n) { to[std::min(us, longest)] += n; }

double percentile(const Counts& counts, double percent) {
    std::uint64_t all = 0, passed = 0;
    for (const auto n : counts) all += n;
    for (std::size_t us = 0; us < counts.size(); ++us)
        if (passed += counts[us]; static_cast<double>(passed) >= percent / 100 * static_cast<double>(all) - 1e-6 && passed > 0)
            return static_cast<double>(us);
    return 0;
}
double longest_of(const Counts& counts) {
    for (std::size_t us = counts.size(); us-- > 0;)
        if (counts[us] > 0) return static_cast<double>(us);
    return 0;
}

/// The machine in real time, for so long after it is up.
bool runner_window(int seconds, int cpu, Counts& counts, std::uint64_t& faults) {
    auto config = bench::ShuttleMachine::configured(axes);
    config.realtime.priority = priority;
    config.realtime.cpus = {cpu};
    config.realtime.lock_memory = true;
    config.simulation.supervision = runtime::Supervision::relaxed;
    SystemClock clock;
    runtime::World world{config, clock.now()};
    auto built = runtime::Machine::build(config, world.transport());
    if (built.index() != 0) return fmt::print(stderr, "{}\n", std::get<1>(built)[0].text()), false;
    auto& machine = *std::get<0>(built);
    runtime::RealtimeRunner runner{machine, &world};
    if (auto started = runner.start(); !started) return fmt::print(stderr, "{}\n", started.error().text()), false;
    std::vector<std::uint64_t> before(Histogram::bucket_count), after(Histogram::bucket_count);
    Instant up{};
    bool counting = false;
    const auto copy = [&](std::vector<std::uint64_t>& to) {
        for (std::size_t i = 0; i < to.size(); ++i) to[i] = machine.times().cycle->lateness.bucket(i);
    };
    const auto served = runner.serve([&](Instant now) {
        if (machine.phase() != runtime::MachinePhase::running) return true;
        if (up == Instant{}) up = now;
        if (!counting && now - up > 500ms) copy(before), counting = true;
        if (counting && now - up > 500ms + std::chrono::seconds{seconds}) {
            copy(after);
            if (const auto* s = machine.latest()) faults += s->statistics.page_faults;
            return false;
        }
        return true;
    });
    runner.finish();
    if (!served) return fmt::print(stderr, "{}\n", served.error().text()), false;
    for (std::size_t i = 0; i < after.size(); ++i)
        if (after[i] > before[i]) add(counts, static_cast<std::size_t>(Histogram::bucket_last(i) / 1000), after[i] - before[i]);
    return true;
}

void method_window(int seconds, int cpu, Counts& counts) {
    const auto seen = apps::measure_lateness({.interval = 1ms, .lasts = std::chrono::seconds{seconds}, .cpu = cpu, .priority = priority});
    const auto& all = seen.woken.all();
    for (std::size_t us = 0; us < all.size(); ++us)
        if (all[us] > 0) add(counts, us, all[us]);
}

/// False: it is not installed.
bool cyclictest_window(int seconds, int cpu, Counts& counts) {
    const auto command = fmt::format("cyclictest -q -m -p{} -i1000 -a{} -D{} -h{} 2>/dev/null", priority, cpu, seconds, longest);
    std::FILE* pipe = ::popen(command.c_str(), "re");
    if (pipe == nullptr) return false;
    char line[256];
    bool any = false;
    while (std::fgets(line, sizeof line, pipe) != nullptr) {
        unsigned us = 0;
        unsigned long n = 0;
        if (line[0] == '#' || std::sscanf(line, "%u %lu", &us, &n) != 2 || n == 0) continue;
        add(counts, us, n);
        any = true;
    }
    ::pclose(pipe);
    return any;
}

void row(const char* what, const Counts& counts) {
    std::uint64_t all = 0;
    for (const auto n : counts) all += n;
    fmt::print("{:<44} {:>9} {:>7.0f} {:>7.0f} {:>7.0f} {:>8.0f}\n", what, all, percentile(counts, 50), percentile(counts, 99),
               percentile(counts, 99.9), longest_of(counts));
}

}  // namespace

int main(int argc, char** argv) {
    const auto given = [&](int at, int otherwise) { return argc > at && std::atoi(argv[at]) > 0 ? std::atoi(argv[at]) : otherwise; };
    const int seconds = given(1, 5), windows = given(2, 6);
    const int cpu = argc > 3 ? std::atoi(argv[3]) : static_cast<int>(std::thread::hardware_concurrency()) - 1;
    Counts ours(longest + 1), method(longest + 1), theirs(longest + 1);
    std::uint64_t faults = 0;
    bool installed = true;
    for (int i = 0; i < windows; ++i) {
        if (!runner_window(seconds, cpu, ours, faults)) return 1;
        ::munlockall();
        method_window(seconds, cpu, method);
        ::munlockall();
        installed = installed && cyclictest_window(seconds, cpu, theirs);
    }
    fmt::print("Woken late, us: each ms on CPU {}, SCHED_FIFO {}, {} windows of {} s each in turn\n", cpu, priority, windows, seconds);
    fmt::print("{:<44} {:>9} {:>7} {:>7} {:>7} {:>8}\n", "", "wake-ups", "p50", "p99", "p99.9", "max");
    row("the machine's cycle, eight axes in motion", ours);
    row("cyclictest's method (taktwerk doctor)", method);
    if (installed) row("cyclictest", theirs);
    else fmt::print("cyclictest is not installed (package rt-tests)\n");
    const auto& beside = installed ? theirs : method;
    fmt::print("p99.9 of the cycle / {}: {:.2f}; page faults of the cycle in operation: {}\n", installed ? "cyclictest" : "its method",
               percentile(ours, 99.9) / std::max(1.0, percentile(beside, 99.9)), faults);
    return 0;
}
