// The drive files against their manuals: master and simulator share what is loaded from them, so these literals are typed from
// the manuals (section beside each), never taken from the files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/config/loaded_drive.hpp"

namespace taktwerk::config {
namespace {

using namespace std::chrono_literals;
using axes::DriveMode;
using axes::Quirk;
using ecat::PdoEntry;
using testing::ElementsAre;

// --- SV33-E -----------------------------------------------------------------------------------------------------------------

TEST(Sv33E, SaysWhoItIs) {
    const auto d = drive("sv33-e");
    EXPECT_EQ(d.device->name, "sv33-e");
    EXPECT_EQ(d.device->device_name, "SV33-ECAT");        // 7.1, 1008h
    EXPECT_EQ(d.device->identity.vendor, 0x000007FBu);    // 6.2.6.2, SII words 8 and 9
    EXPECT_EQ(d.device->identity.product, 0x000C0108u);   // 7.1, 1018h:02
    EXPECT_EQ(d.device->identity.revision, 0x00010001u);  // 7.1, 1018h:03
    ASSERT_EQ(d.device->also_accepted.size(), 1u);
    EXPECT_EQ(d.device->also_accepted[0].vendor, 0x00100000u);  // 7.1, 1018h:01
    EXPECT_EQ(default_of(*d.device, 0x1000), 0x00020192);       // 7.1
    EXPECT_EQ(default_of(*d.device, 0x6502), 0x3A1);            // 7.3
}

TEST(Sv33E, MailboxesAndControllerAreThoseOfTheSii) {
    const auto d = drive("sv33-e");
    ASSERT_TRUE(d.device->mailbox.has_value());
    EXPECT_EQ(d.device->mailbox->max_pending, 4);      // 6.2.8.4
    EXPECT_FALSE(d.device->mailbox->complete_access);  // 6.2.8.2
    ASSERT_EQ(d.device->sync_managers.size(), 4u);
    EXPECT_EQ(d.device->sync_managers[0].use, ecat::SmUse::mailbox_out);
    EXPECT_EQ(d.device->sync_managers[0].start, 0x1000);  // 6.2.6.2, word 18h
    EXPECT_EQ(d.device->sync_managers[0].size, 0x80);     // word 19h
    EXPECT_EQ(d.device->sync_managers[1].start, 0x1400);  // word 1Ah
    EXPECT_EQ(d.device->sync_managers[1].size, 0x80);     // word 1Bh
    EXPECT_EQ(d.device->sync_managers[2].use, ecat::SmUse::outputs);
    EXPECT_EQ(d.device->sync_managers[3].use, ecat::SmUse::inputs);
    EXPECT_EQ(d.device->fmmus, 8);               // 1.3.2
    EXPECT_EQ(d.device->sync_manager_count, 8);  // 1.3.2
}

TEST(Sv33E, FixedPdosHaveTheSizesOfTheManual) {
    const auto d = drive("sv33-e");
    const auto& device = *d.device;
    EXPECT_EQ(bytes(device.rx_pdos, 0x1701), 12u);  // 3.4.2 table 3-28
    EXPECT_EQ(bytes(device.rx_pdos, 0x1702), 19u);
    EXPECT_EQ(bytes(device.rx_pdos, 0x1703), 17u);
    EXPECT_EQ(bytes(device.rx_pdos, 0x1704), 23u);
    EXPECT_EQ(bytes(device.rx_pdos, 0x1705), 19u);
    EXPECT_EQ(bytes(device.rx_pdos, 0x1600), 8u);   // 7.1: 6040h, 607Ah, 60B8h
    EXPECT_EQ(bytes(device.tx_pdos, 0x1B01), 24u);  // sum of its eight entries (the table's 28 fits none)
    EXPECT_EQ(bytes(device.tx_pdos, 0x1B02), 25u);  // 3.4.2 table 3-29
    EXPECT_EQ(bytes(device.tx_pdos, 0x1B03), 29u);
    EXPECT_EQ(bytes(device.tx_pdos, 0x1B04), 29u);
    EXPECT_EQ(bytes(device.tx_pdos, 0x1A00), 22u);         // 7.1
    EXPECT_THAT(device.rx_assigned, ElementsAre(0x1701));  // 7.1, 1C12h:01
    EXPECT_THAT(device.tx_assigned, ElementsAre(0x1B01));  // 7.1, 1C13h:01
    EXPECT_THAT(device.rx_pdos[1].entries,
                ElementsAre(PdoEntry{0x6040, 0, 16}, PdoEntry{0x607A, 0, 32}, PdoEntry{0x60B8, 0, 16}, PdoEntry{0x60FE, 1, 32}));
    for (const auto& pdo : device.rx_pdos) EXPECT_EQ(pdo.fixed, pdo.index != 0x1600) << std::hex << pdo.index;
    EXPECT_EQ(device.rx_rules.max_assigned, 1);  // 7.1: 1C12h:00 is 0..1
    EXPECT_EQ(device.rx_rules.max_entries, 10);  // 7.1: 1600h:00 is 0..10
}

TEST(Sv33E, TheMappingFitsTheStrictestOfItsLimitsAndCarriesWhatAnAxisNeeds) {
    const auto d = drive("sv33-e");
    EXPECT_LE(bytes(d.rx), 32u);  // 3.4.2(1)
    EXPECT_LE(bytes(d.tx), 32u);
    ASSERT_EQ(d.rx.assigned.size(), 1u);
    EXPECT_EQ(d.rx.assigned[0].index, 0x1600);
    EXPECT_LE(d.tx.assigned[0].entries.size(), 10u);
    EXPECT_THAT(objects(d.rx), testing::IsSupersetOf({0x6040, 0x6060, 0x607A, 0x60B8}));
    EXPECT_THAT(objects(d.tx), testing::IsSupersetOf({0x6041, 0x6061, 0x6064, 0x606C, 0x6077, 0x603F, 0x60FD}));
}

TEST(Sv33E, RunsOnSync0Only) {
    const auto d = drive("sv33-e");
    EXPECT_TRUE(d.device->dc.required);             // 1.3.2, 6.2.7
    EXPECT_EQ(d.device->dc.minimum_cycle, 125us);   // 7.1, 1C32h:05 = 0001E848h ns
    EXPECT_EQ(d.device->dc.cycle_multiple, 125us);  // 5.4, E.D31
    EXPECT_EQ(d.profile->minimum_cycle_csp, 1ms);   // 3.4.3(1)
}

TEST(Sv33E, HomingMethodsAreThoseThatExist) {
    const auto methods = drive("sv33-e").profile->homing_methods;
    const std::set<int> have(methods.begin(), methods.end());
    for (const int method : {-2, -1, 1, 14, 17, 18, 19, 20, 21, 22, 30, 33, 34, 35}) EXPECT_EQ(have.count(method), 1u) << method;
    for (const int method : {0, 15, 16, 31, 32, 36}) EXPECT_EQ(have.count(method), 0u) << method;  // 5.5, A.D35
    EXPECT_EQ(methods.size(), 33u);
}

TEST(Sv33E, FactoryValuesAreTheUselessOnesOfTheManual) {
    const auto d = drive("sv33-e");
    const auto& device = *d.device;
    EXPECT_EQ(default_of(device, 0x6083), 100);  // 7.3
    EXPECT_EQ(default_of(device, 0x6084), 100);
    EXPECT_EQ(default_of(device, 0x6085), 100);
    EXPECT_EQ(default_of(device, 0x6081), 0);
    EXPECT_EQ(default_of(device, 0x6098), 1);
    EXPECT_EQ(default_of(device, 0x6099, 1), 100);
    EXPECT_EQ(default_of(device, 0x609A), 100);
    EXPECT_EQ(default_of(device, 0x607F), 100'000'000);
    EXPECT_EQ(default_of(device, 0x6065), 1'048'576);
    EXPECT_EQ(default_of(device, 0x605A), 2);
    EXPECT_EQ(default_of(device, 0x2005, 0x0B), 3);  // 7.2, P05.10
}

TEST(Sv33E, SdoWritesDoNotWearTheEeprom) {
    const auto d = drive("sv33-e");
    ASSERT_EQ(d.startup.size(), 1u);
    EXPECT_EQ(d.startup[0].index, 0x2005);  // 5.5, A.427: "set 2005-0Bh to 0"
    EXPECT_EQ(d.startup[0].sub, 0x0B);
    EXPECT_EQ(d.startup[0].value, 0);
    EXPECT_EQ(d.startup[0].type, ecat::DataType::U16);
    EXPECT_TRUE(d.startup[0].if_changed);
}

TEST(Sv33E, WhatItMeansToAnAxis) {
    const auto d = drive("sv33-e");
    const auto& p = *d.profile;
    EXPECT_THAT(p.modes, testing::IsSupersetOf(
                             {DriveMode::cyclic_position, DriveMode::cyclic_velocity, DriveMode::cyclic_torque, DriveMode::homing}));
    EXPECT_EQ(p.torque_rated_raw, 1000);                   // 7.3: 0.1 %
    EXPECT_EQ(p.enable_delay, 250ms);                      // 3.1.2, P05.13
    EXPECT_EQ(p.mode_rules.change_delay, 1ms);             // 3.4.3(2)
    EXPECT_TRUE(p.has(Quirk::fault_reset_needs_disable));  // 5.6
    EXPECT_TRUE(p.has(Quirk::limit_stop_is_warning));      // 5.5, A.220
    EXPECT_FALSE(p.has(Quirk::fault_low_nibble_f));
    EXPECT_EQ(p.alarm_detail_index, 0x2021);  // 7.2, P21.08
    EXPECT_EQ(p.alarm_detail_sub, 0x09);
}

TEST(Sv33E, AlarmsHaveTheCodesAndNamesOfTheManual) {
    const auto d = drive("sv33-e");
    const auto& profile = *d.profile;
    struct Row {
        const char *panel, *chinese;
        std::uint16_t code;
        bool resettable, warning;
    };
    const Row rows[] = {
        // tables 5-2 and 5-3
        {"E.010", "软件参数故障", 0x6320, false, false},       {"E.210", "硬件过流故障", 0x2312, false, false},
        {"E.217", "输入缺相故障", 0x3130, true, false},        {"E.218", "伺服急停故障", 0x5442, true, false},
        {"E.414", "直流母线欠压故障", 0x3220, true, false},    {"E.423", "位置偏差过大故障", 0x8611, true, false},
        {"E.424", "位置指令过速故障", 0x0424, true, false},    {"E.911", "编码器通讯故障", 0x7305, false, false},
        {"E.B10", "电机过载故障", 0x3230, true, false},        {"E.D32", "EtherCAT 同步信号偏差过大", 0x0D32, true, false},
        {"A.220", "正向超程警告", 0x5443, true, true},         {"A.221", "负向超程警告", 0x5444, true, true},
        {"A.D35", "回零方式设置错误警告", 0x6320, true, true},
    };
    for (const auto& row : rows) {
        const auto* found = alarm(profile, row.panel);
        ASSERT_NE(found, nullptr) << row.panel;
        EXPECT_EQ(found->chinese, row.chinese);
        EXPECT_EQ(found->code, row.code) << row.panel;
        EXPECT_EQ(found->resettable, row.resettable) << row.panel;
        EXPECT_EQ(found->warning, row.warning) << row.panel;
    }
    // Tables 5-2 (71 codes, E.228 printed twice) and 5-3 (13 codes).
    EXPECT_EQ(std::count_if(profile.alarms.begin(), profile.alarms.end(), [](const auto& a) { return !a.warning; }), 71);
    EXPECT_EQ(std::count_if(profile.alarms.begin(), profile.alarms.end(), [](const auto& a) { return a.warning; }), 13);
}

TEST(EveryDrive, SaysInWordsWhatItAssumes) {
    for (const char* name : {"sv33-e", "se-808x", "sv-da200", "tsvm-d6", "xp200"}) {
        const auto profile = drive(name).profile;  // the drive itself is gone behind this line
        const auto& assumed = profile->assumed;
        EXPECT_GE(assumed.size(), 5u) << name;
        for (const auto& sentence : assumed) {
            EXPECT_GE(std::count(sentence.begin(), sentence.end(), ' '), 3) << name << ": '" << sentence << "' is no sentence";
            EXPECT_TRUE(sentence.ends_with('.')) << name << ": " << sentence;
            EXPECT_EQ(std::count(assumed.begin(), assumed.end(), sentence), 1) << name << ": " << sentence;
        }
    }
}

}  // namespace
}  // namespace taktwerk::config
