// Device files: every one that is shipped loads and can stand on a bus; and what is wrong in one is said with its place.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <tuple>

#include "config/device_file/device_loader.hpp"
#include "config/machine_file/machine_loader.hpp"

namespace taktwerk::config {
namespace {

using runtime::IoDirection;
using testing::HasSubstr;

const std::string tree = TAKTWERK_SOURCE_DIR;

std::string one_line_each(const std::vector<Error>& errors) {
    std::string out;
    for (const auto& error : errors) out += error.text() + "\n";
    return out;
}

std::vector<std::string> shipped() {
    auto names = file_names({tree + "/config/devices"});
    for (auto& name : names) std::ranges::replace(name, '-', '_');  // what GoogleTest takes for a name
    return names;
}

std::string path_of(std::string name) {
    if (!std::filesystem::exists(tree + "/config/devices/" + name + ".yaml")) std::ranges::replace(name, '_', '-');
    return tree + "/config/devices/" + name + ".yaml";
}

LoadedDevice load_or_fail(const std::string& path) {
    auto loaded = load_device(path);
    if (const auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        ADD_FAILURE() << one_line_each(*errors);
        return {};
    }
    return std::move(std::get<LoadedDevice>(loaded));
}

class ShippedDevice : public testing::TestWithParam<std::string> {};

TEST_P(ShippedDevice, LoadsAndEveryChannelLiesInItsProcessData) {
    const auto device = load_or_fail(path_of(GetParam()));
    ASSERT_NE(device.device, nullptr);
    EXPECT_FALSE(device.source.empty());
    std::set<std::pair<bool, std::string>> names;
    std::set<std::tuple<bool, std::uint16_t, std::uint8_t>> places;
    for (const auto& channel : device.channels) {
        const bool input = channel.direction == IoDirection::input;
        EXPECT_TRUE(names.emplace(input, channel.name).second) << channel.name << " stands twice";
        EXPECT_TRUE(places.emplace(input, channel.index, channel.sub).second) << channel.name << " is another channel as well";
    }
    // As a machine's only slave, or behind a coupler: the bus finds nothing wrong with it.
    ecat::BusConfig bus;
    ecat::SlaveConfig slave;
    slave.name = "it";
    slave.device = device.device;
    slave.position = 0;
    bus.slaves.push_back(slave);
    EXPECT_EQ(one_line_each(ecat::check(bus)), "");
}
INSTANTIATE_TEST_SUITE_P(All, ShippedDevice, testing::ValuesIn(shipped()), [](const auto& info) { return info.param; });

TEST(Devices, AChannelKnowsWhereItLiesAndWhatItsNumberMeans) {
    const auto device = load_or_fail(tree + "/config/devices/el3064.yaml");
    const auto* second = find_channel(device, IoDirection::input, "2");
    ASSERT_NE(second, nullptr);
    EXPECT_EQ(second, find_channel(device, IoDirection::input, "ai2"));
    EXPECT_EQ(second->index, 0x6010);
    EXPECT_EQ(second->sub, 0x11);
    EXPECT_EQ(second->unit, "V");
    EXPECT_NEAR(second->line.value_of(32767), 10, 1e-12);
    ASSERT_EQ(second->status.size(), 3u);
    EXPECT_EQ(find_channel(device, IoDirection::output, "ai2"), nullptr);
    EXPECT_EQ(find_channel(device, IoDirection::input, "5"), nullptr);
}

/// A device file with one 16-bit input; `channel` is the section of its only channel.
std::string device_with(const std::string& channel) {
    const auto path = std::filesystem::path(testing::TempDir()) / "probe.yaml";
    std::ofstream(path) << "version: 1\nname: probe\nvendor: nobody\ntitle: a probe\nsource: this test\nchecked: inferred\n"
                           "identity: { vendor: 1, product: 2 }\n"
                           "sync_managers:\n  - { use: inputs, start: 0x1000, control: 0 }\n"
                           "pdo:\n  tx:\n    - { pdo: 1A00h, objects: [6000h:01/16] }\n"
                           "channels:\n  a: "
                        << channel << "\n";
    return path.string();
}

std::string errors_of(const std::string& path) {
    auto loaded = load_device(path);
    const auto* errors = std::get_if<std::vector<Error>>(&loaded);
    return errors ? one_line_each(*errors) : std::string{};
}

TEST(Devices, WhatIsWrongInAFileIsSaidWithItsPlace) {
    EXPECT_EQ(errors_of(device_with("{ input: 6000h:01, type: I16 }")), "") << "the positive control";
    EXPECT_THAT(errors_of(device_with("{ input: 6000h:02 }")), HasSubstr("probe.yaml:14:3: no PDO from the device carries 6000h:02"));
    EXPECT_THAT(errors_of(device_with("{ output: 6000h:01 }")), HasSubstr("no PDO to the device carries 6000h:01"));
    EXPECT_THAT(errors_of(device_with("{ type: I16 }")), HasSubstr("needs either `input` or `output`"));
    EXPECT_THAT(errors_of(device_with("{ input: 6000h:01, counts: [0, 100] }")), HasSubstr("`counts` and `value` belong together"));
    EXPECT_THAT(errors_of(device_with("{ input: 6000h:01, counts: [0, 100], value: [0, 10] }")), HasSubstr("`value` has no unit"));
    EXPECT_THAT(errors_of(device_with("{ input: 6000h:01, counts: [0, 100], value: [0 V, 10 A] }")),
                HasSubstr("different units: 'V' and 'A'"));
    EXPECT_THAT(errors_of(device_with("{ input: 6000h:01, counts: [5, 5], value: [0 V, 10 V] }")), HasSubstr("are the same"));
    EXPECT_THAT(errors_of(device_with("{ input: 6000h:01, error: 6000h:09 }")), HasSubstr("no PDO from the device carries 6000h:09"));
}

/// The points of a machine with el3064 as `ai` and el4034 as `ao`.
LoadResult machine_with(const std::string& io) {
    LoadOptions options;
    options.device_dirs = {tree + "/config/devices"};
    options.drive_dirs = {tree + "/config/drives"};
    return load_machine_text("probe.yaml",
                             "version: 1\nname: probe\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n"
                             "    - { name: ai, device: el3064 }\n    - { name: ao, device: el4034 }\n"
                             "    - { name: up, device: el4002 }\n    - { name: do, device: el2008 }\n    - { name: di, device: el1008 }\n"
                             "    - { name: enc, device: el5101 }\nio:\n" +
                                 io,
                             options);
}

runtime::IoPoint point_of(const std::string& io) {
    auto loaded = machine_with(io);
    if (const auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        ADD_FAILURE() << one_line_each(*errors);
        return {};
    }
    return std::get<LoadedMachine>(loaded).machine.io.front();
}

std::string problem_of(const std::string& io) {
    auto loaded = machine_with(io);
    const auto* errors = std::get_if<std::vector<Error>>(&loaded);
    return errors ? one_line_each(*errors) : std::string{};
}

TEST(PointsOfDevices, AScaleStandsBehindThatOfTheChannel) {
    const auto point = point_of(
        "  inputs:\n    p: { slave: ai, channel: ai1, scale: { from: [2 V, 10 V], to: [0 bar, 16 bar] }, limits: [1 bar, 15 bar], "
        "filter: 20 ms, simulated: 8 bar }\n");
    EXPECT_EQ(point.unit, "bar");
    EXPECT_NEAR(point.line.value_of(32767), 16, 1e-9);
    EXPECT_NEAR(point.line.value_of(0), -4, 1e-9) << "0 V is 2 V below 0 bar";
    ASSERT_TRUE(point.limits);
    EXPECT_EQ(point.limits->high, 15);
    EXPECT_EQ(point.filter, std::chrono::milliseconds{20});
    EXPECT_EQ(point.simulated, 19660) << "8 bar are 6 V, 0.6 * 32767 counts";
    EXPECT_EQ(point.status.size(), 3u);
}

TEST(PointsOfDevices, RawNumbersMayBeScaledInstead) {
    const auto point =
        point_of("  outputs:\n    v: { slave: ao, channel: 2, scale: { from: [0, 32767], to: [0 %, 100 %] }, safe: 50 % }\n");
    EXPECT_EQ(point.index, 0x7010);
    EXPECT_EQ(point.unit, "%");
    EXPECT_EQ(point.safe_value, 16384);
}

TEST(PointsOfDevices, WhatDoesNotFitIsRefusedWithItsPlace) {
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai7 }\n"),
                HasSubstr("probe.yaml:15:21: slave 'ai' (el3064) has no input channel 'ai7' (there is: ai1, ai2, ai3, ai4)"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: 7 }\n"), HasSubstr("slave 'ai' has 4 inputs, there is no channel 7"));
    EXPECT_THAT(problem_of("  outputs:\n    p: { slave: ai, channel: ai1 }\n"), HasSubstr("has no output channel 'ai1' (there is: none)"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, limits: [0 bar, 1 bar] }\n"),
                HasSubstr("`limits` is in bar, and the point in V"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, limits: [0, 1] }\n"),
                HasSubstr("`limits` has no unit, and the point is in V"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, limits: [2 V, 1 V] }\n"), HasSubstr("not below the upper one"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, scale: { from: [4 mA, 20 mA], to: [0 bar, 1 bar] } }\n"),
                HasSubstr("the channel is in V, and `from` in mA"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, scale: { from: [0 V, 10 V], to: [0, 1] } }\n"),
                HasSubstr("`to` has no unit"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1 }\n    q: { slave: ai, channel: 1 }\n"),
                HasSubstr("channel 1 of 'ai' is already 'p'"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, simulated: 1.5 }\n"),
                HasSubstr("1.5 for `simulated` is no whole number"));
}

