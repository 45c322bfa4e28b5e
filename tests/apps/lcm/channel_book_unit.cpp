// Rates, types and losses of channels, and what `spy` and `play` make of them.
#include "apps/lcm/channel_book.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "apps/lcm/player.hpp"
#include "apps/lcm/spy_text.hpp"
#include "hmi_bridge/lcm_types/our_types.hpp"
#include "taktwerk_lcm/axis_state_v1_t.hpp"
#include "taktwerk_lcm/command_v1_t.hpp"
#include "taktwerk_lcm/heartbeat_v1_t.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using namespace std::chrono_literals;

template <class Message>
std::vector<std::byte> encoded(const Message& message) {
    std::vector<std::byte> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    return bytes;
}

std::vector<std::byte> heartbeat(std::int64_t seq) {
    taktwerk_lcm::heartbeat_v1_t message{};
    message.seq = seq;
    return encoded(message);
}

const hmi::TypeCatalog& ours() {
    static const auto catalog = hmi::our_types();
    return catalog;
}

TEST(ChannelBook, CountsRatesSizesAndTypes) {
    ChannelBook book(ours());
    for (int i = 0; i < 30; ++i) book.note("TAKTWERK_DEMO_HEARTBEAT", heartbeat(i), 1'000'000 + i * 100'000);  // 10 Hz
    book.note("OTHERS", std::vector<std::byte>(8, std::byte{0x11}), 3'000'000);
    book.note("SHORT", std::vector<std::byte>(3), 3'000'000);
    const auto rows = book.rows(3'900'000);
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].type, "0x1111111111111111");
    EXPECT_EQ(rows[1].type, "none");
    EXPECT_EQ(rows[2].type, "heartbeat_v1_t");
    EXPECT_DOUBLE_EQ(rows[2].rate, 10);
    EXPECT_EQ(rows[2].messages, 30u);
    EXPECT_EQ(rows[2].last_size, heartbeat(0).size());
    EXPECT_EQ(rows[2].last_utime, 3'900'000);
}

