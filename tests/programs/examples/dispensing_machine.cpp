// The bead lies where the drawing has it, and the pump has turned as far as the bead is long. Positions come from the motors of the simulated drives,
// through the beam's geometry, which is written here
// anew; of the program nothing is asked but its output for the valve.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/programs/examples/watched_machine.hpp"

namespace taktwerk::dispensing_example {
namespace {

using namespace std::chrono_literals;
using testing::WatchedMachine;

constexpr double pi = std::numbers::pi, degree = pi / 180;
using Point = std::array<double, 3>;

/// In the cover's frame, whose corner is at (300, 180, -140), turned by 4 degrees. The beam turns about its near end and slides on the far guide, 600 mm
//away; the nozzle's tip is 35 mm below the lift's flange.
Point tip(double near, double far, double across, double lift) {
    const double askew = std::atan2(far - near, 600);
    const double x = near - across * std::sin(-askew) - 300, y = across * std::cos(askew) - 180, c = std::cos(4 * degree),
                 s = std::sin(4 * degree);
    return {c * x + s * y, -s * x + c * y, lift - 35 + 140};
}
double off_line(const Point& p, double ax, double ay, double bx, double by) {
    const double dx = bx - ax, dy = by - ay, t = std::clamp(((p[0] - ax) * dx + (p[1] - ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
    return std::hypot(p[0] - ax - t * dx, p[1] - ay - t * dy);
}
/// From the drawing: 160 x 100 mm, its lower corners are arcs of 20 mm.
double off_drawing(const Point& p) {
    double off =
        std::min({off_line(p, 20, 0, 140, 0), off_line(p, 160, 20, 160, 100), off_line(p, 160, 100, 0, 100), off_line(p, 0, 100, 0, 20)});
    if (p[0] >= 140 && p[1] <= 20) off = std::min(off, std::abs(std::hypot(p[0] - 140, p[1] - 20) - 20));
    if (p[0] <= 20 && p[1] <= 20) off = std::min(off, std::abs(std::hypot(p[0] - 20, p[1] - 20) - 20));
    return off;
}
/// mm from the nearer one of the two sharp corners.
double from_corner(const Point& p) { return std::min(std::hypot(p[0] - 160, p[1] - 100), std::hypot(p[0], p[1] - 100)); }
/// 60 + 80 + 160 + 80 + 60 mm of lines, two quarters of a circle of 20 mm.
constexpr double drawn = 440 + 20 * pi;

struct Bead {
    double length = 0, pumped_set = 0, pumped = 0;    ///< mm of the set-points; deg of the pump
    double off = 0, off_corners = 0, off_height = 0;  ///< mm, of the motors' places
    double slowest = 1e9;                             ///< mm/s of the set-points, in the middle of the lines
    std::vector<Point> laid;
};

class Gantry {
public:
    Gantry() { EXPECT_TRUE(m.up()); }
    Point is() { return tip(m.place("near"), m.place("far"), m.place("across"), m.place("lift")); }
    Point shall() {
        return tip(m.view("near").set_position, m.view("far").set_position, m.view("across").set_position, m.view("lift").set_position);
    }
    void look(std::vector<Bead>& beads, std::vector<double>* bits = nullptr) {
        if (bits != nullptr)
            for (const char* name : {"near", "far", "across", "lift", "pump"}) bits->push_back(m.view(name).set_position);
        const auto set = shall();
        const double pump = m.view("pump").set_position;
        const bool open = m.output("valve");
        if (open && !open_) {
            beads.emplace_back();
            began_ = m.place("pump");
        }
        if (open) {
            auto& bead = beads.back();
            const auto at = is();
            bead.laid.push_back(at);
            auto& off = from_corner(at) < 20 ? bead.off_corners : bead.off;
            off = std::max(off, off_drawing(at));
            bead.off_height = std::max(bead.off_height, std::abs(at[2] - 1));
        }
        if (open || open_) {  // the way of the cycle in which it closes, too
            beads.back().length += std::hypot(set[0] - before_[0], set[1] - before_[1]);
            beads.back().pumped_set += pump - pump_before_;
            beads.back().pumped = m.place("pump") - began_;
        }
        open_ = open;
        before_ = set;
        pump_before_ = pump;
    }
    std::vector<Bead> work(Duration time, std::vector<double>* bits = nullptr) {
        std::vector<Bead> beads;
        m.until([&] { return look(beads, bits), false; }, time);
        return beads;
    }

    WatchedMachine m{"dispensing"};

private:
    bool open_ = false;
    Point before_{};
    double pump_before_ = 0, began_ = 0;
};

void expect_good(const Bead& bead) {
    // Following error: the drives are some 2 cycles of 120 mm/s behind, along the line; across it that is (0.24 mm)^2 / (2 * 20 mm) in an arc. The rest is
    // the 0.1 mm of the curves between line and arc.
    EXPECT_LE(bead.off, 0.12) << "mm beside lines and arcs";
    EXPECT_LE(bead.off_corners, 2 + 0.1) << "mm: parameter corner";
    EXPECT_GE(bead.off_corners, 0.5) << "a sharp corner is cut: else the nozzle has stood in it";
    EXPECT_LE(bead.off_height, 0.02) << "mm: of 1 mm above the cover";
    // The arc that touches both lines of a right angle and is 2 mm from each in its middle has a radius of 2 / (1 - 1 / sqrt 2) = 6.83 mm, and is 2.93 mm
    // shorter than they are.
    EXPECT_LE(bead.length, drawn + 0.1);
    EXPECT_GE(bead.length, drawn - 2 * 2.93);
    // 3 mm2 of a pump of 500 mm3 a turn.
    EXPECT_NEAR(bead.pumped_set, bead.length * 3 * 360 / 500, 0.5 * 3 * 360 / 500)
        << "deg: within half a millimetre of bead, the cycles of valve and output";
    EXPECT_NEAR(bead.pumped, bead.pumped_set, 1.5) << "deg: its following error";
    // All of it is there.
    for (const Point& place : {Point{110, 0, 1},
                               {140 + 20 * std::sin(pi / 4), 20 - 20 * std::cos(pi / 4), 1},
                               {160, 60, 1},
                               {80, 100, 1},
                               {0, 60, 1},
                               {20 - 20 * std::sin(pi / 4), 20 - 20 * std::cos(pi / 4), 1},
                               {50, 0, 1}}) {
        double nearest = 1e9;
        for (const auto& p : bead.laid) nearest = std::min(nearest, std::hypot(p[0] - place[0], p[1] - place[1]));
        EXPECT_LT(nearest, 0.3) << "mm from " << place[0] << ' ' << place[1];
    }
}

TEST(Dispensing, LaysItsBeadWhereTheDrawingHasItAndPumpsWhatItsLengthNeeds) {
    Gantry gantry;
    const auto beads = gantry.work(40s);
    EXPECT_EQ(gantry.m.alarms(), "");
    EXPECT_EQ(gantry.m.variable("spoiled"), 0);
    ASSERT_GE(beads.size(), 4u);
    for (std::size_t i = 0; i + 1 < beads.size(); ++i) expect_good(beads[i]);
}

TEST(Dispensing, GivesTheSameBitsEachTime) {
    std::vector<double> first, second;
    const auto beads = Gantry{}.work(12s, &first);
    (void)Gantry{}.work(12s, &second);
    ASSERT_EQ(first.size(), second.size());
    EXPECT_TRUE(first == second);
    EXPECT_GE(beads.size(), 1u);
}

// The pump follows the way, not the time: held and slowed down by a person, the bead is the same.
TEST(Dispensing, AnOverrideAndAHoldLayTheSameBead) {
    Gantry gantry;
    std::vector<Bead> beads;
    ASSERT_TRUE(gantry.m.until([&] { return gantry.look(beads), !beads.empty() && beads.back().laid.size() > 600; }, 20s));
    const auto order = [&](runtime::OperatorAction action, double value = 0) {
        runtime::OperatorCommand command;
        command.action = action;
        command.index = 0;
        command.value = value;
        command.client = 1;
        command.sequence = ++gantry.m.sequence;
        EXPECT_TRUE(gantry.m.machine->submit(command));
    };
    const auto on = [&](Duration time) { gantry.m.until([&] { return gantry.look(beads), false; }, time); };
    order(runtime::OperatorAction::group_override, 0.3);
    on(1s);
    order(runtime::OperatorAction::group_override, 0);
    on(1s);
    EXPECT_NEAR(gantry.m.view("pump").set_velocity, 0, 1e-9);
    order(runtime::OperatorAction::group_override, 1);
    ASSERT_TRUE(gantry.m.until([&] { return gantry.look(beads), gantry.m.variable("covers") == 1; }, 20s));
    ASSERT_EQ(beads.size(), 1u);
    expect_good(beads.front());
    EXPECT_NEAR(gantry.m.variable("pumped"), drawn * 3, 2 * 2.93 * 3) << "mm3: what the program says of it";
}

// A drive fails in the middle of an arc: the valve shuts in the next cycle, the pump stops by itself, the cover is counted as spoiled, and a person lets a
// new one begin.
TEST(Dispensing, AFaultInAnArcShutsTheValveAndSpoilsOneCover) {
    Gantry gantry;
    auto& m = gantry.m;
    std::vector<Bead> beads;
    ASSERT_TRUE(m.until([&] { return gantry.look(beads), m.output("valve") && gantry.is()[0] > 150 && gantry.is()[1] < 12; }, 20s));
    m.world.drive("far")->raise(0x2310);
    ASSERT_TRUE(m.until([&] { return gantry.look(beads), m.group().state == axes::GroupState::GroupErrorStop; }, 500ms));
    m.run(3ms);
    EXPECT_FALSE(m.output("valve"));
    m.until([&] { return gantry.look(beads), false; }, 2s);
    EXPECT_EQ(m.view("pump").set_velocity, 0);
    EXPECT_EQ(m.variable("spoiled"), 1);
    EXPECT_NE(m.alarms().find("waits for a person"), std::string::npos) << m.alarms();
    EXPECT_FALSE(m.output("valve"));

    ASSERT_TRUE(m.reset_until([&] { return m.group().state == axes::GroupState::GroupStandby; }, 10s)) << m.alarms();
    m.set_switch("works", true);
    ASSERT_TRUE(m.until([&] { return gantry.look(beads), m.variable("covers") == 1; }, 40s)) << m.alarms();
    ASSERT_EQ(beads.size(), 2u);
    expect_good(beads.back());
    EXPECT_EQ(m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::dispensing_example
