#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

namespace {

/// Word at a word address; 0 beyond the image.
std::uint16_t word(std::span<const std::byte> image, std::size_t address) noexcept {
    return 2 * address + 2 <= image.size() ? load_le<std::uint16_t>(image, 2 * address) : std::uint16_t{0};
}

std::uint32_t dword(std::span<const std::byte> image, std::size_t address) noexcept {
    return word(image, address) | (static_cast<std::uint32_t>(word(image, address + 1)) << 16);
}

SiiMailbox mailbox(std::span<const std::byte> image, std::size_t address) noexcept {
    return {word(image, address), word(image, address + 1)};
}

std::uint8_t byte_at(std::span<const std::byte> data, std::size_t offset) noexcept {
    return offset < data.size() ? static_cast<std::uint8_t>(data[offset]) : std::uint8_t{0};
}

void note(Sii& sii, SiiDefect defect) {
    if (!sii.has(defect)) sii.defects.push_back(defect);
}

void take_strings(Sii& sii, std::span<const std::byte> data) {
    if (data.empty()) return note(sii, SiiDefect::bad_strings);
    const std::size_t count = static_cast<std::size_t>(data[0]);
    std::size_t at = 1;
    for (std::size_t i = 0; i < count; ++i) {
        if (at >= data.size()) return note(sii, SiiDefect::bad_strings);
        const std::size_t length = static_cast<std::size_t>(data[at++]);
        const std::size_t there = std::min(length, data.size() - at);
        std::string text;
        text.reserve(there);
        for (const auto byte : data.subspan(at, there)) text.push_back(static_cast<char>(byte));
        sii.strings.push_back(std::move(text));
        if (there < length) return note(sii, SiiDefect::bad_strings);
        at += length;
    }
}

void take_general(Sii& sii, std::span<const std::byte> data) {
    if (data.size() < 18) note(sii, SiiDefect::bad_general);  // byte 17 is the last one used below
    SiiGeneral general;
    general.group = byte_at(data, 0);
    general.image = byte_at(data, 1);
    general.order = byte_at(data, 2);
    general.name = byte_at(data, 3);
    general.coe_details = byte_at(data, 5);
    general.foe_details = byte_at(data, 6);
    general.eoe_details = byte_at(data, 7);
    general.soe_channels = byte_at(data, 8);
    general.ds402_channels = byte_at(data, 9);
    general.sysman_class = byte_at(data, 10);
    general.flags = byte_at(data, 11);
    general.ebus_current = static_cast<std::int16_t>(byte_at(data, 12) | (byte_at(data, 13) << 8));
    general.physical_ports = static_cast<std::uint16_t>(byte_at(data, 16) | (byte_at(data, 17) << 8));
    general.id_address = static_cast<std::uint16_t>(byte_at(data, 18) | (byte_at(data, 19) << 8));
    sii.general = general;
}

void take_sync_managers(Sii& sii, std::span<const std::byte> data) {
    if (data.size() % 8 != 0) note(sii, SiiDefect::bad_sync_managers);
    for (; data.size() >= 8; data = data.subspan(8)) {
        SiiSyncManager sm;
        sm.start = load_le<std::uint16_t>(data, 0);
        sm.length = load_le<std::uint16_t>(data, 2);
        sm.control = static_cast<std::uint8_t>(data[4]);
        sm.status = static_cast<std::uint8_t>(data[5]);
        sm.enable = static_cast<std::uint8_t>(data[6]);
        sm.use = static_cast<SiiSyncManagerUse>(data[7]);
        sii.sync_managers.push_back(sm);
    }
}

void take_pdos(Sii& sii, std::vector<SiiPdo>& pdos, std::span<const std::byte> data) {
    while (!data.empty()) {
        if (data.size() < 8) return note(sii, SiiDefect::bad_pdo);
        SiiPdo pdo;
        pdo.index = load_le<std::uint16_t>(data, 0);
        const std::size_t count = static_cast<std::size_t>(data[2]);
        pdo.sync_manager = static_cast<std::uint8_t>(data[3]);
        pdo.synchronization = static_cast<std::uint8_t>(data[4]);
        pdo.name = static_cast<std::uint8_t>(data[5]);
        pdo.flags = load_le<std::uint16_t>(data, 6);
        data = data.subspan(8);
        const std::size_t there = std::min(count, data.size() / 8);
        pdo.entries.reserve(there);
        for (std::size_t i = 0; i < there; ++i, data = data.subspan(8)) {
            SiiPdoEntry entry;
            entry.index = load_le<std::uint16_t>(data, 0);
            entry.sub = static_cast<std::uint8_t>(data[2]);
            entry.name = static_cast<std::uint8_t>(data[3]);
            entry.data_type = static_cast<std::uint8_t>(data[4]);
            entry.bits = static_cast<std::uint8_t>(data[5]);
            entry.flags = load_le<std::uint16_t>(data, 6);
            pdo.entries.push_back(entry);
        }
        pdos.push_back(std::move(pdo));
        if (there < count) return note(sii, SiiDefect::bad_pdo);
    }
}

void take_fmmu_extensions(Sii& sii, std::span<const std::byte> data) {
    for (; data.size() >= 3; data = data.subspan(3)) sii.fmmu_extensions.push_back({byte_at(data, 0), byte_at(data, 1), byte_at(data, 2)});
}

void take_dc_modes(Sii& sii, std::span<const std::byte> data) {
    constexpr std::size_t mode_bytes = 24;  // the last four are reserved
    if (data.size() % mode_bytes != 0) note(sii, SiiDefect::bad_dc);
    for (; data.size() >= mode_bytes; data = data.subspan(mode_bytes)) {
        SiiDcMode mode;
        mode.sync0_cycle = load_le<std::uint32_t>(data, 0);
        mode.sync0_shift = load_le<std::int32_t>(data, 4);
        mode.sync1_shift = load_le<std::int32_t>(data, 8);
        mode.sync1_factor = load_le<std::int16_t>(data, 12);
        mode.assign_activate = load_le<std::uint16_t>(data, 14);
        mode.sync0_factor = load_le<std::int16_t>(data, 16);
        mode.name = byte_at(data, 18);
        mode.description = byte_at(data, 19);
        sii.dc_modes.push_back(mode);
    }
}

void take_category(Sii& sii, std::uint16_t type, std::span<const std::byte> data) {
    switch (type) {
        case sii_category::nop: break;
        case sii_category::strings: take_strings(sii, data); break;
        case sii_category::general: take_general(sii, data); break;
        case sii_category::fmmu:
            while (!data.empty() && data.back() == std::byte{0xFF}) data = data.first(data.size() - 1);  // fills the last word
            for (const auto byte : data) sii.fmmus.push_back(byte == std::byte{0xFF} ? SiiFmmuUse::unused : static_cast<SiiFmmuUse>(byte));
            break;
        case sii_category::sync_manager: take_sync_managers(sii, data); break;
        case sii_category::fmmu_extension: take_fmmu_extensions(sii, data); break;
        case sii_category::dc: take_dc_modes(sii, data); break;
        case sii_category::tx_pdo: take_pdos(sii, sii.tx_pdos, data); break;
        case sii_category::rx_pdo: take_pdos(sii, sii.rx_pdos, data); break;
        default: sii.others.push_back({type, {data.begin(), data.end()}}); break;
    }
}

/// Where the chain of categories leads, and what is wrong with its end.
struct Chain {
    std::vector<SiiCategoryPlace> categories;
    std::optional<SiiDefect> defect;
};

Chain categories_of(std::span<const std::byte> image) {
    Chain chain;
    for (std::size_t at = sii_header_bytes;;) {
        if (at + 2 > image.size()) {
            chain.defect = SiiDefect::no_end;
            return chain;
        }
        const auto type = load_le<std::uint16_t>(image, at);
        if (type == sii_category::end) return chain;
        if (at + 4 > image.size()) {
            chain.defect = SiiDefect::truncated_category;
            return chain;
        }
        const std::size_t bytes = 2 * static_cast<std::size_t>(load_le<std::uint16_t>(image, at + 2));
        at += 4;
        const std::size_t there = std::min(bytes, image.size() - at);
        chain.categories.push_back({type, at / 2, there / 2});
        if (there < bytes) {
            chain.defect = SiiDefect::truncated_category;
            return chain;
        }
        at += bytes;
    }
}

bool is_blank(std::span<const std::byte> image) noexcept {
    return std::all_of(image.begin(), image.end(), [](std::byte b) { return b == std::byte{0}; }) ||
           std::all_of(image.begin(), image.end(), [](std::byte b) { return b == std::byte{0xFF}; });
}

}  // namespace

