// What reading G-code costs: blocks a second, of short segments as CAM systems write them. The aim is 10,000 a second with lots to spare.

#include <cmath>
#include <string>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "fb_library/gcode/interpreter.hpp"

namespace taktwerk::gcode {
namespace {

constexpr int blocks = 100'000;

/// Lines of about 0.1 mm along a wave, every tenth with a feed.
std::string short_lines() {
    std::string text = "G21 G90 G64 P0.01 F1200\nG0 X0 Y0 Z0\n";
    for (int i = 1; i <= blocks; ++i) {
        text += fmt::format("N{} G1 X{:.3f} Y{:.3f} Z{:.3f}", i, 0.1 * i, 20 * std::sin(0.005 * i), std::cos(0.01 * i));
        text += i % 10 == 0 ? " F1000\n" : "\n";
    }
    return text + "M30\n";
}

/// Quarters of circles, one behind the other.
std::string short_arcs() {
    std::string text = "G21 G90 F1200\nG0 X1 Y0\n";
    for (int i = 0; i < blocks; ++i) {
        constexpr const char* quarters[] = {"G3 X0.000 Y1.000 I-1.000 J0.000\n", "G3 X-1.000 Y0.000 I0.000 J-1.000\n",
                                            "G3 X0.000 Y-1.000 I1.000 J0.000\n", "G3 X1.000 Y0.000 I0.000 J1.000\n"};
        text += quarters[i % 4];
    }
    return text + "M30\n";
}

void read_all(benchmark::State& state, const std::string& text) {
    std::int64_t items = 0;
    for (auto _ : state) {
        TextInMemory source(text);
        Interpreter program(source, {});
        ProgramItem item;
        while (program.next(item) == Interpreter::Step::item) ++items, benchmark::DoNotOptimize(item);
        if (program.fault().kind != FaultKind::none) state.SkipWithError("the program is wrong");
    }
    state.counters["blocks_per_s"] = benchmark::Counter(static_cast<double>(items), benchmark::Counter::kIsRate);
    state.SetBytesProcessed(static_cast<std::int64_t>(text.size()) * static_cast<std::int64_t>(state.iterations()));
}

void read_short_lines(benchmark::State& state) { read_all(state, short_lines()); }
void read_short_arcs(benchmark::State& state) { read_all(state, short_arcs()); }
BENCHMARK(read_short_lines)->Unit(benchmark::kMillisecond);
BENCHMARK(read_short_arcs)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace taktwerk::gcode
