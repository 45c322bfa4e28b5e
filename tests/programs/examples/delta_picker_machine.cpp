// The delta picks each part where the belt has it and lays it where the tray has a place for it. Positions come from the motors of the simulated drives,
// through formulas of the arm
// that are written here anew; of the program nothing is asked but its output for the vacuum.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/programs/examples/watched_machine.hpp"

namespace taktwerk::delta_picker_example {
namespace {

using namespace std::chrono_literals;
using testing::WatchedMachine;

constexpr double degree = std::numbers::pi / 180;
using Point = std::array<double, 3>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
double apart(const Point& a, const Point& b) { return std::sqrt(dot(minus(a, b), minus(a, b))); }

/// Three spheres of 800 mm about the elbows (base 200, platform 45, upper arm 235 mm), the lower of the two points that they share; the sucker's lip is 40
//mm below.
Point lip(const std::array<double, 3>& degrees) {
    std::array<Point, 3> elbow;
    for (std::size_t i = 0; i < 3; ++i) {
        const double out = 200 - 45 + 235 * std::cos(degrees[i] * degree), to = 120 * degree * static_cast<double>(i);
        elbow[i] = {out * std::cos(to), out * std::sin(to), -235 * std::sin(degrees[i] * degree)};
    }
    auto x = minus(elbow[1], elbow[0]);
    const double d = std::sqrt(dot(x, x));
    for (auto& one : x) one /= d;
    const auto third = minus(elbow[2], elbow[0]);
    const double along = dot(x, third);
    auto y = minus(third, {along * x[0], along * x[1], along * x[2]});
    const double e = std::sqrt(dot(y, y));
    for (auto& one : y) one /= e;
    const auto z = cross(x, y);  // up: the arms are counter-clockwise
    const double px = d / 2, py = (along * along + e * e) / (2 * e) - along / e * px, pz = std::sqrt(800.0 * 800 - px * px - py * py);
    Point p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = elbow[0][i] + px * x[i] + py * y[i] - pz * z[i];
    p[2] -= 40;
    return p;
}
/// Of part `k`, its top's middle: the belt's light barrier at X -560 sees parts of 30 mm, each 141.3 mm behind the one before, the first when the belt is at 40.
Point part(int k, double belt) { return {-560 + belt - 40 - 141.3 * k - 15, -120, -880}; }
/// Of the tray's slot `n`: its corner is at (-75, 110), turned by 3 degrees; 4 columns, 50 mm apart. A part of 20 mm falls the last half millimetre.
Point slot(int n) {
    const double x = 50 * (n % 4), y = 50 * (n / 4 % 3), c = std::cos(3 * degree), s = std::sin(3 * degree);
    return {-75 + c * x - s * y, 110 + s * x + c * y, -900 + 20.5};
}

struct Day {
    std::vector<int> parts;      ///< gripped, in their order
    std::vector<double> beside;  ///< mm: how far the lip was from its part at the worst while it sucked
    std::vector<double> off_slot;
    double most_waiting = 0, missed = 0, trays = 0, broken = 0;
    std::vector<double> bits;  ///< set positions of all axes, each cycle
    std::string alarms;
};

class Picker {
public:
    Picker() { EXPECT_TRUE(m.up()); }
    Point at() { return lip({m.place("arm1"), m.place("arm2"), m.place("arm3")}); }
    /// The part that is nearest.
    int nearest() {
        const double belt = m.place("belt");
        return static_cast<int>(std::lround((belt - 40 - 15 - 560 - at()[0]) / 141.3));
    }
    void look(Day& day) {
        for (const char* name : {"arm1", "arm2", "arm3", "belt"}) day.bits.push_back(m.view(name).set_position);
        day.most_waiting = std::max(day.most_waiting, m.variable("waiting"));
        const bool sucks = m.output("vacuum");
        if (sucks && !sucked_) {
            day.parts.push_back(nearest());
            day.beside.push_back(0);
            rests_ = 80;
        }
        if (rests_ > 0 && --rests_ >= 0)
            day.beside.back() = std::max(day.beside.back(), apart(at(), part(day.parts.back(), m.place("belt"))));
        if (!sucks && sucked_) day.off_slot.push_back(apart(at(), slot(static_cast<int>(day.off_slot.size()))));
        sucked_ = sucks;
    }
    Day work(Duration time) {
        Day day;
        m.until([&] { return look(day), false; }, time);
        day.missed = m.variable("missed");
        day.trays = m.variable("trays");
        day.broken = m.variable("broken");
        day.alarms = m.alarms();
        return day;
    }

