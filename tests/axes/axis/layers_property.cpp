// Moves, blends, additions, overrides and updates in any order: what always holds for the set-point. Seeds are fixed; a failure names its seed.

#include <random>

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig any_axis(std::mt19937& random) {
    auto config = plain_axis();
    if (random() % 2) config.limits.jerk = std::numeric_limits<double>::infinity();
    if (random() % 2) config.gearing.inverted = true;
    config.queue_depth = 8;
    config.homing.kind = HomingKind::set_here;
    switch (random() % 3) {
        case 0: config.modulo = 7.5; break;
        case 1:
            config.limits.position_min = -40;
            config.limits.position_max = 60;
            break;
        default: break;
    }
    return config;
}

class RandomLayers : public ::testing::TestWithParam<unsigned> {
protected:
    static inline long joints_in_motion = 0, superimposed_done = 0, on_a_limit = 0, held = 0, updates = 0;
    /// A walk that never gets there proves nothing.
    static void TearDownTestSuite() {
        EXPECT_GT(joints_in_motion, 100);
        EXPECT_GT(superimposed_done, 100);
        EXPECT_GT(on_a_limit, 5);
        EXPECT_GT(held, 200);
        EXPECT_GT(updates, 200);
    }
};

TEST_P(RandomLayers, KeepTheirRules) {
    std::mt19937 random(GetParam());
    const auto pick = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() % 10001) / 10000; };
    const bool with_additions = GetParam() % 2 == 0;
    Rig rig(any_axis(random));
    rig.power_on();
    rig.accept(home(1));
    rig.run(3);
    const auto& limits = rig.axis.config().limits;
    const double modulo = rig.axis.config().modulo;
    const auto any_move = [&]() -> AxisCommand {
        AxisCommand command;
        command.buffer_mode = static_cast<MC_BufferMode>(random() % 6);
        command.velocity = pick(5, 130);
        command.direction = static_cast<MC_Direction>(random() % 4);
        if (random() % 3 == 0) command.acceleration = pick(200, 1200);
        if (random() % 3 == 0) command.deceleration = pick(200, 1200);
        if (random() % 3 == 0) command.jerk = pick(3000, 25000);
        command.position = pick(-30, 30);
        switch (random() % 10) {
            case 0:
            case 1:
            case 2:
                command.kind = CommandKind::move_absolute;
                command.position = modulo > 0 ? pick(0, modulo * 0.999) : pick(-42, 62);
                break;
            case 3:
            case 4: command.kind = CommandKind::move_relative; break;
            case 5: command.kind = CommandKind::move_additive; break;
            case 6:
                command.kind = random() % 2 ? CommandKind::move_continuous_relative : CommandKind::halt;
                command.end_velocity = pick(-60, 60);
                break;
            default:
                command.kind = CommandKind::move_velocity;
                if (command.direction == mcShortestWay) command.direction = mcPositiveDirection;
                command.velocity = pick(-120, 120);
                break;
        }
        return command;
    };

    CommandId last = 0, extra = 0, active_before = 0;
    AxisCommand running;
    std::vector<CommandId> pending;
    CommandId highest = rig.view().last_id;
    int quiet = 0;  // cycles without anything new: far enough to come to a limit
    for (int cycle = 0; cycle < 12'000; ++cycle) {
        switch (quiet > 0 ? 1000 : random() % 220) {
            case 0:
            case 1:
            case 2:
            case 3: {
                const auto command = any_move();
                if (const auto answer = rig.axis.submit(command, Owner::program); answer.id != 0) {
                    last = answer.id;
                    running = command;
                }
                break;
            }
            case 4: {  // several at once
                for (auto i = 1 + random() % 5; i > 0; --i) {
                    auto command = any_move();
                    if (command.buffer_mode == mcAborting) command.buffer_mode = mcBlendingNext;
                    if (const auto answer = rig.axis.submit(command, Owner::program); answer.id != 0) {
                        last = answer.id;
                        running = command;
                    }
                }
                break;
            }
            case 5:
                if (with_additions)
                    extra = rig.axis
                                .submit({.kind = CommandKind::move_superimposed, .position = pick(-8, 8), .velocity = pick(0, 40)},
                                        Owner::program)
                                .id;
                break;
            case 6:
                if (with_additions && random() % 4 == 0) (void)rig.axis.submit({.kind = CommandKind::halt_superimposed}, Owner::program);
                break;
            case 7: {
                const bool stands = random() % 4 == 0;
                (void)rig.axis.set(Override{stands ? 0 : pick(0.1, 1), pick(0.3, 1), pick(0.3, 1)}, Owner::program);
                break;
            }
            case 8: (void)rig.axis.set(Override{}, Owner::program); break;
            case 9:
                running.velocity = running.kind == CommandKind::move_velocity ? pick(-90, 90) : pick(5, 130);
                if (random() % 2 && modulo == 0) running.position += pick(-4, 4);
                if (rig.axis.update(last, running, Owner::program) == ErrorId::none) ++updates;
                break;
            default: break;
        }
        if (quiet > 0) --quiet;
        else if (random() % 500 == 0) quiet = 700;
        for (auto id = highest + 1; id <= rig.view().last_id; ++id) pending.push_back(id);
        highest = rig.view().last_id;
        rig.step();
        const auto& view = rig.view();

        // Never faster than the axis may be; an addition that turns round while the base takes all swings beyond it by a percent or so.
        // Accelerations add up (P1-155).
        const double factor = with_additions ? 2 : 1, swing = with_additions ? 1.02 : 1;
        ASSERT_LE(std::abs(view.set_velocity), 100 * swing * (1 + 1e-9)) << cycle;
        ASSERT_LE(std::abs(view.set_acceleration), 1000 * factor * (1 + 1e-9)) << cycle;
        ASSERT_LE(rig.drive.largest_step, static_cast<std::int64_t>(100 * swing) + 1) << cycle;
        ASSERT_TRUE(std::isfinite(view.set_position)) << cycle;
        ASSERT_GE(view.set_position, limits.position_min - 1e-9) << cycle;
        ASSERT_LE(view.set_position, limits.position_max + 1e-9) << cycle;
        if (modulo > 0) {
            ASSERT_GE(view.set_position, 0) << cycle;
            ASSERT_LT(view.set_position, modulo) << cycle;
        }
        if (view.state == AxisState::Standstill) {
            ASSERT_EQ(view.set_velocity, 0) << cycle;
            ASSERT_EQ(view.active, 0u) << cycle;
            ASSERT_EQ(view.queued_count, 0u) << cycle;
            ASSERT_EQ(view.side[0], 0u) << cycle;
        }
        for (const auto& fact : rig.alarms) ASSERT_EQ(fact.id, id(AxisAlarm::software_limit_reached)) << cycle;
        if (active_before != 0 && view.active != active_before && view.status(active_before) == CommandStatus::done && view.active != 0 &&
            std::abs(view.set_velocity) > 3)
            ++joints_in_motion;
        active_before = view.active;
        if (extra != 0 && view.status(extra) == CommandStatus::done) {
            ++superimposed_done;
            extra = 0;
        }
        if (view.limiter == VelocityLimiter::override_factor && view.set_velocity == 0) ++held;
        if (view.state == AxisState::ErrorStop) {
            if (view.set_velocity == 0) {
                ++on_a_limit;
                ASSERT_TRUE(rig.run_until(
                    [&] {
                        if (rig.view().state == AxisState::ErrorStop && !rig.view().resetting) (void)rig.axis.reset(Owner::program);
                        return rig.view().state == AxisState::Standstill;
                    },
                    3000))
                    << cycle;
                rig.alarms.clear();
                (void)rig.axis.submit(absolute(1, 90), Owner::program);  // away from the limit
            }
        }
        // A command is heard of until it ends.
        for (auto it = pending.begin(); it != pending.end();) {
            const auto status = rig.view().status(*it);
            const bool over = status == CommandStatus::done || status == CommandStatus::aborted || status == CommandStatus::error ||
                              status == CommandStatus::unknown;
            it = over ? pending.erase(it) : it + 1;
        }
    }
    // All of it comes to an end: nothing hangs.
    (void)rig.axis.set(Override{}, Owner::program);
    (void)rig.axis.submit(halt(), Owner::program);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().state == AxisState::Standstill || rig.view().state == AxisState::ErrorStop; }, 3000));
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomLayers, ::testing::Range(1u, 41u));
/// Seeds that found a fault once.
INSTANTIATE_TEST_SUITE_P(Finders, RandomLayers, ::testing::Values(88u, 154u, 176u, 388u, 422u));

}  // namespace
}  // namespace taktwerk::axes::test
