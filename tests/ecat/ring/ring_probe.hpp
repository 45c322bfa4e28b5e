#pragma once
// A ring in the hand: some simulated slaves, a cable at each end, the transport over both, and single datagrams.

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/bytes.hpp"
#include "ecat/ring/ring_transport.hpp"
#include "ecat/sim/plain_device.hpp"
#include "ecat/sim/sim_network.hpp"
#include "ecat/transport/loopback.hpp"
#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat::test {

using namespace std::chrono_literals;
using Bytes = std::vector<std::byte>;

/// No mailbox, no process data: a controller with registers and a clock.
inline std::shared_ptr<const DeviceDescription> bare_slave() {
    auto d = std::make_shared<DeviceDescription>();
    d->name = "bare";
    d->identity = {0x00000ABC, 1, 1, 0};
    d->dc = {.supported = true, .required = false, .clock_64bit = true, .minimum_cycle = 125us, .cycle_multiple = 125us};
    return d;
}

class Idle final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
};

struct RingProbe {
    struct Answer {
        std::uint16_t wkc = 0, adp = 0;
        Bytes data;
        friend bool operator==(const Answer&, const Answer&) = default;
    };

    explicit RingProbe(std::size_t slaves) {
        for (std::size_t i = 0; i < slaves; ++i) network.add(bare_slave(), std::make_unique<Idle>());
        second.plug_into(network.close_ring(network.slave(slaves - 1)));
        first.set_other_end(second);
        second.set_other_end(first);
    }
    /// The cable in front of slave `place`; behind the last one: that of the second interface.
    void cable(std::size_t place, bool plugged) {
        if (place < network.size()) network.set_cable(place, plugged);
        else network.set_ring_cable(plugged);
        if (!plugged) first.lose_under_way(now), second.lose_under_way(now);
    }

    void send(Command command, Address address, const Bytes& data) {
        FrameBuilder builder{frame, ring.mac()};
        const auto area = builder.add(command, ++index, address, data.size());
        std::copy(data.begin(), data.end(), area.begin());
        sent = ring.send(builder.finish(), now);
    }
    /// What comes back of it until `now`.
    std::optional<Answer> receive() {
        const auto received = ring.receive(frame, now);
        if (!received) return std::nullopt;
        FrameReader reader{std::span<const std::byte>{frame}.first(received->size)};
        const auto datagram = reader.next();
        if (!datagram) return std::nullopt;
        source = {frame.begin() + 6, frame.begin() + 12};
        return Answer{datagram->working_counter(), datagram->address.adp(), Bytes(datagram->data.begin(), datagram->data.end())};
    }
    /// One frame a millisecond; nothing where none came back. There must never be two.
    std::optional<Answer> ask(Command command, Address address, const Bytes& data) {
        send(command, address, data);
        now += 1ms;
        auto answer = receive();
        while (receive()) ++answers_too_many;
        return answer;
    }
    std::optional<Answer> read(Command command, Address address, std::size_t size = 2) { return ask(command, address, Bytes(size)); }
    std::optional<Answer> count() { return read(Command::BRD, Address::physical(0, reg::type), 1); }

    sim::SimNetwork network{Instant{}};
    LoopbackTransport first{network}, second{network};
    RingTransport ring{first, second, 250us};
    std::array<std::byte, max_frame_size> frame{};
    Bytes source;
    std::uint8_t index = 0;
    bool sent = false;
    int answers_too_many = 0;
    Instant now{};
};

template <class T>
Bytes bytes_of(T value) {
    Bytes out(sizeof(T));
    store_le<T>(out, 0, value);
    return out;
}

}  // namespace taktwerk::ecat::test
