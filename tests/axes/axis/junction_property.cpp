// Chains of blended moves against an independent calculation on the (way, velocity) plane: ramps as closed formulas, a pass from the end of the chain
// forwards for what can be braked, one from its beginning for what can be reached. Seeds are fixed.

#include <random>

#include "axes/axis/junction.hpp"
#include "tests/axes/axis/axis_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

/// Way of the fastest change of speed from v to u without acceleration at both ends.
double ramp_way(double v, double u, double ramp, double jerk) {
    const double dv = std::abs(v - u);
    const double time = std::isinf(jerk) ? dv / ramp : dv <= ramp * ramp / jerk ? 2 * std::sqrt(dv / jerk) : dv / ramp + ramp / jerk;
    return (v + u) / 2 * time;
}
/// The highest speed from which `u` is reached within `way`, at most `most`.
double highest_from(double u, double way, double ramp, double jerk, double most) {
    if (ramp_way(most, u, ramp, jerk) <= way) return most;
    double low = u, high = most;
    for (int i = 0; i < 200; ++i) (ramp_way((low + high) / 2, u, ramp, jerk) <= way ? low : high) = (low + high) / 2;
    return low;
}
double rule(MC_BufferMode mode, double v1, double v2) {
    return mode == mcBlendingLow ? std::min(v1, v2) : mode == mcBlendingPrevious ? v1 : mode == mcBlendingNext ? v2 : std::max(v1, v2);
}

struct Move {
    double end = 0, speed = 0, up = 0, down = 0;
    MC_BufferMode mode = mcBuffered;
};
std::vector<Move> any_chain(std::mt19937& random, bool one_way) {
    const auto pick = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() % 10001) / 10000; };
    std::vector<Move> chain;
    double place = 0;
    for (auto n = 2 + random() % 6; n > 0; --n) {
        Move move;
        const double way = random() % 3 ? pick(2, 30) : pick(0.05, 2);
        place += one_way || random() % 5 ? way : -way;
        move = {place, pick(5, 100), pick(200, 1000), pick(200, 1000), static_cast<MC_BufferMode>(mcBlendingLow + random() % 4)};
        chain.push_back(move);
    }
    return chain;
}

/// Velocity at the end of each move of the chain as the rules of axes/axis/junction.hpp say, starting from rest at 0.
std::vector<double> expected_joints(const std::vector<Move>& chain, double jerk) {
    const auto way = [&](std::size_t i) { return chain[i].end - (i == 0 ? 0 : chain[i - 1].end); };
    std::vector<double> joints(chain.size(), 0);
    for (std::size_t i = chain.size() - 1; i-- > 0;) {
        if (way(i) * way(i + 1) <= 0) continue;
        const double wanted = rule(chain[i + 1].mode, chain[i].speed, chain[i + 1].speed);
        if (wanted <= joints[i + 1]) joints[i] = wanted;  // slower than it has to become: no braking
        else joints[i] = std::min(wanted, highest_from(joints[i + 1], std::abs(way(i + 1)), chain[i + 1].down, jerk, wanted));
    }
    double speed = 0;
    for (std::size_t i = 0; i < chain.size(); ++i) {  // what can be reached
        if (joints[i] > speed) joints[i] = std::min(joints[i], highest_from(speed, std::abs(way(i)), chain[i].up, jerk, joints[i]));
        speed = joints[i];
    }
    return joints;
}

class RandomChain : public ::testing::TestWithParam<unsigned> {};

// The pure function, with and without jerk: the first joint of random chains that go one way.
TEST_P(RandomChain, FirstJointIsTheIndependentOne) {
    std::mt19937 random(GetParam());
    for (int round = 0; round < 300; ++round) {
        const double jerk = random() % 2 ? infinity : 5000;
        const auto moves = any_chain(random, round % 3 != 0);
        std::vector<ChainMove> chain;
        for (std::size_t i = 0; i < moves.size(); ++i) {
            const auto& move = moves[i];
            chain.push_back({.way = move.end - (i == 0 ? 0 : moves[i - 1].end),
                             .speed = move.speed,
                             .mode = move.mode,
                             .limits = {move.speed, move.up, move.down, jerk}});
        }
        const double joint = junction_velocity(chain);
        const double reached = nearest_reachable(joint, {0, 0, 0}, moves[0].end, chain[0].limits);
        const double expected = std::copysign(expected_joints(moves, jerk)[0], moves[0].end);
        ASSERT_NEAR(reached, expected, 1e-6 * (1 + std::abs(expected))) << GetParam() << " round " << round;
    }
}

// The axis, without jerk, cycle by cycle: each joint is passed at the independent velocity, nothing is overshot, and it takes no longer than
// Buffered. At a joint the set-point is known a cycle before and after: the velocity there lies between, give or take a ramp of one cycle.
TEST_P(RandomChain, AxisPassesEachJointAsCalculated) {
    std::mt19937 random(GetParam() + 1000);
    auto config = plain_axis();
    config.limits.jerk = infinity;
    config.queue_depth = 8;
    const auto moves = any_chain(random, false);
    const auto joints = expected_joints(moves, infinity);
    double low = 0, high = 0;
    for (const auto& move : moves) low = std::min(low, move.end), high = std::max(high, move.end);

    std::array<double, 2> times{};
    for (const bool blended : {false, true}) {
        Rig rig(config);
        rig.power_on();
        const auto begin = rig.now;
        std::vector<CommandId> ids;
        for (std::size_t i = 0; i < moves.size(); ++i) {
            auto command = absolute(moves[i].end, moves[i].speed, i == 0 ? mcAborting : blended ? moves[i].mode : mcBuffered);
            command.acceleration = moves[i].up;
            command.deceleration = moves[i].down;
            ids.push_back(rig.accept(command));
        }
        std::size_t next = 0;
        auto before = rig.view();
        for (Patience patience; patience.lasts(next < ids.size());) {
            rig.step();
            const auto& view = rig.view();
            ASSERT_GE(view.set_position, low - 1e-9);
            ASSERT_LE(view.set_position, high + 1e-9);
            for (; next < ids.size() && rig.status(ids[next]) == CommandStatus::done; ++next) {
                const double sense = moves[next].end - (next == 0 ? 0 : moves[next - 1].end) < 0 ? -1 : 1;
                const double expected = blended ? joints[next] : 0;
                const bool two_in_one = next + 1 < ids.size() && rig.status(ids[next + 1]) == CommandStatus::done;
                const bool two_before = before.status(ids[next]) == CommandStatus::queued;
                if (!two_in_one && !two_before) {  // otherwise a whole move lies inside this cycle
                    const double ramp = 1000 * 0.001 + 1e-6;
                    ASSERT_LE(sense * before.set_velocity, expected + ramp) << GetParam() << " joint " << next;
                    ASSERT_GE(sense * before.set_velocity, expected - ramp) << GetParam() << " joint " << next;
                }
                ASSERT_NEAR(view.set_position, moves[next].end, 0.1 + 1e-9) << GetParam() << " joint " << next;  // 100 u/s
            }
            before = view;
            ASSERT_LT(to_seconds(rig.now - begin), 100);
        }
        times[blended] = to_seconds(rig.now - begin);
        EXPECT_EQ(rig.view().set_position, moves.back().end);
    }
    EXPECT_LE(times[1], times[0] + 0.0011) << GetParam();
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomChain, ::testing::Range(1u, 61u));

}  // namespace
}  // namespace taktwerk::axes::test
