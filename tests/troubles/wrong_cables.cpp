// The cables are not as they should be when the bus comes up.

#include <array>

#include "ecat/wire/frame.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

/// A loop-back plug, a hub: every frame comes back as it left.
class Reflector final : public FrameSink {
public:
    void advance(Instant) noexcept override {}
    std::optional<Duration> process(std::span<std::byte>, Instant) noexcept override { return 1us; }
};

void loop_back_plug(Bench& bench) {
    static Reflector plug;
    bench.transport.plug_into(plug);
}

void ring_with_break(Bench& bench, std::size_t place) {
    bench.make_ring();
    bench.set_ring_cable(place, false);
}

void exchanged_interfaces(Bench& bench) {
    bench.make_ring();
    bench.ring = std::make_unique<RingTransport>(*bench.second, bench.transport, bench.config.cycle / 4);
}

void line_with_exchanged_plugs(Bench& bench) {
    bench.plug_in('s');
    bench.plug_in_backwards('t');
    bench.plug_in('m');
}

void half_duplex(Bench& bench) {
    auto& phy = bench.there('b').controller().phys().phy(0);
    phy.partner = 0x0080;  // 100 Mbit, seen by parallel detection: its duplex is not, and half is assumed (IEEE 802.3, 28.2.3.1)
    phy.partner_negotiates = false;
}

/// Reads the AL states of all slaves, as every master does.
void somebody_works_here(Bench& bench) {
    bench.on_cycle = [&bench, n = 0]() mutable {
        if (++n % 10 != 0) return;
        std::array<std::byte, min_frame_size> buffer{};
        FrameBuilder builder{buffer, MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
        (void)builder.add(Command::BRD, 0x40, Address::physical(0, reg::al_status), 2);
        (void)builder.finish();
        (void)bench.network.process(buffer, bench.now);
        bench.transport.inject(buffer, bench.now);
    };
}

}  // namespace

Chapter wrong_cables() {
    return {"The cables before the start",
            "Nobody is up yet. What can be told of a cable are the frames that come back, and who answers in them.",
            {{.name = "No link at the start",
              .staged = "the cable is not in",
              .before = [](Bench& bench) { bench.transport.faults.link_down = true; },
              .id = "bus.no_link",
              .place = "bus",
              .cause = "the network port has no link",
              .remedy = "check the cable and that the first slave has power"},
             {.name = "A link without slaves",
              .staged = "a link, and nothing comes back: a switch, a PC, the OUT socket of a slave that ends the line",
              .before = [](Bench& bench) { bench.network.set_cable(0, false); },
              .id = "bus.no_frame",
              .place = "bus",
              .cause = "no EtherCAT slave answers at the other end of the cable",
              .remedy = "IN port of the first slave"},
             {.name = "Frames reflected",
              .staged = "a loop-back plug sends every frame back as it was",
              .before = loop_back_plug,
              .id = "bus.empty",
              .place = "bus",
              .cause = "frames come back, but no slave answered",
              .remedy = "the cable goes to the IN port of the first"},
             {.name = "Ring broken at the start",
              .staged = "two interfaces, the cable in front of the second slave is out",
              .before = [](Bench& bench) { ring_with_break(bench, 1); },
              .id = "bus.ring_broken",
              .place = "bus",
              .cause = "the ring is broken between slave 0 and slave 1",
              .remedy = "mend the cable",
              .named = "ab"},
             {.name = "Interfaces of the ring exchanged",
              .staged = "the first slave's cable is in the second interface",
              .before = exchanged_interfaces,
              .id = "bus.ring_exchanged",
              .place = "bus",
              .cause = "the first slave's cable is in the second interface",
              .remedy = "exchange the plugs"},
             {.name = "Plugs of a slave exchanged",
              .staged = "the cable from the master is in the OUT socket of the second slave",
              .configured = "stm",
              .there = " ",
              .before = line_with_exchanged_plugs,
              .id = "bus.plugs_exchanged",
              .place = "slave 'b'",
              .cause = "the cable from the master is in its port 1 (OUT)",
              .remedy = "exchange the two plugs at this slave",
              .named = "b"},
             {.name = "Half-duplex port",
              .staged = "what stands at the other end of its IN socket does not negotiate",
              .before = half_duplex,
              .id = "bus.wrong_link",
              .place = "slave 1 'b'",
              .cause = "port 0: 100 Mbit half duplex, and EtherCAT needs 100 Mbit full duplex",
              .remedy = "switch its auto-negotiation on",
              .named = "b"},
             {.name = "E-bus overload",
              .staged = "a coupler that gives 500 mA and two terminals that take 300 mA each",
              .teller = Teller::scan,
              .configured = "kee",
              .id = "bus.ebus_overload",
              .place = "slave 2 'c'",
              .cause = "up to here the terminals take 600 mA from the E-bus, and slave 0 'a' supplies 500 mA",
              .remedy = "put a feed terminal before it",
              .named = "ac"},
             {.name = "A second master at the start",
              .staged = "it sends a hundred frames a second",
              .before = somebody_works_here,
              .id = "bus.foreign_master",
              .place = "bus",
              .cause = "another EtherCAT master is sending on this cable",
              .remedy = "end that master",
              .culprit = Culprit::other_master}}};
}

}  // namespace taktwerk::troubles
