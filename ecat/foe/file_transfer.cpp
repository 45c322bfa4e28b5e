#include "ecat/foe/file_transfer.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>
#include <tuple>
#include <utility>

#include "ecat/foe/file_reading.hpp"
#include "ecat/foe/file_writing.hpp"
#include "ecat/wire/foe_error.hpp"

namespace taktwerk::ecat {

namespace {

using Bytes = std::vector<std::byte>;

/// The slave's own words, as one can print them.
std::string own_words(const std::string& words) {
    constexpr std::size_t longest = 120;
    std::string text;
    for (const char c : words.substr(0, longest)) text += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    return text;
}

Error refused_file(const MailboxEndpoint& mailbox, const std::string& about, const FoeStep& step) {
    const FoeErrorInfo& info = foe_error_info(step.code);
    const std::string own = own_words(step.words);
    return Error{"foe.refused", mailbox.subject,
                 fmt::format("{} was refused: error {:04X}h {}{}", about, step.code, info.text, own.empty() ? "" : ", '" + own + "'"),
                 std::string{info.remedy}};
}

Error no_file_mailbox(const MailboxEndpoint& mailbox, const std::string& about) {
    return Error{"foe.no_mailbox", mailbox.subject,
                 fmt::format("{}: its mailboxes of {} and {} bytes hold no packet", about, mailbox.out_size, mailbox.in_size),
                 "files need a mailbox: check what its EEPROM says (taktwerk bus eeprom read)"};
}

/// A mailbox answers to anything; these are the shortest that carry a file.
bool carries_files(const MailboxEndpoint& mailbox) { return foe_room(mailbox.out_size) > 0 && foe_room(mailbox.in_size) > 0; }

Bytes encoded(const FoeMessage& message) {
    Bytes bytes(foe_header_size + message.rest.size());
    (void)encode_foe(bytes, message);
    return bytes;
}

MailboxRequest foe_request(const std::string& about, const FoeMessage& message, const FoePatience& patience) {
    MailboxRequest request;
    request.about = about;
    request.payload = encoded(message);
    request.answered_by = [](std::span<const std::byte>) { return true; };  // one conversation at a time: what it means the step says
    request.type = MailboxType::foe;
    request.patience = patience.answer;
    return request;
}

Script<Result<void>> send_only(DatagramPort& port, MailboxEndpoint& mailbox, std::string about, Bytes payload) {
    MailboxRequest request;
    request.about = std::move(about);
    request.payload = std::move(payload);
    request.type = MailboxType::foe;
    co_return co_await tell(port, mailbox, request);
}

/// Tells the slave that it is over, for a reason of ours.
Script<void> give_up(DatagramPort& port, MailboxEndpoint& mailbox, const std::string& about, std::uint32_t code) {
    const FoeMessage message{FoeOp::error, code, {}};
    Bytes payload = encoded(message);
    const Result<void> told = co_await send_only(port, mailbox, about, std::move(payload));
    (void)told;  // the transfer has failed either way
}

/// How long a slave has been saying BUSY without getting further.
class BusyWatch {
public:
    [[nodiscard]] bool too_long(const FoeStep& step, Instant now, const FoePatience& patience) {
        auto seen = std::make_tuple(step.done, step.entire, step.words);
        if (!since_ || seen != seen_) {
            since_ = now;
            seen_ = std::move(seen);
        }
        return now - *since_ >= patience.busy;
    }
    void over() noexcept { since_.reset(); }

private:
    std::optional<Instant> since_;
    std::tuple<std::uint16_t, std::uint16_t, std::string> seen_;
};

template <class Conversation>
void report(const FoeSettings& settings, const Conversation& conversation, const FoeStep& step) {
    if (!settings.progress) return;
    FoeProgress progress;
    if constexpr (requires { conversation.acknowledged(); }) {
        progress.bytes = conversation.acknowledged();
        progress.of = conversation.size();
    } else {
        progress.bytes = conversation.file().size();
    }
    progress.busy = step.kind == FoeStep::Kind::again;
    progress.done = step.done;
    progress.entire = step.entire;
    progress.words = own_words(step.words);
    settings.progress(progress);
}

/// Asks and answers until the conversation is at its end.
template <class Conversation>
Script<Result<void>> converse(DatagramPort& port, MailboxEndpoint& mailbox, Conversation& conversation, std::string about,
                              const FoeSettings& settings) {
    BusyWatch busy;
    for (;;) {
        const MailboxRequest request = foe_request(about, conversation.request(), settings.patience);
        Result<Bytes> bytes = co_await ask(port, mailbox, request);
        if (!bytes) co_return bytes.error();
        FoeStep step;
        for (;;) {
            const auto message = parse_foe(*bytes);
            step = message ? conversation.answer(*message)
                           : FoeStep{.kind = FoeStep::Kind::broken, .code = foe_error::illegal, .words = "the answer is no FoE message"};
            if (step.kind != FoeStep::Kind::skip) break;
            bytes = co_await await_more(port, mailbox, request);
            if (!bytes) co_return bytes.error();
        }
        report(settings, conversation, step);
        switch (step.kind) {
            case FoeStep::Kind::next:
            case FoeStep::Kind::skip: busy.over(); break;
            case FoeStep::Kind::last: {
                Bytes payload = encoded(conversation.request());
                co_return co_await send_only(port, mailbox, about, std::move(payload));
            }
            case FoeStep::Kind::done: co_return Result<void>{};
            case FoeStep::Kind::refused: co_return refused_file(mailbox, about, step);
            case FoeStep::Kind::broken:
                co_await give_up(port, mailbox, about, step.code);
                co_return Error{"foe.protocol", mailbox.subject, fmt::format("{}: {}", about, step.words),
                                "try again; if it stays, the slave's firmware is defective"};
            case FoeStep::Kind::again: {
                const Instant now = co_await time();
                if (busy.too_long(step, now, settings.patience)) {
                    co_await give_up(port, mailbox, about, foe_error::not_defined);
                    co_return Error{"foe.busy", mailbox.subject,
                                    fmt::format("{}: the slave has said that it is busy for {} s, and gets no further", about,
                                                settings.patience.busy / std::chrono::seconds{1}),
                                    "power-cycle it and try again"};
                }
                co_await pause(settings.patience.busy_pause);
                break;
            }
        }
    }
}

Result<void> name_fits(const MailboxEndpoint& mailbox, const std::string& about, const FoeFile& file) {
    const std::size_t room = foe_room(mailbox.out_size);
    if (!file.name.empty() && file.name.size() <= room) return {};
    return Error{"foe.name", mailbox.subject,
                 file.name.empty()
                     ? fmt::format("{}: a file has a name", about)
                     : fmt::format("{}: the name has {} characters, its mailbox has room for {}", about, file.name.size(), room),
                 "give the name that the slave's maker says"};
}

}  // namespace

Script<Result<std::vector<std::byte>>> read_file(DatagramPort& port, MailboxEndpoint& mailbox, FoeFile file, FoeSettings settings) {
    const std::string about = fmt::format("reading file '{}'", own_words(file.name));
    if (!carries_files(mailbox)) co_return no_file_mailbox(mailbox, about);
    const Result<void> fits = name_fits(mailbox, about, file);
    if (!fits) co_return fits.error();
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};
    FileReading reading{std::move(file), foe_room(mailbox.in_size), settings.largest};
    const Result<void> ended = co_await converse(port, mailbox, reading, about, settings);
    if (!ended) co_return ended.error();
    co_return reading.take();
}

