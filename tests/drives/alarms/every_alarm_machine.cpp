// Every alarm of the five drives on a whole machine: the drive raises it, the axis stops or goes on, the texts are those of the manual on the
// log, over LCM and on the monitor, MC_Reset clears it or is refused as documented.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/drives/alarms/alarm_machine.hpp"

namespace taktwerk::test {
namespace {

using axes::AxisState;
using axes::DriveAlarmText;
using runtime::OperatorAction;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

struct Drive {
    const char *profile, *name;  ///< as in the machine's file
    const char* axis;            ///< its first
    friend void PrintTo(const Drive& drive, std::ostream* out) { *out << drive.profile; }
};
constexpr Drive drives[] = {{"sv33-e", "sv33_drive", "sv33"},
                            {"sv-da200", "da200_drive", "da200"},
                            {"tsvm-d6", "robot", "j1"},
                            {"se-808x", "stepper_drive", "stepper"},
                            {"xp200", "xp200_drive", "xp200"}};

/// What the manuals say of some, typed from them: files and simulated drives share the rows that everything else here goes by.
struct Printed {
    const char *profile, *panel;
    std::string_view number, chinese;
    bool clears_by_reset;
};
constexpr Printed printed[] = {
    {"sv33-e", "E.017", "5530h", "参数存储故障", false},                // table 5-2: ×
    {"sv33-e", "E.210", "2312h", "硬件过流故障", false},                // ×
    {"sv33-e", "E.911", "7305h/911h", "编码器通讯故障", false},         // ×
    {"sv33-e", "E.917", "7305h/917h", "编码器电池故障", true},          // √
    {"sv33-e", "E.423", "8611h", "位置偏差过大故障", true},             // √
    {"sv33-e", "A.921", "7305h/921h", "编码器电池电压过低警告", true},  // table 5-3
    {"sv-da200", "Er24-c", "8100h/180Ch", "PDO", true},                 // 5.2; 5.1: 4000h is main code and sub-code
    {"sv-da200", "Er03-0", "7200h/300h", "电流传感器故障", false},      // 5.3: switch off and on
    {"sv-da200", "Er13-1", "3120h", "主回路欠压故障", true},            // 5.3
    {"tsvm-d6", "3", "0049h", "主电源掉电", true},                      // table 7-1: 3, plus 70
    {"tsvm-d6", "11", "0051h", "IPM 故障", false},                      // 11 with a star, plus 70
    {"tsvm-d6", "104", "0004h", "位置超差", true},                      // table 7-2
    {"tsvm-d6", "119", "0013h", "绝对式编码器电池故障", false},         // 19 with a star
    {"se-808x", "ALM slow 2", "8611h", "位置超差错误", true},           // 5.1
    {"se-808x", "ALM quick 4", "3221h", "欠压错误", true},              // 5.1
    {"xp200", "E13", "000Dh", "过负载", true},                          // 6.1
    {"xp200", "E11", "000Bh", "IPM 模块故障", false},                   // 6.1
};

class EveryAlarm : public ::testing::TestWithParam<Drive> {
protected:
    /// The words that a person must find.
    struct Words {
        std::string english, chinese, cause, remedy, reset;
    };
    [[nodiscard]] Words words_of(const axes::DriveProfile& profile, const DriveAlarmText& row) const {
        const auto sharing = std::count_if(profile.alarms.begin(), profile.alarms.end(),
                                           [&](const auto& other) { return other.code == row.code && other.warning == row.warning; });
        const auto number = sharing > 1 ? fmt::format("{:04X}h/{:X}h", row.code, row.detail) : fmt::format("{:04X}h", row.code);
        Words out;
        out.english =
            fmt::format("{} '{}' reports {} {}, panel {}: {}{}", GetParam().profile, GetParam().name, row.warning ? "warning" : "fault",
                        number, row.panel, row.english, row.whole_drive ? " (all axes of the drive)" : "");
        out.chinese = fmt::format("{} '{}' 报告{} {},面板 {}:{}{}", GetParam().profile, GetParam().name, row.warning ? "警告" : "故障",
                                  number, row.panel, row.chinese, row.whole_drive ? "(该驱动器的所有轴)" : "");
        out.cause = row.cause;
        // Where the manual has none (SV33-E E.430) that of the axis' own alarm stays.
        out.remedy = row.remedy.empty() ? "Remove the cause named by the drive's alarm text, then reset" : row.remedy;
        const auto reset_it = fmt::format("press reset or `taktwerk reset {}`, in a program MC_Reset", GetParam().axis);
        out.reset = row.warning         ? "goes with its cause"
                    : row.clears_itself ? "the drive clears it with its cause; then the axis: " + reset_it
                    : row.resettable    ? "once its cause is gone: " + reset_it
                                        : "no reset clears it: switch the drive off and on, then " + reset_it;
        return out;
    }

