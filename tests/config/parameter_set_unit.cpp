// Parameter sets of a drive: written and read back, and what a set must not hold.

#include "config/drive_file/parameter_set.hpp"

#include <gtest/gtest.h>

namespace taktwerk::config {
namespace {

axes::DriveProfile profile() {
    axes::DriveProfile out;
    out.name = "some-drive";
    axes::DriveParameter p;
    p.address = {0x2005, 0x0E};
    p.parameter = "P05.13";
    p.name = "brake release";
    p.unit = "ms";
    p.minimum = 0, p.maximum = 500;
    out.parameters.push_back(p);
    p = {};
    p.address = {0x6099, 2};
    p.name = "homing speed";
    p.bits = 32;
    p.scale = 0.1;
    out.parameters.push_back(p);
    p = {};
    p.address = {0x1011, 1};
    p.name = "restore: everything";
    p.action = true;
    out.parameters.push_back(p);
    p = {};
    p.address = {0x6041, 0};
    p.name = "status word";
    p.change = axes::ParameterChange::never;
    out.parameters.push_back(p);
    return out;
}

std::vector<Error> errors(std::string_view text) {
    const auto drive = profile();
    auto read = parse_parameter_set("set.yaml", text, drive);
    if (auto* found = std::get_if<std::vector<Error>>(&read)) return *found;
    return {};
}

TEST(ParameterSet, WhatIsWrittenReadsBack) {
    const auto drive = profile();
    const ParameterSet set{"some-drive", "x_drive, it's saved", {{&drive.parameters[0], 250}, {&drive.parameters[1], 12345}}};
    const auto text = text_of(set);
    EXPECT_NE(text.find("P05.13: 250 ms"), std::string::npos) << text;
    EXPECT_NE(text.find("'6099h:02': 1234.5"), std::string::npos) << text;

    const auto read = parse_parameter_set("set.yaml", text, drive);
    ASSERT_TRUE(std::holds_alternative<ParameterSet>(read)) << std::get<std::vector<Error>>(read).front().text();
    const auto& again = std::get<ParameterSet>(read);
    EXPECT_EQ(again.comment, "x_drive, it's saved");
    ASSERT_EQ(again.values.size(), 2u);
    EXPECT_EQ(again.values[0].parameter, &drive.parameters[0]);
    EXPECT_EQ(again.values[0].raw, 250);
    EXPECT_EQ(again.values[1].raw, 12345);
}

TEST(ParameterSet, AnEmptySetIsASet) {
    const auto drive = profile();
    EXPECT_TRUE(std::holds_alternative<ParameterSet>(parse_parameter_set("set.yaml", text_of({"some-drive", "", {}}), drive)));
}

TEST(ParameterSet, AllProblemsAreNamedAtTheirPlace) {
    const auto found = errors(
        "version: 1\ndrive: some-drive\nparameters:\n  P05.31: 1 ms\n  P05.13: 501 ms\n  '6099h:02': fast\n  '1011h:01': 1\n  6041h: 3\n");
    ASSERT_EQ(found.size(), 5u);
    const std::vector<std::string> codes{"drive.no_parameter", "drive.out_of_range", "drive.value", "drive.no_setting", "drive.no_setting"};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(found[i].code, codes[i]) << found[i].text();
        EXPECT_EQ(found[i].subject, "set.yaml:" + std::to_string(4 + i) + ":3") << found[i].text();
    }
    EXPECT_NE(found[0].remedy.find("P05.13"), std::string::npos);
}

TEST(ParameterSet, ASetOfAnotherDriveIsRefusedAsAWhole) {
    const auto found = errors("version: 1\ndrive: other\nparameters: {nonsense: 1}\n");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].code, "drive.other_set");
}

TEST(ParameterSet, WhatIsNoSetIsAnError) {
    EXPECT_FALSE(errors("").empty());
    EXPECT_FALSE(errors("version: 1\ndrive: some-drive\n").empty());
    EXPECT_FALSE(errors("version: 1\ndrive: some-drive\nparameters: [1, 2]\n").empty());
    EXPECT_FALSE(errors("version: 2\ndrive: some-drive\nparameters: {}\n").empty());
    EXPECT_FALSE(errors("version: 1\ndrive: some-drive\nparameters:\n  P05.13: [1]\n").empty());
}

}  // namespace
}  // namespace taktwerk::config
