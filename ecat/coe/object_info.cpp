#include "ecat/coe/object_info.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ecat/wire/sdo_info.hpp"

namespace taktwerk::ecat {

namespace {

using Bytes = std::vector<std::byte>;

/// More fragments than any dictionary needs (65,536 indexes in the smallest mailbox): the slave is not believed.
constexpr std::size_t most_bytes = 2 * 65'536 + 2;

Error no_info(const MailboxEndpoint& mailbox, const std::string& about) {
    return Error{"sdo.no_info", mailbox.subject, fmt::format("{}: the slave does not have the SDO information service", about),
                 "use the objects of its profile or manual: `sdo read` works without it"};
}

Error wrong_answer(const MailboxEndpoint& mailbox, const std::string& about, const char* what) {
    return Error{"sdo.protocol", mailbox.subject, fmt::format("{}: {}", about, what),
                 "try again; if it stays, the slave's firmware is defective"};
}

/// Answers start with what was asked for: list type; index; index and sub-index.
bool repeats_question(std::span<const std::byte> answer, std::span<const std::byte> question) {
    question = question.subspan(sdo_info_header_size);
    question = question.first(std::min<std::size_t>(question.size(), 3));
    return answer.size() >= question.size() && std::equal(question.begin(), question.end(), answer.begin());
}

/// The data of all fragments of the answer.
Script<Result<Bytes>> ask_info(DatagramPort& port, MailboxEndpoint& mailbox, const std::string& about, Bytes payload,
                               SdoInfoOpcode wanted) {
    if (mailbox.in_size == 0)
        co_return Error{"sdo.no_mailbox", mailbox.subject, fmt::format("{} is not possible: the slave has no CoE mailbox", about), ""};
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};

    MailboxRequest request;
    request.about = about;
    request.payload = std::move(payload);
    Bytes data;
    request.answered_by = [&, wanted](std::span<const std::byte> bytes) {
        if (const auto info = parse_sdo_info(bytes)) {
            if (info->opcode == SdoInfoOpcode::error) return true;
            return info->opcode == wanted && (!data.empty() || repeats_question(info->data, request.payload));
        }
        const auto sdo = parse_sdo(bytes);  // firmware without the service may answer as to an unknown SDO command
        return sdo && sdo->kind == SdoKind::abort;
    };
    Result<Bytes> answer = co_await ask(port, mailbox, request);
    for (;;) {
        if (!answer) {
            const auto refusal = mailbox.last_refusal;
            const bool unknown =
                refusal == MailboxErrorDetail::unsupported_protocol || refusal == MailboxErrorDetail::service_not_supported;
            if (unknown) co_return no_info(mailbox, about);
            co_return answer.error();
        }
        const auto info = parse_sdo_info(*answer);
        if (!info) co_return no_info(mailbox, about);
        if (info->opcode == SdoInfoOpcode::error) {
            const std::uint32_t code = parse_info_error(info->data).value_or(sdo_abort::general);
            if (code == sdo_abort::unknown_command || code == sdo_abort::unsupported_access) co_return no_info(mailbox, about);
            co_return abort_error(mailbox, about, code);
        }
        data.insert(data.end(), info->data.begin(), info->data.end());
        if (!info->incomplete) co_return data;
        if (data.size() > most_bytes) co_return wrong_answer(mailbox, about, "the answer does not end");
        answer = co_await await_more(port, mailbox, request);
    }
}

}  // namespace

Script<Result<std::vector<std::uint16_t>>> list_objects(DatagramPort& port, MailboxEndpoint& mailbox, ObjectList list) {
    const std::string about = "reading the object list";
    Bytes request(sdo_initiate_size);
    request.resize(encode_list_request(request, list));
    const Result<Bytes> data = co_await ask_info(port, mailbox, about, std::move(request), SdoInfoOpcode::list_response);
    if (!data) co_return data.error();
    const auto view = parse_object_list(*data);
    if (!view || view->type() != static_cast<std::uint16_t>(list))
        co_return wrong_answer(mailbox, about, "the answer is not the list that was asked for");
    std::vector<std::uint16_t> indexes(view->size());
    for (std::size_t n = 0; n < indexes.size(); ++n) indexes[n] = (*view)[n];
    co_return indexes;
}

Script<Result<ObjectInfo>> describe_object(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index) {
    const std::string about = fmt::format("asking for the description of {:04X}h", index);
    Bytes request(sdo_initiate_size);
    request.resize(encode_object_request(request, index));
    const Result<Bytes> data = co_await ask_info(port, mailbox, about, std::move(request), SdoInfoOpcode::object_response);
    if (!data) co_return data.error();
    const auto view = parse_object_description(*data);
    if (!view || view->index != index) co_return wrong_answer(mailbox, about, "the answer describes something else");
    ObjectInfo object;
    object.index = view->index;
    object.data_type = view->data_type;
    object.max_sub = view->max_sub;
    object.code = static_cast<ObjectCode>(view->code);
    object.name = std::string{view->name};
    co_return object;
}

Script<Result<EntryInfo>> describe_entry(DatagramPort& port, MailboxEndpoint& mailbox, std::uint16_t index, std::uint8_t sub) {
    const std::string about = "asking for the description of " + object_text(index, sub);
    Bytes request(sdo_initiate_size);
    request.resize(encode_entry_request(request, index, sub, 0));
    const Result<Bytes> data = co_await ask_info(port, mailbox, about, std::move(request), SdoInfoOpcode::entry_response);
    if (!data) co_return data.error();
    const auto view = parse_entry_description(*data);
    if (!view || view->index != index || view->sub != sub) co_return wrong_answer(mailbox, about, "the answer describes something else");
    EntryInfo entry;
    entry.index = view->index;
    entry.sub = view->sub;
    entry.data_type = view->data_type;
    entry.bits = view->bits;
    entry.access = view->access;
    entry.name = std::string{view->name};
    co_return entry;
}

}  // namespace taktwerk::ecat
