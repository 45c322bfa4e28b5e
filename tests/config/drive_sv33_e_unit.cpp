// Parameters, alarms and hazards of the SV33-E against its manual V1.1. Literals are typed from the manual, section beside each.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <string>

#include "config/drive_file/drive_loader.hpp"

namespace taktwerk::config {
namespace {

using axes::DriveParameter;
using axes::HazardCondition;
using axes::ParameterChange;
using axes::ParameterEffect;
using namespace std::chrono_literals;

const LoadedDrive& sv33e() {
    static const LoadedDrive loaded = [] {
        auto result = load_drive(std::string(TAKTWERK_SOURCE_DIR) + "/config/drives/sv33-e.yaml");
        if (const auto* errors = std::get_if<std::vector<Error>>(&result)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return LoadedDrive{std::make_shared<ecat::DeviceDescription>(), std::make_shared<axes::DriveProfile>(), {}, {}, {}};
        }
        return std::get<LoadedDrive>(result);
    }();
    return loaded;
}

const std::vector<DriveParameter>& parameters() { return sv33e().profile->parameters; }

const DriveParameter* at(std::uint16_t index, std::uint8_t sub) {
    for (const auto& p : parameters())
        if (p.address.index == index && p.address.sub == sub) return &p;
    return nullptr;
}

TEST(Sv33EParameters, AllRowsOfTable72AndWhatOtherSectionsMention) {
    const auto in = [](auto&& rule) { return std::count_if(parameters().begin(), parameters().end(), rule); };
    // Table 7-2 has 277 rows: 6 3 14 22 10 11 6 20 14 32 19 2 15 11 23 69 in its groups 2000h to 2009h, 200Ah, 200Eh, 201Ah, 2020h, 2021h, 2023h.
    EXPECT_EQ(in([](const auto& p) { return p.section == "7.2"; }), 277);
    const std::map<std::uint16_t, int> groups{{0x2000, 6},  {0x2001, 3},  {0x2002, 14}, {0x2003, 22}, {0x2004, 10}, {0x2005, 11},
                                              {0x2006, 6},  {0x2007, 20}, {0x2008, 14}, {0x2009, 32}, {0x200A, 19}, {0x200E, 2},
                                              {0x201A, 15}, {0x2020, 11}, {0x2021, 23}, {0x2023, 69}};
    for (const auto& [index, count] : groups)
        EXPECT_EQ(in([index = index](const auto& p) { return p.section == "7.2" && p.address.index == index; }), count)
            << std::hex << index;
    // Parameters that 3.1.1 to 5.5, 7.3 and 8.1 name and table 7-2 lacks.
    EXPECT_EQ(in([](const auto& p) { return !p.parameter.empty() && p.section != "7.2"; }), 78);
    // Table 7-3 without the numbers of entries: 57 values, and the 31 of 60E3h.
    EXPECT_EQ(in([](const auto& p) { return p.section == "7.3"; }), 57 + 31);
}

TEST(Sv33EParameters, ThePanelsNumberIsTheObjectsNumber) {
    // 7.2: Pgg.nn is 2000h + gg, sub-index nn + 1; gg in hexadecimal, nn in decimal digits.
    for (const auto& p : parameters()) {
        if (p.parameter.empty()) continue;
        unsigned group = 0, number = 0;
        ASSERT_EQ(std::sscanf(p.parameter.c_str(), "P%2X.%2u", &group, &number), 2) << p.parameter;
        EXPECT_EQ(p.address.index, 0x2000 + group) << p.parameter;
        EXPECT_EQ(p.address.sub, number + 1) << p.parameter;
    }
}

TEST(Sv33EParameters, EveryAddressOnceEveryDefaultInItsRangeEverySectionNamed) {
    std::set<std::pair<std::uint16_t, std::uint8_t>> seen;
    for (const auto& p : parameters()) {
        EXPECT_TRUE(seen.insert({p.address.index, p.address.sub}).second) << std::hex << p.address.index << ":" << int{p.address.sub};
        EXPECT_GE(p.value, p.minimum.value_or(p.value)) << p.name;
        EXPECT_LE(p.value, p.maximum.value_or(p.value)) << p.name;
        EXPECT_FALSE(p.section.empty()) << p.name;
        if (p.address.index >= 0x2000 && p.bits == 16) {
            EXPECT_GE(p.value, p.is_signed ? -32768 : 0) << p.name;
            EXPECT_LE(p.value, p.is_signed ? 32767 : 65535) << p.name;
        }
    }
}

TEST(Sv33EParameters, ParametersOf32BitsLeaveTheNextNumberFree) {
    for (const auto& p : parameters())
        if (!p.parameter.empty() && p.bits == 32) {
            EXPECT_EQ(at(p.address.index, static_cast<std::uint8_t>(p.address.sub + 1)), nullptr) << p.parameter;
        }
}

TEST(Sv33EParameters, AreThoseOfTheManual) {
    struct Row {
        std::uint16_t index;
        std::uint8_t sub;
        const char *number, *chinese;
        std::int64_t value, minimum, maximum;
        const char* unit;
        double scale;
        ParameterChange change;
        ParameterEffect effect;
    };
    constexpr auto any = ParameterChange::any_time, stopped = ParameterChange::disabled, never = ParameterChange::never;
    constexpr auto now = ParameterEffect::at_once, restart = ParameterEffect::after_restart;
    constexpr std::int64_t u16 = 65535, u32 = 4294967295;
    const Row rows[] = {
        // table 7-2
        {0x2000, 0x0C, "P00.11", "电机额定电流", 470, 0, u16, "A", 0.01, stopped, restart},
        {0x2000, 0x0E, "P00.13", "额定转矩", 239, 0, u32, "Nm", 0.01, stopped, restart},
        {0x2001, 0x01, "P01.00", "编码器通信协议", 11233, 0, u16, "", 1, stopped, restart},
        {0x2001, 0x06, "P01.05", "编码器线数", 1048576, 0, u32, "", 1, stopped, restart},
        {0x2002, 0x10, "P02.15", "驱动器额定电流", 550, 1, u16, "A", 0.01, never, now},
        {0x2002, 0x23, "P02.34", "再生电阻选择", 0, 0, 3, "", 1, stopped, now},
        {0x2002, 0x29, "P02.40", "外置再生电阻阻值", 50, 1, 1000, "Ohm", 1, stopped, now},
        {0x2003, 0x01, "P03.00", "DI1 功能", 9, 0, 34, "", 1, stopped, now},
        {0x2003, 0x05, "P03.04", "DI3 功能", 11, 0, 34, "", 1, stopped, now},
        {0x2003, 0x14, "P03.19", "初始生效 DI 功能 2", 0, 0, 31, "", 1, stopped, restart},
        {0x2003, 0x15, "P03.20", "DO1 功能", 17, 0, 19, "", 1, stopped, now},
        {0x2003, 0x20, "P03.31", "DI 强制输出值", 447, 0, 447, "", 1, any, now},
        {0x2004, 0x01, "P04.00", "控制模式", 10, 0, 10, "", 1, stopped, now},
        {0x2004, 0x02, "P04.01", "电机运动方向", 0, 0, 1, "", 1, stopped, restart},
        {0x2004, 0x0C, "P04.11", "二类故障停机模式", 2, 0, 4, "", 1, stopped, now},
        {0x2004, 0x10, "P04.15", "超程停机模式", 1, 0, 2, "", 1, stopped, now},
        {0x2004, 0x18, "P04.23", "急转矩停机转矩值", 1000, 0, 3000, "%", 0.1, stopped, now},
        {0x2005, 0x0B, "P05.10", "通信写参数保存", 3, 0, 3, "", 1, any, now},
        {0x2005, 0x0E, "P05.13", "抱闸松闸到可接收指令延时", 250, 0, 500, "ms", 1, any, now},
        {0x2005, 0x0F, "P05.14", "抱闸吸合零速保持时间", 150, 1, 1000, "ms", 1, any, now},
        {0x2005, 0x10, "P05.15", "抱闸吸合速度阈值", 30, 0, 3000, "rpm", 1, any, now},
        {0x2005, 0x11, "P05.16", "抱闸吸合时间阈值", 500, 1, 1000, "ms", 1, any, now},
        {0x2005, 0x2C, "P05.43", "软限位设置", 0, 0, 2, "", 1, stopped, now},
        {0x2006, 0x01, "P06.00", "速度比例增益 1", 250, 1, 20000, "Hz", 0.1, any, now},
        {0x2006, 0x02, "P06.01", "速度积分增益 1", 3183, 15, 51200, "ms", 0.01, any, now},
        {0x2006, 0x0B, "P06.10", "负载惯量比", 200, 0, 12000, "", 0.01, any, now},
        {0x2007, 0x03, "P07.02", "转矩滤波 1", 79, 0, 3000, "ms", 0.01, any, now},
        {0x2007, 0x07, "P07.06", "速度前馈滤波时间", 50, 0, 6400, "ms", 0.01, any, now},
        {0x2007, 0x49, "P07.72", "探针滤波", 15, 0, 31, "ns", 25, stopped, restart},
        {0x2008, 0x0B, "P08.10", "飞车电流判断阈值", 2000, 1000, 4000, "%", 0.1, any, now},
        {0x2008, 0x0D, "P08.12", "飞车速度反馈滤波时间", 20, 1, 1000, "ms", 0.1, any, restart},
        {0x2008, 0x13, "P08.18", "堵转保护时间", 200, 10, u16, "ms", 1, any, now},
        {0x2009, 0x0B, "P09.10", "母线电压", 0, 0, u16, "V", 0.1, never, now},
        {0x2009, 0x2C, "P09.43", "编码器单圈位置", 0, 0, 2147483647, "encoder counts", 1, never, now},
        {0x200A, 0x03, "P0A.02", "ModBus 通讯波特率", 6, 0, 6, "", 1, any, now},
        {0x200A, 0x0E, "P0A.13", "EtherCAT 从站站点别名", 0, 0, u16, "", 1, stopped, now},
        {0x200A, 0x20, "P0A.31", "EtherCAT Sync 信号丢失允许次数", 9, 0, u16, "", 1, any, now},
        {0x200A, 0x21, "P0A.32", "EtherCAT Sync 信号检测偏差阈值", 3000, 0, 4000, "ns", 1, stopped, now},
        {0x200A, 0x22, "P0A.33", "CSP 位置指令增量过大阈值", 3, 1, 7, "times", 1, any, now},
        {0x200E, 0x13, "P0E.18", "第二组通讯电子齿轮比分母", 1, 1, u16, "", 1, stopped, now},
        {0x201A, 0x01, "P1A.00", "实时自调整设定", 7, 0, 7, "", 1, any, now},
        {0x201A, 0x13, "P1A.18", "扰动补偿增益", 0, -1000, 1000, "%", 0.1, any, now},
        {0x2020, 0x06, "P20.05", "编码器复位", 0, 0, 2, "", 1, stopped, now},
        {0x2021, 0x09, "P21.08", "当前故障码", 0, 0, u16, "", 1, never, now},
        {0x2021, 0x1F, "P21.30", "故障记录查询", 0, 0, 9, "", 1, any, now},
        {0x2021, 0x22, "P21.33", "所选故障时间戳", 0, 0, u32, "s", 0.1, never, now},
        {0x2023, 0x02, "P23.01", "VDI 上电初始状态", 0, 0, u16, "", 1, any, restart},
        {0x2023, 0x4B, "P23.74", "VDO16 极性", 0, 0, 1, "", 1, any, now},
        // tables 3-1, 4-12, 3-69 and figure 4.4.5
        {0x2000, 0x13, "P00.18", "最大转速", 6000, 0, u16, "rpm", 1, stopped, restart},
        {0x2000, 0x16, "P00.21", "极对数", 4, 0, u16, "", 1, stopped, restart},
        {0x2006, 0x12, "P06.17", "增益切换-延时", 50, 0, u16, "ms", 0.1, stopped, now},
        {0x2015, 0x04, "P15.03", "转矩限制来源选择", 2, 0, 4, "", 1, any, ParameterEffect::at_standstill},
        // table 7-3
        {0x605A, 0x00, "", "快速停机方式选择", 2, 0, 7, "", 1, any, ParameterEffect::at_standstill},
        {0x6067, 0x00, "", "位置到达阈值", 734, 0, 65535, "encoder counts", 1, any, now},
        {0x6098, 0x00, "", "原点复归方法", 1, -2, 35, "", 1, any, ParameterEffect::at_standstill},
        {0x60E0, 0x00, "", "正向转矩限制", 5000, 0, 5000, "%", 0.1, any, ParameterEffect::at_standstill},
        {0x60E3, 0x1F, "", "支持的回零方式 31", 0x031F, 0, u16, "", 1, never, now},
    };
    static_assert(std::size(rows) >= 30);
    for (const auto& row : rows) {
        const auto* p = at(row.index, row.sub);
        ASSERT_NE(p, nullptr) << row.chinese;
        SCOPED_TRACE(row.chinese);
        EXPECT_EQ(p->parameter, row.number);
        EXPECT_EQ(p->chinese, row.chinese);
        EXPECT_EQ(p->value, row.value);
        const std::int64_t least = p->is_signed ? -(std::int64_t{1} << (p->bits - 1)) : 0;
        const std::int64_t most = (std::int64_t{1} << (p->bits - (p->is_signed ? 1 : 0))) - 1;
        EXPECT_EQ(p->minimum.value_or(least), row.minimum);  // a range of the whole type needs no words
        EXPECT_EQ(p->maximum.value_or(most), row.maximum);
        EXPECT_EQ(p->unit, row.unit);
        EXPECT_DOUBLE_EQ(p->scale, row.scale);
        EXPECT_EQ(p->change, row.change);
        EXPECT_EQ(p->effect, row.effect);
    }
}

TEST(Sv33EParameters, AreObjectsOfTheDictionaryToo) {
    std::set<std::pair<std::uint16_t, std::uint8_t>> objects;
    for (const auto& o : sv33e().device->objects) objects.insert({o.index, o.sub});
    EXPECT_EQ(objects.size(), parameters().size());
    for (const auto& p : parameters()) EXPECT_EQ(objects.count({p.address.index, p.address.sub}), 1u) << p.name;
}

TEST(Sv33EParameters, AreStoredByEachWriteUnlessP0510SaysNo) {
    const auto& profile = *sv33e().profile;
    EXPECT_EQ(profile.storage.way, axes::ParameterStorage::each_write);  // 7.2 P05.10 = 3 from the factory
    EXPECT_EQ(profile.storage.switched_by.index, 0x2005);
    EXPECT_EQ(profile.storage.switched_by.sub, 0x0B);
}

TEST(Sv33EMotion, EachModeHasItsShortestCycle) {
    const auto& profile = *sv33e().profile;  // table of 3.4.3(1)
    EXPECT_EQ(profile.minimum_cycle_csp, 1ms);
    EXPECT_EQ(profile.minimum_cycle_csv, 500us);
    EXPECT_EQ(profile.minimum_cycle_cst, 125us);
}

TEST(Sv33EAlarms, EachHasItsOwnCodeAndDetailAndSaysWhereTheManualHasIt) {
    std::set<std::pair<std::uint16_t, std::uint32_t>> seen;
    std::set<std::string> panels;
    for (const auto& alarm : sv33e().profile->alarms) {
        EXPECT_TRUE(seen.insert({alarm.code, alarm.detail}).second) << alarm.panel;
        EXPECT_TRUE(panels.insert(alarm.panel).second) << alarm.panel;
        EXPECT_EQ(alarm.section, alarm.warning ? "5.5" : "5.4") << alarm.panel;
        EXPECT_FALSE(alarm.cause.empty()) << alarm.panel;
        // The panel shows E.mmm or A.mmm, mmm the main code in hexadecimal (5.1): what P21.08 holds.
        unsigned main_code = 0;
        ASSERT_EQ(std::sscanf(alarm.panel.c_str(), alarm.warning ? "A.%3X" : "E.%3X", &main_code), 1) << alarm.panel;
        EXPECT_EQ(alarm.detail, main_code) << alarm.panel;
    }
    // Table 5-2 has 72 rows, E.228 twice; table 5-3 has 13.
    EXPECT_EQ(panels.size(), 71u + 13u);
}

TEST(Sv33EAlarms, OnlyTheseNeedAPowerCycle) {
    // The rows of table 5-2 marked with a cross.
    const std::set<std::string> crossed{"E.010", "E.011", "E.012", "E.013", "E.014", "E.015", "E.016", "E.017", "E.018", "E.019",
                                        "E.210", "E.211", "E.212", "E.213", "E.214", "E.910", "E.911", "E.912", "E.913", "E.914"};
    std::set<std::string> ours;
    for (const auto& alarm : sv33e().profile->alarms)
        if (!alarm.resettable) ours.insert(alarm.panel);
    EXPECT_EQ(ours, crossed);
}

TEST(Sv33EHazards, NameTheFactoryValuesThatTakeDaysAndWhatToWrite) {
    const auto& hazards = sv33e().profile->hazards;
    const auto names = [&](HazardCondition when, std::uint16_t index) {
        return std::any_of(hazards.begin(), hazards.end(), [&](const auto& h) {
            return h.when == when && std::any_of(h.objects.begin(), h.objects.end(), [&](const auto& o) { return o.index == index; });
        });
    };
    EXPECT_TRUE(names(HazardCondition::not_written, 0x6085));  // 7.3: 100 counts/s2
    EXPECT_TRUE(names(HazardCondition::not_written, 0x6084));
    EXPECT_TRUE(names(HazardCondition::not_set_to, 0x2005));  // 5.5 A.427
    EXPECT_TRUE(names(HazardCondition::mapped, 0x60FE));
    for (const auto& hazard : hazards) {
        EXPECT_FALSE(hazard.section.empty()) << hazard.text;
        EXPECT_FALSE(hazard.remedy.empty()) << hazard.text;
        for (const auto& object : hazard.objects)
            EXPECT_NE(at(object.index, object.sub), nullptr) << std::hex << object.index << ":" << int{object.sub};
    }
}

}  // namespace
}  // namespace taktwerk::config
