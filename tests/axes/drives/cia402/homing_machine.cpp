// Settings of one homing run, and the turns of an absolute encoder: what is written beside the cycle and what the cycle waits for.

#include <gtest/gtest.h>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

constexpr unsigned start_bit = 0x10;

ecat::StartupSdo written(std::uint16_t index, std::uint8_t sub, ecat::DataType type, std::int64_t value) {
    ecat::StartupSdo sdo;
    sdo.index = index;
    sdo.sub = sub;
    sdo.type = type;
    sdo.value = value;
    return sdo;
}

/// A drive that knows 6098h, 6099h and 609Ah, method -2 to 35 (SV33-E 7.3), in homing mode.
class HomingPerRun : public ::testing::Test {
protected:
    void SetUp() override {
        rig.others.insert(rig.others.end(), {{0x6098, 0}, {0x6099, 1}, {0x6099, 2}, {0x609A, 0}});
        using ecat::DataType;
        rig.startup = {written(0x6098, 0, DataType::I8, 21), written(0x6099, 1, DataType::U32, 5000),
                       written(0x6099, 2, DataType::U32, 400), written(0x609A, 0, DataType::U32, 60000)};
        ASSERT_TRUE(rig.build()) << rig.refusal.text();
        ASSERT_TRUE(rig.drive->capabilities().homing_per_run);
        rig.status(0x1237);
        rig.mode(6);
        rig.puppet->on_exchange = [this] {
            if ((rig.got(0x6040) & start_bit) == 0) return;
            if (!started) method_at_start = rig.got(0x6098), speed_at_start = rig.got(0x6099, 1);
            started = true;
        };
        rig.command.power = PowerRequest::on;
        rig.command.mode = DriveMode::homing;
        rig.command.start_homing = true;
    }
    DriveRig rig;
    bool started = false;
    std::int64_t method_at_start = 0, speed_at_start = 0;
};

TEST_F(HomingPerRun, TheStartWaitsUntilTheDriveHasThem) {
    rig.command.homing = {.method = -1, .search_velocity = 7000, .latch_velocity = 300, .acceleration = 50000};
    rig.run(3);
    EXPECT_FALSE(started);
    rig.run(200);
    ASSERT_TRUE(started);
    EXPECT_EQ(method_at_start, -1);
    EXPECT_EQ(speed_at_start, 7000);
    EXPECT_EQ(rig.got(0x6099, 2), 300);
    EXPECT_EQ(rig.got(0x609A), 50000);
    EXPECT_FALSE(rig.feedback().homing_setup_refused);
}

TEST_F(HomingPerRun, WhatTheStartUpListWroteIsNotWrittenAgain) {
    rig.command.homing = {.method = 21, .search_velocity = 5000, .latch_velocity = 400, .acceleration = 60000};
    rig.run(6);
    EXPECT_TRUE(started);
}

TEST_F(HomingPerRun, ARefusedMethodStartsNothingAndIsSaid) {
    rig.command.homing = {.method = 100, .search_velocity = 7000, .latch_velocity = 300, .acceleration = 50000};
    rig.run(200);
    EXPECT_TRUE(rig.feedback().homing_setup_refused);
    EXPECT_FALSE(started);
    rig.command.mode = DriveMode::cyclic_position;
    rig.command.start_homing = false;
    rig.run(5);
    EXPECT_FALSE(rig.feedback().homing_setup_refused) << "the run is over";
    rig.command.mode = DriveMode::homing;
    rig.command.start_homing = true;
    rig.command.homing.method = 22;
    rig.run(200);
    EXPECT_TRUE(started);
    EXPECT_EQ(method_at_start, 22);
}

// A drive that quietly keeps its old value would search the wrong way.
TEST_F(HomingPerRun, AValueThatReadsBackOtherwiseIsRefused) {
    auto watch = rig.puppet->on_exchange;
    rig.puppet->on_exchange = [this, watch] {
        rig.put(0x609A, 123);
        watch();
    };
    rig.command.homing = {.method = 17, .search_velocity = 7000, .latch_velocity = 300, .acceleration = 50000};
    rig.run(200);
    EXPECT_TRUE(rig.feedback().homing_setup_refused);
    EXPECT_FALSE(started);
}

TEST(HomingPerRunCapability, NeedsTheObjects) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    EXPECT_TRUE(rig.drive->capabilities().drive_homing);
    EXPECT_FALSE(rig.drive->capabilities().homing_per_run);
}

// SV33-E P20.05 = 2 (7.2): reset of encoder faults and turns, only while the motor has no power.
TEST(ClearTurns, ByAnObject) {
    DriveRig rig;
    rig.others.push_back({0x2020, 6});
    rig.profile.encoder.clear_turns = {0x2020, 6};
    rig.profile.encoder.clear_turns_value = 2;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    ASSERT_TRUE(rig.drive->capabilities().has(DriveService::clear_multi_turn));
    rig.enabled();
    rig.run(6);
    EXPECT_EQ(rig.drive->start_service(DriveService::clear_multi_turn), 0u) << "never with power";
    EXPECT_EQ(rig.feedback().reference_epoch, 0);

    rig.status(0x0250);
    rig.run(6);
    const auto position_epoch = rig.feedback().position_epoch;
    const auto ticket = rig.drive->start_service(DriveService::clear_multi_turn);
    ASSERT_NE(ticket, 0u);
    const auto answer = rig.answer_to(ticket);
    ASSERT_TRUE(answer && answer->ok());
    EXPECT_EQ(rig.got(0x2020, 6), 2);
    EXPECT_EQ(rig.feedback().reference_epoch, 1);
    EXPECT_NE(rig.feedback().position_epoch, position_epoch);
}

// TSVM 5.3.2: bit 12 of the control word; how long is not stated: it stands 100 ms and falls.
TEST(ClearTurns, ByTheControlWord) {
    DriveRig rig;
    rig.profile.encoder.clear_turns_control = 0x1000;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    int cycles = 0;
    rig.puppet->on_exchange = [&] { cycles += (rig.got(0x6040) & 0x1000) != 0; };
    rig.run(50);
    EXPECT_EQ(cycles, 0);
    const auto ticket = rig.drive->start_service(DriveService::clear_multi_turn);
    ASSERT_NE(ticket, 0u);
    EXPECT_EQ(rig.drive->start_service(DriveService::clear_multi_turn), 0u) << "one at a time";
    const auto answer = rig.answer_to(ticket);
    ASSERT_TRUE(answer && answer->ok());
    rig.run(10);
    EXPECT_NEAR(cycles, 100, 2);
    EXPECT_EQ(rig.control() & 0x1000, 0);
    EXPECT_EQ(rig.feedback().reference_epoch, 1);
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test
