// The worked examples of the SV33-E manual V1.1, done step by step as printed: process data 6.2.9.1 and 6.2.9.2, modes 8.5.1 to 8.5.7.
// The examples use TwinCAT; here the same objects are written. Expectations are the manual's words and hand calculations.

#include <gtest/gtest.h>

#include "ecat/sim/process_data.hpp"
#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test::sv33_e_conformance {
namespace {

constexpr std::int64_t turn = 131'072;  // 17-bit encoder [1.1.2], gear 1:1 [7.3, 6091h]

axes::sim::PlantConfig motor() {
    axes::sim::PlantConfig plant;
    plant.counts_per_revolution = turn;
    plant.viscous_friction = 0;
    plant.coulomb_friction = 0;
    return plant;
}

class Sv33EExamples : public ::testing::Test {
protected:
    DriveDesk desk{"sv33-e", motor()};

    /// "Select suitable mapped objects and activate" with what 1702h offers, which has all targets and the mode.
    void activate(std::int64_t mode) {
        ASSERT_EQ(desk.sdo(0x1C12, 0, 0), 0u);
        ASSERT_EQ(desk.sdo(0x1C12, 1, 0x1702), 0u);
        ASSERT_EQ(desk.sdo(0x1C12, 0, 1), 0u);
        // "Set suitable motion parameters": the factory ramps of 100 counts/s2 are none.
        for (const unsigned ramp : {0x6083u, 0x6084u, 0x6085u}) ASSERT_EQ(desk.sdo(static_cast<std::uint16_t>(ramp), 0, 100 * turn), 0u);
        desk.go_operational();
        desk.pdo(0x6060, mode);
        desk.run(2ms);
        ASSERT_EQ(desk.read(0x6061), mode);
    }
    /// "Write 6 - 7 - 15 to the control word one after the other; the servo should be enabled now."
    void write_6_7_15() {
        desk.control(6);
        EXPECT_EQ(desk.power_state(), 0x21u);
        desk.control(7);
        EXPECT_EQ(desk.power_state(), 0x23u);
        desk.pdo(0x607A, desk.read(0x6064));  // 3.4.3(2): aligned before enabling
        desk.control(15);
        EXPECT_EQ(desk.power_state(), 0x27u);
        desk.run(300ms);  // 3.1.2, P05.13: commands count 250 ms later
    }
    /// "Write 6 to the control word, end of the test."
    void write_6() {
        desk.control(6);
        EXPECT_EQ(desk.power_state(), 0x21u);
    }
};

// 6.2.9.1, steps 1) to 6), with 1702h for 1603h: table 7-1 has five fixed RxPDOs and no 1603h, table 6-20 the other way round.
TEST_F(Sv33EExamples, AssigningAPdo) {
    ASSERT_EQ(desk.state, EsmState::preop);
    EXPECT_EQ(desk.sdo(0x1C12, 0x01, 0x1702), 0x06010003u) << "1C12h:00 has to be 0 before";
    EXPECT_EQ(desk.sdo(0x1C12, 0x00, 0), 0u);
    EXPECT_EQ(desk.sdo(0x1C12, 0x01, 0x1603), 0x06090030u);
    EXPECT_EQ(desk.sdo(0x1C12, 0x01, 0x1702), 0u);
    EXPECT_EQ(desk.sdo(0x1C12, 0x00, 1), 0u);
    EXPECT_EQ(desk.read(0x1C12, 1), 0x1702);
    ecat::sim::ProcessData image(*desk.drive.device, desk.dictionary);
    ASSERT_EQ(image.resolve(), 0);
    EXPECT_EQ(image.bytes(2), 19);  // table 3-28
    EXPECT_EQ(image.bytes(3), 24);  // 1B01h as listed; its table prints 28

    // "SafeOP: the TxPDO is active." "OP: the RxPDO is."
    desk.enter(EsmState::safeop);
    std::array<std::byte, 19> out{std::byte{0x06}};
    image.load_outputs(2, out);
    desk.run(2);
    EXPECT_EQ(desk.power_state(), 0x40u) << "what the master sends is not obeyed yet, what the drive shows is true";
    desk.enter(EsmState::op);
    desk.run(2);
    EXPECT_EQ(desk.power_state(), 0x21u);
}

// 6.2.9.2, steps 1) to 6): 1600h:08 becomes 606Eh. Table 6-22 calls entries 1 to 7 the factory's; 7.1 does not, so they are written first.
TEST_F(Sv33EExamples, MappingAnObject) {
    EXPECT_EQ(desk.sdo(0x1600, 0x08, 0x606E0010), 0x06010003u) << "1600h:00 has to be 0 before";
    EXPECT_EQ(desk.sdo(0x1600, 0x00, 0), 0u);
    const std::int64_t table_6_22[] = {0x60400010, 0x607A0020, 0x60FF0020, 0x60710010, 0x60600008, 0x5FFE0008, 0x60B80010};
    std::uint8_t sub = 0;
    for (const auto entry : table_6_22) EXPECT_EQ(desk.sdo(0x1600, ++sub, entry), 0u) << std::hex << entry;
    EXPECT_EQ(desk.sdo(0x1600, 0x08, 0x606E0010), 0u);
    EXPECT_EQ(desk.sdo(0x1600, 0x00, 8), 0u);
    EXPECT_EQ(desk.read(0x1600, 0), 8);
    EXPECT_EQ(desk.read(0x1600, 8), 0x606E0010);
    EXPECT_EQ(desk.sdo(0x1C12, 0x00, 0), 0u);
    EXPECT_EQ(desk.sdo(0x1C12, 0x01, 0x1600), 0u);
    EXPECT_EQ(desk.sdo(0x1C12, 0x00, 1), 0u);

    // 2 + 4 + 4 + 2 + 1 + 1 + 2 bytes of the table, and 2 of 606Eh behind them.
    ecat::sim::ProcessData image(*desk.drive.device, desk.dictionary);
    ASSERT_EQ(image.resolve(), 0);
    ASSERT_EQ(image.bytes(2), 18);
    desk.go_operational();
    std::array<std::byte, 18> out{};
    out[16] = std::byte{25};
    image.load_outputs(2, out);
    EXPECT_EQ(desk.read(0x606E), 25);
}

// 8.5.1: the recommended slow step is cycle (s) x greatest motor speed (r/s) / 10. P00.18: 6000 rpm = 100 r/s, so 0.01 turns each ms.
TEST_F(Sv33EExamples, Csp) {
    activate(8);
    write_6_7_15();
    desk.pdo(0x6040, 31);
    const std::int64_t start = desk.read(0x6064), step = turn / 100;
    for (std::int64_t n = 1; n <= 1000; ++n) {
        desk.pdo(0x607A, start + n * step);
        desk.run(1ms);
    }
    EXPECT_NEAR(static_cast<double>(desk.read(0x606C)), 10.0 * turn, 0.02 * turn);  // 10 turns a second
    EXPECT_NE(desk.status() & 0x1000, 0);                                           // 3.4.3(2): bit 12, follows the command
    desk.run(300ms);
    EXPECT_NEAR(static_cast<double>(desk.read(0x6064)), static_cast<double>(start + 1000 * step), 3);
    write_6();
}

// 8.5.2: 60FFh is given only after enabling, and is 0 before the end.
TEST_F(Sv33EExamples, Csv) {
    activate(9);
    write_6_7_15();
    EXPECT_EQ(desk.read(0x606C), 0);
    desk.pdo(0x60FF, 5 * turn);
    desk.run(1s);
    EXPECT_NEAR(static_cast<double>(desk.read(0x606C)), 5.0 * turn, 0.01 * turn);
    desk.pdo(0x60FF, 0);
    desk.run(1s);
    EXPECT_EQ(desk.read(0x606C), 0);
    write_6();
}

// 8.5.3: 6071h in 0.1 %. A quarter of the rated torque of 1.27 Nm on 2e-4 kg m2 for 0.1 s: 158.75 rad/s = 25.27 turns/s.
TEST_F(Sv33EExamples, Cst) {
    activate(10);
    desk.pdo(0x607F, 100 * turn);
    write_6_7_15();
    desk.pdo(0x6071, 250);
    desk.run(101ms);
    EXPECT_EQ(desk.read(0x6077), 250);
    EXPECT_NEAR(static_cast<double>(desk.read(0x606C)) / turn, 25.27, 0.3);
    desk.pdo(0x6071, 0);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x6077), 0);
    write_6();
}

