#pragma once
// Why a file transfer is refused: the codes of FoE errors, in words. Source: ETG.1000.6 (FoE, error codes), ETG.1020.

#include <cstdint>
#include <string_view>

namespace taktwerk::ecat {

namespace foe_error {
inline constexpr std::uint32_t not_defined = 0x8000, not_found = 0x8001, access_denied = 0x8002, disk_full = 0x8003, illegal = 0x8004,
                               packet_number = 0x8005, already_exists = 0x8006, no_user = 0x8007, bootstrap_only = 0x8008,
                               not_bootstrap = 0x8009, no_rights = 0x800A, program_error = 0x800B, wrong_checksum = 0x800C,
                               wrong_firmware = 0x800D, no_file = 0x800F, no_file_header = 0x8010, flash_problem = 0x8011,
                               file_incompatible = 0x8012;
}  // namespace foe_error

/// The code as the standard writes it: some slaves leave out its highest bit (0001h for 8001h).
[[nodiscard]] constexpr std::uint32_t usual_foe_code(std::uint32_t code) noexcept { return code < 0x8000 ? code | 0x8000 : code; }

struct FoeErrorInfo {
    std::uint32_t code;
    std::string_view text;
    std::string_view remedy;  ///< may be empty
};
/// Of codes not in the table (vendors' own) an entry with code 0 that says so.
[[nodiscard]] const FoeErrorInfo& foe_error_info(std::uint32_t code) noexcept;

}  // namespace taktwerk::ecat
