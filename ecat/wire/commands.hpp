#pragma once
// EtherCAT datagram commands and sizes. Source: ETG.1000.4.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace taktwerk::ecat {

enum class Command : std::uint8_t {
    NOP = 0,
    APRD = 1,
    APWR = 2,
    APRW = 3,
    FPRD = 4,
    FPWR = 5,
    FPRW = 6,
    BRD = 7,
    BWR = 8,
    BRW = 9,
    LRD = 10,
    LWR = 11,
    LRW = 12,
    ARMW = 13,
    FRMW = 14,
};
[[nodiscard]] std::string_view name(Command command) noexcept;

/// ADP says which slave along the line: the one that sees 0 answers.
[[nodiscard]] constexpr bool goes_by_position(Command command) noexcept {
    return command == Command::APRD || command == Command::APWR || command == Command::APRW || command == Command::ARMW;
}
/// Slaves increment ADP of these as the datagram passes.
[[nodiscard]] constexpr bool counts_slaves(Command command) noexcept {
    return goes_by_position(command) || command == Command::BRD || command == Command::BWR || command == Command::BRW;
}

inline constexpr std::uint16_t ethertype = 0x88A4;
inline constexpr std::size_t ethernet_header_size = 14;
inline constexpr std::size_t ecat_header_size = 2;
inline constexpr std::size_t datagram_header_size = 10;
inline constexpr std::size_t working_counter_size = 2;
inline constexpr std::size_t datagram_overhead = datagram_header_size + working_counter_size;
inline constexpr std::size_t min_frame_size = 60;    ///< without FCS; shorter frames are padded
inline constexpr std::size_t max_frame_size = 1514;  ///< without FCS
inline constexpr std::size_t max_datagram_data = 1486;

/// Where a datagram goes: position or station address plus register offset, or a 32-bit logical address.
struct Address {
    std::uint32_t raw = 0;
    [[nodiscard]] static constexpr Address physical(std::uint16_t adp, std::uint16_t ado) noexcept {
        return {static_cast<std::uint32_t>(adp) | (static_cast<std::uint32_t>(ado) << 16)};
    }
    /// The slave at `position` (0 = first) sees ADP 0.
    [[nodiscard]] static constexpr Address position(std::uint16_t pos, std::uint16_t ado) noexcept {
        return physical(static_cast<std::uint16_t>(0u - pos), ado);
    }
    [[nodiscard]] static constexpr Address logical(std::uint32_t address) noexcept { return {address}; }
    [[nodiscard]] constexpr std::uint16_t adp() const noexcept { return static_cast<std::uint16_t>(raw & 0xFFFFu); }
    [[nodiscard]] constexpr std::uint16_t ado() const noexcept { return static_cast<std::uint16_t>(raw >> 16); }
    friend constexpr bool operator==(Address, Address) = default;
};

}  // namespace taktwerk::ecat
