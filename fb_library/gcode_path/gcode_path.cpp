#include "fb_library/gcode_path/gcode_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fb_library/gcode/interpreter.hpp"
#include "fb_library/gcode_path/line_merger.hpp"

namespace taktwerk::gcode {
namespace {

using axes::PathItem;
using axes::PathRequest;

/// Items that are looked through at once: some 0.3 ms.
constexpr int most_at_once = 2000;

axes::PathPlace place_of(const Fault& fault) noexcept {
    return {
        .error = axes::ErrorId::path_program, .line = fault.line, .column = fault.column, .fault = static_cast<std::uint16_t>(fault.kind)};
}

PathRequest request_of(const Handshake& handshake) noexcept {
    using enum Handshake::Kind;
    PathRequest request{.number = handshake.number, .value = handshake.value, .second = handshake.second};
    switch (handshake.kind) {
        case program_stop: request.kind = axes::mcPathStop; break;
        case optional_stop: request.kind = axes::mcPathOptionalStop; break;
        case block_stop: request.kind = axes::mcPathBlockStop; break;
        case tool_prepare: request.kind = axes::mcPathToolPrepare; break;
        case tool_change: request.kind = axes::mcPathToolChange; break;
        case spindle_clockwise: request.kind = axes::mcPathSpindleClockwise; break;
        case spindle_counter: request.kind = axes::mcPathSpindleCounter; break;
        case spindle_speed: request.kind = axes::mcPathSpindleSpeed; break;
        case spindle_off: request.kind = axes::mcPathSpindleOff; break;
        case mist: request.kind = axes::mcPathMist; break;
        case flood: request.kind = axes::mcPathFlood; break;
        case coolant_off: request.kind = axes::mcPathCoolantOff; break;
        case user: request.kind = axes::mcPathUser; break;
        case end: break;
    }
    return request;
}

double length_of(const Move& move) noexcept {
    double square = 0;
    for (std::size_t i = 0; i < linear_axes; ++i)
        if (move.kind == Move::Kind::line || i == move.normal) square += (move.to[i] - move.from[i]) * (move.to[i] - move.from[i]);
    if (move.kind == Move::Kind::line) return std::sqrt(square);
    double radius = 0;
    for (std::size_t i = 0; i < linear_axes; ++i)
        if (i != move.normal) radius += (move.from[i] - move.centre[i]) * (move.from[i] - move.centre[i]);
    return std::sqrt(square + radius * move.angle * move.angle);
}

class GcodeSource final : public axes::PathSource {
public:
    GcodeSource(std::shared_ptr<const std::string> text, const InterpreterOptions& options, double millimetre)
        : text_(std::move(text)), source_(*text_), interpreter_(source_, options), millimetre_(millimetre) {}

    PathItem next() override {
        while (first_ == count_) {
            first_ = count_ = 0;
            pull();
        }
        return ready_[first_++];
    }

private:
    /// One item of the program: nothing, one or more pieces come of it.
    void pull() {
        ProgramItem item;
        switch (interpreter_.next(item)) {
            case Interpreter::Step::item: take(item); return;
            case Interpreter::Step::fault: {
                flush();
                PathItem fault;
                fault.kind = PathItem::Kind::fault;
                fault.place = place_of(interpreter_.fault());
                fault.line = fault.place.line;
                return put(fault);
            }
            case Interpreter::Step::need_text:
            case Interpreter::Step::end: flush(); return put({});
        }
    }

