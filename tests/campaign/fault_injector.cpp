#include "tests/campaign/fault_injector.hpp"

#include <fmt/format.h>

#include "ecat/wire/registers.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::campaign {

namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t all = 1'000'000;
constexpr std::size_t product_byte = std::size_t{2} * ecat::sii_word::product;

}  // namespace

void FaultInjector::strike() {
    began_ = m_.clock.now();
    slave_ = between(0, static_cast<std::uint32_t>(m_.world.network().size()) - 1);
    deed_ = fmt::format("{} at {:.3f} s, slave {}", name(kind_), to_seconds(began_.time_since_epoch()), slave_);
    strike_frames();
    strike_slave();
    strike_as_second_master();
    if (kind_ == FaultKind::stall_20ms) stall(20ms);
    if (kind_ == FaultKind::stall_200ms) stall(200ms);
    if (kind_ == FaultKind::stall_2s) stall(2s);
    deed_ += fmt::format(", for {} ms", length_ / 1ms);
}

void FaultInjector::strike_frames() {
    auto& faults = m_.world.transport().faults;
    auto& cable = m_.cable;
    cable.flip_bit = between(0, 20'000);
    switch (kind_) {
        case FaultKind::frames_lost: (between(0, 1) != 0 ? faults.drop_requests : faults.drop_answers) = between(1, 2); break;
        case FaultKind::frames_lost_long:
            (between(0, 1) != 0 ? faults.drop_requests : faults.drop_answers) = all;
            length_ = milliseconds(5, 40);
            break;
        case FaultKind::answers_late:
            faults.delay = std::chrono::microseconds{between(1200, 5000)};
            faults.delay_answers = between(1, 2);
            length_ = 10ms;
            break;
        case FaultKind::answers_late_long:
            faults.delay = std::chrono::microseconds{between(1200, 5000)};
            faults.delay_answers = all;
            length_ = milliseconds(8, 30);
            break;
        case FaultKind::answers_twice:
            faults.duplicate_answers = between(1, 50);
            length_ = 60ms;
            break;
        case FaultKind::answers_reordered:
            cable.reorder_by = 1500us;
            cable.reorder = 4;
            length_ = 20ms;
            break;
        case FaultKind::answer_bits_flipped:
            cable.flip_answers = between(1, 5);
            length_ = 20ms;
            break;
        case FaultKind::request_bits_flipped:
            cable.flip_requests = between(1, 5);
            length_ = 20ms;
            break;
        case FaultKind::counter_too_small:
            cable.working_counter_offset = -1;
            length_ = milliseconds(5, 20);
            break;
        case FaultKind::counter_too_large:
            cable.working_counter_offset = static_cast<int>(between(1, 3));
            length_ = milliseconds(5, 20);
            break;
        case FaultKind::link_down:
            faults.link_down = true;
            length_ = milliseconds(20, 500);
            break;
        case FaultKind::reference_frozen:
            cable.freeze_reference_time = true;
            length_ = milliseconds(300, 1000);
            break;
        case FaultKind::foreign_frames: length_ = 1200ms; break;
        default: break;
    }
}

void FaultInjector::strike_slave() {
    auto& network = m_.world.network();
    auto& slave = network.slave(slave_);
    switch (kind_) {
        case FaultKind::state_refused:
            slave.refuse_state(between(0, 1) != 0 ? ecat::sim::EsmState::safeop : ecat::sim::EsmState::op, 0x001D);
            length_ = 2s;
            break;
        case FaultKind::other_device: slave.controller().eeprom().image()[product_byte] ^= std::byte{0x55}; [[fallthrough]];
        case FaultKind::power_cycled:
            network.set_power(slave_, false);
            length_ = milliseconds(5, 300);
            break;
        case FaultKind::power_cycled_twice:
            network.set_power(slave_, false);
            second_off_ = milliseconds(20, 300);
            second_on_ = second_off_ + milliseconds(5, 300);
            length_ = second_on_ + milliseconds(5, 100);
            break;
        case FaultKind::power_gone: network.set_power(slave_, false); break;
        case FaultKind::cable_pulled:
            network.set_cable(slave_, false);
            length_ = milliseconds(20, 500);
            break;
        case FaultKind::cable_gone: network.set_cable(slave_, false); break;
        case FaultKind::mailbox_stuck:
        case FaultKind::mailbox_dead:
            slave_ = between(0, 1);  // the drives; the terminal has none
            network.slave(slave_).stick_mailbox(true);
            length_ = kind_ == FaultKind::mailbox_dead ? 12s : milliseconds(500, 3000);
            break;
        default: break;
    }
}

void FaultInjector::write(ecat::Address address, std::uint16_t value) {
    std::array<std::byte, ecat::min_frame_size> buffer{};
    ecat::FrameBuilder builder{buffer, ecat::MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
    store_le(builder.add(ecat::Command::APWR, 0x40, address, 2), 0, value);
    (void)builder.finish();
    (void)m_.world.network().process(buffer, m_.clock.now());
    m_.world.transport().inject(buffer, m_.clock.now());
}

void FaultInjector::strike_as_second_master() {
    const auto at = static_cast<std::uint16_t>(slave_);
    constexpr std::array<std::uint16_t, 3> states{1, 2, 4};
    switch (kind_) {
        case FaultKind::address_changed: write(ecat::Address::position(at, ecat::reg::station_address), 0); break;
        case FaultKind::state_changed: write(ecat::Address::position(at, ecat::reg::al_control), states[between(0, 2)]); break;
        // Offset 4 of an FMMU: its length. One without length maps nothing.
        case FaultKind::settings_changed:
            write(ecat::Address::position(at, static_cast<std::uint16_t>(ecat::reg::fmmu_at(0) + 4)), 0);
            break;
        default: break;
    }
}

void FaultInjector::stall(Duration length) {
    m_.clock.advance(length);
    m_.world.network().advance(m_.clock.now());
    const auto now = m_.clock.now();
    m_.machine->cycle({now, now, static_cast<std::uint32_t>(length / m_.machine->config().cycle)});
    m_.machine->service(now);
}

void FaultInjector::step() {
    const Duration passed = m_.clock.now() - began_;
    if (kind_ == FaultKind::foreign_frames && passed / 1ms % 40 == 0) write(ecat::Address::position(0, 0x0F80), 0);
    if (kind_ != FaultKind::power_cycled_twice) return;
    const bool on = (passed >= second_off_ / 2 && passed < second_off_) || passed >= second_on_;
    m_.world.network().set_power(slave_, on);
}

bool FaultInjector::over() const { return m_.clock.now() - began_ >= length_; }

void FaultInjector::heal() {
    m_.world.transport().faults = {};
    auto& cable = m_.cable;
    cable.working_counter_offset = 0;
    cable.freeze_reference_time = false;
    cable.flip_answers = cable.flip_requests = cable.reorder = 0;
    auto& network = m_.world.network();
    network.slave(slave_).refuse_state(ecat::sim::EsmState::safeop, 0);
    network.slave(slave_).refuse_state(ecat::sim::EsmState::op, 0);
    if (kind_ == FaultKind::other_device) network.set_power(slave_, true);
    if (for_good(kind_)) return;
    network.set_power(slave_, true);
    network.set_cable(slave_, true);
    network.slave(slave_).stick_mailbox(false);
}

void FaultInjector::repair() {
    auto& network = m_.world.network();
    if (kind_ == FaultKind::other_device) {
        network.set_power(slave_, false);
        network.slave(slave_).controller().eeprom().image()[product_byte] ^= std::byte{0x55};
    }
    network.set_power(slave_, true);
    network.set_cable(slave_, true);
    network.slave(slave_).stick_mailbox(false);
}

}  // namespace taktwerk::campaign
