// Registers 0000h..0FFFh: what the bus may write, and what a write sets off.

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

namespace {

struct Range {
    std::uint32_t first, size;
};

/// Plain read/write registers: a write is stored, nothing else happens at once.
constexpr Range stored[] = {
    {reg::station_address, 2},    {reg::write_register_enable, 2},
    {reg::write_enable, 2},       {reg::dl_control, 4},
    {reg::physical_rw_offset, 2}, {reg::al_control, 2},
    {reg::ecat_event_mask, 2},    {reg::watchdog_divider, 2},
    {reg::pdi_watchdog_time, 2},  {reg::sm_watchdog_time, 2},
    {reg::gp_outputs, 8},         {reg::user_ram, 128},
};
constexpr std::uint32_t dc_unit = 0x0900, dc_unit_end = 0x0A00;
constexpr std::uint32_t protected_end = 0x0F80;             // 0021h guards the registers below
constexpr std::uint8_t protect = 0x01;                      // bit 0 of 0021h and 0031h
constexpr unsigned pdi_takes = 0x01, force_release = 0x02;  // 0500h; bit 0 of 0501h: the application has it

constexpr bool overlaps(std::uint32_t address, std::size_t size, std::uint32_t first, std::uint32_t length) noexcept {
    return address < first + length && first < address + size;
}

}  // namespace

void SlaveController::power_on(Instant now, std::int64_t local, std::int32_t drift_ppb) {
    std::fill(memory_.begin(), memory_.end(), std::byte{0});
    std::fill(application_.begin(), application_.end(), std::byte{0});
    units_ = {};
    fmmus_ = {};
    sync0_ = Sync0{};
    sync1_ = Sync1{};
    start_time_ = {};
    sync0_due_ = sync1_due_ = watchdog_deadline_ = pdi_watchdog_deadline_ = never;
    application_alive_ = true;
    al_control_waits_ = false;
    keys_.power_on();
    latch_pending_ = false;
    events_ = 0;
    ports_.power_on();
    loop_changed_ = true;  // whoever keeps the wiring tells the links anew
    temporary_loops_.end();
    clock_.power_on(now, local, drift_ppb);

    memory_[reg::type] = std::byte{0x11};  // ET1100-like
    memory_[reg::fmmu_count] = static_cast<std::byte>(settings_.fmmus);
    memory_[reg::sync_manager_count] = static_cast<std::byte>(settings_.sync_managers);
    memory_[reg::ram_size] = static_cast<std::byte>(settings_.process_ram / 1024);
    show_sockets();
    show_ports();
    write16(reg::features,
            static_cast<std::uint16_t>((settings_.dc ? feature::dc : 0) | (settings_.dc && settings_.dc_64bit ? feature::dc_64bit : 0) |
                                       (settings_.lrw ? 0 : feature::no_lrw) | (settings_.read_write ? 0 : feature::no_read_write) |
                                       (settings_.bitwise_fmmu ? 0 : feature::fmmu_not_bitwise) | feature::separate_fcs_count));
    write16(reg::dl_control, 0x0001);
    write16(reg::al_control, 1);
    write16(reg::al_status, 1);
    write16(reg::watchdog_divider, reg::watchdog_divider_default);
    write16(reg::pdi_watchdog_time, 1000);
    write16(reg::sm_watchdog_time, 1000);
    if (settings_.dc) {
        write16(reg::dc_speed_start, 0x1000);
        write16(reg::dc_difference_filter, 0x0C04);
    }
    eeprom_.power_on();
    if (eeprom_.checksum_ok()) load_configuration_words();
    show_eeprom();
    mii_.power_on(static_cast<std::uint8_t>(settings_.sockets & ~settings_.ebus));
    show_mii();
}

