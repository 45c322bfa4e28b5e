// The alarms of the XP200, as the other drives' in every_alarm_unit.cpp and alarm_causes_unit.cpp: it has no status word, its host asks it over
// the line. Sections are those of its manual.

#include <algorithm>

#include "tests/axes/sim/xp200/drive_rig.hpp"
#include "tests/drives/alarm_causes.hpp"

namespace taktwerk::test::xp200_alarms {
namespace {

using namespace std::chrono_literals;
using axes::sim::PlantConfig;
using axes::sim::xp200::DriveRig;

constexpr int speed_2 = 138, speed_select = 122, alarm_register = 0x1A;  // Pr138, Pr122 [4.3.3]; 9.5

PlantConfig easy() {
    PlantConfig plant;
    plant.coulomb_friction = 0.005;
    plant.viscous_friction = 1e-4;
    return plant;
}

struct Running : DriveRig {
    explicit Running(const PlantConfig& plant = {}) : DriveRig({}, plant) {}
    void stand() {
        start();
        enable();
        run(700ms);  // 4.8: the brake, Pr169 = 500 ms
    }
    void go() {
        stand();
        write(speed_2, 500);
        write(speed_select, 1);
        run(1s);
        ASSERT_NEAR(servo().speed(), 500, 5);
    }
    int alarm() { return status(alarm_register); }
    void clear() { EXPECT_EQ(ask(modbus::clear_alarm(1)).outcome, modbus::Outcome::answered); }  // 43h
};

// 6.1, and 5.4.2: with Pr136 = 0 the motor coasts at every alarm.
TEST(Xp200EveryAlarm, IsShownLetsTheMotorCoastAndClearsAsListed) {
    const auto& alarms = axes::sim::xp200::xp200_profile().alarms;
    EXPECT_EQ(alarms.size(), 22u);
    for (const auto& row : alarms) {
        SCOPED_TRACE(row.panel + " " + row.english);
        Running rig{easy()};
        rig.go();
        rig.servo().provoke(row.code);
        EXPECT_FALSE(rig.servo().energised());
        rig.run(10ms);
        EXPECT_GT(rig.servo().speed(), 400);
        EXPECT_EQ(rig.alarm(), row.code);
        EXPECT_FALSE(rig.servo().output(1)) << "DO2, ALM: on = no alarm (5.3)";

        rig.clear();
        EXPECT_EQ(rig.alarm(), row.code) << "its cause is still there";
        rig.servo().release();
        rig.run(10ms);
        EXPECT_EQ(rig.alarm(), row.code);
        rig.clear();
        EXPECT_EQ(rig.alarm(), row.resettable ? 0 : row.code);
        EXPECT_FALSE(rig.servo().energised()) << "nothing starts by itself";
        rig.servo().power_off();
        rig.run(1s);
        rig.start();
        EXPECT_EQ(rig.alarm(), 0);
    }
}

void happen(Cause cause, Running& rig) {
    auto& servo = rig.servo();
    switch (cause) {
        case Cause::faster_than_allowed:  // Pr075 = 500 r/min; the load pulls the free motor along
            rig.set(75, 500);
            rig.start();
            rig.run(3s);
            break;
        case Cause::jammed:  // position mode, Pr080 = 400: 4 turns of 10000 counts
            rig.set(4, 0);
            rig.stand();
            servo.jam(true);
            servo.pulses(41'000);
            rig.run(10ms);
            break;
        case Cause::stalled:
        case Cause::torque_above_user:  // Pr070 = 140 % for longer than Pr072
            rig.set(72, cause == Cause::stalled ? 30'000 : 1000);
            rig.stand();
            servo.jam(true);
            rig.write(speed_2, 500);
            rig.write(speed_select, 1);
            rig.run(2500ms);
            break;
        case Cause::both_limits_open:  // Pr097 = 30: both are looked at; nothing is wired
            rig.set(97, 30);
            rig.stand();
            break;
        case Cause::encoder_fails:
            rig.go();
            servo.break_encoder();
            break;
        case Cause::overloaded:  // friction of 1.3 times the rated torque, for a minute
            rig.set(70, 200);
            rig.stand();
            rig.write(speed_2, 500);
            rig.write(speed_select, 1);
            rig.run(60s);
            break;
        case Cause::off_while_saving:  // 9.6.6: 5 s
            rig.stand();
            EXPECT_EQ(rig.ask(modbus::save(1)).outcome, modbus::Outcome::answered);
            rig.run(1s);
            servo.power_off();
            rig.run(1s);
            rig.start();
            break;
        default: FAIL() << "not a cause of this drive";
    }
}

PlantConfig plant_for(Cause cause) {
    PlantConfig plant;
    if (cause == Cause::faster_than_allowed) plant.load_torque = -2;
    if (cause == Cause::overloaded) plant.coulomb_friction = 1.3 * plant.rated_torque;
    return plant;
}

TEST(Xp200FoundAlarm, ByComputing) {
    for (const auto& found : found_by_computing()) {
        if (found.drive != "xp200") continue;
        SCOPED_TRACE(found.panel);
        const auto& alarms = axes::sim::xp200::xp200_profile().alarms;
        const auto row = std::find_if(alarms.begin(), alarms.end(), [&](const auto& r) { return r.panel == found.panel; });
        ASSERT_NE(row, alarms.end());
        Running rig{plant_for(found.cause)};
        happen(found.cause, rig);
        EXPECT_EQ(rig.alarm(), row->code);
    }
}

}  // namespace
}  // namespace taktwerk::test::xp200_alarms
