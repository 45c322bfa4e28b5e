// Refused and aborted commands in words: whose, by whom, why, what to do.

#include "hmi_bridge/words/event_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "axes/axis/alarms.hpp"
#include "tests/hmi_bridge/fake_machine.hpp"

namespace taktwerk::hmi::test {
namespace {

using axes::CommandKind;
using axes::ErrorId;
using axes::Owner;
using runtime::CommandEvent;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct EventTextTest : ::testing::Test {
    FakeMachine machine;
    std::array<std::byte, 64> pick{}, hold{};
    CommandEvent event;
    void SetUp() override {
        machine.its_layout.blocks = {{"cell.pick", pick.data(), pick.size()}, {"cell.hold", hold.data(), hold.size()}};
        event.given = {CommandKind::move_absolute, Owner::program, 0, &pick[8]};
    }
    EventText text() const { return describe(event, machine.its_layout); }
};

TEST_F(EventTextTest, WhoHoldsAnAxisWithAStopIsNamedAndHowToEndIt) {
    event.error = ErrorId::state_forbids;
    event.by = {CommandKind::stop, Owner::program, 0, hold.data()};
    event.held = true;
    EXPECT_EQ(text().what,
              "'cell.pick' (MC_MoveAbsolute) was refused: The command is not allowed in the present state of the axis (state_forbids); "
              "'cell.hold' (MC_Stop) holds the axis");
    EXPECT_EQ(text().remedy, "Let Execute of 'cell.hold' (MC_Stop) fall, then give the command again.");
}

TEST_F(EventTextTest, ABlockWithoutANameIsNamedByItsProgramAndType) {
    event.given.block = nullptr;
    event.error = ErrorId::invalid_velocity;
    EXPECT_EQ(text().who, "MC_MoveAbsolute of program cell");
    EXPECT_THAT(text().what, AllOf(HasSubstr("invalid_velocity"), Not(HasSubstr("has the axis"))));
    EXPECT_THAT(text().remedy, HasSubstr("Give a velocity above zero"));
}

TEST_F(EventTextTest, TwoProgramsAreSaidToBeTwo) {
    event.what = CommandEvent::What::aborted;
    event.by = {CommandKind::move_relative, Owner::program, 1, nullptr};
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveAbsolute) was aborted by MC_MoveRelative of program feeder");
    EXPECT_EQ(text().remedy, "Two programs command this axis: let one of them do it.");

    event.by.program = 0;
    EXPECT_THAT(text().remedy, HasSubstr("mcBuffered")) << "the same program";

    event.by = {CommandKind::halt, Owner::operator_panel, runtime::no_program, nullptr};
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveAbsolute) was aborted by MC_Halt of the operator");
    EXPECT_THAT(text().remedy, HasSubstr("A person has stopped the axis"));

    event.what = CommandEvent::What::refused;
    event.error = ErrorId::power_conflict;
    event.given = {CommandKind::none, Owner::program, 1, nullptr};
    event.by = {CommandKind::none, Owner::program, 0, nullptr};
    EXPECT_THAT(text().what, AllOf(HasSubstr("MC_Power of program feeder"), HasSubstr("MC_Power of program cell has the axis")));
    EXPECT_THAT(text().remedy, HasSubstr("Two programs"));
}

TEST_F(EventTextTest, WhatEndedByTheAxisNamesTheAlarm) {
    event.what = CommandEvent::What::aborted;
    event.state = axes::AxisState::ErrorStop;
    event.axis_error = static_cast<std::uint16_t>(axes::id(axes::AxisAlarm::following_error));
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveAbsolute) was ended: the axis went into ErrorStop (following_error)");
    EXPECT_FALSE(text().remedy.empty());
    event.axis_error = 0;
    event.state = axes::AxisState::Disabled;
    EXPECT_THAT(text().what, HasSubstr("which is Disabled now"));
}

TEST_F(EventTextTest, AnOperatorsCommandIsHis) {
    event.given = {CommandKind::home, Owner::operator_panel, runtime::no_program, nullptr};
    event.error = ErrorId::in_error_stop;
    event.state = axes::AxisState::ErrorStop;
    event.axis_error = static_cast<std::uint16_t>(axes::id(axes::AxisAlarm::following_error));
    EXPECT_THAT(text().what, AllOf(HasSubstr("MC_Home of the operator was refused"), HasSubstr("by following_error")));
    EXPECT_THAT(text().remedy, HasSubstr("`taktwerk reset`"));
}

// Numbers are written as on drives' panels and in their manuals, here as everywhere: 9ABCh.
TEST_F(EventTextTest, AnErrorThatNoListNamesIsWrittenAsAllOtherNumbersAre) {
    event.error = static_cast<ErrorId>(0x9ABC);
    EXPECT_THAT(text().what, HasSubstr("was refused with error 9ABCh"));
}

