#pragma once
// A simulated slave in PREOP and scripts that speak to its mailbox, in virtual time; no master, no cycle.

#include <gtest/gtest.h>

#include <functional>
#include <optional>

#include "ecat/coe/object_info.hpp"
#include "ecat/coe/sdo_client.hpp"
#include "ecat/transport/loopback.hpp"
#include "tests/ecat/sim/bus_probe.hpp"

namespace taktwerk::ecat::test {

using namespace std::chrono_literals;
using sim::bytes;
using sim::Bytes;

/// Keeps what a script returns.
template <class T>
Script<void> keep(Script<Result<T>> script, std::optional<Result<T>>& result) {
    Result<T> value = co_await script;
    result.emplace(std::move(value));
}

/// A device model that raises emergencies when a test says so.
class AlarmingModel final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
    void written(std::uint16_t, std::uint8_t, Instant) override {
        if (on_write) send_emergency(*on_write);
    }
    void raise(const Emergency& emergency) { send_emergency(emergency); }

    std::optional<Emergency> on_write;  ///< comes before the answer to each download
};

class CoeBench {
public:
    explicit CoeBench(DeviceDescription description, sim::SlaveOptions options = {}) {
        auto owned = std::make_unique<AlarmingModel>();
        model = owned.get();
        slave = &probe.add(std::move(description), std::move(owned), std::move(options));
        probe.to_preop(0);
        probe.write(0, reg::station_address, sim::le<std::uint16_t>(0x1001));
        now = probe.now;
        transport.emplace(probe.network);
        exchange.emplace(*transport);
        channel.emplace(*exchange);
        port.emplace(*channel);
        mailbox.subject = "slave 0 'x'";
        mailbox.station = 0x1001;
        mailbox.out_start = 0x1000;
        mailbox.in_start = 0x1400;
        mailbox.out_size = mailbox.in_size = 0x80;
        mailbox.log = &log;
        mailbox.slave = 5;
    }

    /// Answers arrive every millisecond; at most `steps` of them.
    template <class T>
    Result<T> run(Script<Result<T>> script, int steps = 60'000) {
        std::optional<Result<T>> result;
        Runner runner{keep(std::move(script), result)};
        for (int i = 0; i < steps && !runner.done(); ++i) {
            step();
            runner.step(now);
            pack();
        }
        return result ? std::move(*result) : Result<T>{Error{"test.hangs", "", "the script does not end", ""}};
    }
    /// Sends what the scripts submitted; loses a frame when its number comes.
    void pack() {
        const bool hit = frames + 1 == lose_request || frames + 1 == lose_answer;
        if (hit) (frames + 1 == lose_request ? transport->faults.drop_requests : transport->faults.drop_answers) = 1;
        if (channel->pack(now, 16) > 0) ++frames;
        else if (hit) transport->faults = {};
    }
    void step() {
        now += 1ms;
        exchange->receive(now);
        channel->collect(now);
    }
    Result<Bytes> upload(std::uint16_t index, std::uint8_t sub, SdoAccess access = SdoAccess::entry) {
        return run(sdo_upload(*port, mailbox, index, sub, access));
    }
    Result<void> download(std::uint16_t index, std::uint8_t sub, Bytes data, SdoAccess access = SdoAccess::entry) {
        return run(sdo_download(*port, mailbox, index, sub, std::move(data), access));
    }

    sim::BusProbe probe;
    sim::SimSlave* slave = nullptr;
    AlarmingModel* model = nullptr;
    std::optional<LoopbackTransport> transport;
    std::optional<Exchange> exchange;
    std::optional<AcyclicChannel> channel;
    std::optional<DatagramPort> port;
    EmergencyLog log;
    MailboxEndpoint mailbox;
    Instant now{};
    std::size_t frames = 0;                         ///< sent
    std::size_t lose_request = 0, lose_answer = 0;  ///< number of the frame, from 1; 0: none
};

}  // namespace taktwerk::ecat::test
