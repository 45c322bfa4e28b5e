// A portal of three axes works in a frame that is turned: a work piece lies as it lies, and the tool, which nothing can turn, stays as it is.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double quarter = std::numbers::pi / 2;

/// In a product whose X is the machine's Y: its origin is at (10, 20, 3).
GroupCommand on_turned_piece(GroupCommand command) {
    command.frame = mcPCS_2;
    return command;
}
ErrorId outcome_of(GroupRig& rig, const GroupCommand& command) {
    const auto given = rig.give(command);
    if (given.error != ErrorId::none) return given.error;
    EXPECT_TRUE(
        rig.until([&] { return rig.status(given.id) == CommandStatus::done || rig.status(given.id) == CommandStatus::error; }, 9000));
    rig.run(3);
    return rig.error_of(given.id);
}

TEST(GroupTurnedFrame, AnArmThatCannotTurnGoesThereWithItsToolAsItIs) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    ASSERT_EQ(rig.give({.kind = GroupCommandKind::set_frame, .frame = mcPCS_2, .target = {10, 20, 3, 0, 0, quarter}}).error, ErrorId::none);
    // (5, 0, 0) of the product: (10, 20) + 5 along Y. (5, 4, 0): 4 against X beside.
    ASSERT_EQ(outcome_of(rig, on_turned_piece(line({5, 0, 0}, 50))), ErrorId::none);
    EXPECT_NEAR(rig.point()[0], 10, 1e-9);
    EXPECT_NEAR(rig.point()[1], 25, 1e-9);
    EXPECT_NEAR(rig.point()[2], 3, 1e-9);
    auto direct = on_turned_piece(line({5, 4, 0}, 50));
    direct.kind = GroupCommandKind::direct_absolute;
    ASSERT_EQ(outcome_of(rig, direct), ErrorId::none);
    EXPECT_NEAR(rig.point()[0], 6, 1e-9);
    EXPECT_NEAR(rig.point()[1], 25, 1e-9);
    // Half a circle about (5, 2), back to (5, 0).
    auto arc = on_turned_piece(line({5, 0, 0}, 50));
    arc.kind = GroupCommandKind::circular_absolute;
    arc.circle = {.mode = mcCENTER, .aux = {5, 2, 0}};
    ASSERT_EQ(outcome_of(rig, arc), ErrorId::none);
    EXPECT_NEAR(rig.point()[0], 10, 1e-9);
    EXPECT_NEAR(rig.point()[1], 25, 1e-9);
}

// Who asks for a turn asks for something that cannot be: refused, where the tool's own turn, seen from the frame, is not.
TEST(GroupTurnedFrame, ATurnThatIsAskedForIsNotKeptSilent) {
    GroupRig rig(3, cartesian_arm());
    rig.enable();
    ASSERT_EQ(rig.give({.kind = GroupCommandKind::set_frame, .frame = mcPCS_2, .target = {10, 20, 3, 0, 0, quarter}}).error, ErrorId::none);
    EXPECT_EQ(outcome_of(rig, on_turned_piece(line({5, 0, 0, 0, 0, 0.1}, 50))), ErrorId::out_of_reach);
    EXPECT_EQ(outcome_of(rig, on_turned_piece(line({5, 0, 0, 0, 0, -quarter}, 50))), ErrorId::none);
}

}  // namespace
}  // namespace taktwerk::axes::test
