#pragma once
// The slave information image (SII) in a slave's EEPROM: parsing whatever is there, and building one for simulated slaves.
// Not for the cycle (allocates). Source: ETG.1000.6 / ETG.2010, reference/ethercat-masters.md section 5.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ecat/wire/identity.hpp"

namespace taktwerk::ecat {

/// Word addresses of the fixed part.
namespace sii_word {
inline constexpr std::uint16_t pdi_control = 0x00, pdi_configuration = 0x01, sync_pulse_length = 0x02, pdi_configuration_extended = 0x03;
inline constexpr std::uint16_t alias = 0x04, pdi_configuration_more = 0x05, checksum = 0x07;
inline constexpr std::uint16_t vendor = 0x08, product = 0x0A, revision = 0x0C, serial = 0x0E;
inline constexpr std::uint16_t execution_delay = 0x10, port0_delay = 0x11, port1_delay = 0x12;
inline constexpr std::uint16_t boot_mailbox_out = 0x14, boot_mailbox_in = 0x16;  ///< start, then size in the next word
inline constexpr std::uint16_t mailbox_out = 0x18, mailbox_in = 0x1A;            ///< start, then size in the next word
inline constexpr std::uint16_t mailbox_protocols = 0x1C;
inline constexpr std::uint16_t size = 0x3E, version = 0x3F;
inline constexpr std::uint16_t categories = 0x40;  ///< type, length in words, data; and again until sii_category::end
}  // namespace sii_word

inline constexpr std::size_t sii_header_bytes = std::size_t{2} * sii_word::categories;

namespace sii_category {
inline constexpr std::uint16_t nop = 0, strings = 10, data_types = 20, general = 30, fmmu = 40, sync_manager = 41, fmmu_extension = 42,
                               sync_unit = 43, tx_pdo = 50, rx_pdo = 51, dc = 60, end = 0xFFFF;
}  // namespace sii_category

/// Bits of Sii::mailbox_protocols.
namespace sii_protocol {
inline constexpr std::uint16_t aoe = 1u << 0, eoe = 1u << 1, coe = 1u << 2, foe = 1u << 3, soe = 1u << 4, voe = 1u << 5;
}  // namespace sii_protocol

/// Bits of SiiGeneral::coe_details.
namespace sii_coe {
inline constexpr std::uint8_t sdo = 1u << 0, sdo_info = 1u << 1, pdo_assign = 1u << 2, pdo_configuration = 1u << 3,
                              upload_at_startup = 1u << 4, complete_access = 1u << 5;
}  // namespace sii_coe

/// Content that Sii keeps field by field; other categories (data types, sync units, vendors' own) it only names.
[[nodiscard]] constexpr bool is_decoded(std::uint16_t category) noexcept {
    switch (category) {
        case sii_category::strings:
        case sii_category::general:
        case sii_category::fmmu:
        case sii_category::sync_manager:
        case sii_category::fmmu_extension:
        case sii_category::tx_pdo:
        case sii_category::rx_pdo:
        case sii_category::dc: return true;
        default: return false;
    }
}

/// Bits of SiiGeneral::flags (ETG.2010, category 30).
namespace sii_flag {
inline constexpr std::uint8_t enable_safeop = 1u << 0, no_lrw = 1u << 1, mailbox_data_link_layer = 1u << 2;
inline constexpr std::uint8_t id_in_al_status = 1u << 3;  ///< explicit device identification through AL control bit 5 (ETG.1020)
inline constexpr std::uint8_t id_in_memory = 1u << 4;     ///< it stands at SiiGeneral::id_address
}  // namespace sii_flag

struct SiiMailbox {
    std::uint16_t start = 0, size = 0;
    friend bool operator==(const SiiMailbox&, const SiiMailbox&) = default;
};

/// String fields are numbers into Sii::strings, 1-based; 0 = none.
struct SiiGeneral {
    std::uint8_t group = 0, image = 0, order = 0, name = 0;
    std::uint8_t coe_details = 0, foe_details = 0, eoe_details = 0;
    std::uint8_t soe_channels = 0, ds402_channels = 0, sysman_class = 0;
    std::uint8_t flags = 0;            ///< sii_flag
    std::int16_t ebus_current = 0;     ///< mA; negative: supplies
    std::uint16_t physical_ports = 0;  ///< 4 bits a port: 1 MII, 3 EBUS
    std::uint16_t id_address = 0;      ///< of the register or memory that holds the device's id; sii_flag::id_in_memory
    friend bool operator==(const SiiGeneral&, const SiiGeneral&) = default;
};

enum class SiiFmmuUse : std::uint8_t { unused = 0, outputs = 1, inputs = 2, mailbox_status = 3 };
enum class SiiSyncManagerUse : std::uint8_t { unused = 0, mailbox_out = 1, mailbox_in = 2, outputs = 3, inputs = 4 };

struct SiiSyncManager {
    std::uint16_t start = 0, length = 0;
    std::uint8_t control = 0, status = 0;
    std::uint8_t enable = 1;  ///< b0 enabled, b1 fixed content, b2 virtual, b3 opens only in OP
    SiiSyncManagerUse use = SiiSyncManagerUse::unused;
    friend bool operator==(const SiiSyncManager&, const SiiSyncManager&) = default;
};

struct SiiPdoEntry {
    std::uint16_t index = 0;  ///< 0 = gap
    std::uint8_t sub = 0, name = 0;
    std::uint8_t data_type = 0;  ///< CoE type number
    std::uint8_t bits = 0;
    std::uint16_t flags = 0;
    friend bool operator==(const SiiPdoEntry&, const SiiPdoEntry&) = default;
};

struct SiiPdo {
    static constexpr std::uint8_t not_assigned = 0xFF;
    std::uint16_t index = 0;
    std::uint8_t sync_manager = not_assigned;
    std::uint8_t synchronization = 0, name = 0;
    std::uint16_t flags = 0;  ///< b0 mandatory, b4 fixed content
    std::vector<SiiPdoEntry> entries;
    [[nodiscard]] std::size_t bits() const noexcept;
    friend bool operator==(const SiiPdo&, const SiiPdo&) = default;
};

/// Where the vendor wants an FMMU (ETG.2010, category 42).
struct SiiFmmuExtension {
    std::uint8_t flags = 0;  ///< b0 active only in OP
    std::uint8_t sync_manager = 0, sync_unit = 0;
    friend bool operator==(const SiiFmmuExtension&, const SiiFmmuExtension&) = default;
};

/// One way to run the slave with distributed clocks (ETG.2010, category 60). Times in ns; 0: the master chooses.
struct SiiDcMode {
    std::uint32_t sync0_cycle = 0;
    std::int32_t sync0_shift = 0, sync1_shift = 0;
    std::int16_t sync1_factor = 0;      ///< SYNC1 in SYNC0 cycles
    std::uint16_t assign_activate = 0;  ///< 0980h/0981h: 0300h SYNC0, 0700h SYNC0 and SYNC1, 0000h without
    std::int16_t sync0_factor = 0;      ///< SYNC0 in bus cycles
    std::uint8_t name = 0, description = 0;
    friend bool operator==(const SiiDcMode&, const SiiDcMode&) = default;
};

/// A category that is not decoded here: data types, sync units, vendors' own.
struct SiiOtherCategory {
    std::uint16_t type = 0;
    std::vector<std::byte> data;
    friend bool operator==(const SiiOtherCategory&, const SiiOtherCategory&) = default;
};

/// What is wrong with an image. None of it keeps the rest from being read.
enum class SiiDefect : std::uint8_t {
    empty,               ///< all words are 0000h or FFFFh
    truncated_header,    ///< shorter than 64 words
    bad_checksum,        ///< word 7 does not match words 0..6
    truncated_category,  ///< a category reaches beyond the image; the part that is there was read
    no_end,              ///< the image ends without the end marker
    bad_strings,         ///< the string table does not hold as many strings as it says
    bad_general,
    bad_sync_managers,
    bad_pdo,     ///< the category's length does not fit its content
    bad_dc,      ///< the clock category is not a multiple of 24 bytes
    unreadable,  ///< reading it broke off: the rest is missing (parse_sii never says this, who reads the EEPROM does)
};
[[nodiscard]] std::string_view text(SiiDefect defect) noexcept;

/// Everything the image says.
struct Sii {
    std::uint16_t pdi_control = 0, pdi_configuration = 0, sync_pulse_length = 0, pdi_configuration_extended = 0;
    std::uint16_t alias = 0;
    std::array<std::uint16_t, 2> pdi_configuration_more{};  ///< words 5 and 6, which newer controllers load, too
    Identity identity;
    std::array<std::uint16_t, 3> delays{};  ///< execution, port 0, port 1: words 10h to 12h
    SiiMailbox boot_mailbox_out, boot_mailbox_in;
    SiiMailbox mailbox_out, mailbox_in;  ///< out: master to slave
    std::uint16_t mailbox_protocols = 0;
    std::uint16_t size_code = 0;  ///< EEPROM size in kbit - 1
    std::uint16_t version = 1;
    std::vector<std::string> strings;  ///< string n stands at n - 1
    std::optional<SiiGeneral> general;
    std::vector<SiiFmmuUse> fmmus;  ///< in FMMU order
    std::vector<SiiSyncManager> sync_managers;
    std::vector<SiiPdo> tx_pdos, rx_pdos;  ///< tx: slave to master
    std::vector<SiiFmmuExtension> fmmu_extensions;
    std::vector<SiiDcMode> dc_modes;
    std::vector<SiiOtherCategory> others;  ///< those that are not decoded here; read_whole_sii() leaves their bytes 0
    std::vector<SiiDefect> defects;        ///< of a parsed image
    friend bool operator==(const Sii&, const Sii&) = default;

