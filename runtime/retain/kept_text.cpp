#include "runtime/retain/kept_text.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "core/crc32.hpp"
#include "runtime/retain/value_type.hpp"
#include "runtime/retain/words.hpp"

namespace taktwerk::runtime {

namespace {

constexpr std::int64_t most_counts = std::int64_t{1} << 52;  // what a double still tells apart, with room to add

std::uint32_t sum(std::string_view text) { return crc32(std::as_bytes(std::span(text.data(), text.size()))); }

std::string exact(double value) { return text_of(fb::PinKind::LREAL, std::bit_cast<std::uint64_t>(value)); }

bool plain(char c) noexcept {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) > 127 ||
           std::string_view("_-.[]").find(c) != std::string_view::npos;
}
std::string as_word(std::string_view name) {
    std::string out;
    for (const char c : name)
        if (plain(c)) out += c;
        else out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    return out;
}
std::string name_of(std::string_view word, bool& fits) {
    std::string out;
    for (std::size_t i = 0; i < word.size(); ++i) {
        unsigned code = 0;
        if (plain(word[i])) out += word[i];
        else if (word[i] == '%' && i + 2 < word.size() &&
                 std::from_chars(word.data() + i + 1, word.data() + i + 3, code, 16).ptr == word.data() + i + 3) {
            out += static_cast<char>(code);
            i += 2;
        } else fits = false;
    }
    fits = fits && !out.empty() && as_word(out) == word;  // one spelling: no name stands there twice
    return out;
}

/// What some axis could have. A check sum says that nobody altered it by mistake, not that it makes sense.
bool possible(const RetainedAxis& axis) {
    const auto& p = axis.position;
    const auto& g = axis.gearing;
    const bool gearing =
        g.counts_per_revolution > 0 && g.motor_revolutions > 0 && g.load_revolutions > 0 && std::isfinite(g.feed) && g.feed > 0;
    if (!gearing || axis.name.empty() || !std::isfinite(p.shift)) return false;
    const bool resolved = std::abs(p.shift) / g.feed * static_cast<double>(g.counts_per_revolution) <= static_cast<double>(most_counts);
    return resolved && p.counts <= most_counts && p.counts >= -most_counts;
}

class Parser {
public:
    explicit Parser(std::string_view text) : words_(text) {}

    std::optional<Kept> parse() {
        words_.expect("taktwerk");
        const auto format = words_.next();
        old_ = format == "positions";
        words_.refuse_unless(old_ || format == "retain");
        words_.expect("1");
        words_.expect("number");
        words_.read(kept_.number);
        while (words_.good() && !words_.at_end()) {
            const auto what = words_.next();
            if (what == "axis") axis();
            else if (what == "value" && !old_) value();
            else if (what == "block" && !old_) block();
            else if (what == "parameter" && !old_) parameter();
            else return std::nullopt;
        }
        words_.refuse_unless(kept_.number != 0 && kept_.number <= std::numeric_limits<std::uint64_t>::max() / 2);
        const bool all_once = once(kept_.axes) && once(kept_.values) && once(kept_.blocks) && once(kept_.parameters);
        if (!words_.good() || !all_once) return std::nullopt;
        return std::move(kept_);
    }

private:
    void axis() {
        RetainedAxis axis;
        auto& p = axis.position;
        auto& g = axis.gearing;
        axis.name = old_ ? std::string(words_.next()) : name();
        words_.expect("homed"), words_.read_bit(p.homed);
        words_.expect("shift"), words_.read(p.shift);
        words_.expect("counts"), words_.read(p.counts);
        words_.expect("at_rest"), words_.read_bit(p.at_rest);
        words_.expect("gearing"), words_.read(g.counts_per_revolution), words_.read(g.motor_revolutions), words_.read(g.load_revolutions);
        words_.read(g.feed), words_.read_bit(g.inverted);
        if (!words_.good()) return;
        words_.refuse_unless(possible(axis));
        kept_.axes.push_back(std::move(axis));
    }
    void value() {
        KeptValue value;
        value.name = name();
        value.kind = kind();
        const auto type = find_type(words_.next());
        const auto bits = type ? bits_of(*type, words_.next()) : std::nullopt;
        words_.read(value.unclaimed);
        words_.refuse_unless(bits.has_value());
        if (!words_.good()) return;
        value.type = *type;
        value.bits = *bits;
        kept_.values.push_back(std::move(value));
    }
    void block() {
        KeptBlock block;
        block.name = name();
        block.kind = kind();
        block.type = words_.next();
        words_.read(block.layout, 16);
        words_.read(block.unclaimed);
        auto bytes = bytes_of_hex(words_.next());
        words_.refuse_unless(bytes.has_value());
        if (bytes) block.bytes = std::move(*bytes);
        if (words_.good()) kept_.blocks.push_back(std::move(block));
    }
    void parameter() {
        KeptParameter parameter;
        parameter.name = name();
        words_.read(parameter.value);
        words_.read(parameter.configured);
        words_.read(parameter.unclaimed);
        words_.refuse_unless(std::isfinite(parameter.value) && std::isfinite(parameter.configured));
        if (words_.good()) kept_.parameters.push_back(std::move(parameter));
    }
    std::string name() {
        bool fits = true;
        auto out = name_of(words_.next(), fits);
        words_.refuse_unless(fits);
        return out;
    }
    RetainKind kind() {
        const auto kind = find_retain_kind(words_.next());
        words_.refuse_unless(kind.has_value());
        return kind.value_or(RetainKind::retain);
    }
    /// Which of two of one name would it be?
    template <class T>
    static bool once(const std::vector<T>& items) {
        std::vector<std::string_view> names;
        for (const auto& item : items) names.push_back(item.name);
        std::sort(names.begin(), names.end());
        return items.size() <= most_kept_items && std::adjacent_find(names.begin(), names.end()) == names.end();
    }

