// The straight way through a cycle (axes/axis/plain_cycle.hpp) is the whole way, to the last bit: the same walk of coupled axes twice, once with
// every step forced to look at everything, gives the same views and the same words to the drives in every cycle.

#include "tests/axes/axis/coupled_walk.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr unsigned walks_compared = 40;
constexpr int cycles_compared = 1500;

struct Walked {
    std::uint64_t digest = 0;
    long cycles = 0, calm = 0, planned_plain = 0;
};

Walked walk_again(unsigned seed, bool straight) {
    WalkCounts counts;
    CoupledWalk walk(seed, counts);
    walk.rig().digest.ask();
    walk.rig().straight = straight;
    EXPECT_EQ(walk.run(cycles_compared), "") << "seed " << seed;
    return {walk.rig().digest.value(), walk.cycles() * static_cast<long>(walk.rig().axes.size()), walk.rig().calm,
            walk.rig().planned_plain};
}

TEST(PlainCycle, IsTheWholeCycleInEveryWalk) {
    long cycles = 0, calm = 0, planned_plain = 0;
    for (unsigned seed = 1; seed <= property_cases(walks_compared); ++seed) {
        const auto straight = walk_again(seed, true), whole = walk_again(seed, false);
        EXPECT_EQ(straight.digest, whole.digest) << "seed " << seed;
        EXPECT_EQ(whole.calm + whole.planned_plain, 0) << "seed " << seed;
        cycles += straight.cycles;
        calm += straight.calm;
        planned_plain += straight.planned_plain;
    }
    // Walks in which hardly anything goes straight would show nothing.
    EXPECT_GT(calm, cycles / 10);
    EXPECT_GT(planned_plain, cycles / 20);
}

/// To and fro and behind one another, undisturbed: what a machine does all day.
Walked run_a_day(bool straight, const AxisConfig& config) {
    CouplingRig rig({config, config, config, config});
    rig.digest.ask();
    rig.straight = straight;
    const std::array<CamPoint, 3> points{CamPoint{0, 0, 0, 0, CamSegment::quintic}, CamPoint{20, 5, 0, 0, CamSegment::quintic},
                                         CamPoint{40, 0, 0, 0, CamSegment::quintic}};
    const auto cam = rig.tables.add_cam(points);
    rig.start();
    rig.accept(0, at_velocity(30));
    rig.accept(1, {.kind = CommandKind::gear_in, .details = GearDetails{CouplingRig::ref(0), {1, 2}, mcSetValue}});
    const auto table = rig.tables.prepare(cam, true, false, false).id;
    rig.accept(2, {.kind = CommandKind::cam_in, .details = CamDetails{.master = CouplingRig::ref(0), .table = table, .start = mcRelative}});
    double target = 20;
    CommandId move = 0;
    long cycle = 0;
    rig.program = [&] {
        ++cycle;
        if (move == 0 || rig.status(3, move) == CommandStatus::done) {
            target = target == 20 ? 60 : 20;
            move = rig.accept(3, absolute(target, 80));
        }
        if (cycle == 4000) rig.accept(0, at_velocity(-45));
    };
    rig.run(8000);
    rig.program = nullptr;
    return {rig.digest.value(), cycle * 4, rig.calm, rig.planned_plain};
}

TEST(PlainCycle, IsTheWholeCycleOfAMachineAtWork) {
    auto round = plain_slave();
    round.modulo = 360;
    auto inverted = plain_axis();
    inverted.gearing.inverted = true;
    inverted.following.window = 1;
    for (const auto& config : {plain_slave(), round, inverted}) {
        const auto straight = run_a_day(true, config), whole = run_a_day(false, config);
        EXPECT_EQ(straight.digest, whole.digest);
        EXPECT_EQ(whole.calm, 0);
        EXPECT_GT(straight.calm, straight.cycles * 9 / 10);
        EXPECT_GT(straight.planned_plain, straight.cycles * 8 / 10);
    }
}

/// Homed axes that run into what lies ahead of a plain cycle: a software limit, in its own motion and behind a master; a direction that is
/// no longer permitted; a motor that stays behind.
Walked run_into_limits(bool straight) {
    auto config = plain_slave();
    config.homing.kind = HomingKind::set_here;
    config.limits.position_min = -30;
    config.limits.position_max = 30;
    config.following.window = 1;
    CouplingRig rig({config, config, config, config});
    rig.digest.ask();
    rig.straight = straight;
    rig.start();
    for (std::size_t i = 0; i < 4; ++i) rig.accept(i, home(0));
    rig.run(50);
    rig.accept(0, at_velocity(10));
    rig.accept(1, {.kind = CommandKind::gear_in, .details = GearDetails{CouplingRig::ref(0), {2, 1}, mcSetValue}});
    rig.accept(2, at_velocity(10));
    rig.accept(3, at_velocity(10));
    long cycle = 0;
    rig.program = [&] {
        if (++cycle == 1000) rig.permits[2] = 2;
        if (cycle == 1500) rig.drives[3]->blocked = true;
    };
    rig.run(5000);
    rig.program = nullptr;
    EXPECT_TRUE(rig.raised(0, AxisAlarm::software_limit_reached));
    EXPECT_TRUE(rig.raised(1, AxisAlarm::software_limit_reached));
    EXPECT_TRUE(rig.raised(3, AxisAlarm::following_error));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(rig.view(i).set_position, 30 + 1e-6) << "axis " << i;
    EXPECT_EQ(rig.view(2).set_velocity, 0);
    return {rig.digest.value(), cycle * 4, rig.calm, rig.planned_plain};
}

TEST(PlainCycle, SeesWhatLiesAhead) {
    const auto straight = run_into_limits(true), whole = run_into_limits(false);
    EXPECT_EQ(straight.digest, whole.digest);
    EXPECT_GT(straight.planned_plain, straight.cycles / 10);
}

}  // namespace
}  // namespace taktwerk::axes::test
