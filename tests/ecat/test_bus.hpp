#pragma once
// A bus for tests: simulated slaves on an in-process line and a master that reaches them only through frames, in virtual time.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ecat/master.hpp"
#include "ecat/ring/ring_transport.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "ecat/sim/sim_network.hpp"
#include "ecat/transport/loopback.hpp"
#include "tests/ecat/tampered_cable.hpp"

namespace taktwerk::ecat::test {

using namespace std::chrono_literals;

/// A servo as small as it can be: target position comes back as actual position, one exchange later.
/// Identity, SYNC0 rule and PDOs as in the SV33-E manual (6.2.6.2, 7.1).
inline std::shared_ptr<DeviceDescription> servo_description() {
    auto d = std::make_shared<DeviceDescription>();
    d->name = "sv33-e";
    d->device_name = "SV33-ECAT";
    d->identity = {0x000007FB, 0x000C0108, 0x00010001, 0};
    d->mailbox = MailboxDescription{};
    d->sync_managers = {{SmUse::mailbox_out, 0x1000, 0x80, 0x26},
                        {SmUse::mailbox_in, 0x1400, 0x80, 0x22},
                        {SmUse::outputs, 0x1800, 0, 0x64},
                        {SmUse::inputs, 0x1C00, 0, 0x20}};
    d->rx_pdos = {{0x1701, true, {{0x6040, 0, 16}, {0x607A, 0, 32}}},
                  {0x1702, true, {{0x6040, 0, 16}, {0x6060, 0, 8}, {0x607A, 0, 32}}},
                  {0x1600, false, {{0x6040, 0, 16}}}};
    d->tx_pdos = {{0x1B01, true, {{0x6041, 0, 16}, {0x6064, 0, 32}}}, {0x1A00, false, {{0x6041, 0, 16}}}};
    d->rx_assigned = {0x1701};
    d->tx_assigned = {0x1B01};
    d->objects = {
        {0x6040, 0, "Controlword", DataType::U16, Access::rw, Mappable::rx, 0, {}, {}, {}},
        {0x6041, 0, "Statusword", DataType::U16, Access::ro, Mappable::tx, 0, {}, {}, {}},
        {0x6060, 0, "Modes of operation", DataType::I8, Access::rw, Mappable::rx, 0, {}, {}, {}},
        {0x6064, 0, "Position actual value", DataType::I32, Access::ro, Mappable::tx, 0, {}, {}, {}},
        {0x607A, 0, "Target position", DataType::I32, Access::rw, Mappable::rx, 0, {}, {}, {}},
        {0x6085, 0, "Quick stop deceleration", DataType::U32, Access::rw, Mappable::rx, 100, 1, 1'000'000, {}},
        {0x2000, 1, "Serial text", DataType::STRING, Access::ro, Mappable::no, 0, {}, {}, std::string(300, 'x')},
    };
    d->dc = {.supported = true, .required = true, .clock_64bit = true, .minimum_cycle = 125us, .cycle_multiple = 125us};
    return d;
}

/// 8 inputs and 8 outputs, no mailbox; inputs are the outputs inverted.
inline std::shared_ptr<DeviceDescription> terminal_description() {
    auto d = std::make_shared<DeviceDescription>();
    d->name = "dio8";
    d->identity = {0x00000ABC, 0x00000808, 1, 0};
    d->sync_managers = {{SmUse::outputs, 0x1000, 1, 0x44}, {SmUse::inputs, 0x1100, 1, 0x20}};
    PdoDescription out{0x1600, true, {}}, in{0x1A00, true, {}};
    for (std::uint8_t i = 1; i <= 8; ++i) {
        out.entries.push_back({0x7000, i, 1});
        in.entries.push_back({0x6000, i, 1});
    }
    d->rx_pdos = {out};
    d->tx_pdos = {in};
    d->rx_assigned = {0x1600};
    d->tx_assigned = {0x1A00};
    return d;
}

class EchoServo final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary& dictionary, Instant) override {
        target_ = dictionary.find(0x607A, 0);
        actual_ = dictionary.find(0x6064, 0);
        control_ = dictionary.find(0x6040, 0);
        status_ = dictionary.find(0x6041, 0);
    }
    std::uint16_t refuse(sim::EsmState, sim::EsmState to, const sim::SyncSettings& settings) override {
        return to == sim::EsmState::safeop && !settings.sync0_active ? std::uint16_t{0x0030} : std::uint16_t{0};
    }
    void exchange(Instant now) override {
        actual_->set(target_->get());
        status_->set(control_->get());
        last_exchange = now;
        ++exchanges;
    }
    void outputs_lost(Instant) override { ++watchdogs; }
    void raise(const Emergency& emergency) { send_emergency(emergency); }
    Instant last_exchange{};
    int exchanges = 0, watchdogs = 0;