// 15 V on 16 bits that begin anew beyond 10 V would be -5 V. EL4002: 0 to 10 V.
TEST(PointsOfDevices, WhatTheChannelCannotGiveIsRefusedWithItsPlace) {
    EXPECT_THAT(problem_of("  outputs:\n    v: { slave: ao, channel: ao1, safe: 15 V }\n"),
                HasSubstr("probe.yaml:15:35: 15 V for `safe` is beyond what the channel gives: -10.0003 V to 10 V"));
    EXPECT_THAT(problem_of("  outputs:\n    v: { slave: ao, channel: ao1, safe: 40000 }\n"),
                HasSubstr("40000 for `safe` is beyond what the channel gives: -32768 to 32767"));
    EXPECT_THAT(problem_of("  outputs:\n    v: { slave: up, channel: ao1, safe: -1 V }\n"),
                HasSubstr("-1 V for `safe` is beyond what the channel gives: 0 V to 10 V"));
    EXPECT_THAT(problem_of("  outputs:\n    v: { slave: up, channel: ao1, scale: { from: [0 V, 10 V], to: [0 %, 100 %] }, safe: 120 % }\n"),
                HasSubstr("120 % for `safe` is beyond what the channel gives: 0 % to 100 %"));
    EXPECT_THAT(problem_of("  outputs:\n    v: { slave: up, channel: ao1, scale: { from: [0, 32767], to: [100 %, 0 %] }, safe: 120 % }\n"),
                HasSubstr("0 % to 100 %"))
        << "a line that falls";
    EXPECT_THAT(problem_of("  outputs:\n    v: { slave: do, channel: out1, safe: 5 }\n"),
                HasSubstr("5 for `safe` is beyond what the channel gives: 0 to 1"));
    EXPECT_THAT(problem_of("  outputs:\n    v: { slave: enc, channel: set_value1, safe: -1 }\n"), HasSubstr("0 to 65535"));
    EXPECT_THAT(problem_of("  inputs:\n    v: { slave: ai, channel: ai1, simulated: 20 V }\n"),
                HasSubstr("20 V for `simulated` is beyond what the channel shows"));
    for (const char* most : {"10 V", "-10 V", "32767", "-32768"}) {
        const auto point = point_of(fmt::format("  outputs:\n    v: {{ slave: ao, channel: ao1, safe: {} }}\n", most));
        EXPECT_GE(std::abs(point.safe_value), 32767) << most;
    }
}

