// How a machine grows with its axes, 1 to 200 of them, CSP at 1 ms: from the first frame to OP, the controller's cycle, its memory, the wire. With a
// file's name as argument it draws them, too. The heap is the controller's alone: master, axes, program; slaves and the configuration that both share are there before.

#include <malloc.h>

#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/math.hpp"
#include "tests/bench/line_plot.hpp"
#include "tests/bench/shuttle_machine.hpp"

namespace {

using namespace taktwerk;

struct Row {
    double axes, operational_s, cycle_us, cycle_p99_us, memory_kib, wire_us, frames;
};

double heap_kib() { return static_cast<double>(::mallinfo2().uordblks + ::mallinfo2().hblkhd) / 1024.0; }

Row measured(std::size_t axes) {
    bench::ShuttleMachine shuttle{axes};
    const double before = heap_kib();
    shuttle.build();
    const auto to_op = std::chrono::duration<double>(shuttle.bring_up()).count();
    const double controller = heap_kib();
    shuttle.start();
    shuttle.run(5000);
    const auto& total = shuttle.machine().step_statistics().total();
    constexpr double ns_per_byte = 80;  // 100 Mbit/s
    return {static_cast<double>(axes),
            to_op,
            static_cast<double>(total.percentile(50).count()) / 1e3,
            static_cast<double>(total.percentile(99).count()) / 1e3,
            controller - before,
            static_cast<double>(shuttle.wire().wire_bytes()) * ns_per_byte / 1e3,
            static_cast<double>(shuttle.wire().frames_sent())};
}

bench::Line line(const std::vector<Row>& rows, std::string label, double Row::*value) {
    bench::Line out{std::move(label), {}};
    for (const auto& row : rows) out.points.emplace_back(row.axes, row.*value);
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    math::set_stepping_thread_float_environment();
    fmt::print("{:>5} {:>12} {:>14} {:>14} {:>12} {:>14} {:>7}\n", "axes", "to OP, s", "cycle p50, us", "cycle p99, us", "heap, KiB",
               "wire, us", "frames");
    std::vector<Row> rows;
    for (const std::size_t axes : {1, 25, 50, 75, 100, 125, 150, 175, 200}) {
        const auto& r = rows.emplace_back(measured(axes));
        fmt::print("{:>5.0f} {:>12.2f} {:>14.2f} {:>14.2f} {:>12.0f} {:>14.0f} {:>7.0f}\n", r.axes, r.operational_s, r.cycle_us,
                   r.cycle_p99_us, r.memory_kib, r.wire_us, r.frames);
    }
    if (argc > 1)
        std::ofstream(argv[1]) << bench::svg(
            "axes", {line(rows, "from the first frame to OP, s", &Row::operational_s),
                     line(rows, "the controller's cycle, p50, us", &Row::cycle_us),
                     line(rows, "the controller's heap, KiB", &Row::memory_kib), line(rows, "on a wire of 100 Mbit/s, us", &Row::wire_us)});
    return 0;
}