private:
    sim::Entry *target_ = nullptr, *actual_ = nullptr, *control_ = nullptr, *status_ = nullptr;
};

class InvertingTerminal final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
    void raw_outputs(std::span<const std::byte> outputs) override { value_ = outputs[0]; }
    void raw_inputs(std::span<std::byte> inputs) override { inputs[0] = ~value_; }

private:
    std::byte value_{};
};

/// `devices`: "s" a servo, "t" a terminal, in the order of the cable.
class TestBus {
public:
    explicit TestBus(const std::string& devices, Duration cycle = 1ms) : network(Instant{}), cable(network), transport(cable) {
        config.cycle = cycle;
        for (std::size_t i = 0; i < devices.size(); ++i) {
            const bool servo = devices[i] == 's';
            SlaveConfig slave;
            slave.name = std::string(1, static_cast<char>('a' + i));
            slave.device = servo ? servo_description() : terminal_description();
            slave.position = static_cast<std::uint16_t>(i);
            slave.dc = servo;
            config.slaves.push_back(slave);
            sim::SlaveOptions options;
            options.clock_start = Duration{static_cast<std::int64_t>(i + 1) * 987'654'321};
            std::unique_ptr<sim::DeviceModel> model;
            if (servo) model = std::make_unique<EchoServo>();
            else model = std::make_unique<InvertingTerminal>();
            network.add(slave.device, std::move(model), options);
        }
    }

    EchoServo& servo(std::size_t position) { return dynamic_cast<EchoServo&>(network.slave(position).model()); }
    sim::EsmState state(std::size_t position) { return network.slave(position).state(); }

    /// Before start(): a second interface behind the last slave.
    void make_ring(BehindBreak behind_break = BehindBreak::hand_time_on) {
        config.ring = RingConfig{"", behind_break};
        second = std::make_unique<LoopbackTransport>(network.close_ring(network.slave(network.size() - 1)));
        transport.set_other_end(*second);
        second->set_other_end(transport);
        ring = std::make_unique<RingTransport>(transport, *second, config.cycle / 4);
    }
    /// The cable in front of slave `place`; behind the last one: that of the second interface. What is under way is lost.
    void set_ring_cable(std::size_t place, bool plugged) {
        if (place < network.size()) network.set_cable(place, plugged);
        else network.set_ring_cable(plugged);
        if (plugged) return;
        transport.lose_under_way(now);
        second->lose_under_way(now);
    }
    void start() {
        if (!master) master = std::make_unique<Master>(ring ? static_cast<Transport&>(*ring) : transport, config);
        master->start();
    }
    /// One cycle as the runtime runs it.
    void cycle_once() {
        now += config.cycle + (locks ? master->period_correction() : Duration{0});
        master->receive(now);
        if (on_cycle) on_cycle();
        master->send(now);
        // The service thread runs more often than the cycle; answers arrive between the cycles only with the next receive().
        master->step(now);
    }
    void run_for(Duration length) {
        for (const Instant end = now + length; now < end;) cycle_once();
    }
    bool run_until(const std::function<bool()>& condition, Duration limit) {
        for (const Instant end = now + limit; now < end;) {
            cycle_once();
            if (condition()) return true;
        }
        return condition();
    }
    /// True when OP was reached.
    bool bring_up(Duration limit = 20s) {
        start();
        run_until([&] { return master->phase() == Master::Phase::operational || master->phase() == Master::Phase::failed; }, limit);
        return master->phase() == Master::Phase::operational;
    }
    [[nodiscard]] std::vector<AlarmFact> facts() const {
        std::array<AlarmFact, 32> all;
        const std::size_t count = master->active_faults(all);
        return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
    }
    [[nodiscard]] std::vector<AlarmId> faults() const {
        std::vector<AlarmId> ids;
        for (const auto& fact : facts()) ids.push_back(fact.id);
        return ids;
    }
    [[nodiscard]] std::string why() const { return master->failure().text() + " | " + master->progress(); }

    BusConfig config;
    sim::SimNetwork network;
    TamperedCable cable;
    LoopbackTransport transport;
    std::unique_ptr<LoopbackTransport> second;
    std::unique_ptr<RingTransport> ring;
    std::unique_ptr<Master> master;
    std::function<void()> on_cycle;
    bool locks = true;  ///< the caller's cycle follows the reference clock, as the runtime's does
    Instant now{};
};

}  // namespace taktwerk::ecat::test
