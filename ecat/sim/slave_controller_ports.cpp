// The data link layer of a simulated slave controller: loops, links, receive times, error counters.

#include <algorithm>

#include "core/bytes.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr unsigned mii = 3, ebus = 2;                               // port descriptor 0007h, two bits a port; 0: the port does not exist
constexpr std::uint16_t temporary_loops = 1u << 1;                  // of 0100h
constexpr Duration temporary_loops_last = std::chrono::seconds{1};  // ETG.1000.4: about one second

}  // namespace

void SlaveController::add_socket(unsigned p) noexcept {
    settings_.sockets = static_cast<std::uint8_t>(settings_.sockets | (1u << p));
    show_sockets();
}

void SlaveController::show_sockets() noexcept {
    unsigned descriptor = 0;
    for (unsigned p = 0; p < ports_per_slave; ++p)
        if ((settings_.sockets & (1u << p)) != 0) descriptor |= ((settings_.ebus & (1u << p)) != 0 ? ebus : mii) << (2 * p);
    memory_[reg::port_descriptor] = static_cast<std::byte>(descriptor);
}

void SlaveController::set_links(std::uint8_t links) noexcept {
    const auto lost = ports_.set_links(links);
    for (unsigned p = 0; p < ports_per_slave; ++p)
        if ((lost & (1u << p)) != 0) count_error(static_cast<std::uint16_t>(reg::lost_links + p));
    show_ports();
}

void SlaveController::show_ports() noexcept {
    constexpr std::uint16_t not_of_ports = dl_pdi_operational | dl_pdi_watchdog_ok;
    const auto before = read16(reg::dl_status);
    const auto status = static_cast<std::uint16_t>((before & not_of_ports) | ports_.dl_status());
    if (status != before) set_event_request(ecat_event::dl_status, true);
    write16(reg::dl_status, status);
}

void SlaveController::write_dl_control(std::uint8_t modes_before, Instant at) noexcept {
    if ((read16(reg::dl_control) & temporary_loops) != 0) {
        temporary_loops_.begin(modes_before, at + temporary_loops_last);
    } else {
        temporary_loops_.end();
    }
    move_loops(static_cast<std::uint8_t>(memory_[reg::dl_control_loops]));
}

void SlaveController::move_loops(std::uint8_t modes) noexcept {
    ports_.set_modes(modes);
    show_ports();
    loop_changed_ = true;
}

void SlaveController::frame_passed(Instant sent, std::span<const Duration, ports_per_slave> arrival, std::uint8_t arrives) noexcept {
    if (!latch_pending_) return;
    latch_pending_ = false;
    for (unsigned p = 0; p < ports_per_slave; ++p)
        if ((arrives & (1u << p)) != 0)
            store_le<std::uint32_t>(memory_, reg::dc_receive_times + 4 * p, static_cast<std::uint32_t>(clock_.local(sent + arrival[p])));
    if (settings_.dc) store_le<std::int64_t>(memory_, reg::dc_receive_time_unit, clock_.local(latched_at_));
}

void SlaveController::count_receive_error(unsigned p) noexcept {
    count_error(static_cast<std::uint16_t>(reg::rx_errors + 2 * p));      // invalid frame
    count_error(static_cast<std::uint16_t>(reg::rx_errors + 2 * p + 1));  // invalid symbols
}

void SlaveController::count_forwarded_error(unsigned p) noexcept {
    count_error(static_cast<std::uint16_t>(reg::rx_errors + 2 * p));
    count_error(static_cast<std::uint16_t>(reg::forwarded_rx_errors + p));
}

void SlaveController::count_error(std::uint16_t counter) noexcept {
    auto& count = memory_[counter];
    if (count != std::byte{255}) count = static_cast<std::byte>(static_cast<unsigned>(count) + 1);
}

}  // namespace taktwerk::ecat::sim
