#include "ecat/mailbox/mailbox_client.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/wire/eoe.hpp"
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

/// "sdo.timeout", "foe.timeout": whose conversation failed.
std::string code_of(const MailboxRequest& request, const char* what) {
    const char* protocol = request.type == MailboxType::foe ? "foe" : request.type == MailboxType::eoe ? "eoe" : "sdo";
    return fmt::format("{}.{}", protocol, what);
}

std::uint16_t sm_register(std::uint8_t sm, std::uint16_t offset) { return static_cast<std::uint16_t>(reg::sync_manager_at(sm) + offset); }

void keep_emergency(MailboxEndpoint& mailbox, const Emergency& emergency, Instant now) {
    const std::uint32_t word = std::uint32_t{emergency.code} | (std::uint32_t{emergency.error_register} << 16);
    mailbox.emergency.store(emergency.code != 0 ? word : 0u, std::memory_order_relaxed);
    if (mailbox.log != nullptr) mailbox.log->keep({mailbox.slave, now, emergency});
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

/// A read leaves once the cycle has seen the mailbox full.
SendGate when_full(const MailboxEndpoint& mailbox) {
    SendGate gate;
    gate.word = mailbox.flag.word;
    gate.bit = mailbox.flag.bit;
    return gate;
}

enum class Status : std::uint8_t { full, empty, unknown };

/// Looks once.
Script<Status> look(DatagramPort& port, MailboxEndpoint& mailbox, Reply& reply) {
    reply = co_await port.fprd(mailbox.station, sm_register(mailbox.in_sm, sm_status_offset), 1);
    if (!reply.ok()) co_return Status::unknown;
    co_return (static_cast<std::uint8_t>(reply.data[0]) & SyncManager::mailbox_full) != 0 ? Status::full : Status::empty;
}

/// The message in the answer to a read of the mailbox. No bytes: it was empty.
Script<Result<Bytes>> message_in(DatagramPort& port, MailboxEndpoint& mailbox, const std::string& about, Reply reply, Instant deadline) {
    for (;;) {
        if (reply.ok()) co_return std::move(reply.data);
        if (!reply.lost || reply.held) co_return Bytes{};
        const bool repeated = co_await request_repeat(port, mailbox, deadline);
        if (!repeated) co_return unanswered(mailbox.subject, about, reply);
        Reply status;
        const Status now_full = co_await look(port, mailbox, status);
        if (now_full == Status::unknown) co_return unanswered(mailbox.subject, about, status);
        if (now_full == Status::empty) co_return Bytes{};
        reply = co_await port.fprd(mailbox.station, mailbox.in_start, mailbox.in_size, 1);
    }
}

/// Takes a message out of a full mailbox. No bytes: it was empty after all.
Script<Result<Bytes>> take_message(DatagramPort& port, MailboxEndpoint& mailbox, const std::string& about, Instant deadline) {
    Reply reply = co_await port.fprd(mailbox.station, mailbox.in_start, mailbox.in_size, 1);
    co_return co_await message_in(port, mailbox, about, std::move(reply), deadline);
}

Error no_answer(const MailboxEndpoint& mailbox, const MailboxRequest& request, std::string_view but) {
    return Error{code_of(request, "timeout"), mailbox.subject,
                 fmt::format("{}: no answer within {} ms{}", request.about, request.patience / std::chrono::milliseconds{1}, but),
                 "the slave's application is busy or hangs: try again, then power-cycle it"};
}

/// Waits for a message and takes it out.
Script<Result<Bytes>> read_message(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, Instant deadline) {
    Duration period = mailbox_poll_period;
    for (;;) {
        Instant now = co_await time();
        if (mailbox.flag.mapped()) {
            Reply reply = co_await port.fprd_gated(mailbox.station, mailbox.in_start, mailbox.in_size, when_full(mailbox),
                                                   std::clamp(deadline - now, Duration{}, mapped_status_doubt));
            if (!reply.held) {
                Result<Bytes> message = co_await message_in(port, mailbox, request.about, std::move(reply), deadline);
                if (!message || !message->empty()) co_return message;
            }
        }
        Reply reply;
        const Status status = co_await look(port, mailbox, reply);
        if (status == Status::unknown) co_return unanswered(mailbox.subject, request.about, reply);
        if (status == Status::full) {
            Result<Bytes> message = co_await take_message(port, mailbox, request.about, deadline);
            if (!message || !message->empty()) co_return message;
        }
        now = co_await time();
        if (now >= deadline) {
            const Reply out = co_await port.fprd(mailbox.station, sm_register(mailbox.out_sm, sm_status_offset), 1);
            const bool lies = out.ok() && (static_cast<std::uint8_t>(out.data[0]) & SyncManager::mailbox_full) != 0;
            co_return no_answer(mailbox, request, lies ? "; the request still lies in its mailbox, which stays full" : "");
        }
        if (mailbox.flag.mapped()) continue;
        co_await pause(period);
        period = std::min(2 * period, mailbox_longest_poll_period);
    }
}

/// What a message that came out of the mailbox is to a conversation.
struct Arrival {
    enum class Kind : std::uint8_t { mangled, refusal, emergency, message, foreign } kind = Kind::foreign;
    MailboxErrorDetail detail = MailboxErrorDetail::none;  ///< of a refusal
    MailboxType type = MailboxType::error;                 ///< of a message
    std::span<const std::byte> payload{};                  ///< likewise
};

/// Keeps emergencies and the count of pending requests; hands Ethernet on.
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
    const MailboxType type = parsed->header.type;
    if (type == MailboxType::eoe && eoe_type(parsed->payload) == EoeType::fragment) {
        if (mailbox.ethernet) mailbox.ethernet(parsed->payload);
        return {.kind = Arrival::Kind::foreign};
    }
    if (type != MailboxType::coe && type != MailboxType::foe && type != MailboxType::eoe) return {.kind = Arrival::Kind::foreign};
    const auto emergency = type == MailboxType::coe ? parse_emergency(parsed->payload) : std::nullopt;
    if (emergency) {
        keep_emergency(mailbox, *emergency, now);
        return {.kind = Arrival::Kind::emergency};
    }
    if (mailbox.unanswered > 0) --mailbox.unanswered;
    return {.kind = Arrival::Kind::message, .type = type, .payload = parsed->payload};
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
Script<Result<void>> await_room(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, Instant deadline) {
    while (mailbox.unanswered > 0) {
        const Result<void> emptied = co_await drain(port, mailbox, request.about, deadline);
        if (!emptied) co_return emptied;
        const Instant now = co_await time();
        if (now - mailbox.last_written >= mailbox_forgets_after) mailbox.unanswered = 0;
        if (mailbox.unanswered < mailbox.max_pending) co_return Result<void>{};
        if (now >= deadline)
            co_return Error{code_of(request, "mailbox"), mailbox.subject,
                            fmt::format("{}: not sent, {} earlier requests are still unanswered", request.about, mailbox.unanswered),
                            "the slave's application is busy or hangs: try again, then power-cycle it"};
        co_await pause(mailbox_longest_poll_period);
    }
    co_return Result<void>{};
}

/// The mailbox with the request in it.
Result<Bytes> letter(MailboxEndpoint& mailbox, const MailboxRequest& request) {
    Bytes message(mailbox.out_size);
    if (request.payload.size() + mailbox_header_size > message.size())
        return Error{code_of(request, "protocol"), mailbox.subject,
                     fmt::format("{}: the request does not fit into a mailbox of {} bytes", request.about, message.size()),
                     "check the mailbox sizes in its profile"};
    mailbox.counter = next_mailbox_counter(mailbox.counter);
    std::copy(request.payload.begin(), request.payload.end(), message.begin() + mailbox_header_size);
    finish_mailbox(message, request.type, mailbox.counter, request.payload.size());
    return message;
}

Error not_taken(const MailboxEndpoint& mailbox, const MailboxRequest& request, const Reply& written) {
    if (written.lost) return unanswered(mailbox.subject, request.about, written);
    return Error{code_of(request, "mailbox"), mailbox.subject,
                 fmt::format("{}: the slave does not take mailbox messages (its mailbox stays full)", request.about),
                 "the slave's application hangs or left PREOP: power-cycle it"};
}

bool answers(const MailboxRequest& request, const Bytes& message) {
    const auto parsed = parse_mailbox(message);
    return parsed && parsed->header.type == request.type && request.answered_by(parsed->payload);
}

/// Puts the request into the slave's mailbox and sends the reading of the answer after it without waiting in between: where
/// the status is mapped it leaves when the mailbox is full, else in the next frame (a read of an empty mailbox changes
/// nothing). The message that came with it; no bytes: none yet.
Script<Result<Bytes>> post(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, Instant deadline) {
    const Result<void> room = co_await await_room(port, mailbox, request, deadline);
    if (!room) co_return room.error();
    const Result<Bytes> message = letter(mailbox, request);
    if (!message) co_return message.error();
    bool perhaps_written = false;
    for (;;) {
        Instant now = co_await time();
        Transfer write = port.fpwr(mailbox.station, mailbox.out_start, *message, 1);
        write.start(now);
        SendGate gate = when_full(mailbox);
        if (!mailbox.flag.mapped()) gate.behind = write.entry();
        Transfer read = port.fprd_gated(mailbox.station, mailbox.in_start, mailbox.in_size, gate, mapped_status_doubt);
        if (request.answered_by) read.start(now);

        const Reply written = co_await write;
        // The frame that comes back full after one that was lost: with the message of the lost one.
        const bool taken = !written.lost && (written.wkc == 1 || perhaps_written);
        now = co_await time();
        if (taken) mailbox.last_written = now;
        Bytes early;
        if (request.answered_by && (taken || !read.withdraw())) {
            Reply reply = co_await read;
            Result<Bytes> arrived = co_await message_in(port, mailbox, request.about, std::move(reply), deadline);
            if (!arrived) co_return arrived;
            early = std::move(*arrived);
        }
        if (taken || (written.lost && answers(request, early))) co_return early;  // only the frame of the request got lost
        if (!early.empty()) (void)sort(mailbox, early, now);                      // something else that waited
        perhaps_written = perhaps_written || written.lost;                        // the slave drops a repeat by its counter
        if (now >= deadline) co_return not_taken(mailbox, request, written);
        co_await pause(mailbox_poll_period);
    }
}

Error refused(const MailboxEndpoint& mailbox, const MailboxRequest& request, MailboxErrorDetail detail) {
    return Error{
        code_of(request, "mailbox"), mailbox.subject,
        fmt::format("{}: mailbox error {} {}", request.about, static_cast<unsigned>(detail), text(detail)),
        fmt::format("the slave does not understand {} requests: check the mailbox protocol and size in its profile", name(request.type))};
}

struct Answer {
    Bytes payload;           ///< without mailbox header
    bool try_again = false;  ///< the slave has no room now
};

/// Waits for the message that answers the request, skipping others. `read`: the first that came; no bytes: none yet.
Script<Result<Answer>> await_answer(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request, Result<Bytes> read,
                                    Instant deadline) {
    mailbox.last_refusal = MailboxErrorDetail::none;
    for (;; read = Bytes{}) {
        if (read->empty()) read = co_await read_message(port, mailbox, request, deadline);
        if (!read) co_return read.error();
        const Instant now = co_await time();
        const Arrival arrival = sort(mailbox, *read, now);
        switch (arrival.kind) {
            case Arrival::Kind::mangled:
                co_return Error{code_of(request, "protocol"), mailbox.subject,
                                fmt::format("{}: the mailbox holds a message longer than itself", request.about),
                                "the slave's firmware is defective, or the mailbox size in its profile is wrong"};
            case Arrival::Kind::refusal: {
                mailbox.last_refusal = arrival.detail;
                const bool passes =
                    arrival.detail == MailboxErrorDetail::no_more_memory || arrival.detail == MailboxErrorDetail::service_in_work;
                if (!passes || now >= deadline) co_return refused(mailbox, request, arrival.detail);
                co_return Answer{{}, true};
            }
            case Arrival::Kind::message:
                if (arrival.type != request.type || !request.answered_by(arrival.payload)) break;  // of a request that was given up
                co_return Answer{Bytes(arrival.payload.begin(), arrival.payload.end()), false};
            case Arrival::Kind::emergency:
            case Arrival::Kind::foreign: break;
        }
        // One that talks without end and answers nothing.
        if (now >= deadline) co_return no_answer(mailbox, request, "; it sends other messages all the time");
    }
}

}  // namespace

