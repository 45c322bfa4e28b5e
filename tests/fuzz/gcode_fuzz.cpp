// Any bytes as a G-code program: moves of finite numbers that join without gaps, or a fault with a place inside the text and a sentence that a terminal can take; the same however the
// text comes in pieces.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "fb_library/gcode/interpreter.hpp"
#include "fb_library/gcode/program_summary.hpp"

using namespace taktwerk;
using namespace taktwerk::gcode;

namespace {

/// What a program comes to, for a comparison.
struct Outcome {
    std::size_t items = 0;
    AxisValues position{};
    FaultKind kind = FaultKind::none;
    std::uint32_t line = 0, column = 0;
    bool operator==(const Outcome&) const = default;
};

Outcome read_in_pieces(std::string_view text, std::size_t piece, const InterpreterOptions& options) {
    TextInMemory source(text, piece);
    Interpreter program(source, options);
    ProgramSummary summary;
    ProgramItem item;
    Outcome out;
    AxisValues at = options.start;
    auto step = program.next(item);
    for (; step == Interpreter::Step::item; step = program.next(item)) {
        if (++out.items > text.size() + 2) std::abort();  // at most an item a byte, and the end
        if (item.kind == ProgramItem::Kind::resume) at = item.move.to;
        if (item.kind == ProgramItem::Kind::move) {
            if (item.move.from != at || !std::isfinite(length_of(item.move))) std::abort();
            if (item.move.feed.kind != Feed::Kind::rapid && !(item.move.feed.value > 0 && std::isfinite(item.move.feed.value)))
                std::abort();
            for (const double value : item.move.to)
                if (!(std::fabs(value) <= 1e6)) std::abort();
            at = item.move.to;
        }
        if (item.kind == ProgramItem::Kind::dwell && !(item.seconds >= 0)) std::abort();
        summary.add(item);
    }
    if (step == Interpreter::Step::need_text || !(summary.least_seconds() >= 0)) std::abort();
    out.position = program.position(), out.kind = program.fault().kind, out.line = program.fault().line,
    out.column = program.fault().column;
    if ((step == Interpreter::Step::fault) != (out.kind != FaultKind::none)) std::abort();
    if (out.kind == FaultKind::none) {
        (void)program.rest();
        return out;
    }
    if (out.column > longest_line + 1) std::abort();
    const auto error = fault_error(program.fault(), "fuzz.ngc");
    if (error.what.empty() || error.remedy.empty() || error.subject.rfind("fuzz.ngc", 0) != 0) std::abort();
    for (const char c : error.text())
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7F) std::abort();
    return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    // The first byte: how it is run.
    const auto how = data[0];
    InterpreterOptions options;
    if (how & 1) options.rotary = InterpreterOptions::Rotary::offered;
    options.block_delete = (how & 2) != 0, options.optional_stop = (how & 4) != 0, options.single_block = (how & 8) != 0;
    options.start_line = 1 + ((how >> 4) & 3);
    options.tools = {{1, {0, 0, 100, 0, 0, 0}}, {2, {1, 2, 50, 0, 0, 0}}};
    options.offsets[1] = {10, 20, 30, 0, 0, 0};
    options.reference = {5, 5, 5, 0, 0, 0};
    const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (read_in_pieces(text, 4096, options) != read_in_pieces(text, 1 + (how >> 6) * 7, options)) std::abort();
    return 0;
}
