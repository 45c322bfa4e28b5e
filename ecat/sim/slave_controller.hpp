#pragma once
// The hardware of a simulated slave: an EtherCAT slave controller as the bus sees it (registers, FMMUs, sync managers, DC,
// EEPROM interface, watchdogs) and as the application behind it sees it (the `application side` below). It knows nothing of
// states, objects or drives. Datagrams change it only through execute(); machine time only through fire().
// Real-time safe except construction and power_on(). Source: ETG.1000.4, SV33-E manual 6.2.4.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "ecat/sim/dc_clock.hpp"
#include "ecat/sim/ecat_event.hpp"
#include "ecat/sim/eeprom_interface.hpp"
#include "ecat/sim/frame_keys.hpp"
#include "ecat/sim/mii_interface.hpp"
#include "ecat/sim/ports.hpp"
#include "ecat/sim/sync_signals.hpp"
#include "ecat/sim/temporary_loops.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat::sim {

inline constexpr Instant never = Instant::max();

struct ControllerSettings {
    std::uint8_t fmmus = 8, sync_managers = 8;  ///< 1..16 each
    std::uint16_t process_ram = 0x1000;         ///< bytes from 1000h
    bool dc = true, dc_64bit = true;
    bool lrw = true;                ///< executes LRW; without, such a datagram passes unchanged
    bool read_write = true;         ///< executes APRW, FPRW and BRW
    bool bitwise_fmmu = true;       ///< FMMUs map bits; without, their bit fields are ignored: whole bytes
    bool application = true;        ///< a processor behind it serves the PDI and feeds the PDI watchdog
    std::uint8_t sockets = 0b0011;  ///< bit p: port p exists; IN and OUT
    std::uint8_t ebus = 0;          ///< bit p: port p is an E-bus connector, without a PHY
};

/// What happened since the application last asked.
namespace event {
inline constexpr unsigned al_control = 1u << 0;  ///< 0120h was written
inline constexpr unsigned outputs = 1u << 1;     ///< a buffered sync manager got new data
inline constexpr unsigned mailbox_written = 1u << 2;
inline constexpr unsigned mailbox_read = 1u << 3;
inline constexpr unsigned repeat_request = 1u << 4;
inline constexpr unsigned inputs_read = 1u << 5;  ///< a buffered sync manager was read
inline constexpr unsigned watchdog = 1u << 6;     ///< the SM watchdog ran out
inline constexpr unsigned sync0 = 1u << 7;
inline constexpr unsigned sync1 = 1u << 8;
inline constexpr unsigned sync_manager_switched = 1u << 9;  ///< a sync manager was turned on or off
inline constexpr unsigned reset = 1u << 10;                 ///< 'R', 'E', 'S' at 0040h: everything starts anew
}  // namespace event

/// Whether a sync manager may lie there: in the RAM, or on the output pins of a terminal without a processor (0F00h to 0F03h).
[[nodiscard]] bool holds_process_data(std::uint32_t address, std::size_t size) noexcept;

class SlaveController {
public:
    SlaveController(const ControllerSettings& settings, EepromInterface eeprom);

    /// Registers at their reset values, EEPROM words loaded, the DC quartz running from `local` with `drift_ppb`.
    void power_on(Instant now, std::int64_t local, std::int32_t drift_ppb);

    // --- bus side --------------------------------------------------------------------------------------------------------
    /// A frame begins: what the last one unlocked (0020h, 0030h) is locked again.
    void begin_frame() noexcept { keys_.begin_frame(); }
    /// One datagram passes; `at` is when the start of its frame arrived here.
    void execute(MutableDatagram& datagram, Instant at) noexcept;
    /// The frame is through: completes the receive time latch. It arrived at port p at `sent` + `arrival[p]` where bit p of
    /// `arrives` is set.
    void frame_passed(Instant sent, std::span<const Duration, ports_per_slave> arrival, std::uint8_t arrives) noexcept;
    /// Bit p: port p has a neighbour with power.
    void set_links(std::uint8_t links) noexcept;
    [[nodiscard]] Ports& ports() noexcept { return ports_; }
    [[nodiscard]] const Ports& ports() const noexcept { return ports_; }
    /// A write to DL control moved a loop since the last call: frames take another way from now on.
    [[nodiscard]] bool take_loop_change() noexcept { return std::exchange(loop_changed_, false); }
    /// The controller has port p (a cable goes into it).
    void add_socket(unsigned p) noexcept;
    /// Noise on the cable: the frame that came in at port p has a wrong checksum (and invalid symbols) here first, or had it already.
    void count_receive_error(unsigned p) noexcept;
    void count_forwarded_error(unsigned p) noexcept;
    /// A frame with a good checksum whose datagrams make no sense.
    void count_processing_unit_error() noexcept { count_error(reg::processing_unit_errors); }

