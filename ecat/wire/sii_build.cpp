#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::size_t byte_limit = 255;

void put8(std::vector<std::byte>& bytes, unsigned value) { bytes.push_back(static_cast<std::byte>(value & 0xFFu)); }

void put16(std::vector<std::byte>& bytes, unsigned value) {
    put8(bytes, value);
    put8(bytes, value >> 8);
}

void put_category(std::vector<std::byte>& image, std::uint16_t type, std::vector<std::byte> data, std::byte filling = std::byte{0}) {
    if (data.size() % 2 != 0) data.push_back(filling);
    put16(image, type);
    put16(image, static_cast<unsigned>(data.size() / 2));
    image.insert(image.end(), data.begin(), data.end());
}

std::vector<std::byte> strings_of(const Sii& sii) {
    std::vector<std::byte> data;
    const auto count = std::min(sii.strings.size(), byte_limit);
    put8(data, static_cast<unsigned>(count));
    for (std::size_t i = 0; i < count; ++i) {
        const auto text = std::string_view{sii.strings[i]}.substr(0, byte_limit);
        put8(data, static_cast<unsigned>(text.size()));
        for (const char c : text) data.push_back(static_cast<std::byte>(c));
    }
    return data;
}

std::vector<std::byte> general_of(const SiiGeneral& general) {
    std::vector<std::byte> data(32);
    data[0] = static_cast<std::byte>(general.group);
    data[1] = static_cast<std::byte>(general.image);
    data[2] = static_cast<std::byte>(general.order);
    data[3] = static_cast<std::byte>(general.name);
    data[5] = static_cast<std::byte>(general.coe_details);
    data[6] = static_cast<std::byte>(general.foe_details);
    data[7] = static_cast<std::byte>(general.eoe_details);
    data[8] = static_cast<std::byte>(general.soe_channels);
    data[9] = static_cast<std::byte>(general.ds402_channels);
    data[10] = static_cast<std::byte>(general.sysman_class);
    data[11] = static_cast<std::byte>(general.flags);
    store_le<std::int16_t>(data, 12, general.ebus_current);
    store_le<std::uint16_t>(data, 16, general.physical_ports);
    store_le<std::uint16_t>(data, 18, general.id_address);
    return data;
}

std::vector<std::byte> sync_managers_of(const std::vector<SiiSyncManager>& sync_managers) {
    std::vector<std::byte> data;
    for (const auto& sm : sync_managers) {
        put16(data, sm.start);
        put16(data, sm.length);
        put8(data, sm.control);
        put8(data, sm.status);
        put8(data, sm.enable);
        put8(data, static_cast<unsigned>(sm.use));
    }
    return data;
}

std::vector<std::byte> pdos_of(const std::vector<SiiPdo>& pdos) {
    std::vector<std::byte> data;
    for (const auto& pdo : pdos) {
        const auto count = std::min(pdo.entries.size(), byte_limit);
        put16(data, pdo.index);
        put8(data, static_cast<unsigned>(count));
        put8(data, pdo.sync_manager);
        put8(data, pdo.synchronization);
        put8(data, pdo.name);
        put16(data, pdo.flags);
        for (std::size_t i = 0; i < count; ++i) {
            const auto& entry = pdo.entries[i];
            put16(data, entry.index);
            put8(data, entry.sub);
            put8(data, entry.name);
            put8(data, entry.data_type);
            put8(data, entry.bits);
            put16(data, entry.flags);
        }
    }
    return data;
}

std::vector<std::byte> dc_modes_of(const std::vector<SiiDcMode>& modes) {
    std::vector<std::byte> data;
    for (const auto& mode : modes) {
        const std::size_t at = data.size();
        data.resize(at + 24);
        store_le(data, at, mode.sync0_cycle);
        store_le(data, at + 4, mode.sync0_shift);
        store_le(data, at + 8, mode.sync1_shift);
        store_le(data, at + 12, mode.sync1_factor);
        store_le(data, at + 14, mode.assign_activate);
        store_le(data, at + 16, mode.sync0_factor);
        data[at + 18] = static_cast<std::byte>(mode.name);
        data[at + 19] = static_cast<std::byte>(mode.description);
    }
    return data;
}

