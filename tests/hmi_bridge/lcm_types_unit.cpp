// The LCM types must not change unnoticed, and only harmless URLs and combinations are taken.
#include <gmock/gmock.h>

#include <cctype>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "hmi_bridge/command_words.hpp"
#include "hmi_bridge/hmi_config.hpp"
#include "hmi_bridge/lcm/channels.hpp"
#include "hmi_bridge/lcm/lcm_url.hpp"
#include "taktwerk_lcm/acknowledge_v1_t.hpp"
#include "taktwerk_lcm/alarm_list_v1_t.hpp"
#include "taktwerk_lcm/axis_holder_v1_t.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "taktwerk_lcm/command_event_v1_t.hpp"
#include "taktwerk_lcm/command_v1_t.hpp"
#include "taktwerk_lcm/cycle_statistics_v1_t.hpp"
#include "taktwerk_lcm/heartbeat_v1_t.hpp"
#include "taktwerk_lcm/io_state_v1_t.hpp"
#include "taktwerk_lcm/machine_state_v1_t.hpp"
#include "taktwerk_lcm/program_values_v1_t.hpp"
#include "taktwerk_lcm/whole_state_v1_t.hpp"
#include "taktwerk_lcm/whole_state_v2_t.hpp"
#include "taktwerk_lcm/whole_state_v3_t.hpp"
#include "taktwerk_lcm/whole_state_v4_t.hpp"
#include "taktwerk_lcm/whole_state_v5_t.hpp"