    // --- time --------------------------------------------------------------------------------------------------------------
    [[nodiscard]] Instant next_event() const noexcept;
    /// Does what is due at `now` (EEPROM, watchdog, SYNC0) and reports it as events.
    void fire(Instant now) noexcept;

    // --- application side ---------------------------------------------------------------------------------------------------
    [[nodiscard]] unsigned take_events() noexcept { return std::exchange(events_, 0u); }
    /// What the master asked for. Until the application has taken it, another write to 0120h is refused.
    [[nodiscard]] std::uint16_t take_al_control() noexcept {
        al_control_waits_ = false;
        return read16(reg::al_control);
    }
    void set_al_status(std::uint16_t status, std::uint16_t code) noexcept;
    [[nodiscard]] const SyncManager& sync_manager(unsigned n) const noexcept { return units_[n].sm; }
    /// PDI control bit 0: the application locks a sync manager; the bus then gets no access to its memory.
    void lock_sync_manager(unsigned n, bool locked) noexcept;
    /// Mailbox from the master: its bytes while full, empty span else. empty_mailbox() frees it.
    [[nodiscard]] std::span<const std::byte> full_mailbox(unsigned n) const noexcept;
    void empty_mailbox(unsigned n) noexcept;
    [[nodiscard]] bool mailbox_full(unsigned n) const noexcept { return units_[n].full; }
    /// Puts a message into a mailbox to the master; false while the last one was not read.
    bool fill_mailbox(unsigned n, std::span<const std::byte> message) noexcept;
    [[nodiscard]] bool repeat_requested(unsigned n) const noexcept;  ///< request differs from acknowledge
    void acknowledge_repeat(unsigned n) noexcept;
    /// The newest complete outputs of a buffered sync manager.
    [[nodiscard]] std::span<const std::byte> outputs(unsigned n) const noexcept;
    /// Outputs that arrived since the last call.
    [[nodiscard]] bool take_fresh(unsigned n) noexcept;
    void clear_outputs(unsigned n) noexcept;
    /// Where the application puts its inputs; publish_inputs() when they are complete.
    [[nodiscard]] std::span<std::byte> inputs(unsigned n) noexcept;
    void publish_inputs(unsigned n) noexcept;
    /// Restarts the SM watchdog, as the first outputs do.
    void start_watchdog(Instant now) noexcept;
    void stop_watchdog() noexcept;
    [[nodiscard]] bool watchdog_configured() const noexcept;
    /// The processor behind the PDI works, or hangs: then the PDI watchdog (0410h) runs out.
    void set_application_alive(bool alive, Instant now) noexcept;
    /// The application takes or gives back the EEPROM (0501h); false: the master has not offered it (0500h bit 0).
    bool take_eeprom(bool take) noexcept;
    /// An edge or level at a latch input (n: 0, 1).
    void set_latch_input(unsigned n, bool level, Instant at) noexcept;

    /// The pulse generator; SYNC0 itself is out only when 0981h says so.
    [[nodiscard]] const Sync0& sync0() const noexcept { return sync0_; }
    [[nodiscard]] const Sync1& sync1() const noexcept { return sync1_; }
    [[nodiscard]] bool sync0_active() const noexcept { return sync0_.active() && sync_is_out(dc_activate::sync0); }
    [[nodiscard]] bool sync0_runs() const noexcept { return sync0_.runs() && sync_is_out(dc_activate::sync0); }
    // --- for tests and faults -----------------------------------------------------------------------------------------------
    /// The quartz runs fast by so much from now on.
    void set_clock_drift(double ppm, Instant now) noexcept;
    /// The local time jumps: pulses that were due in between are lost.
    void step_clock(Duration by, Instant now) noexcept;
    void forget_station_address() noexcept { write16(reg::station_address, 0); }

    [[nodiscard]] DcClock& clock() noexcept { return clock_; }
    [[nodiscard]] EepromInterface& eeprom() noexcept { return eeprom_; }
    [[nodiscard]] MiiInterface& phys() noexcept { return mii_; }
    [[nodiscard]] const ControllerSettings& settings() const noexcept { return settings_; }
    [[nodiscard]] std::uint16_t station_address() const noexcept { return read16(reg::station_address); }

