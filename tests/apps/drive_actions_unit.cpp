// What `drive set` writes that is no setting does something: stores, restores, tunes, commands. It takes a yes, and is not read back as if it
// were a value.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/drive/drive.hpp"
#include "apps/terminal/exit_code.hpp"
#include "tests/apps/in_process.hpp"
#include "tests/apps/machine_files.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Outcome on_five(std::vector<std::string> words) {
    words.insert(words.end(), {"--machine", five, "--simulate"});
    return drive(std::move(words));
}

struct Act {
    const char* drive;
    const char* assignment;
    const char* name;   ///< in the manual
    const char* other;  ///< the command that does it with care, or nothing
};
class Acts : public ::testing::TestWithParam<Act> {};

// SE-808X 4.2: 1010h "save" and 1011h "load". SV-DA200 4.4: P4.91, P4.92. SV33-E 7.2: P05.01 initialises, P20.03 resets, P20.05 = 2 clears turns;
// 4.2: the offline inertia identification turns the motor.
// CiA 402: 6040h is the control word.
TEST_P(Acts, AreNotDoneUnasked) {
    const auto& act = GetParam();
    const auto unasked = on_five({"set", act.drive, act.assignment});
    EXPECT_NE(unasked.code, exit_ok) << act.assignment;
    EXPECT_THAT(unasked.err, AllOf(HasSubstr(act.name), HasSubstr("is no setting"), HasSubstr("--yes"), HasSubstr(act.other)))
        << act.assignment;
    EXPECT_THAT(unasked.out, Not(HasSubstr("written")));
}
INSTANTIATE_TEST_SUITE_P(
    Each, Acts,
    ::testing::Values(Act{"stepper_drive", "1010h:01=0x65766173", "save all parameters", "--store"},
                      Act{"stepper_drive", "1011h:01=0x64616F6C", "restore all parameters", "drive save stepper_drive FILE"},
                      Act{"da200_drive", "P4.91=1", "Parameter save", "manual"}, Act{"da200_drive", "P4.92=1", "Restore factory", "manual"},
                      Act{"da200_drive", "P1.04=1", "Offline inertia tuning", "manual"},
                      Act{"sv33_drive", "P05.01=1", "system parameter initialisation", "drive save sv33_drive FILE"},
                      Act{"sv33_drive", "P1A.05=1", "offline inertia identification", "manual"},
                      Act{"sv33_drive", "P20.03=1", "fault reset", "drive reset sv33_drive"},
                      Act{"sv33_drive", "P20.05=2", "encoder reset", "clear-turns sv33_drive"}));

// A setting beside it is not written either.
TEST(DriveActs, NothingIsHalfDone) {
    const auto both = on_five({"set", "da200_drive", "P0.05=300", "P4.92=1"});
    EXPECT_NE(both.code, exit_ok);
    EXPECT_THAT(both.out, Not(HasSubstr("P0.05")));
}

// 1011h:01 reads what can be restored (CiA 301: bit 0), not what was written to it.
TEST(DriveActs, WithAYesAreDoneAndNotReadBackAsAValue) {
    for (const char* assignment : {"1011h:01=0x64616F6C", "1010h:01=0x65766173"}) {
        const auto done = on_five({"set", "stepper_drive", assignment, "--yes"});
        EXPECT_EQ(done.code, exit_ok) << assignment << ": " << done.err;
        EXPECT_THAT(done.out, AllOf(HasSubstr("written"), Not(HasSubstr("nothing to change")), Not(HasSubstr("lost at power off"))));
    }
    EXPECT_EQ(on_five({"set", "da200_drive", "P4.91=1", "--yes"}).code, exit_ok);
    EXPECT_EQ(on_five({"set", "da200_drive", "P0.05=300"}).code, exit_ok) << "a setting needs none";
}

// --- what is typed -----------------------------------------------------------------------------------------------------------------

TEST(DriveWords, WhatIsProposedIsOfThisDrive) {
    const auto loose = on_five({"set", "da200_drive", "P0.05=300", "rpm"});
    EXPECT_EQ(loose.code, exit_usage);
    EXPECT_THAT(loose.err, AllOf(HasSubstr("rpm"), HasSubstr("has no '='"), HasSubstr("'P0.05=300 rpm'"), Not(HasSubstr("P05.13"))));
    EXPECT_THAT(on_five({"set", "da200_drive", "P0.05"}).err, AllOf(HasSubstr("write P0.05=VALUE"), Not(HasSubstr("P05.13"))));
    const auto nothing = on_five({"set", "da200_drive", "rpm"});
    EXPECT_THAT(nothing.err, AllOf(HasSubstr("PARAMETER=VALUE, such as"), Not(HasSubstr("P05.13"))));
}

TEST(DriveWords, AParameterTwiceIsRefused) {
    for (const char* second : {"P0.05=400", "P0.05=300", "2005h=400"}) {
        const auto twice = on_five({"set", "da200_drive", "P0.05=300", second});
        EXPECT_EQ(twice.code, exit_usage) << second;
        EXPECT_THAT(twice.err, AllOf(HasSubstr("P0.05"), HasSubstr("given twice"))) << second;
        EXPECT_THAT(twice.out, Not(HasSubstr("changed")));
    }
}

TEST(DriveWords, WhoIsNotThereIsToldOfTheSerialLinesToo) {
    const auto unknown = on_five({"save", "xp200", "/nowhere/x.yaml"});
    EXPECT_NE(unknown.code, exit_ok);
    EXPECT_THAT(unknown.err, AllOf(HasSubstr("stepper_drive"), HasSubstr("xp200_drive")));
}

TEST(DriveWords, SixAxesAreAxes) {
    EXPECT_THAT(on_five({"get", "robot", "PA17", "--axis", "7"}).err, AllOf(HasSubstr("6 axes"), Not(HasSubstr("axiss"))));
}

// SV33-E 5.5, A.D35: methods 15, 16, 31 and 32 do not exist, although 7.3 gives -2 to 35. SE-808X 4.3: 605Ah and 605Dh are 1 or 2.
TEST(DriveWords, AValueThatTheManualForbidsIsRefused) {
    for (const auto* word : {"6098h=15", "6098h=32"}) {
        const auto refused = on_five({"set", "sv33_drive", word});
        EXPECT_NE(refused.code, exit_ok) << word;
        EXPECT_THAT(refused.err, AllOf(HasSubstr("does not document homing method"), HasSubstr("33, 34, 35"))) << word;
    }
    EXPECT_EQ(on_five({"set", "sv33_drive", "6098h=17"}).code, exit_ok) << "positive control";
    for (const auto* word : {"605Ah=3", "605Dh=0"})
        EXPECT_THAT(on_five({"set", "stepper_drive", word}).err, HasSubstr("give 1 .. 2")) << word;
}

// --- run ---------------------------------------------------------------------------------------------------------------------------

TEST(RunDuration, ThatIsOverBeforeTheBusIsUpIsSaid) {
    const auto run = [](const char* duration) {
        return in_process({"run", serial_axis, "--simulate", "--virtual-time", "--quiet", "--duration", duration});
    };
    const auto ended = run("0.01s");
    EXPECT_EQ(ended.code, exit_bus);
    EXPECT_THAT(ended.err, AllOf(HasSubstr("ended by --duration"), HasSubstr("the bus needed"), HasSubstr("0.01 s")));
    EXPECT_EQ(run("5s").code, exit_ok) << "positive control";
}

}  // namespace
}  // namespace taktwerk::apps
