// What a refusal says to who gave the command.

#include "hmi_bridge/words/answer_text.hpp"

#include <gmock/gmock.h>

namespace taktwerk::hmi {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// hmi_bridge/README.md: refused while the emergency stop holds. Who switches on or resets has given no direction that could be barred.
TEST(AnswerText, WhileTheEmergencyStopHoldsAResetAndAnEnableAreToldOfItAlone) {
    const runtime::CommandAnswer refused{.answer = runtime::Answer::refused_by_axis, .error = axes::ErrorId::interlocked};
    for (const auto kind : {CommandKind::enable, CommandKind::reset}) {
        const auto error = explain(refused, kind, "axis x", {});
        EXPECT_THAT(error.what, AllOf(HasSubstr("emergency stop"), Not(HasSubstr("direction"))));
        EXPECT_THAT(error.remedy, AllOf(HasSubstr("Release"), Not(HasSubstr("other way"))));
    }
    EXPECT_THAT(explain(refused, CommandKind::move, "axis x", {}).what, HasSubstr("direction")) << "a limit switch may bar it";
}

// Of a group's jog: which axis' limit, which room, or that the arm does not turn so; and never that "the axis" is in some state.
TEST(AnswerText, AGroupsJogIsToldWhatItMet) {
    runtime::CommandAnswer refused{.answer = runtime::Answer::refused_by_axis, .error = axes::ErrorId::beyond_software_limit};
    const auto told = [&](std::string_view met = {}) { return explain(refused, CommandKind::group_jog, "group arm", {}, met); };
    refused.jog_end = axes::JogEnd::member_limit;
    EXPECT_EQ(told("elbow").what,
              "The way leads beyond a software limit (beyond_software_limit): axis elbow is at its limit in this direction");
    EXPECT_THAT(told("elbow").remedy, HasSubstr("Jog arm the other way"));
    refused.jog_end = axes::JogEnd::none;
    EXPECT_THAT(told("elbow").what, HasSubstr("axis elbow stands outside its limits"));
    EXPECT_EQ(told("elbow").remedy, "Bring it back alone: `taktwerk jog elbow`.");
    refused.error = axes::ErrorId::outside_workspace;
    refused.jog_end = axes::JogEnd::workspace;
    EXPECT_EQ(told("post").what,
              "The tool came to a wall of its workspace (outside_workspace): the room 'post' ends there, or is kept free");
    refused.error = axes::ErrorId::out_of_reach;
    refused.jog_end = axes::JogEnd::reach;
    EXPECT_THAT(told().what, HasSubstr("as far as its arm reaches"));
    refused.jog_end = axes::JogEnd::orientation;
    EXPECT_THAT(told().what, AllOf(HasSubstr("cannot turn its tool about this direction"), Not(HasSubstr("as far as"))));
    refused.jog_end = axes::JogEnd::none;
    for (const auto error : {axes::ErrorId::in_error_stop, axes::ErrorId::not_powered, axes::ErrorId::state_forbids,
                             axes::ErrorId::invalid_position, axes::ErrorId::drive_not_ready, axes::ErrorId::not_connected}) {
        refused.error = error;
        EXPECT_THAT(told().what, AllOf(Not(HasSubstr("The axis")), Not(HasSubstr("of the axis ("))));
        EXPECT_FALSE(told().remedy.empty());
    }
}

}  // namespace
}  // namespace taktwerk::hmi
