#include "ecat/foe/file_writing.hpp"

#include <algorithm>
#include <utility>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat {

std::span<const std::byte> FileWriting::piece() const noexcept {
    const auto rest = file_.subspan(acknowledged_);
    return rest.first(std::min(rest.size(), room_));
}

FoeMessage FileWriting::request() const noexcept {
    if (packet_ == 0) return {FoeOp::write_request, what_.password, foe_text(what_.name)};
    return {FoeOp::data, packet_, piece()};
}

FoeStep FileWriting::answer(const FoeMessage& message) {
    using Kind = FoeStep::Kind;
    switch (message.op) {
        case FoeOp::acknowledge: {
            // Before anything was sent: of a transfer that somebody else left in the middle.
            if (message.number < packet_ || (packet_ == 0 && message.number != 0)) return {.kind = Kind::skip};
            if (message.number > packet_)
                return {.kind = Kind::broken, .code = foe_error::packet_number, .words = "a packet was acknowledged that was never sent"};
            const std::size_t sent = packet_ == 0 ? room_ : piece().size();
            if (packet_ > 0) acknowledged_ += sent;
            if (sent < room_) return {.kind = Kind::done};
            ++packet_;
            return {.kind = Kind::next};
        }
        case FoeOp::busy:
            return {.kind = Kind::again, .words = std::string{message.text()}, .done = message.done(), .entire = message.entire()};
        case FoeOp::error:
            if (packet_ == 0 && usual_foe_code(message.number) == foe_error::illegal && !std::exchange(asked_twice_, true))
                return {.kind = Kind::next};
            return {.kind = Kind::refused, .code = message.number, .words = std::string{message.text()}};
        case FoeOp::read_request:
        case FoeOp::write_request:
        case FoeOp::data: break;
    }
    return {.kind = Kind::broken, .code = foe_error::illegal, .words = "the answer is no answer to a file that is written"};
}

}  // namespace taktwerk::ecat
