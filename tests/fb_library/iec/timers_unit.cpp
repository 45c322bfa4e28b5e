// TON, TOF, TP against timing diagrams: one column is one scan is one second; # TRUE, . FALSE; PT = 4 s unless said otherwise.
// Expected columns follow from the equations of IEC 61131-3 ed. 3 (6.6.3.5.5, figure 15), by hand:
//   TON  Q = IN AND t - t_rise >= PT         TOF  Q = IN OR t - t_fall < PT         TP  Q = t - t_start < PT
#include "fb_library/iec/timers.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace taktwerk::fb {
namespace {

using namespace std::chrono_literals;

struct Diagram {
    std::string Q, ET;
    friend bool operator==(const Diagram&, const Diagram&) = default;
    friend std::ostream& operator<<(std::ostream& os, const Diagram& d) { return os << "\n  Q  " << d.Q << "\n  ET " << d.ET; }
};

CycleContext at(Duration t) { return {.now = Instant{t}, .period = 1s, .cycle = 0}; }

/// One call of the timer a column; `_` is a column without a call: the outputs stand.
template <class Timer>
Diagram run(Timer timer, const std::string& in, Duration start = 1000s) {
    Diagram seen;
    for (std::size_t column = 0; column < in.size(); ++column) {
        timer.IN = in[column] == '#';
        if (in[column] != '_') timer(at(start + column * 1s));
        seen.Q += timer.Q ? '#' : '.';
        seen.ET += static_cast<char>('0' + timer.ET / 1s);
    }
    return seen;
}

TEST(TonDiagram, FollowsTheStandard) {
    EXPECT_EQ(run(TON{.PT = 4s}, "..########....##....#######.."),
              (Diagram{"......####..............###..", "00012344440000010000012344400"}));
}

TEST(TofDiagram, FollowsTheStandardAndARisingEdgeCancelsTheDelay) {
    EXPECT_EQ(run(TOF{.PT = 4s}, "..####........####..####......."),
              (Diagram{"..########....##############...", "0000000123444400000100000123444"}));
}

TEST(TpDiagram, FollowsTheStandardAndIsNotRetriggered) {
    EXPECT_EQ(run(TP{.PT = 4s}, "..########....#.#.#......##...."),
              (Diagram{"..####........####.......####..", "0001234444000001234000000012300"}));
}

TEST(TimerDiagram, PresetOfZeroTakesEffectInTheCallOfTheEdge) {
    EXPECT_EQ(run(TON{.PT = 0s}, ".##.#."), (Diagram{".##.#.", "000000"}));
    EXPECT_EQ(run(TOF{.PT = 0s}, ".##.#."), (Diagram{".##.#.", "000000"}));
    EXPECT_EQ(run(TP{.PT = 0s}, ".##.#."), (Diagram{"......", "000000"}));
}

TEST(TimerDiagram, NegativePresetIsZero) {
    EXPECT_EQ(run(TON{.PT = -3s}, ".##.#."), (Diagram{".##.#.", "000000"}));
    EXPECT_EQ(run(TOF{.PT = -3s}, ".##.#."), (Diagram{".##.#.", "000000"}));
    EXPECT_EQ(run(TP{.PT = -3s}, ".##.#."), (Diagram{"......", "000000"}));
}

TEST(TimerDiagram, FirstCallWithInTrueIsARisingEdge) {
    EXPECT_EQ(run(TON{.PT = 4s}, "######"), (Diagram{"....##", "012344"}));
    EXPECT_EQ(run(TP{.PT = 4s}, "######"), (Diagram{"####..", "012344"}));
}

TEST(TimerDiagram, FirstCallWithInFalseIsNoFallingEdge) { EXPECT_EQ(run(TOF{.PT = 4s}, "......"), (Diagram{"......", "000000"})); }

TEST(TimerDiagram, AnEqualElapsedTimeHasElapsed) {
    TON ton{.IN = true, .PT = 4s};
    ton(at(10s));
    ton(at(14s - 1ns));
    EXPECT_FALSE(ton.Q);
    ton(at(14s));
    EXPECT_TRUE(ton.Q);

    TP tp{.IN = true, .PT = 4s};
    tp(at(10s));
    tp(at(14s - 1ns));
    EXPECT_TRUE(tp.Q);
    tp(at(14s));
    EXPECT_FALSE(tp.Q);
}

TEST(TimerDiagram, TimePassesWhileTheBlockIsNotCalledAndShowsInTheNextCall) {
    EXPECT_EQ(run(TON{.PT = 4s}, ".##_____##."), (Diagram{"........##.", "00111111440"}));
    EXPECT_EQ(run(TP{.PT = 4s}, ".##_____##."), (Diagram{".#######...", "00111111440"}));
}

TEST(TimerDiagram, ASecondCallInTheSameScanWithInFalseResets) {
    TON ton{.IN = true, .PT = 4s};
    ton(at(10s));
    ton(at(13s));
    EXPECT_EQ(ton.ET, 3s);

    ton.IN = false;
    ton(at(13s));
    ton.IN = true;
    ton(at(13s));

    EXPECT_EQ(ton.ET, 0s);
    ton(at(16s));
    EXPECT_FALSE(ton.Q) << "timing began again at 13 s";
}

TEST(TimerPreset, IsLiveWhileTiming) {
    TON ton{.IN = true, .PT = 10s};
    ton(at(0s));
    ton(at(3s));
    ton.PT = 2s;
    ton(at(4s));
    EXPECT_TRUE(ton.Q);
    EXPECT_EQ(ton.ET, 2s);

    TP tp{.IN = true, .PT = 2s};
    tp(at(0s));
    tp.PT = 5s;
    tp(at(4s));
    EXPECT_TRUE(tp.Q);
    tp(at(5s));
    EXPECT_FALSE(tp.Q);
}

TEST(TimerPreset, NoLongerCountsOnceExpired) {
    TON ton{.IN = true, .PT = 2s};
    ton(at(0s));
    ton(at(2s));
    ton.PT = 10s;
    ton(at(3s));
    EXPECT_TRUE(ton.Q);
    EXPECT_EQ(ton.ET, 2s);

    TP tp{.IN = true, .PT = 2s};
    tp(at(0s));
    tp(at(2s));
    tp.PT = 10s;
    tp(at(3s));
    EXPECT_FALSE(tp.Q);
    EXPECT_EQ(tp.ET, 2s);

    TOF tof{.IN = true, .PT = 2s};
    tof(at(0s));
    tof.IN = false;
    tof(at(1s));
    tof(at(3s));
    tof.PT = 10s;
    tof(at(4s));
    EXPECT_FALSE(tof.Q);
    EXPECT_EQ(tof.ET, 2s);
}

// 32 bit milliseconds would be negative after 24.8 days and wrap after 49.7.
TEST(TimerWidth, ElapsedTimeGrowsForYears) {
    TON ton{.IN = true, .PT = 24h * 3650};
    ton(at(0s));
    ton(at(24h * 3649));
    EXPECT_FALSE(ton.Q);
    EXPECT_EQ(ton.ET, 24h * 3649);
    ton(at(24h * 3650));
    EXPECT_TRUE(ton.Q);
}

TEST(TimerWarmStart, GoesOnWithTheElapsedTimeThoughTheClockBeganAnew) {
    TON ton{.IN = true, .PT = 4s};
    ton(at(1'000'000s));
    ton(at(1'000'003s));
    TON retained;
    std::memcpy(static_cast<void*>(&retained), &ton, sizeof ton);

    retained.warm_start(Instant{5s});
    retained(at(5s));
    EXPECT_EQ(retained.ET, 3s);
    EXPECT_FALSE(retained.Q);
    retained(at(6s));
    EXPECT_TRUE(retained.Q);
}

TEST(TimerArray, InstancesAreIndependentAndInitialisedByPinName) {
    TON timers[50];
    for (auto& t : timers) t = TON{.PT = 100ms};
    timers[7].IN = true;
    for (auto& t : timers) t(at(0s));
    for (auto& t : timers) t(at(100ms));
    for (int i = 0; i < 50; ++i) EXPECT_EQ(timers[i].Q, i == 7) << i;
}

}  // namespace
}  // namespace taktwerk::fb
