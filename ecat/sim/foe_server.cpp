#include "ecat/sim/foe_server.hpp"

#include <algorithm>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat::sim {

void FoeServer::start() noexcept {
    doing_ = Doing::nothing;
    closing_ = false;
    files_.abandon();
}

std::size_t FoeServer::serve(std::span<const std::byte> message, std::span<std::byte> out, EsmState state, Instant now) noexcept {
    const auto asked = parse_foe(message);
    if (!asked) return end_with(out, foe_error::illegal);
    if (faults_.silent > 0) {
        --faults_.silent;
        return 0;
    }
    const bool wants_more = asked->op != FoeOp::error && asked->op != FoeOp::busy;
    if (wants_more && faults_.stays_busy) return say_busy(out, 0);
    if (wants_more && faults_.busy > 0 && !(asked->op == FoeOp::acknowledge && last_sent_)) {
        --faults_.busy;
        if (asked->op == FoeOp::read_request && doing_ == Doing::nothing) {
            if (const auto code = open(*asked, state); code != 0) return end_with(out, code);
        }
        return say_busy(out, 100 / (faults_.busy + 1));
    }
    const bool counts = asked->op == FoeOp::data || asked->op == FoeOp::acknowledge;
    if (faults_.fails_at && counts && asked->number == *faults_.fails_at) return end_with(out, faults_.fails_with);
    return answer(*asked, out, state, now);
}

std::size_t FoeServer::answer(const FoeMessage& message, std::span<std::byte> out, EsmState state, Instant now) {
    switch (message.op) {
        case FoeOp::read_request: return doing_ == Doing::nothing ? begin_read(message, out, state) : end_with(out, foe_error::illegal);
        case FoeOp::write_request:
            return doing_ == Doing::nothing ? begin_write(message, out, state, now) : end_with(out, foe_error::illegal);
        case FoeOp::acknowledge: return doing_ == Doing::sending ? go_on_reading(message, out) : end_with(out, foe_error::illegal);
        case FoeOp::data: return doing_ == Doing::taking ? take_data(message, out, now) : end_with(out, foe_error::illegal);
        case FoeOp::error: start(); return 0;
        case FoeOp::busy: return doing_ == Doing::sending && packet_ > 0 ? send_piece(out) : 0;
    }
    return 0;
}

/// Packet 0 was sent, so to speak: its acknowledgement brings the first.
std::uint32_t FoeServer::open(const FoeMessage& message, EsmState state) {
    if (const auto code = files_.open_to_read(message.text(), message.number, state); code != 0) return code;
    doing_ = Doing::sending;
    last_sent_ = false;
    sent_ = 0;
    packet_ = 0;
    return 0;
}

std::size_t FoeServer::begin_read(const FoeMessage& message, std::span<std::byte> out, EsmState state) {
    if (const auto code = open(message, state); code != 0) return end_with(out, code);
    packet_ = 1;
    return send_piece(out);
}

std::size_t FoeServer::begin_write(const FoeMessage& message, std::span<std::byte> out, EsmState state, Instant now) {
    if (const auto code = files_.open_to_write(message.text(), message.number, state, now); code != 0) return end_with(out, code);
    doing_ = Doing::taking;
    closing_ = false;
    packet_ = 1;
    return encode_foe(out, {FoeOp::acknowledge, 0, {}});
}

std::size_t FoeServer::go_on_reading(const FoeMessage& message, std::span<std::byte> out) {
    if (message.number != packet_) return end_with(out, foe_error::packet_number);
    if (last_sent_) {
        start();
        return 0;
    }
    if (packet_ > 0) sent_ += room_;
    ++packet_;
    return send_piece(out);
}

std::size_t FoeServer::send_piece(std::span<std::byte> out) noexcept {
    const auto rest = files_.content().subspan(sent_);
    const auto piece = rest.first(std::min(rest.size(), room_));
    last_sent_ = piece.size() < room_;
    return encode_foe(out, {FoeOp::data, packet_, piece});
}

std::size_t FoeServer::take_data(const FoeMessage& message, std::span<std::byte> out, Instant now) {
    if (message.number != packet_) return end_with(out, foe_error::packet_number);
    if (files_.busy(now)) return say_busy(out, files_.percent(now));
    if (!closing_) {
        if (const auto code = files_.write(message.rest, now); code != 0) return end_with(out, code);
        closing_ = message.rest.size() < taken_at_once_;
    }
    if (closing_) {
        if (files_.busy(now)) return say_busy(out, files_.percent(now));
        const auto code = files_.close();
        doing_ = Doing::nothing;
        closing_ = false;
        if (code != 0) return end_with(out, code);
    }
    return encode_foe(out, {FoeOp::acknowledge, packet_++, {}});
}

std::size_t FoeServer::say_busy(std::span<std::byte> out, unsigned percent) const noexcept {
    constexpr std::uint32_t entire = 100;
    return encode_foe(out, {FoeOp::busy, percent | entire << 16, foe_text("flash")});
}

std::size_t FoeServer::end_with(std::span<std::byte> out, std::uint32_t code) noexcept {
    start();
    return encode_foe(out, {FoeOp::error, code, {}});
}

}  // namespace taktwerk::ecat::sim
