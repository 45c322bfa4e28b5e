#include "hmi_bridge/web/machine_answer.hpp"

#include <charconv>

#include <nlohmann/json.hpp>

#include "hmi_bridge/web/page_message.hpp"

namespace taktwerk::hmi::web {
namespace {

/// {"id":7,"ok":true...}: what the machine writes for everything that is long.
std::optional<NumberedAnswer> read_plain(std::string_view line) {
    constexpr std::string_view head = R"({"id":)", good = R"(,"ok":true)";
    if (!line.starts_with(head) || !line.ends_with('}')) return std::nullopt;
    std::int64_t id = 0;
    const auto* from = line.data() + head.size();
    const auto number = std::from_chars(from, line.data() + line.size(), id);
    if (number.ec != std::errc{}) return std::nullopt;
    const auto rest = line.substr(static_cast<std::size_t>(number.ptr - line.data()));
    if (!rest.starts_with(good) || rest.size() <= good.size() || (rest[good.size()] != ',' && rest[good.size()] != '}'))
        return std::nullopt;
    return NumberedAnswer{id, {true, std::string(rest.substr(1, rest.size() - 2))}};
}

}  // namespace

std::string_view MachineAnswer::value_of(std::string_view key) const {
    const auto head = R"("ok":true,")" + std::string(key) + "\":";
    const std::string_view all = keys;
    return all.starts_with(head) ? all.substr(head.size()) : std::string_view{};
}

std::optional<NumberedAnswer> read_machine_answer(std::string_view line) {
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    if (auto plain = read_plain(line)) return plain;
    bool too_deep = false;  // writing it again goes as deep as it does
    const auto bounded = [&](int depth, nlohmann::ordered_json::parse_event_t, nlohmann::ordered_json&) {
        too_deep = too_deep || depth > MachineAnswer::deepest;
        return !too_deep;
    };
    auto json = nlohmann::ordered_json::parse(line, bounded, false);
    if (too_deep || !json.is_object() || !json.contains("id") || !json.contains("ok") || !json["ok"].is_boolean()) return std::nullopt;
    NumberedAnswer out;
    if (json["id"].is_number_integer()) out.id = json["id"].get<std::int64_t>();
    out.answer.ok = json["ok"].get<bool>();
    json.erase("id");
    const auto text = json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    out.answer.keys = text.substr(1, text.size() - 2);
    return out;
}

MachineAnswer failed_answer(const Error& error) {
    return {false, R"("ok":false,"error":)" + error_json(error).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)};
}

std::int64_t cycle_of(std::string_view state) {
    constexpr std::string_view key = R"("cycle":)";
    const auto at = state.find(key);
    std::int64_t cycle = -1;
    if (at != std::string_view::npos) std::from_chars(state.data() + at + key.size(), state.data() + state.size(), cycle);
    return cycle;
}

}  // namespace taktwerk::hmi::web