std::string_view text(SiiDefect defect) noexcept {
    switch (defect) {
        case SiiDefect::empty: return "the EEPROM is empty";
        case SiiDefect::truncated_header: return "the EEPROM is shorter than its 64-word header";
        case SiiDefect::bad_checksum: return "the checksum of words 0..6 is wrong";
        case SiiDefect::truncated_category: return "a category reaches beyond the EEPROM";
        case SiiDefect::no_end: return "the end marker is missing";
        case SiiDefect::bad_strings: return "the string table is shorter than it says";
        case SiiDefect::bad_general: return "the general category is too short";
        case SiiDefect::bad_sync_managers: return "the sync manager category is not a multiple of 8 bytes";
        case SiiDefect::bad_pdo: return "a PDO category is shorter than its entries";
        case SiiDefect::bad_dc: return "the clock category is not a multiple of 24 bytes";
        case SiiDefect::unreadable: return "the EEPROM could not be read to its end";
    }
    return "unknown defect";
}

std::size_t SiiPdo::bits() const noexcept {
    std::size_t sum = 0;
    for (const auto& entry : entries) sum += entry.bits;
    return sum;
}

bool Sii::has(SiiDefect defect) const noexcept { return std::find(defects.begin(), defects.end(), defect) != defects.end(); }

