#pragma once
// What `taktwerk gcode check` says of a program that is right, and what else is wrong with one that is not. Pure.

#include <string>
#include <vector>

#include "core/result.hpp"
#include "fb_library/gcode/interpreter.hpp"
#include "fb_library/gcode/program_summary.hpp"

namespace taktwerk::apps {

/// A program read through.
struct CheckedProgram {
    gcode::ProgramSummary summary;
    gcode::Interpreter::Counts counts;
    gcode::Interpreter::Rest rest;      ///< behind M2 or M30
    gcode::Handshake end{};             ///< which word ended it
    std::vector<std::string> messages;  ///< the first of them
    bool any_deviation = false;         ///< a move under G64 without P
    double start_line = 1;
    gcode::AxisValues start{};     ///< where it begins
    gcode::ProgramOutputs with{};  ///< and with what, where it starts behind its first line
};
inline constexpr std::size_t most_messages = 20;

[[nodiscard]] std::string summary_text(const CheckedProgram& program, const std::string& name);
/// What is no error and yet worth a look. Codes: gcode.behind_end, gcode.any_deviation, gcode.long_dwell, gcode.state_unknown.
[[nodiscard]] std::vector<Error> remarks(const CheckedProgram& program, const std::string& name);

/// Reads it through. The first fault ends it: what comes behind has another state than it was written for.
[[nodiscard]] Result<CheckedProgram> check_program(gcode::TextSource& source, const gcode::InterpreterOptions& options,
                                                   const std::string& name);
/// What can be said of the lines behind `line` by themselves: words, not what they do. At most `most`.
[[nodiscard]] std::vector<Error> word_errors_behind(gcode::TextSource& source, const gcode::InterpreterOptions& options, std::uint32_t line,
                                                    std::size_t most, const std::string& name);

}  // namespace taktwerk::apps
