#pragma once
// A random walk: a master that does what it likes, and a slave that couples to it, catches up, and is taken away again. One seed is one walk.

#include <array>
#include <optional>
#include <utility>

#include "axes/axis/command_check.hpp"
#include "axes/planner/plan.hpp"
#include "tests/axes/axis/coupling_rig.hpp"
#include "tests/axes/axis/gear_oracle.hpp"
#include "tests/axes/axis/walk_axes.hpp"

namespace taktwerk::axes::test {

struct GearCounts {
    long cycles = 0, catching_up = 0, in_gear = 0, hard_stops = 0, hard_stops_on_the_way = 0, taken_away = 0, timed = 0, outside = 0,
         reversals = 0, measured = 0;
};

class GearWalk {
public:
    GearWalk(unsigned seed, GearCounts& counts) : counts_(counts), dice_(seed), measured_(dice_.once_in(3)), rig_(configs()) {
        reverses_ = dice_.once_in(4);
        sense_ = dice_.once_in(2) ? 1 : -1;
        if (measured_) {
            for (auto& drive : rig_.drives) {
                drive->latch_age = 1 + static_cast<int>(dice_.below(3));
                drive->dead_cycles = 1 + static_cast<int>(dice_.below(3));
            }
        }
    }

    [[nodiscard]] std::string run(int length) {
        rig_.start();
        for (int i = 0; i < length && wrong_.empty(); ++i) {
            move_master();
            move_slave();
            step();
        }
        if (wrong_.empty()) come_into_gear();
        return wrong_;
    }
    [[nodiscard]] const std::string& log() const { return log_; }
    bool logs = false;

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    [[nodiscard]] double any_jerk(double low, double high) {
        return dice_.once_in(3) ? infinite : low * std::pow(high / low, dice_.between(0, 1));
    }
    [[nodiscard]] std::vector<AxisConfig> configs() {
        auto master = plain_axis(), slave = plain_axis();
        master.limits = {.velocity = 100,
                         .acceleration = dice_.between(200, 3000),
                         .deceleration = dice_.between(200, 4000),
                         .jerk = any_jerk(2000, 200'000),
                         .stop_deceleration = dice_.between(1000, 30'000)};
        if (dice_.once_in(2)) master.limits.stop_jerk = infinite;
        master.encoder = measured_;
        if (measured_ && dice_.once_in(2)) master.gearing.counts_per_revolution = 5000;
        slave.limits = {.velocity = dice_.once_in(4) ? 40.0 : 100.0,
                        .acceleration = dice_.between(300, 2000),
                        .deceleration = dice_.between(300, 2000),
                        .jerk = any_jerk(1000, 100'000)};
        return {master, slave};
    }
    template <class... Args>
    void note(fmt::format_string<Args...> text, Args&&... args) {
        if (logs) log_ += fmt::format("{:6} ", cycle_) + fmt::format(text, std::forward<Args>(args)...) + '\n';
    }

    // --- the master

    /// A velocity in its sense, or in any where it reverses on purpose.
    [[nodiscard]] double any_velocity() {
        const double speed = dice_.once_in(6) ? 0 : dice_.between(1, 95);
        return (reverses_ && dice_.once_in(2) ? -sense_ : sense_) * speed;
    }
    void move_master() {
        if (measured_) return turn_encoder();
        auto& axis = rig_.axes[0];
        const auto& view = rig_.view(0);
        if (view.state == AxisState::ErrorStop && view.set_velocity == 0) (void)axis.reset(Owner::program);
        if (stop_ != 0 && view.state == AxisState::Stopping) axis.release_stop(std::exchange(stop_, 0), Owner::program);
        if (!dice_.once_in(pace_)) return;
        pace_ = dice_.one_of({20u, 60u, 200u});
        AxisCommand command = at_velocity(any_velocity());
        const auto dynamics = [&] {
            if (dice_.once_in(2)) command.acceleration = dice_.between(20, 3000);
            if (dice_.once_in(2)) command.deceleration = dice_.between(20, 4000);
            if (dice_.once_in(2)) command.jerk = dice_.between(1000, 200'000);
        };
        switch (dice_.below(8)) {
            case 0:
            case 1:  // the emergency stop
                axis.stop_for_error(AlarmId{4711}, false);
                note("master: emergency stop at {}", view.set_velocity);
                hard_stop();
                return;
            case 2: {
                command = stop();
                command.deceleration = 30'000;
                stop_ = axis.submit(command, Owner::program).id;
                note("master: stop at {}", view.set_velocity);
                hard_stop();
                return;
            }
            case 3:
                command = halt();
                dynamics();
                break;
            case 4:
                // From rest only: a move whose target the axis passes would turn back.
                if (view.set_velocity == 0) command = relative(sense_ * dice_.between(0.1, 20), dice_.between(5, 95));
                dynamics();
                break;
            default: dynamics(); break;
        }
        (void)axis.submit(command, Owner::program);
        note("master: {} to {} (acc {} dec {} jerk {})", static_cast<int>(command.kind), command.velocity, command.acceleration,
             command.deceleration, command.jerk);
    }
    void turn_encoder() {
        if (dice_.once_in(pace_)) {
            pace_ = dice_.one_of({20u, 100u, 400u});
            wanted_ = any_velocity();
            ramp_ = dice_.once_in(3) ? 1e9 : dice_.between(50, 4000);
            note("encoder: to {} with {}", wanted_, ramp_);
            if (ramp_ > 5000) hard_stop();
        }
        turns_ += std::clamp(wanted_ - turns_, -ramp_ * period, ramp_ * period);
        recent_[static_cast<std::size_t>(cycle_) % recent_.size()] = turns_;
        rig_.drives[0]->coasting = turns_ * rig_.axes[0].config().gearing.counts_per_unit() * period;
    }
    void hard_stop() {
        ++counts_.hard_stops;
        if (oracle_) ++counts_.hard_stops_on_the_way;
    }
    /// As its gear gives it to the slave.
    [[nodiscard]] GearOracle::Motion master() const {
        if (measured_) return {ratio_ * turns_, 0};
        return {ratio_ * rig_.view(0).set_velocity, ratio_ * rig_.view(0).set_acceleration};
    }

    // --- the slave

    void move_slave() {
        const auto& view = rig_.view(1);
        const bool coupled = view.state == AxisState::SynchronizedMotion;
        if (oracle_ && coupled) {
            if (dice_.once_in(300)) take_away();
            return;
        }
        if (coupled ? dice_.once_in(100) : dice_.once_in(30)) return couple(coupled && dice_.once_in(2));
        if (coupled && dice_.once_in(60)) return take_away();
        if (coupled || !dice_.once_in(30)) return;
        auto command = dice_.once_in(4) ? halt() : at_velocity(dice_.between(-90, 90));
        (void)rig_.axes[1].submit(command, Owner::program);
        note("slave: {} to {}", static_cast<int>(command.kind), command.velocity);
    }
    void take_away() {
        if (oracle_) ++counts_.taken_away;
        switch (dice_.below(4)) {
            case 0: (void)rig_.axes[1].submit(halt(), Owner::program); break;
            case 1: (void)rig_.axes[1].submit(gear_out(), Owner::program); break;
            case 2: {
                const auto id = rig_.axes[1].submit(stop(), Owner::program).id;
                rig_.axes[1].release_stop(id, Owner::program);
                break;
            }
            default: return couple(false);
        }
        note("slave: taken away at {} u/s, {} u/s2", rig_.view(1).set_velocity, rig_.view(1).set_acceleration);
        oracle_.reset();
    }
    void couple(bool updates) {
        const auto numerator = dice_.one_of({1, 1, -1, 2, -3, 3, -2}), denominator = dice_.one_of({1, 1, 2, 3});
        auto command = gear_in(0, numerator, denominator);
        if (measured_) std::get<GearDetails>(command.details).source = mcActualValue;
        if (dice_.once_in(2)) command.acceleration = dice_.between(200, 2000);
        if (dice_.once_in(2)) command.deceleration = dice_.between(200, 2000);
        if (dice_.once_in(2)) command.jerk = dice_.between(1000, 100'000);
        const auto& view = rig_.view(1);
        const auto done =
            updates ? rig_.axes[1].update(view.active, command, Owner::program) : rig_.axes[1].submit(command, Owner::program).error;
        if (done != ErrorId::none) return;
        begin(command);
    }
    void begin(const AxisCommand& command) {
        const auto& details = std::get<GearDetails>(command.details);
        ratio_ = static_cast<double>(details.ratio.numerator) / static_cast<double>(details.ratio.denominator);
        const auto& config = rig_.axes[1].config();
        const auto limits = dynamics_of(command, config.limits, config.defaults);
        GearOracle::Measured measured;
        if (measured_) {
            // The filter lets 0.22 of a count pass into a cycle, and as much of those before (axes/coupling/master_track.cpp); steps of velocity it
            // answers with a place 13 % too far, extrapolated over up to six cycles of the dead time.
            measured.noise = 1.5 * std::abs(ratio_) / rig_.axes[0].config().gearing.counts_per_unit() / period;
            measured.overshoot = 0.6;
            measured.unrest = 5;
            measured.low = ratio_ * *std::min_element(recent_.begin(), recent_.end());
            measured.high = ratio_ * *std::max_element(recent_.begin(), recent_.end());
            if (ratio_ < 0) std::swap(measured.low, measured.high);
        }
        const auto& view = rig_.view(1);
        oracle_.emplace(limits, period, measured, GearOracle::Motion{view.set_velocity, view.set_acceleration}, master());
        steady_ = std::nullopt;
        if (!measured_ && rig_.view(0).set_acceleration == 0 && std::abs(master().velocity) < config.limits.velocity)
            steady_ = plan_to_velocity({0, view.set_velocity, view.set_acceleration}, master().velocity, limits).profile.duration();
        // Through zero the smaller of acceleration and deceleration holds, and what jerk the former motion needs is raised.
        if (view.set_velocity * master().velocity < 0 || view.set_acceleration != 0) steady_ = std::nullopt;
        since_ = 0;
        steady_at_ = master().velocity;
        note("slave: gear {} (acc {} dec {} jerk {}) from {} u/s, {} u/s2; the master's {} u/s, {} u/s2", ratio_, limits.acceleration,
             limits.deceleration, limits.jerk, view.set_velocity, view.set_acceleration, master().velocity, master().acceleration);
    }

    // --- a cycle

    void step() {
        ++cycle_;
        ++counts_.cycles;
        if (measured_) ++counts_.measured;
        rig_.step();
        const auto& view = rig_.view(1);
        if (!rig_.clean())
            for (const auto& oracle : rig_.oracles) wrong_ += oracle.report();
        const bool coupled = view.state == AxisState::SynchronizedMotion;
        const bool in_gear = coupled && view.active_in_target;
        if (in_gear) ++counts_.in_gear;
        if (logs && coupled)
            note("  {} {:.6f} u/s {:.3f} u/s2; asked for {:.6f} u/s {:.3f} u/s2", in_gear ? "in gear" : "catching up", view.set_velocity,
                 view.set_acceleration, master().velocity, master().acceleration);
        if (!oracle_) return;
        if (!coupled) return oracle_.reset();
        ++since_;
        ++counts_.catching_up;
        oracle_->observe({view.set_velocity, view.set_acceleration}, master(), in_gear);
        if (!oracle_->clean()) wrong_ += oracle_->report();
        if (std::abs(master().velocity - steady_at_) > 1e-9) steady_ = std::nullopt;
        // As soon as a slave can be that has no master to wait for.
        if (steady_ && !in_gear && static_cast<double>(since_) > *steady_ / period + 2)
            wrong_ += fmt::format("not in gear with a steady master {} cycles after the command; {} s are enough\n", since_, *steady_);
        if (!in_gear) return;
        if (steady_) ++counts_.timed;
        counts_.outside += oracle_->outside();
        counts_.reversals += oracle_->reversed();
        oracle_.reset();
    }
    /// Whatever happened: behind a master that runs steadily the slave comes into gear, and on a measured one as calmly as on any.
    void come_into_gear() {
        auto& master_axis = rig_.axes[0];
        (void)rig_.axes[1].submit(halt(), Owner::program);
        oracle_.reset();
        wanted_ = sense_ * 30;
        ramp_ = 1000;
        pace_ = 1u << 30;
        for (int i = 0; i < 1500 && wrong_.empty(); ++i) {
            if (measured_) turn_encoder();
            else if (rig_.view(0).state == AxisState::ErrorStop) (void)master_axis.reset(Owner::program);
            else if (i == 700) (void)master_axis.submit(at_velocity(wanted_), Owner::program);
            step();
        }
        auto command = gear_in(0);
        if (measured_) std::get<GearDetails>(command.details).source = mcActualValue;
        rig_.accept(1, command);
        begin(command);
        double way = 0, before = rig_.view(1).set_velocity;
        int cycles = 0;
        for (; cycles < 3000 && oracle_ && wrong_.empty(); ++cycles) {
            if (measured_) turn_encoder();
            step();
            way += std::abs(rig_.view(1).set_velocity - before);
            before = rig_.view(1).set_velocity;
        }
        if (oracle_ && wrong_.empty()) wrong_ = fmt::format("not in gear {} cycles after the command\n", cycles);
        // From rest to 30 u/s, and not up and down.
        const double noise = measured_ ? 10 / rig_.axes[0].config().gearing.counts_per_unit() / period : 0;
        if (wrong_.empty() && way > 30 * 1.05 + noise) wrong_ = fmt::format("shakes: {} u/s of changes on the way to 30 u/s\n", way);
    }

    static constexpr double period = 1e-3;
    GearCounts& counts_;
    Dice dice_;
    bool measured_;
    CouplingRig rig_;
    bool reverses_ = false;
    double sense_ = 1;
    double wanted_ = 0, turns_ = 0, ramp_ = 1000;  // of the encoder: u/s, u/s2
    std::array<double, 100> recent_{};             // of the encoder, u/s: as long as its filter remembers
    unsigned pace_ = 20;
    CommandId stop_ = 0;
    double ratio_ = 1;
    std::optional<GearOracle> oracle_;  // while the slave catches up
    std::optional<double> steady_;      // s that it needs, as long as the master is steady
    double steady_at_ = 0;
    long since_ = 0, cycle_ = 0;
    std::string wrong_, log_;
};

}  // namespace taktwerk::axes::test