    /// What a register or memory byte holds, for tests; time-dependent registers as last refreshed.
    [[nodiscard]] std::byte peek(std::uint16_t address) const noexcept { return memory_[address]; }

private:
    struct Unit {
        SyncManager sm;
        bool full = false;                       // mailbox
        bool opened = false;                     // the first byte was touched, the last not yet
        bool fresh = false;                      // buffered, outputs not yet taken by the application
        bool written = false, was_read = false;  // status bits 0 and 1: since the other side last began
        std::uint8_t buffer = 3;                 // the one written last; 3: none yet
        [[nodiscard]] bool governs(std::uint32_t address) const noexcept {
            return sm.enabled() && address >= sm.start && address < std::uint32_t{sm.start} + sm.length;
        }
    };

    // slave_controller.cpp
    bool read(std::uint32_t address, std::span<std::byte> out, Instant at) noexcept;
    bool write(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept;
    void exchange_physical(MutableDatagram& datagram, bool addressed, Instant at) noexcept;
    void add_to_counter(MutableDatagram& datagram, unsigned increment) noexcept;

    // slave_controller_fmmu.cpp
    void exchange_logical(MutableDatagram& datagram, Instant at) noexcept;
    bool map_write(const Fmmu& fmmu, std::uint32_t logical, std::span<const std::byte> data, Instant at) noexcept;
    bool map_read(const Fmmu& fmmu, std::uint32_t logical, std::span<std::byte> data, Instant at) noexcept;

    // slave_controller_memory.cpp: sync managers
    bool read_memory(std::uint32_t address, std::span<std::byte> out) noexcept;
    bool write_memory(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept;
    bool governed_read(unsigned n, std::uint32_t address, std::span<std::byte> out) noexcept;
    bool governed_write(unsigned n, std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept;
    [[nodiscard]] std::optional<unsigned> governor(std::uint32_t address) const noexcept;
    [[nodiscard]] std::size_t ungoverned_run(std::uint32_t address, std::size_t size) const noexcept;
    void write_sync_manager_registers(std::uint32_t address, std::span<const std::byte> in) noexcept;
    void show_sync_manager(unsigned n) noexcept;
    void reset_unit(unsigned n) noexcept;

    // slave_controller_ports.cpp: data link layer
    void write_dl_control(std::uint8_t modes_before, Instant at) noexcept;
    void move_loops(std::uint8_t modes) noexcept;
    void show_ports() noexcept;
    void show_sockets() noexcept;
    void count_error(std::uint16_t counter) noexcept;

    // slave_controller_dc.cpp
    void write_dc(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept;
    void control_sync(Instant at) noexcept;
    void clock_moved(Instant now) noexcept;
    void show_dc(Instant at) noexcept;
    void fire_sync(Instant now) noexcept;
    void latch_times_read(std::uint32_t address, std::size_t size) noexcept;
    [[nodiscard]] bool sync_is_out(std::uint8_t bit) const noexcept {
        return (static_cast<unsigned>(memory_[reg::dc_activation]) & bit) != 0;
    }

    // slave_controller_registers.cpp
    [[nodiscard]] bool write_allowed(std::uint32_t address) const noexcept;
    void start_pdi_watchdog(Instant now) noexcept;
    [[nodiscard]] Duration watchdog_ticks(std::uint16_t ticks_register) const noexcept;
    bool read_registers(std::uint32_t address, std::span<std::byte> out, Instant at) noexcept;
    bool write_registers(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept;
    void write_eeprom(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept;
    void show_eeprom() noexcept;
    void write_mii(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept;
    void show_mii() noexcept;
    void load_configuration_words() noexcept;
    void set_event_request(std::uint16_t bits, bool on) noexcept;

    [[nodiscard]] std::uint16_t read16(std::uint16_t address) const noexcept;
    void write16(std::uint16_t address, std::uint16_t value) noexcept;

    ControllerSettings settings_;
    EepromInterface eeprom_;
    MiiInterface mii_;
    std::vector<std::byte> memory_;       // registers and process RAM as the bus sees them
    std::vector<std::byte> application_;  // buffered outputs as the application sees them, same addresses
    std::array<Unit, 16> units_{};
    std::array<Fmmu, 16> fmmus_{};
    DcClock clock_;
    Sync0 sync0_;
    Sync1 sync1_;
    std::array<std::byte, 8> start_time_{};  // 0990h as written; it reads as the next pulse
    std::array<bool, 2> latch_level_{};
    Ports ports_;
    bool loop_changed_ = false;
    TemporaryLoops temporary_loops_;
    Instant latched_at_{};  // at the processing unit
    bool latch_pending_ = false;
    Instant watchdog_deadline_ = never;
    Instant pdi_watchdog_deadline_ = never;
    bool application_alive_ = true;
    bool al_control_waits_ = false;
    FrameKeys keys_;
    Instant sync0_due_ = never, sync1_due_ = never;
    unsigned events_ = 0;
};

}  // namespace taktwerk::ecat::sim
