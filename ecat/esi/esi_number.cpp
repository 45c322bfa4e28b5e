#include "ecat/esi/esi_number.hpp"

#include <charconv>

namespace taktwerk::ecat::esi {

namespace {

bool is_hex_prefix(std::string_view text) noexcept {
    return text.size() > 2 && (text[0] == '#' || text[0] == '0') && (text[1] == 'x' || text[1] == 'X');
}

template <class T>
std::optional<T> all_of(std::string_view digits, int base) noexcept {
    T value{};
    const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
    if (digits.empty() || problem != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    return value;
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
    constexpr std::string_view blanks = " \t\r\n";
    const auto first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::optional<std::int64_t> parse_number(std::string_view text) noexcept {
    text = trimmed(text);
    if (is_hex_prefix(text)) {
        if (text[0] == '#' && is_hex_prefix(text.substr(2))) text.remove_prefix(2);  // "#x0x6041" is in files of some
        const auto value = all_of<std::uint64_t>(text.substr(2), 16);
        return value ? std::optional(static_cast<std::int64_t>(*value)) : std::nullopt;
    }
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    if (const auto value = all_of<std::int64_t>(text, 10)) return value;
    const auto large = all_of<std::uint64_t>(text, 10);
    return large ? std::optional(static_cast<std::int64_t>(*large)) : std::nullopt;
}

std::optional<bool> parse_flag(std::string_view text) noexcept {
    text = trimmed(text);
    if (text == "1" || text == "true" || text == "True" || text == "TRUE") return true;
    if (text == "0" || text == "false" || text == "False" || text == "FALSE") return false;
    return std::nullopt;
}

std::optional<std::vector<std::byte>> parse_bytes(std::string_view text) {
    text = trimmed(text);
    if (is_hex_prefix(text)) text.remove_prefix(2);
    std::vector<std::byte> out;
    constexpr unsigned none = 0xFF;
    unsigned high = none;
    for (const char c : text) {
        if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
        const auto digit = all_of<unsigned>(std::string_view(&c, 1), 16);
        if (!digit) return std::nullopt;
        if (high != none) {
            out.push_back(static_cast<std::byte>(high << 4u | *digit));
            high = none;
        } else {
            high = *digit;
        }
    }
    if (high != none) return std::nullopt;
    return out;
}

}  // namespace taktwerk::ecat::esi
