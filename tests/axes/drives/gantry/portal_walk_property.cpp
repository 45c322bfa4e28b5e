// A portal, or one drive, with what an axis may have beside its motor: a brake that the controller works, an encoder at the load, other limits in one direction,
// reactions of its own. Whatever is asked of it and whatever falls: the motion is one that the oracle takes, no brake is open without torque, no power
// goes before a brake has closed, and of a portal no side is left alone or racked unseen.
//
// A failure names its seed; TAKTWERK_WALK_SEED=<seed> runs that walk alone and tells all that was asked in it.

#include <map>
#include <optional>

#include "axes/drives/gantry/gantry_port.hpp"
#include "tests/axes/axis/walk_commands.hpp"
#include "tests/walk_seeds.hpp"

namespace taktwerk::axes::test {
namespace {

using PortalCounts = std::map<std::string, long, std::less<>>;

/// A drive that belongs to somebody else.
class Lent final : public DrivePort {
public:
    explicit Lent(FakeDrive& drive) : drive_(drive) {}
    [[nodiscard]] const DriveCapabilities& capabilities() const noexcept override { return drive_.capabilities(); }
    [[nodiscard]] Instant setpoint_effective(Instant send) const noexcept override { return drive_.setpoint_effective(send); }
    [[nodiscard]] DriveAlarm alarm() const noexcept override { return drive_.alarm(); }
    /// A quick stop is for a drive that has power: asked of another one it asks for none (axes/drives/cia402/encode.cpp).
    void encode(const DriveCommand& command, Instant now) noexcept override {
        auto told = command;
        const bool stops = drive_.power == PowerState::enabled || drive_.power == PowerState::quick_stop;
        if (told.power == PowerRequest::quick_stop && !stops) told.power = PowerRequest::off;
        drive_.encode(told, now);
    }
    const DriveFeedback& decode(Instant now) noexcept override { return drive_.decode(now); }

private:
    FakeDrive& drive_;
};

class PortalWalk {
public:
    PortalWalk(unsigned seed, PortalCounts& counts)
        : counts_(counts),
          dice_(seed),
          config_(any_portal(dice_)),
          mirrored_(dice_.once_in(2)),
          axis_(config_, port(), cycle),
          oracle_(config_, cycle),
          any_(
              dice_, 1, [this](std::size_t) -> const AxisView& { return axis_.view(); }, tables_) {
        for (const auto& error : check(config_)) ADD_FAILURE() << error.text();
        tables_.declare(tables_of_axis_);
        axis_.bind({&axis_, 1, &tables_of_axis_, load_});
        right_.position = 4321;
        for (auto* side : {&left_, &right_}) {
            side->dead_cycles = 1;
            side->power_delay = 1 + static_cast<int>(dice_.below(6));
        }
    }

    [[nodiscard]] std::string run(int cycles) {
        for (int i = 0; i < cycles && wrong_.empty(); ++i) step(true);
        if (!wrong_.empty()) return wrong_;
        // Whatever was: it can be stopped, reset and moved again.
        heal();
        for (int i = 0; i < 6000 && wrong_.empty() && !(axis_.view().state == AxisState::Standstill && i > 1000); ++i) {
            if (axis_.view().state == AxisState::ErrorStop && !axis_.view().resetting) (void)axis_.reset(Owner::program);
            if (i % 1000 == 10) lock_ = axis_.submit(stop(), Owner::program).id;
            if (i % 1000 == 700 && lock_ != 0) axis_.release_stop(std::exchange(lock_, 0), Owner::program);
            if (axis_.view().brake == BrakeState::closed && axis_.view().state == AxisState::Standstill)
                (void)axis_.set(SetBrake{true}, Owner::program);
            step(false);
        }
        if (wrong_.empty() && axis_.view().state != AxisState::Standstill)
            wrong_ = fmt::format("does not come to rest: {}, error {}\n", name(axis_.view().state), axis_.view().error);
        else ++counts_["came to rest"];
        return wrong_;
    }
    [[nodiscard]] const std::string& log() const { return log_; }
    bool logs = false;

private:
    static constexpr Duration cycle = 1ms;

