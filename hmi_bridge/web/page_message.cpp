#include "hmi_bridge/web/page_message.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "hmi_bridge/socket/json_fields.hpp"
#include "hmi_bridge/web/json_text.hpp"

namespace taktwerk::hmi::web {
namespace {

using Json = nlohmann::ordered_json;

Error web_error(std::string code, std::string what, std::string remedy) {
    return Error{"web." + std::move(code), "", std::move(what), std::move(remedy)};
}

std::optional<std::int64_t> whole_number(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number_integer()) return std::nullopt;
    if (found->is_number_unsigned() && found->get<std::uint64_t>() > static_cast<std::uint64_t>(INT64_MAX)) return std::nullopt;
    return found->get<std::int64_t>();
}

/// Empty when it is not there; an error when it is no text.
Result<std::string> text_at(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) return std::string{};
    if (!found->is_string()) return web_error("key", fmt::format("'{}' is not a text", key), "Reload the page.");
    return found->get<std::string>();
}

/// The server's own: a page says neither when its message was sent by this host's clock nor in whose name.
constexpr std::array<const char*, 3> own_keys{"utime", "valid_ms", "commissioning"};

std::variant<PageMessage, Error> read_object(const Json& object) {
    const auto type = text_at(object, "type"), machine = text_at(object, "machine"), cmd = text_at(object, "cmd");
    for (const auto* text : {&type, &machine, &cmd})
        if (!*text) return text->error();
    PageMessage message;
    message.machine = *machine;
    if (*type == "watch") {
        message.kind = PageMessage::Kind::watch;
        return message;
    }
    if (const auto sent = object.find("sent_ms"); sent != object.end()) {
        if (!sent->is_number() || !std::isfinite(sent->get<double>()))
            return web_error("key", "'sent_ms' is not a number", "Reload the page.");
        message.sent_ms = sent->get<double>();
    }
    if (*type == "clock") {
        message.kind = PageMessage::Kind::clock;
        if (!message.sent_ms) return web_error("key", "a clock says its time as 'sent_ms'", "Reload the page.");
        return message;
    }
    if (*type != "command")
        return web_error("type", fmt::format("'{}' is no type of message", shown(*type)), "Use watch, clock or command; reload the page.");
    const auto id = whole_number(object, "id");
    if (!id || *id < 1) return web_error("id", "a command needs a whole number as 'id', from 1 on", "Reload the page.");
    message.id = *id;
    message.rule = find_rule(*cmd);
    if (message.rule == nullptr)
        return web_error("unknown_command", fmt::format("'{}' is no command that a page gives", shown(*cmd)), "Reload the page.");
    for (const char* key : own_keys)
        if (object.contains(key)) return web_error("key", fmt::format("'{}' is the server's to say", key), "Leave it out.");
    message.request = object;
    for (const char* key : {"type", "machine", "id", "sent_ms"}) message.request.erase(key);
    return message;
}

}  // namespace

bool PageMessage::may_move() const {
    if (rule == nullptr || !rule->moves) return false;
    const char* key = rule->command == "jog" || rule->command == "group_jog" ? "velocity"
                      : rule->command == "set_value"                         ? "value"
                                                                             : nullptr;
    if (key == nullptr) return true;
    const auto given = request.find(key);
    return given == request.end() || !given->is_number() || given->get<double>() != 0;
}

bool PageMessage::is_held() const { return is_jog() || (rule != nullptr && rule->command == "set_value" && request.contains("press")); }

bool PageMessage::is_renewal() const {
    if (!is_held() || !may_move()) return false;
    const auto press = request.find("press");
    return press == request.end() || *press == false;
}

nlohmann::ordered_json PageMessage::release() const {
    const bool of_a_group = rule->command == "group_jog";
    const char* key = of_a_group ? "group" : "axis";
    const auto given = request.find(key);
    if (given == request.end() || !given->is_string()) return {};
    return {{"cmd", of_a_group ? "group_jog" : "jog"}, {key, *given}, {"velocity", 0}};
}

std::string PageMessage::variable() const {
    const auto given = request.find("variable");
    return given != request.end() && given->is_string() ? given->get<std::string>() : std::string{};
}

std::variant<PageMessage, UnreadMessage> read_page_message(std::string_view text) {
    const auto unread = [](Error error) { return UnreadMessage{std::nullopt, std::move(error)}; };
    if (text.size() > PageMessage::longest) return unread(web_error("too_long", "a message is at most 64 KiB", "Reload the page."));
    const auto parsed = read_json(text, PageMessage::deepest);
    if (!parsed) return unread(parsed.error());
    if (!parsed->is_object()) return unread(web_error("not_an_object", "the message is no JSON object", "Reload the page."));
    auto read = read_object(*parsed);
    if (auto* error = std::get_if<Error>(&read)) return UnreadMessage{whole_number(*parsed, "id"), std::move(*error)};
    return std::get<PageMessage>(std::move(read));
}

Json error_json(const Error& error) {
    return Json{{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}};
}

std::string refusal(std::int64_t id, const Error& error) {
    return Json{{"type", "answer"}, {"id", id}, {"ok", false}, {"error", error_json(error)}}.dump(-1, ' ', false,
                                                                                                  Json::error_handler_t::replace);
}

}  // namespace taktwerk::hmi::web
