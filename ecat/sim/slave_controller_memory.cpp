// Process RAM under its sync managers: mailboxes that are full or empty, buffers that are always complete.

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

namespace {

/// The three buffers in turn; 3 stands for none yet.
constexpr std::uint8_t next_buffer(std::uint8_t buffer) noexcept { return buffer < 2 ? static_cast<std::uint8_t>(buffer + 1) : 0; }

}  // namespace

std::optional<unsigned> SlaveController::governor(std::uint32_t address) const noexcept {
    for (unsigned n = 0; n < settings_.sync_managers; ++n)
        if (units_[n].governs(address)) return n;
    return std::nullopt;
}

std::size_t SlaveController::ungoverned_run(std::uint32_t address, std::size_t size) const noexcept {
    for (unsigned n = 0; n < settings_.sync_managers; ++n) {
        const auto& sm = units_[n].sm;
        if (sm.enabled() && sm.start > address) size = std::min<std::size_t>(size, sm.start - address);
    }
    return size;
}

bool SlaveController::read_memory(std::uint32_t address, std::span<std::byte> out) noexcept {
    bool any = false;
    while (!out.empty() && address < memory_.size()) {
        std::size_t run = std::min(out.size(), memory_.size() - address);
        if (const auto n = governor(address)) {
            run = std::min<std::size_t>(run, std::size_t{units_[*n].sm.start} + units_[*n].sm.length - address);
            any |= governed_read(*n, address, out.first(run));
        } else {
            run = ungoverned_run(address, run);
            std::copy_n(memory_.begin() + address, run, out.begin());
            any = true;
        }
        address += static_cast<std::uint32_t>(run);
        out = out.subspan(run);
    }
    return any;
}

