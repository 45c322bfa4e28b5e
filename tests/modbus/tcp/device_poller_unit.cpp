// Who asks a device, in virtual time: what is asked when, what is kept of it, how it comes back.

#include "modbus/tcp/device_poller.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/modbus/tcp/scripted_device.hpp"

namespace taktwerk::modbus::tcp {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::ScriptedDevice;
using Kind = Fault::Kind;
using Use = Channel::Use;

/// pressure: input register 0; level: holding 5 as int16; valve, speed: holding 20 and 21, written; lamp: coil 3, written.
DeviceConfig press() {
    DeviceConfig device;
    device.poll = 20ms, device.refresh = 500ms, device.max_age = 100ms;
    const auto add = [&](const char* name, Table table, std::uint16_t address, NumberType type, Use use) {
        Channel channel;
        channel.name = name, channel.table = table, channel.address = address, channel.type = type, channel.use = use;
        device.channels.push_back(channel);
    };
    add("pressure", Table::input, 0, NumberType::uint16, Use::read);
    add("level", Table::holding, 5, NumberType::int16, Use::read);
    add("valve", Table::holding, 20, NumberType::uint16, Use::written);
    add("speed", Table::holding, 21, NumberType::int16, Use::written);
    add("lamp", Table::coil, 3, NumberType::boolean, Use::written);
    return device;
}
constexpr std::size_t pressure = 0, level = 1, valve = 2, speed = 3, lamp = 4;

struct PollerRig {
    explicit PollerRig(const DeviceConfig& config = press()) : words(config.channels.size()), poller(config, device, words) {}
    void run(Duration time) {
        for (const auto end = now + time; now < end;) {
            now += 1ms;
            poller.step(now);
        }
    }
    void put(std::size_t channel, std::int64_t word) {
        words[channel] = word;
        poller.put(words);
    }
    DevicePoller::Report report() { return *poller.report().value; }
    Duration age(std::size_t request) { return now - report().requests[request].done; }
    std::size_t logged(const std::string& entry) const {
        return static_cast<std::size_t>(std::count(device.log.begin(), device.log.end(), entry));
    }

