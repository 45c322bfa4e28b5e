#include "tests/whole_machine/troublemaker.hpp"

#include "ecat/wire/registers.hpp"
#include "tests/whole_machine/hands.hpp"
#include "tests/whole_machine/rogue.hpp"

namespace taktwerk::whole {

namespace {

constexpr std::uint32_t all = 1'000'000;

Mischief mischief_of(Trouble trouble) {
    switch (trouble) {
        case Trouble::throws_in_scan: return Mischief::throws_in_scan;
        case Trouble::throws_in_stop: return Mischief::throws_in_stop;
        case Trouble::no_numbers: return Mischief::no_numbers;
        case Trouble::wrong_commands: return Mischief::wrong_commands;
        case Trouble::takes_others_axis: return Mischief::takes_others_axis;
        default: return Mischief::none;
    }
}

}  // namespace

bool Troublemaker::possible(Trouble trouble) const {
    const auto& config = rig_.m.machine->config();
    switch (source_of(trouble)) {
        case Source::serial: return !config.serial.empty();
        case Source::bus:
        case Source::host: return config.bus.slaves.size() > 0;
        case Source::files: return trouble == Trouble::folder_gone || trouble == Trouble::bits_flipped || PrivateDisk::possible();
        case Source::drives:
            return std::any_of(config.axes.begin(), config.axes.end(),
                               [&](const auto& one) { return rig_.m.world.drive(one.axis.name) != nullptr; });
        case Source::operators: return trouble != Trouble::emergency_stop || !input_of_emergency_stop().empty();
        case Source::programs: return trouble != Trouble::takes_others_axis || config.programs.size() > 1;
    }
    return false;
}

std::string Troublemaker::choose_place(Trouble trouble) {
    const auto& config = rig_.m.machine->config();
    if (source_of(trouble) == Source::bus) {
        if (trouble == Trouble::mailbox_stuck) {
            std::vector<std::string> drives;
            for (const auto& axis : config.axes)
                if (!axis.slave.empty() && axis.profile) drives.push_back(axis.slave);
            return drives.empty() ? "" : drives[below(drives.size())];
        }
        const bool of_a_slave = trouble == Trouble::slave_off || trouble == Trouble::cable_pulled || trouble == Trouble::state_changed;
        return of_a_slave ? config.bus.slaves[below(config.bus.slaves.size())].name : "";
    }
    if (source_of(trouble) == Source::drives) {
        std::vector<std::string> axes;
        for (const auto& axis : config.axes)
            if (rig_.m.world.drive(axis.axis.name) != nullptr) axes.push_back(axis.axis.name);
        return axes[below(axes.size())];
    }
    if (source_of(trouble) == Source::serial) {
        for (const auto& axis : config.axes)
            if (!axis.drive.empty()) return axis.axis.name;
    }
    if (trouble == Trouble::takes_others_axis) return Rogue::axis;
    if (source_of(trouble) == Source::programs) return "rogue";
    return {};
}

Blow Troublemaker::strike(Trouble trouble) {
    auto at = choose_place(trouble);
    const auto happening = rig_.begins(trouble, at);
    const Duration length = begin(trouble, at);
    under_way_.push_back({trouble, std::move(at), rig_.now() + length, happening});
    return {length, trouble == Trouble::answers_late ? rig_.m.world.transport().faults.delay : Duration{}};
}

Duration Troublemaker::begin(Trouble trouble, const std::string& at) {
    switch (source_of(trouble)) {
        case Source::bus: return begin_on_bus(trouble, at);
        default: return begin_beside(trouble, at);
    }
}

Duration Troublemaker::begin_on_bus(Trouble trouble, const std::string& at) {
    auto& faults = rig_.m.world.transport().faults;
    auto& cable = rig_.m.cable;
    switch (trouble) {
        case Trouble::frames_lost: (below(2) != 0 ? faults.drop_requests : faults.drop_answers) = 1 + below(2); return {};
        case Trouble::frames_lost_long: (below(2) != 0 ? faults.drop_requests : faults.drop_answers) = all; return between(5ms, 40ms);
        case Trouble::answers_late:
            faults.delay = between(1200us, 5000us);
            faults.delay_answers = all;
            return between(8ms, 30ms);
        case Trouble::counter_wrong:
            cable.working_counter_offset = below(2) != 0 ? -1 : static_cast<int>(1 + below(3));
            return between(5ms, 20ms);
        case Trouble::slave_off: rig_.m.world.set_slave_power(at, false); return between(5ms, 800ms);
        case Trouble::cable_pulled: rig_.m.world.set_cable(at, false); return between(20ms, 800ms);
        case Trouble::link_down: faults.link_down = true; return between(20ms, 500ms);
        case Trouble::state_changed:
            for (std::size_t s = 0; s < rig_.m.world.network().size(); ++s)
                if (rig_.m.world.network().slave(s).options().name == at) send_to_other_state(s);
            return {};
        case Trouble::mailbox_stuck:
            for (std::size_t s = 0; s < rig_.m.world.network().size(); ++s)
                if (auto& slave = rig_.m.world.network().slave(s); slave.options().name == at) slave.stick_mailbox(true);
            return between(500ms, 3000ms);
        case Trouble::reference_frozen: cable.freeze_reference_time = true; return between(300ms, 1000ms);
        default: return {};
    }
}

void Troublemaker::send_to_other_state(std::size_t slave) {
    constexpr std::array<std::uint16_t, 3> states{1, 2, 4};
    std::array<std::byte, ecat::min_frame_size> buffer{};
    ecat::FrameBuilder builder{buffer, ecat::MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
    const auto place = ecat::Address::position(static_cast<std::uint16_t>(slave), ecat::reg::al_control);
    store_le(builder.add(ecat::Command::APWR, 0x40, place, 2), 0, states[below(3)]);
    (void)builder.finish();
    (void)rig_.m.world.network().process(buffer, rig_.now());
    rig_.m.world.transport().inject(buffer, rig_.now());
}

Duration Troublemaker::begin_beside(Trouble trouble, const std::string& at) {
    auto& world = rig_.m.world;
    const auto happen = [&](runtime::SimulationEvent::Kind kind, const std::string& target, std::int64_t value) {
        runtime::SimulationEvent event;
        event.kind = kind;
        event.target = target;
        event.value = value;
        world.happen(event);
    };
    using Kind = runtime::SimulationEvent::Kind;
    const auto& config = rig_.m.machine->config();
    switch (trouble) {
        case Trouble::drive_fault: world.drive(at)->raise(0x3130); return {};
        case Trouble::mains_lost: happen(Kind::main_power, at, 0); return between(50ms, 1000ms);
        case Trouble::jammed: happen(Kind::jam, at, 0); return between(50ms, 600ms);
        case Trouble::line_cut: happen(Kind::serial_line, config.serial.front().name, 0); return between(300ms, 2000ms);
        case Trouble::serial_answers_lost: world.serial().line(config.serial.front().name)->lose_answers(1 + below(10)); return 500ms;
        case Trouble::serial_answers_damaged: world.serial().line(config.serial.front().name)->damage_answers(1 + below(10)); return 500ms;
        case Trouble::serial_drive_fault: happen(Kind::drive_fault, at, 13); return {};
        case Trouble::throws_in_scan:
        case Trouble::throws_in_stop:
        case Trouble::no_numbers:
        case Trouble::wrong_commands:
        case Trouble::takes_others_axis: Rogue::mischief = mischief_of(trouble); return between(5ms, 500ms);
        case Trouble::emergency_stop: world.set_input(input_of_emergency_stop(), false); return between(50ms, 2000ms);
        case Trouble::commands_at_random:
        case Trouble::mode_to_and_fro:
        case Trouble::stops_in_a_row:
        case Trouble::points_forced: return between(200ms, 1500ms);
        case Trouble::late_by_half: return 50 * config.cycle;
        case Trouble::stall_5ms: stall(5ms); return {};
        case Trouble::stall_20ms: stall(20ms); return {};
        case Trouble::stall_200ms: stall(200ms); return {};
        case Trouble::stall_2s: stall(2s); return {};
        case Trouble::disk_full: rig_.disk.fill(); return between(500ms, 3000ms);
        case Trouble::disk_read_only: rig_.disk.take_nothing(); return between(500ms, 3000ms);
        case Trouble::folder_gone: rig_.disk.take_away(); return between(500ms, 3000ms);
        case Trouble::bits_flipped:
            for (const auto* slot : {"retain.0", "retain.1"}) rig_.disk.flip_a_bit(rig_.disk.path() / "kept" / slot, random_);
            return {};
        default: return {};
    }
}

/// The computer does nothing for so long; the world goes on.
void Troublemaker::stall(Duration length) {
    rig_.m.clock.advance(length);
    rig_.m.world.network().advance(rig_.now());
    rig_.m.world.apply_events(rig_.now());
    const auto now = rig_.now();
    rig_.m.machine->cycle({now, now, static_cast<std::uint32_t>(length / rig_.m.machine->config().cycle)});
    rig_.m.machine->run_slow_tasks();
    rig_.m.machine->service(now);
    if (rig_.m.runner->drain) rig_.m.runner->drain();
    rig_.m.runner->after_cycle(now);
}

void Troublemaker::by_hand(Trouble trouble) {
    Hands hands{rig_, random_};
    switch (trouble) {
        case Trouble::commands_at_random:
            if (below(50) == 0) hands.do_anything();
            return;
        case Trouble::mode_to_and_fro:
            if (below(60) == 0) rig_.mode(static_cast<runtime::Mode>(below(3)));
            return;
        case Trouble::stops_in_a_row:
            if (below(10) == 0) {
                (void)rig_.m.machine->request_stop(below(2) != 0 ? 0xFFFF
                                                                 : static_cast<std::uint16_t>(below(rig_.m.machine->layout().axes.size())));
                rig_.happens(Deed::stop);
            }
            return;
        case Trouble::points_forced:
            if (below(40) == 0) hands.force_anything();
            return;
        case Trouble::late_by_half: {
            // This cycle came half a period after its time; the next ones are on the grid again.
            const auto& config = rig_.m.machine->config();
            rig_.m.clock.advance(config.cycle + config.cycle / 2);
            const auto now = rig_.now();
            rig_.m.world.network().advance(now);
            rig_.m.machine->cycle({now - config.cycle / 2, now, 0});
            rig_.m.machine->run_slow_tasks();
            rig_.m.machine->service(now);
            if (rig_.m.runner->drain) rig_.m.runner->drain();
            rig_.m.runner->after_cycle(now);
            return;
        }
        default: return;
    }
}

void Troublemaker::step() {
    for (std::size_t i = 0; i < under_way_.size();) {
        if (rig_.now() < under_way_[i].until) {
            by_hand(under_way_[i].trouble);
            ++i;
            continue;
        }
        const auto one = under_way_[i];
        under_way_.erase(under_way_.begin() + static_cast<std::ptrdiff_t>(i));
        end(one);
    }
}

void Troublemaker::end(const UnderWay& one) {
    auto& world = rig_.m.world;
    auto& faults = world.transport().faults;
    switch (one.trouble) {
        case Trouble::frames_lost:
        case Trouble::frames_lost_long: faults.drop_requests = faults.drop_answers = 0; break;
        case Trouble::answers_late: faults.delay_answers = 0; break;
        case Trouble::counter_wrong: rig_.m.cable.working_counter_offset = 0; break;
        case Trouble::slave_off: world.set_slave_power(one.at, true); break;
        case Trouble::cable_pulled: world.set_cable(one.at, true); break;
        case Trouble::link_down: faults.link_down = false; break;
        case Trouble::mailbox_stuck:
            for (std::size_t s = 0; s < world.network().size(); ++s) world.network().slave(s).stick_mailbox(false);
            break;
        case Trouble::reference_frozen: rig_.m.cable.freeze_reference_time = false; break;
        case Trouble::mains_lost:
        case Trouble::jammed: {
            runtime::SimulationEvent event;
            event.kind = one.trouble == Trouble::jammed ? runtime::SimulationEvent::Kind::jam : runtime::SimulationEvent::Kind::main_power;
            event.target = one.at;
            event.value = 1;
            world.happen(event);
            break;
        }
        case Trouble::line_cut: {
            runtime::SimulationEvent event;
            event.kind = runtime::SimulationEvent::Kind::serial_line;
            event.target = rig_.m.machine->config().serial.front().name;
            event.value = 1;
            world.happen(event);
            break;
        }
        case Trouble::serial_answers_lost:
        case Trouble::serial_answers_damaged:
            for (const auto& line : rig_.m.machine->config().serial) {
                world.serial().line(line.name)->lose_answers(0);
                world.serial().line(line.name)->damage_answers(0);
            }
            break;
        case Trouble::throws_in_scan:
        case Trouble::throws_in_stop:
        case Trouble::no_numbers:
        case Trouble::wrong_commands:
        case Trouble::takes_others_axis: Rogue::mischief = Mischief::none; break;
        case Trouble::emergency_stop: world.set_input(input_of_emergency_stop(), true); break;
        case Trouble::points_forced: (void)rig_.submit(runtime::OperatorAction::release_forces); break;
        case Trouble::disk_full:
        case Trouble::disk_read_only:
        case Trouble::folder_gone: rig_.disk.mend(); break;
        default: break;
    }
    rig_.ended(one.happening);
}

void Troublemaker::heal() {
    for (const auto& one : under_way_) end(one);
    under_way_.clear();
}

}  // namespace taktwerk::whole
