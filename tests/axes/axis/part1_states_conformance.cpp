// Figure 2 of PLCopen Part 1 v2.0 and its table 4, by commands on real axes: every kind of motion in every state, and every kind in front of
// and behind a buffered command.

#include <optional>

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum AxisState;
using K = CommandKind;

constexpr std::size_t x = 0, master = 1;

AxisConfig homing_axis() {
    auto config = plain_slave();
    config.homing.kind = HomingKind::drive;
    config.homing.method = 35;
    return config;
}

AxisCommand command_of(K kind, MC_BufferMode mode = mcAborting) {
    AxisCommand command{.kind = kind, .buffer_mode = mode, .position = 20, .velocity = 10};
    command.end_velocity = 5;
    if (kind == K::gear_in) {
        GearDetails gear;
        gear.master = {master};
        command.details = gear;
    }
    if (kind == K::gear_in_pos) {
        GearInPosDetails gear;
        gear.master = {master};
        gear.master_sync_position = 30, gear.slave_sync_position = 10, gear.master_start_distance = 20;
        command.details = gear;
    }
    if (kind == K::combine) {
        CombineDetails sum;
        sum.master1 = {master}, sum.master2 = {2};
        command.details = sum;
    }
    return command;
}

/// An axis that homes by its drive, a master that moves at 10 u/s, and a third that stands.
struct Stage : CouplingRig {
    Stage() : CouplingRig({homing_axis(), plain_slave(), plain_slave()}) {
        drives[x]->homing_hangs = true;
        start();
        accept(master, {.kind = K::move_velocity, .velocity = 10});
        run(100);
    }
    /// False when the state was not reached.
    bool bring_to(AxisState state) {
        switch (state) {
            case Disabled: enabled[x] = false; return run_until([&] { return view(x).state == Disabled; }, 1000);
            case Standstill: break;
            case Homing: accept(x, command_of(K::home)); break;
            case DiscreteMotion: accept(x, {.kind = K::move_absolute, .position = 500, .velocity = 20}); break;
            case ContinuousMotion: accept(x, {.kind = K::move_velocity, .velocity = 20}); break;
            case SynchronizedMotion: accept(x, command_of(K::gear_in)); break;
            case Stopping: accept(x, command_of(K::stop)); break;
            case ErrorStop: axes[x].stop_for_error(0x3001, false); break;
        }
        run(50);
        return view(x).state == state;
    }
};

/// Where the figure's arrow for this kind leads from this state; nothing where there is none: refused, and the state stays.
std::optional<AxisState> by_figure(K kind, AxisState from) {
    const bool in_motion = from == DiscreteMotion || from == ContinuousMotion || from == SynchronizedMotion;
    switch (kind) {
        case K::move_absolute:
        case K::move_relative:
        case K::move_additive:
        case K::halt: return in_motion || from == Standstill ? std::optional{DiscreteMotion} : std::nullopt;
        case K::move_velocity:
        case K::move_continuous_absolute:
        case K::move_continuous_relative: return in_motion || from == Standstill ? std::optional{ContinuousMotion} : std::nullopt;
        case K::gear_in:
        case K::gear_in_pos:
        case K::combine: return in_motion || from == Standstill ? std::optional{SynchronizedMotion} : std::nullopt;
        case K::move_superimposed:
            return from == Standstill ? std::optional{DiscreteMotion} : in_motion ? std::optional{from} : std::nullopt;
        case K::gear_out:
        case K::cam_out: return from == SynchronizedMotion ? std::optional{ContinuousMotion} : std::nullopt;
        case K::home: return from == Standstill ? std::optional{Homing} : std::nullopt;
        case K::stop: return in_motion || from == Standstill || from == Homing ? std::optional{Stopping} : std::nullopt;
        default: return std::nullopt;
    }
}

class Figure2 : public ::testing::TestWithParam<K> {};

