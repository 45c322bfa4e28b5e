#pragma once
// A random walk: one to four axes that may follow one another, and whatever programs, people, drives and buses may do to them. The oracle looks
// at each axis in each cycle, the ledger at each command. One seed is one walk, bit for bit.

#include <utility>

#include "tests/axes/axis/walk_ledger.hpp"

namespace taktwerk::axes::test {

/// Whether the axes of a walk have other limits in one direction than in the other.
enum class Directions : std::uint8_t { alike, differ };
/// Whether somebody turns the operator's override meanwhile: of its own, what the others draw stays what it was.
enum class Operators : std::uint8_t { away, at_the_override };

class CoupledWalk {
public:
    CoupledWalk(unsigned seed, WalkCounts& counts, Directions directions = Directions::alike, Operators operators = Operators::away)
        : counts_(counts),
          dice_(seed),
          operators_dice_(seed + 1'000'000),
          operators_(operators),
          rig_(any_axes(dice_, directions)),
          ledger_(rig_.axes.size()),
          any_(
              dice_, rig_.axes.size(), [this](std::size_t i) -> const AxisView& { return rig_.view(i); }, tables_),
          locks_(rig_.axes.size()),
          jogs_(rig_.axes.size()),
          told_(rig_.axes.size()) {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) any_drive(dice_, rig_.axes[i].config(), *rig_.drives[i]);
        tables_.declare(rig_.tables);
        for (auto& axis : rig_.axes) axis.bind({rig_.axes.data(), rig_.axes.size(), &rig_.tables, {}});
        rig_.program = [this] { program(); };
    }

    /// Text when something that must always hold did not.
    [[nodiscard]] std::string run(int cycles) {
        for (int i = 0; i < cycles && wrong_.empty(); ++i) {
            lively_ = true;
            step();
            if (dice_.once_in(4000)) come_to_rest();
        }
        come_to_rest();
        return wrong_;
    }
    [[nodiscard]] long cycles() const { return cycle_; }
    [[nodiscard]] const CouplingRig& rig() const { return rig_; }
    [[nodiscard]] CouplingRig& rig() { return rig_; }
    [[nodiscard]] const std::string& log() const { return log_; }
    bool logs = false;

private:
    [[nodiscard]] static std::vector<AxisConfig> any_axes(Dice& dice, Directions directions) {
        std::vector<AxisConfig> configs;
        for (auto i = 1 + dice.below(4); i > 0; --i) {
            configs.push_back(any_axis(dice));
            if (directions == Directions::differ) slower_one_way(dice, configs.back().limits);
            for (const auto& error : check(configs.back())) ADD_FAILURE() << error.text();
        }
        return configs;
    }
    static void slower_one_way(Dice& dice, AxisLimits& limits) {
        auto& slower = dice.once_in(2) ? limits.negative : limits.positive;
        slower.velocity = 45;  // homing is a little slower
        if (dice.once_in(2)) slower.acceleration = 550;
        if (dice.once_in(2)) slower.deceleration = 700;
    }
    void note(std::size_t axis, const std::string& what) {
        if (logs) log_ += fmt::format("{:6} axis {}: {}\n", cycle_, axis, what);
    }
    void tell_changes(std::size_t axis, const AxisView& view) {
        auto now = fmt::format("{}, active {} {}, {} wait, superimposed {}", name(view.state), view.active, walk_name(view.active_kind),
                               view.queued_count, view.side[static_cast<std::size_t>(SideSlot::superimposed)]);
        if (view.error != 0) now += fmt::format(", error {}", view.error);
        if (now == told_[axis]) return;
        note(axis, fmt::format("    {} at {} u, {} u/s, {} u/s2", now, view.set_position, view.set_velocity, view.set_acceleration));
        told_[axis] = std::move(now);
    }
    void count(std::string_view what) {
        const auto found = counts_.find(what);
        if (found == counts_.end()) counts_.emplace(what, 1);
        else ++found->second;
    }