    static AxisConfig any_portal(Dice& dice) {
        auto config = plain_axis();
        auto& limits = config.limits;
        if (dice.once_in(2)) limits.jerk = infinity;
        limits.stop_deceleration = 3000;
        if (dice.once_in(2)) limits.negative = {.velocity = 45, .acceleration = dice.once_in(2) ? 550.0 : 0, .deceleration = 700};
        config.gearing.inverted = dice.once_in(2);
        config.queue_depth = 8;
        if (dice.once_in(4)) config.modulo = 25;
        if (dice.once_in(4)) config.following.window = 3;
        if (dice.once_in(3)) config.following.per_velocity = 10ms;
        if (!std::isfinite(config.following.window)) config.following.per_velocity = {};
        if (!dice.once_in(4)) config.gantry = {.on = true, .warning = dice.once_in(2) ? 0.2 : 0, .error = 0.5};
        config.brake.by = BrakeBy::output;
        config.brake.release = std::chrono::milliseconds{dice.below(60)};
        config.brake.engage = std::chrono::milliseconds{dice.below(60)};
        config.brake.release_without_power = dice.once_in(3);
        if (dice.once_in(2))
            config.load_encoder = {.on = true, .input = 0, .counts_per_unit = 100, .tolerance = 0.5, .shown = dice.once_in(2)};
        if (config.gantry.on) choose_for_gantry(config.reactions);
        using enum ErrorReaction;
        if (dice.once_in(2))
            config.reactions.choose(AxisAlarm::drive_warning, dice.one_of({warn, ramp_stop, ramp_then_off, quick_stop, power_off}));
        if (dice.once_in(3)) config.reactions.choose(AxisAlarm::drive_fault, dice.one_of({ramp_then_off, quick_stop, power_off}));
        if (dice.once_in(3)) config.reactions.choose(AxisAlarm::following_error, dice.one_of({warn, ramp_then_off, quick_stop, power_off}));
        if (dice.once_in(3)) config.reactions.choose(AxisAlarm::axis_feedback_lost, dice.one_of({ramp_then_off, quick_stop, power_off}));
        if (dice.once_in(3))
            config.reactions.choose(AxisAlarm::gantry_skew, dice.one_of({ramp_stop, ramp_then_off, quick_stop, power_off}));
        if (dice.once_in(3)) config.reactions.choose(AxisAlarm::load_deviation, dice.one_of({ramp_stop, ramp_then_off, power_off}));
        return config;
    }
    DrivePort& port() {
        if (!config_.gantry.on) return alone_port_;
        gantry_.emplace(std::make_unique<Lent>(left_), std::make_unique<Lent>(right_), mirrored_);
        return *gantry_;
    }
    void breach(const std::string& what) {
        if (wrong_.size() < 2000) wrong_ += fmt::format("cycle {}, {}: {}\n", cycle_count_, name(axis_.view().state), what);
    }
    void note(const std::string& what) {
        if (logs) log_ += fmt::format("{:6} {}\n", cycle_count_, what);
    }

    void step(bool lively) {
        ++cycle_count_;
        now_ += cycle;
        const auto motor = std::llround(left_.position);
        if (config_.load_encoder.on) load_[0] = (motor + slipped_) * (config_.gearing.inverted ? -1 : 1) / 10;
        axis_.update(now_);
        axis_.supervise(now_);
        fetch();
        axis_.power(enable_, true, true, axis_.view().owner);
        if (lively && dice_.once_in(15)) act();
        axis_.plan(now_, cycle);
        axis_.encode(now_);
        fetch();
        oracle_.observe(axis_.view(), axis_.drive_command(), axis_.config().limits);
        if (!oracle_.clean()) wrong_ += oracle_.report();
        check_brake();
        check_power(left_, left_seen_);
        if (config_.gantry.on) {
            check_power(right_, right_seen_);
            check_sides();
        }
        if (logs && axis_.view().state != told_)
            note(fmt::format("    {} at {} u/s, error {}, left {}, right {}", name(axis_.view().state), axis_.view().set_velocity,
                             axis_.view().error, static_cast<int>(left_.power), static_cast<int>(right_.power)));
        told_ = axis_.view().state;
        if (axis_.view().state == AxisState::ErrorStop) ++counts_["in ErrorStop"];
        if (axis_.view().brake == BrakeState::opening) ++counts_["brake opens"];
        if (axis_.view().brake == BrakeState::closing) ++counts_["brake closes"];
    }
    void fetch() {
        AlarmFact fact;
        while (axis_.fetch_alarm(fact)) {
            ++counts_[fmt::format("alarm {}", find_alarm(axis_alarms, fact.id)->name)];
            note(fmt::format("    alarm {}", find_alarm(axis_alarms, fact.id)->name));
        }
    }

    // --- what must hold ---------------------------------------------------------------------------------------------------------

