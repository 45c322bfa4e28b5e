#include "modbus/client/client.hpp"

#include <algorithm>

namespace taktwerk::modbus {

namespace {

/// Twice does no harm: the same value, the same state. Saving wears the memory and takes its time: once.
bool may_repeat(Function function) noexcept { return function != Function::save; }

/// Bytes reach us through a driver and a thread that look in from time to time (a USB adapter gathers up to 16 ms): a pause that long inside
/// a frame is not the drive's. One in all: bytes that trickle in, each within its pause, are no answer either and hold nobody up.
constexpr Duration pause = std::chrono::milliseconds{20};

}  // namespace

std::string_view name(Outcome outcome) noexcept {
    switch (outcome) {
        case Outcome::answered: return "answered";
        case Outcome::exception: return "refused";
        case Outcome::silent: return "no answer";
        case Outcome::damaged: return "a damaged answer";
        case Outcome::no_port: return "the serial port is not there";
    }
    return "?";
}

std::string_view name(Refusal refusal) noexcept {
    switch (refusal) {
        case Refusal::none: return "none";
        case Refusal::busy: return "the line is busy";
        case Refusal::too_many_words: return "more words than the drive takes in one request";
        case Refusal::no_words: return "no words";
        case Refusal::saving: return "the drive saves its parameters";
    }
    return "?";
}

Duration Client::worst_time(std::size_t request_bytes, std::size_t response_bytes) const noexcept {
    const auto& line = line_.settings();
    return line.duration(request_bytes + response_bytes) + 2 * line.frame_gap() + config_.answer_timeout;
}

Refusal Client::may_ask(const Request& request, Instant now) const noexcept {
    switch (request.function) {
        case Function::read_parameters:
        case Function::read_status:
            if (request.count == 0) return Refusal::no_words;
            if (request.count > read_words_limit) return Refusal::too_many_words;
            break;
        case Function::write_parameters:
            if (request.count == 0) return Refusal::no_words;
            if (request.count > write_words_limit) return Refusal::too_many_words;
            break;
        default: break;
    }
    if (now < saving_[request.station]) return Refusal::saving;
    return idle(now) ? Refusal::none : Refusal::busy;
}

Refusal Client::ask(const Request& request, Instant now) {
    if (const auto refusal = may_ask(request, now); refusal != Refusal::none) return refusal;
    request_ = request;
    tries_left_ = may_repeat(request.function) ? std::max<std::uint8_t>(config_.tries, 1) : std::uint8_t{1};
    asked_at_ = now;
    ++statistics_.asked;
    unanswered_ = false;
    if (may_get_the_answer_to_another(request, now)) {
        state_ = State::resting;
        quiet_until_ = owed_until_;
    } else send(now);
    return Refusal::none;
}

bool Client::may_get_the_answer_to_another(const Request& request, Instant now) const noexcept {
    const bool reads = request.function == Function::read_parameters || request.function == Function::read_status;  // others are echoed
    return reads && now < owed_until_ && request.station == owed_.station && request.function == owed_.function &&
           request.count == owed_.count && request.address != owed_.address;
}

void Client::send(Instant now) {
    state_ = State::waiting;
    line_.discard(now);
    heard_.size = 0;
    const auto frame = encode(request_);
    port_there_ = line_.send(frame.span(), now);
    sent_at_ = now + line_.settings().duration(frame.size);
    --tries_left_;
}

std::optional<Answer> Client::step(Instant now) {
    if (state_ != State::waiting) {
        line_.discard(now);  // nobody asked; and a computed line lives by being looked at
        if (state_ == State::resting && now >= quiet_until_) send(now);
        return std::nullopt;
    }
    if (!port_there_) return again_or_end(Outcome::no_port, now);

    const auto got = line_.receive(std::span{heard_.bytes}.subspan(heard_.size), now);
    heard_.size += got;
    if (got > 0) last_byte_ = now;
    const auto length = frame_length(Direction::response, heard_.span());
    if (length.known == LengthKnown::yes && heard_.size >= length.bytes) {
        heard_.size = length.bytes;
        Response response;
        if (parse_response(heard_.span(), request_, response) != WireError::none) return again_or_end(Outcome::damaged, now);
        auto answer = end(response.exception == ExceptionCode::none ? Outcome::answered : Outcome::exception, now);
        answer.sampled = now - line_.settings().duration(length.bytes);
        answer.response = response;
        return answer;
    }
    if (length.known == LengthKnown::never) return again_or_end(Outcome::damaged, now);
    if (heard_.size == 0) return now - sent_at_ > config_.answer_timeout ? again_or_end(Outcome::silent, now) : std::nullopt;
    const auto& settings = line_.settings();
    const bool paused = now - last_byte_ > settings.frame_gap() + pause;
    const auto whole = settings.duration(std::max<std::size_t>(length.bytes, heard_.size));
    const bool trickles = now - sent_at_ > config_.answer_timeout + whole + settings.frame_gap() + pause;
    return paused || trickles ? again_or_end(Outcome::damaged, now) : std::nullopt;
}

std::optional<Answer> Client::again_or_end(Outcome outcome, Instant now) {
    if (outcome == Outcome::silent) ++statistics_.timeouts;
    unanswered_ = unanswered_ || outcome == Outcome::silent;
    if (outcome == Outcome::damaged) ++statistics_.damaged;
    if (tries_left_ == 0) return end(outcome, now);
    ++statistics_.retries;
    state_ = State::resting;
    quiet_until_ = now + line_.settings().frame_gap();
    return std::nullopt;
}

Answer Client::end(Outcome outcome, Instant now) {
    state_ = State::idle;
    quiet_until_ = now + line_.settings().frame_gap();
    if (unanswered_) {
        owed_ = request_;
        owed_until_ = sent_at_ + 2 * config_.answer_timeout;  // it was patient for as long already
    }
    Answer answer;
    answer.outcome = outcome;
    answer.request = request_;
    answer.took = now - asked_at_;
    if (outcome == Outcome::answered) {
        ++statistics_.answered;
        statistics_.longest = std::max(statistics_.longest, answer.took);
    }
    if (outcome == Outcome::exception) ++statistics_.exceptions;
    // Also when no answer came: the drive may have heard, and saving must not be disturbed.
    if (request_.function == Function::save && outcome != Outcome::exception && outcome != Outcome::no_port)
        saving_[request_.station] = now + std::chrono::seconds{save_seconds};
    return answer;
}

}  // namespace taktwerk::modbus