    void take(const ProgramItem& item) {
        if (item.kind == ProgramItem::Kind::move && merges(item)) return;
        flush();
        PathItem out;
        out.line = item.line;
        out.number = item.number;
        switch (item.kind) {
            case ProgramItem::Kind::move: take_move(item, out); break;
            case ProgramItem::Kind::dwell:
                out.kind = PathItem::Kind::dwell;
                out.seconds = item.seconds;
                put(out);
                break;
            case ProgramItem::Kind::handshake:
                if (item.handshake.kind == Handshake::Kind::end) out.kind = PathItem::Kind::end;
                else out.kind = waits_of(item.handshake.kind) == Waits::no ? PathItem::Kind::tell : PathItem::Kind::ask;
                out.request = request_of(item.handshake);
                put(out);
                break;
            case ProgramItem::Kind::message: break;  // nobody shows it yet
            case ProgramItem::Kind::resume: resume(item, out); break;
        }
    }

    /// What is in force where the program begins, asked for as the program itself did, then the way there.
    void resume(const ProgramItem& item, PathItem out) {
        const auto ask = [&](axes::MC_PATH_REQUEST kind, std::uint32_t number, double value) {
            out.kind = PathItem::Kind::ask;
            out.request = {.kind = kind, .number = number, .value = value};
            put(out);
        };
        const auto& state = interpreter_.resume_state();
        ask(axes::mcPathResume, state.user_codes_left_out, 0);
        if (state.tool != 0) ask(axes::mcPathToolChange, state.tool, 0);
        using enum ProgramOutputs::Spindle;
        if (state.spindle == clockwise) ask(axes::mcPathSpindleClockwise, 0, state.speed);
        if (state.spindle == counter) ask(axes::mcPathSpindleCounter, 0, state.speed);
        if (state.mist) ask(axes::mcPathMist, 0, 0);
        if (state.flood) ask(axes::mcPathFlood, 0, 0);
        out.kind = PathItem::Kind::line;
        out.to = scaled(item.move.to);
        out.joint = PathItem::Joint::stop;
        put(out);
    }

    void take_move(const ProgramItem& item, PathItem out) {
        const Move& move = item.move;
        out.kind = move.kind == Move::Kind::arc ? PathItem::Kind::arc : PathItem::Kind::line;
        out.to = scaled(move.to);
        for (std::size_t i = 0; i < linear_axes; ++i) out.centre[i] = move.centre[i] * millimetre_;
        out.normal = move.normal;
        out.angle = move.angle;
        if (move.feed.kind == Feed::Kind::mm_per_s) out.velocity = move.feed.value * millimetre_;
        if (move.feed.kind == Feed::Kind::seconds) out.velocity = length_of(move) * millimetre_ / move.feed.value;
        switch (move.path.kind) {
            case PathMode::Kind::exact_path: out.joint = PathItem::Joint::exact; break;
            case PathMode::Kind::exact_stop: out.joint = PathItem::Joint::stop; break;
            case PathMode::Kind::blend: out.joint = PathItem::Joint::blend; break;
        }
        out.deviation = (move.path.deviation_mm - merge_of(move.path)) * millimetre_;
        if (out.kind == PathItem::Kind::arc || merge_of(move.path) <= 0 || move.feed.kind == Feed::Kind::seconds) return put(out);
        held_ = out;
        held_feed_ = move.feed;
        held_mode_ = move.path;
        merger_.begin(first_three(move.from), first_three(move.to));
        holds_ = true;
    }

