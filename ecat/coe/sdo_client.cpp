#include "ecat/coe/sdo_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ecat/wire/mailbox.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {

namespace {

using Bytes = std::vector<std::byte>;

/// What one SDO conversation is about, for messages and for matching answers.
struct Conversation {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    const char* verb = "";  // "reading", "writing"
};

std::string about(const Conversation& transfer) { return fmt::format("{} {}", transfer.verb, object_text(transfer.index, transfer.sub)); }

Error abort_error(const MailboxEndpoint& mailbox, const Conversation& transfer, std::uint32_t code) {
    std::string remedy;
    switch (code) {
        case sdo_abort::no_object: remedy = "this firmware does not have the object: check the profile against the drive's manual"; break;
        case sdo_abort::no_subindex:
            remedy = "this firmware does not have the sub-index: check the profile against the drive's manual";
            break;
        case sdo_abort::read_only: remedy = "the object cannot be written: remove it from the start-up list"; break;
        case sdo_abort::write_only: remedy = "the object cannot be read back: set verify: false"; break;
        case sdo_abort::device_state:
        case sdo_abort::local_control:
            remedy = "the drive does not accept it in its present state: disable the axis, or write it in PREOP";
            break;
        case sdo_abort::value_range:
        case sdo_abort::value_too_high:
        case sdo_abort::value_too_low: remedy = "choose a value within the range the manual gives"; break;
        case sdo_abort::wrong_length:
        case sdo_abort::too_long:
        case sdo_abort::too_short: remedy = "the data type does not fit the object: check the type in the profile or start-up list"; break;
        case sdo_abort::not_mappable:
        case sdo_abort::pdo_length: remedy = "the drive does not accept this PDO mapping: map fewer or other objects"; break;
        default: break;
    }
    return Error{"sdo.abort", mailbox.subject, fmt::format("{} was refused: abort {:08X}h {}", about(transfer), code, sdo_abort_text(code)),
                 remedy};
}

void keep_emergency(MailboxEndpoint& mailbox, const Emergency& emergency) {
    if (mailbox.emergencies.size() >= MailboxEndpoint::emergency_limit) mailbox.emergencies.erase(mailbox.emergencies.begin());
    mailbox.emergencies.push_back(emergency);
}

std::uint16_t sm_register(std::uint8_t sm, std::uint16_t offset) { return static_cast<std::uint16_t>(reg::sync_manager_at(sm) + offset); }

/// Puts the message into the slave's mailbox.
Script<Result<void>> write_message(DatagramPort& port, MailboxEndpoint& mailbox, Conversation transfer, const Bytes& message,
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
            if (reply.lost) co_return unanswered(mailbox.subject, about(transfer), reply);
            co_return Error{"sdo.mailbox", mailbox.subject,
                            fmt::format("{}: the slave does not take mailbox messages (its mailbox stays full)", about(transfer)),
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

/// Waits for a message and takes it out.
Script<Result<Bytes>> read_message(DatagramPort& port, MailboxEndpoint& mailbox, Conversation transfer, Instant deadline) {
    for (;;) {
        const Reply status = co_await port.fprd(mailbox.station, sm_register(mailbox.in_sm, sm_status_offset), 1);
        if (!status.ok()) co_return unanswered(mailbox.subject, about(transfer), status);
        if ((static_cast<std::uint8_t>(status.data[0]) & SyncManager::mailbox_full) != 0) {
            Reply reply = co_await port.fprd(mailbox.station, mailbox.in_start, mailbox.in_size, 1);
            if (reply.ok()) co_return std::move(reply.data);
            if (reply.lost) {
                const bool repeated = co_await request_repeat(port, mailbox, deadline);
                if (!repeated) co_return unanswered(mailbox.subject, about(transfer), reply);
                continue;
            }
        }
        const Instant now = co_await time();
        if (now >= deadline) {
            co_return Error{"sdo.timeout", mailbox.subject,
                            fmt::format("{}: no answer within {} ms", about(transfer), sdo_timeout / std::chrono::milliseconds{1}),
                            "the slave's application is busy or hangs: try again, then power-cycle it"};
        }
        co_await pause(mailbox_poll_period);
    }
}

/// One request, one answer of the wanted kind; the answer is a view into `storage`. Aborts and mailbox errors become errors.
Script<Result<SdoMessage>> ask(DatagramPort& port, MailboxEndpoint& mailbox, Conversation transfer, const Bytes& payload, SdoKind wanted,
                               Bytes& storage) {
    const Instant started = co_await time();
    const Instant deadline = started + sdo_timeout;
    for (;;) {
        mailbox.counter = next_mailbox_counter(mailbox.counter);
        Bytes message(mailbox.out_size);
        std::copy(payload.begin(), payload.end(), message.begin() + mailbox_header_size);
        finish_mailbox(message, MailboxType::coe, mailbox.counter, payload.size());
        const Result<void> written = co_await write_message(port, mailbox, transfer, message, deadline);
        if (!written) co_return written.error();

        bool ask_again = false;
        while (!ask_again) {
            Result<Bytes> read = co_await read_message(port, mailbox, transfer, deadline);
            if (!read) co_return read.error();
            storage = std::move(*read);
            const auto parsed = parse_mailbox(storage);
            if (!parsed) {
                co_return Error{"sdo.protocol", mailbox.subject,
                                fmt::format("{}: the mailbox holds a message longer than itself", about(transfer)),
                                "the slave's firmware is defective, or the mailbox size in its profile is wrong"};
            }
            if (parsed->header.type == MailboxType::error) {
                const auto detail = parse_mailbox_error(parsed->payload).value_or(MailboxErrorDetail::none);
                const Instant now = co_await time();
                const bool passes = detail == MailboxErrorDetail::no_more_memory || detail == MailboxErrorDetail::service_in_work;
                if (passes && now < deadline) {
                    co_await pause(10 * mailbox_poll_period);
                    ask_again = true;
                    continue;
                }
                co_return Error{"sdo.mailbox", mailbox.subject,
                                fmt::format("{}: mailbox error {} {}", about(transfer), static_cast<unsigned>(detail), text(detail)),
                                "the slave does not understand CoE requests: check the mailbox protocol and size in its profile"};
            }
            if (parsed->header.type != MailboxType::coe) continue;
            if (const auto emergency = parse_emergency(parsed->payload)) {
                keep_emergency(mailbox, *emergency);
                continue;
            }
            const auto answer = parse_sdo(parsed->payload);
            if (!answer) continue;
            const bool initiate = wanted == SdoKind::upload_response || wanted == SdoKind::download_response;
            const bool same_object = answer->index == transfer.index && answer->sub == transfer.sub;
            if (answer->kind == SdoKind::abort && same_object) co_return abort_error(mailbox, transfer, answer->abort_code);
            if (answer->kind != wanted || (initiate && !same_object)) continue;  // an answer that came too late for its own request
            co_return *answer;
        }
    }
}

Error no_mailbox(const MailboxEndpoint& mailbox, const Conversation& transfer) {
    return Error{"sdo.no_mailbox", mailbox.subject, fmt::format("{} is not possible: the slave has no CoE mailbox", about(transfer)),
                 "remove start-up SDOs and parameters from this slave"};
}

Error wrong_segment(const MailboxEndpoint& mailbox, const Conversation& transfer, const char* what) {
    return Error{"sdo.protocol", mailbox.subject, fmt::format("{}: {}", about(transfer), what),
                 "try again; if it stays, the slave's firmware is defective"};
}

}  // namespace

std::string object_text(std::uint16_t index, std::uint8_t sub) { return fmt::format("{:04X}h:{:02X}", index, sub); }

std::uint32_t abort_code(const Error& error) noexcept {
    if (error.code != "sdo.abort") return 0;
    const auto at = error.what.find("abort ");
    return at == std::string::npos ? 0 : static_cast<std::uint32_t>(std::strtoul(error.what.c_str() + at + 6, nullptr, 16));
}

Script<Result<std::vector<std::byte>>> sdo_upload(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub) {
    const Conversation transfer{index, sub, "reading"};
    if (mailbox.in_size == 0) co_return no_mailbox(mailbox, transfer);
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};

    Bytes storage;
    Bytes request(sdo_initiate_size);
    encode_upload_request(request, index, sub);
    const Result<SdoMessage> first = co_await ask(port, mailbox, transfer, request, SdoKind::upload_response, storage);
    if (!first) co_return first.error();
    Bytes value(first->data.begin(), first->data.end());
    const std::size_t complete = first->expedited ? value.size() : first->complete_size;

    bool toggle = false;
    bool last = value.size() >= complete;
    while (!last) {
        Bytes segment(sdo_initiate_size);
        encode_upload_segment_request(segment, toggle);
        const Result<SdoMessage> next = co_await ask(port, mailbox, transfer, segment, SdoKind::upload_segment_response, storage);
        if (!next) co_return next.error();
        if (next->toggle != toggle) co_return wrong_segment(mailbox, transfer, "a segment came twice or was skipped (toggle bit)");
        value.insert(value.end(), next->data.begin(), next->data.end());
        if (value.size() > complete) co_return wrong_segment(mailbox, transfer, "the segments are longer than the size announced");
        if (next->data.empty() && !next->last) co_return wrong_segment(mailbox, transfer, "an empty segment that is not the last");
        last = next->last;
        toggle = !toggle;
    }
    co_return value;
}

Script<Result<void>> sdo_download(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub,
                                  std::vector<std::byte> data) {
    const Conversation transfer{index, sub, "writing"};
    if (mailbox.out_size == 0) co_return no_mailbox(mailbox, transfer);
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};

