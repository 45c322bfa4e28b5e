// What one cycle of a whole machine costs the cycle thread, step by step: 1, 8 and 64 CSP axes. With --record once more, recorded as by `taktwerk run
// --record` (docs/replay.md).

#include <string_view>

#include <fmt/format.h>

#include "core/math.hpp"
#include "core/recorder.hpp"
#include "tests/bench/shuttle_machine.hpp"

namespace {

using namespace taktwerk;

double us(Duration d) { return static_cast<double>(d.count()) / 1000.0; }

void run(std::size_t axes, int cycles, bool record) {
    Recorder recorder{std::size_t{32} << 20, Recorder::Policy::drop_newest};
    std::uint64_t bytes = 0;
    bench::ShuttleMachine shuttle{axes};
    shuttle.build();
    if (record) {
        shuttle.machine().record(recorder, runtime::RecordedThreads::one);
        constexpr std::size_t head = 20;  // of a record in a file
        shuttle.between = [&] { recorder.drain([&](const RecordView& view) { bytes += head + view.bytes.size(); }); };
    }
    shuttle.bring_up();
    shuttle.start();
    shuttle.machine().signals().touch();  // as the runner does before a machine in real time: its cycles meet no page for the first time
    bytes = 0;
    const double moving = shuttle.run(cycles);
    const auto& steps = shuttle.machine().step_statistics();
    fmt::print("\n{} axes, {} cycles, {:.0f} % of them in motion\n", axes, cycles, 100.0 * moving);
    fmt::print("{:<10} {:>36}   {:>32}\n", "", "ns per axis and cycle", "us per cycle");
    fmt::print("{:<10} {:>11} {:>11} {:>12}   {:>10} {:>10} {:>10}\n", "step", "p50", "p99", "max", "p50", "p99", "max");
    const auto row = [&](std::string_view step, const Histogram& h) {
        const double n = static_cast<double>(axes) / 1000.0;
        fmt::print("{:<10} {:>11.1f} {:>11.1f} {:>12.1f}   {:>10.2f} {:>10.2f} {:>10.2f}\n", step, us(h.percentile(50)) / n,
                   us(h.percentile(99)) / n, us(h.max()) / n, us(h.percentile(50)), us(h.percentile(99)), us(h.max()));
    };
    for (std::size_t i = 0; i < steps.size(); ++i) row(steps.name(i), steps.times(i));
    row("total", steps.total());
    if (record) fmt::print("recorded: {} bytes a cycle, {} records lost\n", bytes / static_cast<std::uint64_t>(cycles), recorder.dropped());
}

}  // namespace

int main(int count, char** arguments) {
    math::set_stepping_thread_float_environment();
    fmt::print("One cycle of a machine on the cycle thread; simulated slaves answer between the cycles.\n");
    const bool record = count > 1 && std::string_view(arguments[1]) == "--record";
    for (const std::size_t axes : {1, 8, 64})
        for (const bool recorded : {false, true})
            if (!recorded || record) run(axes, 20000, recorded);
    return 0;
}
