#include "ecat/eeprom/sii_names.hpp"

#include <array>
#include <span>

#include <fmt/format.h>

namespace taktwerk::ecat {

namespace {

std::vector<std::string> names_of_bits(unsigned bits, std::span<const std::string_view> names) {
    std::vector<std::string> out;
    for (std::size_t n = 0; n < names.size(); ++n)
        if ((bits & (1u << n)) != 0) out.emplace_back(names[n]);
    return out;
}

}  // namespace

std::string sii_category_name(std::uint16_t type) {
    switch (type) {
        case sii_category::nop: return "filling";
        case sii_category::strings: return "strings";
        case sii_category::data_types: return "data types";
        case sii_category::general: return "general";
        case sii_category::fmmu: return "FMMUs";
        case sii_category::sync_manager: return "sync managers";
        case sii_category::fmmu_extension: return "FMMU extensions";
        case sii_category::sync_unit: return "sync units";
        case sii_category::tx_pdo: return "TxPDOs";
        case sii_category::rx_pdo: return "RxPDOs";
        case sii_category::dc: return "clock modes";
        default: return fmt::format("category {}", type);
    }
}

std::string_view name(SiiSyncManagerUse use) noexcept {
    switch (use) {
        case SiiSyncManagerUse::unused: return "unused";
        case SiiSyncManagerUse::mailbox_out: return "mailbox out";
        case SiiSyncManagerUse::mailbox_in: return "mailbox in";
        case SiiSyncManagerUse::outputs: return "outputs";
        case SiiSyncManagerUse::inputs: return "inputs";
    }
    return "unknown";
}

std::string_view name(SiiFmmuUse use) noexcept {
    switch (use) {
        case SiiFmmuUse::unused: return "unused";
        case SiiFmmuUse::outputs: return "outputs";
        case SiiFmmuUse::inputs: return "inputs";
        case SiiFmmuUse::mailbox_status: return "mailbox status";
    }
    return "unknown";
}

std::vector<std::string> sii_protocol_names(std::uint16_t protocols) {
    constexpr std::array<std::string_view, 6> names{"AoE", "EoE", "CoE", "FoE", "SoE", "VoE"};
    return names_of_bits(protocols, names);
}

std::vector<std::string> sii_coe_names(std::uint8_t details) {
    constexpr std::array<std::string_view, 6> names{
        "SDO", "SDO information", "PDO assignment", "PDO configuration", "PDO upload at start", "complete access"};
    return names_of_bits(details, names);
}

std::string sii_ports_text(std::uint16_t ports) {
    constexpr std::array<std::string_view, 5> kinds{"", "MII", "", "E-bus", "fast hot connect"};
    std::string text;
    for (unsigned p = 0; p < 4; ++p) {
        const unsigned kind = (ports >> (4 * p)) & 0xFu;
        if (kind == 0) continue;
        const std::string word = kind < kinds.size() && !kinds[kind].empty() ? std::string{kinds[kind]} : fmt::format("kind {}", kind);
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", p, word);
    }
    return text;
}

}  // namespace taktwerk::ecat
