// When an alarm is announced: at once, with what is known; the further object completes it. And how long MC_Reset tries.

#include <gmock/gmock.h>

#include "tests/drives/alarms/alarm_machine.hpp"

namespace taktwerk::test {
namespace {

using axes::AxisState;
using runtime::OperatorAction;
using ::testing::ElementsAre;

const axes::DriveAlarmText& row(AlarmMachine& m, std::string_view panel) {
    const auto& rows = m.profile().alarms;
    return *std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.panel == panel; });
}

struct AlarmAnnouncement : ::testing::Test {
    AlarmMachine m{"sv33-e"};
    void SetUp() override {
        ASSERT_TRUE(m.is_up());
        m.enable(0);
        m.forget_messages();
    }
};

// SV33-E table 5-2: eight faults share 7305h, P21.08 says which it is. The axis does not wait for that.
TEST_F(AlarmAnnouncement, StopsTheAxisBeforeTheDetailIsRead) {
    m.provoke(row(m, "E.917"));
    ASSERT_TRUE(m.until([&] { return m.shown(0) != nullptr; }, 50ms));
    EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop);
    EXPECT_EQ(m.said(0), "sv33-e 'sv33_drive' reports fault 7305h, panel E.910, E.911, E.912 or 5 others");
    EXPECT_TRUE(m.until([&] { return m.said(0) == "sv33-e 'sv33_drive' reports fault 7305h/917h, panel E.917: encoder battery"; }, 300ms));
}

// Twice a second the list goes out anyway; a text that becomes complete does not wait for that.
TEST_F(AlarmAnnouncement, OverLcmItIsOneAlarmWhoseTextBecomesComplete) {
    std::vector<std::string> texts;
    std::vector<std::int64_t> since;
    m.provoke(row(m, "E.917"));
    for (int i = 0; i < 300; ++i) {
        m.run(1ms);
        const auto alarms = m.over_lcm("sv33");
        ASSERT_LE(alarms.size(), 1u);
        if (alarms.empty()) continue;
        EXPECT_EQ(alarms[0].count, 1);
        if (texts.empty() || texts.back() != alarms[0].english) {
            texts.push_back(alarms[0].english);
            since.push_back(alarms[0].since_ns);
        }
        EXPECT_EQ(alarms[0].english, m.said(0)) << "the newest words, in the same cycle";
    }
    EXPECT_THAT(texts, ElementsAre("sv33-e 'sv33_drive' reports fault 7305h, panel E.910, E.911, E.912 or 5 others",
                                   "sv33-e 'sv33_drive' reports fault 7305h/917h, panel E.917: encoder battery"));
    EXPECT_EQ(since.front(), since.back());
}

TEST_F(AlarmAnnouncement, AResetIsTriedForTwoSecondsWhileTheCauseStands) {
    m.provoke(row(m, "E.219"));
    m.run(500ms);
    EXPECT_EQ(m.command(OperatorAction::reset).answer, runtime::Answer::accepted);
    m.run(1900ms);
    EXPECT_TRUE(m.axis(0).resetting);
    m.run(200ms);
    EXPECT_FALSE(m.axis(0).resetting);
    EXPECT_EQ(m.axis(0).reset_error, axes::ErrorId::reset_failed);
    EXPECT_EQ(m.said(0), "sv33-e 'sv33_drive' reports fault 4210h, panel E.219: drive too hot");
}

}  // namespace
}  // namespace taktwerk::test