bool SlaveController::write_memory(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept {
    bool any = false;
    while (!in.empty() && address < memory_.size()) {
        std::size_t run = std::min(in.size(), memory_.size() - address);
        if (const auto n = governor(address)) {
            run = std::min<std::size_t>(run, std::size_t{units_[*n].sm.start} + units_[*n].sm.length - address);
            any |= governed_write(*n, address, in.first(run), at);
        } else {
            run = ungoverned_run(address, run);
            std::copy_n(in.begin(), run, memory_.begin() + address);
            any = true;
        }
        address += static_cast<std::uint32_t>(run);
        in = in.subspan(run);
    }
    return any;
}

bool SlaveController::governed_read(unsigned n, std::uint32_t address, std::span<std::byte> out) noexcept {
    Unit& unit = units_[n];
    if ((unit.sm.pdi_control & SyncManager::pdi_deactivate) != 0 || unit.sm.is_written_by_master()) return false;
    const bool last = address + out.size() == std::size_t{unit.sm.start} + unit.sm.length;
    if (unit.sm.is_mailbox()) {
        if (!unit.full) return false;
        if (address == unit.sm.start) unit.opened = true;
        if (!unit.opened) return false;
    }
    if (address == unit.sm.start) unit.written = false;
    std::copy_n(memory_.begin() + address, out.size(), out.begin());
    if (last) unit.was_read = true;
    show_sync_manager(n);
    if (!last) return true;
    if (unit.sm.is_mailbox()) {
        unit.full = unit.opened = false;
        events_ |= event::mailbox_read;
    } else {
        events_ |= event::inputs_read;
    }
    show_sync_manager(n);
    return true;
}

bool SlaveController::governed_write(unsigned n, std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept {
    Unit& unit = units_[n];
    if ((unit.sm.pdi_control & SyncManager::pdi_deactivate) != 0 || !unit.sm.is_written_by_master()) return false;
    if (unit.full) return false;
    if (address == unit.sm.start) unit.opened = true;
    if (!unit.opened) return false;
    if (address == unit.sm.start) unit.was_read = false;
    std::copy(in.begin(), in.end(), memory_.begin() + address);
    if (address + in.size() != std::size_t{unit.sm.start} + unit.sm.length) return true;

    unit.opened = false;
    unit.written = true;
    if (unit.sm.is_mailbox()) {
        unit.full = true;
        events_ |= event::mailbox_written;
    } else {
        // Three buffers, seen from outside: the application gets nothing until the last byte is there.
        std::copy_n(memory_.begin() + unit.sm.start, unit.sm.length, application_.begin() + unit.sm.start);
        unit.fresh = true;
        unit.buffer = next_buffer(unit.buffer);
        events_ |= event::outputs;
    }
    if ((unit.sm.control & SyncManager::watchdog_trigger) != 0) start_watchdog(at);
    show_sync_manager(n);
    return true;
}

void SlaveController::write_sync_manager_registers(std::uint32_t address, std::span<const std::byte> in) noexcept {
    for (std::size_t i = 0; i < in.size(); ++i) {
        const std::uint32_t at = address + static_cast<std::uint32_t>(i);
        const auto n = (at - reg::sync_manager) / SyncManager::size;
        const auto field = (at - reg::sync_manager) % SyncManager::size;
        if (n >= settings_.sync_managers) return;
        Unit& unit = units_[n];
        if (field == sm_status_offset || field == sm_pdi_control_offset) continue;
        if (field < sm_status_offset) {
            // Start, length and control are frozen while the sync manager is on.
            if (!unit.sm.enabled()) memory_[at] = in[i];
        } else {
            const auto before = unit.sm.activate;
            memory_[at] = in[i];
            const auto after = static_cast<std::uint8_t>(in[i]);
            if (((before ^ after) & SyncManager::enable) != 0) {
                reset_unit(static_cast<unsigned>(n));
                events_ |= event::sync_manager_switched;
            }
            if (((before ^ after) & SyncManager::repeat_request) != 0) events_ |= event::repeat_request;
        }
        const auto pdi = unit.sm.pdi_control;
        unit.sm = decode_sync_manager(
            std::span<const std::byte>{memory_}.subspan(reg::sync_manager_at(static_cast<unsigned>(n))).first<SyncManager::size>());
        unit.sm.pdi_control = pdi;
        // A manager that reaches beyond the RAM governs only what exists.
        if (std::size_t{unit.sm.start} + unit.sm.length > memory_.size() || !holds_process_data(unit.sm.start, unit.sm.length)) {
            unit.sm.start = reg::process_ram;
            unit.sm.length = 0;
        }
        show_sync_manager(static_cast<unsigned>(n));
    }
}

void SlaveController::reset_unit(unsigned n) noexcept {
    Unit fresh;
    fresh.sm = units_[n].sm;
    units_[n] = fresh;
}

void SlaveController::show_sync_manager(unsigned n) noexcept {
    Unit& unit = units_[n];
    const std::size_t base = reg::sync_manager_at(n);
    unsigned status = (unit.written ? SyncManager::interrupt_write : 0u) | (unit.was_read ? SyncManager::interrupt_read : 0u);
    if (unit.sm.is_mailbox()) status |= unit.full ? SyncManager::mailbox_full : 0u;
    else if (unit.sm.enabled()) status |= unsigned{unit.buffer} << 4;
    unit.sm.status = static_cast<std::uint8_t>(status);
    memory_[base + sm_status_offset] = static_cast<std::byte>(unit.sm.status);
    memory_[base + sm_pdi_control_offset] = static_cast<std::byte>(unit.sm.pdi_control);
    // What the other side did with it: taken what the master wrote, or left something to read.
    const bool pending = unit.sm.is_written_by_master() ? unit.was_read : unit.written;
    if (n < 8)
        set_event_request(static_cast<std::uint16_t>(1u << (ecat_event::sync_manager_0 + n)),
                          pending && unit.sm.enabled() && (unit.sm.control & SyncManager::ecat_interrupt) != 0);
}

bool SlaveController::take_fresh(unsigned n) noexcept {
    Unit& unit = units_[n];
    if (!unit.fresh) return false;
    unit.fresh = unit.written = false;
    unit.was_read = true;
    show_sync_manager(n);
    return true;
}

void SlaveController::publish_inputs(unsigned n) noexcept {
    Unit& unit = units_[n];
    unit.written = true;
    unit.was_read = false;
    unit.buffer = next_buffer(unit.buffer);
    show_sync_manager(n);
}

void SlaveController::lock_sync_manager(unsigned n, bool locked) noexcept {
    Unit& unit = units_[n];
    const auto bit = SyncManager::pdi_deactivate;
    unit.sm.pdi_control = static_cast<std::uint8_t>(locked ? unit.sm.pdi_control | bit : unit.sm.pdi_control & ~bit);
    reset_unit(n);
    show_sync_manager(n);
}

std::span<const std::byte> SlaveController::full_mailbox(unsigned n) const noexcept {
    if (!units_[n].full) return {};
    return std::span<const std::byte>{memory_}.subspan(units_[n].sm.start, units_[n].sm.length);
}

void SlaveController::empty_mailbox(unsigned n) noexcept {
    units_[n].full = units_[n].written = false;
    units_[n].was_read = true;
    show_sync_manager(n);
}

bool SlaveController::fill_mailbox(unsigned n, std::span<const std::byte> message) noexcept {
    Unit& unit = units_[n];
    if (unit.full || !unit.sm.enabled() || message.size() > unit.sm.length) return false;
    const auto area = std::span<std::byte>{memory_}.subspan(unit.sm.start, unit.sm.length);
    std::fill(std::copy(message.begin(), message.end(), area.begin()), area.end(), std::byte{0});
    unit.full = unit.written = true;
    unit.opened = unit.was_read = false;
    show_sync_manager(n);
    return true;
}

bool SlaveController::repeat_requested(unsigned n) const noexcept {
    return ((units_[n].sm.activate ^ units_[n].sm.pdi_control) & SyncManager::repeat_request) != 0;
}

void SlaveController::acknowledge_repeat(unsigned n) noexcept {
    auto& sm = units_[n].sm;
    sm.pdi_control =
        static_cast<std::uint8_t>((sm.pdi_control & ~SyncManager::repeat_acknowledge) | (sm.activate & SyncManager::repeat_request));
    show_sync_manager(n);
}

std::span<const std::byte> SlaveController::outputs(unsigned n) const noexcept {
    return std::span<const std::byte>{application_}.subspan(units_[n].sm.start, units_[n].sm.length);
}

void SlaveController::clear_outputs(unsigned n) noexcept {
    const auto& sm = units_[n].sm;
    std::fill_n(application_.begin() + sm.start, sm.length, std::byte{0});
}

std::span<std::byte> SlaveController::inputs(unsigned n) noexcept {
    return std::span<std::byte>{memory_}.subspan(units_[n].sm.start, units_[n].sm.length);
}

}  // namespace taktwerk::ecat::sim