    [[nodiscard]] bool has(SiiDefect defect) const noexcept;
    /// String `number` (1-based); empty for 0 and for numbers beyond the table.
    [[nodiscard]] std::string_view string(std::uint8_t number) const noexcept;
    /// Appends a string unless it is there; returns its number (0 for an empty one or a full table).
    std::uint8_t add_string(std::string_view string);
};

/// CRC-8 (polynomial 07h, start FFh) over the first 14 bytes: low byte of word 7. `image` has at least 14 bytes.
[[nodiscard]] std::uint8_t sii_checksum(std::span<const std::byte> image) noexcept;

/// Reads any bytes: broken, truncated and empty images give what is there, and `defects`.
[[nodiscard]] Sii parse_sii(std::span<const std::byte> image);

/// A category as it lies in an image.
struct SiiCategoryPlace {
    std::uint16_t type = 0;
    std::size_t word = 0;   ///< of its content, behind type and length
    std::size_t words = 0;  ///< of content that is there
    friend bool operator==(const SiiCategoryPlace&, const SiiCategoryPlace&) = default;
};
/// All of them in the order of the image, without the end marker. Any bytes.
[[nodiscard]] std::vector<SiiCategoryPlace> sii_categories(std::span<const std::byte> image);

/// The image of `sii`, padded with FFh to `sii.size_code` (at least to its content). Strings are cut at 255 bytes.
/// parse_sii() of it gives the same fields; categories stand in an order of ours, those in `others` last.
[[nodiscard]] std::vector<std::byte> build_sii(const Sii& sii);

}  // namespace taktwerk::ecat
