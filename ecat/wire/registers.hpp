#pragma once
// The register map of an EtherCAT slave controller: addresses and bits; how a FMMU and a sync manager are laid out stands in mapping_units.hpp.
// Each line: length in bytes, meaning. Source: ETG.1000.4, reference/ethercat-masters.md section 5, SV33-E manual 6.2.4.

#include <cstdint>

#include "ecat/wire/mapping_units.hpp"

namespace taktwerk::ecat {

namespace reg {

// Information
inline constexpr std::uint16_t type = 0x0000;                ///< 1: type of controller
inline constexpr std::uint16_t revision = 0x0001;            ///< 1
inline constexpr std::uint16_t build = 0x0002;               ///< 2
inline constexpr std::uint16_t fmmu_count = 0x0004;          ///< 1
inline constexpr std::uint16_t sync_manager_count = 0x0005;  ///< 1
inline constexpr std::uint16_t ram_size = 0x0006;            ///< 1: KiB of process RAM
inline constexpr std::uint16_t port_descriptor = 0x0007;     ///< 1: 2 bits a port: 0 none, 1 not configured, 2 EBUS, 3 MII
inline constexpr std::uint16_t features = 0x0008;            ///< 2: see `feature`

// Addresses
inline constexpr std::uint16_t station_address = 0x0010;  ///< 2: configured address, for FP commands
inline constexpr std::uint16_t station_alias = 0x0012;    ///< 2: from SII word 4; answers only with dl_control_alias

// Write protection and reset
inline constexpr std::uint16_t write_register_enable = 0x0020;   ///< 1
inline constexpr std::uint16_t write_register_protect = 0x0021;  ///< 1
inline constexpr std::uint16_t write_enable = 0x0030;            ///< 1
inline constexpr std::uint16_t write_protect = 0x0031;           ///< 1
inline constexpr std::uint16_t reset_ecat = 0x0040;              ///< 1: 'R','E','S' in three frames resets the controller
inline constexpr std::uint16_t reset_pdi = 0x0041;               ///< 1: the same from the application's side

// Data link layer
inline constexpr std::uint16_t dl_control = 0x0100;          ///< 4: b0 forward only EtherCAT, b8.. loop modes, b24 alias enable
inline constexpr std::uint16_t dl_control_loops = 0x0101;    ///< 1: 2 bits a port: 0 auto, 1 auto close, 2 open, 3 closed
inline constexpr std::uint16_t dl_control_alias = 0x0103;    ///< 1: b0 the station alias answers to FP commands
inline constexpr std::uint16_t physical_rw_offset = 0x0108;  ///< 2
inline constexpr std::uint16_t dl_status = 0x0110;           ///< 2: see dl_port_open() and its neighbours

// Application layer: bits and states in ecat/wire/al_status.hpp
inline constexpr std::uint16_t al_control = 0x0120;        ///< 2
inline constexpr std::uint16_t al_status = 0x0130;         ///< 2
inline constexpr std::uint16_t al_status_code = 0x0134;    ///< 2
inline constexpr std::uint16_t run_led_override = 0x0138;  ///< 1
inline constexpr std::uint16_t err_led_override = 0x0139;  ///< 1

// Process data interface
inline constexpr std::uint16_t pdi_control = 0x0140;                 ///< 1: type of interface
inline constexpr std::uint16_t esc_configuration = 0x0141;           ///< 1: b2 DC SYNC unit, b3 DC latch unit present
inline constexpr std::uint16_t pdi_information = 0x014E;             ///< 2
inline constexpr std::uint16_t pdi_configuration = 0x0150;           ///< 1
inline constexpr std::uint16_t sync_latch_configuration = 0x0151;    ///< 1
inline constexpr std::uint16_t pdi_configuration_extended = 0x0152;  ///< 2

// Events
inline constexpr std::uint16_t ecat_event_mask = 0x0200;     ///< 2: which events show in the datagrams' IRQ field
inline constexpr std::uint16_t al_event_mask = 0x0204;       ///< 4
inline constexpr std::uint16_t ecat_event_request = 0x0210;  ///< 2
inline constexpr std::uint16_t al_event_request = 0x0220;    ///< 4

// Error counters: saturate at 255; writing anything clears the block they belong to
inline constexpr std::uint16_t rx_errors = 0x0300;               ///< 8: port p at +2p invalid frames, +2p+1 RX errors
inline constexpr std::uint16_t forwarded_rx_errors = 0x0308;     ///< 4: one a port
inline constexpr std::uint16_t processing_unit_errors = 0x030C;  ///< 1
inline constexpr std::uint16_t pdi_errors = 0x030D;              ///< 1
inline constexpr std::uint16_t pdi_error_code = 0x030E;          ///< 1
inline constexpr std::uint16_t lost_links = 0x0310;              ///< 4: one a port

// Watchdogs
inline constexpr std::uint16_t watchdog_divider = 0x0400;    ///< 2: 2498 -> 25 MHz / 2500 = 100 us a tick
inline constexpr std::uint16_t pdi_watchdog_time = 0x0410;   ///< 2: ticks; 0 off
inline constexpr std::uint16_t sm_watchdog_time = 0x0420;    ///< 2: ticks; 0 off; 1000 = 100 ms by default
inline constexpr std::uint16_t sm_watchdog_status = 0x0440;  ///< 2: b0 running well
inline constexpr std::uint16_t sm_watchdog_count = 0x0442;   ///< 1: expiries; any write clears
inline constexpr std::uint16_t pdi_watchdog_count = 0x0443;  ///< 1
inline constexpr std::uint16_t watchdog_divider_default = 2498;

// SII EEPROM
inline constexpr std::uint16_t eeprom_configuration = 0x0500;  ///< 1: 0 master owns, 1 PDI owns, 2 force release
inline constexpr std::uint16_t eeprom_pdi_access = 0x0501;     ///< 1
inline constexpr std::uint16_t eeprom_control = 0x0502;        ///< 2: see `eeprom`
inline constexpr std::uint16_t eeprom_address = 0x0504;        ///< 4: word address
inline constexpr std::uint16_t eeprom_data = 0x0508;           ///< 8: 4 or 8 bytes a read (eeprom::reads_8_bytes)

// MII management
inline constexpr std::uint16_t mii_control = 0x0510;       ///< 2: see `mii` (phy.hpp)
inline constexpr std::uint16_t mii_phy_address = 0x0512;   ///< 1
inline constexpr std::uint16_t mii_phy_register = 0x0513;  ///< 1
inline constexpr std::uint16_t mii_phy_data = 0x0514;      ///< 2
inline constexpr std::uint16_t mii_ecat_access = 0x0516;   ///< 1: b0 the master alone
inline constexpr std::uint16_t mii_pdi_access = 0x0517;    ///< 1: b0 the application has it, b1 the master takes it away
inline constexpr std::uint16_t mii_port_status = 0x0518;   ///< 4: one a port

// Tables: unit n at base + n * size
inline constexpr std::uint16_t fmmu = 0x0600;          ///< 16 each
inline constexpr std::uint16_t sync_manager = 0x0800;  ///< 8 each
[[nodiscard]] constexpr std::uint16_t fmmu_at(unsigned n) noexcept { return static_cast<std::uint16_t>(fmmu + 16 * n); }
[[nodiscard]] constexpr std::uint16_t sync_manager_at(unsigned n) noexcept { return static_cast<std::uint16_t>(sync_manager + 8 * n); }

// Distributed clocks: times in ns
inline constexpr std::uint16_t dc_receive_times = 0x0900;       ///< 16: 4 a port; writing 0900h latches all of them
inline constexpr std::uint16_t dc_system_time = 0x0910;         ///< 8: write = input of the drift control
inline constexpr std::uint16_t dc_receive_time_unit = 0x0918;   ///< 8: latched with 0900h, at the processing unit
inline constexpr std::uint16_t dc_system_offset = 0x0920;       ///< 8: local + offset = system time
inline constexpr std::uint16_t dc_system_delay = 0x0928;        ///< 4: propagation delay from the reference clock
inline constexpr std::uint16_t dc_difference = 0x092C;          ///< 4: bit 31 sign, rest magnitude (dc_difference_ns())
inline constexpr std::uint16_t dc_speed_start = 0x0930;         ///< 2: 1000h; writing it resets the drift control
inline constexpr std::uint16_t dc_difference_filter = 0x0934;   ///< 1
inline constexpr std::uint16_t dc_speed_filter = 0x0935;        ///< 1: 0Ch
inline constexpr std::uint16_t dc_receive_latch_mode = 0x0936;  ///< 1
inline constexpr std::uint16_t dc_cyclic_control = 0x0980;      ///< 1: b0 the application controls the cyclic unit (0 = the master)
inline constexpr std::uint16_t dc_activation = 0x0981;          ///< 1: b0 cyclic, b1 SYNC0, b2 SYNC1
inline constexpr std::uint16_t dc_pulse_length = 0x0982;        ///< 2: units of 10 ns; 0 = acknowledge mode
inline constexpr std::uint16_t dc_activation_status = 0x0984;   ///< 1
inline constexpr std::uint16_t dc_sync0_status = 0x098E;        ///< 1
inline constexpr std::uint16_t dc_sync1_status = 0x098F;        ///< 1
inline constexpr std::uint16_t dc_start_time = 0x0990;          ///< 8: system time of the first SYNC0
inline constexpr std::uint16_t dc_next_sync1 = 0x0998;          ///< 8
inline constexpr std::uint16_t dc_sync0_cycle = 0x09A0;         ///< 4
inline constexpr std::uint16_t dc_sync1_cycle = 0x09A4;         ///< 4: delta to SYNC0
inline constexpr std::uint16_t dc_latch0_control = 0x09A8;      ///< 1
inline constexpr std::uint16_t dc_latch1_control = 0x09A9;      ///< 1
inline constexpr std::uint16_t dc_latch0_status = 0x09AE;       ///< 1
inline constexpr std::uint16_t dc_latch1_status = 0x09AF;       ///< 1
inline constexpr std::uint16_t dc_latch0_positive = 0x09B0;     ///< 8
inline constexpr std::uint16_t dc_latch0_negative = 0x09B8;     ///< 8
inline constexpr std::uint16_t dc_latch1_positive = 0x09C0;     ///< 8
inline constexpr std::uint16_t dc_latch1_negative = 0x09C8;     ///< 8
inline constexpr std::uint16_t dc_buffer_change_time = 0x09F0;  ///< 4
inline constexpr std::uint16_t dc_pdi_buffer_start = 0x09F8;    ///< 4
inline constexpr std::uint16_t dc_pdi_buffer_change = 0x09FC;   ///< 4

// Vendor area and memory
inline constexpr std::uint16_t product_id = 0x0E00;       ///< 8
inline constexpr std::uint16_t vendor_id = 0x0E08;        ///< 8
inline constexpr std::uint16_t health = 0x0E10;           ///< 1
inline constexpr std::uint16_t digital_outputs = 0x0F00;  ///< 4
inline constexpr std::uint16_t gp_outputs = 0x0F10;       ///< 8
inline constexpr std::uint16_t gp_inputs = 0x0F18;        ///< 8
inline constexpr std::uint16_t user_ram = 0x0F80;         ///< 128
inline constexpr std::uint16_t process_ram = 0x1000;      ///< process data and mailboxes

}  // namespace reg

/// Bits of reg::features.
namespace feature {
inline constexpr std::uint16_t fmmu_not_bitwise = 1u << 0;
inline constexpr std::uint16_t dc = 1u << 2;
inline constexpr std::uint16_t dc_64bit = 1u << 3;
inline constexpr std::uint16_t enhanced_link_mii = 1u << 6;
inline constexpr std::uint16_t separate_fcs_count = 1u << 7;
inline constexpr std::uint16_t enhanced_dc_activation = 1u << 8;
inline constexpr std::uint16_t no_lrw = 1u << 9;
inline constexpr std::uint16_t no_read_write = 1u << 10;  ///< no BRW, APRW, FPRW
inline constexpr std::uint16_t fixed_fmmu_sm = 1u << 11;
}  // namespace feature

/// Bits of reg::eeprom_control.
namespace eeprom {
inline constexpr std::uint16_t write_enable = 1u << 0;
inline constexpr std::uint16_t emulated = 1u << 5;
inline constexpr std::uint16_t reads_8_bytes = 1u << 6;
inline constexpr std::uint16_t two_byte_address = 1u << 7;
inline constexpr std::uint16_t command_mask = 7u << 8;
inline constexpr std::uint16_t read = 1u << 8;
inline constexpr std::uint16_t write = 2u << 8;
inline constexpr std::uint16_t reload = 4u << 8;
inline constexpr std::uint16_t checksum_error = 1u << 11;
inline constexpr std::uint16_t not_loaded = 1u << 12;
inline constexpr std::uint16_t command_error = 1u << 13;
inline constexpr std::uint16_t write_enable_error = 1u << 14;
inline constexpr std::uint16_t busy = 1u << 15;
inline constexpr std::uint16_t errors = checksum_error | not_loaded | command_error | write_enable_error;
}  // namespace eeprom

/// Bits of reg::dc_activation.
namespace dc_activate {
inline constexpr std::uint8_t cyclic = 1u << 0;
inline constexpr std::uint8_t sync0 = 1u << 1;
inline constexpr std::uint8_t sync1 = 1u << 2;
}  // namespace dc_activate

// reg::dl_status, port 0..3
inline constexpr std::uint16_t dl_pdi_operational = 1u << 0;
inline constexpr std::uint16_t dl_pdi_watchdog_ok = 1u << 1;
[[nodiscard]] constexpr bool dl_physical_link(std::uint16_t dl_status, unsigned port) noexcept {
    return ((dl_status >> (4 + port)) & 1u) != 0;
}
[[nodiscard]] constexpr bool dl_loop_closed(std::uint16_t dl_status, unsigned port) noexcept {
    return ((dl_status >> (8 + 2 * port)) & 1u) != 0;
}
[[nodiscard]] constexpr bool dl_signal(std::uint16_t dl_status, unsigned port) noexcept {
    return ((dl_status >> (9 + 2 * port)) & 1u) != 0;
}
/// Another slave (or the master) talks there: a signal, and the loop is not closed. The physical-link bit says less: it is
/// also set towards a neighbour without power at its controller.
[[nodiscard]] constexpr bool dl_port_open(std::uint16_t dl_status, unsigned port) noexcept {
    return dl_signal(dl_status, port) && !dl_loop_closed(dl_status, port);
}

/// reg::dc_difference is sign and magnitude. Nanoseconds; positive: the local copy is ahead of the received reference time.
[[nodiscard]] constexpr std::int32_t dc_difference_ns(std::uint32_t raw) noexcept {
    const auto magnitude = static_cast<std::int32_t>(raw & 0x7FFF'FFFFu);
    return (raw & 0x8000'0000u) != 0 ? -magnitude : magnitude;
}

}  // namespace taktwerk::ecat