Script<Result<std::vector<std::byte>>> ask(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request) {
    const Instant started = co_await time();
    const Instant deadline = started + request.patience;
    for (;;) {
        Result<Bytes> first = co_await post(port, mailbox, request, deadline);
        if (!first) co_return first.error();
        ++mailbox.unanswered;
        Result<Answer> answer = co_await await_answer(port, mailbox, request, std::move(first), deadline);
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
    Result<Bytes> none = Bytes{};
    Result<Answer> answer = co_await await_answer(port, mailbox, request, std::move(none), now + request.patience);
    if (!answer) co_return answer.error();
    if (answer->try_again) co_return refused(mailbox, request, mailbox.last_refusal);
    co_return std::move(answer->payload);
}

Script<Result<void>> tell(DatagramPort& port, MailboxEndpoint& mailbox, const MailboxRequest& request) {
    const Instant now = co_await time();
    const Result<Bytes> written = co_await post(port, mailbox, request, now + request.patience);
    if (!written) co_return written.error();
    co_return Result<void>{};
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
        if (mailbox.station == 0 || mailbox.lock.taken() || !(flagged || ask_now)) continue;
        asked = now;
        const Result<void> read = co_await read_unasked(port, mailbox);
        (void)read;  // a slave that does not answer is the business of whoever watches its state
    }
}

}  // namespace taktwerk::ecat
