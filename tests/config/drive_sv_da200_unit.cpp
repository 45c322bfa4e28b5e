// The drive file of the SV-DA200 against its guide (EtherCAT 技术指南). Literals are typed from the guide, section beside each.

#include "config/drive_file/drive_loader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string>

namespace taktwerk::config {
namespace {

using namespace std::chrono_literals;
using axes::DriveAlarmKind;
using axes::DriveMode;
using axes::DriveParameter;
using axes::ParameterEffect;
using ecat::PdoEntry;
using testing::ElementsAre;

const LoadedDrive& drive() {
    static const LoadedDrive loaded = [] {
        auto result = load_drive(std::string(TAKTWERK_SOURCE_DIR) + "/config/drives/sv-da200.yaml");
        if (const auto* errors = std::get_if<std::vector<Error>>(&result)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return LoadedDrive{std::make_shared<ecat::DeviceDescription>(), std::make_shared<axes::DriveProfile>(), {}, {}, {}};
        }
        return std::get<LoadedDrive>(result);
    }();
    return loaded;
}

const DriveParameter& parameter(std::uint16_t index, std::uint8_t sub = 0) {
    static const DriveParameter none;
    for (const auto& p : drive().profile->parameters)
        if (p.address.index == index && p.address.sub == sub) return p;
    ADD_FAILURE() << std::hex << index << " is not listed";
    return none;
}

const ecat::ObjectEntry& object(std::uint16_t index, std::uint8_t sub = 0) {
    static const ecat::ObjectEntry none;
    for (const auto& o : drive().device->objects)
        if (o.index == index && o.sub == sub) return o;
    ADD_FAILURE() << std::hex << index << " is not listed";
    return none;
}

std::size_t bytes(const std::vector<PdoEntry>& entries) {
    std::size_t bits = 0;
    for (const auto& entry : entries) bits += entry.bits;
    return bits / 8;
}

const axes::DriveAlarmText& alarm(std::string_view panel) {
    static const axes::DriveAlarmText none;
    for (const auto& row : drive().profile->alarms)
        if (row.panel == panel) return row;
    ADD_FAILURE() << panel << " is not listed";
    return none;
}

TEST(SvDa200, SyncManagersStandAtTheFixedAddresses) {
    const auto& d = *drive().device;
    ASSERT_EQ(d.sync_managers.size(), 4u);  // 2.2.1
    EXPECT_EQ(d.sync_managers[0].start, 0x1000);
    EXPECT_EQ(d.sync_managers[1].start, 0x1200);
    EXPECT_EQ(d.sync_managers[2].start, 0x1400);
    EXPECT_EQ(d.sync_managers[3].start, 0x1480);
    EXPECT_GE(d.sync_managers[0].size, 40);  // 40 ~ 512 Byte
    EXPECT_LE(d.sync_managers[0].size, 512);
    EXPECT_EQ(d.fmmus, 3);             // 2.2.1: FMMU 0 to 2
    EXPECT_TRUE(d.mailbox->sdo_info);  // 2.3
}

TEST(SvDa200, TheFactoryMappingIsThatOfTheGuide) {  // 2.2.4
    const auto& d = *drive().device;
    EXPECT_THAT(d.rx_assigned, ElementsAre(0x1600));
    EXPECT_THAT(d.tx_assigned, ElementsAre(0x1A00));
    EXPECT_THAT(d.rx_pdos.at(0).entries, ElementsAre(PdoEntry{0x6040, 0, 16}, PdoEntry{0x607A, 0, 32}, PdoEntry{0x60FF, 0, 32},
                                                     PdoEntry{0x6060, 0, 8}, PdoEntry{0x6071, 0, 16}, PdoEntry{0x60B8, 0, 16},
                                                     PdoEntry{0x60E0, 0, 16}, PdoEntry{0x60E1, 0, 16}, PdoEntry{0x607F, 0, 32}));
    EXPECT_EQ(bytes(d.rx_pdos.at(0).entries), 23u);  // 2+4+4+1+2+2+2+2+4
    EXPECT_THAT(d.tx_pdos.at(0).entries, ElementsAre(PdoEntry{0x6041, 0, 16}, PdoEntry{0x6064, 0, 32}, PdoEntry{0x606C, 0, 32},
                                                     PdoEntry{0x6077, 0, 16}, PdoEntry{0x6061, 0, 8}, PdoEntry{0x6078, 0, 16},
                                                     PdoEntry{0x60B9, 0, 16}, PdoEntry{0x60BA, 0, 32}, PdoEntry{0x60FD, 0, 32}));
    EXPECT_EQ(bytes(d.tx_pdos.at(0).entries), 25u);  // 2+4+4+2+1+2+2+4+4
    EXPECT_EQ(d.rx_pdos.size(), 4u);                 // 4.2: 1600h to 1603h
    EXPECT_EQ(d.tx_pdos.size(), 4u);                 // 4.2: 1A00h to 1A03h
}

TEST(SvDa200, WhatTheRuntimeMapsKeepsToTenObjectsAPdo) {
    EXPECT_EQ(drive().device->rx_rules.max_entries, 10);  // 2.1 note 11
    EXPECT_EQ(drive().device->tx_rules.max_entries, 10);
    ASSERT_EQ(drive().rx.assigned.size(), 1u);
    ASSERT_EQ(drive().tx.assigned.size(), 1u);
    EXPECT_LE(drive().rx.assigned[0].entries.size(), 10u);
    EXPECT_LE(drive().tx.assigned[0].entries.size(), 10u);
    EXPECT_LE(bytes(drive().rx.assigned[0].entries), 0x80u / 3);  // three buffers between 1400h and 1480h (2.2.1)
    for (const auto& entry : drive().rx.assigned[0].entries) EXPECT_NE(entry.index, 0x60B2) << "would override P2.44 (4.10)";
}

TEST(SvDa200, KnowsSixCyclesOnly) {  // 2.1 item 4
    EXPECT_THAT(drive().device->dc.cycles, ElementsAre(250us, 500us, 1ms, 2ms, 4ms, 8ms));
    EXPECT_TRUE(drive().device->dc.supported);
    EXPECT_FALSE(drive().device->dc.required);  // 2.1 item 3: 0 is free run
}

TEST(SvDa200, ModesAndHomingMethodsAreThoseDescribed) {
    EXPECT_THAT(drive().profile->modes,  // 2.3
                testing::UnorderedElementsAre(DriveMode::profile_position, DriveMode::profile_velocity, DriveMode::homing,
                                              DriveMode::cyclic_position, DriveMode::cyclic_velocity, DriveMode::cyclic_torque));
    EXPECT_THAT(drive().profile->homing_methods, ElementsAre(1, 2, 3, 4, 17, 18, 19, 20, 35));  // 3.4.6
    EXPECT_EQ(object(0x6502).value, 0x3A5);                                                     // bits 0, 2, 5, 7, 8, 9: 2.3
    EXPECT_EQ(drive().profile->enable_status_bits, 0x0110);                                     // 3.1.2: bit 4 main power, bit 8 clock
}

TEST(SvDa200, ObjectsOfTheProfileHaveTheTypesOfTheGuide) {  // 4.3
    using ecat::Access;
    using ecat::DataType;
    using ecat::Mappable;
    struct Row {
        std::uint16_t index;
        DataType type;
        Access access;
        Mappable map;
    };
    constexpr auto rw = Access::rw, ro = Access::ro;
    constexpr auto no = Mappable::no, rx = Mappable::rx, tx = Mappable::tx;
    for (const auto& row : {Row{0x603F, DataType::U16, ro, tx}, Row{0x6040, DataType::U16, rw, rx}, Row{0x6041, DataType::U16, ro, tx},
                            Row{0x605D, DataType::I16, rw, no}, Row{0x6060, DataType::I8, rw, rx},  Row{0x6061, DataType::I8, ro, tx},
                            Row{0x6063, DataType::I32, ro, no}, Row{0x6064, DataType::I32, ro, tx}, Row{0x6065, DataType::U32, rw, no},
                            Row{0x6066, DataType::U16, rw, no}, Row{0x606C, DataType::I32, ro, tx}, Row{0x6071, DataType::I16, rw, rx},
                            Row{0x6072, DataType::U16, rw, rx}, Row{0x6073, DataType::U16, ro, no}, Row{0x6075, DataType::U32, ro, no},
                            Row{0x6076, DataType::U32, ro, no}, Row{0x6079, DataType::U32, ro, no}, Row{0x607A, DataType::I32, rw, rx},
                            Row{0x607C, DataType::I32, rw, no}, Row{0x607F, DataType::U32, rw, rx}, Row{0x6081, DataType::U32, rw, rx},
                            Row{0x6083, DataType::U32, rw, rx}, Row{0x6084, DataType::U32, rw, rx}, Row{0x6098, DataType::I8, rw, no},
                            Row{0x609A, DataType::U32, rw, no}, Row{0x60B0, DataType::I32, rw, rx}, Row{0x60B1, DataType::I32, rw, rx},
                            Row{0x60B2, DataType::I16, rw, rx}, Row{0x60B8, DataType::U16, rw, rx}, Row{0x60B9, DataType::U16, ro, tx},
                            Row{0x60BD, DataType::I32, ro, tx}, Row{0x60E0, DataType::U16, rw, rx}, Row{0x60E1, DataType::U16, rw, rx},
                            Row{0x60F4, DataType::I32, ro, tx}, Row{0x60FD, DataType::U32, ro, tx}, Row{0x60FF, DataType::I32, rw, rx},
                            Row{0x6502, DataType::U32, ro, no}, Row{0x4000, DataType::U16, ro, tx}, Row{0x4001, DataType::I16, ro, no},
                            Row{0x4002, DataType::I16, rw, no}, Row{0x4003, DataType::I16, rw, no}, Row{0x4020, DataType::I32, rw, no},
                            Row{0x4021, DataType::I16, rw, no}, Row{0x4022, DataType::I16, rw, no}, Row{0x4100, DataType::I32, rw, rx},
                            Row{0x4101, DataType::I32, rw, rx}, Row{0x1001, DataType::U8, ro, tx}}) {
        const auto& o = object(row.index);
        EXPECT_EQ(o.type, row.type) << std::hex << row.index;
        EXPECT_EQ(o.access, row.access) << std::hex << row.index;
        EXPECT_EQ(o.mappable, row.map) << std::hex << row.index;
    }
    for (std::uint8_t sub = 1; sub <= 3; ++sub) EXPECT_EQ(object(0x4300, sub).type, DataType::U32);  // 4.9
}

TEST(SvDa200, ObjectsThatTheGuideDoesNotListDoNotExist) {  // 4.2, 4.3
    std::set<std::uint16_t> have;
    for (const auto& o : drive().device->objects) have.insert(o.index);
    for (const int index : {0x605A, 0x605B, 0x605C, 0x605E, 0x607D, 0x607E, 0x6080, 0x6085, 0x6086, 0x6087, 0x60C2, 0x60E3, 0x1010})
        EXPECT_EQ(have.count(static_cast<std::uint16_t>(index)), 0u) << std::hex << index;
}

// --- The vendor's parameters [4.4] ---------------------------------------------------------------------------------------------

TEST(SvDa200, EveryParameterOfTheTablesIsThere) {
    int p = 0, r = 0;
    for (const auto& row : drive().profile->parameters) {
        p += row.parameter.starts_with("P");
        r += row.parameter.starts_with("R");
    }
    EXPECT_EQ(p, 384);  // rows of 2000h to 2606h
    EXPECT_EQ(r, 82);   // rows of 3000h to 3114h
}

// "Pa.bb": 2000h + 100h * a + bb, "Ra.bb": 3000h + 100h * a + bb, bb a decimal number. 4.4, 4.9: P0.05 is 2005h.
TEST(SvDa200, EachParameterHasTheAddressOfItsNumber) {
    int checked = 0;
    for (const auto& row : drive().profile->parameters) {
        if (row.parameter.empty()) continue;
        ASSERT_EQ(row.parameter.size(), 5u) << row.parameter;
        unsigned group = 0, number = 0;
        std::from_chars(row.parameter.data() + 1, row.parameter.data() + 2, group);
        std::from_chars(row.parameter.data() + 3, row.parameter.data() + 5, number);
        const unsigned base = row.parameter[0] == 'P' ? 0x2000 : 0x3000;
        EXPECT_EQ(row.address.index, base + 0x100 * group + number) << row.parameter;
        EXPECT_EQ(row.address.sub, 0) << row.parameter;
        EXPECT_FALSE(row.chinese.empty()) << row.parameter;
        EXPECT_FALSE(row.section.empty()) << row.parameter;
        ++checked;
    }
    EXPECT_EQ(checked, 466);
}

TEST(SvDa200, NoAddressIsListedTwice) {
    std::set<std::pair<std::uint16_t, std::uint8_t>> seen;
    for (const auto& o : drive().device->objects)
        EXPECT_TRUE(seen.emplace(o.index, o.sub).second) << std::hex << o.index << ':' << int{o.sub};
}

TEST(SvDa200, ParametersAreAsPrinted) {  // 4.4
    struct Row {
        std::uint16_t index;
        const char *parameter, *chinese;
        std::uint8_t bits;
        bool is_signed;
        double scale;
    };
    for (const auto& row : {Row{0x2000, "P0.00", "电机型号", 32, true, 1},
                            Row{0x2003, "P0.03", "控制模式选择", 16, true, 1},
                            Row{0x2005, "P0.05", "点动速度", 16, true, 1},
                            Row{0x200A, "P0.10", "最大转矩限制 1", 16, true, 0.1},
                            Row{0x2011, "P0.17", "参数 EEPROM写入方式选择", 16, true, 1},
                            Row{0x2012, "P0.18", "厂家密码", 16, false, 1},
                            Row{0x2016, "P0.22", "电机旋转一圈所需脉冲数", 32, true, 1},
                            Row{0x2025, "P0.37", "位置指令模式", 16, true, 1},
                            Row{0x202D, "P0.45", "模拟量输入 1死区范围", 16, true, 0.001},
                            Row{0x2045, "P0.69", "快速停机减速时间", 16, true, 1},
                            Row{0x2063, "P0.99", "速度检测 FIR滤波等级", 16, true, 1},
                            Row{0x2104, "P1.04", "惯量离线整定", 32, true, 1},
                            Row{0x2118, "P1.24", "第 1陷波 Q值", 16, true, 0.01},
                            Row{0x2127, "P1.39", "第 2制振滤波器系数", 16, true, 0.01},
                            Row{0x2200, "P2.00", "第 1速度增益", 16, true, 0.1},
                            Row{0x220B, "P2.11", "速度前馈滤波时间", 16, true, 0.01},
                            Row{0x222C, "P2.44", "转矩指令偏置", 16, true, 0.1},
                            Row{0x2235, "P2.53", "中频抑振开关", 16, false, 1},
                            Row{0x2254, "P2.84", "自动模式速度观测器速度反馈输入滤波时间", 32, true, 0.01},
                            Row{0x2300, "P3.00", "开关量 1输入配置", 16, false, 1},
                            Row{0x2328, "P3.40", "行程限位开关设定", 16, true, 1},
                            Row{0x2407, "P4.07", "EtherCAT同步周期", 16, true, 1},
                            Row{0x240D, "P4.13", "总线速度指令", 32, true, 0.1},
                            Row{0x2419, "P4.25", "EtherCAT控制单位类型", 16, true, 1},
                            Row{0x2421, "P4.33", "位置超差脉冲范围", 32, true, 1},
                            Row{0x242B, "P4.43", "转矩限制屏蔽及运行周期选择", 16, false, 1},
                            Row{0x250A, "P5.10", "回原点方式选择", 16, true, 1},
                            Row{0x2545, "P5.69", "点位触发缓存开关", 16, false, 1},
                            Row{0x2606, "P6.06", "端子 JOG有效", 16, true, 1},
                            Row{0x3000, "R0.00", "电机转速", 32, true, 0.1},
                            Row{0x3002, "R0.02", "反馈脉冲累积", 64, true, 1},
                            Row{0x300A, "R0.10", "输出电流", 32, true, 0.01},
                            Row{0x3021, "R0.33", "上电时间", 32, false, 1},
                            Row{0x3039, "R0.57", "第二编码器位置反馈累积", 64, true, 1},
                            Row{0x3063, "R0.99", "故障码", 16, true, 1},
                            Row{0x3114, "R1.20", "驱动器状态位显示", 32, false, 1}}) {
        const auto& p = parameter(row.index);
        EXPECT_EQ(p.parameter, row.parameter) << std::hex << row.index;
        EXPECT_EQ(p.chinese, row.chinese) << row.parameter;
        EXPECT_EQ(p.bits, row.bits) << row.parameter;
        EXPECT_EQ(p.is_signed, row.is_signed) << row.parameter;
        EXPECT_DOUBLE_EQ(p.scale, row.scale) << row.parameter;
        EXPECT_EQ(p.change == axes::ParameterChange::never, row.parameter[0] == 'R') << row.parameter;  // RO
    }
}

TEST(SvDa200, OnlyTwoMonitorValuesCanBeMapped) {  // 4.4, 4.5
    std::set<std::uint16_t> mappable;
    for (const auto& o : drive().device->objects)
        if (o.index >= 0x2000 && o.index < 0x4000 && o.mappable != ecat::Mappable::no) mappable.insert(o.index);
    EXPECT_THAT(mappable, ElementsAre(0x300D, 0x3019));
}

TEST(SvDa200, WhatIsPrintedOfValuesAndEffects) {
    EXPECT_EQ(object(0x2016).value, 10000);   // 2.1 note 4
    EXPECT_EQ(object(0x2400).value, -1);      // 2.1 item 2
    EXPECT_EQ(object(0x242B).value, 0x0003);  // 2.1 note 8
    EXPECT_EQ(object(0x241A).maximum, 63);    // 2.1 item 7
    EXPECT_EQ(object(0x241B).maximum, 10);    // 2.1 item 8
    EXPECT_EQ(object(0x2407).maximum, 5);     // 2.1 item 4
    EXPECT_EQ(object(0x2419).maximum, 3);     // 2.1 item 6
    // 2.1 note 1: the first five items and P4.28 after a restart, P4.25 to P4.27 at once; note 4: P0.22; 3.8.1: P3.00
    const auto effect = [](int index) { return parameter(static_cast<std::uint16_t>(index)).effect; };
    for (const int index : {0x2003, 0x2400, 0x2408, 0x2407, 0x2409, 0x241C, 0x2016, 0x2300})
        EXPECT_EQ(effect(index), ParameterEffect::after_restart) << std::hex << index;
    for (const int index : {0x2419, 0x241A, 0x241B}) EXPECT_EQ(effect(index), ParameterEffect::at_once) << std::hex << index;
}

// --- Settings that decide ------------------------------------------------------------------------------------------------------

TEST(SvDa200, UnitsFollowP425) {  // 2.1 note 3, note 8, 4.6
    const auto& units = drive().profile->units;
    EXPECT_EQ(units.object.index, 0x2419);
    EXPECT_EQ(units.counts_per_revolution.index, 0x2016);
    ASSERT_EQ(units.variants.size(), 4u);
    for (int value = 0; value < 4; ++value) {
        const auto& v = units.variants[static_cast<std::size_t>(value)];
        EXPECT_EQ(v.value, value);
        EXPECT_EQ(v.velocity, value == 0 ? axes::VelocityUnit::rpm : axes::VelocityUnit::profile);
        EXPECT_EQ(v.acceleration, value == 0 ? axes::AccelerationUnit::time : axes::AccelerationUnit::counts);
        EXPECT_EQ(v.zero_limits_count, value == 2);
        EXPECT_EQ(v.index_before_inputs, value == 2);
        EXPECT_EQ(v.index_probe, value != 3);
        EXPECT_EQ(v.cyclic_bit_12, value >= 2);
        EXPECT_EQ(v.status_hidden, value == 3 ? 0x4100 : 0) << "bits 8 and 14 are the vendor's: 3.1.2";
    }
}

TEST(SvDa200, SettingsThatForbidEnablingAreChecked) {
    std::set<std::uint16_t> checked;
    for (const auto& row : drive().profile->required_settings) {
        checked.insert(row.object.index);
        if (row.object.index == 0x2003) {  // 2.1 item 1
            EXPECT_THAT(row.values, ElementsAre(8));
        }
        if (row.object.index == 0x2025) {  // 3.3.2, 3.3.4
            EXPECT_THAT(row.values, ElementsAre(1));
        }
        if (row.object.index == 0x2407) {  // 2.1 item 4
            EXPECT_THAT(row.cycles, ElementsAre(250us, 500us, 1ms, 2ms, 4ms, 8ms));
        }
        EXPECT_FALSE(row.remedy.empty());
    }
    EXPECT_THAT(checked, ElementsAre(0x2003, 0x2025, 0x2407, 0x2408, 0x2419));
}

// --- Alarms [5.2, 5.3] ------------------------------------------------------------------------------------------------------------

TEST(SvDa200, AllAlarmsAreThereAndCanBeToldApart) {
    const auto& alarms = drive().profile->alarms;
    EXPECT_EQ(alarms.size(), 75u);  // 5 of 5.2, 70 of 5.3
    std::set<std::string> panels;
    std::set<std::uint32_t> details;
    for (const auto& row : alarms) {
        EXPECT_TRUE(panels.insert(row.panel).second) << row.panel;
        EXPECT_TRUE(details.insert(row.detail).second) << row.panel;
        EXPECT_FALSE(row.cause.empty() || row.remedy.empty() || row.section.empty()) << row.panel;
        // "Er24-b": 4000h has the main code in bits 15 to 8 and the sub-code in bits 3 to 0 (5.1).
        unsigned main = 0, sub = 0;
        std::from_chars(row.panel.data() + 2, row.panel.data() + 4, main);
        std::from_chars(row.panel.data() + 5, row.panel.data() + 6, sub, 16);
        EXPECT_EQ(row.detail, main << 8 | sub) << row.panel;
    }
    EXPECT_EQ(drive().profile->alarm_detail_index, 0x4000);
}

TEST(SvDa200, AlarmsAreAsPrinted) {
    struct Row {
        const char* panel;
        std::uint16_t code;
        const char* chinese;
        bool resettable;  ///< false: the remedy is to switch off and on
    };
    for (const auto& row : {Row{"Er24-a", 0x8100, "EtherCAT 故障-DC Sync0信号异常", true},
                            Row{"Er24-b", 0x8100, "EtherCAT 故障-断线故障", true},
                            Row{"Er24-c", 0x8100, "EtherCAT 故障-PDO数据丢失故障", true},
                            Row{"Er01-0", 0x2320, "IGBT故障", true},
                            Row{"Er02-0", 0x7301, "编码器故障-编码器断线", true},
                            Row{"Er02-7", 0x7305, "编码器故障-多圈绝对值丢失", true},
                            Row{"Er02-8", 0x5114, "编码器故障-编码器电池低压报警", true},
                            Row{"Er02-9", 0x5115, "编码器故障-编码器电池欠压故障", true},
                            Row{"Er03-2", 0x7200, "电流传感器故障-W相电流传感器故障", false},
                            Row{"Er04-0", 0x6100, "系统初始化故障", false},
                            Row{"Er05-3", 0x6320, "设置故障-软件限位设置故障", true},
                            Row{"Er07-0", 0x7112, "再生放电过载故障", true},
                            Row{"Er09-0", 0x5520, "EEPROM故障-读写故障", false},
                            Row{"Er09-1", 0x5530, "EEPROM故障-数据校验故障", true},
                            Row{"Er10-0", 0x7400, "硬件故障-FPGA故障", false},
                            Row{"Er10-2", 0x2300, "硬件故障-对地短路故障", true},
                            Row{"Er10-4", 0x5430, "硬件故障-紧急停机故障", true},
                            Row{"Er13-0", 0x3110, "主回路过压故障", true},
                            Row{"Er13-1", 0x3120, "主回路欠压故障", true},
                            Row{"Er14-0", 0x5115, "控制电源欠压故障", true},
                            Row{"Er18-0", 0x2230, "电机过载故障", true},
                            Row{"Er19-0", 0x8400, "速度故障-过速故障", true},
                            Row{"Er19-4", 0xFF00, "飞车故障", true},
                            Row{"Er21-0", 0x8500, "位置超程-正向超程", true},
                            Row{"Er21-1", 0x8500, "位置超程-反向超程", true},
                            Row{"Er22-0", 0x8611, "超差故障-位置超差", true},
                            Row{"Er22-2", 0x8611, "位置增量溢出故障", true},
                            Row{"Er23-0", 0x4210, "驱动器过温故障", true},
                            Row{"Er25-6", 0xFF00, "应用故障-回原点越位", false},
                            Row{"Er25-7", 0xFF00, "应用故障-惯量辨识失败", true}}) {
        EXPECT_EQ(alarm(row.panel).code, row.code) << row.panel;
        EXPECT_EQ(alarm(row.panel).chinese, row.chinese) << row.panel;
        EXPECT_EQ(alarm(row.panel).resettable, row.resettable) << row.panel;
    }
    EXPECT_EQ(alarm("Er24-a").kind, DriveAlarmKind::sync_lost);
    EXPECT_EQ(alarm("Er21-0").kind, DriveAlarmKind::positive_limit);
    EXPECT_EQ(alarm("Er02-7").kind, DriveAlarmKind::reference_lost);
}

}  // namespace
}  // namespace taktwerk::config