// What a program writes is cut off at what the terminal gives, before the bus is there and after.
TEST(PointsOfDevices, WhatIsWrittenIsCutOffAtWhatTheChannelGives) {
    const auto both_ways = point_of("  outputs:\n    v: { slave: ao, channel: ao1 }\n").line;
    EXPECT_EQ(both_ways.raw_of(15), 32767);
    EXPECT_EQ(both_ways.raw_of(-15), -32768);
    const auto upwards = point_of("  outputs:\n    v: { slave: up, channel: ao1 }\n").line;
    EXPECT_EQ(upwards.raw_of(-5), 0);
    EXPECT_FALSE(upwards.holds(-0.01));
    EXPECT_TRUE(upwards.holds(10));
}

TEST(PointsOfDevices, WhatDoesNothingToABitOrANumberIsRefused) {
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: di, channel: in1, filter: 20 ms }\n"),
                HasSubstr("probe.yaml:15:35: the point is one bit, which has no value between 0 and 1 to filter"));
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, inverted: true }\n"),
                HasSubstr("probe.yaml:15:35: the point has 16 bits, and only one bit can be inverted"));
    EXPECT_EQ(
        problem_of("  inputs:\n    p: { slave: di, channel: in1, inverted: true }\n    q: { slave: ai, channel: ai1, filter: 20 ms }\n"),
        "");
    EXPECT_THAT(problem_of("  inputs:\n    p: { slave: ai, channel: ai1, limits: [11 V, 20 V] }\n"),
                HasSubstr("no value of the input lies between them"));
}

TEST(PointsOfDevices, AnUnknownDeviceIsSaidWithTheNearest) {
    LoadOptions options;
    options.device_dirs = {tree + "/config/devices"};
    options.drive_dirs = {tree + "/config/drives"};
    const auto errors = [&](const std::string& device) {
        auto loaded = load_machine_text(
            "probe.yaml",
            "version: 1\nname: probe\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n    - { name: a, device: " + device + " }\n",
            options);
        const auto* found = std::get_if<std::vector<Error>>(&loaded);
        return found ? one_line_each(*found) : std::string{};
    };
    EXPECT_EQ(errors("el3064"), "");
    EXPECT_THAT(errors("el3064x"), HasSubstr("did you mean `el3064`?"));
    EXPECT_THAT(errors("sv33-e"), HasSubstr("write `profile: sv33-e`"));
}

}  // namespace
}  // namespace taktwerk::config
