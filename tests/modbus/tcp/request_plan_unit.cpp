// Channels merged into requests: limits of the Application Protocol V1.1b3, gaps, order, nothing cut in two.

#include "modbus/tcp/request_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace taktwerk::modbus::tcp {
namespace {

using ::testing::ElementsAre;
using Use = Channel::Use;

Channel channel_at(Table table, unsigned address, NumberType type = NumberType::uint16, Use use = Use::read) {
    Channel channel;
    channel.table = table, channel.address = static_cast<std::uint16_t>(address), channel.type = type, channel.use = use;
    return channel;
}

DeviceConfig device_with(std::vector<Channel> channels, std::uint16_t gap = 0) {
    DeviceConfig device;
    device.channels = std::move(channels);
    device.gap = gap;
    return device;
}

TEST(RequestPlan, NeighboursAreOneRequestInWhateverOrderTheyStand) {
    const auto plan = plan_requests(device_with({channel_at(Table::input, 4), channel_at(Table::input, 2, NumberType::float32),
                                                 channel_at(Table::input, 1), channel_at(Table::input, 0)}));
    ASSERT_EQ(plan.size(), 1u);
    EXPECT_EQ(plan[0].address, 0);
    EXPECT_EQ(plan[0].count, 5);
    EXPECT_THAT(plan[0].channels, ElementsAre(3, 2, 1, 0));
}

TEST(RequestPlan, WhatOverlapsIsReadOnce) {
    const auto plan = plan_requests(
        device_with({channel_at(Table::holding, 10, NumberType::uint32), channel_at(Table::holding, 10), channel_at(Table::holding, 11)}));
    ASSERT_EQ(plan.size(), 1u);
    EXPECT_EQ(plan[0].address, 10);
    EXPECT_EQ(plan[0].count, 2);
}

TEST(RequestPlan, AReadSpansTheGapAndNotOneMore) {
    for (const auto& [second, requests] : {std::pair{4u, 1u}, std::pair{5u, 2u}})
        EXPECT_EQ(plan_requests(device_with({channel_at(Table::input, 0), channel_at(Table::input, second)}, 3)).size(), requests)
            << second;
}

TEST(RequestPlan, AWriteTouchesNothingThatNobodyNamed) {
    const auto plan = plan_requests(device_with(
        {channel_at(Table::holding, 0, NumberType::uint16, Use::written), channel_at(Table::holding, 1, NumberType::uint16, Use::written),
         channel_at(Table::holding, 3, NumberType::uint16, Use::written)},
        100));
    ASSERT_EQ(plan.size(), 2u);
    EXPECT_EQ(plan[0].count, 2);
    EXPECT_EQ(function_of(plan[0]), 16);
    EXPECT_EQ(plan[1].address, 3);
    EXPECT_EQ(function_of(plan[1]), 6);
}

TEST(RequestPlan, TablesAndDirectionsAreApartAndTheUnusedIsNotAskedFor) {
    const auto plan = plan_requests(device_with(
        {channel_at(Table::coil, 0, NumberType::boolean), channel_at(Table::discrete_input, 0, NumberType::boolean),
         channel_at(Table::holding, 0), channel_at(Table::input, 0), channel_at(Table::coil, 1, NumberType::boolean, Use::written),
         channel_at(Table::input, 1, NumberType::uint16, Use::none)},
        100));
    std::vector<int> functions;
    for (const auto& request : plan) functions.push_back(function_of(request));
    EXPECT_THAT(functions, ElementsAre(5, 1, 2, 3, 4)) << "writes first";
}

// 6.1: 2000 coils; 6.3: 125 registers; 6.11: 1968 coils; 6.12: 123 registers.
TEST(RequestPlan, LimitsOfTheProtocolAreKept) {
    struct Limit {
        Table table;
        Use use;
        unsigned most;
    };
    for (const auto& [table, use, most] :
         {Limit{Table::coil, Use::read, 2000}, Limit{Table::discrete_input, Use::read, 2000}, Limit{Table::holding, Use::read, 125},
          Limit{Table::input, Use::read, 125}, Limit{Table::coil, Use::written, 1968}, Limit{Table::holding, Use::written, 123}}) {
        const auto type = is_bits(table) ? NumberType::boolean : NumberType::uint16;
        std::vector<Channel> channels;
        for (unsigned i = 0; i <= most; ++i) channels.push_back(channel_at(table, i, type, use));
        const auto plan = plan_requests(device_with(channels));
        ASSERT_EQ(plan.size(), 2u) << most;
        EXPECT_EQ(plan[0].count, most);
        EXPECT_EQ(plan[1].count, 1);
    }
}

TEST(RequestPlan, ANumberOfTwoRegistersIsNotCutAtTheLimit) {
    std::vector<Channel> channels;
    for (unsigned i = 0; i < 124; ++i) channels.push_back(channel_at(Table::input, i));
    channels.push_back(channel_at(Table::input, 124, NumberType::float32));
    const auto plan = plan_requests(device_with(channels));
    ASSERT_EQ(plan.size(), 2u);
    EXPECT_EQ(plan[1].address, 124);
    EXPECT_EQ(plan[1].count, 2);
}

TEST(RequestPlan, WhateverIsDrawnEveryUsedChannelLiesWholeInExactlyOneRequestWithinTheLimits) {
    std::mt19937 source{7};
    const auto draw = [&source] { return static_cast<unsigned>(source()); };
    for (int round = 0; round < 300; ++round) {
        std::vector<Channel> channels;
        for (unsigned n = draw() % 200; n > 0; --n) {
            const auto table = static_cast<Table>(draw() % 4);
            const auto type = is_bits(table) ? NumberType::boolean : static_cast<NumberType>(1 + draw() % 5);
            const auto use = is_writable(table) ? static_cast<Use>(draw() % 3) : static_cast<Use>(draw() % 2);
            const unsigned highest = 0x10000u - addresses_of(type);
            const unsigned address = draw() % 4 == 0 ? highest - draw() % 40 : draw() % 3000;
            channels.push_back(channel_at(table, address, type, use));
        }
        const auto device = device_with(channels, static_cast<std::uint16_t>(draw() % 20));
        std::vector<int> carried(channels.size());
        for (const auto& request : plan_requests(device)) {
            EXPECT_LE(request.count, is_bits(request.table) ? (request.write ? 1968 : 2000) : (request.write ? 123 : 125));
            EXPECT_LE(request.address + 0u + request.count, 0x10000u);
            for (const auto i : request.channels) {
                ++carried[i];
                EXPECT_EQ(channels[i].table, request.table);
                EXPECT_EQ(channels[i].use == Use::written, request.write);
                EXPECT_GE(channels[i].address, request.address);
                EXPECT_LE(channels[i].address + 0u + addresses_of(channels[i].type), request.address + 0u + request.count);
            }
        }
        for (std::size_t i = 0; i < channels.size(); ++i) EXPECT_EQ(carried[i], channels[i].use == Use::none ? 0 : 1);
    }
}

}  // namespace
}  // namespace taktwerk::modbus::tcp