    WatchedMachine m{"delta-picker"};

private:
    bool sucked_ = false;
    int rests_ = 0;
};

TEST(DeltaPicker, TakesEachPartWhereTheBeltHasItAndLaysItIntoTheTray) {
    Picker picker;
    const auto day = picker.work(40s);
    EXPECT_EQ(day.alarms, "");
    EXPECT_EQ(day.missed, 0);
    EXPECT_EQ(day.broken, 0);
    EXPECT_GE(day.trays, 1);
    EXPECT_GE(day.most_waiting, 3) << "several parts on the belt at once";
    // 40 s at 90 mm/s are 25 parts of 141.3 mm, less the way from the barrier to the reach (340 mm) and what the first seconds and the last round cost.
    ASSERT_GE(day.parts.size(), 20u);
    for (std::size_t i = 0; i < day.parts.size(); ++i) {
        EXPECT_EQ(day.parts[i], static_cast<int>(i)) << "no part is left out, none is taken twice";
        EXPECT_LE(day.beside[i], 0.18) << "mm, part " << i
                                       << ": two cycles of the belt's 0.09 mm, by which arm and belt may be apart in time";
    }
    for (std::size_t i = 0; i < day.off_slot.size(); ++i)
        EXPECT_LE(day.off_slot[i], 0.1) << "mm, slot " << i << ": the arm has nearly come to rest";
}

TEST(DeltaPicker, GivesTheSameBitsEachTime) {
    const auto first = Picker{}.work(8s), second = Picker{}.work(8s);
    ASSERT_EQ(first.bits.size(), second.bits.size());
    EXPECT_TRUE(first.bits == second.bits);
    EXPECT_GE(first.parts.size(), 2u);
}

// The arm's drive fails with a part on the gripper: nothing falls, a person resets and says that it may go on, and the part is laid where it was meant to go.
TEST(DeltaPicker, AFaultWithAPartInTheAirEndsInItsSlot) {
    Picker picker;
    auto& m = picker.m;
    Day day;
    ASSERT_TRUE(m.until([&] { return picker.look(day), day.parts.size() == 4 && picker.at()[1] > -60; }, 20s)) << "on its way to the tray";
    m.world.drive("arm2")->raise(0x2310);
    m.until([&] { return picker.look(day), false; }, 2s);
    EXPECT_EQ(m.group().state, axes::GroupState::GroupErrorStop);
    EXPECT_TRUE(m.output("vacuum"));
    EXPECT_EQ(m.view("belt").set_velocity, 0) << "no part goes by meanwhile";
    EXPECT_NE(m.alarms().find("waits for a person"), std::string::npos) << m.alarms();
    EXPECT_TRUE(m.output("vacuum"));

    ASSERT_TRUE(m.reset_until([&] { return m.group().state == axes::GroupState::GroupStandby; }, 10s)) << m.alarms();
    m.until([&] { return picker.look(day), false; }, 1s);
    EXPECT_EQ(day.off_slot.size(), 3u) << "nothing begins by itself";
    m.set_switch("picks", true);
    m.until([&] { return picker.look(day), day.parts.size() >= 12; }, 30s);
    EXPECT_EQ(m.alarms(), "");
    ASSERT_GE(day.off_slot.size(), 10u);
    for (std::size_t i = 0; i < day.off_slot.size(); ++i) EXPECT_LE(day.off_slot[i], 0.1) << "mm, slot " << i;
    for (std::size_t i = 0; i < day.parts.size(); ++i) EXPECT_EQ(day.parts[i], static_cast<int>(i));
}

// A pick that grips nothing is seen by the vacuum switch; the slot stays for the next part.
TEST(DeltaPicker, APickThatGripsNothingLeavesNoHoleInTheTray) {
    Picker picker;
    auto& m = picker.m;
    Day day;
    ASSERT_TRUE(m.until([&] { return picker.look(day), day.parts.size() == 2; }, 20s));
    m.world.set_input("part_gripped", false);
    ASSERT_TRUE(m.until([&] { return m.variable("empty") == 1; }, 3s));
    m.world.set_input("part_gripped", true);
    EXPECT_FALSE(m.output("vacuum"));
    ASSERT_TRUE(m.until([&] { return m.variable("placed") == 3; }, 20s));
    EXPECT_EQ(m.variable("picked"), 3);
    EXPECT_EQ(m.alarms(), "");
    EXPECT_LE(apart(picker.at(), slot(2)), 0.6) << "mm; it has just begun to leave";
}

}  // namespace
}  // namespace taktwerk::delta_picker_example
