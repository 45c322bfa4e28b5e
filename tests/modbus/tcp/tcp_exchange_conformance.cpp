// Bytes on a real socket against the examples of the MODBUS Application Protocol Specification V1.1b3, chapter 6; the header from the
// Messaging Implementation Guide V1.0b, 3.1.3. And every way in which the other end may be wrong.

#include "modbus/tcp/tcp_exchange.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <array>
#include <chrono>
#include <thread>

#include "tests/modbus/tcp/raw_device.hpp"

namespace taktwerk::modbus::tcp {
namespace {

using namespace std::chrono_literals;
using testing::RawBytes;
using testing::RawDevice;
using Kind = Fault::Kind;

DeviceConfig at_port(std::uint16_t port, Duration timeout = 2s) {
    DeviceConfig device;
    device.host = "127.0.0.1", device.port = port, device.unit = 17, device.timeout = timeout;
    return device;
}

/// Header 3.1.3: transaction, protocol 0, length of what follows, unit.
RawBytes request_with(std::uint8_t transaction, const RawBytes& pdu) {
    RawBytes out{0, transaction, 0, 0, 0, static_cast<std::uint8_t>(pdu.size() + 1), 17};
    out.insert(out.end(), pdu.begin(), pdu.end());
    return out;
}

RawDevice::Answer answers(const RawBytes& pdu) {
    return [pdu](int socket, const RawBytes& request) { RawDevice::send(socket, RawDevice::framed(request, pdu)); };
}

struct Reading {
    Table table;
    std::uint16_t address, count;
    RawBytes request, response;
    std::vector<std::uint16_t> values;
};

TEST(TcpExchange, ReadsAsTheExamplesOfTheSpecification) {
    const std::vector<Reading> readings{
        // 6.1: coils 20 to 38
        {Table::coil, 0x13, 19, {1, 0, 0x13, 0, 0x13}, {1, 3, 0xCD, 0x6B, 5}, {1, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 1, 0, 1, 1, 0, 1, 0, 1}},
        // 6.2: discrete inputs 197 to 218
        {Table::discrete_input, 0xC4, 22, {2, 0, 0xC4, 0, 0x16}, {2, 3, 0xAC, 0xDB, 0x35}, {0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 0,
                                                                                            1, 1, 0, 1, 1, 1, 0, 1, 0, 1, 1}},
        // 6.3: registers 108 to 110
        {Table::holding, 0x6B, 3, {3, 0, 0x6B, 0, 3}, {3, 6, 2, 0x2B, 0, 0, 0, 0x64}, {555, 0, 100}},
        // 6.4: input register 9
        {Table::input, 8, 1, {4, 0, 8, 0, 1}, {4, 2, 0, 0x0A}, {10}},
    };
    for (const auto& known : readings) {
        RawDevice device{answers(known.response)};
        TcpExchange exchange{at_port(device.port())};
        ASSERT_EQ(exchange.connect(), Fault{});
        std::vector<std::uint16_t> values(known.count);
        ASSERT_EQ(exchange.read(known.table, known.address, values), Fault{}) << int{known.request[0]};
        EXPECT_EQ(values, known.values);
        ASSERT_EQ(device.frames().size(), 1u);
        EXPECT_EQ(device.frames()[0], request_with(1, known.request));
    }
}

TEST(TcpExchange, WritesAsTheExamplesOfTheSpecification) {
    struct Writing {
        Table table;
        std::uint16_t address;
        std::vector<std::uint16_t> values;
        RawBytes request, response;
    };
    const std::vector<Writing> writings{
        {Table::coil, 0xAC, {1}, {5, 0, 0xAC, 0xFF, 0}, {5, 0, 0xAC, 0xFF, 0}},                                       // 6.5
        {Table::holding, 1, {3}, {6, 0, 1, 0, 3}, {6, 0, 1, 0, 3}},                                                   // 6.6
        {Table::coil, 0x13, {1, 0, 1, 1, 0, 0, 1, 1, 1, 0}, {15, 0, 0x13, 0, 10, 2, 0xCD, 1}, {15, 0, 0x13, 0, 10}},  // 6.11
        {Table::holding, 1, {0x0A, 0x0102}, {16, 0, 1, 0, 2, 4, 0, 0x0A, 1, 2}, {16, 0, 1, 0, 2}},                    // 6.12
    };
    for (const auto& known : writings) {
        RawDevice device{answers(known.response)};
        TcpExchange exchange{at_port(device.port())};
        ASSERT_EQ(exchange.connect(), Fault{});
        EXPECT_EQ(exchange.write(known.table, known.address, known.values), Fault{}) << int{known.request[0]};
        ASSERT_EQ(device.frames().size(), 1u);
        EXPECT_EQ(device.frames()[0], request_with(1, known.request));
    }
}

Fault read_from(RawDevice& device, Duration timeout = 2s) {
    TcpExchange exchange{at_port(device.port(), timeout)};
    if (const auto fault = exchange.connect()) return fault;
    std::array<std::uint16_t, 3> values{};
    return exchange.read(Table::holding, 0x6B, values);
}

// Chapter 7: function | 80h and the code.
TEST(TcpExchange, TellsExceptionsByTheirCode) {
    for (const unsigned code : {1u, 2u, 3u, 4u, 5u, 6u, 8u, 10u, 11u}) {
        RawDevice device{answers({0x83, static_cast<std::uint8_t>(code)})};
        EXPECT_EQ(read_from(device), (Fault{Kind::exception, static_cast<std::uint8_t>(code)})) << code;
    }
}

// An exception is the device's word, also where it has no number.
TEST(TcpExchange, TellsAnExceptionWithoutANumber) {
    RawDevice device{answers({0x83, 0})};
    TcpExchange exchange{at_port(device.port())};
    ASSERT_EQ(exchange.connect(), Fault{});
    std::vector<std::uint16_t> values(1);
    EXPECT_EQ(exchange.read(Table::holding, 0, values), (Fault{Kind::exception, 0}));
    EXPECT_TRUE(exchange.connected());
}

TEST(TcpExchange, TakesNoAnswerThatIsNotItsOwn) {
    const RawBytes right{3, 6, 2, 0x2B, 0, 0, 0, 0x64};
    const std::vector<std::pair<const char*, RawDevice::Answer>> wrong{
        {"short: one register where three were asked for", answers({3, 2, 2, 0x2B})},
        {"another function", answers({4, 6, 2, 0x2B, 0, 0, 0, 0x64})},
        {"another transaction",
         [&](int socket, const RawBytes& request) {
             auto answer = RawDevice::framed(request, right);
             answer[1] ^= 0x55;
             RawDevice::send(socket, answer);
         }},
        {"an exception code that there is not", answers({0x83, 0x77})},
    };
    for (const auto& [what, answer] : wrong) {
        RawDevice device{answer};
        EXPECT_EQ(read_from(device).kind, Kind::bad_answer) << what;
    }
}

TEST(TcpExchange, SaysThatNobodyListens) {
    std::uint16_t free_port = 0;
    {
        RawDevice gone{answers({})};
        free_port = gone.port();
    }
    TcpExchange exchange{at_port(free_port)};
    EXPECT_EQ(exchange.connect(), (Fault{Kind::refused}));
}

TEST(TcpExchange, SaysThatTheConnectionWasEnded) {
    RawDevice device{[](int socket, const RawBytes&) { ::shutdown(socket, SHUT_RDWR); }};
    EXPECT_EQ(read_from(device).kind, Kind::closed);
}

/// A network of this thread's own, with not even a loopback that is up.
TEST(TcpExchange, SaysThatNoWayLeadsThere) {
    std::thread{[] {
        if (::unshare(CLONE_NEWNET) != 0) GTEST_SKIP() << "network namespaces are not permitted here";
        TcpExchange exchange{at_port(502)};
        EXPECT_EQ(exchange.connect(), (Fault{Kind::unreachable}));
    }}.join();
}

// Half open, slow, and a byte now and then: each ends with the timeout.
TEST(TcpExchange, WaitsForAWholeAnswerNoLongerThanItsTimeout) {
    std::atomic<bool> over{false};
    const auto drip = [&over](int socket, const RawBytes& request) {
        for (const auto byte : RawDevice::framed(request, {3, 6, 2, 0x2B, 0, 0, 0, 0x64})) {
            if (over.load()) return;
            RawDevice::send(socket, {byte});
            std::this_thread::sleep_for(60ms);
        }
    };
    const std::vector<std::pair<const char*, RawDevice::Answer>> slow{
        {"nothing at all", [](int, const RawBytes&) {}},
        {"half of an answer",
         [](int socket, const RawBytes& request) {
             auto answer = RawDevice::framed(request, {3, 6, 2, 0x2B, 0, 0, 0, 0x64});
             answer.resize(10);
             RawDevice::send(socket, answer);
         }},
        {"a byte every 60 ms", drip},
    };
    for (const auto& [what, answer] : slow) {
        over.store(false);
        RawDevice device{answer};
        const auto begin = std::chrono::steady_clock::now();
        EXPECT_EQ(read_from(device, 100ms).kind, Kind::timeout) << what;
        EXPECT_LT(std::chrono::steady_clock::now() - begin, 600ms) << what;  // 15 bytes would drip for 900 ms
        over.store(true);
    }
}

TEST(TcpExchange, TakesAddressesAndNoNames) {
    EXPECT_TRUE(is_address("192.168.1.50"));
    EXPECT_TRUE(is_address("fe80::1"));
    EXPECT_FALSE(is_address("valves"));
    EXPECT_FALSE(is_address("localhost"));
    EXPECT_FALSE(is_address("192.168.1.500"));
    for (const char* host : {"192.168.001.050", "127.1", "2130706433", "0x7f.0.0.1", "0.0.0.0", "255.255.255.255", "224.0.0.1"})
        EXPECT_FALSE(is_address(host)) << host;
    EXPECT_FALSE(is_address(""));
}

}  // namespace
}  // namespace taktwerk::modbus::tcp