    [[nodiscard]] static bool gives_torque(const FakeDrive& drive) {
        return drive.power == PowerState::enabled || drive.power == PowerState::quick_stop;
    }
    /// Open only where a drive holds the load, but for the cycles that a lost answer takes to be noticed; or by hand, where the file permits it.
    void check_brake() {
        const auto& view = axis_.view();
        const bool open = left_.last.brake == BrakeRequest::open;
        const bool held = gives_torque(left_) || (config_.gantry.on && gives_torque(right_));
        const bool heard = !left_.silent && !left_.offline && (!config_.gantry.on || (!right_.silent && !right_.offline));
        if (by_hand_ > 0) by_hand_ = open ? 3 : by_hand_ - 1;  // until it is closed again
        if (axis_.view().powered) by_hand_ = 0;
        loose_ = open && (!held || !heard) && by_hand_ == 0 ? loose_ + 1 : 0;
        if (loose_ == 6)
            breach(fmt::format("the brake is open, power is {} and {}, heard {}", static_cast<int>(left_.power),
                               static_cast<int>(right_.power), heard));
        // Motion only where it is open.
        const bool opened = view.brake == BrakeState::open;
        if (view.set_velocity != 0 && view.powered && view.online && !opened && view.state != AxisState::ErrorStop)
            breach(fmt::format("moves at {} u/s with its brake {}", view.set_velocity, static_cast<int>(view.brake)));
        closed_for_ = open ? 0 : closed_for_ + 1;
    }
    struct Seen {
        PowerRequest asked = PowerRequest::off;
        PowerState power = PowerState::disabled;
        bool opened = false;  // the brake, since it came
        std::int64_t felt = 0;
    };
    /// Power that nobody takes at once goes when the brake has had its time.
    void check_power(const FakeDrive& drive, Seen& seen) {
        const bool asked_off =
            seen.asked == PowerRequest::on && drive.last.power == PowerRequest::off && drive.power == PowerState::enabled;
        const bool at_once = emergency_ == EmergencyStop::power_off_now || axis_.view().state == AxisState::ErrorStop;
        if (drive.power != PowerState::enabled) seen.opened = false;
        else if (left_.last.brake == BrakeRequest::open) seen.opened = true;
        if (asked_off && !at_once && seen.opened && by_hand_ == 0 && closed_for_ * cycle < config_.brake.engage)
            breach(fmt::format("power goes {} cycles after the brake was told to close", closed_for_));
        if (asked_off) ++counts_["power taken"];
        // What the motor would feel: a target that is where it was, as fast as the axis may be. What comes back from another mode in motion is ahead by the
        // dead time, two cycles.
        const auto most = static_cast<std::int64_t>(2 * config_.limits.velocity) + 60;
        if (drive.largest_step > most && seen.felt <= most)
            breach(fmt::format("a drive was told to jump by {} counts", drive.largest_step));
        seen.felt = drive.largest_step;
        seen.asked = drive.last.power;
        seen.power = drive.power;
    }
    void check_sides() {
        const auto& view = axis_.view();
        const bool first = left_.power == PowerState::enabled, second = right_.power == PowerState::enabled;
        // Both are told the same.
        const auto between = (mirrored_ ? -1 : 1) * right_.last.position - left_.last.position;
        if (first && second && both_ > 2) {
            if (between != between_) breach(fmt::format("the sides are told places that differ by {} after {} counts", between, between_));
            if (left_.last.velocity != (mirrored_ ? -1 : 1) * right_.last.velocity) breach("the sides are told different velocities");
            ++counts_["both powered"];
        }
        between_ = between;
        both_ = first && second ? both_ + 1 : 0;
        // One alone is not for long: only until the other has its power too, or the axis has come to rest.
        alone_ = first != second ? alone_ + 1 : 0;
        if (first != second && view.set_velocity != 0) ++counts_["one side ramps down"];
        const bool enabling = view.state == AxisState::Disabled && enable_;
        if (alone_ == 600 && !enabling) breach("one side is powered alone");
        // Apart by more than the portal bears.
        const double apart = std::abs((mirrored_ ? -1 : 1) * right_.position - left_.position - static_cast<double>(between)) / 1000;
        const bool heard = !left_.silent && !left_.offline && !right_.silent && !right_.offline;
        apart_ = both_ > 5 && heard && apart > config_.gantry.error + 0.35 ? apart_ + 1 : 0;  // 0.35 u: the way of three cycles
        if (apart_ == 8 && view.state != AxisState::ErrorStop && view.state != AxisState::Disabled)
            breach(fmt::format("the sides are {} u apart", apart));
        if (apart_ == 8) ++counts_["apart"];
    }

    // --- what happens -----------------------------------------------------------------------------------------------------------

