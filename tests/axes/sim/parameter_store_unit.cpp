// Parameters over power cycles, for each way in which the drives store them.

#include "axes/sim/parameter_store.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes::sim {
namespace {

using namespace std::chrono_literals;
using Refusal = ParameterStore::Refusal;

constexpr ParameterAddress storage_switch{0x2005, 0x0B}, delay{0x2005, 0x0E}, direction{0x2004, 0x02}, stop{0x2004, 0x0D},
    fault{0x2021, 0x09}, speed{0x6081, 0}, control{0x6040, 0}, method{0x6098, 0};

/// Rows as in the SV33-E manual 7.2 and 7.3.
DriveProfile profile(ParameterStorage storage) {
    DriveProfile p;
    p.storage.way = storage;
    if (storage == ParameterStorage::each_write) p.storage.switched_by = storage_switch;
    const auto row = [&](ParameterAddress at, std::int64_t value, std::int64_t low, std::int64_t high, ParameterChange change,
                         ParameterEffect effect) {
        DriveParameter r;
        r.address = at;
        r.value = value;
        r.minimum = low;
        r.maximum = high;
        r.change = change;
        r.effect = effect;
        p.parameters.push_back(r);
    };
    using C = ParameterChange;
    using E = ParameterEffect;
    row(storage_switch, 3, 0, 3, C::any_time, E::at_once);   // P05.10
    row(delay, 250, 0, 500, C::any_time, E::at_once);        // P05.13
    row(direction, 0, 0, 1, C::disabled, E::after_restart);  // P04.01
    row(stop, 2, 0, 2, C::disabled, E::at_once);             // P04.12
    row(fault, 0, 0, 65535, C::never, E::at_once);           // P21.08
    row(speed, 0, 0, 4294967295, C::any_time, E::at_standstill);
    row(control, 0, 0, 65535, C::any_time, E::at_once);
    row(method, 1, -2, 35, C::any_time, E::at_standstill);
    return p;
}

ParameterStore store(ParameterStorage storage) {
    static constexpr ParameterAddress commands[] = {control};
    return {profile(storage), commands};
}

constexpr Instant t0{};

TEST(ParameterStore, EachWriteStaysWhereTheDriveStoresEach) {
    auto s = store(ParameterStorage::each_write);
    s.write(delay, 300, t0);
    s.write(speed, 5000, t0);
    EXPECT_EQ(s.value(delay), 300);
    s.power_on();
    EXPECT_EQ(s.value(delay), 300);
    EXPECT_EQ(s.value(speed), 5000);
    EXPECT_EQ(s.eeprom_writes(), 2u);
}

// SV33-E 7.2, P05.10: 0 nothing, 1 objects 2000h, 2 objects 6000h, 3 both.
TEST(ParameterStore, TheSwitchSaysWhichWritesAreStored) {
    for (const std::int64_t which : {0, 1, 2, 3}) {
        auto s = store(ParameterStorage::each_write);
        s.write(storage_switch, which, t0);
        s.write(delay, 300, t0);
        s.write(speed, 5000, t0);
        s.power_on();
        EXPECT_EQ(s.value(delay), which == 1 || which == 3 ? 300 : 250) << which;
        EXPECT_EQ(s.value(speed), which == 2 || which == 3 ? 5000 : 0) << which;
    }
}

TEST(ParameterStore, SwitchedOffItStaysOffUntilThePowerGoes) {
    auto s = store(ParameterStorage::each_write);
    s.write(storage_switch, 0, t0);  // with storing off this write is none that is stored
    for (int i = 0; i < 1000; ++i) s.write(delay, i % 500, t0);
    EXPECT_EQ(s.eeprom_writes(), 0u);
    EXPECT_FALSE(s.writes_too_often(t0));
    s.power_on();
    EXPECT_EQ(s.value(storage_switch), 3);
}

TEST(ParameterStore, CommandsAreNeverKept) {
    auto s = store(ParameterStorage::each_write);
    s.write(control, 15, t0);
    EXPECT_EQ(s.value(control), 15);
    s.power_on();
    EXPECT_EQ(s.value(control), 0);
}

TEST(ParameterStore, OnRequestMeansThatSavingIsAnAct) {
    auto s = store(ParameterStorage::on_request);
    s.write(delay, 300, t0);
    s.power_on();
    EXPECT_EQ(s.value(delay), 250);
    s.write(delay, 300, t0);
    s.save(t0);
    EXPECT_EQ(s.eeprom_writes(), 1u);  // what is already there is not written again
    s.power_on();
    EXPECT_EQ(s.value(delay), 300);
    s.restore_factory(t0);
    EXPECT_EQ(s.value(delay), 300);  // counts from the next power-on
    s.power_on();
    EXPECT_EQ(s.value(delay), 250);
}

TEST(ParameterStore, ADriveThatNeverStoresForgetsEverything) {
    auto s = store(ParameterStorage::never);
    s.write(delay, 300, t0);
    s.power_on();
    EXPECT_EQ(s.value(delay), 250);
    EXPECT_EQ(s.eeprom_writes(), 0u);
}

TEST(ParameterStore, RangesAndAccessAreRefused) {
    const auto s = store(ParameterStorage::each_write);
    EXPECT_EQ(s.refuse(delay, 500, false), Refusal::none);
    EXPECT_EQ(s.refuse(delay, 501, false), Refusal::too_high);  // P05.13: 0 to 500
    EXPECT_EQ(s.refuse(method, -2, false), Refusal::none);      // 6098h: -2 to 35
    EXPECT_EQ(s.refuse(method, -3, false), Refusal::too_low);
    EXPECT_EQ(s.refuse(fault, 1, false), Refusal::read_only);
    EXPECT_EQ(s.refuse({0x2FFF, 1}, 0, false), Refusal::unknown);
}

// SV33-E 7.2: "changed when stopped" against "changed at any time".
TEST(ParameterStore, SomeAreTakenOnlyWhileTheMotorIsOff) {
    const auto s = store(ParameterStorage::each_write);
    EXPECT_EQ(s.refuse(stop, 1, true), Refusal::enabled);
    EXPECT_EQ(s.refuse(stop, 1, false), Refusal::none);
    EXPECT_EQ(s.refuse(delay, 1, true), Refusal::none);
}

// SV33-E 5.5, A.426.
TEST(ParameterStore, SomeCountOnlyAfterARestart) {
    auto s = store(ParameterStorage::each_write);
    s.write(direction, 1, t0);
    EXPECT_EQ(s.value(direction), 1);
    EXPECT_EQ(s.acting(direction), 0);
    EXPECT_TRUE(s.restart_pending());
    s.write(direction, 0, t0);  // taken back: nothing is left to wait for
    EXPECT_FALSE(s.restart_pending());
    s.write(direction, 1, t0);
    s.power_on();
    EXPECT_EQ(s.acting(direction), 1);
    EXPECT_FALSE(s.restart_pending());
}

// SV33-E 5.5, A.427, with our numbers: 101 writes within 10 s are too often, spread over a longer time they are not.
TEST(ParameterStore, ManyStoredWritesInAShortTimeAreTooOften) {
    auto s = store(ParameterStorage::each_write);
    Instant now{};
    for (int i = 0; i < 100; ++i) s.write(delay, i, now += 50ms);
    EXPECT_FALSE(s.writes_too_often(now));
    s.write(delay, 7, now += 50ms);
    EXPECT_TRUE(s.writes_too_often(now));
    EXPECT_FALSE(s.writes_too_often(now + 10s));  // it goes by itself

    auto slow = store(ParameterStorage::each_write);
    for (int i = 0; i < 500; ++i) {
        slow.write(delay, i % 500, now += 200ms);
        ASSERT_FALSE(slow.writes_too_often(now));
    }
}

// TSVM: six axes, each with its own objects 800h further.
TEST(ParameterStore, EachAxisHasItsOwn) {
    auto p = profile(ParameterStorage::each_write);
    p.axes = 2;
    p.object_offset = 0x0800;
    ParameterStore s{p, {}};
    s.write({0x6881, 0}, 77, t0);
    EXPECT_EQ(s.value({0x6881, 0}), 77);
    EXPECT_EQ(s.value(speed), 0);
}

}  // namespace
}  // namespace taktwerk::axes::sim