std::string_view Sii::string(std::uint8_t number) const noexcept {
    return number != 0 && number <= strings.size() ? std::string_view{strings[number - 1u]} : std::string_view{};
}

std::uint8_t sii_checksum(std::span<const std::byte> image) noexcept {
    std::uint8_t crc = 0xFF;
    for (const auto byte : image.first(14)) {
        crc = static_cast<std::uint8_t>(crc ^ static_cast<std::uint8_t>(byte));
        for (int bit = 0; bit < 8; ++bit) crc = static_cast<std::uint8_t>((crc & 0x80u) != 0 ? (crc << 1) ^ 0x07 : crc << 1);
    }
    return crc;
}

std::vector<SiiCategoryPlace> sii_categories(std::span<const std::byte> image) { return categories_of(image).categories; }

Sii parse_sii(std::span<const std::byte> image) {
    Sii sii;
    if (is_blank(image)) {  // also no bytes at all
        sii.version = 0;
        sii.defects.push_back(SiiDefect::empty);
        return sii;
    }
    if (image.size() < sii_header_bytes) note(sii, SiiDefect::truncated_header);
    sii.pdi_control = word(image, sii_word::pdi_control);
    sii.pdi_configuration = word(image, sii_word::pdi_configuration);
    sii.sync_pulse_length = word(image, sii_word::sync_pulse_length);
    sii.pdi_configuration_extended = word(image, sii_word::pdi_configuration_extended);
    sii.alias = word(image, sii_word::alias);
    for (std::size_t i = 0; i < sii.pdi_configuration_more.size(); ++i)
        sii.pdi_configuration_more[i] = word(image, sii_word::pdi_configuration_more + i);
    for (std::size_t i = 0; i < sii.delays.size(); ++i) sii.delays[i] = word(image, sii_word::execution_delay + i);
    sii.identity.vendor = dword(image, sii_word::vendor);
    sii.identity.product = dword(image, sii_word::product);
    sii.identity.revision = dword(image, sii_word::revision);
    sii.identity.serial = dword(image, sii_word::serial);
    sii.boot_mailbox_out = mailbox(image, sii_word::boot_mailbox_out);
    sii.boot_mailbox_in = mailbox(image, sii_word::boot_mailbox_in);
    sii.mailbox_out = mailbox(image, sii_word::mailbox_out);
    sii.mailbox_in = mailbox(image, sii_word::mailbox_in);
    sii.mailbox_protocols = word(image, sii_word::mailbox_protocols);
    sii.size_code = word(image, sii_word::size);
    sii.version = word(image, sii_word::version);
    if (image.size() >= 16 && sii_checksum(image) != static_cast<std::uint8_t>(word(image, sii_word::checksum) & 0xFFu))
        note(sii, SiiDefect::bad_checksum);

    const Chain chain = categories_of(image);
    for (const auto& category : chain.categories) take_category(sii, category.type, image.subspan(2 * category.word, 2 * category.words));
    if (chain.defect) note(sii, *chain.defect);
    return sii;
}

}  // namespace taktwerk::ecat
