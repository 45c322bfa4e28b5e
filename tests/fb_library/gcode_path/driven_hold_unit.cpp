// MC_SyncGroupToAxis against a person's hold: the master goes where it likes, and the tool stands until he lets it go.

#include "tests/fb_library/gcode_path/driven_rig.hpp"

namespace taktwerk::fb {
namespace {

struct HeldByPerson : DrivenRig {
    explicit HeldByPerson(const char* text = circle) : DrivenRig(text) {
        begin();
        master_at(20);
        EXPECT_TRUE(plc.until([&] { return sync.InSync && speed() > 15; }, 2000));
        EXPECT_EQ(group().hold(), ErrorId::none);
    }
    axes::AxisGroup& group() { return plc.rig.groups[0]; }
    [[nodiscard]] bool moves(int cycles) {
        const auto at = tool();
        bool moved = false;
        for (int i = 0; i < cycles; ++i) {
            plc.run(1);
            moved = moved || tool() != at;
        }
        return moved;
    }
};

// It comes to rest on the path, stands whatever the master does, and comes up to it again from there.
TEST(DrivenHold, ItStandsAndComesUpToItsMasterAgain) {
    HeldByPerson rig;
    ASSERT_TRUE(rig.comes_to_rest());
    rig.plc.run(1);
    EXPECT_TRUE(rig.plc.rig.view().interrupted);
    rig.master_at(-30);
    EXPECT_FALSE(rig.moves(500));
    EXPECT_TRUE(rig.sync.Busy);
    EXPECT_FALSE(rig.sync.Active);
    rig.master_at(20);
    rig.plc.run(500);
    EXPECT_EQ(rig.group().release_hold(), ErrorId::none);
    EXPECT_TRUE(rig.plc.until([&] { return rig.sync.InSync && rig.speed() > 15; }, 2000));
}

// What its program commands meanwhile, while it brakes and at rest: driven it is not, a line waits.
TEST(DrivenHold, NothingOfItsProgramMovesIt) {
    for (const bool at_rest : {false, true}) {
        HeldByPerson rig;
        ASSERT_TRUE(!at_rest || rig.comes_to_rest());
        const auto next = rig.plc.rig.give(axes::test::line({5, 5, 0}, 30));
        EXPECT_EQ(next.error, ErrorId::none) << at_rest;
        ASSERT_TRUE(rig.comes_to_rest());
        rig.plc.run(5);
        EXPECT_TRUE(rig.sync.CommandAborted);
        rig.sync.Execute = false;
        rig.plc.run(1);
        rig.sync.Execute = true;
        EXPECT_FALSE(rig.moves(500));
        EXPECT_TRUE(rig.sync.Error);
        EXPECT_EQ(rig.sync.ErrorID, ErrorId::held_by_person);
        EXPECT_EQ(rig.plc.rig.status(next.id), axes::CommandStatus::queued);
        EXPECT_EQ(rig.group().release_hold(), ErrorId::none);
        EXPECT_TRUE(rig.plc.until([&] { return rig.plc.rig.status(next.id) == axes::CommandStatus::done; }, 3000));
    }
}

// A person's stop ends it; a master that moves on moves nothing.
TEST(DrivenHold, HisStopEndsIt) {
    for (const bool at_rest : {false, true}) {
        HeldByPerson rig;
        ASSERT_TRUE(!at_rest || rig.comes_to_rest());
        rig.group().halt();
        ASSERT_TRUE(rig.comes_to_rest());
        EXPECT_FALSE(rig.moves(300));
        EXPECT_TRUE(rig.sync.CommandAborted);
        EXPECT_EQ(rig.state(), axes::GroupState::GroupStandby);
        EXPECT_FALSE(rig.plc.rig.view().interrupted);
    }
}

}  // namespace
}  // namespace taktwerk::fb
