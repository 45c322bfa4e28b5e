#include "apps/plot/trace_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "axes/words/types.hpp"

namespace taktwerk::apps {
namespace {

using Column = std::vector<double>;

struct AxisColumn {
    std::string_view name;
    Column AxisTrace::*member;
};
constexpr AxisColumn axis_columns[] = {
    {"state", &AxisTrace::state},
    {"set_position", &AxisTrace::set_position},
    {"actual_position", &AxisTrace::actual_position},
    {"set_velocity", &AxisTrace::set_velocity},
    {"actual_velocity", &AxisTrace::actual_velocity},
    {"set_acceleration", &AxisTrace::set_acceleration},
    {"set_jerk", &AxisTrace::set_jerk},
    {"following_error", &AxisTrace::following_error},
};
/// Not in every trace.
constexpr AxisColumn later_columns[] = {
    {"target_position", &AxisTrace::target_position},
    {"active", &AxisTrace::active},
};

/// Beyond it neighbouring values cannot be told apart on any axis of a picture; no machine has such numbers.
constexpr double largest = 1e15;

Error error(std::string code, const std::string& subject, std::string what, std::string remedy) {
    return {"trace." + code, subject, std::move(what), std::move(remedy)};
}

/// "x.set_position[mm]" -> name "x.set_position", unit "mm".
struct Heading {
    std::string name, unit;
};
Heading heading(std::string_view text) {
    const auto bracket = text.find('[');
    if (bracket == std::string_view::npos || text.back() != ']') return {std::string(text), {}};
    return {std::string(text.substr(0, bracket)), std::string(text.substr(bracket + 1, text.size() - bracket - 2))};
}

std::vector<Heading> headings(std::string_view line) {
    std::vector<Heading> out;
    while (true) {
        const auto comma = line.find(',');
        out.push_back(heading(line.substr(0, comma)));
        if (comma == std::string_view::npos) return out;
        line.remove_prefix(comma + 1);
    }
}

/// The one that stands twice; empty: each stands once. What is doubled could be drawn from either.
std::string doubled(const std::vector<Heading>& columns) {
    std::set<std::string_view> seen;
    for (const auto& column : columns)
        if (!seen.insert(column.name).second) return column.name;
    return {};
}

/// An axis is what has a state and a set-point.
std::vector<AxisTrace> axes_of(const std::vector<Heading>& columns) {
    std::vector<AxisTrace> axes;
    constexpr std::string_view mark = ".set_position";
    for (const auto& column : columns) {
        const std::string_view name = column.name;
        if (name.size() <= mark.size() || name.substr(name.size() - mark.size()) != mark) continue;
        AxisTrace axis;
        axis.name = std::string(name.substr(0, name.size() - mark.size()));
        axis.unit = column.unit.empty() ? "u" : column.unit;
        axes.push_back(std::move(axis));
    }
    return axes;
}

/// Where each column of the file goes; nullptr for what no plot shows.
Result<std::vector<Column*>> targets(Trace& trace, const std::vector<Heading>& columns, const std::string& name) {
    std::map<std::string, Column*> wanted{{"time_s", &trace.time_s}, {"emergency_stop", &trace.emergency_stop}};
    std::map<std::string, Column*> welcome;
    for (auto& axis : trace.axes) {
        for (const auto& column : axis_columns) wanted[axis.name + "." + std::string(column.name)] = &(axis.*column.member);
        for (const auto& column : later_columns) welcome[axis.name + "." + std::string(column.name)] = &(axis.*column.member);
    }
    const auto of_an_axis = [&](const std::string& column) {
        return std::any_of(trace.axes.begin(), trace.axes.end(), [&](const auto& axis) { return column.rfind(axis.name + ".", 0) == 0; });
    };
    for (const auto& column : columns)
        if (wanted.count(column.name) == 0 && column.name != "alarms" && !of_an_axis(column.name)) trace.bits.push_back({column.name, {}});
    for (auto& bit : trace.bits) welcome[bit.name] = &bit.value;
    std::vector<Column*> out;
    for (const auto& column : columns) {
        if (const auto found = wanted.find(column.name); found != wanted.end()) {
            out.push_back(found->second);
            wanted.erase(found);
        } else {
            const auto also = welcome.find(column.name);
            out.push_back(also == welcome.end() ? nullptr : also->second);
        }
    }
    if (trace.axes.empty())
        return error("not_a_trace", name, "no column is called AXIS.set_position", "Give a file that `taktwerk run --trace` has written.");
    if (!wanted.empty())
        return error("not_a_trace", name, fmt::format("the column '{}' is missing", wanted.begin()->first),
                     "Give a file that `taktwerk run --trace` has written.");
    return out;
}

/// Nobody plans the jerk of an axis that is led (by a group, a master): its set-points have what their accelerations are apart.
void find_jerk(AxisTrace& axis, const std::vector<double>& time) {
    constexpr auto led = static_cast<double>(axes::AxisState::SynchronizedMotion);
    for (std::size_t i = 1; i < time.size(); ++i) {
        const double step = time[i] - time[i - 1];
        if (axis.state[i] == led && axis.state[i - 1] == led && axis.set_jerk[i] == 0 && step > 0)
            axis.set_jerk[i] = (axis.set_acceleration[i] - axis.set_acceleration[i - 1]) / step;
    }
}

/// What places and colours the rest of the picture.
std::vector<const Column*> frame_of(const Trace& trace) {
    std::vector<const Column*> out{&trace.time_s, &trace.emergency_stop};
    for (const auto& axis : trace.axes) out.insert(out.end(), {&axis.state, &axis.active});
    return out;
}

/// False when the line has another number of columns, a field is not a number, or one that must be finite is not.
bool read_row(std::string_view line, const std::vector<Column*>& columns, const std::vector<bool>& finite, std::vector<double>& row) {
    row.clear();
    const char* at = line.data();
    const char* const end = at + line.size();
    for (std::size_t i = 0; i < columns.size(); ++i) {
        double value = 0;
        const auto [next, problem] = std::from_chars(at, end, value);
        if (problem != std::errc{} || (finite[i] && !std::isfinite(value))) return false;
        if (columns[i] && std::isfinite(value) && std::abs(value) > largest) return false;  // what is not drawn may be any counter
        row.push_back(value);
        const bool last = i + 1 == columns.size();
        if (last) return next == end;
        if (next == end || *next != ',') return false;
        at = next + 1;
    }
    return false;
}

}  // namespace

Result<Trace> parse_trace(std::string_view text, const std::string& name) {
    const auto header_end = text.find('\n');
    if (header_end == std::string_view::npos)
        return error("not_a_trace", name, "the file has no heading line", "Give a file that `taktwerk run --trace` has written.");
    const auto columns = headings(text.substr(0, header_end));
    if (const auto twice = doubled(columns); !twice.empty())
        return error("not_a_trace", name, fmt::format("the column '{}' stands in it twice", twice),
                     "Record it again; an axis and a program of the same name need different names.");
    Trace trace;
    trace.axes = axes_of(columns);
    auto target = targets(trace, columns, name);
    if (!target) return target.error();
    text.remove_prefix(header_end + 1);

    const auto frame = frame_of(trace);
    std::vector<bool> finite;
    for (const auto* column : *target) finite.push_back(std::find(frame.begin(), frame.end(), column) != frame.end());
    std::vector<double> row;
    for (std::size_t line_number = 2; !text.empty(); ++line_number) {
        const auto end = text.find('\n');
        if (end == std::string_view::npos) {
            trace.cut_off = true;
            break;
        }
        if (!read_row(text.substr(0, end), *target, finite, row))
            return error("bad_line", fmt::format("{}:{}", name, line_number),
                         fmt::format("the line is not {} numbers (of at most {:g}) with commas between", target->size(), largest),
                         "Record the trace again; this file was changed or damaged.");
        for (std::size_t i = 0; i < row.size(); ++i)
            if (auto* column = (*target)[i]) column->push_back(row[i]);
        text.remove_prefix(end + 1);
    }
    if (trace.time_s.empty())
        return error("empty", name, "the trace has a heading but no cycles",
                     "The machine ended before its first cycle: see what `taktwerk run` said.");
    const auto is_no_bit = [](const BitTrace& bit) {
        return std::any_of(bit.value.begin(), bit.value.end(), [](double value) { return value != 0 && value != 1; });
    };
    for (auto& bit : trace.bits) {
        if (!is_no_bit(bit)) continue;
        const auto column = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == bit.name; });
        trace.values.push_back({bit.name, column->unit, bit.value});
    }
    trace.bits.erase(std::remove_if(trace.bits.begin(), trace.bits.end(), is_no_bit), trace.bits.end());
    for (std::size_t i = 0; i < trace.time_s.size(); ++i)
        for (const auto& axis : trace.axes)
            if (const double state = axis.state[i]; state != std::floor(state) || state < 0 || state >= axes::axis_state_count)
                return error("bad_line", fmt::format("{}:{}", name, i + 2),
                             fmt::format("'{}.state' is {:g}; states are 0 to {}", axis.name, state, axes::axis_state_count - 1),
                             "Record the trace again; this file was changed or damaged.");
    double last = trace.time_s.front();
    for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
        const double t = trace.time_s[i];
        if (t < last)
            return error("bad_line", fmt::format("{}:{}", name, i + 2), "the time runs backwards",
                         "Record the trace again; this file was changed or damaged.");
        last = t;
    }
    for (auto& axis : trace.axes) find_jerk(axis, trace.time_s);
    return trace;
}

Result<Trace> read_trace(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (file) text << file.rdbuf();
    if (!file) {
        const std::string reason = errno != 0 ? std::strerror(errno) : "it is empty or not a file";
        return error("open", path, fmt::format("the trace cannot be read: {}", reason),
                     "Check the name; `taktwerk run FILE --trace out.csv` writes one.");
    }
    return parse_trace(text.str(), path);
}

}  // namespace taktwerk::apps
