#include "apps/gcode/summary_text.hpp"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "apps/terminal/count_text.hpp"
#include "core/one_line.hpp"

namespace taktwerk::apps {
namespace {

using gcode::Handshake;
using gcode::ProgramItem;

constexpr double long_dwell_s = 100;

std::string duration_text(double seconds) {
    if (seconds < 60) return fmt::format("{:.3g} s", seconds);
    const auto whole = static_cast<long long>(seconds);
    if (seconds < 3600) return fmt::format("{} min {:.0f} s", whole / 60, std::floor(seconds - static_cast<double>(whole / 60 * 60)));
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

/// Times 60: as programs write it.
std::string per_minute(double per_second) { return fmt::format("{:.6g}", per_second * 60); }

std::string range(double least, double most, const char* unit) {
    return least == most ? fmt::format("{:.6g} {}", most, unit) : fmt::format("{:.6g} to {:.6g} {}", least, most, unit);
}

std::string end_text(const Handshake& end) { return end.number == 0 ? std::string("%") : fmt::format("M{}", end.number); }

std::string with_text(const gcode::ProgramOutputs& with) {
    std::string text = with.tool == 0 ? "no tool" : fmt::format("tool {}", with.tool);
    if (with.spindle != gcode::ProgramOutputs::Spindle::off)
        text += fmt::format(", spindle {} {:g} 1/min",
                            with.spindle == gcode::ProgramOutputs::Spindle::clockwise ? "clockwise" : "counter-clockwise", with.speed);
    if (with.mist) text += ", mist";
    if (with.flood) text += ", flood";
    return text;
}

class Rows {
public:
    void add(const char* name, const std::string& value) { text_ += fmt::format("  {:<10}{}\n", name, value); }
    std::string text_;
};

void put_moves(Rows& rows, const gcode::ProgramSummary& summary) {
    const auto each = [](const char* what, const gcode::ProgramSummary::Moves& moves) {
        return fmt::format("{} ({:.6g} mm)", count_text(moves.count, what), moves.length_mm);
    };
    rows.add("moves",
             fmt::format("{}, {}, {}", each("rapid", summary.rapids()), each("line", summary.lines()), each("arc", summary.arcs())));
}

void put_waits(Rows& rows, const gcode::ProgramSummary& summary) {
    std::string waits;
    const auto add = [&](Handshake::Kind kind, const char* what) {
        if (const auto count = summary.handshakes()[static_cast<std::size_t>(kind)]; count > 0)
            waits += fmt::format("{}{} x {}", waits.empty() ? "" : ", ", count, what);
    };
    using enum Handshake::Kind;
    add(program_stop, "M0"), add(optional_stop, "M1"), add(tool_change, "M6");
    add(spindle_clockwise, "M3"), add(spindle_counter, "M4"), add(spindle_off, "M5");
    add(mist, "M7"), add(flood, "M8"), add(coolant_off, "M9");
    add(user, "M100 to M199");
    if (!waits.empty()) rows.add("waits", waits);
}

}  // namespace

std::string summary_text(const CheckedProgram& program, const std::string& name) {
    const auto& summary = program.summary;
    const auto& counts = program.counts;
    Rows rows;
    rows.text_ = fmt::format("{}: {}, {}; ends with {}\n", name, count_text(counts.lines, "line"), count_text(counts.blocks, "block"),
                             end_text(program.end));
    if (program.start_line > 1)
        rows.add("from", fmt::format("line {:g}: X {:.6g} Y {:.6g} Z {:.6g}, {}", program.start_line, program.start[0], program.start[1],
                                     program.start[2], with_text(program.with)));
    for (std::size_t axis = 0; axis < gcode::axis_count; ++axis) {
        const auto& extent = summary.extents()[axis];
        if (!extent.moved) continue;
        const char axis_name[] = {gcode::axis_letters[axis], '\0'};
        rows.add(axis_name, fmt::format("{:.6g} to {:.6g} {}", extent.least, extent.most, axis < gcode::linear_axes ? "mm" : "deg"));
    }
    put_moves(rows, summary);
    if (counts.standing > 0) rows.add("standing", fmt::format("{} to where the program is already", count_text(counts.standing, "move")));
    if (summary.feeds().most > 0)
        rows.add("feed", summary.feeds().least == summary.feeds().most
                             ? per_minute(summary.feeds().most) + " mm/min"
                             : per_minute(summary.feeds().least) + " to " + per_minute(summary.feeds().most) + " mm/min");
    if (summary.spindle().used) rows.add("spindle", range(summary.spindle().least, summary.spindle().most, "1/min"));
    if (!summary.tools().empty()) {
        std::string tools;
        for (const auto tool : summary.tools()) tools += fmt::format("{}{}", tools.empty() ? "" : ", ", tool);
        rows.add("tools", tools);
    }
    if (summary.dwells().count > 0)
        rows.add("dwell", fmt::format("{}, {} in all; the longest {} (line {})", count_text(summary.dwells().count, "pause"),
                                      duration_text(summary.dwells().seconds), duration_text(summary.dwells().longest),
                                      summary.dwells().longest_line));
    put_waits(rows, summary);
    if (counts.left_out > 0) rows.add("left out", count_text(counts.left_out, "block") + " by block delete");
    if (counts.optional_stops > 0) rows.add("passed by", fmt::format("{} x M1 (optional stop is off)", counts.optional_stops));
    rows.add("time", fmt::format("at least {}: programmed feeds reached at once; without rapids and waiting",
                                 duration_text(summary.least_seconds())));
    for (const auto& message : program.messages) rows.add("message", message);
    if (summary.messages() > program.messages.size())
        rows.add("", fmt::format("and {} more", summary.messages() - program.messages.size()));
    return rows.text_;
}

std::vector<Error> remarks(const CheckedProgram& program, const std::string& name) {
    std::vector<Error> all;
    if (program.rest.lines > 0)
        all.push_back({"gcode.behind_end", fmt::format("{}:{}", name, program.rest.first_line),
                       fmt::format("{} behind the program's end {} never carried out", count_text(program.rest.lines, "line"),
                                   program.rest.lines == 1 ? "is" : "are"),
                       "Delete them, or the end before them."});
    if (program.any_deviation)
        all.push_back({"gcode.any_deviation", name, "G64 without P lets corners be cut by any amount, those of rapids as well",
                       "Give the deviation that is allowed: G64 P0.02."});
    if (const auto& dwells = program.summary.dwells(); dwells.longest > long_dwell_s)
        all.push_back({"gcode.long_dwell", fmt::format("{}:{}", name, dwells.longest_line),
                       fmt::format("a pause of {}", duration_text(dwells.longest)),
                       "P of G4 is in seconds here, in milliseconds on some other controls."});
    if (program.with.user_codes_left_out > 0)
        all.push_back({"gcode.state_unknown", name,
                       fmt::format("{} x M100 to M199 before the start line {} left out, and what they did is not known here",
                                   program.with.user_codes_left_out, program.with.user_codes_left_out == 1 ? "is" : "are"),
                       "Bring the machine into that state by hand."});
    return all;
}

Result<CheckedProgram> check_program(gcode::TextSource& source, const gcode::InterpreterOptions& options, const std::string& name) {
    gcode::Interpreter program(source, options);
    CheckedProgram out;
    ProgramItem item;
    auto step = program.next(item);
    for (; step == gcode::Interpreter::Step::item; step = program.next(item)) {
        out.summary.add(item);
        switch (item.kind) {
            case ProgramItem::Kind::message:
                if (out.messages.size() < most_messages) out.messages.push_back(on_one_line(program.message()));
                break;
            case ProgramItem::Kind::handshake: out.end = item.handshake; break;
            case ProgramItem::Kind::resume: out.start_line = item.line, out.start = item.move.to, out.with = program.resume_state(); break;
            case ProgramItem::Kind::move:
                out.any_deviation |= item.move.path.kind == gcode::PathMode::Kind::blend && std::isinf(item.move.path.deviation_mm);
                break;
            case ProgramItem::Kind::dwell: break;
        }
    }
    if (step == gcode::Interpreter::Step::fault) return gcode::fault_error(program.fault(), name);
    if (step == gcode::Interpreter::Step::need_text)
        return Error{"gcode.read_failed", name, "the text cannot be read any further", "Look after the file or its medium."};
    out.counts = program.counts();
    out.rest = program.rest();
    return out;
}

std::vector<Error> word_errors_behind(gcode::TextSource& source, const gcode::InterpreterOptions& options, std::uint32_t line,
                                      std::size_t most, const std::string& name) {
    std::vector<Error> all;
    gcode::SourceLines lines(source);
    gcode::Block block;
    gcode::Fault fault;
    auto step = lines.next();
    for (; step == gcode::SourceLines::Step::line && all.size() < most; step = lines.next()) {
        const auto deletable = options.block_delete ? gcode::Deletable::left_out : gcode::Deletable::carried_out;
        if (lines.number() <= line) continue;
        if (gcode::parse_block(lines.text(), lines.number(), deletable, block, fault) != gcode::FaultKind::none) {
            all.push_back(gcode::fault_error(fault, name));
            continue;
        }
        const auto stop = block.number_of(gcode::CodeGroup::stop);
        if (stop == 2 || stop == 30) return all;
    }
    if (step == gcode::SourceLines::Step::fault && lines.fault().line > line && all.size() < most)
        all.push_back(gcode::fault_error(lines.fault(), name));
    return all;
}

}  // namespace taktwerk::apps
