// What the simulated XP200 answers, and when it stays silent. Facts from the manual's chapter 9.

#include "tests/axes/sim/xp200/drive_rig.hpp"

namespace taktwerk::axes::sim::xp200 {
namespace {

using modbus::ExceptionCode;
using modbus::Outcome;

TEST(Xp200Station, FactoryValuesAreThoseOfTheManual) {
    DriveRig rig;
    rig.start();
    EXPECT_EQ(rig.read(5), 50);      // 5.1.1
    EXPECT_EQ(rig.read(66), -300);   // 5.1.1: FED4h
    EXPECT_EQ(rig.read(97), 33);     // 5.1.1
    EXPECT_EQ(rig.read(83), -230);   // 5.1.1
    EXPECT_EQ(rig.read(105), 21);    // 5.1.2
    EXPECT_EQ(rig.read(207), 2500);  // 5.1.3
}

// 9.5: the same words by 04h and, 1000h higher, by 03h.
TEST(Xp200Station, StatusIsReadByTwoFunctions) {
    DriveRig rig;
    rig.start();
    const auto direct = rig.ask(modbus::read_status(1, 0x12, 2)), shifted = rig.ask(modbus::read_parameters(1, 0x1012, 2));
    ASSERT_EQ(direct.outcome, Outcome::answered);
    ASSERT_EQ(shifted.outcome, Outcome::answered);
    EXPECT_EQ(direct.response.words, shifted.response.words);
}

// 9.4: addresses 0 to 249; 9.5: status 0 to 27h; 9.6: eight words read, ten written.
TEST(Xp200Station, WhatItRefuses) {
    DriveRig rig;
    rig.start();
    EXPECT_EQ(rig.refused(modbus::read_parameters(1, 249, 1)), ExceptionCode::none);
    EXPECT_EQ(rig.refused(modbus::read_parameters(1, 249, 2)), ExceptionCode::illegal_address);
    EXPECT_EQ(rig.refused(modbus::read_status(1, 0x27, 1)), ExceptionCode::none);
    EXPECT_EQ(rig.refused(modbus::read_status(1, 0x28, 1)), ExceptionCode::illegal_address);
    EXPECT_EQ(rig.refused(modbus::read_parameters(1, 0x1028, 1)), ExceptionCode::illegal_address);
    EXPECT_EQ(rig.refused(modbus::write_parameter(1, 13, 1)), ExceptionCode::illegal_address);    // reserved (9.4)
    EXPECT_EQ(rig.refused(modbus::write_parameter(1, 1, 0x102)), ExceptionCode::device_failure);  // Pr001 cannot be changed (5.4.1)
    EXPECT_EQ(rig.refused(modbus::write_parameter(1, 138, 5001)), ExceptionCode::illegal_value);  // -5000 to 5000 (5.1.2)
    EXPECT_EQ(rig.refused(modbus::write_parameter(1, 138, static_cast<std::uint16_t>(-5000))), ExceptionCode::none);
    EXPECT_EQ(rig.refused(modbus::servo(1, 0x56)), ExceptionCode::illegal_value);  // 55h or AAh (9.6.7)
    // What the client would not send.
    modbus::Frame answer;
    ASSERT_TRUE(rig.drive.hear(modbus::encode(modbus::read_status(1, 0, 9)).span(), rig.now, answer));
    EXPECT_EQ(answer.size, 5u);
    EXPECT_EQ(answer.bytes[2], std::byte{3});
    const std::array<std::uint16_t, 11> zeros{};
    ASSERT_TRUE(rig.drive.hear(modbus::encode(modbus::write_parameters(1, 137, std::span{zeros}.first(8))).span(), rig.now, answer));
    EXPECT_EQ(answer.size, 8u);
    ASSERT_TRUE(rig.drive.hear(modbus::encode(modbus::write_parameters(1, 137, zeros)).span(), rig.now, answer));
    EXPECT_EQ(answer.bytes[1], std::byte{0x90});
}

// 9.3: a frame with a wrong CRC is nobody's; the manual's own example has one.
TEST(Xp200Station, SilenceForWrongCrcAndOtherStations) {
    DriveRig rig;
    rig.start();
    modbus::Frame answer;
    const std::array<std::byte, 8> printed{std::byte{1}, std::byte{3}, std::byte{0},    std::byte{5},
                                           std::byte{0}, std::byte{2}, std::byte{0x94}, std::byte{0x37}};
    EXPECT_FALSE(rig.drive.hear(printed, rig.now, answer));
    EXPECT_FALSE(rig.drive.hear(modbus::encode(modbus::clear_alarm(2)).span(), rig.now, answer));
    EXPECT_FALSE(rig.drive.hear(modbus::encode(modbus::clear_alarm(0)).span(), rig.now, answer));
    EXPECT_TRUE(rig.drive.hear(modbus::encode(modbus::clear_alarm(1)).span(), rig.now, answer));
}

// 9.6.5: two bytes come back.
TEST(Xp200Station, EchoTest) {
    DriveRig rig;
    rig.start();
    EXPECT_EQ(rig.ask(modbus::diagnose(1, 0xABCD)).outcome, Outcome::answered);
}

// 9.2: -1 closes the port. 9.3: station, baud rate and format count after a save and a restart.
TEST(Xp200Station, PortSettingsCountAfterSaveAndRestart) {
    DriveRig rig;
    rig.start();
    rig.write(181, 5);
    rig.write(182, 3);
    EXPECT_EQ(rig.ask(modbus::diagnose(1, 1)).outcome, Outcome::answered) << "still the old station and speed";
    EXPECT_EQ(rig.ask(modbus::save(1)).outcome, Outcome::answered);
    rig.run(6s);
    rig.servo().power_off();
    rig.start();
    EXPECT_EQ(rig.ask(modbus::diagnose(5, 1)).outcome, Outcome::silent) << "38400 baud now";
    EXPECT_EQ(rig.drive.line(), (modbus::LineSettings{38400, modbus::Parity::even, 1}));

    DriveRig closed;
    closed.set(181, -1);
    closed.start();
    EXPECT_EQ(closed.ask(modbus::diagnose(1, 1)).outcome, Outcome::silent);
}

// 3.5, 9.6.6: a write is lost at power-off unless it was saved.
TEST(Xp200Station, OnlyWhatIsSavedOutlastsPowerOff) {
    DriveRig rig;
    rig.start();
    rig.write(60, 250);
    EXPECT_EQ(rig.ask(modbus::save(1)).outcome, Outcome::answered);
    rig.run(5100ms);
    rig.write(61, 300);
    rig.servo().power_off();
    rig.start();
    EXPECT_EQ(rig.read(60), 250);
    EXPECT_EQ(rig.read(61), 100);
}

// 9.6.6: 5 s; 6.1 E20: power lost while saving, and nothing clears that.
TEST(Xp200Station, PowerLostWhileSavingIsAlarm20) {
    DriveRig rig;
    rig.start();
    EXPECT_EQ(rig.ask(modbus::save(1)).outcome, Outcome::answered);
    modbus::Frame answer;
    EXPECT_FALSE(rig.drive.hear(modbus::encode(modbus::diagnose(1, 1)).span(), rig.now, answer));
    rig.run(4s);
    rig.servo().power_off();
    rig.start();
    EXPECT_EQ(rig.status(0x1A), 20);
    EXPECT_EQ(rig.ask(modbus::clear_alarm(1)).outcome, Outcome::answered);
    EXPECT_EQ(rig.status(0x1A), 20);
}

TEST(Xp200Station, MaySayBusyWhileSaving) {
    DriveRig rig{{.while_saving = WhileSaving::says_busy}};
    rig.start();
    EXPECT_EQ(rig.ask(modbus::save(1)).outcome, Outcome::answered);
    modbus::Frame answer;
    ASSERT_TRUE(rig.drive.hear(modbus::encode(modbus::diagnose(1, 1)).span(), rig.now, answer));
    EXPECT_EQ(answer.bytes[2], std::byte{6});
}

// 5.4.1: Pr002 and Pr099 change only with Pr000 = 316 or 385.
TEST(Xp200Station, MotorCodeNeedsThePassword) {
    DriveRig rig;
    rig.start();
    rig.write(99, 3);
    EXPECT_EQ(rig.read(99), 0);
    rig.write(0, 316);
    rig.write(99, 3);
    EXPECT_EQ(rig.read(99), 3);
}

// 4.7.1: ready about 1.5 s after mains.
TEST(Xp200Station, StartsInOneAndAHalfSeconds) {
    DriveRig rig;
    rig.servo().power_on(rig.now);
    rig.run(1400ms);
    EXPECT_EQ(rig.servo().state(), Servo::State::starting);
    rig.run(200ms);
    EXPECT_EQ(rig.servo().state(), Servo::State::ready);
}

}  // namespace
}  // namespace taktwerk::axes::sim::xp200
