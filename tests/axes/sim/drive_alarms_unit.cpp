// Alarms of a drive with several axes: those that all of them share.

#include <gtest/gtest.h>

#include "axes/sim/cia402_device.hpp"

namespace taktwerk::axes::sim {
namespace {

using namespace std::chrono_literals;

DriveAlarmText row(std::uint16_t code, DriveAlarmKind kind, bool whole_drive, bool resettable = true) {
    DriveAlarmText text;
    text.code = code;
    text.kind = kind;
    text.whole_drive = whole_drive;
    text.resettable = resettable;
    return text;
}

/// Six axes 800h apart; alarms from the TSVM-D6 manual 7.1 and 7.2.
DriveProfile six_axes() {
    DriveProfile profile;
    profile.axes = 6;
    profile.object_offset = 0x800;
    profile.missed_frames_allowed = 3;
    profile.alarms = {row(73, DriveAlarmKind::undervoltage, true), row(91, DriveAlarmKind::communication, true),
                      row(92, DriveAlarmKind::link_changed, true), row(83, DriveAlarmKind::other, true, false),
                      row(12, DriveAlarmKind::other, false)};
    return profile;
}

ecat::DeviceDescription description() {
    ecat::DeviceDescription d;
    d.sync_managers = {{ecat::SmUse::outputs, 0x1100, 0, 0x64}, {ecat::SmUse::inputs, 0x1600, 0, 0x20}};
    for (unsigned axis = 0; axis < 6; ++axis)
        for (const auto& [index, type] :
             {std::pair{0x603Fu, ecat::DataType::U16}, std::pair{0x6040u, ecat::DataType::U16}, std::pair{0x6041u, ecat::DataType::U16},
              std::pair{0x6060u, ecat::DataType::I8}, std::pair{0x6064u, ecat::DataType::I32}, std::pair{0x607Au, ecat::DataType::I32}}) {
            ecat::ObjectEntry object;
            object.index = static_cast<std::uint16_t>(index + axis * 0x800);
            object.name = "object";
            object.type = type;
            d.objects.push_back(object);
        }
    return d;
}

struct SixAxes {
    ecat::sim::ObjectDictionary dictionary{description()};
    Cia402Device device;
    Instant now{};

    SixAxes() : device(six_axes(), std::vector<Cia402Device::AxisSetup>(6, {PlantConfig{}, SimulatedMotor{}})) {
        device.power_on(dictionary, now);
        device.entered(ecat::sim::EsmState::op, now);
        cycle();
    }
    void cycle(int times = 1) {
        for (int i = 0; i < times; ++i) {
            now += 1ms;
            device.advance(now);
            device.exchange(now);
        }
    }
    /// SYNC0 that found no new outputs, as the slave controller counts it.
    void miss(int frames) {
        for (int i = 0; i < frames; ++i) {
            auto* count = dictionary.find(0x1C32, 0x0B);
            count->set(count->get() + 1);
            cycle();
        }
    }
    void control(unsigned axis, std::int64_t word) {
        dictionary.find(static_cast<std::uint16_t>(0x6040 + axis * 0x800), 0)->set(word);
        cycle();
    }
    std::int64_t code(unsigned axis) { return dictionary.value(static_cast<std::uint16_t>(0x603F + axis * 0x800), 0); }
    void expect_all(std::int64_t wanted) {
        for (unsigned axis = 0; axis < 6; ++axis) EXPECT_EQ(code(axis), wanted) << "axis " << axis + 1;
    }
};

TEST(SharedAlarm, OfOneAxisStaysWithIt) {
    SixAxes d;
    d.device.raise(2, 12);
    d.cycle(2);
    for (unsigned axis = 0; axis < 6; ++axis) EXPECT_EQ(d.code(axis), axis == 2 ? 12 : 0);
}

// 7.1: a common alarm has no axis; it shows as its number plus 70.
TEST(SharedAlarm, OfTheWholeDriveStandsInAllAxesAndEachIsResetByItself) {
    SixAxes d;
    d.device.raise(2, 83);
    d.cycle(2);
    d.expect_all(83);
    d.control(0, 0x80);
    EXPECT_EQ(d.code(0), 83) << "a starred one";

    SixAxes e;
    e.device.raise(5, 73);
    e.cycle(2);
    e.expect_all(73);
    e.control(0, 0x80);
    e.cycle(3);
    EXPECT_EQ(e.code(0), 0);
    EXPECT_EQ(e.code(1), 73);
    for (unsigned axis = 1; axis < 6; ++axis) e.control(axis, 0x80);
    e.expect_all(0);
}

// One main circuit: an enabled axis finds out, the others learn of it.
TEST(SharedAlarm, OneEnabledAxisThatLosesMainPowerTellsTheOthers) {
    SixAxes d;
    d.dictionary.find(0x7060, 0)->set(8);
    for (const int word : {0x06, 0x07, 0x0F}) d.control(2, word);
    ASSERT_EQ(d.dictionary.value(0x7041, 0) & 0x6F, 0x27);
    d.device.main_power(false);
    d.cycle(2);
    d.expect_all(73);
}

// 7.1.1, alarm 21: "more than 3 consecutive".
TEST(MissedFrames, ThreeInARowAreForgivenFourAreNot) {
    SixAxes d;
    d.miss(3);
    d.cycle();
    d.miss(3);
    d.cycle();
    d.expect_all(0);
    d.miss(4);
    d.cycle();
    d.expect_all(91);
}

TEST(LinkChange, StopsAllAxes) {
    SixAxes d;
    d.device.link_changed(d.now);
    d.cycle();
    d.expect_all(92);
}

}  // namespace
}  // namespace taktwerk::axes::sim
