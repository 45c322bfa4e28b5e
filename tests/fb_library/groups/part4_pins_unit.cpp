// The blocks of groups against the transcription of PLCopen Part 4 v2.0 (part4_pins.csv): every pin, its direction, its type and its place. The
// official tables were not at hand: docs/motion/group-decisions.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "fb_library/block_types.hpp"
#include "fb_library/groups/part4.hpp"

namespace taktwerk::fb {
namespace {

struct StandardPin {
    std::string name, direction, type, obligation, version;
};

/// By block, in the file's order. `versions`: which pins count.
std::map<std::string, std::vector<StandardPin>> transcription(const std::set<std::string>& versions) {
    std::ifstream file(std::string(TAKTWERK_SOURCE_DIR) + "/tests/fb_library/groups/part4_pins.csv");
    std::map<std::string, std::vector<StandardPin>> blocks;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        std::string block;
        StandardPin pin;
        std::getline(cells, block, ',');
        for (auto* cell : {&pin.name, &pin.direction, &pin.type, &pin.obligation, &pin.version}) std::getline(cells, *cell, ',');
        if (versions.contains(pin.version)) blocks[block].push_back(pin);
    }
    return blocks;
}
const std::set<std::string> v2{"v1+v2", "v2"}, v1{"v1"};

/// Those of v1.0 that have another name in v2.0.
bool renamed(const std::string& block) { return block.starts_with("MC_GroupReadActual"); }

std::string direction_of(const Pin& pin) {
    return pin.direction == PinDirection::in ? "in" : pin.direction == PinDirection::out ? "out" : "in_out";
}
bool same_type(const std::string& standard, std::string_view ours) {
    if (standard == "REAL") return ours == "LREAL";
    if (standard == "ARRAY OF REAL") return ours == "ARRAY OF LREAL";
    if (standard == "ARRAY[6] OF REAL") return ours == "ARRAY[6] OF LREAL";
    if (standard.starts_with('(')) return ours.starts_with("MC_");  // an enumeration whose name is not known
    if (standard == "WORD") return ours == "WORD" || ours == "UINT";
    return standard == ours;
}

// G-001, G-002
TEST(Part4Pins, EveryPinOfV2IsThereInItsOrderAndNoOther) {
    const auto standard = transcription(v2), old = transcription(v1);
    std::size_t compared = 0;
    for (const BlockType& type : group_block_types()) {
        const std::string name{type.name};
        const auto& from = renamed(name) ? old : standard;
        ASSERT_TRUE(from.contains(name)) << name;
        const auto& expected = from.at(name);
        ASSERT_EQ(type.pins.size(), expected.size()) << name;
        for (std::size_t i = 0; i < expected.size(); ++i, ++compared) {
            EXPECT_EQ(type.pins[i].name, expected[i].name) << name;
            EXPECT_EQ(direction_of(type.pins[i]), expected[i].direction) << name << '.' << expected[i].name;
            EXPECT_TRUE(same_type(expected[i].type, type.pins[i].type.name))
                << name << '.' << expected[i].name << ' ' << type.pins[i].type.name;
        }
    }
    EXPECT_GT(compared, 250u);
}

// G-001: the 68 blocks of v2.0 and the three renamed ones of v1.0 are offered, or their absence is said.
TEST(Part4Pins, EveryBlockIsOfferedOrSaidNotToBe) {
    auto names = transcription(v2);
    EXPECT_EQ(names.size(), 68u);
    for (const auto& [name, pins] : transcription(v1))
        if (renamed(name)) names[name];
    EXPECT_EQ(names.size(), 71u);
    std::set<std::string> refused;
    for (const auto& block : not_offered) {
        EXPECT_TRUE(refused.insert(std::string{block.block}).second) << block.block << " stands twice";
        EXPECT_TRUE(names.contains(std::string{block.block})) << block.block << " is no block of Part 4";
        EXPECT_TRUE(block.reason.starts_with("not_supported: ")) << block.block;
    }
    for (const auto& [name, pins] : names) EXPECT_NE(find_block_type(name) != nullptr, refused.contains(name)) << name;
}

// G-002
TEST(Part4Pins, EnumeratorsBeginWithMc) {
    for (const BlockType& type : group_block_types())
        for (const Pin& pin : type.pins)
            for (const auto value : pin.type.values) EXPECT_TRUE(value.starts_with("mc")) << pin.type.name << ' ' << value;
}

}  // namespace
}  // namespace taktwerk::fb