Script<Result<FoeWritten>> write_file(DatagramPort& port, MailboxEndpoint& mailbox, FoeFile file, std::vector<std::byte> content,
                                      FoeSettings settings) {
    const std::string about = fmt::format("writing file '{}'", own_words(file.name));
    if (!carries_files(mailbox)) co_return no_file_mailbox(mailbox, about);
    const Result<void> fits = name_fits(mailbox, about, file);
    if (!fits) co_return fits.error();
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};
    FileWriting writing{std::move(file), content, foe_room(mailbox.out_size)};
    const Result<void> ended = co_await converse(port, mailbox, writing, about, settings);
    FoeWritten out;
    out.acknowledged = writing.acknowledged();
    // Without a word of refusal the request may have reached the slave, and its answer nobody.
    const bool turned_down = !ended && (ended.error().code == "foe.refused" || mailbox.last_refusal != MailboxErrorDetail::none);
    out.begun = writing.begun() || !turned_down;
    if (!ended) out.failure = ended.error();
    co_return out;
}

Script<Result<void>> abandon_file(DatagramPort& port, MailboxEndpoint& mailbox) {
    co_await mailbox.lock.acquire();
    const ScriptLockGuard guard{mailbox.lock};
    const std::string about = "ending a file transfer";
    const FoeMessage message{FoeOp::error, foe_error::not_defined, foe_text("ended by the master")};
    Bytes payload = encoded(message);
    co_return co_await send_only(port, mailbox, about, std::move(payload));
}

std::uint32_t foe_code(const Error& error) noexcept {
    if (error.code != "foe.refused") return 0;
    constexpr std::string_view before = "was refused: error ";
    const auto at = error.what.rfind(before);  // the file may be called anything
    return at == std::string::npos ? 0 : static_cast<std::uint32_t>(std::strtoul(error.what.c_str() + at + before.size(), nullptr, 16));
}

}  // namespace taktwerk::ecat
