#include "apps/lcm/spy_text.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/terminal/count_text.hpp"
#include "hmi_bridge/lcm_types/message_reader.hpp"
#include "hmi_bridge/lcm_types/shown_message.hpp"
#include "hmi_bridge/socket/json_number.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_hex = 512;  // bytes shown
constexpr double silent_ms = 500;         // heartbeat_v1_t: older than that is stale

const hmi::LcmType* type_of(const hmi::TypeCatalog& catalog, std::span<const std::byte> message) {
    const auto fingerprint = hmi::fingerprint_of(message);
    return fingerprint ? catalog.find(*fingerprint) : nullptr;
}

/// 16 bytes a line, as hexdump has them.
std::string hex_lines(std::span<const std::byte> message) {
    std::string out;
    for (std::size_t at = 0; at < message.size() && at < longest_hex; at += 16) {
        std::string letters;
        out += fmt::format("  {:04x} ", at);
        for (std::size_t i = at; i < std::min(at + 16, message.size()); ++i) {
            const auto byte = std::to_integer<unsigned char>(message[i]);
            out += fmt::format(" {:02x}", byte);
            letters += byte >= 0x20 && byte < 0x7F ? static_cast<char>(byte) : '.';
        }
        out += fmt::format("{:{}}  {}\n", "", 3 * (16 - letters.size()), letters);
    }
    if (message.size() > longest_hex) out += fmt::format("  ... {} bytes in all\n", message.size());
    return out;
}

std::string printable(std::string_view text) {
    std::string out;
    for (const char c : text) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
    return out;
}

}  // namespace

std::string channels_text(const ChannelBook& book, std::int64_t utime, Colours colours) {
    using Side = TextTable::Column::Side;
    TextTable table{
        {{"channel"}, {"type"}, {"Hz", Side::right}, {"bytes", Side::right}, {"messages", Side::right}, {"age ms", Side::right}}};
    for (const auto& row : book.rows(utime)) {
        const double age = std::max(0.0, static_cast<double>(utime - row.last_utime) / 1000);
        const bool known = !row.type.starts_with("0x") && row.type != "none";
        table.add({row.channel, Cell{row.type, known ? Tone::plain : Tone::faint}, fmt::format("{:.1f}", row.rate),
                   std::to_string(row.last_size), std::to_string(row.messages),
                   Cell{fmt::format("{:.0f}", age), age > silent_ms ? Tone::warning : Tone::plain}});
    }
    if (table.empty()) return "no message on any channel\n";
    auto out = table.text(colours);
    for (const auto& machine : book.machines()) {
        out += fmt::format("{}: {} of its state, {} lost on the way to here{}\n",
                           printable(machine.prefix.substr(9, machine.prefix.size() - 10)), count_text(machine.messages, "message"),
                           machine.lost,
                           machine.restarts > 0
                               ? fmt::format(", {} of its count: it was restarted, or two publish", count_text(machine.restarts, "restart"))
                               : "");
    }
    if (book.unlisted() > 0)
        out += fmt::format("{} on further channels, beyond the {} that are listed\n", count_text(book.unlisted(), "message"),
                           ChannelBook::most_channels);
    return out;
}

std::string channels_json(const ChannelBook& book, std::int64_t utime) {
    Json out{{"channels", Json::array()}, {"machines", Json::array()}};
    for (const auto& row : book.rows(utime))
        out["channels"].push_back(Json{{"channel", row.channel},
                                       {"type", row.type},
                                       {"rate_hz", row.rate},
                                       {"bytes", row.last_size},
                                       {"messages", row.messages},
                                       {"age_ms", static_cast<double>(utime - row.last_utime) / 1000}});
    for (const auto& machine : book.machines())
        out["machines"].push_back(
            Json{{"channels", machine.prefix}, {"messages", machine.messages}, {"lost", machine.lost}, {"restarts", machine.restarts}});
    return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string message_text(const hmi::TypeCatalog& catalog, std::string_view channel, std::span<const std::byte> message) {
    const auto* type = type_of(catalog, message);
    const auto name = printable(channel);
    if (type == nullptr) {
        const auto fingerprint = hmi::fingerprint_of(message);
        return fmt::format("{}: {} bytes, {}\n{}", name, message.size(),
                           fingerprint ? fmt::format("of the unknown type 0x{:016x}", *fingerprint) : "too few for a type",
                           hex_lines(message));
    }
    const auto read = hmi::read_message(catalog, *type, message);
    if (!read)
        return fmt::format("{}: {} bytes, a bad {}: {}\n{}", name, message.size(), type->name, read.error().what, hex_lines(message));
    auto out = fmt::format("{}: {}\n", name, type->name);
    for (const auto& line : hmi::shown_lines(catalog, *type, *read)) out += "  " + line + "\n";
    return out;
}

std::string message_json(const hmi::TypeCatalog& catalog, std::string_view channel, std::span<const std::byte> message,
                         std::int64_t utime) {
    const auto* type = type_of(catalog, message);
    Json out{{"channel", std::string(channel)},
             {"type", type != nullptr ? Json(type->name) : Json()},
             {"utime", utime},
             {"bytes", message.size()}};
    auto read = type != nullptr ? hmi::read_message(catalog, *type, message) : Result<Json>(Error{"", "", "the type is not known", ""});
    if (read) {
        hmi::spell_out_numbers(*read);
        out["message"] = std::move(*read);
    } else {
        out["problem"] = read.error().what;
        std::string hex;
        for (const auto byte : message.first(std::min(message.size(), longest_hex)))
            hex += fmt::format("{:02x}", std::to_integer<int>(byte));
        out["hex"] = hex;
    }
    return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string part_of(const hmi::TypeCatalog& catalog, std::span<const std::byte> message) {
    const auto* type = type_of(catalog, message);
    if (type == nullptr) return {};
    const auto read = hmi::read_message(catalog, *type, message);
    if (!read) return {};
    for (const char* key : {"axis_index", "first"})
        if (const auto found = read->find(key); found != read->end() && found->is_number_integer())
            return fmt::format("{:08}", found->get<std::int64_t>());
    return {};
}

}  // namespace taktwerk::apps
