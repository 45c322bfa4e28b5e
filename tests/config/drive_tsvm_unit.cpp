// The TSVM-D6 against its manual V1.1 (simplified edition, 2020-12). Literals are typed from the manual, section beside each.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "config/drive_file/drive_loader.hpp"
#include "ecat/description/module_pdos.hpp"

namespace taktwerk::config {
namespace {

using axes::DriveAlarmKind;
using axes::DriveMode;
using axes::DriveParameter;
using axes::ParameterEffect;
using axes::ParameterReach;
using axes::Quirk;
using testing::ElementsAre;
using namespace std::chrono_literals;

const LoadedDrive& tsvm() {
    static const LoadedDrive loaded = [] {
        auto result = load_drive(std::string(TAKTWERK_SOURCE_DIR) + "/config/drives/tsvm-d6.yaml");
        if (const auto* errors = std::get_if<std::vector<Error>>(&result)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return LoadedDrive{std::make_shared<ecat::DeviceDescription>(), std::make_shared<axes::DriveProfile>(), {}, {}, {}};
        }
        return std::get<LoadedDrive>(result);
    }();
    return loaded;
}

const ecat::ObjectEntry* tsvm_object(unsigned index) {
    for (const auto& o : tsvm().device->objects)
        if (o.index == index && o.sub == 0) return &o;
    return nullptr;
}

const DriveParameter* tsvm_parameter(std::string_view name) {
    for (const auto& p : tsvm().profile->parameters)
        if (p.parameter == name) return &p;
    return nullptr;
}

const axes::DriveAlarmText* alarm(unsigned code) {
    for (const auto& row : tsvm().profile->alarms)
        if (row.code == code) return &row;
    return nullptr;
}

// --- six axes from one -------------------------------------------------------------------------------------------------------

TEST(TsvmObjects, StandAtTheNumbersThatTheManualPrintsForEachAxis) {
    // 5.4.3 items 2, 3 and 5 to 10; 7 for the error code; 6060h of axis 1 to 4 (item 4), of 5 and 6 by the rule of 5.2.5.
    constexpr unsigned printed[][6] = {{0x6040, 0x6840, 0x7040, 0x7840, 0x8040, 0x8840}, {0x6041, 0x6841, 0x7041, 0x7841, 0x8041, 0x8841},
                                       {0x607A, 0x687A, 0x707A, 0x787A, 0x807A, 0x887A}, {0x60FF, 0x68FF, 0x70FF, 0x78FF, 0x80FF, 0x88FF},
                                       {0x6071, 0x6871, 0x7071, 0x7871, 0x8071, 0x8871}, {0x6064, 0x6864, 0x7064, 0x7864, 0x8064, 0x8864},
                                       {0x606C, 0x686C, 0x706C, 0x786C, 0x806C, 0x886C}, {0x6077, 0x6877, 0x7077, 0x7877, 0x8077, 0x8877},
                                       {0x603F, 0x683F, 0x703F, 0x783F, 0x803F, 0x883F}, {0x6060, 0x6860, 0x7060, 0x7860, 0x8060, 0x8860}};
    for (const auto& row : printed)
        for (const auto index : row) {
            ASSERT_NE(tsvm_object(index), nullptr) << std::hex << index;
            EXPECT_EQ(tsvm_object(index)->type, tsvm_object(row[0])->type) << std::hex << index;
        }
    EXPECT_EQ(tsvm_object(0x8041)->access, ecat::Access::ro);  // the statusword of axis 5, whatever 5.4.3 item 4 says of modes
    EXPECT_EQ(tsvm_object(0x8841)->access, ecat::Access::ro);
    EXPECT_EQ(tsvm().device->objects.size() % 6, 0u);
}

TEST(TsvmObjects, VendorAreasLieWhereTheManualPutsThem) {
    // 5.4.3 item 1: 2000h to 27FFh, 2800h, 3000h, 3800h, 4000h, 4800h to 4FFFh.
    for (const unsigned base : {0x2000u, 0x2800u, 0x3000u, 0x3800u, 0x4000u, 0x4800u}) {
        EXPECT_NE(tsvm_object(base + 0x50), nullptr) << std::hex << base;  // PA80, 6.1
        EXPECT_EQ(std::count_if(tsvm().device->objects.begin(), tsvm().device->objects.end(),
                                [&](const auto& o) { return o.index >= base && o.index <= base + 0x7FF; }),
                  11)
            << "6.1 prints eleven bus addresses";
    }
    EXPECT_EQ(tsvm_object(0x5000), nullptr);
    EXPECT_EQ(tsvm_object(0x9040), nullptr) << "there is no seventh axis";
}

TEST(TsvmObjects, ThatTheManualDoesNotHaveAreNotThere) {
    // 5.4.1: no homing; 2.6, 6.2: inputs on no object; no touch probe.
    for (const unsigned index : {0x6098u, 0x6099u, 0x609Au, 0x607Cu, 0x60FDu, 0x60B8u, 0x607Fu, 0x60E0u})
        for (unsigned axis = 0; axis < 6; ++axis) EXPECT_EQ(tsvm_object(index + axis * 0x800), nullptr) << std::hex << index;
}

TEST(TsvmPdos, StandAtTheNumbersOfTheManual) {
    const auto pdos = ecat::pdos_of(*tsvm().device, tsvm().modules);
    // 5.2.5, first of each range.
    EXPECT_THAT(pdos.rx_assigned, ElementsAre(0x1600, 0x1640, 0x1680, 0x16C0, 0x1700, 0x1740));
    EXPECT_THAT(pdos.tx_assigned, ElementsAre(0x1A00, 0x1A40, 0x1A80, 0x1AC0, 0x1B00, 0x1B40));
    // 5.2.5, the example of axis 1 in its printed order: 32 + 32 + 16 + 8 + 16 bits.
    using E = ecat::PdoEntry;
    EXPECT_THAT(pdos.rx[0].entries, ElementsAre(E{0x607A, 0, 32}, E{0x60FF, 0, 32}, E{0x6071, 0, 16}, E{0x6060, 0, 8}, E{0x6040, 0, 16}));
    EXPECT_EQ(pdos.rx[5].entries[4], (E{0x8840, 0, 16}));
    EXPECT_EQ(pdos.tx[4].entries[0], (E{0x8041, 0, 16}));
    EXPECT_EQ(tsvm().modules.size(), 6u) << "5.2.5: one module in each of the six slots";
    for (std::size_t slot = 0; slot < tsvm().modules.size(); ++slot) EXPECT_EQ(tsvm().modules[slot].slot, slot);
}

// --- what it is ---------------------------------------------------------------------------------------------------------------

TEST(Tsvm, WhatItMeansToAnAxis) {
    const auto& p = *tsvm().profile;
    EXPECT_EQ(p.axes, 6);
    EXPECT_EQ(p.object_offset, 0x800);                                                                                    // 5.2.5
    EXPECT_EQ(p.pdo_offset, 0x40);                                                                                        // 5.2.5
    EXPECT_THAT(p.modes, ElementsAre(DriveMode::cyclic_position, DriveMode::cyclic_velocity, DriveMode::cyclic_torque));  // 5.4.1
    EXPECT_TRUE(p.homing_methods.empty());                                                                                // 5.4.1
    EXPECT_EQ(p.enable_delay, 100ms);                                                                                     // 5.3.1
    EXPECT_TRUE(p.mode_rules.change_at_standstill);                                                                       // 5.4.1
    EXPECT_EQ(p.mode_rules.change_interval, 20ms);                                                                        // 5.4.1
    EXPECT_EQ(p.mode_rules.indeterminate, 2ms);                                                                           // 5.4.1
    EXPECT_EQ(p.enable_status_bits, 1u << 4);                                                                             // 5.3.1, 5.3.2
    EXPECT_EQ(p.torque_rated_raw, 1000);                                                                                  // 5.4.2: 0.1 %
    EXPECT_EQ(p.brake.release, 20ms);                                                                                     // 6.1, PA50
    EXPECT_EQ(p.brake.hold, 0ms);                                                                                         // 6.1, PA47
    EXPECT_EQ(p.brake.moving_wait, 50ms);                                                                                 // 6.1, PA48
    EXPECT_EQ(p.brake.moving_speed, 100);                                                                                 // 6.1, PA49
    EXPECT_EQ(p.missed_frames_allowed, 3);                                                                                // 7.1.1
    EXPECT_DOUBLE_EQ(p.torque_overload, 1.6);                                                                             // 6.1, PA30
    EXPECT_EQ(p.torque_overload_time, 3s);                                                                                // 4.3.2, PA31
    EXPECT_DOUBLE_EQ(p.overspeed_limit, 1.0);                                                                             // 6.1, PA23
    EXPECT_TRUE(p.stops.quick_stop_leaves);                                                                               // 5.3.1
    EXPECT_EQ(p.storage.way, axes::ParameterStorage::never);                                                              // 3.3.5, 4.3.6
    EXPECT_FALSE(p.has(Quirk::fault_reaction_02b6)) << "02B6h fits no row of the table in 5.3.2: taken for a misprint";
    EXPECT_TRUE(tsvm().device->dc.required);  // 5.2.6
    EXPECT_GE(p.questions.size(), 15u);
    EXPECT_GE(p.assumed.size(), 10u);
}

// --- parameters ---------------------------------------------------------------------------------------------------------------

TEST(TsvmParameters, AllRowsOfTheTableAndWhatOtherSectionsShow) {
    const auto& all = tsvm().profile->parameters;
    const auto in = [&](auto&& rule) { return std::count_if(all.begin(), all.end(), rule); };
    const auto starts = [](const DriveParameter& p, std::string_view with) { return p.parameter.rfind(with, 0) == 0; };
    // 6.1 has 45 rows; 4.3.6 shows nine more (3 7 8 11 16 19 20 24 26), 4.3.2 three (31 34 35), 7.1 names PA59.
    EXPECT_EQ(in([&](const auto& p) { return starts(p, "PA"); }), 45 + 9 + 3 + 1);
    EXPECT_EQ(in([&](const auto& p) { return starts(p, "PA") && p.reach == ParameterReach::bus; }), 11);  // 6.1, last column
    EXPECT_EQ(in([&](const auto& p) { return starts(p, "Fn"); }), 4 + 5);                                 // 6.2; 4.3.1, 4.3.7, 3.3.3
    EXPECT_EQ(in([&](const auto& p) { return starts(p, "DJ"); }), 13);                                    // 4.3.1
    std::set<std::string> names;
    for (const auto& p : all) EXPECT_TRUE(p.parameter.empty() || names.insert(p.parameter).second) << p.parameter << " stands twice";
}

TEST(TsvmParameters, AddressesRangesAndFactoryValuesAreThoseOfTheTable) {
    struct Row {
        const char *name, *chinese;
        int index, minimum, maximum, value;
    };
    const Row rows[] = {
        // 6.1; decimals as raw tenths
        {"PA0", "参数密码", 0x2000, 0, 9999, 315},
        {"PA5", "速度比例增益", 0x2005, 2, 2000, 150},
        {"PA6", "速度积分时间常数", 0x2006, 10, 10000, 500},
        {"PA9", "位置比例增益", 0x2009, 1, 1000, 50},
        {"PA18", "绝对式编码器使用方式", 0x2012, 0, 0b11111, 0b00101},
        {"PA29", "负载转动惯量比", 0x201D, 0, 8000, 200},
        {"PA33", "刚性等级", 0x2021, 0, 31, 0},
        {"PA38", "DP 菜单动态显示项", 0x2026, 0, 300, 0},
        {"PA80", "绝对式编码器复位设置", 0x2050, 0, 0b11111, 0},
        {"PA81", "电机每旋转一圈的指令脉冲数低位", 0x2051, 0, 32000, 0},
        {"PA84", "电机每旋转一圈的指令脉冲数高位", 0x2054, 0, 10000, 0},
        {"PA1", "电机型号", 0, 1, 132, 1},
        {"PA4", "控制方式", 0, 0, 16, 8},
        {"PA12", "位置指令脉冲分频分子", 0, 1, 32767, 1},
        {"PA14", "位置指令脉冲输入方式", 0, 0, 4, 0},
        {"PA17", "位置超差检测范围", 0, 0, 3000, 30},
        {"PA21", "JOG 运行速度/转矩模式最高速度", 0, 0, 3000, 300},
        {"PA23", "用户设定最高速度限制百分比", 0, 1, 200, 100},
        {"PA25", "转矩指令来源选择", 0, 0, 8, 0},
        {"PA27", "内部速度指令 1", 0, -9000, 9000, 0},
        {"PA30", "电机转矩过载报警值", 0, 10, 300, 160},
        {"PA40", "加速时间常数", 0, 0, 10000, 20},
        {"PA45", "绝对式编码器单圈位数", 0, 0, 30, 0},
        {"PA47", "电机静止时使能断开等待时间", 0, 0, 5000, 0},
        {"PA48", "电机运转时电磁制动器制动等待时间", 0, 0, 5000, 50},
        {"PA49", "电机运转时制动器动作速度", 0, 0, 3000, 100},
        {"PA50", "电机使能时制动器打开延时", 0, 0, 3000, 20},
        {"PA51", "制动电阻选择开关", 0, 0, 1, 0},
        {"PA52", "位置指令平滑时间常数", 0, 0, 1000, 0},
        {"PA61", "电机编码器类型设置", 0, -1, 7, 2},
        {"PA62", "报警屏蔽设置位", 0, 0, 0b11111, 0},
        {"PA64", "电流比例增益", 0, 1, 500, 150},
        {"PA65", "电流积分时间常数", 0, 10, 1000, 200},
        {"PA69", "外接制动电阻阻值", 0, 0, 750, 50},
        {"PA70", "外接制动电阻功率", 0, 0, 10000, 50},
        {"PA74", "内部电流指令", 0, -300, 300, 0},
    };
    for (const auto& row : rows) {
        const auto* found = tsvm_parameter(row.name);
        ASSERT_NE(found, nullptr) << row.name;
        EXPECT_EQ(found->chinese, row.chinese);
        EXPECT_EQ(found->address.index, row.index) << row.name;
        EXPECT_EQ(found->minimum, row.minimum) << row.name;
        EXPECT_EQ(found->maximum, row.maximum) << row.name;
        EXPECT_EQ(found->value, row.value) << row.name;
        EXPECT_EQ(found->reach == ParameterReach::bus, row.index != 0) << row.name;
        // The table's own rule: 2000h plus the number.
        EXPECT_TRUE(row.index == 0 || row.index == 0x2000 + std::stoi(std::string(row.name).substr(2))) << row.name;
    }
}

TEST(TsvmParameters, TheStarredOnesCountAfterSavingAndARestart) {
    // 6.1, the rows with a star.
    const std::set<std::string> starred{"PA1",  "PA2",  "PA4",  "PA12", "PA13", "PA14", "PA15", "PA22", "PA23",
                                        "PA30", "PA45", "PA51", "PA61", "PA69", "PA70", "PA81", "PA84"};
    std::set<std::string> ours;
    for (const auto& p : tsvm().profile->parameters)
        if (p.effect == ParameterEffect::after_saving && p.section.rfind("6.1", 0) == 0) ours.insert(p.parameter);
    EXPECT_EQ(ours, starred);
}

// --- alarms -------------------------------------------------------------------------------------------------------------------

TEST(TsvmAlarms, AreAllOfBothTablesAndUnique) {
    // Table 7-1: 15 rows, number plus 70 (7.1). Table 7-2: 29 rows; 24 stands in 7.2.1 alone.
    const std::set<unsigned> common{71, 72, 73, 75, 76, 81, 82, 83, 86, 87, 90, 91, 92, 95, 96};
    const std::set<unsigned> of_axis{1,  2,  3,  4,  5,  6,  10, 11, 12, 13, 14, 15, 18, 19, 20,
                                     21, 22, 23, 24, 27, 28, 29, 33, 34, 35, 43, 44, 45, 46, 47};
    std::set<unsigned> found_common, found_axis;
    for (const auto& row : tsvm().profile->alarms) {
        auto& found = row.whole_drive ? found_common : found_axis;
        EXPECT_TRUE(found.insert(row.code).second) << row.code << " stands twice";
        EXPECT_FALSE(row.english.empty() || row.chinese.empty() || row.cause.empty() || row.remedy.empty()) << row.code;
        EXPECT_EQ(row.section.rfind(row.whole_drive ? "7.1" : "7.2", 0), 0u) << row.code;
        // 7.2: OLED and PC tool show axis x 100 plus the code; 7.1: common ones have no axis.
        EXPECT_EQ(row.panel, std::to_string(row.whole_drive ? row.code - 70 : 100 + row.code));
    }
    EXPECT_EQ(found_common, common);
    EXPECT_EQ(found_axis, of_axis);
}

TEST(TsvmAlarms, TheStarredOnesNeedAPowerCycle) {
    // 7.1, 7.2 and the note at the end of 7.2.1: "★ cannot be reset by software".
    const std::set<unsigned> starred{76, 81, 83, 96, 2, 10, 11, 19, 20, 21, 22, 23, 33, 34, 35, 45, 46, 47};
    std::set<unsigned> ours;
    for (const auto& row : tsvm().profile->alarms)
        if (!row.resettable) ours.insert(row.code);
    EXPECT_EQ(ours, starred);
}

TEST(TsvmAlarms, HaveTheNamesOfTheManualAndMeanWhatItSays) {
    struct Row {
        unsigned code;
        const char* chinese;
        DriveAlarmKind kind;
    };
    const Row rows[] = {
        // 7.1
        {71, "看门狗错误", DriveAlarmKind::other},
        {72, "过压", DriveAlarmKind::other},
        {73, "主电源掉电", DriveAlarmKind::undervoltage},
        {83, "能耗制动过流", DriveAlarmKind::other},
        {91, "总线数据连续错帧", DriveAlarmKind::communication},
        {92, "总线网络连接状态发生变化", DriveAlarmKind::link_changed},
        {95, "急停输入报警", DriveAlarmKind::emergency_stop},
        // 7.2
        {1, "超速", DriveAlarmKind::overspeed},
        {4, "位置超差", DriveAlarmKind::following_error},
        {13, "过负载", DriveAlarmKind::overload},
        {18, "绝对式编码器报警", DriveAlarmKind::encoder},
        {19, "绝对式编码器电池故障", DriveAlarmKind::reference_lost},
        {27, "绝对式编码器电池报警", DriveAlarmKind::battery_low},
        {29, "用户转矩过载", DriveAlarmKind::torque_overload},
        {43, "总线控制模式错误", DriveAlarmKind::mode_not_set},
        {44, "总线状态机异常切换", DriveAlarmKind::left_operational},
        {47, "电机型号 (PA1) 不在电机支持列表内", DriveAlarmKind::other},
    };
    for (const auto& row : rows) {
        ASSERT_NE(alarm(row.code), nullptr) << row.code;
        EXPECT_EQ(alarm(row.code)->chinese, row.chinese);
        EXPECT_EQ(alarm(row.code)->kind, row.kind) << row.code;
    }
}

}  // namespace
}  // namespace taktwerk::config
