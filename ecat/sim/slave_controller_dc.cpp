// The distributed clocks unit of a simulated slave controller: system time, SYNC signals, latch inputs (0900h..09FFh).

#include <algorithm>
#include <cmath>

#include "core/bytes.hpp"
#include "ecat/sim/slave_controller.hpp"

namespace taktwerk::ecat::sim {

namespace {

/// A write is stored, nothing else happens at once. They exist only where the controller has the unit.
constexpr std::pair<std::uint16_t, std::uint16_t> dc_stored[] = {
    {reg::dc_system_offset, 8},  {reg::dc_system_delay, 4}, {reg::dc_speed_start, 2}, {reg::dc_difference_filter, 2},
    {reg::dc_cyclic_control, 2}, {reg::dc_sync0_cycle, 4},  {reg::dc_sync1_cycle, 4}, {reg::dc_latch0_control, 2},
};
/// The upper halves that a 32-bit unit does not have.
constexpr std::uint16_t upper_halves[] = {reg::dc_system_time + 4,     reg::dc_receive_time_unit + 4, reg::dc_system_offset + 4,
                                          reg::dc_start_time + 4,      reg::dc_next_sync1 + 4,        reg::dc_latch0_positive + 4,
                                          reg::dc_latch0_negative + 4, reg::dc_latch1_positive + 4,   reg::dc_latch1_negative + 4};

constexpr std::uint8_t cyclic_by_application = 1u << 0;   // 0980h
constexpr std::uint8_t latch0_by_application = 1u << 4;   // bit 5: latch 1
constexpr unsigned edge_positive = 0, edge_negative = 1;  // bits of 09A8h (single event) and 09AEh (latched)
constexpr std::uint8_t latch_level = 1u << 2;             // 09AEh
constexpr unsigned latches = 2, latch_time_size = 8;

constexpr std::uint16_t latch_time(unsigned n, unsigned edge) noexcept {
    return static_cast<std::uint16_t>(reg::dc_latch0_positive + (2 * n + edge) * latch_time_size);
}

}  // namespace

void SlaveController::write_dc(std::uint32_t address, std::span<const std::byte> in, Instant at) noexcept {
    const auto hits = [&](std::uint32_t first, std::uint32_t size) { return address < first + size && first < address + in.size(); };
    if (hits(reg::dc_receive_times, 1)) {
        latched_at_ = at;
        latch_pending_ = true;
    }
    if (!settings_.dc) return;
    const auto store = [&](std::uint32_t first, std::uint32_t size, std::byte* to) {
        for (std::uint32_t a = std::max(address, first); a < std::min<std::size_t>(address + in.size(), first + size); ++a)
            to[a - first] = in[a - address];
    };
    for (const auto& [first, size] : dc_stored) store(first, size, memory_.data() + first);
    store(reg::dc_start_time, 8, start_time_.data());

    if (address == reg::dc_system_time && in.size() >= 8 && settings_.dc_64bit) clock_.correct(load_le<std::int64_t>(in), at);
    else if (address == reg::dc_system_time && in.size() >= 4) clock_.correct_low32(load_le<std::uint32_t>(in), at);
    if (hits(reg::dc_system_offset, 8))
        clock_.set_offset(settings_.dc_64bit ? load_le<std::int64_t>(memory_, reg::dc_system_offset)
                                             : std::int64_t{load_le<std::uint32_t>(memory_, reg::dc_system_offset)});
    if (hits(reg::dc_system_delay, 4)) clock_.set_delay(load_le<std::uint32_t>(memory_, reg::dc_system_delay));
    if (hits(reg::dc_speed_start, 2)) clock_.reset_control(at);
    // The cyclic unit belongs to whom 0980h says: bit 0 set, the application keeps it and 0981h does nothing.
    if (hits(reg::dc_activation, 1) && (static_cast<unsigned>(memory_[reg::dc_cyclic_control]) & cyclic_by_application) == 0)
        control_sync(at);
    clock_moved(at);  // whatever was written may have moved it
}

void SlaveController::control_sync(Instant at) noexcept {
    constexpr unsigned signals = dc_activate::sync0 | dc_activate::sync1;
    const auto activation = static_cast<unsigned>(memory_[reg::dc_activation]);
    const bool on = (activation & dc_activate::cyclic) != 0 && (activation & signals) != 0;
    if (!on) {
        sync0_.deactivate();
        sync1_.deactivate();
        return;
    }
    if (!sync0_.active()) {
        auto start = load_le<std::int64_t>(start_time_);
        if (!settings_.dc_64bit) {
            // The low 32 bits say when; what has passed comes again when they have gone round.
            const auto now = clock_.system(at);
            start = now + static_cast<std::int64_t>(static_cast<std::uint32_t>(start) - static_cast<std::uint32_t>(now));
        }
        sync0_.activate(start, load_le<std::uint32_t>(memory_, reg::dc_sync0_cycle), clock_, at);
    }
    if ((activation & dc_activate::sync1) == 0) sync1_.deactivate();
    else if (!sync1_.active()) sync1_.activate(load_le<std::uint32_t>(memory_, reg::dc_sync1_cycle));
}

void SlaveController::clock_moved(Instant now) noexcept {
    sync0_.clock_changed(clock_, now);
    sync0_due_ = sync0_.due(clock_).value_or(never);
    sync1_due_ = sync1_.due(clock_).value_or(never);
}

void SlaveController::set_clock_drift(double ppm, Instant now) noexcept {
    clock_.set_drift(static_cast<std::int32_t>(std::lround(ppm * 1000.0)), now);
    clock_moved(now);
}

void SlaveController::step_clock(Duration by, Instant now) noexcept {
    clock_.step(by);
    clock_moved(now);
}

void SlaveController::show_dc(Instant at) noexcept {
    store_le<std::int64_t>(memory_, reg::dc_system_time, clock_.system(at));
    store_le<std::uint32_t>(memory_, reg::dc_difference, clock_.difference_register());
    store_le<std::int64_t>(memory_, reg::dc_start_time, sync0_.runs() ? sync0_.next_system() : load_le<std::int64_t>(start_time_));
    if (sync1_.active()) store_le<std::int64_t>(memory_, reg::dc_next_sync1, sync1_.next_system());
    if (settings_.dc_64bit) return;
    for (const auto upper : upper_halves) store_le<std::uint32_t>(memory_, upper, 0);
}

void SlaveController::fire_sync(Instant now) noexcept {
    if (sync1_due_ <= now) {
        sync1_.fire();
        sync1_due_ = never;
        events_ |= event::sync1;
    }
    if (sync0_due_ <= now) {
        sync1_.sync0_fired(sync0_.next_system());
        sync0_.fire();
        sync0_due_ = sync0_.due(clock_).value_or(never);
        sync1_due_ = sync1_.due(clock_).value_or(never);
        if (sync_is_out(dc_activate::sync0)) events_ |= event::sync0;
    }
}

void SlaveController::set_latch_input(unsigned n, bool level, Instant at) noexcept {
    if (!settings_.dc || n >= latches || latch_level_[n] == level) return;
    latch_level_[n] = level;
    auto& status = memory_[reg::dc_latch0_status + n];
    status = level ? status | std::byte{latch_level} : status & ~std::byte{latch_level};
    const unsigned edge = level ? edge_positive : edge_negative;
    const auto bit = static_cast<std::byte>(1u << edge);
    if ((memory_[reg::dc_latch0_control + n] & bit) != std::byte{0}) {
        if ((status & bit) != std::byte{0}) return;  // single event: the first one stays until it was read
        status |= bit;
    }
    store_le<std::int64_t>(memory_, latch_time(n, edge), clock_.system(at));
    if ((static_cast<unsigned>(memory_[reg::dc_cyclic_control]) & (unsigned{latch0_by_application} << n)) == 0)
        set_event_request(ecat_event::dc_latch, true);
}

void SlaveController::latch_times_read(std::uint32_t address, std::size_t size) noexcept {
    for (unsigned n = 0; n < latches; ++n)
        for (const unsigned edge : {edge_positive, edge_negative}) {
            const std::uint32_t first = latch_time(n, edge);
            if (address >= first + latch_time_size || first >= address + size) continue;
            memory_[reg::dc_latch0_status + n] &= ~static_cast<std::byte>(1u << edge);
            set_event_request(ecat_event::dc_latch, false);
        }
}

}  // namespace taktwerk::ecat::sim
