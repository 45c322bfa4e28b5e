// A program that never returns, in the built command (docs/stopping.md). While it hangs it has a processor to itself, at the cycle's priority: whatever runs
// in real time beside it would feel that.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/terminal/exit_code.hpp"
#include "tests/apps/child.hpp"
#include "tests/apps/machine_files.hpp"
#include "tests/apps/stopping.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::HasSubstr;

class HungProgram : public Stopping {};

TEST_F(HungProgram, AnEndlessLoopInABaseTaskIsNamedToEveryClientAndEndsInThePromisedTime) {
    Child run({taktwerk, "run", dying(2)});
    EXPECT_TRUE(run.says("task 'main' of program 'dying' does not return", 60s)) << run.text();
    const auto hello = ask({{"cmd", "hello"}});
    ASSERT_TRUE(hello) << refused.text();
    EXPECT_EQ((*hello)["hello"]["cycling"], false);
    EXPECT_FALSE(ask({{"cmd", "state"}})) << "frozen values are not shown as if they lived";
    EXPECT_EQ(refused.code, "state.stuck");
    EXPECT_THAT(refused.what, HasSubstr("'dying'"));
    EXPECT_FALSE(ask({{"cmd", "stop"}})) << "nobody may believe that it stops";
    EXPECT_EQ(refused.code, "command.no_answer");
    EXPECT_FALSE(ask({{"cmd", "shutdown"}}));
    EXPECT_EQ(refused.code, "command.no_answer");
    EXPECT_EQ(run.wait(30s), exit_hung) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("was told to end and cannot"));
}

// A hung cycle holds its processor at its priority, and the kernel leaves ordinary threads alone a share of it (sched(7)): so whoever tells it and ends
// the process may have no real-time priority below the cycle's.
TEST_F(HungProgram, OnOneProcessorAnEndlessLoopInABaseTaskIsToldAndEndsAsWell) {
    Child run({"taskset", "-c", "0", taktwerk, "run", dying(2)});
    EXPECT_TRUE(run.says("STUCK", 60s)) << run.text();
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(60s), exit_hung) << run.text();
}

TEST_F(HungProgram, AnEndlessSlowerTaskDoesNotOutliveTheEnd) {
    Child run({taktwerk, "run", dying(2, 4)});
    ASSERT_TRUE(run.says("not finished at its next release", 60s)) << run.text();
    EXPECT_TRUE(run.says("-> Disabled", 30s)) << "its axis stops, and its power goes: " << run.text();
    const auto state = ask({{"cmd", "state"}});
    ASSERT_TRUE(state) << "the machine lives: " << refused.text();
    EXPECT_THAT(state->dump(), HasSubstr("task_late"));
    EXPECT_TRUE(ask({{"cmd", "reset"}})) << refused.text();
    EXPECT_FALSE(ask({{"cmd", "program_start"}, {"program", "dying"}}));
    EXPECT_THAT(refused.what, HasSubstr("has not come back")) << refused.text();
    run.signal(SIGTERM);
    EXPECT_EQ(run.wait(40s), exit_hung) << run.text();
    EXPECT_THAT(run.text(), HasSubstr("task 'main' of program 'dying' does not return"));

    Child again({taktwerk, "run", dying(0, 4)});
    EXPECT_TRUE(again.says("this one begins in manual mode", 60s)) << "behind a run that hung: " << again.text();
    EXPECT_TRUE(again.says("running, manual mode", 60s)) << "the next run gets the bus: " << again.text();
    again.signal(SIGTERM);
    EXPECT_EQ(again.wait(40s), exit_ok) << again.text();
}

}  // namespace
}  // namespace taktwerk::apps
