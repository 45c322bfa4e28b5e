// SE-808X: the drive file against its manual, "SE-808X 驱动器使用手册 - EtherCAT 总线应用介绍". Literals are typed from the manual, its
// section beside each, never taken from the files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/config/loaded_drive.hpp"

namespace taktwerk::config {
namespace {

using namespace std::chrono_literals;
using axes::ParameterChange;
using axes::ParameterEffect;
using axes::Quirk;
using ecat::Access;
using ecat::DataType;
using ecat::Mappable;
using ecat::PdoEntry;
using testing::ElementsAre;

const ecat::ObjectEntry* object(const ecat::DeviceDescription& device, std::uint16_t index, std::uint8_t sub = 0) {
    for (const auto& row : device.objects)
        if (row.index == index && row.sub == sub) return &row;
    return nullptr;
}

TEST(Se808x, SaysWhoItIs) {
    const auto d = drive("se-808x");
    EXPECT_EQ(d.device->device_name, "Hollysys_Step");  // 4.2, 1008h
    EXPECT_EQ(d.device->identity.vendor, 0x00000AB6u);  // 4.1
    EXPECT_EQ(d.device->identity.product, 0x00001000u);
    EXPECT_EQ(d.device->identity.revision, 0x00010001u);
    EXPECT_EQ(default_of(*d.device, 0x1000), 0x00040192);  // 4.1, printed with one digit too many
}

TEST(Se808x, ItsFactoryImageIs23And15Bytes) {
    const auto d = drive("se-808x");
    const auto& device = *d.device;
    EXPECT_THAT(device.rx_assigned, ElementsAre(0x1600, 0x1601, 0x1602, 0x1603));  // 4.2
    EXPECT_THAT(device.tx_assigned, ElementsAre(0x1A00, 0x1A01, 0x1A02, 0x1A03));
    std::size_t out = 0, in = 0;
    for (const auto pdo : device.rx_assigned) out += bytes(device.rx_pdos, pdo);
    for (const auto pdo : device.tx_assigned) in += bytes(device.tx_pdos, pdo);
    EXPECT_EQ(out, 23u);                        // 3.1.1: 24 + 96 + 32 + 32 bits
    EXPECT_EQ(in, 15u);                         // 3.1.2: 24 + 64 + 16 + 16 bits
    EXPECT_EQ(device.rx_rules.max_entries, 4);  // 4.2
    EXPECT_EQ(device.rx_rules.max_assigned, 4);
    EXPECT_THAT(device.tx_pdos[2].entries, ElementsAre(PdoEntry{0x60FD, 0, 16}));  // 3.1.2: 60FD0010h
}

TEST(Se808x, TheMappingLeavesOutWhatCyclicZerosWouldOverride) {
    const auto d = drive("se-808x");
    for (const int object : {0x6081, 0x6083, 0x6084, 0x60FF})
        EXPECT_EQ(objects(d.rx).count(static_cast<std::uint16_t>(object)), 0u) << std::hex << object;
    EXPECT_THAT(objects(d.rx), ElementsAre(0x6040, 0x6060, 0x607A));
    EXPECT_THAT(objects(d.tx), testing::IsSupersetOf({0x6041, 0x6061, 0x6064, 0x606C, 0x603F, 0x60FD}));
    for (const auto& pdo : d.tx.assigned) EXPECT_LE(pdo.entries.size(), 4u);
}

TEST(Se808x, WhatItMeansToAnAxis) {
    const auto d = drive("se-808x");
    EXPECT_EQ(d.profile->minimum_cycle_csp, 500us);                               // 1.2
    EXPECT_THAT(d.profile->homing_methods, ElementsAre(17, 18, 19, 20, 21, 22));  // 3.2.7
    EXPECT_TRUE(d.profile->has(Quirk::fault_low_nibble_f));                       // 3.2.2.2
    EXPECT_TRUE(d.profile->has(Quirk::no_remote_bit));
    EXPECT_TRUE(d.profile->has(Quirk::no_internal_limit_bit));
    EXPECT_TRUE(d.profile->has(Quirk::csp_bits_12_13_reserved));
    EXPECT_FALSE(d.profile->encoder.present);           // 4.4: 2000h:11 = 2, open loop
    EXPECT_EQ(d.profile->input_bit_negative_limit, 0);  // 4.3, 60FDh
    EXPECT_EQ(d.profile->input_bit_positive_limit, 1);
    EXPECT_EQ(d.profile->input_bit_home, 2);
    EXPECT_EQ(default_of(*d.device, 0x6098), 20);  // 4.3
    EXPECT_EQ(default_of(*d.device, 0x6099, 1), 10000);
    EXPECT_EQ(default_of(*d.device, 0x609A), 30000);
    EXPECT_EQ(default_of(*d.device, 0x6085), 30000);
    EXPECT_EQ(default_of(*d.device, 0x605E), 0);
    EXPECT_EQ(default_of(*d.device, 0x2000, 0x02), 10000);  // 4.4
    EXPECT_EQ(default_of(*d.device, 0x2000, 0x11), 2);
    EXPECT_EQ(default_of(*d.device, 0x2000, 0x15), 90);
}

TEST(Se808x, ListsEveryObjectOfTheManual) {
    const auto d = drive("se-808x");
    const auto& objects = d.device->objects;
    const auto count = [&](unsigned first, unsigned last) {
        return std::count_if(objects.begin(), objects.end(), [&](const auto& o) { return o.index >= first && o.index <= last; });
    };
    EXPECT_EQ(count(0x6000, 0x6FFF),
              25);  // 4.3: 23 objects from 603Fh to 60FFh, 6099h with two entries behind its count; 605Dh, 607Ch among them
    EXPECT_EQ(count(0x2000, 0x2000), 28);  // 4.4: sub-indices 0 to 1Bh
    EXPECT_EQ(count(0x2001, 0x2001), 15);  // 4.4: sub-indices 0 to Eh
    EXPECT_EQ(count(0x1000, 0x1011), 8);   // 4.1, 4.2: 1000h, 1001h, 1009h, 100Ah, 1010h and 1011h with 0 and 1; 1008h is the identity's
    EXPECT_EQ(d.profile->parameters.size(), objects.size());
    std::set<std::pair<int, int>> once;
    for (const auto& o : objects) EXPECT_TRUE(once.emplace(o.index, o.sub).second) << std::hex << o.index << ":" << int{o.sub};
    for (const auto& row : d.profile->parameters) {
        EXPECT_FALSE(row.section.empty()) << std::hex << row.address.index << ":" << int{row.address.sub};
        EXPECT_FALSE(row.chinese.empty()) << std::hex << row.address.index << ":" << int{row.address.sub};
    }
}

TEST(Se808x, ParametersHaveTheRangesOfTheManual) {
    const auto d = drive("se-808x");
    struct Row {
        std::uint8_t sub;
        std::int64_t minimum, maximum, value;  // value -1: none printed
    };
    const Row rows[] = {
        // 4.4, columns maximum, minimum, default
        {0x01, 5, 70, 10},    {0x02, 200, 60000, 10000}, {0x03, 1, 200, 4},    {0x04, 1, 10000, 100}, {0x05, 0, 65535, -1},
        {0x06, 0, 1, 1},      {0x07, 1, 65535, -1},      {0x08, 1, 65535, -1}, {0x09, 1, 63353, -1},  {0x0A, 1, 65535, -1},
        {0x0B, 1, 25, 6},     {0x0C, 1, 25, 12},         {0x0D, 1, 65535, -1}, {0x0E, 1, 65535, -1},  {0x0F, 1, 60000, 50},
        {0x10, 1, 60000, -1}, {0x11, 1, 60000, 2},       {0x12, 1, 60000, -1}, {0x13, 0, 1, 0},       {0x14, 5, 200, 20},
        {0x15, 5, 200, 90},   {0x16, 0, 1, 0},           {0x17, 0, 3, 0},      {0x18, 0, 65535, 0},   {0x19, 0, 30000, 3000},
        {0x1A, 0, 7, 0},      {0x1B, 10, 100, 50},
    };
    ASSERT_EQ(std::size(rows), 27u);  // 4.4: sub-index 0 is 27
    EXPECT_EQ(default_of(*d.device, 0x2000, 0), 27);
    for (const auto& row : rows) {
        const auto p = parameter(*d.profile, 0x2000, row.sub);
        EXPECT_EQ(p.minimum, row.minimum) << int{row.sub};
        EXPECT_EQ(p.maximum, row.maximum) << int{row.sub};
        EXPECT_EQ(p.bits, 16) << int{row.sub};  // all Unsigned16
        EXPECT_FALSE(p.is_signed) << int{row.sub};
        EXPECT_EQ(p.factory, row.value >= 0 ? axes::FactoryValue::stated : axes::FactoryValue::unknown) << int{row.sub};
        if (row.value >= 0) {
            EXPECT_EQ(p.value, row.value) << int{row.sub};
        }
        EXPECT_EQ(object(*d.device, 0x2000, row.sub)->mappable, Mappable::no) << int{row.sub};
        EXPECT_EQ(object(*d.device, 0x2000, row.sub)->access, Access::rw) << int{row.sub};
    }
    EXPECT_EQ(parameter(*d.profile, 0x2000, 0x01).unit, "A");  // 4.4: x0.1 A
    EXPECT_DOUBLE_EQ(parameter(*d.profile, 0x2000, 0x01).scale, 0.1);
    EXPECT_EQ(parameter(*d.profile, 0x2000, 0x07).unit, "mH");
    EXPECT_EQ(parameter(*d.profile, 0x2000, 0x15).unit, "V");
    EXPECT_EQ(parameter(*d.profile, 0x2000, 0x19).chinese, "通讯错误最大计时");  // a time, not a count
    for (const int sub : {0x01, 0x02, 0x11}) {                                   // 6: save, then switch off and on
        EXPECT_EQ(parameter(*d.profile, 0x2000, static_cast<std::uint8_t>(sub)).effect, ParameterEffect::after_saving);
        EXPECT_EQ(parameter(*d.profile, 0x2000, static_cast<std::uint8_t>(sub)).change, ParameterChange::disabled);  // 3.2.1
    }
    EXPECT_EQ(parameter(*d.profile, 0x2000, 0x06).effect, ParameterEffect::after_saving);  // 2.8
}

TEST(Se808x, ObjectsHaveTypesAndAccessOfTheManual) {
    const auto d = drive("se-808x");
    struct Row {
        std::uint16_t index;
        std::uint8_t sub;
        DataType type;
        Access access;
        Mappable map;
    };
    using D = DataType;
    using A = Access;
    using M = Mappable;
    const Row rows[] = {
        {0x603F, 0, D::U16, A::ro, M::tx},   {0x6040, 0, D::U16, A::wo, M::rx}, {0x6041, 0, D::U16, A::ro, M::tx},  // 4.3
        {0x605A, 0, D::I16, A::rw, M::no},   {0x605D, 0, D::I16, A::rw, M::no}, {0x605E, 0, D::I16, A::rw, M::no},
        {0x6060, 0, D::I8, A::wo, M::rx},                                                                           // 3.2.2.3
        {0x6061, 0, D::I8, A::ro, M::tx},                                                                           // 3.2.2.4
        {0x6064, 0, D::I32, A::ro, M::tx},   {0x606C, 0, D::I32, A::ro, M::tx}, {0x6071, 0, D::I16, A::rw, M::rx},  // 4.3
        {0x6077, 0, D::I16, A::ro, M::tx},   {0x607A, 0, D::I32, A::rw, M::rx}, {0x607C, 0, D::I32, A::rw, M::rx},
        {0x6081, 0, D::U32, A::rw, M::rx},                                       // 3.2.3.2
        {0x6083, 0, D::U32, A::rw, M::rx},   {0x6084, 0, D::U32, A::rw, M::rx},  // 3.2.3.3, 3.2.3.4
        {0x6085, 0, D::U16, A::rw, M::no},   {0x6087, 0, D::U32, A::rw, M::no},  // 4.3
        {0x6098, 0, D::I8, A::wo, M::no},                                        // 3.2.7; 4.3 for the mapping
        {0x6099, 1, D::U32, A::rw, M::rx},   {0x6099, 2, D::U32, A::rw, M::rx}, {0x609A, 0, D::U32, A::rw, M::no},  // 4.3
        {0x60FD, 0, D::U32, A::ro, M::tx},   {0x60FF, 0, D::I32, A::rw, M::rx}, {0x1010, 0, D::U16, A::ro, M::no},
        {0x1010, 1, D::U32, A::rw, M::no},   {0x1011, 0, D::U16, A::ro, M::no},                                     // 4.2
        {0x1011, 1, D::U32, A::rw, M::no},   {0x2001, 1, D::U16, A::ro, M::tx}, {0x2001, 4, D::U16, A::ro, M::tx},  // 4.4
        {0x2001, 0xE, D::U16, A::ro, M::tx},
    };
    for (const auto& row : rows) {
        const auto* o = object(*d.device, row.index, row.sub);
        ASSERT_NE(o, nullptr) << std::hex << row.index << ":" << int{row.sub};
        EXPECT_EQ(o->type, row.type) << std::hex << row.index;
        EXPECT_EQ(o->access, row.access) << std::hex << row.index;
        EXPECT_EQ(o->mappable, row.map) << std::hex << row.index;
    }
    EXPECT_EQ(default_of(*d.device, 0x2001, 0), 5);  // 4.4, although sub-indices 1 to Eh follow
    EXPECT_EQ(default_of(*d.device, 0x6099, 2), 10000);
    EXPECT_EQ(default_of(*d.device, 0x6083), 30000);
    EXPECT_EQ(default_of(*d.device, 0x6084), 30000);
}

TEST(Se808x, AlarmsAreTheNineOfTheManual) {
    const auto d = drive("se-808x");
    const auto& alarms = d.profile->alarms;
    struct Row {
        std::uint16_t code;
        const char *chinese, *lamp;
    };
    const Row rows[] = {
        // 5.1: code, name, blinking of ALM
        {0x5552, "硬件中点错误", "ALM quick 2"}, {0x7122, "未接电机线错误", "ALM quick 3"},   {0x3221, "欠压错误", "ALM quick 4"},
        {0x3211, "过压错误", "ALM quick 5"},     {0x5551, "E2prom 错误", "ALM quick 6"},      {0x8611, "位置超差错误", "ALM slow 2"},
        {0x8311, "过载错误", "ALM slow 3"},      {0x7500, "EtherCAT 通信错误", "ALM slow 4"}, {0x5553, "霍尔信号异常", "ALM slow 5"},
    };
    ASSERT_EQ(alarms.size(), std::size(rows));
    for (std::size_t i = 0; i < alarms.size(); ++i) {
        EXPECT_EQ(alarms[i].code, rows[i].code);
        EXPECT_EQ(alarms[i].chinese, rows[i].chinese);
        EXPECT_EQ(alarms[i].panel, rows[i].lamp);
        EXPECT_TRUE(alarms[i].resettable) << rows[i].chinese;  // 5.1: reset by clearing the alarm
        EXPECT_FALSE(alarms[i].warning);
        EXPECT_FALSE(alarms[i].cause.empty() || alarms[i].remedy.empty() || alarms[i].section.empty()) << rows[i].chinese;
    }
}

TEST(Se808x, StopsAndStorageAreThoseOfTheManual) {
    const auto d = drive("se-808x");
    EXPECT_EQ(d.profile->storage.way, axes::ParameterStorage::on_request);  // 4.2, 6: 1010h:01
    EXPECT_EQ(d.profile->stops.off, axes::DriveStop::coast);                // 3.2.1.1, transitions 6, 8, 9: windings off
    EXPECT_EQ(d.profile->stops.fault, axes::DriveStop::coast);              // 4.3: 605Eh = 0
    EXPECT_FALSE(d.profile->stops.quick_stop_leaves);                       // 3.2.1.1: 12 and 16 only
    EXPECT_EQ(d.profile->hazards.size(), 9u);
    EXPECT_EQ(d.profile->questions.size(), 13u);
}

}  // namespace
}  // namespace taktwerk::config
