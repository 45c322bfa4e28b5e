// Couplings begun, changed and given up at random, in chains, while their masters do what they like. Seeds are fixed; a failure names its seed.

#include <random>

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {
namespace {

class RandomCouplings : public ::testing::TestWithParam<unsigned> {
protected:
    static inline long synchronized = 0, in_sync = 0, cycles = 0;
    /// A walk that never couples proves nothing.
    static void TearDownTestSuite() {
        EXPECT_GT(synchronized, cycles / 4);
        EXPECT_GT(in_sync, synchronized / 8);
    }
};

TEST_P(RandomCouplings, NeverJumpAndTellTheTruth) {
    std::mt19937 random(GetParam());
    const auto pick = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() % 10001) / 10000; };
    constexpr std::size_t count = 4;
    std::vector<AxisConfig> configs(count, plain_slave());
    for (auto& config : configs) {
        if (random() % 2) config.limits.jerk = 20000;
        if (random() % 3 == 0) config.gearing.feed = 0.7;
        if (random() % 3 == 0) config.gearing.inverted = true;
        if (random() % 3 == 0) config.limits.deceleration = 2000;
    }
    CouplingRig rig(configs);
    const auto hump =
        rig.tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0}, {.master = 10, .slave = 4}, {.master = 25, .slave = 0}});
    const auto feed = rig.tables.add_cam(std::vector<CamPoint>{{.master = -5, .slave = 1, .segment = CamSegment::linear},
                                                               {.master = 3, .slave = 5, .segment = CamSegment::spline},
                                                               {.master = 9, .slave = 2, .segment = CamSegment::quintic},
                                                               {.master = 20, .slave = 12}});
    rig.start();

    for (int cycle = 0; cycle < 6000; ++cycle) {
        const std::size_t axis = random() % count, other = random() % count, third = random() % count;
        auto& it = rig.axes[axis];
        const auto dynamics = [&](AxisCommand command) {
            if (random() % 2) command.acceleration = pick(50, 1000), command.deceleration = pick(50, 1000);
            if (random() % 2) command.jerk = pick(1000, 50000);
            if (random() % 4 == 0) command.buffer_mode = mcBuffered;
            return command;
        };
        const auto ratio = [&] {
            return GearRatio{static_cast<std::int32_t>(random() % 7) - 3, static_cast<std::int32_t>(random() % 4) + 1};
        };
        const auto source = [&] { return random() % 4 ? mcSetValue : mcActualValue; };
        switch (random() % 300) {
            case 0:
            case 1:
            case 2: {
                auto command = dynamics(gear_in(other));
                std::get<GearDetails>(command.details) = {CouplingRig::ref(other), ratio(), source()};
                (void)it.submit(command, Owner::program);
                break;
            }
            case 3:
            case 4: {
                auto command = dynamics(gear_in_pos(other, pick(-60, 60), pick(-30, 30), random() % 2 ? pick(-30, 30) : 0));
                std::get<GearInPosDetails>(command.details).ratio = ratio();
                (void)it.submit(command, Owner::program);
                break;
            }
            case 5:
            case 6:
            case 7: {
                (void)it.set(SelectCam{random() % 2 ? hump : feed, random() % 3 != 0, random() % 2 == 0, random() % 2 == 0},
                             Owner::program);
                auto command = dynamics(cam_in(other, rig.view(axis).selected_cam, static_cast<MC_StartMode>(random() % 3)));
                auto& cam = std::get<CamDetails>(command.details);
                cam.source = source();
                cam.master_scaling = random() % 3 ? 1 : pick(-2, 2);
                cam.slave_scaling = random() % 3 ? 1 : pick(-2, 2);
                cam.master_start_distance = random() % 4 ? 0 : pick(-20, 20);
                cam.master_sync_position = pick(-40, 40);
                (void)it.submit(command, Owner::program);
                break;
            }
            case 8:
                (void)it.submit(dynamics(combine(other, third, random() % 2 ? mcAddAxes : mcSubAxes, ratio(), ratio())), Owner::program);
                break;
            case 9: {
                auto command = dynamics(
                    phasing(random() % 2 ? CommandKind::phasing_absolute : CommandKind::phasing_relative, pick(-8, 8), pick(1, 40)));
                (void)it.submit(command, Owner::program);
                break;
            }
            case 10:
                if (random() % 3 == 0) (void)it.submit(random() % 2 ? gear_out() : cam_out(), Owner::program);
                break;
            case 11:
            case 12: (void)it.submit(dynamics(absolute(pick(-60, 60), pick(5, 90))), Owner::program); break;
            case 13:
            case 14: (void)it.submit(dynamics(at_velocity(pick(-60, 60))), Owner::program); break;
            case 15: (void)it.submit(halt(), Owner::program); break;
            case 16: {
                const auto stopped = it.submit(stop(), Owner::program).id;
                it.release_stop(stopped, Owner::program);
                break;
            }
            case 17: (void)it.set(SetPosition{pick(-20, 20), random() % 2 == 0}, Owner::program); break;
            case 18: {  // ContinuousUpdate
                const auto& view = rig.view(axis);
                auto command = gear_in(other);
                std::get<GearDetails>(command.details).ratio = ratio();
                if (view.active_kind == CommandKind::gear_in) (void)it.update(view.active, command, Owner::program);
                break;
            }
            case 19: rig.drives[axis]->lag = static_cast<std::int64_t>(random() % 40); break;
            case 20:
            case 21: (void)it.reset(Owner::program); break;
            default: break;
        }
        std::vector<double> before(count);
        for (std::size_t i = 0; i < count; ++i) before[i] = static_cast<double>(rig.axes[i].drive_command().position);
        rig.step();
        ASSERT_TRUE(rig.clean()) << cycle;  // what is wrong is said at the end
        for (std::size_t i = 0; i < count; ++i) {
            const auto& view = rig.view(i);
            // At the drive nothing that MC_SetPosition may have renumbered: counts. 100 u/s at 1 ms, and the rounding.
            const double counts = std::abs(configs[i].gearing.counts_per_unit());
            ASSERT_LE(std::abs(static_cast<double>(rig.axes[i].drive_command().position) - before[i]), 0.1 * counts + 1.01)
                << "axis " << i << " cycle " << cycle;
            ASSERT_LE(std::abs(view.set_velocity), 100 * (1 + 1e-8)) << "axis " << i << " cycle " << cycle;
            ++cycles;
            if (view.state != AxisState::SynchronizedMotion) {
                ASSERT_NE(view.active_kind, CommandKind::gear_in) << cycle;
                continue;
            }
            ++synchronized;
            if (!view.active_in_target) continue;
            ++in_sync;
            ASSERT_TRUE(view.master.valid());
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const double hardest = std::max(configs[i].limits.acceleration, configs[i].limits.deceleration) * 1e-3;
        EXPECT_LE(rig.traces[i].largest_change, hardest * (1 + 1e-6)) << "axis " << i;
    }
    // Whatever happened: everything stops, and couples again.
    for (auto& axis : rig.axes) (void)axis.reset(Owner::program);
    rig.run(200);
    for (std::size_t i = 0; i < count; ++i) (void)rig.axes[i].submit(halt(), Owner::program);
    rig.run(2000);
    for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(rig.view(i).state, AxisState::Standstill) << i << " error " << rig.view(i).error;
    rig.accept(0, at_velocity(20));
    const auto id = rig.accept(1, gear_in(0, -1, 2));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, id) == CommandStatus::in_target && rig.view(1).set_velocity < -9.999; }, 1000));
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomCouplings, ::testing::Range(1u, 17u));

}  // namespace
}  // namespace taktwerk::axes::test
