// Orders for power at drawn moments while answers get lost or damaged, or the line is cut for a moment. What holds stands in power_rig.hpp.

#include <random>

#include "tests/axes/drives/xp200/power_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::xp200 {
namespace {

/// A question and its repetition, each without an answer for 50 ms (modbus/client): that much later everything is.
constexpr auto one_lost_answer = 70ms;
constexpr auto silence = 300ms;  // DriveConfig

struct Draw {
    std::mt19937 random;
    [[nodiscard]] int below(int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); }
    [[nodiscard]] Duration milliseconds(int from, int to) { return std::chrono::milliseconds{from + below(to - from)}; }
};

/// One trouble of the line, shorter than what counts as silence.
std::string trouble(Draw& draw, modbus::VirtualLine& line) {
    const auto count = static_cast<std::uint32_t>(1 + draw.below(draw.below(3) == 0 ? 4 : 2));
    switch (draw.below(3)) {
        case 0: line.lose_answers(count); return fmt::format("{} lost", count);
        case 1: line.damage_answers(count); return fmt::format("{} damaged", count);
        default: line.shorten_answers(count); return fmt::format("{} shortened", count);
    }
}

/// As the cycles of flicker(), with something of the line at a drawn moment.
std::string flicker_with_trouble(Draw& draw, PowerRig& rig) {
    auto& line = rig.rig().line;
    std::string story;
    const int orders = 3 + 2 * draw.below(3);
    const int struck = draw.below(orders);
    for (int i = 0; i < orders; ++i) {
        rig.power(i % 2 == 0);
        const auto pause = i + 1 < orders ? draw.milliseconds(1, draw.below(4) == 0 ? 900 : 130) : draw.milliseconds(0, 200);
        const auto before = i == struck ? std::chrono::milliseconds{draw.below(static_cast<int>(pause / 1ms) + 1)} : Duration{};
        rig.run(before);
        if (i == struck) {
            if (draw.below(4) == 0) {
                const auto cut = draw.milliseconds(5, 150);
                line.cut(true);
                rig.run(cut);
                line.cut(false);
                story += fmt::format("[cut {} ms] ", cut / 1ms);
            } else story += fmt::format("[{}] ", trouble(draw, line));
        }
        rig.run(pause - before);
        story += fmt::format("{} {} ms ", i % 2 == 0 ? "on" : "off", pause / 1ms);
    }
    return story;
}

TEST(Xp200PowerProperty, OrdersAmongLostAnswersAreNoLossOfPower) {
    std::size_t silent = 0;
    for (std::uint32_t seed = 1; seed <= property_cases(300); ++seed) {
        Draw draw{std::mt19937{seed}};
        PowerRig rig;
        rig.run(draw.milliseconds(0, 60));
        rig.silence_is_allowed();
        const auto story = flicker_with_trouble(draw, rig);
        rig.run(silence);
        if (rig.came_back_from_silence()) ++silent;
        rig.must_come_and_stay_and_go(1400ms + 4 * one_lost_answer + silence);
        ASSERT_EQ(rig.problem(), "") << "seed " << seed << ": " << story;
    }
    EXPECT_LT(silent, property_cases(300) / 3) << "most of them are shorter than that";
}

// The positive control: the power stage opens at a drawn moment after that, and the next answer may be lost too.
TEST(Xp200PowerProperty, ALossAmongThemIsTold) {
    for (std::uint32_t seed = 1; seed <= property_cases(300); ++seed) {
        Draw draw{std::mt19937{seed}};
        PowerRig rig;
        rig.run(draw.milliseconds(0, 60));
        rig.silence_is_allowed();
        const auto story = flicker_with_trouble(draw, rig);
        rig.run(silence);
        (void)rig.came_back_from_silence();
        ASSERT_TRUE(rig.until([&] { return rig.has_its_power(); }, 2s)) << "seed " << seed << ": " << story;
        rig.run(draw.milliseconds(0, 900));
        ASSERT_EQ(rig.problem(), "") << "seed " << seed << ": " << story;
        const auto bound = loss_told_at_rest + one_lost_answer;
        rig.allow(bound);
        rig.error_is_allowed();
        rig.open_power_stage(true);
        if (draw.below(2) == 0) rig.rig().line.lose_answers(1);
        ASSERT_TRUE(rig.until([&] { return !rig.rig().drive.servo().energised(); }, 10ms));
        ASSERT_TRUE(rig.until([&] { return rig.rig().axis.view().state == AxisState::ErrorStop; }, bound))
            << "seed " << seed << ": " << story;
        EXPECT_EQ(rig.rig().axis.view().error, id(AxisAlarm::drive_power_lost)) << "seed " << seed << ": " << story;
        EXPECT_EQ(rig.problem(), "") << "seed " << seed << ": " << story;
    }
}

}  // namespace
}  // namespace taktwerk::axes::xp200