namespace taktwerk::hmi {
namespace {

using namespace taktwerk_lcm;
using runtime::Answer;

// What a message means is fixed by these numbers: a type that changes gets a new name (_v2_t) and this table a new line. The
// fingerprints are lcm-gen's own; the table only keeps them from changing unnoticed.
TEST(LcmTypes, FingerprintsDoNotChange) {
    const std::vector<std::pair<std::string, std::pair<std::int64_t, std::uint64_t>>> table{
        {"acknowledge_v1_t", {acknowledge_v1_t::getHash(), 0xa6da1e312ee63c20u}},
        {"alarm_v1_t", {alarm_v1_t::getHash(), 0x5bd95d0177b99698u}},
        {"alarm_list_v1_t", {alarm_list_v1_t::getHash(), 0x66c1467ef7d317eau}},
        {"axis_holder_v1_t", {axis_holder_v1_t::getHash(), 0xcf43c84ef30367bcu}},
        {"command_event_v1_t", {command_event_v1_t::getHash(), 0x6e3562bd255111bbu}},
        {"axis_state_v1_t", {axis_state_v1_t::getHash(), 0x5382e5f78658f4bau}},
        {"command_v1_t", {command_v1_t::getHash(), 0x49f677269204d580u}},
        {"cycle_statistics_v1_t", {cycle_statistics_v1_t::getHash(), 0xc75e584d828afcb5u}},
        {"heartbeat_v1_t", {heartbeat_v1_t::getHash(), 0x33e13d4ee4af763eu}},
        {"io_state_v1_t", {io_state_v1_t::getHash(), 0x74ff9bc328461ef9u}},
        {"machine_state_v1_t", {machine_state_v1_t::getHash(), 0x29e7c8d11954642fu}},
        {"program_values_v1_t", {program_values_v1_t::getHash(), 0xbf80812da8872cfbu}},
        {"whole_alarm_v1_t", {whole_alarm_v1_t::getHash(), 0xcf6eb015cf1fcdc6u}},
        {"whole_axis_v1_t", {whole_axis_v1_t::getHash(), 0xf358ba56d75e4636u}},
        {"whole_bus_v1_t", {whole_bus_v1_t::getHash(), 0x549a343a648664adu}},
        {"whole_event_v1_t", {whole_event_v1_t::getHash(), 0xf04824e4569a9217u}},
        {"whole_force_v1_t", {whole_force_v1_t::getHash(), 0x1494e34d203bbc60u}},
        {"whole_giver_v1_t", {whole_giver_v1_t::getHash(), 0xb85550231ca38212u}},
        {"whole_group_v1_t", {whole_group_v1_t::getHash(), 0x8f8b29d217738476u}},
        {"whole_group_member_v1_t", {whole_group_member_v1_t::getHash(), 0x97a0ff968f2e58a5u}},
        {"whole_measure_v1_t", {whole_measure_v1_t::getHash(), 0xc625e1affe951bf1u}},
        {"whole_point_v1_t", {whole_point_v1_t::getHash(), 0x8c90734f0868e5a8u}},
        {"whole_program_v1_t", {whole_program_v1_t::getHash(), 0xea99b3b421c32f1eu}},
        {"whole_slave_v1_t", {whole_slave_v1_t::getHash(), 0xa3decc79206f3321u}},
        {"whole_state_v1_t", {whole_state_v1_t::getHash(), 0xf48ecc8775cb588eu}},
        {"whole_state_v2_t", {whole_state_v2_t::getHash(), 0xaa5e1140b31fb16au}},
        {"whole_state_v3_t", {whole_state_v3_t::getHash(), 0xf5a7ee78c2284487u}},
        {"whole_state_v4_t", {whole_state_v4_t::getHash(), 0xf13b94f6195835a9u}},
        {"whole_group_v2_t", {whole_group_v2_t::getHash(), 0x8d54fd10c30b7d07u}},
        {"whole_state_v5_t", {whole_state_v5_t::getHash(), 0x95359926ef651d49u}},
        {"whole_group_v3_t", {whole_group_v3_t::getHash(), 0x41462f49dbc6d475u}},
        {"whole_refusal_v1_t", {whole_refusal_v1_t::getHash(), 0x97747b996ea2fff6u}},
        {"whole_event_v2_t", {whole_event_v2_t::getHash(), 0x0e53f4c3a8e5ae79u}},
        {"whole_group_frame_v1_t", {whole_group_frame_v1_t::getHash(), 0xcf690152a10afeaeu}},
        {"whole_statistics_v1_t", {whole_statistics_v1_t::getHash(), 0x5b85a89c093cd5e5u}},
        {"whole_statistics_v2_t", {whole_statistics_v2_t::getHash(), 0x366d4af8a7e70253u}},
        {"whole_task_v1_t", {whole_task_v1_t::getHash(), 0x00bc836482d1411fu}},
        {"whole_value_v1_t", {whole_value_v1_t::getHash(), 0xf053d7cc919c68f6u}},
    };
    ASSERT_FALSE(table.empty());
    for (const auto& [name, hashes] : table)
        EXPECT_EQ(static_cast<std::uint64_t>(hashes.first), hashes.second) << name << std::hex << " 0x" << hashes.first;
}

TEST(LcmTypes, ConstantsAreTheNumbersOfTheCommandTable) {
    std::ifstream file(std::string(TAKTWERK_SOURCE_DIR) + "/hmi_bridge/lcm/command_v1_t.lcm");
    std::stringstream text;
    text << file.rdbuf();
    const auto all = text.str();
    std::map<std::string, int> kinds;
    const std::regex constant("KIND_([A-Z_]+) = ([0-9]+)");
    for (std::sregex_iterator match(all.begin(), all.end(), constant), end; match != end; ++match)
        kinds[(*match)[1]] = std::stoi((*match)[2]);
    ASSERT_EQ(kinds.size(), command_words.size());
    for (const auto& entry : command_words) {
        std::string upper(entry.word);
        for (auto& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        EXPECT_EQ(kinds[upper], static_cast<int>(entry.kind)) << upper;
    }
    // The numbers themselves, as HMIs have compiled them in.
    EXPECT_EQ(command_v1_t::KIND_JOG, 7);
    EXPECT_EQ(command_v1_t::KIND_STOP, 9);
    EXPECT_EQ(command_v1_t::KIND_SHUTDOWN, 17);
    EXPECT_EQ(command_v1_t::MODE_AUTOMATIC, 2);
    EXPECT_EQ(acknowledge_v1_t::ANSWER_DUPLICATE, static_cast<int>(Answer::duplicate));
    EXPECT_EQ(acknowledge_v1_t::ANSWER_NO_CONTROL, static_cast<int>(Answer::no_control));
    EXPECT_EQ(acknowledge_v1_t::ANSWER_REFUSED_BY_AXIS, static_cast<int>(Answer::refused_by_axis));
}

// Generated decoders compute sizes in 32 bits: with a count or a string length from the wire they read beyond the message.
TEST(LcmTypes, WhatTheRuntimeReceivesHasFixedSize) {
    std::ifstream file(std::string(TAKTWERK_SOURCE_DIR) + "/hmi_bridge/lcm/command_v1_t.lcm");
    ASSERT_TRUE(file);
    for (std::string line; std::getline(file, line);) {
        line = line.substr(0, line.find("//"));
        EXPECT_EQ(line.find("string"), std::string::npos) << line;
        EXPECT_FALSE(std::regex_search(line, std::regex(R"(\[[^0-9])"))) << line;
    }
}

TEST(LcmUrls, OnlyWhatDoesNotBlockIsTakenAndTheTtlIsAlwaysSaid) {
    EXPECT_EQ(parse_lcm_url("udpm://239.255.76.67:7667")->text, "udpm://239.255.76.67:7667?ttl=0");
    EXPECT_EQ(parse_lcm_url("udpm://")->text, "udpm://239.255.76.67:7667?ttl=0");
    EXPECT_EQ(parse_lcm_url("udpm://224.1.2.3:9?ttl=1&recv_buf_size=2097152")->text, "udpm://224.1.2.3:9?ttl=1&recv_buf_size=2097152");
    EXPECT_TRUE(parse_lcm_url("udpm://239.255.76.67:7667?ttl=1")->leaves_host());
    for (const auto* url : {"", "tcpq://localhost:7700", "file://x.log", "mpudpm://239.255.76.67:7667", "udpm://10.0.0.1:7667",
                            "udpm://239.255.76.67:0", "udpm://239.255.76.67:70000", "udpm://239.255.76.67:7667?ttl=256",
                            "udpm://239.255.76.67:7667?ttl=", "udpm://239.255.76.67:7667?tll=0"})
        EXPECT_FALSE(parse_lcm_url(url)) << url;
    using namespace std::string_view_literals;
    EXPECT_FALSE(parse_lcm_url("udpm://239.255.76.67\0.example"sv)) << "the system would read only what stands before the NUL";
}

TEST(HmiConfigCheck, CommandsNeverLeaveTheHost) {
    HmiConfig config;
    EXPECT_TRUE(check(config).empty());
    config.lcm_url = "udpm://239.255.76.67:7667?ttl=1";
    EXPECT_TRUE(check(config).empty()) << "state may";
    config.lcm_commands = LcmCommands::local;
    ASSERT_EQ(check(config).size(), 1u);
    EXPECT_EQ(check(config)[0].code, "hmi.commands_leave_host");

    config = {};
    config.rate_hz = 0;
    config.lcm = false;
    config.lcm_required = true;
    config.lcm_commands = LcmCommands::local;
    EXPECT_EQ(check(config).size(), 3u) << "all at once";
}

TEST(ChannelNames, FitLcmAndAreNoRegularExpressions) {
    EXPECT_EQ(Channels("demo").axis_state(), "TAKTWERK_DEMO_AXIS_STATE");
    EXPECT_EQ(Channels("Zelle 7.*").command(), "TAKTWERK_ZELLE_7___COMMAND");
    EXPECT_LE(Channels(std::string(200, 'm')).cycle_statistics().size(), 63u);
}

}  // namespace
}  // namespace taktwerk::hmi
