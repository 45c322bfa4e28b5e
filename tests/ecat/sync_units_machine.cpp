// Sync units in OP: their own rate, their own working counter, their own instants; and slaves that need another layout.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/process_image.hpp"
#include "ecat/wire/frame.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {
namespace {

/// "axes" every 4 cycles; the slaves of `slow` belong to it.
void slow_axes(TestBus& bus, std::initializer_list<std::size_t> slow) {
    bus.config.sync_units = {{"axes", 4}};
    for (const std::size_t s : slow) bus.config.slaves[s].sync_unit = "axes";
}

/// Datagrams seen on the wire since it was attached: of one command, answers only.
struct Listener {
    explicit Listener(TestBus& bus, Command command) : wanted(command) { bus.master->set_tap(&Listener::tap, this); }
    static void tap(void* context, std::span<const std::byte> frame, Instant, bool outgoing) noexcept {
        auto& self = *static_cast<Listener*>(context);
        if (outgoing) return;
        FrameReader reader{frame};
        while (const auto datagram = reader.next())
            if (datagram->command == self.wanted) {
                ++self.count;
                self.wkc = datagram->working_counter();
                for (const auto byte : datagram->data) self.seen |= static_cast<unsigned>(byte);
            }
    }
    Command wanted;
    int count = 0;
    unsigned wkc = 0, seen = 0;
};

TEST(SyncUnits, ASlowUnitIsExchangedEveryDivisorCycles) {
    TestBus bus{"ss"};
    slow_axes(bus, {0});
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(40ms);
    int fresh_slow = 0, due_slow = 0, fresh_fast = 0;
    const int exchanges = bus.servo(0).exchanges, fast_exchanges = bus.servo(1).exchanges;
    for (int i = 0; i < 40; ++i) {
        bus.cycle_once();
        fresh_slow += bus.master->health(0).fresh ? 1 : 0;
        due_slow += bus.master->health(0).due ? 1 : 0;
        fresh_fast += bus.master->health(1).fresh ? 1 : 0;
        EXPECT_EQ(bus.master->health(0).age, 0u) << "between its instants nothing is missing";
    }
    EXPECT_EQ(fresh_slow, 10);
    EXPECT_EQ(due_slow, 10);
    EXPECT_EQ(fresh_fast, 40);
    EXPECT_EQ(bus.servo(0).exchanges - exchanges, 10) << "its SYNC0 has the unit's period";
    EXPECT_EQ(bus.servo(1).exchanges - fast_exchanges, 40);
}

// Sent in cycle n, in effect half a bus cycle later, and only then: the drive's own record is the witness.
TEST(SyncUnits, OutputsOfASlowUnitTakeEffectAtItsOwnInstants) {
    TestBus bus{"ss"};
    slow_axes(bus, {0});
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(40ms);
    std::vector<Instant> promised;
    Instant promise{};
    bus.on_cycle = [&] { promise = bus.master->outputs_effective(0, bus.now); };
    for (int i = 0; i < 9; ++i) {
        bus.cycle_once();
        promised.push_back(promise);
        EXPECT_GT(promise, bus.now);
        EXPECT_LE(promise - bus.now, 3505us) << "at most three cycles and the shift";
    }
    // Four cycles in a row promise the same instant, then the next one, a period later: nine cycles see two changes.
    int changes = 0;
    for (std::size_t i = 1; i < promised.size(); ++i) {
        if (promised[i] - promised[i - 1] < 1us && promised[i - 1] - promised[i] < 1us) continue;
        ++changes;
        EXPECT_NEAR(static_cast<double>((promised[i] - promised[i - 1]).count()), 4e6, 2000);
    }
    EXPECT_EQ(changes, 2);
    const Instant last = promised.back();
    bus.run_for(4ms);
    EXPECT_NEAR(static_cast<double>((bus.servo(0).last_exchange - last).count()), 0, 200);
}

TEST(SyncUnits, InputsOfASlowUnitCarryItsLatchInstant) {
    TestBus bus{"s"};
    slow_axes(bus, {0});
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(40ms);
    ASSERT_TRUE(bus.run_until([&] { return bus.master->health(0).fresh; }, 5ms));
    // The answer left a cycle ago; SYNC0 before that was half a cycle after the exchange four cycles earlier.
    EXPECT_NEAR(static_cast<double>((bus.now - bus.master->health(0).latched).count()), 1e6 + 4e6 - 0.5e6, 3000);
    const auto latched = bus.master->health(0).latched;
    bus.cycle_once();
    EXPECT_EQ(bus.master->health(0).latched, latched) << "it says of the last exchange when it was";
}

TEST(SyncUnits, AgeCountsPeriodsOfTheUnit) {
    TestBus bus{"ss"};
    slow_axes(bus, {0});
    bus.config.slaves[0].sm_watchdog = 200ms;
    bus.config.slaves[1].sm_watchdog = 200ms;
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(40ms);
    ASSERT_TRUE(bus.run_until([&] { return bus.master->health(0).fresh; }, 5ms));
    bus.transport.faults.drop_answers = 1000;
    for (int i = 0; i < 12; ++i) bus.cycle_once();
    EXPECT_EQ(bus.master->health(0).age, 3u);
    EXPECT_GE(bus.master->health(1).age, 11u);
    bus.transport.faults.drop_answers = 0;
    bus.run_for(10ms);
    EXPECT_EQ(bus.master->health(0).age, 0u);
}

// a and b share a unit, c has its own. b loses power: a ages with it although it answers, c does not notice.
TEST(SyncUnits, AWrongWorkingCounterFreezesTheInputsOfItsUnitOnly) {
    TestBus bus{"tts"};
    bus.config.slaves[0].sync_unit = bus.config.slaves[2].sync_unit = "pair";
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(20ms);
    const auto output = bus.master->output(0, 0x7000, 1).value();
    const auto input = bus.master->input(0, 0x6000, 1).value();
    ASSERT_EQ(read_signal(bus.master->inputs(), input), 1) << "inverted";

    bus.network.set_power(2, false);
    write_signal(bus.master->outputs(), output, 1);
    bus.run_for(10ms);
    EXPECT_EQ(read_signal(bus.master->inputs(), input), 1) << "frozen, although slave a answered 0";
    EXPECT_FALSE(bus.master->health(0).fresh);
    EXPECT_GE(bus.master->health(0).age, 8u);
    EXPECT_TRUE(bus.master->health(1).fresh);
    EXPECT_EQ(bus.master->health(1).age, 0u);
}

TEST(SyncUnits, SlavesWithoutLrwReachOpWithLwrAndLrd) {
    TestBus bus{""};
    sim::SlaveOptions options;
    options.lrw = false;
    bus.network.add(terminal_description(), std::make_unique<InvertingTerminal>(), options);
    bus.network.add(terminal_description(), std::make_unique<InvertingTerminal>());
    for (std::uint16_t i = 0; i < 2; ++i) {
        SlaveConfig slave;
        slave.name = std::string(1, static_cast<char>('a' + i));
        slave.device = terminal_description();
        slave.position = i;
        slave.sync_unit = "io";
        bus.config.slaves.push_back(slave);
    }
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    write_signal(bus.master->outputs(), bus.master->output(1, 0x7000, 5).value(), 1);
    bus.run_for(5ms);
    for (std::size_t s = 0; s < 2; ++s) EXPECT_TRUE(bus.master->health(s).fresh);
    EXPECT_EQ(read_signal(bus.master->inputs(), bus.master->input(1, 0x6000, 5).value()), 0);
    EXPECT_EQ(read_signal(bus.master->inputs(), bus.master->input(0, 0x6000, 5).value()), 1);
}

/// `size` bytes in and out; inputs are the outputs, one exchange later.
class WideEcho final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
    void raw_outputs(std::span<const std::byte> outputs) override { value_.assign(outputs.begin(), outputs.end()); }
    void raw_inputs(std::span<std::byte> inputs) override {
        for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i] = i < value_.size() ? value_[i] : std::byte{};
    }