// 8.5.4: "set suitable motion parameters" (6081h is 0 from the factory), 607Ah, then 31 for an absolute target or 95 for one that counts from
// the last [3.4.3(5)]. 10 turns at 5 turns/s by 100 turns/s2: 2.05 s.
TEST_F(Sv33EExamples, Pp) {
    EXPECT_EQ(desk.sdo(0x6081, 0, 5 * turn), 0u);
    activate(1);
    write_6_7_15();
    const auto start = desk.position();
    const auto positions = [&](std::int64_t target, std::uint16_t word) {
        desk.pdo(0x607A, target);
        desk.control(word, 1);
        EXPECT_NE(desk.status() & 0x1000, 0u) << "3.4.3(5): bit 12 acknowledges";
        desk.control(15, 2);
        EXPECT_EQ(desk.status() & 0x1000, 0u) << "and falls with bit 4";
        EXPECT_EQ(desk.status() & 0x0400, 0u) << "on the way";
    };
    positions(start + 10 * turn, 31);
    desk.run(1s);
    EXPECT_NEAR(static_cast<double>(desk.read(0x606C)), 5.0 * turn, 0.01 * turn);
    EXPECT_EQ(desk.status() & 0x0400, 0u);
    desk.run(1100ms);
    EXPECT_NE(desk.status() & 0x0400, 0u);                                        // bit 10: reached
    EXPECT_NEAR(static_cast<double>(desk.position() - start), 10.0 * turn, 734);  // 6067h

    positions(-4 * turn, 95);
    desk.run(1s);
    EXPECT_NE(desk.status() & 0x0400, 0u);
    EXPECT_NEAR(static_cast<double>(desk.position() - start), 6.0 * turn, 734);
    write_6();
}

