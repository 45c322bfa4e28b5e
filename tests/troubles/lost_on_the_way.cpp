// Somebody goes away, or frames do, after all slaves were counted and before the bus is up.

#include "core/bytes.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

/// Cycles since the bring-up began: mailboxes are open, nobody is in OP.
constexpr int under_way = 300;

template <void (*happens)(Bench&)>
void under_way_comes(Bench& bench) {
    bench.on_cycle = [&bench, n = 0]() mutable {
        if (++n == under_way) happens(bench);
    };
}

void power_goes(Bench& bench) { bench.network.set_power(bench.there('b'), false); }
void link_goes(Bench& bench) { bench.transport.faults.link_down = true; }
void answers_stop(Bench& bench) { bench.network.set_cable(0, false); }

/// Every fourth frame on its way, by chance.
void rough_cable(Bench& bench) {
    bench.on_cycle = [&bench, drawn = 12345u]() mutable {
        drawn = drawn * 1664525u + 1013904223u;
        bench.network.disturb(bench.there('c'), (drawn >> 16) % 4 == 0 ? 1 : 0);
    };
}

/// It sends the second slave to INIT, fifty times a second.
void another_configures(Bench& bench) {
    bench.on_cycle = [&bench, n = 0]() mutable {
        if (++n < 200 || n % 20 != 0) return;
        std::array<std::byte, min_frame_size> buffer{};
        FrameBuilder builder{buffer, MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
        store_le(builder.add(Command::APWR, 0x40, Address::position(1, reg::al_control), 2), 0, std::uint16_t{1});
        (void)builder.finish();
        (void)bench.network.process(buffer, bench.now);
        bench.transport.inject(buffer, bench.now);
    };
}

}  // namespace

Chapter lost_on_the_way() {
    return {
        "Lost while the bus comes up",
        "All were counted, then somebody goes. Who only stands behind it, or whose datagram it was that did not come back, is not accused.",
        {{.name = "A slave loses its power while the bus comes up",
          .staged = "the second of three is switched off while mailboxes are asked",
          .configured = "sss",
          .before = under_way_comes<power_goes>,
          .id = "bus.no_slave",
          .place = "slave 1 'b'",
          .cause =
              "it fell silent while the bus came up: between slave 0 'a' (sv33-e) port 1 and slave 1 'b' (sv33-e); 2 slaves do not answer",
          .remedy = "check its power and the cable that is named",
          .named = "ab"},
         {.name = "The cable at the master out while the bus comes up",
          .staged = "no carrier any more while mailboxes are asked",
          .configured = "sss",
          .before = under_way_comes<link_goes>,
          .id = "bus.no_link",
          .place = "bus",
          .cause = "the network port lost its link while the bus came up",
          .remedy = "check the cable between this computer and the first slave"},
         {.name = "No frame comes back any more while the bus comes up",
          .staged = "the cable behind a media converter is pulled while mailboxes are asked",
          .configured = "sss",
          .before = under_way_comes<answers_stop>,
          .id = "bus.no_frame",
          .place = "bus",
          .cause = "frames stopped coming back while the bus came up",
          .remedy = "check the cable between this computer and the first slave"},
         {.name = "A cable that damages frames while the bus comes up",
          .staged = "one frame in four is disturbed between the second and the third slave",
          .configured = "sts",
          .before = rough_cable,
          .id = "bus.cable_errors",
          .place = "slave 2",
          .cause = "were damaged on the cable between slave 1",
          .remedy = "replace the cable that is named",
          .named = "bc",
          .patience = 4s},
         {.name = "A second master while the bus comes up",
          .staged = "it sends the second slave to INIT again and again",
          .configured = "sst",
          .before = another_configures,
          .id = "bus.foreign_master",
          .place = "bus",
          .cause = "another EtherCAT master sent",
          .remedy = "end that master",
          .named = "b",
          .culprit = Culprit::other_master,
          .patience = 2s}}};
}

}  // namespace taktwerk::troubles