void SlaveController::load_configuration_words() noexcept {
    write16(reg::pdi_control, eeprom_.word(0));
    write16(reg::pdi_configuration, eeprom_.word(1));
    if (settings_.dc) write16(reg::dc_pulse_length, eeprom_.word(2));
    write16(reg::pdi_configuration_extended, eeprom_.word(3));
    write16(reg::station_alias, eeprom_.word(4));
    const unsigned served = settings_.application ? dl_pdi_watchdog_ok : 0u;
    write16(reg::dl_status, static_cast<std::uint16_t>(read16(reg::dl_status) | dl_pdi_operational | served));
}

void SlaveController::set_al_status(std::uint16_t status, std::uint16_t code) noexcept {
    if (status != read16(reg::al_status)) set_event_request(ecat_event::al_status, true);
    write16(reg::al_status, status);
    write16(reg::al_status_code, code);
}

void SlaveController::set_event_request(std::uint16_t bits, bool on) noexcept {
    const auto request = read16(reg::ecat_event_request);
    write16(reg::ecat_event_request, static_cast<std::uint16_t>(on ? request | bits : request & ~bits));
}

bool SlaveController::read_registers(std::uint32_t address, std::span<std::byte> out, Instant at) noexcept {
    // A controller without DC unit does not count these: a FRMW's working counter shows who keeps the time.
    if (!settings_.dc && address >= reg::dc_system_time && address + out.size() <= dc_unit_end) return false;
    if (settings_.dc && overlaps(address, out.size(), dc_unit, dc_unit_end - dc_unit)) show_dc(at);
    const std::size_t run = std::min<std::size_t>(out.size(), reg::process_ram - address);
    std::copy_n(memory_.begin() + address, run, out.begin());
    if (run < out.size()) (void)read_memory(reg::process_ram, out.subspan(run));
    if (overlaps(address, run, reg::al_status, 2)) set_event_request(ecat_event::al_status, false);
    if (overlaps(address, run, reg::dl_status, 2)) set_event_request(ecat_event::dl_status, false);
    latch_times_read(address, run);
    return true;
}

