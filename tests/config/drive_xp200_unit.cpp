// Facts of the XP200 as literals from its user manual V1.0; sections in the comments. Nothing here is taken from the file that is tested.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "config/drive_file/drive_loader.hpp"

namespace taktwerk::config {
namespace {

const LoadedDrive& xp200() {
    static const auto loaded = load_drive(TAKTWERK_SOURCE_DIR "/config/drives/xp200.yaml");
    if (const auto* errors = std::get_if<1>(&loaded)) throw std::runtime_error(errors->front().text());
    return std::get<0>(loaded);
}

const axes::DriveParameter* xp200_parameter(std::string_view name) {
    for (const auto& p : xp200().profile->parameters)
        if (p.parameter == name) return &p;
    return nullptr;
}

TEST(Xp200File, HasNoDictionaryAndAllParametersAndAlarms) {
    EXPECT_EQ(xp200().device, nullptr);
    // 113 in 5.1.1 to 5.1.3, Pr034 in 5.4.1, Pr181 to Pr183 in 9.2, Pr116 in 8.1, Pr119 in 3.3, Pr176 in 5.2; then 29 words of status in 9.5,
    // without the second encoder, the joined position and the reserved ones.
    EXPECT_EQ(xp200().profile->parameters.size(), 120u + 29u);
    EXPECT_EQ(xp200().profile->alarms.size(), 22u);  // 6.1
    EXPECT_EQ(std::count_if(xp200().profile->alarms.begin(), xp200().profile->alarms.end(), [](const auto& a) { return a.resettable; }),
              11);
}

TEST(Xp200File, EachParameterHasItsNumberAsAddressAndStandsOnce) {
    std::uint16_t last = 0;
    for (const auto& p : xp200().profile->parameters) {
        // 9.4: the number of a parameter is its address, 0 to 249; 9.5: status by function 03h from 1000h on.
        EXPECT_EQ(p.parameter, p.address.index < 250 ? fmt::format("Pr{:03}", p.address.index) : fmt::format("0x{:04X}", p.address.index));
        EXPECT_EQ(p.address.index >= 0x1000, p.section == "9.5") << p.parameter;
        EXPECT_TRUE(p.address.index > last || p.address.index == 0) << p.parameter;
        last = p.address.index;
        EXPECT_FALSE(p.chinese.empty() || p.name.empty() || p.section.empty()) << p.parameter;
        EXPECT_EQ(p.bits, 16);
    }
}

struct Row {
    const char* name;
    std::int64_t low, high, value;
    const char* unit;
    double scale;
};

TEST(Xp200File, RangesFactoryValuesAndUnits) {
    // Manual 5.1.1, 5.1.2, 5.1.3, 9.2.
    const Row rows[] = {
        {"Pr000", 0, 9999, 315, "", 1},
        {"Pr004", 0, 8, 0, "", 1},
        {"Pr005", 1, 3000, 50, "Hz", 1},
        {"Pr006", 1, 1000, 20, "ms", 1},
        {"Pr007", 1, 500, 25, "ms", 0.1},
        {"Pr009", 1, 1000, 40, "1/s", 1},
        {"Pr019", 5, 500, 35, "ms", 0.1},
        {"Pr025", 0, 3, 0, "", 1},
        {"Pr029", 1, 32767, 1, "", 1},
        {"Pr038", 0, 15, 6, "", 1},
        {"Pr046", 10, 3000, 300, "r/min/V", 1},
        {"Pr047", -15000, 15000, 0, "mV", 0.1},
        {"Pr060", 0, 10000, 100, "ms", 1},
        {"Pr061", 0, 10000, 100, "ms", 1},
        {"Pr063", 0, 10000, 1000, "ms", 1},
        {"Pr065", 0, 300, 300, "%", 1},
        {"Pr066", -300, 0, -300, "%", 1},
        {"Pr070", 1, 300, 140, "%", 1},
        {"Pr071", -300, -1, -140, "%", 1},
        {"Pr072", 1, 30000, 5000, "ms", 1},
        {"Pr075", 0, 6000, 3500, "r/min", 1},
        {"Pr078", 0, 5000, 1000, "r/min", 1},
        {"Pr080", 0, 32767, 400, "rev", 0.01},
        {"Pr082", 1, 32767, 2500, "lines", 1},
        {"Pr083", -3600, 3600, -230, "deg", 0.1},
        {"Pr097", 0, 33, 33, "", 1},
        {"Pr098", 0, 1, 0, "", 1},
        {"Pr100", -21, 21, 1, "", 1},
        {"Pr105", -21, 21, 21, "", 1},
        {"Pr108", -12, 12, 2, "", 1},
        {"Pr111", -12, 12, 8, "", 1},
        {"Pr120", 0, 11111, 0, "", 1},
        {"Pr125", 1, 1000, 5, "ms", 1},
        {"Pr136", 0, 1, 0, "", 1},
        {"Pr137", -5000, 5000, 0, "r/min", 1},
        {"Pr148", -300, 300, 0, "%", 1},
        {"Pr150", 0, 32767, 10, "counts", 1},
        {"Pr154", -5000, 5000, 500, "r/min", 1},
        {"Pr160", 0, 1000, 10, "r/min", 1},
        {"Pr164", 0, 1, 0, "", 1},
        {"Pr165", 0, 1000, 5, "r/min", 1},
        {"Pr166", 0, 5000, 500, "ms", 1},
        {"Pr169", 0, 5000, 500, "ms", 1},
        {"Pr181", -1, 247, -1, "", 1},
        {"Pr182", 0, 3, 2, "", 1},
        {"Pr183", 0, 5, 1, "", 1},
        {"Pr201", 1, 50, 4, "", 1},
        {"Pr204", 1, 4000, 60, "A", 0.1},
        {"Pr207", 1, 30000, 2500, "r/min", 1},
    };
    for (const auto& row : rows) {
        const auto* p = xp200_parameter(row.name);
        ASSERT_NE(p, nullptr) << row.name;
        EXPECT_EQ(p->minimum, row.low) << row.name;
        EXPECT_EQ(p->maximum, row.high) << row.name;
        EXPECT_EQ(p->value, row.value) << row.name;
        EXPECT_EQ(p->unit, row.unit) << row.name;
        EXPECT_DOUBLE_EQ(p->scale, row.scale) << row.name;
        EXPECT_EQ(p->is_signed, row.low < 0) << row.name;
    }
}

TEST(Xp200File, WhatCountsAfterARestartOnly) {
    // 3.6.4 Pr004; 5.4.1 Pr035, Pr038, Pr039; 3.7 Pr002; 9.3 Pr181 to Pr183.
    std::vector<int> numbers;
    for (const auto& p : xp200().profile->parameters)
        if (p.effect == axes::ParameterEffect::after_restart) numbers.push_back(p.address.index);
    EXPECT_EQ(numbers, (std::vector{2, 4, 35, 38, 39, 181, 182, 183}));
    EXPECT_EQ(xp200_parameter("Pr001")->change, axes::ParameterChange::never);  // 5.4.1
    EXPECT_EQ(xp200_parameter("Pr003")->change, axes::ParameterChange::never);
}

TEST(Xp200File, AlarmsByCode) {
    const auto alarm = [](int code) {
        const auto& all = xp200().profile->alarms;
        return *std::find_if(all.begin(), all.end(), [&](const auto& a) { return a.code == code; });
    };
    EXPECT_EQ(alarm(1).chinese, "超速");  // 6.1
    EXPECT_EQ(alarm(4).kind, axes::DriveAlarmKind::following_error);
    EXPECT_FALSE(alarm(3).resettable);
    EXPECT_TRUE(alarm(29).resettable);
    EXPECT_FALSE(alarm(33).resettable);
    std::vector<int> codes;
    for (const auto& a : xp200().profile->alarms) codes.push_back(a.code);
    EXPECT_EQ(codes, (std::vector{1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 20, 21, 23, 24, 29, 30, 31, 32, 33}));
}

}  // namespace
}  // namespace taktwerk::config