private:
    std::vector<std::byte> value_;
};

// 1600 + 1600 bytes: three windows in three frames. The sync managers must not be handed over before their last byte.
TEST(SyncUnits, ASlaveLargerThanAFrameExchangesAllItsBytes) {
    auto device = std::make_shared<DeviceDescription>();
    device->name = "wide";
    device->identity = {0xABC, 0x1600, 1, 0};
    device->process_ram = 0x4000;
    device->sync_managers = {{SmUse::outputs, 0x1000, 1600, 0x44}, {SmUse::inputs, 0x3000, 1600, 0x20}};
    PdoDescription out{0x1600, true, {}}, in{0x1A00, true, {}};
    for (std::uint8_t i = 1; i <= 200; ++i) {
        out.entries.push_back({0x7000, i, 64});
        in.entries.push_back({0x6000, i, 64});
    }
    device->rx_pdos = {out};
    device->tx_pdos = {in};
    device->rx_assigned = {0x1600};
    device->tx_assigned = {0x1A00};
    TestBus bus{""};
    bus.network.add(device, std::make_unique<WideEcho>());
    SlaveConfig slave;
    slave.name = "wide";
    slave.device = device;
    slave.position = 0;
    bus.config.slaves = {slave};
    ASSERT_TRUE(check(bus.config).empty()) << check(bus.config)[0].text();
    ASSERT_TRUE(bus.bring_up()) << bus.why();

    for (std::uint8_t i = 1; i <= 200; ++i) write_signal(bus.master->outputs(), bus.master->output(0, 0x7000, i).value(), i * 1'000'003LL);
    bus.run_for(5ms);
    EXPECT_TRUE(bus.master->health(0).fresh);
    for (std::uint8_t i = 1; i <= 200; ++i)
        ASSERT_EQ(read_signal(bus.master->inputs(), bus.master->input(0, 0x6000, i).value()), i * 1'000'003LL) << int{i};
    EXPECT_EQ(bus.master->statistics().working_counter_errors, 0u);
}

// One LRD a cycle with the servos' bits; while an SDO answer waits, the slave's bit is seen.
TEST(SyncUnits, FullMailboxesAreSeenInEveryCycle) {
    TestBus bus{"sts"};
    ASSERT_TRUE(bus.bring_up()) << bus.why();
    bus.run_for(20ms);
    Listener listener{bus, Command::LRD};
    bus.run_for(10ms);
    EXPECT_EQ(listener.count, 10);
    EXPECT_EQ(listener.wkc, 2u) << "two slaves have a mailbox";
    EXPECT_EQ(listener.seen, 0u);
    const auto ticket = bus.master->upload(2, 0x6041, 0);
    std::optional<Result<SdoResult>> result;
    bus.run_until([&] { return (result = bus.master->poll(ticket)).has_value(); }, 1s);
    EXPECT_TRUE(result && result->ok());
    EXPECT_EQ(listener.seen, 2u) << "bit 1: the second of them";
    bus.master->set_tap(nullptr, nullptr);
}

}  // namespace
}  // namespace taktwerk::ecat::test
