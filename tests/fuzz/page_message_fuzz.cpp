// Any bytes as what one page says, a message a line: a message whose command stands in the table, or an error of ours with a sentence; never what only
// the server may say. What goes on to the machine is one line, which its door takes for the command that was judged and no other.
#include <algorithm>
#include <cstdlib>

#include "hmi_bridge/socket/urgent_line.hpp"
#include "hmi_bridge/web/audit_line.hpp"
#include "hmi_bridge/web/message_age.hpp"
#include "hmi_bridge/web/page_message.hpp"
#include "tests/fuzz/message_count.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi::web;

namespace {

using Json = nlohmann::ordered_json;

void look_at_refusal(const UnreadMessage& unread) {
    const auto& error = unread.error;
    if (!error.code.starts_with("web.") || error.what.empty() || error.remedy.empty()) std::abort();
    if (!unread.id) return;
    const auto text = refusal(*unread.id, error);
    if (text.find('\n') != std::string::npos || Json::parse(text)["id"] != *unread.id) std::abort();
}

/// As the server hands it on, with its own time and number.
void look_at_forwarded(const PageMessage& message) {
    static const hmi::test::FakeMachine machine;
    auto request = message.request;
    request["utime"] = 1;
    request["id"] = message.id;
    const auto line = request.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (line.find('\n') != std::string::npos || !Json::accept(line)) std::abort();
    const auto audited = audit_text(bounded(message.request));
    if (std::ranges::any_of(audited, [](unsigned char c) { return c < 0x20 || c == 0x7f; })) std::abort();
    if (line.size() < longest_in_audit && Json::parse(audited) != message.request) std::abort();
    const auto urgent = hmi::urgent_line(line, machine.layout());
    using Kind = hmi::UrgentLine::Kind;
    const auto& command = message.rule->command;
    if (command == "stop" && (!urgent || urgent->kind != Kind::stop)) std::abort();
    if (!urgent) return;
    if (urgent->kind == Kind::shutdown && command != "shutdown") std::abort();
    if ((urgent->kind == Kind::jog_hold || urgent->kind == Kind::jog_release) && !message.is_jog()) std::abort();
    if (urgent->kind == Kind::jog_hold && !message.may_move()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    MessageAge age;
    Instant now{std::chrono::seconds{1}};
    static fuzz::MessageCount count;
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    for (int lines = 0; lines < 8 && !rest.empty(); ++lines) {
        const auto end = std::min(rest.find('\n'), rest.size());
        count.one();
        const auto read = read_page_message(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        now += std::chrono::milliseconds{50};
        if (const auto* unread = std::get_if<UnreadMessage>(&read)) {
            look_at_refusal(*unread);
            continue;
        }
        const auto& message = std::get<PageMessage>(read);
        if (message.kind != PageMessage::Kind::command) continue;
        if (message.rule == nullptr || message.id < 1 || message.request.value("cmd", "") != message.rule->command) std::abort();
        for (const char* key : {"type", "machine", "id", "sent_ms", "utime", "valid_ms", "commissioning"})
            if (message.request.contains(key)) std::abort();
        if (message.may_move() && !message.rule->moves) std::abort();
        if (message.is_renewal() && (!message.is_held() || !message.may_move())) std::abort();
        if (message.sent_ms)
            if (const auto waited = age.of(*message.sent_ms, now); waited < Duration{} || waited > std::chrono::seconds{1'000'000})
                std::abort();
        look_at_forwarded(message);
    }
    return 0;
}
