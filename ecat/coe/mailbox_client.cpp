#include "ecat/coe/mailbox_client.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/wire/registers.hpp"
#include "ecat/wire/sdo.hpp"

namespace taktwerk::ecat {

namespace {

using Bytes = std::vector<std::byte>;

/// With mapped status the slave is asked all the same, rarely: process data may not be exchanged.
constexpr Duration mapped_status_doubt = std::chrono::milliseconds{20};
constexpr Duration busy_pause = std::chrono::milliseconds{10};  ///< after "no memory" and "in work"
constexpr Duration settled = std::chrono::milliseconds{5};      ///< a mapped flag may still show what was just read
constexpr int drain_limit = 16;                                 ///< messages; a slave that never stops is not waited for

std::uint16_t sm_register(std::uint8_t sm, std::uint16_t offset) { return static_cast<std::uint16_t>(reg::sync_manager_at(sm) + offset); }

void keep_emergency(MailboxEndpoint& mailbox, const Emergency& emergency, Instant now) {
    const std::uint32_t word = std::uint32_t{emergency.code} | (std::uint32_t{emergency.error_register} << 16);
    mailbox.emergency.store(emergency.code != 0 ? word : 0u, std::memory_order_relaxed);
    if (mailbox.log != nullptr) mailbox.log->keep({mailbox.slave, now, emergency});
}

/// Puts the message into the slave's mailbox.
Script<Result<void>> write_message(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, const Bytes& message,
                                   Instant deadline) {
    bool perhaps_written = false;
    for (;;) {
        const Reply reply = co_await port.fpwr(mailbox.station, mailbox.out_start, message, 1);
        if (!reply.lost && reply.wkc == 1) co_return Result<void>{};
        const Instant now = co_await time();
        if (reply.lost) {
            perhaps_written = true;  // the slave drops the repeat by its counter
        } else if (perhaps_written) {
            co_return Result<void>{};  // full: with the message whose frame did not come back
        }
        if (now >= deadline) {
            if (reply.lost) co_return unanswered(mailbox.subject, request.about, reply);
            co_return Error{"sdo.mailbox", mailbox.subject,
                            fmt::format("{}: the slave does not take mailbox messages (its mailbox stays full)", request.about),
                            "the slave's application hangs or left PREOP: power-cycle it"};
        }
        co_await pause(mailbox_poll_period);
    }
}

/// The frame with the mailbox's contents got lost: asks the slave to put the same message there again.
Script<bool> request_repeat(DatagramPort& port, MailboxEndpoint& mailbox, Instant deadline) {
    mailbox.repeat_toggle = !mailbox.repeat_toggle;
    const auto activate = static_cast<std::uint8_t>(SyncManager::enable | (mailbox.repeat_toggle ? SyncManager::repeat_request : 0));
    const Reply written = co_await port.fpwr(mailbox.station, sm_register(mailbox.in_sm, sm_activate_offset), activate);
    if (!written.ok()) co_return false;
    mailbox.repeated = true;
    for (;;) {
        const Reply reply = co_await port.fprd(mailbox.station, sm_register(mailbox.in_sm, sm_pdi_control_offset), 1);
        if (!reply.ok()) co_return false;
        const bool acknowledged = (static_cast<std::uint8_t>(reply.data[0]) & SyncManager::repeat_acknowledge) != 0;
        if (acknowledged == mailbox.repeat_toggle) co_return true;
        const Instant now = co_await time();
        if (now >= deadline) co_return false;
        co_await pause(mailbox_poll_period);
    }
}

/// co_await: until the cycle sees the mailbox full, or `limit`.
class FlagSet final : public Leaf<FlagSet> {
public:
    FlagSet(const MailboxFlag& flag, Instant limit) noexcept : flag_(flag), limit_(limit) {}
    bool ready(Instant now) override { return !flag_.mapped() || flag_.set() || now >= limit_; }
    void await_resume() const noexcept {}

private:
    const MailboxFlag& flag_;
    Instant limit_;
};

enum class Status : std::uint8_t { full, empty, unknown };

/// Looks once.
Script<Status> look(DatagramPort& port, MailboxEndpoint& mailbox, Reply& reply) {
    reply = co_await port.fprd(mailbox.station, sm_register(mailbox.in_sm, sm_status_offset), 1);
    if (!reply.ok()) co_return Status::unknown;
    co_return (static_cast<std::uint8_t>(reply.data[0]) & SyncManager::mailbox_full) != 0 ? Status::full : Status::empty;
}

/// Takes a message out of a full mailbox. No bytes: it was empty after all.
Script<Result<Bytes>> take_message(DatagramPort& port, MailboxEndpoint& mailbox, const std::string& about, Instant deadline) {
    for (;;) {
        Reply reply = co_await port.fprd(mailbox.station, mailbox.in_start, mailbox.in_size, 1);
        if (reply.ok()) co_return std::move(reply.data);
        if (!reply.lost) co_return Bytes{};
        const bool repeated = co_await request_repeat(port, mailbox, deadline);
        if (!repeated) co_return unanswered(mailbox.subject, about, reply);
        Reply status;
        const Status now_full = co_await look(port, mailbox, status);
        if (now_full == Status::unknown) co_return unanswered(mailbox.subject, about, status);
        if (now_full == Status::empty) co_return Bytes{};
    }
}

/// Waits for a message and takes it out.
Script<Result<Bytes>> read_message(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, Instant deadline) {
    Duration period = mailbox_poll_period;
    for (;;) {
        Instant now = co_await time();
        bool full = false;
        if (mailbox.flag.mapped()) {
            co_await FlagSet{mailbox.flag, std::min(deadline, now + mapped_status_doubt)};
            full = mailbox.flag.mapped() && mailbox.flag.set();
        }
        if (!full) {
            Reply reply;
            const Status status = co_await look(port, mailbox, reply);
            if (status == Status::unknown) co_return unanswered(mailbox.subject, request.about, reply);
            full = status == Status::full;
        }
        if (full) {
            Result<Bytes> message = co_await take_message(port, mailbox, request.about, deadline);
            if (!message || !message->empty()) co_return message;
        }
        now = co_await time();
        if (now >= deadline) {
            co_return Error{"sdo.timeout", mailbox.subject,
                            fmt::format("{}: no answer within {} ms", request.about, sdo_timeout / std::chrono::milliseconds{1}),
                            "the slave's application is busy or hangs: try again, then power-cycle it"};
        }
        co_await pause(mailbox.flag.mapped() ? mailbox_poll_period : period);  // mapped: until the cycle looked again
        period = std::min(2 * period, mailbox_longest_poll_period);
    }
}

/// What a message that came out of the mailbox is to a conversation.
struct Arrival {
    enum class Kind : std::uint8_t { mangled, refusal, emergency, coe, foreign } kind = Kind::foreign;
    MailboxErrorDetail detail = MailboxErrorDetail::none;  ///< of a refusal
    std::span<const std::byte> payload{};                  ///< of a CoE message
};

/// Keeps emergencies and the count of pending requests.
Arrival sort(MailboxEndpoint& mailbox, std::span<const std::byte> message, Instant now) {
    const auto parsed = parse_mailbox(message);
    if (!parsed) return {.kind = Arrival::Kind::mangled};
    const std::uint8_t counter = parsed->header.counter;
    const bool again = mailbox.repeated && counter != 0 && counter == mailbox.received;
    mailbox.repeated = false;
    mailbox.received = counter;
    if (again) return {.kind = Arrival::Kind::foreign};
    if (parsed->header.type == MailboxType::error) {
        if (mailbox.unanswered > 0) --mailbox.unanswered;
        return {.kind = Arrival::Kind::refusal, .detail = parse_mailbox_error(parsed->payload).value_or(MailboxErrorDetail::none)};
    }
    if (parsed->header.type != MailboxType::coe) return {.kind = Arrival::Kind::foreign};
    if (const auto emergency = parse_emergency(parsed->payload)) {
        keep_emergency(mailbox, *emergency, now);
        return {.kind = Arrival::Kind::emergency};
    }
    if (mailbox.unanswered > 0) --mailbox.unanswered;
    return {.kind = Arrival::Kind::coe, .payload = parsed->payload};
}

/// Reads the mailbox empty.
Script<Result<void>> drain(DatagramPort& port, MailboxEndpoint& mailbox, const std::string& about, Instant deadline) {
    for (int i = 0; i < drain_limit; ++i) {
        Reply reply;
        const Status status = co_await look(port, mailbox, reply);
        if (status == Status::unknown) co_return unanswered(mailbox.subject, about, reply);
        if (status == Status::empty) co_return Result<void>{};
        const Result<Bytes> message = co_await take_message(port, mailbox, about, deadline);
        if (!message) co_return message.error();
        const Instant now = co_await time();
        if (!message->empty()) (void)sort(mailbox, *message, now);
    }
    co_return Result<void>{};
}

/// Waits until the slave has room for one more request. Answers that came too late are read out meanwhile.
Script<Result<void>> await_room(DatagramPort& port, MailboxEndpoint& mailbox, const std::string& about, Instant deadline) {
    while (mailbox.unanswered > 0) {
        const Result<void> emptied = co_await drain(port, mailbox, about, deadline);
        if (!emptied) co_return emptied;
        const Instant now = co_await time();
        if (now - mailbox.last_written >= mailbox_forgets_after) mailbox.unanswered = 0;
        if (mailbox.unanswered < mailbox.max_pending) co_return Result<void>{};
        if (now >= deadline)
            co_return Error{"sdo.mailbox", mailbox.subject,
                            fmt::format("{}: not sent, {} earlier requests are still unanswered", about, mailbox.unanswered),
                            "the slave's application is busy or hangs: try again, then power-cycle it"};
        co_await pause(mailbox_longest_poll_period);
    }
    co_return Result<void>{};
}

Script<Result<void>> post(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, Instant deadline) {
    const Result<void> room = co_await await_room(port, mailbox, request.about, deadline);
    if (!room) co_return room;
    mailbox.counter = next_mailbox_counter(mailbox.counter);
    Bytes message(mailbox.out_size);
    if (request.payload.size() + mailbox_header_size > message.size())
        co_return Error{"sdo.protocol", mailbox.subject,
                        fmt::format("{}: the request does not fit into a mailbox of {} bytes", request.about, message.size()),
                        "check the mailbox sizes in its profile"};
    std::copy(request.payload.begin(), request.payload.end(), message.begin() + mailbox_header_size);
    finish_mailbox(message, MailboxType::coe, mailbox.counter, request.payload.size());
    const Result<void> written = co_await write_message(port, mailbox, request, message, deadline);
    mailbox.last_written = co_await time();
    co_return written;
}

Error refused(const MailboxEndpoint& mailbox, const MailboxRequest& request, MailboxErrorDetail detail) {
    return Error{"sdo.mailbox", mailbox.subject,
                 fmt::format("{}: mailbox error {} {}", request.about, static_cast<unsigned>(detail), text(detail)),
                 "the slave does not understand CoE requests: check the mailbox protocol and size in its profile"};
}

struct Answer {
    Bytes payload;           ///< CoE message
    bool try_again = false;  ///< the slave has no room now
};

/// Waits for the message that answers the request, skipping others.
Script<Result<Answer>> await_answer(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, Instant deadline) {
    mailbox.last_refusal = MailboxErrorDetail::none;
    for (;;) {
        const Result<Bytes> read = co_await read_message(port, mailbox, request, deadline);
        if (!read) co_return read.error();
        const Instant now = co_await time();
        const Arrival arrival = sort(mailbox, *read, now);
        switch (arrival.kind) {
            case Arrival::Kind::mangled:
                co_return Error{"sdo.protocol", mailbox.subject,
                                fmt::format("{}: the mailbox holds a message longer than itself", request.about),
                                "the slave's firmware is defective, or the mailbox size in its profile is wrong"};
            case Arrival::Kind::refusal: {
                mailbox.last_refusal = arrival.detail;
                const bool passes =
                    arrival.detail == MailboxErrorDetail::no_more_memory || arrival.detail == MailboxErrorDetail::service_in_work;
                if (!passes || now >= deadline) co_return refused(mailbox, request, arrival.detail);
                co_return Answer{{}, true};
            }
            case Arrival::Kind::coe:
                if (!request.answered_by(arrival.payload)) break;  // of a request that was given up
                co_return Answer{Bytes(arrival.payload.begin(), arrival.payload.end()), false};
            case Arrival::Kind::emergency:
            case Arrival::Kind::foreign: break;
        }
    }
}

}  // namespace

Script<Result<std::vector<std::byte>>> ask(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request) {
    const Instant started = co_await time();
    const Instant deadline = started + sdo_timeout;
    for (;;) {
        const Result<void> written = co_await post(port, mailbox, request, deadline);
        if (!written) co_return written.error();
        ++mailbox.unanswered;
        Result<Answer> answer = co_await await_answer(port, mailbox, request, deadline);
        if (!answer) co_return answer.error();
        if (!answer->try_again) {
            mailbox.unanswered = 0;  // slaves answer in order: nothing earlier can follow
            co_return std::move(answer->payload);
        }
        const Result<void> emptied = co_await drain(port, mailbox, request.about, deadline);
        if (!emptied) co_return emptied.error();
        co_await pause(busy_pause);
    }
}

Script<Result<std::vector<std::byte>>> await_more(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request) {
    const Instant now = co_await time();
    Result<Answer> answer = co_await await_answer(port, mailbox, request, now + sdo_timeout);
    if (!answer) co_return answer.error();
    if (answer->try_again) co_return refused(mailbox, request, mailbox.last_refusal);
    co_return std::move(answer->payload);
}

Script<Result<void>> tell(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request) {
    const Instant now = co_await time();
    co_return co_await post(port, mailbox, request, now + sdo_timeout);
}

Script<Result<void>> read_unasked(DatagramPort& port, MailboxEndpoint& mailbox) {
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};
    const Instant now = co_await time();
    const std::string about = "reading its mailbox";
    co_return co_await drain(port, mailbox, about, now + sdo_timeout);
}

Script<void> listen(DatagramPort& port, MailboxEndpoint& mailbox) {
    Instant asked = co_await time();
    for (;;) {
        const Instant now = co_await pause(settled);
        const bool flagged = mailbox.flag.mapped() && mailbox.flag.set();
        const bool ask_now = !mailbox.flag.mapped() && now - asked >= unasked_poll_period;
        if (mailbox.lock.taken() || !(flagged || ask_now)) continue;
        asked = now;
        const Result<void> read = co_await read_unasked(port, mailbox);
        (void)read;  // a slave that does not answer is the business of whoever watches its state
    }
}

}  // namespace taktwerk::ecat
