#pragma once
// A program's text and what comes out of it, in one value.

#include <string>
#include <string_view>
#include <vector>

#include "fb_library/gcode/interpreter.hpp"

namespace taktwerk::gcode {

struct ReadProgram {
    std::vector<ProgramItem> items;
    std::vector<std::string> messages;
    Fault fault;
    AxisValues position{};
    Interpreter::Counts counts{};

    [[nodiscard]] std::vector<Move> moves() const {
        std::vector<Move> all;
        for (const auto& item : items)
            if (item.kind == ProgramItem::Kind::move) all.push_back(item.move);
        return all;
    }
    [[nodiscard]] std::vector<Handshake> handshakes() const {
        std::vector<Handshake> all;
        for (const auto& item : items)
            if (item.kind == ProgramItem::Kind::handshake) all.push_back(item.handshake);
        return all;
    }
    /// "2:5 gcode.no_feed", or "".
    [[nodiscard]] std::string wrong() const {
        if (fault.kind == FaultKind::none) return {};
        return std::to_string(fault.line) + ":" + std::to_string(fault.column) + " " + std::string(fault_code(fault.kind));
    }
};

[[nodiscard]] inline ReadProgram read_program(std::string_view text, const InterpreterOptions& options = {}, std::size_t piece = 4096) {
    TextInMemory source(text, piece);
    Interpreter program(source, options);
    ReadProgram out;
    ProgramItem item;
    auto step = program.next(item);
    for (; step == Interpreter::Step::item; step = program.next(item)) {
        out.items.push_back(item);
        if (item.kind == ProgramItem::Kind::message) out.messages.emplace_back(program.message());
    }
    out.fault = program.fault(), out.position = program.position(), out.counts = program.counts();
    return out;
}

/// Of blocks, with an end behind them.
[[nodiscard]] inline ReadProgram read_blocks(std::string_view blocks, const InterpreterOptions& options = {}) {
    return read_program(std::string(blocks) + "\nM2\n", options);
}

}  // namespace taktwerk::gcode
