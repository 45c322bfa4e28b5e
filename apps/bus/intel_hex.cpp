#include "apps/bus/intel_hex.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

namespace taktwerk::apps {

namespace {

std::string_view as_text(std::span<const std::byte> file) noexcept {
    return {reinterpret_cast<const char*>(file.data()), file.size()};  // NOLINT: bytes as text
}

constexpr std::string_view blanks = " \t\r\n";

/// A record's bytes, length to checksum; empty: the line is no record.
std::vector<std::uint8_t> record_bytes(std::string_view line) {
    std::vector<std::uint8_t> out;
    if (line.front() != ':' || line.size() % 2 == 0) return {};
    for (std::size_t at = 1; at < line.size(); at += 2) {
        std::uint8_t byte = 0;
        const auto* end = line.data() + at + 2;
        if (const auto read = std::from_chars(line.data() + at, end, byte, 16); read.ec != std::errc{} || read.ptr != end) return {};
        out.push_back(byte);
    }
    const bool whole = out.size() >= 5 && out.size() == std::size_t{out.front()} + 5;
    return whole ? out : std::vector<std::uint8_t>{};
}

/// Puts records into an image, one after the other.
class HexImage {
public:
    explicit HexImage(std::size_t most) : most_(most) {}

    /// What is wrong with a record; empty: nothing.
    [[nodiscard]] std::string take(const std::vector<std::uint8_t>& record) {
        std::uint8_t sum = 0;
        for (const auto byte : record) sum = static_cast<std::uint8_t>(sum + byte);
        if (sum != 0) return fmt::format("its checksum is {:02X}h, its bytes give {:02X}h", record.back(), (record.back() - sum) & 0xFF);
        const auto data = std::span{record}.subspan(4, record.front());
        const std::size_t address = record[1] * 256u + record[2];
        switch (record[3]) {
            case 0: return store(base_ + address, data);
            case 1: ended_ = true; return {};
            case 2:
            case 4:
                if (data.size() != 2) return fmt::format("a base has two bytes, this one {}", data.size());
                base_ = (std::size_t{data[0]} * 256 + data[1]) << (record[3] == 2 ? 4u : 16u);
                return {};
            case 3:
            case 5: return {};  // where a processor starts
            default: return fmt::format("there is no record type {:02X}h", record[3]);
        }
    }
    [[nodiscard]] bool ended() const noexcept { return ended_; }
    [[nodiscard]] std::vector<std::byte> bytes() && { return std::move(bytes_); }

private:
    std::string store(std::size_t at, std::span<const std::uint8_t> data) {
        if (at + data.size() > most_) return fmt::format("it writes to {:X}h, and an EEPROM ends at {:X}h", at + data.size() - 1, most_);
        if (bytes_.size() < at + data.size()) {
            bytes_.resize(at + data.size(), std::byte{0xFF});
            given_.resize(bytes_.size(), false);
        }
        for (const auto byte : data) {
            if (given_[at]) return fmt::format("the byte at {:04X}h has been given before", at);
            given_[at] = true;
            bytes_[at++] = std::byte{byte};
        }
        return {};
    }

    std::size_t most_, base_ = 0;
    std::vector<std::byte> bytes_;
    std::vector<bool> given_;
    bool ended_ = false;
};

Error hex_error(const std::string& path, std::size_t line, std::string what) {
    return Error{"eeprom.hex", fmt::format("{}:{}", path, line), std::move(what),
                 "the file is damaged or was cut: get it anew, or give a binary image"};
}

}  // namespace

bool is_intel_hex(std::span<const std::byte> file) noexcept {
    const auto text = as_text(file);
    const auto first = text.find_first_not_of(blanks);
    return first != std::string_view::npos && text[first] == ':' &&
           std::all_of(text.begin(), text.end(), [](char c) { return (c >= ' ' && c <= '~') || blanks.find(c) != std::string_view::npos; });
}

Result<std::vector<std::byte>> parse_intel_hex(std::span<const std::byte> file, std::size_t most, const std::string& path) {
    HexImage image{most};
    auto rest = as_text(file);
    std::size_t number = 0;
    while (!rest.empty()) {
        const auto end = std::min(rest.find('\n'), rest.size());
        auto line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++number;
        while (!line.empty() && blanks.find(line.back()) != std::string_view::npos) line.remove_suffix(1);
        while (!line.empty() && blanks.find(line.front()) != std::string_view::npos) line.remove_prefix(1);
        if (line.empty()) continue;
        if (image.ended()) return hex_error(path, number, "there is more behind the end record");
        const auto record = record_bytes(line);
        if (record.empty()) return hex_error(path, number, "this line is no Intel HEX record");
        if (auto wrong = image.take(record); !wrong.empty()) return hex_error(path, number, std::move(wrong));
    }
    if (!image.ended()) return hex_error(path, number, "the end record (:00000001FF) is missing");
    return std::move(image).bytes();
}

}  // namespace taktwerk::apps
