// What a turn of the motor is for a simulated drive, on a whole machine: an axis whose drive has another scale is not enabled, and one whose
// drive has it stored goes as far as it shows. SE-808X 6 (2000h:02: 200 to 60000, 10000 from the factory, counts after saving and switching
// off and on); SV33-E 3.1.5 (encoder counts = counts * 6091h:01 / 6091h:02).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "axes/axis/alarms.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "fb_library/all_blocks.hpp"
#include "tests/drives/one_drive_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Blocks on the axis, called in each scan; the test sets their inputs between cycles (one thread, virtual time).
class Pusher final : public Program {
public:
    static inline Pusher* here = nullptr;
    Pusher() { here = this; }
    fb::MC_Power power;
    fb::MC_Home home;
    fb::MC_MoveAbsolute move;

    void declare(Declaration& d) override {
        power.Axis = home.Axis = move.Axis = d.axis("x");
        d.task<&Pusher::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Enable = true;
        power(ctx), home(ctx), move(ctx);
    }
};

MachineConfig scaled(const std::string& slave, const std::string& gearing) {
    return one_drive_machine<Pusher>(
        slave, "    gearing: " + gearing +
                   "\n    limits: { velocity: 20 mm/s, acceleration: 100 mm/s2, jerk: 1000 mm/s3, position: [-200 mm, 400 mm] }\n"
                   "    following_error: { window: 5 mm, time: 20 ms }\n");
}

/// Turns of the motor's own shaft while the axis goes from 0 to 10 mm. Negative: it could not.
double turns_for_10_mm(TestMachine& m) {
    m.replayed.leave_out();  // the test says when it pushes
    auto& desk = *Pusher::here;
    if (!m.until([&] { return desk.power.Status; }, 5s)) return -1;
    desk.home.Execute = true;
    if (!m.until([&] { return desk.home.Done; }, 1s)) return -2;
    const auto turns = [&] {
        const auto& drive = *m.world.drive("x");
        return drive.plant().position() / drive.counts_per_revolution();
    };
    const double before = turns();
    desk.move.Position = 10, desk.move.Velocity = 10, desk.move.Execute = true;
    if (!m.until([&] { return desk.move.Done; }, 10s)) return -3;
    m.run(300ms);
    return turns() - before;
}

// 10 mm are one turn by `gearing`.
TEST(DriveScale, AStepperWithItsStepsStoredGoesAsFarAsTheAxisShows) {
    TestMachine m{scaled("      profile: se-808x\n      stored: [{ object: 2000h:02, value: 50000 }]\n",
                         "{ counts_per_revolution: 50000, feed: 10 mm }")};
    ASSERT_TRUE(m.up());
    EXPECT_NEAR(turns_for_10_mm(m), 1.0, 0.01);
}

TEST(DriveScale, AStepperAsFromTheFactoryIsRefusedByAnAxisWithAnotherGearing) {
    TestMachine m{scaled("      profile: se-808x\n", "{ counts_per_revolution: 50000, feed: 10 mm }")};
    ASSERT_TRUE(m.up());
    EXPECT_EQ(turns_for_10_mm(m), -1);
    EXPECT_THAT(m.alarms(),
                AllOf(HasSubstr("10000 counts for the drive (2000h:02)"), HasSubstr("50000 for the axis"), HasSubstr("--store")));
}

// The case of an audit, past the loader that refuses it: written in the start-up list, read back as 50000, and still 10000 in force.
TEST(DriveScale, WhatAStartUpListWroteAndNobodyStoredIsCaught) {
    auto config = scaled("      profile: se-808x\n", "{ counts_per_revolution: 50000, feed: 10 mm }");
    ecat::StartupSdo sdo;
    sdo.index = 0x2000, sdo.sub = 2, sdo.type = ecat::DataType::U16, sdo.value = 50000, sdo.verify = true;
    config.bus.slaves[0].startup.push_back(sdo);
    TestMachine m{config};
    ASSERT_TRUE(m.up()) << "it reads back";
    EXPECT_EQ(m.world.drive("x")->counts_per_revolution(), 10000) << "what the simulated drive works with";
    EXPECT_EQ(turns_for_10_mm(m), -1);
    EXPECT_THAT(m.alarms(), HasSubstr("2000h:02 (steps per revolution) was written and counts after a restart only"));
}

// The simulated motor has the encoder of its axis; 6091h counts at once (7.3), so a start-up list may write it.
TEST(DriveScale, AnElectronicGearThatTheAxisDoesNotKnowIsRefused) {
    TestMachine m{scaled("      profile: sv33-e\n      startup: [{ object: 6091h:01, value: 2 }]\n",
                         "{ counts_per_revolution: 131072, feed: 10 mm }")};
    ASSERT_TRUE(m.up());
    EXPECT_EQ(m.world.drive("x")->counts_per_revolution(), 65536);
    EXPECT_EQ(turns_for_10_mm(m), -1);
    EXPECT_THAT(m.alarms(),
                AllOf(HasSubstr("65536 counts for the drive (P01.05 x 6091h:02 / 6091h:01)"), HasSubstr("131072 for the axis")));
}

TEST(DriveScale, AnElectronicGearThatTheAxisKnowsIsObeyed) {
    TestMachine m{
        scaled("      profile: sv33-e\n      stored: [{ object: 2001h:06, value: 1048576 }]\n"
               "      startup: [{ object: 6091h:01, value: 8 }, { object: 6065h, value: 393216 }]\n",
               "{ counts_per_revolution: 131072, feed: 10 mm }")};
    ASSERT_TRUE(m.up());
    EXPECT_NEAR(turns_for_10_mm(m), 1.0, 0.01);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
