// Whatever is asked of an axis, in whatever order, with whatever faults: the rules that always hold. Seeds are fixed; a failure names its seed.

#include <array>
#include <random>

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig any_axis(std::mt19937& random) {
    auto config = plain_axis();
    if (random() % 2) config.limits.jerk = std::numeric_limits<double>::infinity();
    if (random() % 2) config.gearing.inverted = true;
    if (random() % 3) {
        config.limits.position_min = -40;
        config.limits.position_max = 60;
    }
    config.limits.stop_deceleration = random() % 2 ? 3000 : 0;
    config.homing.kind = static_cast<HomingKind>(random() % 4);
    config.homing.search_velocity = 50;
    config.homing.latch_velocity = 10;
    config.homing.timeout = 2s;
    return config;
}

class RandomAxis : public ::testing::TestWithParam<unsigned> {
protected:
    static inline std::array<long, axis_state_count> visited{};
    static inline long cycles = 0;
    /// A walk that hides in one state proves little: each (but for couplings, which do not exist yet) must be seen for a part of the time.
    static void TearDownTestSuite() {
        for (std::size_t s = 0; s < axis_state_count; ++s)
            if (static_cast<AxisState>(s) != AxisState::SynchronizedMotion) {
                EXPECT_GT(visited[s], cycles / 200) << name(static_cast<AxisState>(s)) << " in " << cycles;
            }
    }
};

TEST_P(RandomAxis, KeepsItsRules) {
    std::mt19937 random(GetParam());
    const auto pick = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() % 10001) / 10000; };
    Rig rig(any_axis(random), [&](FakeDrive& drive) {
        drive.dead_cycles = static_cast<int>(random() % 3);
        drive.latch_age = static_cast<int>(random() % 2);
        drive.switches = random() % 2;
        drive.home_low = -9000;
        drive.home_high = -4000;
        drive.negative_end = -90'000;
        drive.positive_end = 110'000;
    });
    rig.enable = true;
    CommandId last = 0, highest = 0;
    std::vector<CommandId> pending;
    const auto& limits = rig.axis.config().limits;

    for (int cycle = 0; cycle < 15'000; ++cycle) {
        const auto owner = rig.view().owner;
        switch (random() % 400) {
            case 0:
            case 1:
            case 2: last = rig.axis.submit(absolute(pick(-45, 65), pick(1, 150), random() % 2 ? mcBuffered : mcAborting), owner).id; break;
            case 3:
            case 4: last = rig.axis.submit(relative(pick(-30, 30), pick(1, 150), random() % 2 ? mcBuffered : mcAborting), owner).id; break;
            case 5:
            case 6: last = rig.axis.submit(at_velocity(pick(-120, 120), random() % 2 ? mcBuffered : mcAborting), owner).id; break;
            case 7: last = rig.axis.submit(jog(pick(-120, 120)), owner).id; break;
            case 8: last = rig.axis.submit(halt(random() % 2 ? mcBuffered : mcAborting), owner).id; break;
            case 9: last = rig.axis.submit(stop(), owner).id; break;
            case 10:
            case 11:
            case 12: rig.axis.release_stop(last, owner); break;
            case 13: last = rig.axis.submit(home(pick(-5, 5)), owner).id; break;
            case 14: (void)rig.axis.set(SetPosition{pick(-3, 3), true}, owner); break;
            case 15: (void)rig.axis.renew_jog(last, pick(-100, 100), owner); break;
            case 16:
                if (random() % 4 == 0) rig.drive.fault_code = 0x7500;
                break;
            case 17:
            case 18:
            case 19: rig.drive.fault_code = 0; break;
            case 20:
                if (random() % 4 == 0) rig.enable = false;
                break;
            case 21:
            case 22:
            case 23: rig.enable = true; break;
            case 24: rig.drive.silent = random() % 3 == 0; break;
            case 25: rig.drive.silent = false; break;
            case 26: rig.axis.demand_emergency_stop(random() % 4 == 0 ? EmergencyStop::stop_and_power_off : EmergencyStop::none); break;
            case 27: rig.axis.demand_emergency_stop(EmergencyStop::none); break;
            case 28:
            case 29:
            case 30:
            case 31:
            case 32:
            case 33:
            case 34:
            case 35: (void)rig.axis.reset(owner); break;
            case 36: rig.axis.take_control(static_cast<Owner>(1 + random() % 3)); break;
            case 37: rig.axis.set_mode(static_cast<OperatingMode>(random() % 3)); break;
            case 38: rig.drive.refuses_power = random() % 4 == 0; break;
            case 39: rig.drive.refuses_power = false; break;
            case 40: (void)rig.axis.set_operators_override(static_cast<double>(random() % 4) / 3); break;
            case 41:
            case 42: (void)rig.axis.set_operators_override(1); break;
            default: break;
        }
        if (last != 0 && last > highest) {
            highest = last;
            pending.push_back(last);
        }
        rig.step();
        const auto& view = rig.view();

        ++visited[static_cast<std::size_t>(view.state)];
        ++cycles;
        ASSERT_LE(rig.drive.largest_step, 101) << "cycle " << cycle;  // 100 u/s are 100 counts a cycle
        ASSERT_LE(std::abs(view.set_velocity), 100 * (1 + 1e-9)) << cycle;
        ASSERT_LE(std::abs(view.set_acceleration), std::max(limits.deceleration, limits.stop_deceleration) * (1 + 1e-9)) << cycle;
        ASSERT_TRUE(std::isfinite(view.set_position)) << cycle;
        if (view.state == AxisState::Disabled || view.state == AxisState::Standstill) {
            ASSERT_EQ(view.set_velocity, 0) << cycle;
        }
        if (view.state == AxisState::Standstill) {
            ASSERT_EQ(view.active, 0u) << cycle;
            ASSERT_TRUE(view.powered) << cycle;
        }
        ASSERT_EQ(view.state == AxisState::ErrorStop, view.error != 0) << cycle;
        // Without a command in front of them they wait behind MC_Stop, for power, or until an axis whose command could not go on stands.
        const bool halts = view.state == AxisState::DiscreteMotion && view.limiter == VelocityLimiter::stopping;
        const bool may_wait = view.state == AxisState::Stopping || view.state == AxisState::Disabled || halts;
        ASSERT_TRUE(view.active != 0 || view.queued_count == 0 || may_wait) << cycle;
        ASSERT_LE(view.queued_count, rig.axis.config().queue_depth);
        // A command is heard of until it ends, and ends once.
        for (auto it = pending.begin(); it != pending.end();) {
            const auto status = view.status(*it);
            ASSERT_NE(status, CommandStatus::unknown) << "command " << *it << " cycle " << cycle;
            const bool over = status == CommandStatus::done || status == CommandStatus::aborted || status == CommandStatus::error;
            it = over ? pending.erase(it) : it + 1;
        }
    }
    // Whatever happened: without causes a reset brings it back.
    rig.drive.fault_code = 0;
    rig.drive.silent = rig.drive.refuses_power = false;
    rig.enable = true;
    (void)rig.axis.set_operators_override(1);
    rig.axis.demand_emergency_stop(EmergencyStop::none);
    rig.axis.take_control(Owner::commissioning);
    rig.axis.take_control(Owner::program);
    ASSERT_TRUE(rig.run_until(
        [&] {
            if (rig.view().state == AxisState::ErrorStop && !rig.view().resetting) (void)rig.axis.reset(Owner::program);
            return rig.view().state == AxisState::Standstill;
        },
        10'000))
        << name(rig.view().state);
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomAxis, ::testing::Range(1u, 41u));

}  // namespace
}  // namespace taktwerk::axes::test
