// How well the clocks hold together in virtual time: 60 s after lock, quartzes 50 ppm off, one sample a cycle. Not a time
// measurement: the figures are ns of simulated time and the same in each run. Aim: below 100 ns.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <benchmark/benchmark.h>

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

/// p50, p99 and max of magnitudes, in ns.
void report(benchmark::State& state, const std::string& what, std::vector<std::int64_t>& values) {
    std::sort(values.begin(), values.end());
    state.counters[what + "_p50_ns"] = static_cast<double>(values[values.size() / 2]);
    state.counters[what + "_p99_ns"] = static_cast<double>(values[values.size() * 99 / 100]);
    state.counters[what + "_max_ns"] = static_cast<double>(values.back());
}

/// `phase`: where a frame passes the reference, against the instant that SYNC0 was placed by. `spread`: system time of the last
/// slave against the reference's.
void dc_offset_after_lock(benchmark::State& state) {
    const double ppm = static_cast<double>(state.range(0));
    for (auto _ : state) {
        TestBus bus{""};
        for (std::uint16_t i = 0; i < 3; ++i) {
            sim::SlaveOptions options;
            options.drift_ppm = i == 0 ? ppm : -ppm;
            options.clock_start = Duration{1'000'000'007LL * (i + 1)};
            bus.network.add(servo_description(), std::make_unique<EchoServo>(), options);
            SlaveConfig slave;
            slave.name = std::string(1, static_cast<char>('a' + i));
            slave.device = servo_description();
            slave.position = i;
            slave.dc = true;
            bus.config.slaves.push_back(slave);
        }
        if (!bus.bring_up()) {
            state.SkipWithError(bus.why().c_str());
            return;
        }
        constexpr Duration cable = 50ns;  // to the reference, which stamps the frame
        const std::int64_t period = bus.config.cycle.count(), shift = period / 2;
        std::vector<std::int64_t> phase, spread;
        for (const Instant end = bus.now + 60s; bus.now < end;) {
            bus.cycle_once();
            auto& reference = bus.network.slave(0).controller();
            const std::int64_t passes = reference.clock().system(bus.now + cable);
            const std::int64_t into = (((passes - reference.sync0().next_system() + shift) % period) + period) % period;
            phase.push_back(std::min(into, period - into));
            spread.push_back(std::abs(bus.network.slave(2).controller().clock().system(bus.now) - reference.clock().system(bus.now)));
        }
        report(state, "phase", phase);
        report(state, "spread", spread);
    }
}
BENCHMARK(dc_offset_after_lock)->Arg(0)->Arg(50)->Arg(-50)->ArgName("ppm")->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace taktwerk::ecat::test