std::vector<std::byte> fmmu_extensions_of(const std::vector<SiiFmmuExtension>& extensions) {
    std::vector<std::byte> data;
    for (const auto& extension : extensions) {
        put8(data, extension.flags);
        put8(data, extension.sync_manager);
        put8(data, extension.sync_unit);
    }
    return data;
}

}  // namespace

std::uint8_t Sii::add_string(std::string_view string) {
    if (string.empty()) return 0;
    const auto found = std::find(strings.begin(), strings.end(), string);
    if (found != strings.end()) return static_cast<std::uint8_t>(found - strings.begin() + 1);
    if (strings.size() >= byte_limit) return 0;
    strings.emplace_back(string);
    return static_cast<std::uint8_t>(strings.size());
}

std::vector<std::byte> build_sii(const Sii& sii) {
    std::vector<std::byte> image(sii_header_bytes);
    const auto set = [&image](std::size_t word_address, std::uint16_t value) { store_le<std::uint16_t>(image, 2 * word_address, value); };
    const auto set_mailbox = [&set](std::size_t word_address, const SiiMailbox& mailbox) {
        set(word_address, mailbox.start);
        set(word_address + 1, mailbox.size);
    };
    set(sii_word::pdi_control, sii.pdi_control);
    set(sii_word::pdi_configuration, sii.pdi_configuration);
    set(sii_word::sync_pulse_length, sii.sync_pulse_length);
    set(sii_word::pdi_configuration_extended, sii.pdi_configuration_extended);
    set(sii_word::alias, sii.alias);
    for (std::size_t i = 0; i < sii.pdi_configuration_more.size(); ++i)
        set(sii_word::pdi_configuration_more + i, sii.pdi_configuration_more[i]);
    set(sii_word::checksum, sii_checksum(image));
    store_le<std::uint32_t>(image, 2 * sii_word::vendor, sii.identity.vendor);
    store_le<std::uint32_t>(image, 2 * sii_word::product, sii.identity.product);
    store_le<std::uint32_t>(image, 2 * sii_word::revision, sii.identity.revision);
    store_le<std::uint32_t>(image, 2 * sii_word::serial, sii.identity.serial);
    for (std::size_t i = 0; i < sii.delays.size(); ++i) set(sii_word::execution_delay + i, sii.delays[i]);
    set_mailbox(sii_word::boot_mailbox_out, sii.boot_mailbox_out);
    set_mailbox(sii_word::boot_mailbox_in, sii.boot_mailbox_in);
    set_mailbox(sii_word::mailbox_out, sii.mailbox_out);
    set_mailbox(sii_word::mailbox_in, sii.mailbox_in);
    set(sii_word::mailbox_protocols, sii.mailbox_protocols);
    set(sii_word::size, sii.size_code);
    set(sii_word::version, sii.version);

    if (!sii.strings.empty()) put_category(image, sii_category::strings, strings_of(sii));
    if (sii.general) put_category(image, sii_category::general, general_of(*sii.general));
    if (!sii.fmmus.empty()) {
        std::vector<std::byte> data;
        for (const auto use : sii.fmmus) put8(data, static_cast<unsigned>(use));
        put_category(image, sii_category::fmmu, std::move(data), std::byte{0xFF});
    }
    if (!sii.sync_managers.empty()) put_category(image, sii_category::sync_manager, sync_managers_of(sii.sync_managers));
    if (!sii.fmmu_extensions.empty()) put_category(image, sii_category::fmmu_extension, fmmu_extensions_of(sii.fmmu_extensions));
    if (!sii.tx_pdos.empty()) put_category(image, sii_category::tx_pdo, pdos_of(sii.tx_pdos));
    if (!sii.rx_pdos.empty()) put_category(image, sii_category::rx_pdo, pdos_of(sii.rx_pdos));
    if (!sii.dc_modes.empty()) put_category(image, sii_category::dc, dc_modes_of(sii.dc_modes));
    for (const auto& other : sii.others) put_category(image, other.type, other.data);
    put16(image, sii_category::end);

    constexpr std::size_t bytes_per_kbit = 128;
    const std::size_t device = (std::size_t{sii.size_code} + 1) * bytes_per_kbit;
    if (image.size() < device) image.resize(device, std::byte{0xFF});
    return image;
}

}  // namespace taktwerk::ecat
