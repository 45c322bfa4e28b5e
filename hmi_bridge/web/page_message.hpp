#pragma once
// What a page may say, read from one text frame (README.md). Whatever it is, the answer is a message or an error; nothing throws. Not real-time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "hmi_bridge/web/roles.hpp"

namespace taktwerk::hmi::web {

struct PageMessage {
    static constexpr std::size_t longest = 64 * 1024;  ///< bytes
    static constexpr int deepest = 8;                  ///< levels of objects and arrays

    enum class Kind { watch, clock, command };
    Kind kind = Kind::command;
    std::string machine;  ///< empty: the watched one
    std::int64_t id = 0;
    const CommandRule* rule = nullptr;  ///< of a command
    std::optional<double> sent_ms;      ///< finite; of a clock always there
    nlohmann::ordered_json request;     ///< of a command: the socket's own, without id and time

    /// A renewal, a press, or (false) a jog let go and everything that moves nothing.
    [[nodiscard]] bool may_move() const;
    [[nodiscard]] bool is_jog() const {
        return rule != nullptr && (rule->command == "jog" || rule->command == "group_jog" || rule->command == "measure");
    }
    /// A jog, a measurement, or a button by `set_value` with `press`: true, and false with each renewal.
    [[nodiscard]] bool is_held() const;
    [[nodiscard]] bool is_renewal() const;
    /// Of a jog or a measurement: the command that lets go of it, without its time; null where it names neither axis nor group.
    [[nodiscard]] nlohmann::ordered_json release() const;
    [[nodiscard]] std::string variable() const;  ///< of a set_value; empty where it is no text
};

struct UnreadMessage {
    std::optional<std::int64_t> id;  ///< where one stood in it
    Error error;
};

/// Errors: web.too_long, web.too_deep, web.not_json, web.duplicate_key, web.not_an_object, web.type, web.id, web.key, web.unknown_command.
[[nodiscard]] std::variant<PageMessage, UnreadMessage> read_page_message(std::string_view text);

[[nodiscard]] nlohmann::ordered_json error_json(const Error& error);
/// {"type":"answer","id":...,"ok":false,"error":{...}}
[[nodiscard]] std::string refusal(std::int64_t id, const Error& error);

}  // namespace taktwerk::hmi::web
