#include "ecat/coe/sdo_client.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace taktwerk::ecat {

namespace {

using Bytes = std::vector<std::byte>;

/// One SDO transfer, for messages and for matching answers.
struct Conversation {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    SdoAccess access = SdoAccess::entry;
    std::string about;  // "reading 1C12h:00"

    [[nodiscard]] bool complete() const noexcept { return access == SdoAccess::complete; }
};

Conversation conversation(const char* verb, std::uint16_t index, std::uint8_t sub, SdoAccess access) {
    return {index, sub, access,
            access == SdoAccess::complete ? fmt::format("{} all of {:04X}h", verb, index)
                                          : fmt::format("{} {}", verb, object_text(index, sub))};
}

/// An answer with the bytes it points into.
struct SdoAnswer {
    Bytes payload;
    SdoMessage message;
};

/// One request, one answer of the wanted kind. Aborts become errors.
Script<Result<SdoAnswer>> ask_sdo(DatagramPort& port, MailboxEndpoint& mailbox, const Conversation& transfer, Bytes payload,
                                  SdoKind wanted) {
    MailboxRequest request;
    request.about = transfer.about;
    request.payload = std::move(payload);
    request.answered_by = [&transfer, wanted](std::span<const std::byte> bytes) {
        const auto answer = parse_sdo(bytes);
        if (!answer) return false;
        const bool same_object = answer->index == transfer.index && answer->sub == transfer.sub;
        if (answer->kind == SdoKind::abort) return same_object;
        const bool initiate = wanted == SdoKind::upload_response || wanted == SdoKind::download_response;
        return answer->kind == wanted && (same_object || !initiate);
    };
    Result<Bytes> bytes = co_await ask(port, mailbox, request);
    if (!bytes) co_return bytes.error();
    SdoAnswer answer;
    answer.payload = std::move(*bytes);
    answer.message = *parse_sdo(answer.payload);  // answered_by has parsed the same bytes
    if (answer.message.kind == SdoKind::abort) co_return abort_error(mailbox, transfer.about, answer.message.abort_code);
    co_return answer;
}

Error no_mailbox(const MailboxEndpoint& mailbox, const Conversation& transfer) {
    return Error{"sdo.no_mailbox", mailbox.subject, fmt::format("{} is not possible: the slave has no CoE mailbox", transfer.about),
                 "remove start-up SDOs and parameters from this slave"};
}

/// The slave answers something that does not belong here: the transfer is ended on both sides.
Script<Error> wrong_segment(DatagramPort& port, MailboxEndpoint& mailbox, const Conversation& transfer, std::uint32_t code,
                            const char* what) {
    MailboxRequest abort;
    abort.about = transfer.about;
    abort.payload.resize(sdo_initiate_size);
    encode_sdo_abort(abort.payload, transfer.index, transfer.sub, code);
    const Result<void> told = co_await tell(port, mailbox, abort);
    (void)told;  // the transfer has failed either way
    co_return Error{"sdo.protocol", mailbox.subject, fmt::format("{}: {}", transfer.about, what),
                    "try again; if it stays, the slave's firmware is defective"};
}

}  // namespace

std::string object_text(std::uint16_t index, std::uint8_t sub) { return fmt::format("{:04X}h:{:02X}", index, sub); }

Script<Result<std::vector<std::byte>>> sdo_upload(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub,
                                                  SdoAccess access) {
    const Conversation transfer = conversation("reading", index, sub, access);
    if (mailbox.in_size == 0) co_return no_mailbox(mailbox, transfer);
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};

    Bytes request(sdo_initiate_size);
    encode_upload_request(request, index, sub, transfer.complete());
    const Result<SdoAnswer> first = co_await ask_sdo(port, mailbox, transfer, std::move(request), SdoKind::upload_response);
    if (!first) co_return first.error();
    const SdoMessage& head = first->message;
    Bytes value(head.data.begin(), head.data.end());
    const std::size_t complete = head.expedited ? value.size() : head.complete_size;

    bool toggle = false;
    bool last = value.size() >= complete;
    while (!last) {
        Bytes segment(sdo_initiate_size);
        encode_upload_segment_request(segment, toggle);
        const Result<SdoAnswer> next = co_await ask_sdo(port, mailbox, transfer, std::move(segment), SdoKind::upload_segment_response);
        if (!next) co_return next.error();
        const SdoMessage& part = next->message;
        if (part.toggle != toggle) {
            const Error error =
                co_await wrong_segment(port, mailbox, transfer, sdo_abort::toggle, "a segment came twice or was skipped (toggle bit)");
            co_return error;
        }
        value.insert(value.end(), part.data.begin(), part.data.end());
        if (value.size() > complete) {
            const Error error =
                co_await wrong_segment(port, mailbox, transfer, sdo_abort::too_long, "the segments are longer than the size announced");
            co_return error;
        }
        if (part.data.empty() && !part.last) {
            const Error error =
                co_await wrong_segment(port, mailbox, transfer, sdo_abort::too_short, "an empty segment that is not the last");
            co_return error;
        }
        last = part.last;
        toggle = !toggle;
    }
    co_return value;
}

Script<Result<void>> sdo_download(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub,
                                  std::vector<std::byte> data, SdoAccess access) {
    const Conversation transfer = conversation("writing", index, sub, access);
    if (mailbox.out_size == 0) co_return no_mailbox(mailbox, transfer);
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};

    Bytes request(static_cast<std::size_t>(mailbox.out_size) - mailbox_header_size);
    const std::size_t used = encode_download_request(request, index, sub, data, transfer.complete());
    std::size_t done = data.size() <= 4 ? data.size() : used - sdo_initiate_size;
    request.resize(used);
    const Result<SdoAnswer> first = co_await ask_sdo(port, mailbox, transfer, std::move(request), SdoKind::download_response);
    if (!first) co_return first.error();

    bool toggle = false;
    const std::size_t room = static_cast<std::size_t>(mailbox.out_size) - mailbox_header_size - sdo_segment_header_size;
    while (done < data.size()) {
        const std::size_t part = std::min(room, data.size() - done);
        Bytes segment(part + sdo_segment_header_size + sdo_segment_minimum);
        const auto piece = std::span<const std::byte>{data}.subspan(done, part);
        const std::size_t size = encode_download_segment_request(segment, toggle, done + part == data.size(), piece);
        segment.resize(size);
        const Result<SdoAnswer> next = co_await ask_sdo(port, mailbox, transfer, std::move(segment), SdoKind::download_segment_response);
        if (!next) co_return next.error();
        if (next->message.toggle != toggle) {
            const Error error = co_await wrong_segment(port, mailbox, transfer, sdo_abort::toggle,
                                                       "a segment was acknowledged twice or skipped (toggle bit)");
            co_return error;
        }
        done += part;
        toggle = !toggle;
    }
    co_return Result<void>{};
}

}  // namespace taktwerk::ecat
