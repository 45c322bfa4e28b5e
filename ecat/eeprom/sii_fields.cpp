#include "ecat/eeprom/sii_fields.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/bytes.hpp"
#include "ecat/eeprom/sii_names.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

namespace {

using Bytes = std::span<const std::byte>;

struct HeaderField {
    std::uint16_t first, words;
    std::string_view name;
};

constexpr std::array<HeaderField, 25> header_fields{{
    {sii_word::pdi_control, 1, "PDI control"},
    {sii_word::pdi_configuration, 1, "PDI configuration"},
    {sii_word::sync_pulse_length, 1, "SYNC pulse length"},
    {sii_word::pdi_configuration_extended, 1, "extended PDI configuration"},
    {sii_word::alias, 1, "alias"},
    {sii_word::pdi_configuration_more, 2, "further PDI configuration"},
    {sii_word::checksum, 1, "checksum of words 0 to 6"},
    {sii_word::vendor, 2, "vendor"},
    {sii_word::product, 2, "product"},
    {sii_word::revision, 2, "revision"},
    {sii_word::serial, 2, "serial number"},
    {sii_word::execution_delay, 1, "execution delay"},
    {sii_word::port0_delay, 1, "port 0 delay"},
    {sii_word::port1_delay, 1, "port 1 delay"},
    {sii_word::boot_mailbox_out, 1, "mailbox out in BOOT: address"},
    {sii_word::boot_mailbox_out + 1, 1, "mailbox out in BOOT: size"},
    {sii_word::boot_mailbox_in, 1, "mailbox in in BOOT: address"},
    {sii_word::boot_mailbox_in + 1, 1, "mailbox in in BOOT: size"},
    {sii_word::mailbox_out, 1, "mailbox out: address"},
    {sii_word::mailbox_out + 1, 1, "mailbox out: size"},
    {sii_word::mailbox_in, 1, "mailbox in: address"},
    {sii_word::mailbox_in + 1, 1, "mailbox in: size"},
    {sii_word::mailbox_protocols, 1, "mailbox protocols"},
    {sii_word::size, 1, "EEPROM size"},
    {sii_word::version, 1, "version"},
}};

std::string header_field(std::size_t word) {
    for (const auto& field : header_fields)
        if (word >= field.first && word < std::size_t{field.first} + field.words) return std::string{field.name};
    return "reserved";
}

/// A string that the byte pair at `offset` of the category belongs to.
std::string string_field(Bytes data, std::size_t offset) {
    if (offset == 0) return "number of strings, string 1";
    std::size_t at = 1;
    for (std::size_t n = 1; at < data.size(); ++n) {
        const std::size_t length = static_cast<std::size_t>(data[at]);
        const std::size_t end = at + 1 + length;
        if (offset < end) {
            std::string text;
            for (const auto byte : data.subspan(at + 1, std::min(length, data.size() - at - 1))) text.push_back(static_cast<char>(byte));
            return fmt::format("string {} '{}'", n, text);
        }
        at = end;
    }
    return "strings";
}

std::string general_field(std::size_t offset) {
    switch (offset) {
        case 0: return "general: group, image";
        case 2: return "general: order, name";
        case 4: return "general: CoE details";
        case 6: return "general: FoE and EoE details";
        case 8: return "general: SoE and DS402 channels";
        case 10: return "general: flags";
        case 12: return "general: E-bus current";
        case 16: return "general: kinds of ports";
        case 18: return "general: address of the device id";
        default: return "general: reserved";
    }
}

std::string sync_manager_field(std::size_t offset) {
    constexpr std::array<std::string_view, 4> parts{"address", "length", "control and status", "enable and use"};
    return fmt::format("sync manager {} {}", offset / 8, parts[offset % 8 / 2]);
}

std::string pdo_field(Bytes data, std::size_t offset, const char* direction) {
    for (std::size_t at = 0; at + 8 <= data.size();) {
        const auto index = load_le<std::uint16_t>(data, at);
        const std::size_t entries = static_cast<std::size_t>(data[at + 2]);
        if (offset < at + 8) return fmt::format("{} {:04X}h", direction, index);
        const std::size_t end = at + 8 + 8 * entries;
        if (offset < end) return fmt::format("{} {:04X}h entry {}", direction, index, (offset - at - 8) / 8 + 1);
        at = end;
    }
    return direction;
}

std::string clock_field(std::size_t offset) {
    constexpr std::array<std::string_view, 12> parts{"SYNC0 cycle",  "SYNC0 cycle",          "SYNC0 shift",  "SYNC0 shift",
                                                     "SYNC1 shift",  "SYNC1 shift",          "SYNC1 factor", "activation",
                                                     "SYNC0 factor", "name and description", "reserved",     "reserved"};
    return fmt::format("clock mode {} {}", offset / 24, parts[offset % 24 / 2]);
}

}  // namespace

std::string sii_field(std::span<const std::byte> image, std::size_t word) {
    if (word < sii_word::categories) return header_field(word);
    std::size_t end = sii_word::categories;
    for (const auto& category : sii_categories(image)) {
        end = category.word + category.words;
        if (word >= end) continue;
        if (word < category.word) return sii_category_name(category.type) + ": type and length";
        const auto data = image.subspan(2 * category.word, 2 * category.words);
        const std::size_t offset = 2 * (word - category.word);
        switch (category.type) {
            case sii_category::strings: return string_field(data, offset);
            case sii_category::general: return general_field(offset);
            case sii_category::sync_manager: return sync_manager_field(offset);
            case sii_category::tx_pdo: return pdo_field(data, offset, "TxPDO");
            case sii_category::rx_pdo: return pdo_field(data, offset, "RxPDO");
            case sii_category::dc: return clock_field(offset);
            default: return sii_category_name(category.type);
        }
    }
    return word == end ? "end marker" : "behind the end marker";
}

std::vector<SiiWordChange> sii_changes(std::span<const std::byte> before, std::span<const std::byte> after) {
    std::vector<SiiWordChange> changes;
    const std::size_t words = std::min(before.size(), after.size()) / 2;
    for (std::size_t word = 0; word < words; ++word) {
        const auto from = load_le<std::uint16_t>(before, 2 * word), to = load_le<std::uint16_t>(after, 2 * word);
        if (from != to) changes.push_back({word, from, to});
    }
    return changes;
}

void set_sii_alias(std::span<std::byte> image, std::uint16_t alias) noexcept {
    store_le<std::uint16_t>(image, 2 * sii_word::alias, alias);
    store_le<std::uint16_t>(image, 2 * sii_word::checksum, sii_checksum(image));
}

}  // namespace taktwerk::ecat
