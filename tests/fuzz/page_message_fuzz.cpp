// Any bytes as what a page says: a message whose command stands in the table, or an error of ours with a sentence; never what only the server may say.
#include <cstdlib>

#include "hmi_bridge/web/page_message.hpp"

using namespace taktwerk::hmi::web;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto read = read_page_message({reinterpret_cast<const char*>(data), size});
    if (const auto* unread = std::get_if<UnreadMessage>(&read)) {
        if (!unread->error.code.starts_with("web.") || unread->error.what.empty() || unread->error.remedy.empty()) std::abort();
        return 0;
    }
    const auto& message = std::get<PageMessage>(read);
    if (message.kind != PageMessage::Kind::command) return 0;
    if (message.rule == nullptr || message.id < 1 || message.request.value("cmd", "") != message.rule->command) std::abort();
    for (const char* key : {"type", "machine", "id", "sent_ms", "utime", "valid_ms", "commissioning"})
        if (message.request.contains(key)) std::abort();
    if (message.may_move() && !message.rule->moves) std::abort();
    return 0;
}
