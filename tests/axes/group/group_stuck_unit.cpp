// A way along which no motion is found: the command ends with that, and the group is where it was. Provoked by a velocity at which ten units take
// three million years: nothing that lasts longer than 10^12 s is a motion.

#include "axes/group/path_source.hpp"
#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double no_velocity = 1e-13;  // u/s
constexpr int soon = 100;              // cycles: a plan and its answer

// 1e-200: its square is 0, and cells that are made for it are shorter than the last digit of a place.
class AStuckGroup : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(GroupStuck, AStuckGroup, testing::Values(no_velocity, 1e-200));

TEST_P(AStuckGroup, EndsItsCommandAndStands) {
    GroupRig rig(2);
    rig.enable();
    const auto stuck = rig.give(line({10, 5}, GetParam()));
    ASSERT_NE(stuck.id, 0U);
    ASSERT_TRUE(rig.until([&] { return rig.status(stuck.id) == CommandStatus::error; }, soon)) << "it is not tried for ever";
    EXPECT_EQ(rig.error_of(stuck.id), ErrorId::path_not_planned);
    rig.run(3);
    EXPECT_EQ(rig.view().state, GroupState::GroupStandby);
    EXPECT_EQ(rig.view().error, 0) << "no error of the group: it stands where it stood, and can be moved";
    EXPECT_EQ(rig.point(), JointVector{});
    const auto next = rig.give(line({10, 5}, 50));
    ASSERT_TRUE(rig.until([&] { return rig.status(next.id) == CommandStatus::done; }, 2000));
    EXPECT_EQ(rig.point()[0], 10);
}

// The one in front of it arrives, the one behind it begins where the group stands, not where the other would have ended.
TEST(GroupStuck, ItsNeighboursAreGone) {
    GroupRig rig(1);
    rig.enable();
    const auto first = rig.give(line({30}, 50));
    const auto stuck = rig.give(line_by({10}, no_velocity, mcBuffered));
    const auto last = rig.give(line_by({-5}, 50, mcBuffered));
    ASSERT_TRUE(rig.until([&] { return rig.status(first.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 30);
    ASSERT_TRUE(rig.until([&] { return rig.status(stuck.id) == CommandStatus::error; }, soon));
    EXPECT_EQ(rig.error_of(stuck.id), ErrorId::path_not_planned);
    ASSERT_TRUE(rig.until([&] { return rig.status(last.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 25);
}

// That the next way is stuck is known long before: it is nothing to the one that runs, also while that stands by an override of 0.
TEST(GroupStuck, WhatIsPreparedDoesNotEndWhatRuns) {
    GroupRig rig(1);
    rig.enable();
    const auto first = rig.give(line({30}, 50));
    const auto stuck = rig.give(line({40}, no_velocity, mcBuffered));
    rig.run(200);
    ASSERT_EQ(rig.set(Override{.velocity = 0}), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().path_velocity == 0; }, 1000));
    rig.run(200);
    EXPECT_EQ(rig.status(first.id), CommandStatus::active);
    EXPECT_EQ(rig.status(stuck.id), CommandStatus::queued);
    ASSERT_EQ(rig.set(Override{.velocity = 1}), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.status(first.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 30);
    ASSERT_TRUE(rig.until([&] { return rig.status(stuck.id) == CommandStatus::error; }, soon));
}

// Three lines of 10, each from rest to rest; the second cannot be planned.
class ThreeLines final : public PathSource {
public:
    PathItem next() override {
        constexpr std::array<double, 3> velocities{50, no_velocity, 50};
        PathItem item;
        if (at_ == velocities.size()) return item;
        item.kind = PathItem::Kind::line;
        item.joint = PathItem::Joint::stop;
        item.velocity = velocities[at_++];
        item.line = static_cast<std::uint32_t>(at_);
        item.to = {10.0 * item.line, 0, 0};
        return item;
    }

private:
    std::size_t at_ = 0;
};
class ThreeLinesProgram final : public PathProgram {
    [[nodiscard]] std::unique_ptr<PathSource> open(const std::array<double, 3>&) const override { return std::make_unique<ThreeLines>(); }
};
class ThreeLinesMaker final : public PathMaker {
    void begin(const PathOptions&, const std::array<double, 3>&, double) override {}
    std::optional<PathMade> step() override { return PathMade{std::make_shared<ThreeLinesProgram>(), 3, {}}; }
};

// All before it is gone, then the command ends with the reason; the group stands in front of the line, and what waits begins there.
TEST(GroupStuck, AStoredPathEndsInFrontOfIt) {
    std::vector<AxisConfig> configs{group_axis("x"), group_axis("y"), group_axis("z")};
    std::vector<std::unique_ptr<PathMaker>> makers;
    makers.push_back(std::make_unique<ThreeLinesMaker>());
    GroupRig rig(configs, {{.name = "g", .members = {"x", "y", "z"}, .kinematics = cartesian_arm()}}, std::move(makers));
    rig.enable();
    const auto ticket = rig.groups.select(GroupRig::ref, PathRef{0}, {}).id;
    ASSERT_NE(ticket, 0U);
    ASSERT_TRUE(rig.until([&] { return rig.groups.path(PathRef{0})->kind == PathState::Kind::ready; }, 20));
    const auto path = rig.give({.kind = GroupCommandKind::path, .frame = mcMCS, .path = PathRef{0}, .ticket = ticket});
    ASSERT_NE(path.id, 0U) << static_cast<int>(path.error);
    const auto next = rig.give(line({5, 5, 5}, 50, mcBuffered));
    double furthest = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            furthest = std::max(furthest, rig.point()[0]);
            return rig.status(path.id) == CommandStatus::error;
        },
        3000));
    EXPECT_EQ(furthest, 10) << "the first line, exactly, and no more";
    EXPECT_EQ(rig.error_of(path.id), ErrorId::path_not_planned);
    EXPECT_EQ(rig.view().path.place.error, ErrorId::path_not_planned);
    ASSERT_TRUE(rig.until([&] { return rig.status(next.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[2], 5);
    rig.run(3);
    EXPECT_EQ(rig.view().state, GroupState::GroupStandby);
}

}  // namespace
}  // namespace taktwerk::axes::test
