// Any bytes as a trace: columns of one length whose time rises, or an error with a sentence; and a picture's script can be made of it.
#include <cstdlib>
#include <string_view>

#include "apps/plot/plot_script.hpp"
#include "apps/plot/trace_file.hpp"

using namespace taktwerk;
using namespace taktwerk::apps;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto trace = parse_trace({reinterpret_cast<const char*>(data), size}, "fuzz.csv");
    if (!trace) {
        if (trace.error().code.empty() || trace.error().what.empty()) std::abort();
        return 0;
    }
    const auto rows = trace->time_s.size();
    if (rows == 0 || trace->emergency_stop.size() != rows) std::abort();
    for (std::size_t i = 1; i < rows; ++i)
        if (!(trace->time_s[i] >= trace->time_s[i - 1])) std::abort();
    const auto all_or_none = [rows](const std::vector<double>& column) { return column.empty() || column.size() == rows; };
    for (const auto& axis : trace->axes) {
        for (const auto* column : {&axis.state, &axis.set_position, &axis.actual_position, &axis.set_velocity, &axis.actual_velocity,
                                   &axis.set_acceleration, &axis.set_jerk, &axis.following_error})
            if (column->size() != rows) std::abort();
        if (!all_or_none(axis.target_position) || !all_or_none(axis.active)) std::abort();
    }
    for (const auto& bit : trace->bits)
        if (bit.value.size() != rows) std::abort();

    PlotRequest request;
    request.title = "fuzz", request.output = "fuzz.svg", request.following_error = true;
    const auto script = plot_script(*trace, request);
    if (!script && script.error().what.empty()) std::abort();
    return 0;
}
