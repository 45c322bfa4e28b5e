#include "ecat/diagnosis/object_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

namespace taktwerk::ecat {

namespace {

struct TypeWord {
    std::string_view word, standard;  ///< ours, and IEC's
    std::uint16_t number;
    std::uint8_t bits;  ///< 0: any length
    bool sign;
};
constexpr std::array all_types{TypeWord{"BOOL", "BOOLEAN", coe_type::boolean, 1, false},
                               TypeWord{"I8", "SINT", coe_type::integer8, 8, true},
                               TypeWord{"I16", "INT", coe_type::integer16, 16, true},
                               TypeWord{"I24", "INT24", coe_type::integer24, 24, true},
                               TypeWord{"I32", "DINT", coe_type::integer32, 32, true},
                               TypeWord{"I64", "LINT", coe_type::integer64, 64, true},
                               TypeWord{"U8", "USINT", coe_type::unsigned8, 8, false},
                               TypeWord{"U16", "UINT", coe_type::unsigned16, 16, false},
                               TypeWord{"U24", "UINT24", coe_type::unsigned24, 24, false},
                               TypeWord{"U32", "UDINT", coe_type::unsigned32, 32, false},
                               TypeWord{"U64", "ULINT", coe_type::unsigned64, 64, false},
                               TypeWord{"REAL32", "REAL", coe_type::real32, 32, true},
                               TypeWord{"REAL64", "LREAL", coe_type::real64, 64, true},
                               TypeWord{"STRING", "VISIBLE_STRING", coe_type::visible_string, 0, false},
                               TypeWord{"BYTES", "OCTET_STRING", coe_type::octet_string, 0, false}};

const TypeWord* find(std::uint16_t type) noexcept {
    const auto it = std::find_if(all_types.begin(), all_types.end(), [&](const TypeWord& t) { return t.number == type; });
    return it == all_types.end() ? nullptr : &*it;
}

bool same_word(std::string_view a, std::string_view b) noexcept {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::toupper(static_cast<unsigned char>(x)) == std::toupper(static_cast<unsigned char>(y));
    });
}

bool is_bits(std::uint16_t type) noexcept { return type >= coe_type::bit1 && type <= coe_type::bit8; }

std::uint64_t number_of(std::span<const std::byte> value) noexcept {
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(8, value.size()); ++i) number |= static_cast<std::uint64_t>(value[i]) << (8 * i);
    return number;
}

std::int64_t sign_extended(std::uint64_t value, unsigned bits) noexcept {
    const unsigned spare = 64 - bits;
    return static_cast<std::int64_t>(value << spare) >> spare;
}

std::string hex_bytes(std::span<const std::byte> value) {
    constexpr std::size_t shown = 32;
    std::string text;
    for (const std::byte b : value.first(std::min(shown, value.size())))
        text += fmt::format("{}{:02X}", text.empty() ? "" : " ", static_cast<unsigned>(b));
    if (value.size() > shown) text += fmt::format(" ... ({} bytes)", value.size());
    return text.empty() ? std::string{"(empty)"} : text;
}

std::string quoted(std::span<const std::byte> value) {
    std::string text = "'";
    for (const std::byte b : value) {
        const auto c = static_cast<unsigned char>(b);
        if (c == 0) break;
        if (c < 0x20 || c == 0x7F) text += fmt::format("\\x{:02X}", static_cast<unsigned>(c));
        else text += static_cast<char>(c);
    }
    return text + "'";
}

std::string unsigned_text(std::uint64_t value, std::size_t digits) {
    return value < 10 ? fmt::format("{}", value) : fmt::format("{} ({:0{}X}h)", value, value, digits);
}

Error bad(std::string_view text, const std::string& why) {
    return Error{"sdo.value", std::string{text}, why, "write a number as 12, -5, 1234h or 0x1234, or choose another --type"};
}

/// Sign and magnitude of "12", "-5", "1234h", "0x1234".
bool read_integer(std::string_view text, bool& negative, std::uint64_t& magnitude) {
    negative = !text.empty() && text.front() == '-';
    if (negative || (!text.empty() && text.front() == '+')) text.remove_prefix(1);
    int base = 10;
    if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) {
        base = 16;
        text.remove_prefix(2);
    } else if (text.size() > 1 && (text.back() == 'h' || text.back() == 'H')) {
        base = 16;
        text.remove_suffix(1);
    }
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), magnitude, base);
    return problem == std::errc{} && end == text.data() + text.size() && !text.empty();
}

std::vector<std::byte> bytes_of(std::uint64_t value, std::size_t size) {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>((value >> (8 * i)) & 0xFFu);
    return bytes;
}

Result<std::vector<std::byte>> parse_real(std::string_view text, bool wide) {
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || end != text.data() + text.size()) return bad(text, "is not a number");
    if (wide) return bytes_of(std::bit_cast<std::uint64_t>(value), 8);
    return bytes_of(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
}

