// Which objects a drive needs, what their raw values mean, and what a mapped object starts with.

#include <limits>

#include <gmock/gmock.h>

#include "tests/axes/drives/cia402/scripted_drive.hpp"

namespace taktwerk::axes::cia402::test {
namespace {

using ::testing::HasSubstr;

TEST(Cia402Mapping, AMissingObjectIsNamedWithItsPdoAndWhatToDo) {
    DriveRig rig;
    rig.rx = {{0x6040, 0}, {0x607A, 0}};  // SV33-E 1701h: no mode of operation
    rig.others.push_back({0x6060, 0});
    ASSERT_FALSE(rig.build());
    EXPECT_EQ(rig.refusal.code, "drive.not_mapped");
    EXPECT_THAT(rig.refusal.text(), HasSubstr("z_drive"));
    EXPECT_THAT(rig.refusal.text(), HasSubstr("6060h"));
    EXPECT_THAT(rig.refusal.text(), HasSubstr("RxPDO"));
    EXPECT_THAT(rig.refusal.text(), HasSubstr("pdo.rx"));
}

TEST(Cia402Mapping, EachMandatoryInputIsAskedFor) {
    for (const auto index : {std::uint16_t{0x6041}, std::uint16_t{0x6061}, std::uint16_t{0x6064}}) {
        DriveRig rig;
        std::erase_if(rig.tx, [&](const auto& o) { return o.first == index; });
        rig.others.push_back({index, 0});
        ASSERT_FALSE(rig.build());
        EXPECT_EQ(rig.refusal.code, "drive.not_mapped");
        EXPECT_THAT(rig.refusal.text(), HasSubstr("pdo.tx"));
    }
}

// A mode whose target nobody maps cannot be used, whatever the manual lists.
TEST(Cia402Mapping, AModeWithoutItsTargetIsNoCapability) {
    DriveRig rig;
    rig.profile.modes = {DriveMode::cyclic_position, DriveMode::cyclic_velocity, DriveMode::cyclic_torque};
    rig.rx.push_back({0x60FF, 0});
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    EXPECT_TRUE(rig.drive->capabilities().has(DriveMode::cyclic_position));
    EXPECT_TRUE(rig.drive->capabilities().has(DriveMode::cyclic_velocity));
    EXPECT_FALSE(rig.drive->capabilities().has(DriveMode::cyclic_torque));
}

// TSVM 5.3: objects of axis n at +0x800 * (n - 1). The third axis: 7040h, 7060h, 707Ah ...
TEST(Cia402Mapping, TheThirdAxisOfASlaveHasItsObjectsAtTheOffset) {
    DriveRig rig;
    rig.axis = 2;
    const auto shift = [](Objects& list) {
        for (auto& o : list) o.first = static_cast<std::uint16_t>(o.first + 0x1000);
    };
    rig.rx.push_back({0x6040, 0});
    Objects third{{0x6040, 0}, {0x6060, 0}, {0x607A, 0}};
    shift(third);
    shift(rig.tx);
    rig.rx.insert(rig.rx.end(), third.begin(), third.end());
    rig.tx.push_back({0x6041, 0});
    ASSERT_TRUE([&] {
        rig.others.clear();
        return rig.build();
    }()) << rig.refusal.text();
    rig.put(0x7041, 0x0231);
    rig.put(0x7061, 8);
    rig.command.power = PowerRequest::on;
    rig.run(6);
    EXPECT_EQ(rig.got(0x7040), 0x0007);
    EXPECT_EQ(rig.got(0x6040), 0x0000) << "the first axis is another's";
}

// SE-808X 3.1.1 and sheet 9.1 item 3: 6083h is cyclic by default; a zero there would override what the SDO wrote.
TEST(Cia402Mapping, MappedObjectsThatNobodyWritesStartAtTheirStartUpValue) {
    DriveRig rig;
    rig.rx.push_back({0x6083, 0});
    rig.rx.push_back({0x607F, 0});
    ecat::StartupSdo ramp;
    ramp.index = 0x6083;
    ramp.value = 250'000;
    rig.startup = {ramp};
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.run(20);
    EXPECT_EQ(rig.got(0x6083), 250'000);
    EXPECT_EQ(rig.got(0x607F), 100'000'000) << "the dictionary's own value where the list has none";
    rig.command.acceleration = 5000;
    rig.run(6);
    EXPECT_EQ(rig.got(0x6083), 5000);
}

// SV33-E 7.3: 60E0h and 60E1h end at 5000 (500 %), their type at 65535; SV-DA200 2.2: a mapped limit of 0 blocks the drive.
TEST(Cia402Mapping, NoTorqueLimitIsTheMostTheObjectTakes) {
    DriveRig rig;
    rig.rx.push_back({0x60E0, 0});
    rig.rx.push_back({0x60E1, 0});
    rig.rx.push_back({0x6072, 0});
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    EXPECT_TRUE(rig.drive->capabilities().torque_limits);
    rig.run(6);
    EXPECT_EQ(rig.got(0x60E0), 5000);
    EXPECT_EQ(rig.got(0x60E1), 5000);
    rig.command.torque_limit_positive = 0.8;
    rig.command.torque_limit_negative = 0.3;
    rig.run(6);
    EXPECT_EQ(rig.got(0x60E0), 800);  // 0.1 % of rated
    EXPECT_EQ(rig.got(0x60E1), 300);
    EXPECT_EQ(rig.got(0x6072), 800)
        << "it holds for both directions: the smaller would cut off the larger (SV33-E 3.4.3 (8): the least of both counts)";
    EXPECT_TRUE(rig.drive->capabilities().torque_limit_per_direction);
}

TEST(Cia402Mapping, OneTorqueLimitForBothDirectionsTakesTheSmaller) {
    DriveRig rig;
    rig.rx.push_back({0x6072, 0});
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    EXPECT_TRUE(rig.drive->capabilities().torque_limits);
    EXPECT_FALSE(rig.drive->capabilities().torque_limit_per_direction);
    rig.command.torque_limit_positive = 0.8;
    rig.command.torque_limit_negative = 0.3;
    rig.run(6);
    EXPECT_EQ(rig.got(0x6072), 300);
}

// Not mapped, but in the dictionary: by SDO when they change, and only then. Nothing is written before somebody asks; without a limit again the drive
// gets back what it began with.
TEST(Cia402TorqueLimits, AreWrittenWhenTheyChange) {
    DriveRig rig;
    rig.others.insert(rig.others.end(), {{0x60E0, 0}, {0x60E1, 0}, {0x6072, 0}});
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    const auto& can = rig.drive->capabilities();
    EXPECT_FALSE(can.torque_limits);
    EXPECT_TRUE(can.torque_limits_written);
    EXPECT_TRUE(can.torque_limit_per_direction);
    rig.put(0x60E0, 4321);
    rig.run(200);
    EXPECT_EQ(rig.got(0x60E0), 4321) << "as somebody left it";
    EXPECT_NE(rig.feedback().torque_limits, TorqueLimitAnswer::pending);

    rig.command.torque_limit_positive = 0.8;
    rig.command.torque_limit_negative = 0.3;
    rig.run(2);
    EXPECT_EQ(rig.feedback().torque_limits, TorqueLimitAnswer::pending);
    rig.run(200);
    EXPECT_NE(rig.feedback().torque_limits, TorqueLimitAnswer::pending);
    EXPECT_NE(rig.feedback().torque_limits, TorqueLimitAnswer::refused);
    EXPECT_EQ(rig.got(0x60E0), 800);
    EXPECT_EQ(rig.got(0x60E1), 300);
    EXPECT_EQ(rig.got(0x6072), 5000) << "each direction has its own";

    rig.put(0x60E0, 1234);
    rig.run(200);
    EXPECT_EQ(rig.got(0x60E0), 1234) << "the same limits are not written again";
    rig.command.torque_limit_positive = rig.command.torque_limit_negative = std::numeric_limits<double>::infinity();
    rig.run(200);
    EXPECT_EQ(rig.got(0x60E0), 5000) << "the dictionary's value";
    EXPECT_EQ(rig.got(0x60E1), 5000);
}

// 6072h alone; the start-up list says what it goes back to.
TEST(Cia402TorqueLimits, OneForBothDirectionsIsWrittenToo) {
    DriveRig rig;
    rig.others.push_back({0x6072, 0});
    ecat::StartupSdo most;
    most.index = 0x6072;
    most.type = ecat::DataType::U16;
    most.value = 2500;
    rig.startup = {most};
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    EXPECT_TRUE(rig.drive->capabilities().torque_limits_written);
    EXPECT_FALSE(rig.drive->capabilities().torque_limit_per_direction);
    rig.command.torque_limit_positive = rig.command.torque_limit_negative = 0.4;
    rig.run(200);
    EXPECT_EQ(rig.got(0x6072), 400);
    rig.command.torque_limit_positive = rig.command.torque_limit_negative = std::numeric_limits<double>::infinity();
    rig.run(200);
    EXPECT_EQ(rig.got(0x6072), 2500);
}

// What a drive does not take is said, and not tried again.
TEST(Cia402TorqueLimits, ARefusedOneIsSaid) {
    DriveRig rig;
    rig.others.push_back({0x6072, 0});
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.puppet->refuse_downloads = true;
    rig.command.torque_limit_positive = rig.command.torque_limit_negative = 0.4;
    rig.run(200);
    EXPECT_NE(rig.feedback().torque_limits, TorqueLimitAnswer::pending);
    EXPECT_EQ(rig.feedback().torque_limits, TorqueLimitAnswer::refused);
    EXPECT_EQ(rig.got(0x6072), 5000);
    rig.puppet->refuse_downloads = false;
    rig.command.torque_limit_positive = rig.command.torque_limit_negative = 0.5;
    rig.run(200);
    EXPECT_NE(rig.feedback().torque_limits, TorqueLimitAnswer::refused);
    EXPECT_EQ(rig.got(0x6072), 500);
}

TEST(Cia402Mapping, FeedForwardIsSentInUnitsOfTheDriveAndOnlyWhileItFollows) {
    DriveRig rig;
    rig.profile.velocity_counts_per_unit = 0.1;  // a drive that counts speeds in tens
    rig.rx.push_back({0x60B1, 0});
    rig.rx.push_back({0x60B2, 0});
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.command.power = PowerRequest::on;
    rig.command.velocity = -120'000;
    rig.command.torque = 0.25;
    rig.mode(8);
    rig.status(0x0233);
    rig.run(6);
    EXPECT_EQ(rig.got(0x60B1), 0);
    EXPECT_EQ(rig.got(0x60B2), 0);
    rig.enabled();
    rig.run(6);
    EXPECT_EQ(rig.got(0x60B1), -12'000);
    EXPECT_EQ(rig.got(0x60B2), 250);
    rig.command.torque = std::numeric_limits<double>::quiet_NaN();
    rig.command.velocity = 1e30;
    rig.run(6);
    EXPECT_EQ(rig.got(0x60B2), 0) << "what is no number pushes nowhere";
    EXPECT_EQ(rig.got(0x60B1), 2'147'483'647);
}

TEST(Cia402Mapping, SwitchesAreReadFromTheBitsOfTheProfile) {
    DriveRig rig;
    rig.profile.input_bit_negative_limit = 4;
    rig.profile.input_bit_positive_limit = 5;
    rig.profile.input_bit_home = 31;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.put(0x60FD, 0x80000010);
    rig.run(6);
    EXPECT_TRUE(rig.feedback().negative_limit);
    EXPECT_FALSE(rig.feedback().positive_limit);
    EXPECT_TRUE(rig.feedback().home_switch);
}

TEST(Cia402Position, GoesOnAcrossTheWrapOfThirtyTwoBits) {
    DriveRig rig;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.put(0x6064, 2'147'483'600);
    rig.run(6);
    const auto before = rig.feedback().position;
    rig.put(0x6064, -2'147'483'596);  // 100 counts further
    rig.run(6);
    EXPECT_EQ(rig.feedback().position - before, 100);
    rig.command.power = PowerRequest::on;
    rig.enabled();
    rig.command.position = rig.feedback().position + 50;
    rig.run(6);
    EXPECT_EQ(rig.got(0x607A), -2'147'483'546) << "the target wraps like the actual position";
}

TEST(Cia402Position, VelocityIsDifferentiatedWhereTheDriveDoesNotTell) {
    DriveRig rig;
    std::erase_if(rig.tx, [](const auto& o) { return o.first == 0x606C; });
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    std::int64_t position = 0;
    rig.puppet->on_exchange = [&] { rig.put(0x6064, position += 25); };
    rig.run(20);
    EXPECT_NEAR(rig.feedback().velocity, 25'000, 1);  // 25 counts each ms
}

TEST(Cia402Position, TorqueAndVelocityAreScaledByTheProfile) {
    DriveRig rig;
    rig.profile.velocity_counts_per_unit = 0.1;
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.put(0x606C, -1234);
    rig.put(0x6077, -355);
    rig.run(6);
    EXPECT_DOUBLE_EQ(rig.feedback().velocity, -12'340);
    EXPECT_DOUBLE_EQ(rig.feedback().torque, -0.355);
}

// A drive with an incremental encoder counts from 0 after a power cycle: the axis learns that its zero is gone, and sees no speed.
TEST(Cia402Position, AReturningDriveIsAnnouncedAndItsLeapIsNoSpeed) {
    DriveRig rig;
    std::erase_if(rig.tx, [](const auto& o) { return o.first == 0x606C; });
    ASSERT_TRUE(rig.build()) << rig.refusal.text();
    rig.put(0x6064, 700'000);
    rig.run(20);
    const auto epoch = rig.feedback().position_epoch;
    ASSERT_TRUE(rig.feedback().online);

    rig.network.set_power(0, false);
    for (int i = 0; i < 5000 && rig.feedback().online; ++i) rig.run(1);
    EXPECT_FALSE(rig.feedback().online);
    EXPECT_FALSE(rig.feedback().fresh);
    double fastest = 0;
    rig.on_cycle = [&] { fastest = std::max(fastest, std::abs(rig.feedback().velocity)); };
    rig.network.set_power(0, true);
    for (int i = 0; i < 20'000 && !(rig.feedback().online && rig.feedback().fresh); ++i) rig.run(1);
    rig.run(10);
    ASSERT_TRUE(rig.feedback().online);
    EXPECT_EQ(rig.feedback().position_epoch, epoch + 1);
    EXPECT_EQ(rig.feedback().position, 0);
    EXPECT_LT(fastest, 1.0);
}

}  // namespace
}  // namespace taktwerk::axes::cia402::test