    void expect_on_the_log(const std::vector<Json>& log, const Words& words, bool shared_code) const;
    void expect_over_lcm(AlarmMachine& m, const DriveAlarmText& row, const Words& words) const;
    static void expect_on_the_monitor(AlarmMachine& m, const Words& words);
    void expect_as_printed(const DriveAlarmText& row, const Words& words) const;
    void expect_states(AlarmMachine& m, const DriveAlarmText& row) const;
    static void expect_cleared(AlarmMachine& m, const DriveAlarmText& row);
    static void reset(AlarmMachine& m) { EXPECT_EQ(m.command(OperatorAction::reset).answer, runtime::Answer::accepted); }
};

// Said once, at once. Where several alarms share the code, one marked line completes it when the detail is read.
void EveryAlarm::expect_on_the_log(const std::vector<Json>& log, const Words& words, bool shared_code) const {
    std::vector<Json> of_the_drive;
    for (const auto& line : log)
        if (line.value("text", "").starts_with(fmt::format("axis {}: {} '", GetParam().axis, GetParam().profile)))
            of_the_drive.push_back(line);
    ASSERT_EQ(of_the_drive.size(), shared_code ? 2u : 1u);
    for (const auto& line : log) EXPECT_THAT(line.value("text", ""), Not(HasSubstr("sent emergency"))) << "the same once more";
    EXPECT_EQ(of_the_drive.front().at("event"), "ALARM");
    if (shared_code) {
        EXPECT_EQ(of_the_drive.back().at("event"), "detail");
    }
    const auto& complete = of_the_drive.back();
    EXPECT_THAT(complete.at("text").get<std::string>(), HasSubstr(words.english));
    EXPECT_EQ(complete.at("chinese"), words.chinese);
    EXPECT_EQ(complete.at("cause"), words.cause);
    EXPECT_EQ(complete.at("remedy"), words.remedy);
    EXPECT_EQ(complete.at("reset"), words.reset);
}

void EveryAlarm::expect_over_lcm(AlarmMachine& m, const DriveAlarmText& row, const Words& words) const {
    auto alarms = m.over_lcm(GetParam().axis);
    if (!m.axis(0).homed)
        std::erase_if(alarms, [](const auto& alarm) { return alarm.name == "reference_lost"; });  // the axis' own, besides
    ASSERT_EQ(alarms.size(), 1u) << alarms.front().english << "; " << alarms.back().english;
    EXPECT_EQ(alarms[0].english, words.english);
    EXPECT_EQ(alarms[0].chinese, words.chinese);
    EXPECT_EQ(alarms[0].cause, words.cause);
    EXPECT_EQ(alarms[0].remedy, words.remedy);
    EXPECT_EQ(alarms[0].reset, words.reset);
    EXPECT_EQ(alarms[0].count, 1);
    EXPECT_EQ(alarms[0].name, row.warning ? "drive_warning" : "drive_fault");
}

void EveryAlarm::expect_on_the_monitor(AlarmMachine& m, const Words& words) {
    const auto lines = m.monitor();
    EXPECT_THAT(lines, Contains(HasSubstr(words.english)));
    EXPECT_THAT(lines, Contains(HasSubstr(words.chinese)));
    EXPECT_THAT(lines, Contains(HasSubstr("why: " + words.cause)));
    EXPECT_THAT(lines, Contains(HasSubstr(fmt::format("-> {} ({})", words.remedy, words.reset))));
}

void EveryAlarm::expect_as_printed(const DriveAlarmText& row, const Words& words) const {
    for (const auto& known : printed) {
        if (known.profile != std::string_view(GetParam().profile) || row.panel != known.panel) continue;
        EXPECT_THAT(words.english, HasSubstr(fmt::format(" {}, panel {}:", known.number, known.panel)));
        EXPECT_THAT(words.chinese, HasSubstr(std::string(known.chinese)));
        EXPECT_EQ(row.resettable, known.clears_by_reset);
    }
}

void EveryAlarm::expect_states(AlarmMachine& m, const DriveAlarmText& row) const {
    EXPECT_EQ(m.axis(0).state, row.warning ? AxisState::Standstill : AxisState::ErrorStop);
    EXPECT_EQ(m.axis(0).powered, row.warning);
    if (m.axis_count() > 1) {
        EXPECT_EQ(m.axis(1).state, row.whole_drive ? AxisState::ErrorStop : AxisState::Standstill);
    }
}

void EveryAlarm::expect_cleared(AlarmMachine& m, const DriveAlarmText& row) {
    EXPECT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Disabled && !m.shown(0); }, 2s)) << m.alarms();
    if (row.whole_drive) {
        EXPECT_TRUE(m.until([&] { return m.axis(1).state == AxisState::Disabled && !m.shown(1); }, 2s)) << m.alarms();
    }
}

