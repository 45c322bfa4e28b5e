// SV-DA200 guide 4.7: the master opens the holding brake by bit 0 of 60FEh:02, once P4.28 is 1. A hanging load, over real frames: it never sinks.

#include <gtest/gtest.h>

#include <cmath>

#include "axes/sim/cia402_axis.hpp"
#include "fb_library/all_blocks.hpp"
#include "tests/drives/one_drive_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::BrakeState;

class BrakeDesk final : public Program {
public:
    static inline BrakeDesk* here = nullptr;
    BrakeDesk() { here = this; }
    MC_Power power;
    MC_SetBrake brake;
    MC_MoveRelative move;

    void declare(Declaration& d) override {
        power.Axis = brake.Axis = move.Axis = d.axis("x");
        d.task<&BrakeDesk::scan>("main");
    }
    void scan(TaskContext& ctx) { power(ctx), brake(ctx), move(ctx); }
};

const std::string mapped_brake = "      pdo: { rx: [6040h, 607Ah, 60FFh, 6060h, 6071h, 60B8h, 60E0h, 60E1h, 607Fh, '60FEh:02'] }\n";
const std::string commissioned = "      stored: [{ object: 241Ch, value: 1 }]\n";
const std::string axis_with_brake =
    "    gearing: { counts_per_revolution: 10000, feed: 10 mm }\n"
    "    limits: { velocity: 100 mm/s, acceleration: 1000 mm/s2, jerk: 20000 mm/s3, position: [-200 mm, 400 mm] }\n"
    "    following_error: { window: 5 mm, time: 20 ms }\n"
    "    require_homed: false\n"
    "    brake: { by: object, release: 100 ms, engage: 150 ms }\n"
    "    simulation: { load_torque: 0.3 N m }\n";

struct HangingLoad : ::testing::Test {
    HangingLoad() { m.replayed.leave_out(); }  // the test works its blocks
    TestMachine m{one_drive_machine<BrakeDesk>("      profile: sv-da200\n" + commissioned + mapped_brake, axis_with_brake)};
    BrakeDesk& desk = *BrakeDesk::here;
    axes::sim::Cia402Axis& drive() { return *m.world.drive("x"); }
    double place() { return drive().plant().position(); }  // counts, 1000 a mm
};

TEST_F(HangingLoad, HangsOnItsBrakeOrOnItsMotorAndNeverSinks) {
    ASSERT_TRUE(m.up());
    const double before = place();
    EXPECT_TRUE(drive().brake_closed());
    double lowest = before, highest = before;
    m.on_cycle = [&] { lowest = std::min(lowest, place()), highest = std::max(highest, place()); };
    desk.power.Enable = true;
    ASSERT_TRUE(m.until([&] { return desk.power.Status; }, 5s)) << m.alarms();
    EXPECT_FALSE(drive().brake_closed());
    m.run(100ms);
    desk.power.Enable = false;
    ASSERT_TRUE(m.until([&] { return drive().brake_closed(); }, 2s));
    m.run(1s);
    EXPECT_EQ(m.axis(0).drive_state, axes::PowerState::disabled);
    EXPECT_LT(highest - lowest, 50) << "counts: the play of its position loop";
    EXPECT_EQ(m.alarms(), "");
}

TEST_F(HangingLoad, SetBrakeHoldsItUnderPowerAndIsRefusedWithout) {
    ASSERT_TRUE(m.up());
    desk.brake.Release = true;
    desk.brake.Execute = true;
    m.run(5ms);
    EXPECT_EQ(desk.brake.ErrorID, ErrorId::not_powered) << "it would fall";
    EXPECT_TRUE(drive().brake_closed());
    desk.brake.Execute = false;
    desk.power.Enable = true;
    ASSERT_TRUE(m.until([&] { return desk.power.Status && desk.brake.Released; }, 5s)) << m.alarms();

    desk.brake.Release = false;
    desk.brake.Execute = true;
    m.run(100ms);
    EXPECT_TRUE(desk.brake.Busy) << "150 ms";
    EXPECT_TRUE(drive().brake_closed());
    ASSERT_TRUE(m.until([&] { return desk.brake.Done; }, 100ms));
    EXPECT_FALSE(desk.brake.Released);
    desk.move.Distance = 5, desk.move.Velocity = 20;
    desk.move.Execute = true;
    m.run(5ms);
    EXPECT_EQ(desk.move.ErrorID, ErrorId::brake_closed);
    desk.move.Execute = false;

    desk.brake.Execute = false;
    m.run(2ms);
    desk.brake.Release = true;
    desk.brake.Execute = true;
    ASSERT_TRUE(m.until([&] { return desk.brake.Done; }, 200ms));
    EXPECT_FALSE(drive().brake_closed());
    desk.move.Execute = true;
    ASSERT_TRUE(m.until([&] { return desk.move.Done; }, 2s)) << m.alarms();
}

std::string refused(const std::string& slave) {
    const std::string text = "version: 1\nname: one-drive\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n    - name: drive\n" +
                             slave + "axes:\n  x:\n    slave: drive\n    unit: mm\n" + axis_with_brake;
    config::LoadOptions options;
    options.simulate = true;
    auto loaded = config::load_machine_text(std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/one-drive.yaml", text, options);
    std::string out;
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded))
        for (const auto& error : *errors) out += error.text() + "\n";
    return out;
}

// What the drive would not obey is refused with the way out, and so is a drive that works its own brake.
TEST(BrakeOfADrive, IsRefusedWhereTheDriveWouldNotObey) {
    EXPECT_EQ(refused("      profile: sv-da200\n" + commissioned + mapped_brake), "");
    EXPECT_NE(refused("      profile: sv-da200\n" + commissioned).find("60FEh:02 is not in the RxPDO"), std::string::npos);
    EXPECT_NE(refused("      profile: sv-da200\n" + mapped_brake).find("obeys 60FEh only where 241Ch is 1"), std::string::npos);
    EXPECT_NE(refused("      profile: sv33-e\n").find("sv33-e has no object that works a brake: it works its own"), std::string::npos);
    EXPECT_NE(refused("      profile: se-808x\n").find("write `by: output`"), std::string::npos);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
