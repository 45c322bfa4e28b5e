// Parameters of the drives of a whole machine while it cycles, in virtual time: SDOs beside the process data, a register beside the polls.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hmi_bridge/gateway/drive_requests.hpp"
#include "hmi_bridge/runtime_link.hpp"
#include "tests/apps/simulated_five_drives.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using hmi::DriveRequestKind;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class FiveDrivesAsked : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_NO_FATAL_FAILURE(five.build());
        link.emplace(*five.machine);
        requests.emplace(*link, [this](std::string_view line) { log.emplace_back(line); });
        five.runner->after_cycle = [this](Instant now) { requests->step(now); };
        ASSERT_NO_FATAL_FAILURE(five.bring_up());
    }
    hmi::DriveAnswer ask(DriveRequestKind kind, const std::string& axis, const std::string& parameter = "", const std::string& value = "") {
        requests->handle({kind, axis, parameter, value, false, "a test", 1, "1"}, five.machine->latest(), five.clock.now());
        for (int i = 0; i < 12'000; ++i) {
            if (auto answer = requests->next_answer()) return *answer;
            five.runner->run_for(1ms);
        }
        ADD_FAILURE() << "no answer";
        return {};
    }
    std::string shown(const std::string& axis, const std::string& parameter) {
        const auto answer = ask(DriveRequestKind::read, axis, parameter);
        return answer.error ? answer.error->text() : answer.shown;
    }
    void mode(runtime::Mode wanted) {
        runtime::OperatorCommand command;
        command.action = runtime::OperatorAction::set_mode;
        command.mode = wanted;
        five.command(command);
    }

    SimulatedFiveDrives five;
    std::optional<hmi::RuntimeLink> link;
    std::optional<hmi::DriveRequests> requests;
    std::vector<std::string> log;
};

TEST_F(FiveDrivesAsked, EveryKindOfDriveAnswersByItsManualsNames) {
    EXPECT_EQ(shown("sv33", "P05.13"), "250 ms");      // SV33-E 7.2
    EXPECT_EQ(shown("da200", "P4.07"), "2");           // SV-DA200 4.4: 1 ms
    EXPECT_EQ(shown("stepper", "2000h:01"), "4.0 A");  // 40 times 0.1 A, of the machine file
    EXPECT_EQ(shown("xp200", "Pr097"), "33");          // of the machine file
    EXPECT_THAT(shown("xp200", "Pr999"), HasSubstr("no such parameter"));
}

TEST_F(FiveDrivesAsked, AWrittenValueIsInTheDriveAndInTheLog) {
    ASSERT_FALSE(ask(DriveRequestKind::write, "sv33", "P05.13", "300 ms").error);
    EXPECT_EQ(shown("sv33", "P05.13"), "300 ms");
    // XP200 manual 9.4: Pr065 is the torque limit in the direction CCW.
    const auto torque = ask(DriveRequestKind::write, "xp200", "Pr065", "150");
    EXPECT_FALSE(torque.error) << torque.error->text();
    EXPECT_THAT(shown("xp200", "Pr065"), HasSubstr("150"));
    EXPECT_THAT(log, SizeIs(2));
}

TEST_F(FiveDrivesAsked, InAutomaticModeTheyAreReadButNotWritten) {
    mode(runtime::Mode::automatic);
    EXPECT_EQ(shown("sv33", "P05.13"), "250 ms");
    const auto refused = ask(DriveRequestKind::write, "sv33", "P05.13", "300 ms");
    ASSERT_TRUE(refused.error);
    EXPECT_THAT(refused.error->code, testing::AnyOf("command.wrong_mode", "command.no_control"));
    EXPECT_EQ(shown("sv33", "P05.13"), "250 ms");
    EXPECT_THAT(log, IsEmpty());
    mode(runtime::Mode::manual);
    EXPECT_FALSE(ask(DriveRequestKind::write, "sv33", "P05.13", "300 ms").error);
}

TEST_F(FiveDrivesAsked, OnlyDrivesThatStoreOnRequestAreToldTo) {
    EXPECT_FALSE(ask(DriveRequestKind::store, "stepper").error);  // SE-808X 4.2: 1010h
    EXPECT_EQ(ask(DriveRequestKind::store, "sv33").error.value_or(Error{}).code, "drive.cannot_store");
    EXPECT_EQ(ask(DriveRequestKind::store, "j2").error.value_or(Error{}).code, "drive.cannot_store");
    EXPECT_THAT(log, SizeIs(1));
}

// Six axes of one slave: the objects of the third are 2 * 800h further (TSVM 5.2.5).
TEST_F(FiveDrivesAsked, TheThirdJointHasItsOwnParameters) {
    EXPECT_EQ(shown("j3", "605Ah"), "2");  // 5.3.1
    ASSERT_FALSE(ask(DriveRequestKind::write, "j3", "605Ah", "3").error);
    EXPECT_EQ(shown("j3", "605Ah"), "3");
    EXPECT_EQ(shown("j2", "605Ah"), "2");
}

}  // namespace
}  // namespace taktwerk::apps