    Words words_;
    bool old_ = false;  // axes alone, their names as they are
    Kept kept_;
};

}  // namespace

std::string hex_of(std::span<const std::byte> bytes) {
    std::string out;
    for (const auto byte : bytes) fmt::format_to(std::back_inserter(out), "{:02x}", std::to_integer<unsigned>(byte));
    return out;
}

std::optional<std::vector<std::byte>> bytes_of_hex(std::string_view digits) {
    if (digits.empty() || digits.size() % 2 != 0 || digits.size() > 2 * largest_kept_block) return std::nullopt;
    std::vector<std::byte> out;
    for (std::size_t i = 0; i < digits.size(); i += 2) {
        std::uint8_t byte = 0;
        const auto* stop = digits.data() + i + 2;
        if (std::from_chars(digits.data() + i, stop, byte, 16).ptr != stop) return std::nullopt;
        out.push_back(std::byte{byte});
    }
    return out;
}

std::string text_of(const Kept& kept) {
    std::string text = fmt::format("taktwerk retain 1\nnumber {}\n", kept.number);
    const auto out = std::back_inserter(text);
    for (const auto& axis : kept.axes) {
        const auto& p = axis.position;
        const auto& g = axis.gearing;
        fmt::format_to(out, "axis {} homed {} shift {} counts {} at_rest {} gearing {} {} {} {} {}\n", as_word(axis.name), p.homed ? 1 : 0,
                       exact(p.shift), p.counts, p.at_rest ? 1 : 0, g.counts_per_revolution, g.motor_revolutions, g.load_revolutions,
                       exact(g.feed), g.inverted ? 1 : 0);
    }
    for (const auto& value : kept.values)
        fmt::format_to(out, "value {} {} {} {} {}\n", as_word(value.name), word(value.kind), word(value.type),
                       text_of(value.type, value.bits), value.unclaimed);
    for (const auto& block : kept.blocks)
        fmt::format_to(out, "block {} {} {} {:016x} {} {}\n", as_word(block.name), word(block.kind), block.type, block.layout,
                       block.unclaimed, hex_of(block.bytes));
    for (const auto& parameter : kept.parameters)
        fmt::format_to(out, "parameter {} {} {} {}\n", as_word(parameter.name), exact(parameter.value), exact(parameter.configured),
                       parameter.unclaimed);
    return text + fmt::format("crc {:08x}\n", sum(text));
}

std::optional<Kept> kept_of(std::string_view text) {
    const auto last = text.rfind("crc ");
    if (last == std::string_view::npos || text.substr(last) != fmt::format("crc {:08x}\n", sum(text.substr(0, last)))) return std::nullopt;
    return Parser(text.substr(0, last)).parse();
}

}  // namespace taktwerk::runtime