    void step() {
        ++cycle_;
        rig_.step();
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
            const auto& view = rig_.view(i);
            if (logs) tell_changes(i, view);
            const auto lost = ledger_.follow(i, view, rig_.tables, counts_);
            if (!lost.empty()) wrong_ += fmt::format("cycle {}, axis {}: {}", cycle_, i, lost);
            if (!rig_.oracles[i].clean()) wrong_ += rig_.oracles[i].report();
            observe(view);
        }
    }
    /// What a walk must come by to prove anything.
    void observe(const AxisView& view) {
        static constexpr std::array states{"in Disabled",         "in Standstill",         "in Homing",   "in DiscreteMotion",
                                           "in ContinuousMotion", "in SynchronizedMotion", "in Stopping", "in ErrorStop"};
        count(states[static_cast<std::size_t>(view.state)]);
        const bool coupled = view.state == AxisState::SynchronizedMotion;
        const bool layered = view.side[static_cast<std::size_t>(SideSlot::superimposed)] != 0;
        const bool positioned = view.active_kind == CommandKind::gear_in_pos || view.active_kind == CommandKind::cam_in;
        if (coupled && positioned && !view.active_in_target && !view.sync_started && view.set_velocity != 0) {
            count("coupling waits in motion");
            if (layered) count("superimposed while a coupling waits");
        }
        if (coupled && view.active_in_target) count("in sync");
        if (coupled && layered && view.active_in_target) count("superimposed on a coupling");
        if (view.side[static_cast<std::size_t>(SideSlot::phasing)] != 0) count("phasing");
        if (view.sync_started) count("on the way to a sync point");
        if (view.queued_count > 0) count("commands wait");
        if (view.limiter == VelocityLimiter::override_factor) count("overridden");
        if (view.drive_mode == DriveMode::cyclic_torque) count("in torque");
        if (view.drive_mode <= DriveMode::profile_torque && view.drive_mode != DriveMode::none) count("in a profile of the drive");
    }

    // --- what happens in the program's step -------------------------------------------------------------------------------------

    void program() {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) feed(i);
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) stir(i);
        if (gap_ > 0 && --gap_ == 0) rig_.drives[gap_axis_]->silent = false;
        if (!lively_) return;
        if (operators_ == Operators::at_the_override) turn_override();
        if (!dice_.once_in(12)) return;
        const auto axis = dice_.below(static_cast<unsigned>(rig_.axes.size()));
        // Several in one scan: what a program of many blocks does.
        do act(axis);
        while (dice_.once_in(3));
    }
    /// Of one axis or of all: to nothing, to all, anywhere, or a little further, as a knob is turned.
    void turn_override() {
        if (knob_ > 0) --knob_;
        else if (!operators_dice_.once_in(40)) return;
        else if (operators_dice_.once_in(3)) knob_ = operators_dice_.below(60);
        const auto axes = static_cast<unsigned>(rig_.axes.size());
        const auto only = operators_dice_.below(axes + 1);  // the last: all
        double factor = operators_dice_.one_of({0.0, 1.0, 1e-9, operators_dice_.between(0, 1), operators_dice_.between(0, 0.05)});
        for (std::size_t i = 0; i < axes; ++i) {
            if (only < axes && only != i) continue;
            if (knob_ > 0) factor = std::clamp(rig_.view(i).operators_override + operators_dice_.between(-0.05, 0.05), 0.0, 1.0);
            if (rig_.axes[i].set_operators_override(factor) != ErrorId::none) wrong_ += "the operator's override was refused\n";
            note(i, fmt::format("the operator's override is {}", factor));
            count("operator's override");
            if (rig_.view(i).state == AxisState::SynchronizedMotion) count("operator's override of a coupling");
        }
    }
    void act(std::size_t axis) {
        const auto& view = rig_.view(axis);
        if (view.state == AxisState::ErrorStop || view.state == AxisState::Disabled) {
            if (dice_.once_in(3)) heal(axis);
        }
        const auto what = dice_.below(100);
        if (what < 62) submit(axis, any_(axis));
        else if (what < 68) set(axis, any_.any_setting(axis));
        else if (what < 74) set(axis, any_.any_override());
        else if (what < 82) update(axis);
        else if (what < 88) hold(axis);
        else if (what < 94) disturb(axis);
        else heal(axis);
    }
    void submit(std::size_t axis, AxisCommand command) {
        auto& it = rig_.axes[axis];
        const auto before = rig_.view(axis);
        // A cam is selected for each MC_CamIn, mostly.
        if (command.kind == CommandKind::cam_in && !dice_.once_in(4)) {
            set(axis, SelectCam{tables_.cams[dice_.below(3)], dice_.once_in(2), dice_.once_in(2), dice_.once_in(2)});
            if (auto* cam = std::get_if<CamDetails>(&command.details)) cam->table = rig_.view(axis).selected_cam;
        }
        const auto answer = it.submit(command, rig_.view(axis).owner);
        note(axis, fmt::format("{} mode {} p {} v {} -> {} error {}", walk_name(command.kind), static_cast<int>(command.buffer_mode),
                               command.position, command.velocity, answer.id, static_cast<int>(answer.error)));
        if ((answer.id == 0) == (answer.error == ErrorId::none))
            wrong_ += fmt::format("cycle {}, axis {}: {} was answered with id {} and error {}\n", cycle_, axis, walk_name(command.kind),
                                  answer.id, static_cast<int>(answer.error));
        if (answer.id == 0) {
            const auto& after = rig_.view(axis);
            if (command.kind == CommandKind::move_additive) return;  // what was given before it in this scan has its turn first
            if (after.active != before.active || after.state != before.state || after.queued_count != before.queued_count)
                wrong_ += fmt::format("cycle {}, axis {}: the refused {} changed the axis\n", cycle_, axis, walk_name(command.kind));
            return;
        }
        count(walk_name(command.kind));
        ledger_.accepted(axis, answer.id, command, cycle_);
        if (command.kind == CommandKind::stop) locks_[axis] = answer.id;
        if (command.kind == CommandKind::jog) jogs_[axis] = answer.id;
        if (rig_.view(axis).status(answer.id) == CommandStatus::queued)
            count(fmt::format("buffered in mode {}", static_cast<int>(command.buffer_mode)));
        const auto* point = std::get_if<GearInPosDetails>(&command.details);
        const auto* cam = std::get_if<CamDetails>(&command.details);
        if ((point && point->master_start_distance != 0) || (cam && cam->master_start_distance != 0)) count("waiting coupling");
    }
    void set(std::size_t axis, const AxisSetting& setting) {
        static constexpr std::array names{"SetPosition", "WriteParameter", "WriteOutput", "Override", "SetpointFeed", "SelectCam"};
        const auto error = rig_.axes[axis].set(setting, rig_.view(axis).owner);
        note(axis, fmt::format("{} -> {}", names[setting.index()], static_cast<int>(error)));
        if (error == ErrorId::none) count(names[setting.index()]);
    }
    /// ContinuousUpdate: another command of the same kind for the running one, or one that waits.
    void update(std::size_t axis) {
        const auto& view = rig_.view(axis);
        CommandId id = view.active;
        if (view.queued_count > 0 && dice_.once_in(4)) id = view.queued[0];
        if (const auto beside = view.side[static_cast<std::size_t>(SideSlot::superimposed)]; beside != 0 && dice_.once_in(3)) id = beside;
        if (id == 0) return;
        const bool layer = id == view.side[static_cast<std::size_t>(SideSlot::superimposed)];
        const auto kind = layer ? CommandKind::move_superimposed : view.active_kind;
        const auto command = any_.of(axis, kind);
        const auto error = rig_.axes[axis].update(id, command, view.owner);
        note(axis,
             fmt::format("update {} {} p {} v {} -> {}", id, walk_name(kind), command.position, command.velocity, static_cast<int>(error)));
        if (error != ErrorId::none) return;
        count("ContinuousUpdate");
        count(fmt::format("update {}", walk_name(kind)));
        if (id == view.active) ledger_.updated(axis, id, command);
    }
    /// What lives by being held.
    void hold(std::size_t axis) {
        auto& it = rig_.axes[axis];
        if (locks_[axis] != 0) it.release_stop(std::exchange(locks_[axis], 0), rig_.view(axis).owner);
        if (jogs_[axis] == 0) return;
        const bool renewed = it.renew_jog(jogs_[axis], dice_.between(-60, 60), rig_.view(axis).owner) == ErrorId::none;
        if (renewed) count("jog renewed");
        else jogs_[axis] = 0;
    }
    void feed(std::size_t axis) {
        const auto& view = rig_.view(axis);
        if (view.active_kind != CommandKind::external || !lively_ || dice_.once_in(30)) return;
        const double period = to_seconds(CouplingRig::cycle);
        const double acceleration = dice_.once_in(300) ? 1e5 : dice_.between(-400, 400) - 4 * view.set_velocity;
        const double velocity = view.set_velocity + acceleration * period;
        double position = view.set_position + (view.set_velocity + velocity) / 2 * period;
        if (view.modulo > 0) position -= view.modulo * std::floor(position / view.modulo);
        if (rig_.axes[axis].set(SetpointFeed{position, velocity, acceleration}, view.owner) == ErrorId::none) count("SetpointFeed");
    }
    /// What layers do to one another: a jog that changes its velocity, an addition replaced by a shorter or a reversed one, a base that takes the
    /// whole velocity and leaves room again.
    void stir(std::size_t axis) {
        if (!lively_) return;
        const auto& view = rig_.view(axis);
        const bool layered = view.side[static_cast<std::size_t>(SideSlot::superimposed)] != 0;
        const bool jogs = view.active_kind == CommandKind::jog;
        if (jogs && dice_.once_in(4)) {
            if (rig_.axes[axis].renew_jog(view.active, dice_.between(-110, 110), view.owner) == ErrorId::none && layered)
                count("jog renewed under an addition");
        }
        const auto add = [&](double most) {
            auto command = any_.of(axis, CommandKind::move_superimposed);
            command.position = dice_.between(-most, most);
            submit(axis, command);
        };
        if (jogs ? dice_.once_in(60) : layered && dice_.once_in(100)) {
            if (layered) count("addition replaced");
            add(jogs ? 5 : dice_.once_in(2) ? 1 : 20);
        }
        if (view.active_kind != CommandKind::move_velocity || !dice_.once_in(80)) return;
        if (!layered) {
            add(20);
            return;
        }
        auto command = at_velocity(dice_.once_in(2) ? dice_.one_of({-100.0, 100.0}) : dice_.between(-100, 100));
        if (dice_.once_in(3)) command.jerk = dice_.between(3000, 25'000);
        const auto id = view.active;
        if (rig_.axes[axis].update(id, command, view.owner) != ErrorId::none) return;
        note(axis, fmt::format("update {} under an addition: v {} jerk {}", id, command.velocity, command.jerk));
        count("base updated under an addition");
        ledger_.updated(axis, id, command);
    }
    void disturb(std::size_t axis) {
        auto& drive = *rig_.drives[axis];
        auto& it = rig_.axes[axis];
        const auto event = dice_.below(40);
        note(axis, fmt::format("disturbance {}", event));
        switch (event) {
            case 0:
                drive.fault_code = 0x7500;
                count("drive fault");
                break;
            case 1:
                rig_.enabled[axis] = false;
                count("power off");
                break;
            case 2:
                drive.silent = true;
                count("feedback lost");
                break;
            case 3:
                drive.offline = true;
                count("bus lost");
                break;
            case 4:
                it.demand_emergency_stop(
                    dice_.one_of({EmergencyStop::stop, EmergencyStop::stop_and_power_off, EmergencyStop::power_off_now}));
                count("emergency stop");
                break;
            case 5:
                drive.refuses_power = true;
                count("power lost");
                break;
            case 6:
                it.set_mode(static_cast<OperatingMode>(dice_.below(3)));
                count("operating mode");
                break;
            case 7:
                it.take_control(static_cast<Owner>(1 + dice_.below(3)));
                count("control taken");
                break;
            case 8:
                it.shut_down();
                count("shut down");
                break;
            case 9:
                it.stop_for_error(AlarmId{4711}, dice_.once_in(2));
                count("stopped by machine");
                break;
            case 10:
            case 11:
                drive.silent = true;
                count("feedback gap");
                gap_ = 1 + static_cast<int>(dice_.below(3));
                gap_axis_ = axis;
                break;
            case 12: drive.warning = !drive.warning; break;
            case 13:
                drive.blocked = !drive.blocked;
                count("blocked");
                break;
            case 14: drive.load = dice_.between(-0.1, 0.1); break;
            case 15: drive.coasting = dice_.between(-20, 20); break;
            case 16:
                rig_.permits[axis] = static_cast<std::uint8_t>(dice_.below(4));
                count("direction not permitted");
                break;
            default: drive.lag = static_cast<std::int64_t>(dice_.below(40)); break;
        }
    }
    void heal(std::size_t axis) {
        auto& drive = *rig_.drives[axis];
        auto& it = rig_.axes[axis];
        drive.fault_code = 0;
        drive.silent = drive.offline = drive.refuses_power = drive.blocked = drive.warning = false;
        drive.coasting = 0;
        rig_.enabled[axis] = true;
        rig_.permits[axis] = 3;
        it.demand_emergency_stop(EmergencyStop::none);
        (void)it.reset(rig_.view(axis).owner);
        note(axis, "healed");
        count("reset");
    }

    // --- the end of everything ---------------------------------------------------------------------------------------------------

    /// Nothing new is asked; what was accepted comes to its end, or may last. Then all are stopped, and everything is over.
    void come_to_rest() {
        if (!wrong_.empty()) return;
        lively_ = false;
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
            heal(i);
            auto& it = rig_.axes[i];
            it.set_mode(OperatingMode::automatic);
            it.take_control(Owner::program);
            (void)it.set(Override{}, Owner::program);
            if (operators_ == Operators::at_the_override) (void)it.set_operators_override(1);
            if (rig_.view(i).lock != 0) it.release_stop(rig_.view(i).lock, Owner::program);
            locks_[i] = jogs_[i] = 0;
        }
        const auto unfinished = [&](WalkLedger::Patience patience) {
            std::string out;
            for (std::size_t i = 0; i < rig_.axes.size(); ++i)
                if (const auto text = ledger_.unfinished(i, rig_.view(i), patience); !text.empty())
                    out += fmt::format("axis {}: {}", i, text);
            return out;
        };
        constexpr int longest =
            60'000;  // cycles: 250 u (coordinates are shifted) at 8 u/s with the ramps, some in a row, and their searches
        for (int i = 0; i < longest && wrong_.empty() && !(i % 16 == 0 && unfinished(WalkLedger::Patience::left).empty()); ++i)
            quiet_step();
        if (wrong_.empty()) wrong_ = unfinished(WalkLedger::Patience::over);
        if (!wrong_.empty()) return;
        count("came to an end");
        for (int i = 0; i < 8000 && wrong_.empty() && !all_rest(); ++i) {
            if (i % 500 == 0) stop_all();
            if (i % 500 == 400) release_all();
            quiet_step();
        }
        if (!wrong_.empty()) return;
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
            const auto& view = rig_.view(i);
            if (view.state != AxisState::Standstill)
                wrong_ += fmt::format("axis {} does not come to rest: {}, error {}\n", i, name(view.state), view.error);
            end_signals(i);
        }
        quiet_step();
        for (std::size_t i = 0; i < rig_.axes.size(); ++i)
            if (const auto text = ledger_.left_over(i); !text.empty()) wrong_ += fmt::format("cycle {}, axis {}: {}", cycle_, i, text);
        count("came to rest");
    }
    void quiet_step() {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
            // What waited may have been another override: at 0 the axis would be held for ever, and rightly so.
            if (rig_.view(i).override_factors != Override{}) (void)rig_.axes[i].set(Override{}, Owner::program);
            if (rig_.view(i).state == AxisState::ErrorStop && !rig_.view(i).resetting) (void)rig_.axes[i].reset(Owner::program);
        }
        step();
    }
    [[nodiscard]] bool all_rest() const {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i)
            if (rig_.view(i).state != AxisState::Standstill) return false;
        return true;
    }
    void stop_all() {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
            const auto answer = rig_.axes[i].submit(test::stop(), Owner::program);
            if (answer.id == 0) continue;
            locks_[i] = answer.id;
            ledger_.accepted(i, answer.id, test::stop(), cycle_);
        }
    }
    void release_all() {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i)
            if (locks_[i] != 0) rig_.axes[i].release_stop(std::exchange(locks_[i], 0), Owner::program);
    }
    void end_signals(std::size_t axis) {
        auto& it = rig_.axes[axis];
        (void)it.submit({.kind = CommandKind::abort_passive_homing}, Owner::program);
        for (const auto source : {TriggerSource::probe1, TriggerSource::probe2, TriggerSource::index_pulse, TriggerSource::home_switch})
            for (const bool falling : {false, true})
                (void)it.submit(
                    {.kind = CommandKind::abort_trigger, .details = ProbeDetails{.trigger = {.source = source, .falling = falling}}},
                    Owner::program);
    }

    WalkCounts& counts_;
    Dice dice_, operators_dice_;
    Operators operators_;
    unsigned knob_ = 0;  // so many further turns of it
    CouplingRig rig_;
    WalkTables tables_;
    WalkLedger ledger_;
    AnyCommand any_;
    std::vector<CommandId> locks_, jogs_;
    std::vector<std::string> told_;
    long cycle_ = 0;
    int gap_ = 0;
    std::size_t gap_axis_ = 0;
    bool lively_ = true;
    std::string wrong_, log_;
};

}  // namespace taktwerk::axes::test
