#include "fb_library/gcode/interpreter.hpp"

#include "fb_library/gcode/block_run.hpp"

namespace taktwerk::gcode {

Interpreter::Interpreter(TextSource& source, const InterpreterOptions& options)
    : options_(options),
      lines_(source),
      offsets_(options.offsets),
      position_(options.start),
      phase_(options.start_line > 1 ? Phase::skipping : Phase::running) {
    state_.unit_mm = state_.feed_unit_mm = options.units == InterpreterOptions::Units::inch ? 25.4 : 1;
    state_.path = options.path;
}

Interpreter::Step Interpreter::next(ProgramItem& item) noexcept {
    for (;;) {
        if (first_ < count_) {
            item = items_[first_++];
            return Step::item;
        }
        if (fault_.kind != FaultKind::none) return Step::fault;
        if (phase_ == Phase::ended) return Step::end;
        first_ = count_ = 0;
        if (const auto step = read_block(); step != Step::item) return step;
    }
}

Interpreter::Step Interpreter::failed(FaultKind kind, std::uint32_t line) noexcept {
    fault_ = {};
    fault_.kind = kind, fault_.line = line;
    count_ = 0;
    return Step::fault;
}

bool Interpreter::emit(const ProgramItem& item) noexcept {
    if (phase_ == Phase::skipping || count_ == items_.size()) return false;
    items_[count_++] = item;
    return true;
}

void Interpreter::begin_here(const Block& block) noexcept {
    phase_ = Phase::running;
    resumed_ = outputs_;
    ProgramItem item;
    item.kind = ProgramItem::Kind::resume, item.line = block.line, item.number = block.number;
    item.move.from = item.move.to = position_;
    emit(item);
}

Interpreter::Step Interpreter::read_block() noexcept {
    const auto read = lines_.next();
    counts_.lines = lines_.number();
    switch (read) {
        case SourceLines::Step::need_text: return Step::need_text;
        case SourceLines::Step::fault: fault_ = lines_.fault(); return Step::fault;
        case SourceLines::Step::end: {
            if (!lines_.closed()) return failed(FaultKind::no_end, lines_.number());
            if (phase_ == Phase::skipping) return failed(FaultKind::start_beyond_end, 0);
            phase_ = Phase::ended;
            ProgramItem last;
            last.kind = ProgramItem::Kind::handshake, last.line = lines_.number();
            last.handshake.kind = Handshake::Kind::end;
            emit(last);
            return Step::item;
        }
        case SourceLines::Step::line: break;
    }
    const auto deletable = options_.block_delete ? Deletable::left_out : Deletable::carried_out;
    if (parse_block(lines_.text(), lines_.number(), deletable, block_, fault_) != FaultKind::none) return Step::fault;
    if (block_.deletable && options_.block_delete) {
        ++counts_.left_out;
        return Step::item;
    }
    if (phase_ == Phase::skipping && lines_.number() >= options_.start_line) begin_here(block_);
    if (!BlockRun(*this, block_).run()) {
        count_ = 0;
        return Step::fault;
    }
    if (phase_ == Phase::ended && count_ == 0) return failed(FaultKind::start_beyond_end, 0);
    return Step::item;
}

Interpreter::Rest Interpreter::rest() noexcept {
    Rest rest;
    if (phase_ != Phase::ended) return rest;
    while (lines_.next() == SourceLines::Step::line)
        if (lines_.text().find_first_not_of(" \t") != std::string_view::npos && rest.lines++ == 0) rest.first_line = lines_.number();
    return rest;
}

}  // namespace taktwerk::gcode