bool SlaveController::write_registers(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept {
    if (!settings_.dc && address >= reg::dc_system_time && address + in.size() <= dc_unit_end) return false;
    if (address + in.size() > reg::process_ram) {
        (void)write_memory(reg::process_ram, in.subspan(reg::process_ram - address), at);
        in = in.first(reg::process_ram - address);
    }
    const auto store = [&](std::span<const Range> ranges) {
        for (const Range& range : ranges)
            for (std::uint32_t a = std::max(address, range.first); a < std::min<std::size_t>(address + in.size(), range.first + range.size);
                 ++a)
                memory_[a] = in[a - address];
    };
    const auto hits = [&](std::uint32_t first, std::uint32_t size) { return overlaps(address, in.size(), first, size); };

    if (address >= dc_unit && address < dc_unit_end) {
        write_dc(address, in, at);
        return true;
    }
    // Recorded buses show both: FMMUs and sync managers that do not exist do not count, and of two writes in quick succession the slaves count only the first.
    constexpr std::uint32_t fmmus_end = reg::fmmu + 0x100, sync_managers_end = reg::sync_manager + 0x80;
    if (address >= reg::fmmu_at(settings_.fmmus) && address + in.size() <= fmmus_end) return false;
    if (address >= reg::sync_manager_at(settings_.sync_managers) && address + in.size() <= sync_managers_end) return false;
    if (address == reg::al_control && al_control_waits_) return false;
    const auto modes_before = ports_.modes();
    store(stored);
    if (hits(reg::dl_control_loops, 1)) write_dl_control(modes_before, at);
    if (hits(reg::write_register_enable, 1)) keys_.unlock_registers();
    if (hits(reg::write_enable, 1)) keys_.unlock_all();
    if (hits(reg::reset_ecat, 1)) {
        if (keys_.reset_key(in[reg::reset_ecat - address])) events_ |= event::reset;
    }
    if (hits(reg::al_control, 1)) {
        events_ |= event::al_control;
        al_control_waits_ = settings_.application;
    }
    if (hits(reg::rx_errors, 12)) std::fill_n(memory_.begin() + reg::rx_errors, 12, std::byte{0});
    if (hits(reg::processing_unit_errors, 1)) memory_[reg::processing_unit_errors] = std::byte{0};
    if (hits(reg::pdi_errors, 2)) std::fill_n(memory_.begin() + reg::pdi_errors, 2, std::byte{0});
    if (hits(reg::lost_links, 4)) std::fill_n(memory_.begin() + reg::lost_links, 4, std::byte{0});
    if (hits(reg::sm_watchdog_count, 2)) std::fill_n(memory_.begin() + reg::sm_watchdog_count, 2, std::byte{0});
    if ((hits(reg::sm_watchdog_time, 2) || hits(reg::watchdog_divider, 2)) && watchdog_deadline_ != never) start_watchdog(at);
    if ((hits(reg::pdi_watchdog_time, 2) || hits(reg::watchdog_divider, 2)) && !application_alive_) start_pdi_watchdog(at);
    if (hits(reg::eeprom_configuration, 1)) {
        const auto configuration = static_cast<unsigned>(in[reg::eeprom_configuration - address]);
        memory_[reg::eeprom_configuration] = static_cast<std::byte>(configuration & pdi_takes);
        if ((configuration & force_release) != 0)
            memory_[reg::eeprom_pdi_access] = eeprom_.faults().held_by_application ? std::byte{1} : std::byte{0};
    }
    if (hits(reg::eeprom_control, 14)) write_eeprom(address, in, at);
    if (hits(reg::mii_control, 6)) write_mii(address, in, at);
    for (std::uint32_t n = 0; n < settings_.fmmus; ++n) {
        const std::uint32_t base = reg::fmmu_at(n);
        if (!hits(base, Fmmu::size)) continue;
        for (std::uint32_t a = std::max(address, base); a < std::min<std::size_t>(address + in.size(), base + Fmmu::size); ++a)
            memory_[a] = in[a - address];
        fmmus_[n] = decode_fmmu(std::span<const std::byte>{memory_}.subspan(base).first<Fmmu::size>());
        if (!settings_.bitwise_fmmu) {
            fmmus_[n].logical_start_bit = fmmus_[n].physical_start_bit = 0;
            fmmus_[n].logical_stop_bit = 7;
        }
    }
    if (hits(reg::sync_manager, 16 * SyncManager::size)) {
        const std::uint32_t skip = address < reg::sync_manager ? reg::sync_manager - address : 0;
        write_sync_manager_registers(address + skip, in.subspan(skip));
    }
    return true;
}

void SlaveController::write_eeprom(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept {
    // The master has the EEPROM while 0500h and 0501h both say so; else its commands go nowhere, and while busy, too.
    const bool taken = ((memory_[reg::eeprom_configuration] | memory_[reg::eeprom_pdi_access]) & std::byte{1}) != std::byte{0};
    if (taken || eeprom_.busy()) return;
    for (std::uint32_t a = std::max<std::uint32_t>(address, reg::eeprom_address);
         a < std::min<std::size_t>(address + in.size(), reg::eeprom_data + 8); ++a)
        memory_[a] = in[a - address];
    eeprom_.address_written(load_le<std::uint32_t>(memory_, reg::eeprom_address));
    eeprom_.data_written(load_le<std::uint16_t>(memory_, reg::eeprom_data));
    if (overlaps(address, in.size(), reg::eeprom_control, 2)) {
        const auto byte = [&](std::uint32_t a) {
            return a >= address && a < address + in.size() ? static_cast<unsigned>(in[a - address]) : 0u;
        };
        eeprom_.control_written(static_cast<std::uint16_t>(byte(reg::eeprom_control) | (byte(reg::eeprom_control + 1u) << 8)), at);
        write16(reg::eeprom_control, eeprom_.status());
    }
}

void SlaveController::show_eeprom() noexcept {
    write16(reg::eeprom_control, eeprom_.status());
    const auto data = eeprom_.data();
    std::copy(data.begin(), data.end(), memory_.begin() + reg::eeprom_data);
}

void SlaveController::write_mii(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept {
    if (mii_.busy()) return;
    for (std::uint32_t a = std::max<std::uint32_t>(address, reg::mii_phy_address);
         a < std::min<std::size_t>(address + in.size(), reg::mii_phy_data + 2u); ++a)
        memory_[a] = in[a - address];
    if (!overlaps(address, in.size(), reg::mii_control, 2)) return;
    const auto byte = [&](std::uint32_t a) {
        return a >= address && a < address + in.size() ? static_cast<unsigned>(in[a - address]) : 0u;
    };
    constexpr std::byte numbers{0x1F};
    mii_.control_written(static_cast<std::uint16_t>(byte(reg::mii_control) | (byte(reg::mii_control + 1u) << 8)),
                         static_cast<std::uint8_t>(memory_[reg::mii_phy_address] & numbers),
                         static_cast<std::uint8_t>(memory_[reg::mii_phy_register] & numbers), read16(reg::mii_phy_data), at);
    show_mii();
}

void SlaveController::show_mii() noexcept {
    write16(reg::mii_control, mii_.control());
    if (!mii_.busy()) write16(reg::mii_phy_data, mii_.data());
}

bool SlaveController::take_eeprom(bool take) noexcept {
    if (take && (memory_[reg::eeprom_configuration] & std::byte{pdi_takes}) == std::byte{0}) return false;
    memory_[reg::eeprom_pdi_access] = take ? std::byte{1} : std::byte{0};
    return true;
}

bool SlaveController::write_allowed(std::uint32_t address) const noexcept {
    const auto protects = [&](std::uint16_t at) { return (memory_[at] & std::byte{protect}) != std::byte{0}; };
    if (protects(reg::write_protect) && !keys_.all_unlocked() && address != reg::write_enable) return false;
    return address >= protected_end || !protects(reg::write_register_protect) || keys_.registers_unlocked() ||
           address == reg::write_register_enable || address == reg::write_enable;
}

Duration SlaveController::watchdog_ticks(std::uint16_t ticks_register) const noexcept {
    constexpr std::int64_t tick_ns = 40;  // 25 MHz
    return Duration{tick_ns * (std::int64_t{read16(reg::watchdog_divider)} + 2) * read16(ticks_register)};
}

void SlaveController::set_application_alive(bool alive, Instant now) noexcept {
    application_alive_ = alive;
    if (!alive) return start_pdi_watchdog(now);
    pdi_watchdog_deadline_ = never;
    if (settings_.application) write16(reg::dl_status, static_cast<std::uint16_t>(read16(reg::dl_status) | dl_pdi_watchdog_ok));
}

void SlaveController::start_pdi_watchdog(Instant now) noexcept {
    const Duration time = watchdog_ticks(reg::pdi_watchdog_time);
    pdi_watchdog_deadline_ = time > Duration::zero() ? now + time : never;
}

bool SlaveController::watchdog_configured() const noexcept {
    if (read16(reg::sm_watchdog_time) == 0) return false;
    for (unsigned n = 0; n < settings_.sync_managers; ++n) {
        const auto& sm = units_[n].sm;
        if (sm.enabled() && sm.length > 0 && (sm.control & SyncManager::watchdog_trigger) != 0) return true;
    }
    return false;
}

void SlaveController::start_watchdog(Instant now) noexcept {
    const Duration time = watchdog_ticks(reg::sm_watchdog_time);
    watchdog_deadline_ = time > Duration::zero() ? now + time : never;
    write16(reg::sm_watchdog_status, 1);
}

void SlaveController::stop_watchdog() noexcept { watchdog_deadline_ = never; }

}  // namespace taktwerk::ecat::sim
