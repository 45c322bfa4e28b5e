// What one answer to `state` costs the service side, of a machine whose axes move: 1, 8 and 64 of them. A page asks up to 50 times a second.

#include <benchmark/benchmark.h>

#include "core/math.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "tests/bench/shuttle_machine.hpp"

namespace {

using namespace taktwerk;

void StateOfAxes(benchmark::State& state) {
    math::set_stepping_thread_float_environment();
    bench::ShuttleMachine shuttle{static_cast<std::size_t>(state.range(0))};
    shuttle.build();
    (void)shuttle.bring_up();
    shuttle.start();
    (void)shuttle.run(1000);
    hmi::RuntimeLink link{shuttle.machine()};
    const auto* snapshot = link.latest();
    std::size_t bytes = 0;
    for (auto _ : state) {
        const auto text = hmi::state_json(*snapshot, link);
        bytes = text.size();
        benchmark::DoNotOptimize(text.data());
    }
    state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(StateOfAxes)->Arg(1)->Arg(8)->Arg(64)->Unit(benchmark::kMicrosecond);

}  // namespace