// P1-033, P1-017, P1-020, P1-026, P1-030, P1-031, P1-035, P1-036, P1-041, P1-126: in each state the command leads where the arrow leads, in the same cycle, or
// is refused with an error and changes nothing.
TEST_P(Figure2, EveryStateTakesWhatItsArrowsSay) {
    for (std::size_t s = 0; s < axis_state_count; ++s) {
        const auto state = static_cast<AxisState>(s);
        Stage stage;
        ASSERT_TRUE(stage.bring_to(state)) << name(state);
        const auto expected = by_figure(GetParam(), state);
        const auto before = stage.view(x);

        const auto answer = stage.axes[x].submit(command_of(GetParam()), Owner::program);

        EXPECT_EQ(answer.error == ErrorId::none, expected.has_value()) << name(state) << ": error " << static_cast<int>(answer.error);
        stage.step();
        EXPECT_EQ(name(stage.view(x).state), name(expected.value_or(state))) << "from " << name(state);
        if (!expected) {
            EXPECT_EQ(stage.view(x).active, before.active);
            EXPECT_EQ(answer.id, 0u);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Figure2,
                         ::testing::Values(K::move_absolute, K::move_relative, K::move_additive, K::move_velocity,
                                           K::move_continuous_absolute, K::move_continuous_relative, K::gear_in, K::gear_in_pos, K::combine,
                                           K::move_superimposed, K::gear_out, K::cam_out, K::home, K::stop));

// P1-208: a slave keeps the gear's velocity whatever its override; the same axis is slowed by it as soon as it moves by itself.
TEST(OverrideOfASlave, HasNoEffectWhileItIsCoupled) {
    Stage stage;
    const auto gear = stage.accept(x, command_of(K::gear_in));
    ASSERT_TRUE(stage.run_to_sync(x, gear));
    ASSERT_EQ(stage.axes[x].set(Override{.velocity = 0.5}, Owner::program), ErrorId::none);
    for (int i = 0; i < 200; ++i) {
        stage.step();
        ASSERT_NEAR(stage.view(x).set_velocity, 10, 1e-9) << i;
        ASSERT_EQ(stage.status(x, gear), CommandStatus::in_target);
    }
    stage.accept(x, {.kind = K::move_velocity, .velocity = 10});
    stage.run(200);
    EXPECT_NEAR(stage.view(x).set_velocity, 5, 1e-9);
}

/// Table 4: what starts a buffered follower. Nothing where a follower is not possible or never comes.
enum class Signal : std::uint8_t { done, in_target };
struct Row {
    K kind;
    bool can_be_buffered;
    Signal starts_the_next;
};
class Table4 : public ::testing::TestWithParam<Row> {};

// P1-092: the follower waits until the signal and begins then.
TEST_P(Table4, AFollowerBeginsOnTheSignal) {
    const auto& row = GetParam();
    Stage stage;
    const auto first = stage.accept(x, command_of(row.kind));
    const auto next = stage.accept(x, {.kind = K::move_absolute, .buffer_mode = mcBuffered, .position = 40, .velocity = 20});
    bool signalled = false, early = false;
    ASSERT_TRUE(stage.run_until(
        [&] {
            const auto status = stage.status(x, first), follower = stage.status(x, next);
            const bool now = row.starts_the_next == Signal::done ? status == CommandStatus::done : status == CommandStatus::in_target;
            signalled = signalled || now;
            early = early || (!signalled && follower != CommandStatus::queued);
            return follower == CommandStatus::active;
        },
        20'000));
    EXPECT_TRUE(signalled);
    EXPECT_FALSE(early);
    EXPECT_TRUE(stage.run_until([&] { return stage.status(x, next) == CommandStatus::done; }));
    EXPECT_EQ(stage.view(x).set_position, 40);
}

// P1-092: behind a move to a position each kind that can be buffered waits for its Done and then begins.
TEST_P(Table4, AsAFollowerItWaitsWhereItCanBeBuffered) {
    const auto& row = GetParam();
    if (!row.can_be_buffered) return;
    Stage stage;
    const auto first = stage.accept(x, {.kind = K::move_absolute, .position = 5, .velocity = 20});
    const auto second = stage.accept(x, command_of(row.kind, mcBuffered));
    bool both = false;
    ASSERT_TRUE(stage.run_until(
        [&] {
            const auto status = stage.status(x, second);
            const bool runs = status != CommandStatus::queued;
            both = both || (runs && stage.status(x, first) != CommandStatus::done);
            return runs;
        },
        5'000));
    EXPECT_FALSE(both) << "began before Done";
    EXPECT_NE(stage.status(x, second), CommandStatus::error);
}

INSTANTIATE_TEST_SUITE_P(Rows, Table4,
                         ::testing::Values(Row{K::halt, true, Signal::done}, Row{K::move_absolute, true, Signal::done},
                                           Row{K::move_relative, true, Signal::done}, Row{K::move_additive, true, Signal::done},
                                           Row{K::move_velocity, true, Signal::in_target},
                                           Row{K::move_continuous_absolute, true, Signal::in_target},
                                           Row{K::move_continuous_relative, true, Signal::in_target},
                                           Row{K::gear_in, true, Signal::in_target}, Row{K::gear_in_pos, true, Signal::in_target},
                                           Row{K::combine, true, Signal::in_target}));

}  // namespace
}  // namespace taktwerk::axes::test