    void act() {
        const auto what = dice_.below(100);
        auto& side = config_.gantry.on && dice_.once_in(2) ? right_ : left_;
        if (what < 55) {
            const auto command = any_(0);
            const auto answer = axis_.submit(command, axis_.view().owner);
            note(fmt::format("{} -> {}", walk_name(command.kind), static_cast<int>(answer.error)));
            if (answer.id != 0) ++counts_["commands"];
            if (command.kind == CommandKind::stop && answer.id != 0) lock_ = answer.id;
        } else if (what < 62) {
            const bool open = dice_.once_in(2);
            const auto error = axis_.set(SetBrake{open}, axis_.view().owner);
            note(fmt::format("MC_SetBrake {} -> {}", open, static_cast<int>(error)));
            if (error == ErrorId::none) ++counts_[open ? "MC_SetBrake opens" : "MC_SetBrake closes"];
            if (open && error == ErrorId::none) by_hand_ = 3;
        } else if (what < 67) (void)axis_.set(any_.any_override(), axis_.view().owner);
        else if (what < 72) {
            if (lock_ != 0) axis_.release_stop(std::exchange(lock_, 0), axis_.view().owner);
        } else if (what < 88) disturb(side);
        else if (what < 94 && axis_.view().state == AxisState::ErrorStop) (void)axis_.reset(Owner::program), note("reset");
        else heal();
    }
    void disturb(FakeDrive& side) {
        const auto event = dice_.below(16);
        note(fmt::format("disturbance {} {}", event, &side == &left_ ? "left" : "right"));
        switch (event) {
            case 0: side.fault_code = 0x7500; break;
            case 1:
            case 2: enable_ = !enable_; break;
            case 3: side.silent = true; break;
            case 4: side.offline = true; break;
            case 5: side.refuses_power = true; break;
            case 6:
                emergency_ = dice_.one_of({EmergencyStop::stop, EmergencyStop::stop_and_power_off, EmergencyStop::power_off_now});
                axis_.demand_emergency_stop(emergency_);
                break;
            case 7: side.warning = !side.warning; break;
            case 8: side.blocked = !side.blocked; break;
            case 9: slipped_ += static_cast<std::int64_t>(dice_.between(-1000, 1000)); break;
            case 10: axis_.take_control(static_cast<Owner>(1 + dice_.below(3))); break;
            case 11: axis_.set_mode(static_cast<OperatingMode>(dice_.below(3))); break;
            case 12: axis_.shut_down(); break;
            case 13: axis_.stop_for_error(AlarmId{4711}, dice_.once_in(2)); break;
            case 14: side.fault_code = 0, side.refuses_power = false; break;  // it comes back by itself
            default: side.lag = static_cast<std::int64_t>(dice_.below(60)); break;
        }
    }
    void heal() {
        note("healed");
        for (auto* side : {&left_, &right_}) {
            side->fault_code = 0;
            side->silent = side->offline = side->refuses_power = side->warning = side->blocked = false;
            side->lag = 0;
        }
        enable_ = true;
        emergency_ = EmergencyStop::none;
        axis_.demand_emergency_stop(emergency_);
        axis_.set_mode(OperatingMode::automatic);
        axis_.take_control(Owner::program);
        (void)axis_.set(Override{}, Owner::program);
        if (axis_.view().lock != 0) axis_.release_stop(axis_.view().lock, Owner::program);
        (void)axis_.reset(Owner::program);
    }

    PortalCounts& counts_;
    Dice dice_;
    AxisConfig config_;
    bool mirrored_;
    FakeDrive left_{cycle}, right_{cycle};
    Lent alone_port_{left_};
    std::optional<gantry::GantryPort> gantry_;
    Axis axis_;
    MotionOracle oracle_;
    MotionTables tables_of_axis_;
    WalkTables tables_;
    AnyCommand any_;
    std::array<std::int64_t, 1> load_{};
    Instant now_{};
    long cycle_count_ = 0, closed_for_ = 1000;
    CommandId lock_ = 0;
    EmergencyStop emergency_ = EmergencyStop::none;
    bool enable_ = false;
    int by_hand_ = 0;
    std::int64_t slipped_ = 0;
    int loose_ = 0, alone_ = 0, apart_ = 0, both_ = 0;
    std::int64_t between_ = 0;
    Seen left_seen_, right_seen_;
    AxisState told_ = AxisState::Disabled;
    std::string wrong_, log_;
};

TEST(PortalWalks, KeepEveryRule) {
    PortalCounts counts;
    const auto walked = taktwerk::test::walk_seeds(
        40, 3000, [&](unsigned seed) { return PortalWalk(seed, counts); }, [](auto&) {});
    if (walked.one_alone || HasFailure()) return;
    for (const auto* what : {"commands", "both powered", "one side ramps down", "power taken", "brake opens", "brake closes",
                             "MC_SetBrake opens", "MC_SetBrake closes", "alarm gantry_skew", "alarm gantry_side_lost",
                             "alarm load_deviation", "alarm drive_fault", "alarm axis_feedback_lost", "came to rest"})
        EXPECT_GE(counts[what], walked.walks / 10) << what;
}

}  // namespace
}  // namespace taktwerk::axes::test
