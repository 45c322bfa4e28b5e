#pragma once
// A trace read back from CSV (what apps/machine/trace_csv.hpp writes), column by column, as far as a plot needs it.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::apps {

struct AxisTrace {
    std::string name, unit;  ///< unit "u" when the trace does not say
    std::vector<double> state, set_position, actual_position, set_velocity, actual_velocity, set_acceleration, set_jerk, following_error;
    std::vector<double> target_position;  ///< where the commanded motion ends; empty in traces of older versions
    std::vector<double> active;           ///< number of the command in control, 0 = none; empty in traces of older versions
};

/// A column that belongs to no axis and is 0 or 1 all the time: an input, an output, a monitored BOOL of a program.
struct BitTrace {
    std::string name;  ///< "in.start", "feeder.running"
    std::vector<double> value;
};

/// Any other column that belongs to no axis: an analog point, a number of a program.
struct ValueTrace {
    std::string name, unit;     ///< "cell.pressure"; unit empty when the trace does not say
    std::vector<double> value;  ///< may hold NaN and infinities: what the program had
};

/// Times, states and emergency_stop are finite; measured and computed values need not be.
struct Trace {
    std::vector<double> time_s;          ///< since the start of the run, as in its log
    std::vector<double> emergency_stop;  ///< 0 or 1
    std::vector<AxisTrace> axes;
    std::vector<BitTrace> bits;      ///< in the order of the file
    std::vector<ValueTrace> values;  ///< likewise
    bool cut_off = false;            ///< the last line is incomplete: the writer was killed
};

/// Errors: trace.open, trace.not_a_trace, trace.bad_line (with its number), trace.empty.
[[nodiscard]] Result<Trace> read_trace(const std::string& path);
/// The same from text; `name` stands in the errors.
[[nodiscard]] Result<Trace> parse_trace(std::string_view text, const std::string& name);

}  // namespace taktwerk::apps
