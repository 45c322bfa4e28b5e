#include "ecat/sim/slave_controller.hpp"

#include <algorithm>

#include "core/bytes.hpp"

namespace taktwerk::ecat::sim {

SlaveController::SlaveController(const ControllerSettings& settings, EepromInterface eeprom_interface)
    : settings_(settings),
      eeprom_(std::move(eeprom_interface)),
      memory_(std::size_t{reg::process_ram} + settings.process_ram),
      application_(std::size_t{reg::process_ram} + settings.process_ram) {}

std::uint16_t SlaveController::read16(std::uint16_t address) const noexcept { return load_le<std::uint16_t>(memory_, address); }
void SlaveController::write16(std::uint16_t address, std::uint16_t value) noexcept { store_le<std::uint16_t>(memory_, address, value); }

bool holds_process_data(std::uint32_t address, std::size_t size) noexcept {
    constexpr std::uint32_t outputs_end = reg::digital_outputs + 4u;
    return address >= reg::process_ram || (address >= reg::digital_outputs && address + size <= outputs_end);
}

bool SlaveController::read(std::uint32_t address, std::span<std::byte> out, Instant at) noexcept {
    return holds_process_data(address, out.size()) ? read_memory(address, out) : read_registers(address, out, at);
}

bool SlaveController::write(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept {
    if (!write_allowed(address)) return false;
    return holds_process_data(address, in.size()) ? write_memory(address, in, at) : write_registers(address, in, at);
}

void SlaveController::add_to_counter(MutableDatagram& datagram, unsigned increment) noexcept {
    store_le<std::uint16_t>(datagram.wkc, 0, static_cast<std::uint16_t>(datagram.working_counter() + increment));
}

void SlaveController::execute(MutableDatagram& datagram, Instant at) noexcept {
    const auto adp = load_le<std::uint16_t>(datagram.header, 2);
    const auto pass_on = [&] { store_le<std::uint16_t>(datagram.header, 2, static_cast<std::uint16_t>(adp + 1)); };
    const auto station = [&] {
        return adp == station_address() ||
               ((memory_[reg::dl_control_alias] & std::byte{1}) != std::byte{0} && adp == read16(reg::station_alias));
    };
    switch (datagram.command) {
        case Command::NOP: break;
        case Command::APRD:
        case Command::APWR:
        case Command::APRW:
        case Command::ARMW:
            exchange_physical(datagram, adp == 0, at);
            pass_on();
            break;
        case Command::BRD:
        case Command::BWR:
        case Command::BRW:
            exchange_physical(datagram, true, at);
            pass_on();
            break;
        case Command::FPRD:
        case Command::FPWR:
        case Command::FPRW:
        case Command::FRMW: exchange_physical(datagram, station(), at); break;
        case Command::LRD:
        case Command::LWR:
        case Command::LRW: exchange_logical(datagram, at); break;
    }
    const auto events = static_cast<std::uint16_t>(read16(reg::ecat_event_request) & read16(reg::ecat_event_mask));
    if (events != 0)
        store_le<std::uint16_t>(datagram.header, 8, static_cast<std::uint16_t>(load_le<std::uint16_t>(datagram.header, 8) | events));
}

void SlaveController::exchange_physical(MutableDatagram& datagram, bool addressed, Instant at) noexcept {
    const std::uint32_t ado = load_le<std::uint16_t>(datagram.header, 4);
    switch (datagram.command) {
        case Command::APRD:
        case Command::FPRD:
            if (addressed && read(ado, datagram.data, at)) add_to_counter(datagram, 1);
            return;
        case Command::APWR:
        case Command::FPWR:
        case Command::BWR:
            if (addressed && write(ado, datagram.data, at)) add_to_counter(datagram, 1);
            return;
        case Command::ARMW:
        case Command::FRMW:
            // Read by the slave addressed, written by all others: spreads the reference clock's time.
            if (addressed ? read(ado, datagram.data, at) : write(ado, datagram.data, at)) add_to_counter(datagram, 1);
            return;
        default: break;
    }
    if (!addressed || (datagram.command != Command::BRD && !settings_.read_write)) return;
    // BRD, APRW, FPRW, BRW: the old content leaves, the arriving one stays. Broadcast reads are the OR over the slaves.
    std::array<std::byte, max_datagram_data> old;
    const std::span<std::byte> content{old.data(), std::min(datagram.data.size(), old.size())};
    const bool broadcast = datagram.command == Command::BRD || datagram.command == Command::BRW;
    const bool was_read = read(ado, content, at);
    // 0108h: a slave may be told to keep what arrives somewhere else than where it reads.
    const std::uint32_t offset = broadcast ? 0u : read16(reg::physical_rw_offset);
    if (datagram.command != Command::BRD && write((ado + offset) & 0xFFFFu, datagram.data, at)) add_to_counter(datagram, 2);
    if (!was_read) return;
    for (std::size_t i = 0; i < content.size(); ++i) datagram.data[i] = broadcast ? datagram.data[i] | content[i] : content[i];
    add_to_counter(datagram, 1);
}

Instant SlaveController::next_event() const noexcept {
    Instant next = std::min({watchdog_deadline_, pdi_watchdog_deadline_, sync0_due_, sync1_due_, temporary_loops_.until()});
    if (eeprom_.busy()) next = std::min(next, eeprom_.due());
    if (mii_.busy()) next = std::min(next, mii_.due());
    return next;
}

void SlaveController::fire(Instant now) noexcept {
    if (eeprom_.busy() && eeprom_.due() <= now) {
        if (eeprom_.complete()) load_configuration_words();
        show_eeprom();
    }
    if (mii_.busy() && mii_.due() <= now) {
        mii_.complete(ports_.links());
        show_mii();
    }
    if (watchdog_deadline_ <= now) {
        watchdog_deadline_ = never;
        write16(reg::sm_watchdog_status, 0);
        count_error(reg::sm_watchdog_count);
        events_ |= event::watchdog;
    }
    if (temporary_loops_.until() <= now) {
        temporary_loops_.end();
        memory_[reg::dl_control_loops] = static_cast<std::byte>(temporary_loops_.kept());
        move_loops(temporary_loops_.kept());
    }
    if (pdi_watchdog_deadline_ <= now) {
        pdi_watchdog_deadline_ = never;
        count_error(reg::pdi_watchdog_count);
        write16(reg::dl_status, static_cast<std::uint16_t>(read16(reg::dl_status) & ~dl_pdi_watchdog_ok));
        set_event_request(ecat_event::dl_status, true);
    }
    fire_sync(now);
}

}  // namespace taktwerk::ecat::sim
