// A drive's alarm in words, from the profile of its drive.

#include "runtime/machine/drive_alarm_words.hpp"

#include <gtest/gtest.h>

namespace taktwerk::runtime {
namespace {

AxisBinding axis() {
    auto profile = std::make_shared<axes::DriveProfile>();
    profile->name = "a-1";
    axes::DriveAlarmText firmware;
    firmware.code = 0x7500, firmware.detail = 0x12, firmware.panel = "E.012", firmware.english = "firmware", firmware.chinese = "固件";
    firmware.cause = "wrong version", firmware.remedy = "call the maker", firmware.resettable = false;
    axes::DriveAlarmText interrupt;
    interrupt.code = 0x7500, interrupt.detail = 0x13, interrupt.panel = "E.013", interrupt.english = "interrupt",
    interrupt.chinese = "中断";
    interrupt.cause = "it is lost", interrupt.remedy = "replace it", interrupt.section = "5.4";
    axes::DriveAlarmText limit;
    limit.code = 0x5443, limit.panel = "A.220", limit.english = "positive limit", limit.chinese = "正向超程", limit.warning = true;
    axes::DriveAlarmText overload;
    overload.code = 0x8311, overload.english = "overload", overload.chinese = "过载", overload.whole_drive = true;
    profile->alarms = {firmware, interrupt, limit, overload};
    AxisBinding out;
    out.axis.name = "x";
    out.slave = "x_drive";
    out.profile = profile;
    return out;
}

constexpr auto fault = axes::ShownAlarm::As::fault, warning = axes::ShownAlarm::As::warning;

AlarmText general() { return {"axis x", "drive_fault", "general", "一般", "see the manual", "remove it", "the axis stops", "reset"}; }

TEST(DriveAlarmWords, NameDrivePanelAlarmInBothLanguagesCauseRemedyAndReset) {
    auto text = general();
    tell_drive_alarm(text, axis(), {0x7500, 0x13, fault});
    EXPECT_EQ(text.source, "axis x");
    EXPECT_EQ(text.name, "drive_fault");
    EXPECT_EQ(text.english, "a-1 'x_drive' reports fault 7500h/13h, panel E.013: interrupt");
    EXPECT_EQ(text.chinese, "a-1 'x_drive' 报告故障 7500h/13h,面板 E.013:中断");
    EXPECT_EQ(text.cause, "it is lost");
    EXPECT_EQ(text.remedy, "replace it");
    EXPECT_EQ(text.manual, "a-1 5.4") << "which page to open";
    EXPECT_EQ(text.reset, "once its cause is gone: press reset or `taktwerk reset x`, in a program MC_Reset");
}

TEST(DriveAlarmWords, SayWhatNoResetClears) {
    auto text = general();
    tell_drive_alarm(text, axis(), {0x7500, 0x12, fault});
    EXPECT_EQ(text.english, "a-1 'x_drive' reports fault 7500h/12h, panel E.012: firmware");
    EXPECT_EQ(text.reset, "no reset clears it: switch the drive off and on, then press reset or `taktwerk reset x`, in a program MC_Reset");
}

// The detail is read by SDO after the fault: until then it can be either, and neither cause nor remedy is claimed.
TEST(DriveAlarmWords, NameAllThatItCanBeUntilTheDetailIsRead) {
    auto text = general();
    tell_drive_alarm(text, axis(), {0x7500, std::nullopt, fault});
    EXPECT_EQ(text.english, "a-1 'x_drive' reports fault 7500h, panel E.012 or E.013");
    EXPECT_EQ(text.manual, "") << "nobody knows yet which it is";
    EXPECT_EQ(text.chinese, "a-1 'x_drive' 报告故障 7500h,面板 E.012 或 E.013");
    EXPECT_EQ(text.cause, "see the manual");
    EXPECT_EQ(text.remedy, "remove it");
    EXPECT_EQ(text.reset,
              "once its cause is gone: press reset or `taktwerk reset x`, in a program MC_Reset; if it stays, switch the drive off and on");
}

TEST(DriveAlarmWords, OfAWarningGoWithItsCause) {
    auto text = general();
    tell_drive_alarm(text, axis(), {0x5443, std::nullopt, warning});
    EXPECT_EQ(text.english, "a-1 'x_drive' reports warning 5443h, panel A.220: positive limit");
    EXPECT_EQ(text.chinese, "a-1 'x_drive' 报告警告 5443h,面板 A.220:正向超程");
    EXPECT_EQ(text.reset, "goes with its cause");
}

TEST(DriveAlarmWords, SayThatAllAxesOfADriveAreConcernedAndKeepWhatTheRowLeavesOut) {
    auto text = general();
    tell_drive_alarm(text, axis(), {0x8311, std::nullopt, fault});
    EXPECT_EQ(text.english, "a-1 'x_drive' reports fault 8311h: overload (all axes of the drive)");
    EXPECT_EQ(text.cause, "see the manual");
    EXPECT_EQ(text.remedy, "remove it");
}

TEST(DriveAlarmWords, OfANumberThatNobodyListsStillNameDriveAndNumber) {
    auto text = general();
    tell_drive_alarm(text, axis(), {0x1234, std::nullopt, fault});
    EXPECT_EQ(text.english, "a-1 'x_drive' reports fault 1234h, not in the drive's alarm list");
    EXPECT_EQ(text.cause, "see the manual");
    EXPECT_EQ(text.reset, "to try: press reset or `taktwerk reset x`, in a program MC_Reset; the drive's list does not name this number");
}

TEST(DriveAlarmWords, StayGeneralWithoutAProfile) {
    auto text = general();
    tell_drive_alarm(text, {}, {0x7500, std::nullopt, fault});
    EXPECT_EQ(text.english, "general");
    EXPECT_EQ(text.reset, "reset");
}

}  // namespace
}  // namespace taktwerk::runtime
