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

}  // namespace
}  // namespace taktwerk::hmi
