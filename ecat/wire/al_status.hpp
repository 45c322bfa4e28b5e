#pragma once
// Application layer states and status codes: what a slave answers at 0130h and 0134h, in words.
// Source: ETG.1000.6 (states, codes), reference/ethercat-masters.md section 5.

#include <cstdint>
#include <span>
#include <string_view>

namespace taktwerk::ecat {

/// EtherCAT state machine; the values are those of AL control (0120h) and AL status (0130h) bits 3..0.
enum class AlState : std::uint8_t { unknown = 0, init = 1, preop = 2, boot = 3, safeop = 4, op = 8 };
/// "INIT", "PREOP", ...; "unknown" for any other value.
[[nodiscard]] std::string_view name(AlState state) noexcept;

inline constexpr std::uint16_t al_state_mask = 0x000F;           ///< state bits of 0120h and 0130h
inline constexpr std::uint16_t al_control_acknowledge = 0x0010;  ///< 0120h: acknowledges the error indication
inline constexpr std::uint16_t al_control_request_id = 0x0020;   ///< 0120h: asks for the device id in 0134h
inline constexpr std::uint16_t al_status_error = 0x0010;         ///< 0130h: a transition failed, 0134h says why
inline constexpr std::uint16_t al_status_id_valid = 0x0020;      ///< 0130h: 0134h holds the device id

/// State part of AL status; `unknown` for values the standard does not define.
[[nodiscard]] constexpr AlState al_state(std::uint16_t al_status) noexcept {
    switch (al_status & al_state_mask) {
        case 1: return AlState::init;
        case 2: return AlState::preop;
        case 3: return AlState::boot;
        case 4: return AlState::safeop;
        case 8: return AlState::op;
        default: return AlState::unknown;
    }
}

/// One AL status code. The strings live for ever.
struct AlStatusInfo {
    std::uint16_t code;
    std::string_view text;    ///< the standard's words
    std::string_view remedy;  ///< likely cause and what to do; may be empty
};

[[nodiscard]] std::span<const AlStatusInfo> al_status_codes() noexcept;  ///< ascending by code
/// The entry of `code`; for codes not in the table an entry with code 0xFFFF that says so (vendor codes begin at 8000h).
[[nodiscard]] const AlStatusInfo& al_status_info(std::uint16_t code) noexcept;

}  // namespace taktwerk::ecat