    ScriptedDevice device;
    std::vector<std::int64_t> words;
    DevicePoller poller;
    Instant now = Instant{} + 1s;
};

TEST(DevicePoller, ConnectsWritesTheOutputsAndThenReads) {
    PollerRig rig;
    rig.device.registers[{Table::input, 0}] = 1234;
    rig.device.registers[{Table::holding, 5}] = 0xFFFF;
    rig.run(7ms);
    EXPECT_THAT(rig.device.log, ElementsAre("connect", "write coil 3+1", "read holding 5+1", "write holding 20+2", "read input 0+1"));
    EXPECT_EQ(rig.report().words[pressure], 1234);
    EXPECT_EQ(rig.report().words[level], -1);
}

TEST(DevicePoller, ReadsOnceInEachPollAndLeavesTheDeviceAloneBetween) {
    PollerRig rig;
    rig.run(20ms);
    rig.device.log.clear();
    rig.run(200ms);
    EXPECT_EQ(rig.logged("read input 0+1"), 10u);
    EXPECT_EQ(rig.logged("read holding 5+1"), 10u);
    EXPECT_EQ(rig.device.log.size(), 20u) << "no output changed";
}

TEST(DevicePoller, WritesAnOutputWhenItChangesAndEachRefreshAlthoughItDoesNot) {
    PollerRig rig;
    rig.run(20ms);
    rig.device.log.clear();
    rig.put(valve, 700);
    rig.put(speed, -5);
    rig.run(3ms);
    EXPECT_EQ((rig.device.registers[{Table::holding, 20}]), 700);
    EXPECT_EQ((rig.device.registers[{Table::holding, 21}]), 0xFFFB);
    EXPECT_EQ(rig.logged("write holding 20+2"), 1u);
    rig.device.log.clear();
    rig.run(2100ms);
    EXPECT_EQ(rig.logged("write holding 20+2"), 4u);
    EXPECT_EQ(rig.logged("write coil 3+1"), 4u);
}

TEST(DevicePoller, AnOutputThatChangesAllTheTimeDoesNotStarveTheInputs) {
    PollerRig rig;
    rig.run(20ms);
    rig.device.log.clear();
    for (int i = 0; i < 200; ++i) {
        rig.put(valve, i);
        rig.run(1ms);
    }
    EXPECT_EQ(rig.logged("read input 0+1"), 10u);
    EXPECT_EQ(rig.logged("read holding 5+1"), 10u);
}

TEST(DevicePoller, AValueIsAsOldAsTheRequestThatBroughtIt) {
    PollerRig rig;
    rig.run(20ms);
    rig.device.answering = {Kind::timeout};
    rig.run(150ms);
    const auto reads = rig.poller.requests().size() - 1;
    EXPECT_GE(rig.age(reads), 149ms);
    EXPECT_LE(rig.age(reads), 171ms);
    EXPECT_EQ(rig.report().requests[reads].fault.kind, Kind::timeout);
}

TEST(DevicePoller, AnExceptionConcernsItsRequestAlone) {
    PollerRig rig;
    rig.device.registers[{Table::input, 0}] = 9;
    rig.device.refused_at[{Table::holding, 5}] = {Kind::exception, 2};
    rig.run(100ms);
    EXPECT_EQ(rig.logged("close"), 0u);
    const auto& requests = rig.poller.requests();
    for (std::size_t r = 0; r < requests.size(); ++r) {
        const auto state = rig.report().requests[r];
        const bool refused = requests[r].table == Table::holding && !requests[r].write;
        EXPECT_EQ(state.ever, !refused);
        EXPECT_EQ(state.fault, refused ? (Fault{Kind::exception, 2}) : Fault{});
    }
    EXPECT_EQ(rig.report().words[pressure], 9);
}

TEST(DevicePoller, AWriteThatIsRefusedIsTriedAgainWithTheNextRefreshOnly) {
    PollerRig rig;
    rig.device.refused_at[{Table::holding, 20}] = {Kind::exception, 3};
    rig.run(20ms);
    rig.device.log.clear();
    rig.put(valve, 1);
    rig.run(2100ms);
    EXPECT_EQ(rig.logged("write holding 20+2"), 4u);
}

TEST(DevicePoller, ComesBackWithPausesThatDoubleToFiveSeconds) {
    PollerRig rig;
    rig.device.connecting = {Kind::refused};
    std::vector<Instant> attempts;
    for (const auto end = rig.now + 20s; rig.now < end;) {
        const auto before = rig.device.log.size();
        rig.run(1ms);
        if (rig.device.log.size() > before) attempts.push_back(rig.now);
    }
    std::vector<Duration> pauses;
    for (std::size_t i = 1; i < attempts.size(); ++i) pauses.push_back(attempts[i] - attempts[i - 1]);
    const std::vector<Duration> expected{100ms, 200ms, 400ms, 800ms, 1600ms, 3200ms, 5s, 5s};
    EXPECT_EQ(pauses, expected);
    EXPECT_EQ(rig.report().requests[0].fault.kind, Kind::refused);
}

TEST(DevicePoller, OutputsComeFirstWhenTheDeviceIsBack) {
    PollerRig rig;
    rig.put(lamp, 1);
    rig.run(20ms);
    rig.device.answering = {Kind::closed};
    rig.run(20ms);
    EXPECT_EQ(rig.logged("close"), 1u);
    rig.device.answering = {};
    rig.device.registers.clear();  // it lost its power
    rig.device.log.clear();
    rig.run(150ms);
    ASSERT_GE(rig.device.log.size(), 2u);
    EXPECT_EQ(rig.device.log[0], "connect");
    EXPECT_TRUE(rig.device.log[1].starts_with("write"));
    EXPECT_EQ((rig.device.registers[{Table::coil, 3}]), 1);
    for (const auto& state : rig.report().requests) EXPECT_EQ(state.fault, Fault{});
}

// A thing that takes connections and ends them is not asked a thousand times a second.
// Some devices end the connection behind each answer: one request a connection, and each of them has its turn.
TEST(DevicePoller, WhoAnswersOnceInEachConnectionIsWrittenAndRead) {
    PollerRig rig;
    rig.device.registers[{Table::input, 0}] = 77;
    rig.device.answers_before_closing = 1;
    rig.run(4s);
    EXPECT_GT(rig.logged("write coil 3+1"), 3u);
    EXPECT_GT(rig.logged("write holding 20+2"), 3u);
    EXPECT_GT(rig.logged("read holding 5+1"), 3u);
    EXPECT_GT(rig.logged("read input 0+1"), 3u);
    EXPECT_EQ(rig.report().words[pressure], 77);
    for (const auto& request : rig.report().requests) EXPECT_TRUE(request.ever);
}

TEST(DevicePoller, WhoLetsItselfBeConnectedAndSaysNothingIsLeftAloneLongerEachTime) {
    PollerRig rig;
    rig.device.answering = {Kind::closed};
    rig.run(10s);
    EXPECT_LE(rig.logged("connect"), 8u);
}

TEST(DevicePoller, TheEndWritesWhatChangedOnceAndClosesTheConnection) {
    PollerRig rig;
    rig.put(lamp, 1);
    rig.run(20ms);
    rig.device.log.clear();
    rig.put(lamp, 0);
    while (rig.poller.finish(rig.now)) {}
    EXPECT_THAT(rig.device.log, ElementsAre("write coil 3+1", "close"));
    EXPECT_EQ((rig.device.registers[{Table::coil, 3}]), 0);
}

TEST(DevicePoller, TheEndOfADeadDeviceTakesOneRequestAtMost) {
    PollerRig rig;
    rig.run(20ms);
    rig.device.answering = {Kind::timeout};
    rig.put(lamp, 1);
    rig.put(valve, 1);
    rig.device.log.clear();
    while (rig.poller.finish(rig.now)) {}
    EXPECT_THAT(rig.device.log, ElementsAre("write coil 3+1", "close"));
    rig.device.log.clear();
    while (rig.poller.finish(rig.now)) {}
    EXPECT_THAT(rig.device.log, IsEmpty()) << "it is not connected: no attempt at the end";
}

}  // namespace
}  // namespace taktwerk::modbus::tcp
