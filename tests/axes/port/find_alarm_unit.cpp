// Which alarm of a drive's table a code means. The rows are those of SV33-E 5.4 and 5.5 that share codes, and one as of SE-808X, which has no
// further object.

#include "axes/port/find_alarm.hpp"

#include <gtest/gtest.h>

#include "axes/port/alarm_words.hpp"

namespace taktwerk::axes {
namespace {

using As = ShownAlarm::As;

DriveAlarmText row(std::uint16_t code, std::uint32_t detail, const char* panel) {
    DriveAlarmText text;
    text.code = code;
    text.detail = detail;
    text.panel = text.english = text.chinese = panel;
    return text;
}
DriveAlarmText lasting(DriveAlarmText text) { return text.resettable = false, text; }
DriveAlarmText warning(DriveAlarmText text) { return text.warning = true, text; }
DriveAlarmText of(DriveAlarmKind kind, DriveAlarmText text) { return text.kind = kind, text; }

DriveProfile profile() {
    DriveProfile out;
    out.alarms = {
        lasting(of(DriveAlarmKind::encoder, row(0x7305, 0x0911, "E.911"))),
        of(DriveAlarmKind::reference_lost, row(0x7305, 0x0917, "E.917")),
        of(DriveAlarmKind::reference_lost, row(0x7305, 0x0918, "E.918")),
        warning(of(DriveAlarmKind::battery_low, row(0x7305, 0x0921, "A.921"))),
        of(DriveAlarmKind::phase_lost, row(0x3130, 0x0217, "E.217")),
        warning(row(0x3130, 0x0222, "A.222")),
        row(0x8611, 0, "slow 2"),
        lasting(row(0x5530, 0x0017, "E.017")),
    };
    return out;
}

TEST(FindAlarm, ByCodeAndDetail) {
    const auto p = profile();
    const auto found = find_alarm(p, {0x7305, 0x0917u, As::fault});
    ASSERT_NE(found.row, nullptr);
    EXPECT_EQ(found.row->panel, "E.917");
    EXPECT_EQ(found.candidates, 1u);
    EXPECT_TRUE(found.resettable);
    EXPECT_EQ(found.kind, DriveAlarmKind::reference_lost);
    EXPECT_FALSE(find_alarm(p, {0x7305, 0x0911u, As::fault}).resettable);
}

// Nothing is claimed that only one of them is; a reset is tried as long as one of them takes it.
TEST(FindAlarm, WithoutTheDetailItCanBeAnyOfItsCode) {
    const auto p = profile();
    const auto found = find_alarm(p, {0x7305, std::nullopt, As::fault});
    EXPECT_EQ(found.row, nullptr);
    EXPECT_EQ(found.candidates, 3u) << "A.921 is a warning";
    EXPECT_TRUE(found.resettable);
    EXPECT_EQ(found.kind, DriveAlarmKind::other);
}

// SV33-E 5.4, 5.5: 3130h is E.217 or A.222; the status word says whether it is a fault.
TEST(FindAlarm, AFaultIsNoWarningOfTheSameCode) {
    const auto p = profile();
    EXPECT_EQ(find_alarm(p, {0x3130, std::nullopt, As::fault}).row->panel, "E.217");
    EXPECT_EQ(find_alarm(p, {0x3130, std::nullopt, As::warning}).row->panel, "A.222");
    EXPECT_EQ(find_alarm(p, {0x3130, std::nullopt, As::unknown}).candidates, 2u);
    EXPECT_EQ(find_alarm(p, {0x8611, std::nullopt, As::warning}).row->panel, "slow 2") << "one that is listed otherwise only";
}

TEST(FindAlarm, ADetailThatIsNotListedIsNoOtherAlarm) {
    const auto p = profile();
    const auto found = find_alarm(p, {0x7305, 0x0999u, As::fault});
    EXPECT_EQ(found.row, nullptr);
    EXPECT_EQ(found.candidates, 0u);
    EXPECT_TRUE(found.resettable);
}

TEST(FindAlarm, ACodeOfItsOwnNeedsNoDetail) {
    const auto p = profile();
    EXPECT_EQ(find_alarm(p, {0x5530, std::nullopt, As::fault}).row->panel, "E.017");
    EXPECT_EQ(find_alarm(p, {0x5530, 0x99u, As::fault}).row->panel, "E.017");
    EXPECT_EQ(find_alarm(p, {0x8611, 0u, As::fault}).row->panel, "slow 2");
    EXPECT_EQ(find_alarm(p, {0x1234, std::nullopt, As::fault}).candidates, 0u);
}

TEST(AlarmWords, NameOneAlarmOrAllThatItCanBe) {
    const auto p = profile();
    EXPECT_EQ(words(p, {0x7305, 0x0911u, As::fault}, "taktwerk reset x").english, "7305h/911h, panel E.911: E.911");
    EXPECT_EQ(words(p, {0x7305, std::nullopt, As::fault}, "taktwerk reset x").english, "7305h, panel E.911, E.917 or E.918");
    EXPECT_EQ(words(p, {0x7305, 0x0999u, As::fault}, "taktwerk reset x").english, "7305h/999h, not in the drive's alarm list");
}

TEST(AlarmWords, ACodeThatSaysAllIsNotNamedTwice) {
    const auto p = profile();
    for (const auto& detail : {std::optional<std::uint32_t>{}, std::optional<std::uint32_t>{0x0017}})
        EXPECT_EQ(words(p, {0x5530, detail, As::fault}, "taktwerk reset x").english, "5530h, panel E.017: E.017");
    EXPECT_EQ(words(p, {0x5530, 0x99u, As::fault}, "taktwerk reset x").english, "5530h/99h, panel E.017: E.017")
        << "not the one of the list";
}

TEST(AlarmWords, AMultitudeIsCounted) {
    DriveProfile p;
    for (std::uint32_t detail = 1; detail <= 7; ++detail) p.alarms.push_back(row(0x6320, detail, "P"));
    EXPECT_EQ(words(p, {0x6320, std::nullopt, As::fault}, "taktwerk reset x").english, "6320h, panel P, P, P or 4 others");
}

TEST(AlarmWords, SayWhatClearsIt) {
    const auto p = profile();
    EXPECT_EQ(words(p, {0x7305, 0x0911u, As::fault}, "taktwerk reset x").reset,
              "no reset clears it: switch the drive off and on, then press reset or `taktwerk reset x`, in a program MC_Reset");
    EXPECT_EQ(words(p, {0x7305, 0x0917u, As::fault}, "taktwerk reset x").reset,
              "once its cause is gone: press reset or `taktwerk reset x`, in a program MC_Reset");
    EXPECT_EQ(words(p, {0x7305, std::nullopt, As::fault}, "taktwerk reset x").reset,
              "once its cause is gone: press reset or `taktwerk reset x`, in a program MC_Reset; if it stays, switch the drive off and on");
    EXPECT_EQ(words(p, {0x7305, 0x0921u, As::warning}, "taktwerk reset x").reset, "goes with its cause");
    auto itself = row(0x5442, 0x0218, "E.218");  // SV33-E 5.4: by itself, once the emergency stop is released
    itself.clears_itself = true;
    EXPECT_EQ(cleared_by(itself, "taktwerk reset x"),
              "the drive clears it with its cause; then the axis: press reset or `taktwerk reset x`, in a program MC_Reset");
}

}  // namespace
}  // namespace taktwerk::axes