    Bytes storage;
    Bytes request(static_cast<std::size_t>(mailbox.out_size) - mailbox_header_size);
    const std::size_t used = encode_download_request(request, index, sub, data);
    std::size_t done = data.size() <= 4 ? data.size() : used - sdo_initiate_size;
    request.resize(used);
    const Result<SdoMessage> first = co_await ask(port, mailbox, transfer, request, SdoKind::download_response, storage);
    if (!first) co_return first.error();

    bool toggle = false;
    const std::size_t room = static_cast<std::size_t>(mailbox.out_size) - mailbox_header_size - sdo_segment_header_size;
    while (done < data.size()) {
        const std::size_t part = std::min(room, data.size() - done);
        Bytes segment(part + sdo_segment_header_size + sdo_segment_minimum);
        const auto piece = std::span<const std::byte>{data}.subspan(done, part);
        const std::size_t size = encode_download_segment_request(segment, toggle, done + part == data.size(), piece);
        segment.resize(size);
        const Result<SdoMessage> next = co_await ask(port, mailbox, transfer, segment, SdoKind::download_segment_response, storage);
        if (!next) co_return next.error();
        if (next->toggle != toggle) co_return wrong_segment(mailbox, transfer, "a segment was acknowledged twice or skipped (toggle bit)");
        done += part;
        toggle = !toggle;
    }
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