/// "0A 1B" or "0A1B".
Result<std::vector<std::byte>> parse_bytes(std::string_view text) {
    std::vector<std::byte> bytes;
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == ' ') {
            ++at;
            continue;
        }
        unsigned value = 0;
        const auto pair = text.substr(at, 2);
        const auto [end, problem] = std::from_chars(pair.data(), pair.data() + pair.size(), value, 16);
        if (problem != std::errc{} || end != pair.data() + 2) return bad(text, "is not a row of hexadecimal bytes such as 0A1B2C");
        bytes.push_back(static_cast<std::byte>(value));
        at += 2;
    }
    return bytes;
}

}  // namespace

std::string type_name(std::uint16_t type) {
    if (const auto* known = find(type)) return std::string{known->word};
    if (is_bits(type)) return fmt::format("BIT{}", type - coe_type::bit1 + 1);
    if (type == coe_type::unknown) return "-";
    return fmt::format("{:04X}h", type);
}

std::optional<std::uint16_t> type_number(std::string_view word) {
    for (const auto& type : all_types)
        if (same_word(word, type.word) || same_word(word, type.standard)) return type.number;
    return std::nullopt;
}

std::string known_types() {
    std::string text;
    for (const auto& type : all_types) text += (text.empty() ? "" : ", ") + std::string{type.word};
    return text;
}

std::string value_text(std::uint16_t type, std::span<const std::byte> value) {
    const auto* known = find(type);
    if (known != nullptr && known->bits != 0 && value.size() == (known->bits + 7u) / 8u) {
        const std::uint64_t number = number_of(value);
        if (type == coe_type::boolean) return (number & 1u) != 0 ? "TRUE" : "FALSE";
        if (type == coe_type::real32) return fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(number)));
        if (type == coe_type::real64) return fmt::format("{}", std::bit_cast<double>(number));
        return known->sign ? fmt::format("{}", sign_extended(number, known->bits)) : unsigned_text(number, known->bits / 4u);
    }
    if (type == coe_type::visible_string) return quoted(value);
    if (is_bits(type) && value.size() == 1) return fmt::format("{}", number_of(value));
    const bool simple = known == nullptr && !value.empty() && value.size() <= 8;
    return simple ? unsigned_text(number_of(value), 2 * value.size()) : hex_bytes(value);
}

Result<std::vector<std::byte>> parse_value(std::uint16_t type, std::string_view text) {
    if (type == coe_type::visible_string) {
        std::vector<std::byte> bytes;
        for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
        return bytes;
    }
    if (type == coe_type::octet_string) return parse_bytes(text);
    if (type == coe_type::real32 || type == coe_type::real64) return parse_real(text, type == coe_type::real64);
    if (type == coe_type::boolean && (same_word(text, "true") || same_word(text, "false"))) return bytes_of(same_word(text, "true"), 1);
    const auto* known = find(type);
    const unsigned bits = is_bits(type) ? static_cast<unsigned>(type - coe_type::bit1 + 1) : known != nullptr ? known->bits : 0u;
    if (bits == 0) return bad(text, fmt::format("a value of type {} cannot be written from the command line", type_name(type)));
    bool negative = false;
    std::uint64_t magnitude = 0;
    if (!read_integer(text, negative, magnitude)) return bad(text, "is not a whole number");
    const bool sign = known != nullptr && known->sign;
    const std::uint64_t top = bits == 64 ? std::numeric_limits<std::uint64_t>::max() : (std::uint64_t{1} << bits) - 1;
    // Hexadecimal is taken as a bit pattern also for signed types: FFh is -1 of an I8.
    const bool pattern = sign && !negative && !text.empty() && (text.back() == 'h' || text.back() == 'H' || text.substr(0, 2) == "0x");
    const std::uint64_t limit = !sign || pattern ? top : negative ? (top >> 1) + 1 : top >> 1;
    if (magnitude > limit || (negative && !sign && magnitude != 0)) return bad(text, fmt::format("does not fit {}", type_name(type)));
    return bytes_of(negative ? std::uint64_t{0} - magnitude : magnitude, (bits + 7) / 8);
}

std::vector<std::byte> bits_of(std::span<const std::byte> bytes, std::size_t offset, std::size_t bits) {
    std::vector<std::byte> out((bits + 7) / 8);
    for (std::size_t i = 0; i < bits && (offset + i) / 8 < bytes.size(); ++i) {
        const std::size_t from = offset + i;
        const unsigned bit = (static_cast<unsigned>(bytes[from / 8]) >> (from % 8)) & 1u;
        out[i / 8] |= static_cast<std::byte>(bit << (i % 8));
    }
    return out;
}

}  // namespace taktwerk::ecat
