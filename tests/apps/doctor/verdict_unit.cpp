// Is the cycle realistic? Percentiles by hand, the verdict, and how it is printed.
#include <gmock/gmock.h>

#include <algorithm>

#include "apps/doctor/clock_watch.hpp"
#include "apps/doctor/examine.hpp"
#include "tests/apps/doctor/host_tree.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

Measured measured(std::initializer_list<std::pair<Duration, int>> samples) {
    Measured m;
    for (const auto& [time, count] : samples)
        for (int i = 0; i < count; ++i) m.lateness.woken.record(time);
    return m;
}

Wanted on_any_cpu() { return {1ms, 100us, -1}; }

TEST(DoctorHistogram, PercentilesByNearestRankInWholeMicroseconds) {
    const auto m = measured({{5'900ns, 989}, {40us, 10}, {300us, 1}});  // 1000 samples: ranks 500, 990, 999
    EXPECT_EQ(m.lateness.woken.percentile_us(50), 5);
    EXPECT_EQ(m.lateness.woken.percentile_us(98.9), 5);
    EXPECT_EQ(m.lateness.woken.percentile_us(99), 40);
    EXPECT_EQ(m.lateness.woken.percentile_us(99.9), 40);
    EXPECT_EQ(m.lateness.woken.max_us(), 300);
    EXPECT_EQ(m.lateness.woken.at_least(300us), 1u);
    EXPECT_EQ(m.lateness.woken.at_least(301us), 0u);
}

TEST(DoctorHistogram, WhatIsLongerThanItsBinsIsStillTheMaximum) {
    const auto m = measured({{5us, 1}, {25ms, 1}});
    EXPECT_EQ(m.lateness.woken.max_us(), 25'000);
    EXPECT_EQ(m.lateness.woken.percentile_us(100), 25'000);
    EXPECT_EQ(m.lateness.woken.at_least(1ms), 1u);
    EXPECT_EQ(MicrosecondHistogram{}.percentile_us(99.9), 0);
}

// Half the cycle is room: lateness p99.9 + computing + round trip p99.9.
TEST(DoctorVerdict, ComparesWhatIsUsedWithTheCycle) {
    const auto fitness = [](const Measured& m) { return verdict(measured_findings(m, on_any_cpu()), &m, on_any_cpu()).fitness; };
    EXPECT_EQ(fitness(measured({{400us, 1000}})), Severity::good);     // 400 + 100 = 500
    EXPECT_EQ(fitness(measured({{401us, 1000}})), Severity::warning);  // 501
    EXPECT_EQ(fitness(measured({{900us, 1000}})), Severity::warning);  // 1000
    EXPECT_EQ(fitness(measured({{901us, 1000}})), Severity::unfit);
    auto with_bus = measured({{300us, 1000}});
    with_bus.trips.emplace();
    with_bus.trips->sent = with_bus.trips->answered = 1;
    with_bus.trips->took.record(101us);
    EXPECT_EQ(fitness(with_bus), Severity::warning);  // 300 + 100 + 101
}

TEST(DoctorVerdict, TheShortestUsualCycleThatFits) {
    const auto m = measured({{20us, 1000}});  // 20 + 100 = 120: half of 250 us
    EXPECT_EQ(verdict({}, &m, on_any_cpu()).shortest_cycle, Duration{250us});
    const auto hopeless = measured({{20ms, 1000}});
    EXPECT_FALSE(verdict({}, &hopeless, on_any_cpu()).shortest_cycle.has_value());
    EXPECT_FALSE(verdict({}, nullptr, on_any_cpu()).shortest_cycle.has_value());
}

TEST(DoctorVerdict, AWakeUpThatMissesItsCycleIsTold) {
    const auto findings = measured_findings(measured({{10us, 5000}, {2ms, 1}}), on_any_cpu());
    const auto found = std::find_if(findings.begin(), findings.end(), [](const auto& f) { return f.code == "measured.missed"; });
    ASSERT_NE(found, findings.end());
    EXPECT_EQ(found->severity, Severity::warning);  // one in 5,000
    EXPECT_THAT(found->found, HasSubstr("1 of 5001"));
    for (const auto& f : measured_findings(measured({{10us, 5000}}), on_any_cpu())) EXPECT_NE(f.code, "measured.missed");
}

TEST(DoctorVerdict, FramesThatDoNotComeBack) {
    auto m = measured({{10us, 100}});
    m.trips.emplace();
    m.trips->sent = 100;
    const auto has = [&](const char* code) {
        const auto all = measured_findings(m, on_any_cpu());
        return std::any_of(all.begin(), all.end(), [&](const auto& f) { return f.code == code; });
    };
    EXPECT_TRUE(has("measured.no_answer"));
    m.trips->answered = 90;
    EXPECT_TRUE(has("measured.lost"));
    m.trips->answered = 99;  // the last one was not waited for
    EXPECT_FALSE(has("measured.lost"));
}

TEST(DoctorClocks, AStepIsMoreThanSteeringCanDoInATenthOfASecond) {
    EXPECT_FALSE(is_step(0ns, 50us));  // 500 ppm of 100 ms
    EXPECT_TRUE(is_step(0ns, 2ms));
    EXPECT_TRUE(is_step(3600s, 0s));
}

// Of this computer, whatever it is: a wake-up is never early, as many as fit, and what was asked for was reported.
TEST(DoctorMeasuring, CountsEachWakeUpOfTheGrid) {
    LatenessPlan plan;
    plan.interval = 1ms;
    plan.lasts = 50ms;
    const auto seen = measure_lateness(plan);
    EXPECT_GT(seen.woken.count(), 0u);
    EXPECT_LE(seen.woken.count(), 50u);
    EXPECT_FALSE(seen.granted.items.empty());
}

// --- in words ---

Examination of(const test::HostTree& host) {
    const test::MemoryPorts ports;
    return examine(host.root(), ports, {1ms, 100us, 3}, "");
}

TEST(DoctorReport, BeginsWithTheVerdictAndTheDearest) {
    test::HostTree host;
    test::delivered(host);
    const auto text = report_text(of(host), Colours::off, 100);
    EXPECT_TRUE(text.starts_with("NOT FIT for a cycle of 1 ms: ")) << text;
    EXPECT_LT(text.find("memory may not be locked"), text.find("is not PREEMPT_RT")) << text;
    EXPECT_THAT(text, HasSubstr("apt-get install linux-image-rt-amd64"));
    EXPECT_THAT(text, HasSubstr("sysctl vm.compact_unevictable_allowed=0"));
    EXPECT_THAT(text, Not(HasSubstr("\033")));
    std::size_t at = 0;
    while (at < text.size()) {
        const auto end = std::min(text.find('\n', at), text.size());
        EXPECT_NE(text[end - 1], ' ') << text.substr(at, end - at);
        at = end + 1;
    }
}

TEST(DoctorReport, AFitComputerTakesFewLines) {
    test::HostTree host;
    test::set_up(host);
    const auto text = report_text(of(host), Colours::off, 100);
    EXPECT_TRUE(text.starts_with("FIT for a cycle of 1 ms\n")) << text;
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 10) << text;
    EXPECT_THAT(text, Not(HasSubstr("--apply")));
}

TEST(DoctorReport, JsonHasWhatTheTextHas) {
    test::HostTree host;
    test::delivered(host);
    auto seen = of(host);
    seen.measured = measured({{7us, 3}, {12us, 1}});
    const auto json = report_json(seen);
    EXPECT_EQ(json["fit"], "unfit");
    EXPECT_EQ(json["cycle_us"], 1000);
    EXPECT_EQ(json["cpu"], 3);
    EXPECT_EQ(json["findings"].size(), seen.findings.size());
    EXPECT_EQ(json["findings"][0]["code"], "rights.memory");
    EXPECT_EQ(json["findings"][0]["severity"], "unfit");
    EXPECT_EQ(json["lateness"]["count"], 4);
    EXPECT_EQ(json["lateness"]["bins"], nlohmann::ordered_json::parse("[[7,3],[12,1]]"));
    EXPECT_EQ(json["lateness"]["p50_us"], 7);
    EXPECT_FALSE(json.contains("round_trips"));
}

}  // namespace
}  // namespace taktwerk::apps