// 8.5.5: 60FFh with 6083h and 6084h.
TEST_F(Sv33EExamples, Pv) {
    activate(3);
    write_6_7_15();
    desk.pdo(0x60FF, 5 * turn);
    desk.run(1s);
    EXPECT_NEAR(static_cast<double>(desk.read(0x606C)), 5.0 * turn, 0.01 * turn);
    desk.pdo(0x60FF, 0);
    desk.run(1s);
    EXPECT_EQ(desk.read(0x606C), 0);
    write_6();
}

// 8.5.6: 6071h; 6087h is 4294967295 from the factory, at once.
TEST_F(Sv33EExamples, Pt) {
    activate(4);
    desk.pdo(0x607F, 100 * turn);
    write_6_7_15();
    desk.pdo(0x6071, 100);
    desk.run(50ms);
    EXPECT_EQ(desk.read(0x6077), 100);
    EXPECT_GT(desk.read(0x606C), 0);
    desk.pdo(0x6071, 0);
    desk.run(2ms);
    write_6();
}

// 8.5.5, 8.5.6: "if the motor does not move although the target is taken, see whether acceleration and deceleration are 0" ...
TEST_F(Sv33EExamples, WithoutARampPvMovesNothing) {
    activate(3);
    EXPECT_EQ(desk.sdo(0x6083, 0, 0), 0u);
    write_6_7_15();
    desk.pdo(0x60FF, 5 * turn);
    desk.run(500ms);
    EXPECT_EQ(desk.read(0x606C), 0);
    // The speed is the least of 60FFh, 607Fh and the motor's [3.4.3(7)].
    EXPECT_EQ(desk.sdo(0x6083, 0, 100 * turn), 0u);
    desk.pdo(0x607F, 0);
    desk.run(500ms);
    EXPECT_NEAR(desk.speed(), 0, 0.001 * turn);
    desk.pdo(0x607F, turn);
    desk.run(500ms);
    EXPECT_NEAR(desk.speed(), turn, 0.01 * turn);
}

// ... "whether the torque slope is 0, whether the speed limit is 0".
TEST_F(Sv33EExamples, WithoutASlopeOrASpeedLimitPtMovesNothing) {
    activate(4);
    desk.pdo(0x607F, 100 * turn);
    EXPECT_EQ(desk.sdo(0x6087, 0, 0), 0u);
    write_6_7_15();
    desk.pdo(0x6071, 100);
    desk.run(200ms);
    EXPECT_EQ(desk.read(0x6077), 0);
    EXPECT_EQ(desk.sdo(0x6087, 0, 4'294'967'295), 0u);
    desk.pdo(0x607F, 0);
    desk.run(200ms);
    EXPECT_NEAR(desk.speed(), 0, 0.001 * turn);
    desk.pdo(0x607F, 100 * turn);
    desk.run(50ms);
    EXPECT_GT(desk.read(0x606C), 0);
}

// 8.5.7 lets homing begin with 6 - 7 - 15; 3.4.3(9) says control word bit 4 starts it, which is what the model does. Method 35: here.
TEST_F(Sv33EExamples, Homing) {
    EXPECT_EQ(desk.sdo(0x6098, 0, 35), 0u);
    activate(6);
    write_6_7_15();
    EXPECT_EQ(desk.status() & 0x1000, 0);
    desk.pdo(0x6040, 31);
    desk.run(100ms);
    EXPECT_NE(desk.status() & 0x1000, 0);  // bit 12, homing attained
    EXPECT_EQ(desk.status() & 0x2000, 0);
    EXPECT_EQ(desk.read(0x6064), 0);  // 607Ch is 0 from the factory
    write_6();
}

}  // namespace
}  // namespace taktwerk::test::sv33_e_conformance