TEST(ChannelBook, ARateIsKnownFromTheFirstSecondOnAndFallsWithSilence) {
    ChannelBook book(ours());
    for (int i = 0; i < 5; ++i) book.note("A", {}, i * 20'000);
    EXPECT_DOUBLE_EQ(book.rows(80'000)[0].rate, 50);
    EXPECT_LE(book.rows(10'000'000)[0].rate, 0.5);
}

TEST(ChannelBook, WhatIsMissingInTheCountOfAMachineWasLost) {
    ChannelBook book(ours());
    book.note("TAKTWERK_DEMO_HEARTBEAT", heartbeat(7), 1);
    taktwerk_lcm::axis_state_v1_t axis{};
    axis.seq = 8;  // one count for all of its channels
    book.note("TAKTWERK_DEMO_AXIS_STATE", encoded(axis), 2);
    book.note("TAKTWERK_DEMO_HEARTBEAT", heartbeat(12), 3);
    book.note("TAKTWERK_OTHER_HEARTBEAT", heartbeat(1), 4);
    book.note("TAKTWERK_DEMO_HEARTBEAT", heartbeat(1), 5);  // it was started again
    book.note("TAKTWERK_DEMO_HEARTBEAT", heartbeat(2), 6);
    const auto machines = book.machines();
    ASSERT_EQ(machines.size(), 2u);
    EXPECT_EQ(machines[0].prefix, "TAKTWERK_DEMO_");
    EXPECT_EQ(machines[0].messages, 5u);
    EXPECT_EQ(machines[0].lost, 3u) << "9, 10, 11";
    EXPECT_EQ(machines[0].restarts, 1u);
    EXPECT_EQ(machines[1].lost, 0u);
    EXPECT_EQ(book.lost(), 3u);
}

TEST(ChannelBook, ChannelsThatSomebodyMakesUpAreBounded) {
    ChannelBook book(ours());
    for (std::size_t i = 0; i < ChannelBook::most_channels + 5; ++i) book.note("C" + std::to_string(i), {}, 1);
    EXPECT_EQ(book.rows(1).size(), ChannelBook::most_channels);
    EXPECT_EQ(book.unlisted(), 5u);
}

TEST(ChannelBook, OnlyStateChannelsOfOursHaveAMachine) {
    EXPECT_EQ(machine_prefix("TAKTWERK_DEMO_AXIS_STATE"), "TAKTWERK_DEMO_");
    EXPECT_EQ(machine_prefix("TAKTWERK_CELL_7_CYCLE_STATISTICS"), "TAKTWERK_CELL_7_");
    EXPECT_EQ(machine_prefix("TAKTWERK_DEMO_COMMAND"), "");
    EXPECT_EQ(machine_prefix("TAKTWERK_DEMO_ACKNOWLEDGE"), "") << "it counts by itself";
    EXPECT_EQ(machine_prefix("TAKTWERK_AXIS_STATE"), "");
    EXPECT_EQ(machine_prefix("IIWA_STATUS"), "");
}

TEST(SpyText, ShowsFieldsOfOursAndBytesOfOthers) {
    taktwerk_lcm::axis_state_v1_t axis{};
    axis.name = "x";
    axis.unit = "mm";
    axis.actual_position = 1.5;
    EXPECT_THAT(message_text(ours(), "TAKTWERK_DEMO_AXIS_STATE", encoded(axis)), HasSubstr("  actual_position: 1.5 mm\n"));
    const auto json = nlohmann::json::parse(message_json(ours(), "TAKTWERK_DEMO_AXIS_STATE", encoded(axis), 5));
    EXPECT_EQ(json["message"]["actual_position"], 1.5);
    EXPECT_EQ(json["type"], "axis_state_v1_t");

    const auto others = message_text(ours(), "C\x1B[2J", std::vector<std::byte>(10, std::byte{0x41}));
    EXPECT_THAT(others, HasSubstr("unknown type 0x4141414141414141"));
    EXPECT_THAT(others, HasSubstr("AAAAAAAAAA"));
    EXPECT_THAT(others, Not(HasSubstr("\x1B"))) << "a name of a channel commands no terminal";
    auto torn = encoded(axis);
    torn.pop_back();
    EXPECT_THAT(message_text(ours(), "A", torn), HasSubstr("a bad axis_state_v1_t"));
    EXPECT_EQ(nlohmann::json::parse(message_json(ours(), "A", torn, 5))["message"], nullptr);
}

TEST(Player, CommandsAreKnownByTheirChannelAndByTheirType) {
    LoggedMessage message;
    message.channel = "TAKTWERK_DEMO_COMMAND";
    EXPECT_TRUE(is_command(message, ours()));
    message.channel = "RENAMED";
    EXPECT_FALSE(is_command(message, ours()));
    message.data = encoded(taktwerk_lcm::command_v1_t{});
    EXPECT_TRUE(is_command(message, ours()));
}

TEST(Player, NothingIsPlayedIntoANetworkOrOverALiveMachine) {
    LogContent content;
    content.chosen["TAKTWERK_DEMO_HEARTBEAT"] = 3;
    const auto host = *hmi::parse_lcm_url("udpm://239.255.76.67:7667?ttl=0");
    const auto network = *hmi::parse_lcm_url("udpm://239.255.76.67:7667?ttl=1");
    EXPECT_FALSE(play_hazard(content, host, {}));
    EXPECT_FALSE(play_hazard(content, host, {"TAKTWERK_OTHER_HEARTBEAT"}));
    EXPECT_EQ(play_hazard(content, network, {})->code, "lcm.play_leaves_host");
    EXPECT_EQ(play_hazard(content, host, {"TAKTWERK_DEMO_HEARTBEAT"})->code, "lcm.play_over_live");
}

// An hour at 10 ms in which each step is rounded: counted from the start, the last one is due when it was said.
TEST(Player, IsDueByItsStampAndNothingAddsUp) {
    const Instant start{5s};
    const PlayClock as_it_was(start, 1'000'000, 1), thrice(start, 1'000'000, 3), at_once(start, 1'000'000, 0);
    EXPECT_EQ(as_it_was.due(1'000'000), start);
    EXPECT_EQ(as_it_was.due(1'010'000), start + 10ms);
    EXPECT_EQ(as_it_was.due(3'601'000'000), start + 3600s);
    EXPECT_EQ(thrice.due(3'601'000'000), start + 1200s);
    EXPECT_EQ(at_once.due(3'601'000'000), start);
    EXPECT_EQ(as_it_was.due(0), start) << "a stamp that goes back";
}

TEST(Player, APatternIsOfTheWholeName) {
    EXPECT_TRUE(std::regex_match("ANY", *name_pattern("")));
    EXPECT_FALSE(std::regex_match("TAKTWERK_DEMO_AXIS_STATE", *name_pattern("AXIS")));
    EXPECT_FALSE(name_pattern("(").has_value());
}

}  // namespace
}  // namespace taktwerk::apps