// Group "table" has the axes x and y.
TEST_F(EventTextTest, AGroupsRefusedCommandSaysWhichRoomAndWhere) {
    machine.its_layout.groups[0].rooms = {{"cell", false}, {"post", true}};
    event = {};
    event.group = 0;
    event.axis = axes::AxisRef{}.index;
    event.given.owner = Owner::program;
    event.given.program = 0;
    event.given.block = &pick[8];
    event.given.group_kind = axes::GroupCommandKind::linear_absolute;
    event.error = ErrorId::outside_workspace;
    event.place.error = event.error;
    auto& at = event.place.at;
    at.room = 1;
    at.in_space = at.on_path = true;
    at.point = {45, -0.0001, 12.5};
    at.part = 0.45;
    at.length = 100;
    const std::string refused =
        "'cell.pick' (MC_MoveLinearAbsolute) was refused: The path leaves the workspace of the tool (outside_workspace). Where: ";
    EXPECT_EQ(event_subject(event, machine.its_layout), "group table");
    EXPECT_EQ(
        text().what,
        refused + "it enters the kept-free room 'post'; at X 45.000 Y 0.000 Z 12.500 mm (MCS); after 45.000 of 100.000 mm of its way");
    EXPECT_THAT(text().remedy, HasSubstr("around the room"));
    at.room = 0;
    at.length = 0;
    event.place.line = 12;
    EXPECT_EQ(text().what,
              refused + "it leaves the room 'cell'; at X 45.000 Y 0.000 Z 12.500 mm (MCS); after 45.0 % of its way; line 12 of its text");

    event.error = event.place.error = ErrorId::beyond_software_limit;
    event.place = {.error = event.error};
    at.place = 1;
    EXPECT_THAT(text().what, HasSubstr(". Where: axis y would be beyond its limit"));
    at.limit_known = true;
    at.position = 120;
    at.limit = 100;
    EXPECT_THAT(text().what, HasSubstr(". Where: axis y would go to 120.000 mm, its limit is 100.000 mm"));
    event.error = event.place.error = ErrorId::not_homed;
    EXPECT_THAT(text().what, HasSubstr(". Where: axis y is not homed"));
    at = {};
    EXPECT_THAT(text().what, Not(HasSubstr("Where"))) << "nobody can say";

    event.what = CommandEvent::What::aborted;
    event.axis_error = axes::id(axes::AxisAlarm::drive_fault);
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveLinearAbsolute) was ended: the group went into GroupErrorStop (drive_fault)");
    event.error_axis = 1;
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveLinearAbsolute) was ended: the group went into GroupErrorStop (drive_fault of axis y)");
    event.what = CommandEvent::What::refused;
    event.error = ErrorId::in_error_stop;
    EXPECT_THAT(text().what, HasSubstr("(in_error_stop), by drive_fault of axis y"));
}

// Who ended a group's command, and what is to be done: another program, its own, a person, or nobody.
TEST_F(EventTextTest, AGroupsAbortedCommandSaysByWhom) {
    event = {};
    event.what = CommandEvent::What::aborted;
    event.group = 0;
    event.axis = axes::AxisRef{}.index;
    event.given.owner = Owner::program;
    event.given.program = 0;
    event.given.block = &pick[8];
    event.given.group_kind = axes::GroupCommandKind::linear_absolute;
    event.by = {axes::CommandKind::none, Owner::program, 1, nullptr, axes::GroupCommandKind::halt};
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveLinearAbsolute) was aborted by MC_GroupHalt of program feeder");
    EXPECT_THAT(text().remedy, HasSubstr("Two programs command this group"));
    event.by.program = 0;
    event.by.group_kind = axes::GroupCommandKind::linear_relative;
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveLinearAbsolute) was aborted by MC_MoveLinearRelative of program cell");
    EXPECT_THAT(text().remedy, HasSubstr("mcBuffered"));
    event.by = {axes::CommandKind::none, Owner::operator_panel, runtime::no_program, nullptr, axes::GroupCommandKind::halt};
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveLinearAbsolute) was aborted by MC_GroupHalt of the operator");
    EXPECT_THAT(text().remedy, HasSubstr("A person has stopped the group"));
    event.by = {};
    EXPECT_EQ(text().what, "'cell.pick' (MC_MoveLinearAbsolute) was ended by the group itself");

    event.by = event.given;
    event.given = {axes::CommandKind::none, Owner::operator_panel, runtime::no_program, nullptr, axes::GroupCommandKind::interrupt};
    EXPECT_EQ(text().what, "MC_GroupInterrupt of the operator was aborted by 'cell.pick' (MC_MoveLinearAbsolute)");
    EXPECT_THAT(text().remedy, HasSubstr("an override of 0 holds it"));
}

}  // namespace
}  // namespace taktwerk::hmi::test