    /// Merging and cutting corners share what the program allows: the path is never further from the program than P.
    [[nodiscard]] static double merge_of(const PathMode& mode) noexcept {
        return mode.kind == PathMode::Kind::blend ? std::min(mode.merge_mm, mode.deviation_mm / 2) : 0;
    }
    [[nodiscard]] bool merges(const ProgramItem& item) noexcept {
        const Move& move = item.move;
        if (!holds_ || move.kind != Move::Kind::line) return false;
        if (move.feed.kind != held_feed_.kind || move.feed.value != held_feed_.value) return false;
        const auto& mode = move.path;
        if (mode.kind != held_mode_.kind || mode.deviation_mm != held_mode_.deviation_mm || mode.merge_mm != held_mode_.merge_mm)
            return false;
        if (!merger_.extend(first_three(move.to), merge_of(mode))) return false;
        held_.to = scaled(move.to);
        if (const auto* arc = merger_.arc()) {
            held_.kind = PathItem::Kind::arc;
            for (std::size_t i = 0; i < linear_axes; ++i) held_.centre[i] = arc->centre[i] * millimetre_;
            held_.normal = arc->normal;
            held_.angle = arc->angle;
        }
        return true;
    }
    void flush() {
        if (holds_) put(held_);
        holds_ = false;
    }
    void put(const PathItem& item) noexcept { ready_[count_++] = item; }
    [[nodiscard]] std::array<double, 3> scaled(const AxisValues& at) const noexcept {
        return {at[0] * millimetre_, at[1] * millimetre_, at[2] * millimetre_};
    }
    [[nodiscard]] static Point first_three(const AxisValues& at) noexcept { return {at[0], at[1], at[2]}; }

    std::shared_ptr<const std::string> text_;
    TextInMemory source_;
    Interpreter interpreter_;
    double millimetre_;
    std::array<PathItem, 10> ready_{};  // of one item: a line that was held, and at most seven pieces
    std::size_t first_ = 0, count_ = 0;
    LineMerger merger_;
    PathItem held_;
    Feed held_feed_;
    PathMode held_mode_;
    bool holds_ = false;
};

InterpreterOptions with(InterpreterOptions options, const axes::PathOptions& how, const std::array<double, 3>& start, double millimetre) {
    options.rotary = InterpreterOptions::Rotary::refused;
    options.single_block = how.single_block;
    options.optional_stop = how.optional_stop;
    options.block_delete = how.block_delete;
    options.start_line = how.start_line;
    for (std::size_t i = 0; i < linear_axes; ++i) options.start[i] = start[i] / millimetre;
    return options;
}

class GcodeProgram final : public axes::PathProgram {
public:
    GcodeProgram(std::shared_ptr<const std::string> text, InterpreterOptions options, const axes::PathOptions& how, double millimetre)
        : text_(std::move(text)), options_(std::move(options)), how_(how), millimetre_(millimetre) {}
    [[nodiscard]] std::unique_ptr<axes::PathSource> open(const std::array<double, 3>& start) const override {
        return std::make_unique<GcodeSource>(text_, with(options_, how_, start, millimetre_), millimetre_);
    }

private:
    std::shared_ptr<const std::string> text_;
    InterpreterOptions options_;
    axes::PathOptions how_;
    double millimetre_;
};

}  // namespace

struct GcodePathMaker::Look {
    Look(const std::string& text, const InterpreterOptions& options) : source(text), interpreter(source, options) {}
    TextInMemory source;
    Interpreter interpreter;
    axes::PathOptions how;
    double millimetre = 1;
};

GcodePathMaker::GcodePathMaker(std::shared_ptr<const std::string> text, InterpreterOptions options)
    : text_(std::move(text)), options_(std::move(options)) {}
GcodePathMaker::~GcodePathMaker() = default;

void GcodePathMaker::begin(const axes::PathOptions& options, const std::array<double, 3>& start, double millimetre) {
    look_ = std::make_unique<Look>(*text_, with(options_, options, start, millimetre));
    look_->how = options;
    look_->millimetre = millimetre;
}

std::optional<axes::PathMade> GcodePathMaker::step() {
    ProgramItem item;
    for (int i = 0; i < most_at_once; ++i) {
        const auto step = look_->interpreter.next(item);
        if (step == Interpreter::Step::item) continue;
        axes::PathMade made;
        made.lines = look_->interpreter.counts().lines;
        if (step == Interpreter::Step::fault) made.place = place_of(look_->interpreter.fault());
        else made.program = std::make_shared<GcodeProgram>(text_, options_, look_->how, look_->millimetre);
        look_.reset();
        return made;
    }
    return std::nullopt;
}

}  // namespace taktwerk::gcode
