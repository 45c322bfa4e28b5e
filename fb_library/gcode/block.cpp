#include "fb_library/gcode/block.hpp"

#include <charconv>
#include <cmath>

namespace taktwerk::gcode {
namespace {

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
constexpr bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }
constexpr char capital(char c) noexcept { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }
constexpr bool is_letter(char c) noexcept { return capital(c) >= 'A' && capital(c) <= 'Z'; }
constexpr bool is_expression(char c) noexcept { return c == '#' || c == '[' || c == ']' || c == '='; }

constexpr std::string_view known_letters = "ABCFGHIJKLMNPQRSTXYZ";

constexpr std::array<double, 16> powers_of_ten{1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

bool same_word(std::string_view text, std::string_view capitals) noexcept {
    if (text.size() != capitals.size()) return false;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (capital(text[i]) != capitals[i]) return false;
    return true;
}

class BlockParser {
public:
    BlockParser(std::string_view line, std::uint32_t number, Block& block, Fault& fault) noexcept
        : line_(line), block_(block), fault_(fault) {
        block.text = line, block.line = number, block.number = no_block_number, block.deletable = false, block.letters = 0;
        block.codes.fill({}), block.message = {};
    }

    FaultKind parse(Deletable deletable) noexcept {
        skip_blanks();
        if (at_ < line_.size() && line_[at_] == '/') {
            block_.deletable = true;
            if (deletable == Deletable::left_out) return FaultKind::none;
            ++at_;
        }
        for (skip_blanks(); at_ < line_.size(); skip_blanks()) {
            const char c = line_[at_];
            if (c == ';') return FaultKind::none;
            const auto wrong = c == '(' ? comment() : is_letter(c) ? word() : stray(c);
            if (wrong != FaultKind::none) return wrong;
        }
        return FaultKind::none;
    }

private:
    void skip_blanks() noexcept {
        while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
    }

    FaultKind fail(FaultKind kind, std::size_t at, std::string_view reason = {}) noexcept {
        fault_ = {};
        fault_.kind = kind, fault_.line = block_.line, fault_.column = static_cast<std::uint32_t>(at + 1), fault_.reason = reason;
        fault_.word = word_at(line_, fault_.column);
        return kind;
    }

    FaultKind stray(char c) noexcept {
        if (c == '/') return fail(FaultKind::slash_not_first, at_);
        if (c == '%') return fail(FaultKind::percent_inside, at_);
        if (c == ',') return fail(FaultKind::comma, at_);
        if (is_expression(c)) return fail(FaultKind::expression, at_);
        if (is_digit(c) || c == '.' || c == '+' || c == '-') return fail(FaultKind::no_letter, at_);
        // No character of UTF-8 has these bytes; UTF-16 begins with two of them and has zeros all along.
        const bool plain = c != '\0' && c != '\xFE' && c != '\xFF';
        return fail(plain ? FaultKind::bad_character : FaultKind::not_plain_text, at_);
    }

    FaultKind comment() noexcept {
        const auto open = at_;
        for (++at_; at_ < line_.size() && line_[at_] != ')'; ++at_)
            if (line_[at_] == '(') return fail(FaultKind::nested_comment, at_);
        if (at_ == line_.size()) return fail(FaultKind::open_comment, open);
        return active(open + 1, line_.substr(open + 1, at_++ - open - 1));
    }

    FaultKind active(std::size_t at, std::string_view inside) noexcept {
        const auto comma = inside.find(',');
        if (comma == std::string_view::npos) return log_close(at, inside);
        auto name = inside.substr(0, comma);
        while (!name.empty() && is_blank(name.front())) name.remove_prefix(1);
        while (!name.empty() && is_blank(name.back())) name.remove_suffix(1);
        if (same_word(name, "MSG")) {
            if (!block_.message.empty()) {
                fail(FaultKind::word_twice, at);
                fault_.other = fault_.word;
                return FaultKind::word_twice;
            }
            block_.message = inside.substr(comma + 1);
            while (!block_.message.empty() && is_blank(block_.message.front())) block_.message.remove_prefix(1);
            return FaultKind::none;
        }
        for (const std::string_view other : {"DEBUG", "PRINT", "LOG", "LOGOPEN", "LOGAPPEND", "PROBEOPEN"})
            if (same_word(name, other)) return fail(FaultKind::active_comment, at);
        return FaultKind::none;
    }

    FaultKind log_close(std::size_t at, std::string_view inside) noexcept {
        while (!inside.empty() && is_blank(inside.front())) inside.remove_prefix(1);
        while (!inside.empty() && is_blank(inside.back())) inside.remove_suffix(1);
        return same_word(inside, "LOGCLOSE") || same_word(inside, "PROBECLOSE") ? fail(FaultKind::active_comment, at) : FaultKind::none;
    }

    FaultKind word() noexcept {
        const auto start = at_;
        const char letter = capital(line_[at_++]);
        if (letter == 'O') return fail(FaultKind::o_word, start);
        if (known_letters.find(letter) == std::string_view::npos) return fail(FaultKind::unknown_letter, start);
        double value = 0;
        if (const auto wrong = number(start, letter == 'N' ? 999'999'999 : largest_number, value); wrong != FaultKind::none) return wrong;
        const bool first = !any_word_;
        any_word_ = true;
        switch (letter) {
            case 'N': return block_number(start, first, value);
            case 'G': return g_word(start, value);
            case 'M': return m_word(start, value);
            default: break;
        }
        const auto place = static_cast<std::size_t>(letter - 'A');
        if (block_.has(letter)) return twice(start, block_.column[place]);
        block_.letters |= letter_bit(letter);
        block_.value[place] = value, block_.column[place] = static_cast<std::uint16_t>(start + 1);
        return FaultKind::none;
    }

    FaultKind twice(std::size_t at, std::uint32_t before) noexcept {
        const auto kind = fail(FaultKind::word_twice, at);
        fault_.other = word_at(line_, before);
        return kind;
    }

    FaultKind number(std::size_t start, double most, double& value) noexcept {
        skip_blanks();
        const auto begin = at_;
        bool negative = false, point = false;
        if (at_ < line_.size() && (line_[at_] == '+' || line_[at_] == '-')) negative = line_[at_++] == '-';
        const bool sign = at_ > begin;
        const auto digits_begin = at_;
        std::size_t digits = 0, behind_point = 0;
        std::uint64_t whole = 0;
        for (; at_ < line_.size(); ++at_) {
            const char c = line_[at_];
            if (c == '.') {
                if (point) return fail(FaultKind::number_form, start);
                point = true;
                continue;
            }
            if (!is_digit(c)) break;
            ++digits, behind_point += point ? 1 : 0;
            if (digits <= 18) whole = whole * 10 + static_cast<std::uint64_t>(c - '0');
        }
        const auto end = at_;
        skip_blanks();
        const char next = at_ < line_.size() ? line_[at_] : '\0';
        if (next == ',') return fail(FaultKind::comma, start);
        if (is_expression(next)) return fail(FaultKind::expression, at_);
        if (at_ > end && (is_digit(next) || next == '.') && (digits > 0 || point || sign)) return fail(FaultKind::blank_in_number, start);
        if (digits == 0) return fail(sign || point ? FaultKind::number_form : FaultKind::no_number, start);
        if (next == '+' || next == '-') return fail(FaultKind::number_form, start);
        // Both operands exact: the quotient is the nearest double. What is longer goes the long way.
        if (digits <= 15) value = static_cast<double>(whole) / powers_of_ten[behind_point];
        else if (std::from_chars(line_.data() + digits_begin, line_.data() + end, value).ec != std::errc{})
            return fail(FaultKind::too_large, start);
        if (!(value <= most)) return fail(FaultKind::too_large, start);
        if (negative) value = -value;
        return FaultKind::none;
    }

    FaultKind block_number(std::size_t start, bool first, double value) noexcept {
        if (!first) return fail(FaultKind::n_not_first, start);
        if (std::signbit(value)) return fail(FaultKind::negative, start);
        if (value != std::floor(value)) return fail(FaultKind::not_whole, start);
        block_.number = static_cast<std::uint32_t>(value);
        return FaultKind::none;
    }

    FaultKind g_word(std::size_t start, double value) noexcept {
        const double tenths = std::round(value * 10);
        const bool known = !std::signbit(value) && tenths < 1000 && std::fabs(value * 10 - tenths) < 1e-9;
        return code(start, known ? find_g(static_cast<int>(tenths)) : nullptr);
    }
    FaultKind m_word(std::size_t start, double value) noexcept {
        const bool known = !std::signbit(value) && value < 1000 && value == std::floor(value);
        return code(start, known ? find_m(static_cast<int>(value)) : nullptr);
    }

    FaultKind code(std::size_t start, const CodeEntry* entry) noexcept {
        if (entry == nullptr) return fail(FaultKind::unknown_code, start);
        if (!entry->refused.empty()) return fail(FaultKind::refused_code, start, entry->refused);
        auto& place = block_.codes[static_cast<std::size_t>(entry->group)];
        if (place.entry == entry) return twice(start, place.column);
        if (place.entry != nullptr) {
            const auto kind = fail(FaultKind::same_group, start);
            fault_.other = word_at(line_, place.column);
            return kind;
        }
        place = {entry, static_cast<std::uint16_t>(start + 1)};
        return FaultKind::none;
    }

    std::string_view line_;
    Block& block_;
    Fault& fault_;
    std::size_t at_ = 0;
    bool any_word_ = false;
};

}  // namespace

FaultKind parse_block(std::string_view line, std::uint32_t number, Deletable deletable, Block& block, Fault& fault) noexcept {
    return BlockParser(line, number, block, fault).parse(deletable);
}

FixedText<24> word_at(std::string_view line, std::uint32_t column) noexcept {
    constexpr std::string_view hex = "0123456789ABCDEF";
    FixedText<24> word;
    if (column == 0 || column > line.size()) return word;
    const auto put = [&word](char c) {
        if (word.length < word.bytes.size()) word.bytes[word.length++] = c;
    };
    auto at = static_cast<std::size_t>(column - 1);
    const char first = line[at];
    if (!is_letter(first) && !is_digit(first) && first != '.' && first != '+' && first != '-') {
        const auto byte = static_cast<unsigned char>(first);
        if (byte > 0x20 && byte < 0x7F) return FixedText<24>(std::string_view(&line[at], 1));
        for (const char c : {'b', 'y', 't', 'e', ' ', hex[byte >> 4], hex[byte & 15], 'h'}) put(c);
        return word;
    }
    const auto number = [](char c) { return is_digit(c) || c == '.' || c == '+' || c == '-'; };
    put(capital(first)), ++at;
    // A name (of a comment) is letters alone; a word is a letter and its number.
    if (is_letter(first) && at < line.size() && is_letter(line[at]))
        for (std::size_t next = at; next < line.size() && is_letter(line[next]); ++next)
            if (next + 1 == line.size() || line[next + 1] == ',' || line[next + 1] == ')') {
                for (; at <= next; ++at) put(capital(line[at]));
                return word;
            }
    while (at < line.size() && is_blank(line[at])) ++at;
    for (; at < line.size() && number(line[at]); ++at) put(line[at]);
    return word;
}

}  // namespace taktwerk::gcode
