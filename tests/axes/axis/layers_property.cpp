// Moves, blends, additions, overrides and updates in any order: what always holds for the set-point. Seeds are fixed; a failure names its seed.

#include <random>

#include "tests/axes/axis/walk_axes.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig any_layered_axis(std::mt19937& random) {
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
    std::mt19937 operators(GetParam() + 1000);  // of its own: what the others draw stays what it was
    const auto pick = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() % 10001) / 10000; };
    const bool with_additions = GetParam() % 2 == 0;
    Rig rig(any_layered_axis(random));
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
            case 8:
                (void)rig.axis.set(Override{}, Owner::program);
                (void)rig.axis.set_operators_override(operators() % 16 == 0 ? 0.5 : 1);
                break;
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

        // Never faster than the axis may be, also together. Accelerations add up (P1-155).
        const double factor = with_additions ? 2 : 1;
        ASSERT_LE(std::abs(view.set_velocity), 100 * (1 + 1e-8)) << cycle;
        ASSERT_LE(std::abs(view.set_acceleration), 1000 * factor * (1 + 1e-9)) << cycle;
        ASSERT_LE(rig.drive.largest_step, 101) << cycle;
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
    (void)rig.axis.set_operators_override(1);
    (void)rig.axis.submit(halt(), Owner::program);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().state == AxisState::Standstill || rig.view().state == AxisState::ErrorStop; }, 3000));
}
// A velocity that changes, additions that are replaced by shorter and by reversed ones, that wait and find room again: the rig's oracle sees
// that the sum keeps the axis' velocity in both senses; and once the base leaves room the last addition comes to its end.
TEST(BaseAndAddition, KeepTheAxisVelocityTogetherAndComeToTheirEnds) {
    long reversed = 0, waited = 0;
    const auto walk = [&](unsigned seed) {
        Dice dice(seed);
        struct Event {
            int at, what;
            AxisCommand command;
        };
        std::vector<Event> events;
        for (unsigned i = 0, count = 2 + dice.below(4); i < count; ++i) {
            Event event{i == 0 ? 0 : 20 + static_cast<int>(dice.below(350)), i == 0 ? 0 : dice.one_of({0, 2, 2, 2, 3, 5, 6}), {}};
            const bool base = event.what == 0 || event.what == 3;
            event.command = at_velocity(base ? dice.between(-100, 100) : event.what == 6 ? dice.between(0, 100) : dice.between(-25, 25));
            const double speed = dice.between(10, 100);
            if (!base) event.command = {.kind = CommandKind::move_superimposed, .position = event.command.velocity, .velocity = speed};
            event.command.acceleration = event.command.deceleration = dice.once_in(2) ? 0 : dice.between(100, 1000);
            event.command.jerk = dice.once_in(2) ? 0 : dice.between(1000, 20000);
            events.push_back(event);
        }
        Rig rig;
        rig.power_on();
        CommandId base = 0, addition = 0;
        double way = 0;
        for (int cycle = 0; cycle < 900; ++cycle) {
            for (const auto& event : events) {
                if (event.at != cycle) continue;
                const auto& command = event.command;
                switch (event.what) {
                    case 0: base = rig.axis.submit(command, Owner::program).id; break;
                    case 2:
                        addition = rig.axis.submit(command, Owner::program).id;
                        reversed += way * command.position < 0;
                        way = command.position;
                        break;
                    case 3: (void)rig.axis.update(base, command, Owner::program); break;
                    case 5: (void)rig.axis.update(addition, command, Owner::program); break;
                    default: (void)rig.axis.set(Override{std::abs(command.position) / 100, 1, 1}, Owner::program); break;
                }
            }
            rig.step();
            ASSERT_LE(std::abs(rig.view().set_velocity), 100 * (1 + 1e-8)) << "seed " << seed << ", cycle " << cycle;
        }
        waited += addition != 0 && rig.status(addition) == CommandStatus::active;
        (void)rig.axis.set(Override{}, Owner::program);
        (void)rig.axis.submit(at_velocity(30), Owner::program);
        const auto last = rig.axis.submit({.kind = CommandKind::move_superimposed, .position = 3}, Owner::program).id;
        ASSERT_TRUE(rig.run_until([&] { return rig.status(last) == CommandStatus::done; }, 2000)) << "seed " << seed;
    };
    for (unsigned seed = 1; seed <= 600 && !HasFatalFailure(); ++seed) walk(seed);
    for (const unsigned finder : {2026u, 3007u, 3834u, 5860u, 13416u, 15520u, 19055u, 24155u}) walk(finder);
    EXPECT_GT(reversed, 100);
    EXPECT_GT(waited, 20);
}

// A jog whose velocity changes in most cycles, between software limits, and additions on top that come, replace one another and end in the middle
// of anything: never beyond the limits, never with more than the ramps of two (the rig's oracle).
TEST(JogAndAddition, StayBetweenTheSoftwareLimits) {
    long at_a_limit = 0;
    const auto walk = [&](unsigned seed) {
        Dice dice(seed);
        auto config = plain_axis();
        config.limits.position_min = -10;
        config.limits.position_max = 10;
        config.homing.kind = HomingKind::set_here;
        config.patience.jog_lease = 50ms;
        Rig rig(config);
        rig.power_on();
        rig.accept(home(0));
        rig.run(10);
        CommandId held = 0;
        for (int cycle = 0; cycle < 2000; ++cycle) {
            if (rig.view().error != 0) (void)rig.axis.reset(Owner::program);
            if (rig.view().active_kind != CommandKind::jog || dice.once_in(80))
                held = rig.axis.submit(jog(dice.between(-110, 110)), Owner::program).id;
            else if (dice.once_in(3)) (void)rig.axis.renew_jog(held, dice.between(-110, 110), Owner::program);
            if (dice.once_in(60)) {
                const double way = dice.between(-5, 5);
                (void)rig.axis.submit({.kind = CommandKind::move_superimposed, .position = way, .velocity = dice.between(5, 80)},
                                      Owner::program);
            }
            rig.step();
            const double beyond = std::abs(rig.view().set_position) - 10;
            ASSERT_LE(beyond, 1e-9) << "seed " << seed << ", cycle " << cycle;
            at_a_limit += beyond > -0.01;
        }
        ASSERT_TRUE(rig.oracle.clean()) << "seed " << seed << '\n' << rig.oracle.report();
    };
    for (unsigned seed = 1; seed <= 60 && !HasFailure(); ++seed) walk(seed);
    EXPECT_GT(at_a_limit, 60);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomLayers, ::testing::Range(1u, 41u));
/// Seeds that found a fault once.
INSTANTIATE_TEST_SUITE_P(Finders, RandomLayers, ::testing::Values(88u, 154u, 176u, 388u, 422u));

}  // namespace
}  // namespace taktwerk::axes::test
