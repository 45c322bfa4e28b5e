#include "ecat/foe/file_reading.hpp"

#include <utility>

#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat {

FoeMessage FileReading::request() const noexcept {
    if (!accepted_) return {FoeOp::read_request, what_.password, foe_text(what_.name)};
    return {FoeOp::acknowledge, packet_, {}};
}

FoeStep FileReading::answer(const FoeMessage& message) {
    using Kind = FoeStep::Kind;
    switch (message.op) {
        case FoeOp::data: {
            if (message.number == packet_ && packet_ > 0) return {.kind = Kind::skip};
            if (message.number != packet_ + 1)
                return {.kind = Kind::broken, .code = foe_error::packet_number, .words = "a packet is missing, or came out of turn"};
            if (message.rest.size() > limit_ - file_.size())
                return {.kind = Kind::broken, .code = foe_error::disk_full, .words = "the file is larger than what is taken"};
            file_.insert(file_.end(), message.rest.begin(), message.rest.end());
            accepted_ = true;
            ++packet_;
            return {.kind = message.rest.size() < room_ ? Kind::last : Kind::next};
        }
        case FoeOp::busy:
            accepted_ = true;
            return {.kind = Kind::again, .words = std::string{message.text()}, .done = message.done(), .entire = message.entire()};
        case FoeOp::error:
            if (!accepted_ && usual_foe_code(message.number) == foe_error::illegal && !std::exchange(asked_twice_, true))
                return {.kind = Kind::next};
            return {.kind = Kind::refused, .code = message.number, .words = std::string{message.text()}};
        case FoeOp::read_request:
        case FoeOp::write_request:
        case FoeOp::acknowledge: break;
    }
    return {.kind = Kind::broken, .code = foe_error::illegal, .words = "the answer is no answer to a file that is read"};
}

}  // namespace taktwerk::ecat