TEST_P(EveryAlarm, IsShownWithItsTextsAndResetOrRefusedAsDocumented) {
    AlarmMachine m{GetParam().profile};
    ASSERT_TRUE(m.is_up());
    std::size_t seen = 0;
    for (const auto& row : m.profile().alarms) {
        SCOPED_TRACE(row.panel + " " + row.english);
        const auto words = words_of(m.profile(), row);
        expect_as_printed(row, words);
        // Given: the axis is powered and stands; of the TSVM-D6 a second one too.
        for (std::uint16_t axis = 0; axis < std::min<std::uint16_t>(2, m.axis_count()); ++axis) m.enable(axis);
        ASSERT_EQ(m.axis(0).state, AxisState::Standstill) << m.alarms();
        ASSERT_EQ(m.shown(0), nullptr);
        const bool loses_reference = row.kind == axes::DriveAlarmKind::reference_lost || row.kind == axes::DriveAlarmKind::turn_overflow;
        if (loses_reference) m.home(0);
        const bool homed = m.axis(0).homed;
        m.forget_messages();

        const auto log = m.log_of([&] {
            m.provoke(row);
            (void)m.until([&] { return m.said(0) == words.english; }, 600ms);
            m.run(20ms);
        });

        expect_states(m, row);
        EXPECT_EQ(m.axis(0).homed, homed && !loses_reference);
        expect_on_the_log(log, words, words.english.find("h/") != std::string::npos);
        expect_over_lcm(m, row, words);
        expect_on_the_monitor(m, words);
        ++seen;

        if (row.warning) {
            m.release(row);
            m.run(50ms);
            EXPECT_EQ(m.shown(0), nullptr) << "it goes with its cause";
            EXPECT_TRUE(m.axis(0).powered);
            continue;
        }
        // MC_Reset while the cause is there; it tries for 2 s, or gives up at once where only a power cycle helps.
        reset(m);
        m.run(150ms);
        EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop);
        EXPECT_EQ(m.said(0), words.english) << "still there, and the same";
        m.release(row);
        if (!row.resettable) {
            EXPECT_EQ(m.axis(0).reset_error, axes::ErrorId::reset_failed);
            reset(m);
            m.run(150ms);
            EXPECT_EQ(m.said(0), words.english) << "a reset does not clear it";
            m.switch_off_and_on();
            EXPECT_TRUE(m.until([&] { return m.axis(0).online; }, 20s)) << m.alarms();
            m.run(100ms);
            reset(m);
        }
        expect_cleared(m, row);
        if (HasFailure()) break;  // the next would start from a machine that is not ready
    }
    EXPECT_EQ(seen, m.profile().alarms.size());
}

INSTANTIATE_TEST_SUITE_P(Drives, EveryAlarm, ::testing::ValuesIn(drives), [](const auto& drive) { return std::string(drive.param.axis); });

}  // namespace
}  // namespace taktwerk::test
