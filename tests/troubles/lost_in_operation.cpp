// A running machine loses frames, cables, slaves, or the time to send.

#include "ecat/wire/sii.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

void make_ring_of(Bench& bench) { bench.make_ring(); }

/// This computer does nothing for so long.
void stall(Bench& bench) {
    bench.now += 20ms;
    bench.network.advance(bench.now);
}

/// Too short to miss more than a frame or two, long enough to lose everything it was told.
void restart(Bench& bench) {
    bench.network.set_power(bench.there('c'), false);
    bench.run_for(1ms);
    bench.network.set_power(bench.there('c'), true);
}

void share_one_sync_unit(Bench& bench) {
    for (auto& slave : bench.config.slaves) slave.sync_unit = "cell";
}

/// Its watchdog of 100 ms is shorter than what this machine bears.
void patient_machine(Bench& bench) {
    bench.config.lost_frames_limit = 300;
    for (auto& slave : bench.config.slaves) slave.sm_watchdog = 100ms;
}

void replaced(Bench& bench) {
    bench.network.set_power(bench.there('c'), false);
    bench.run_for(200ms);
    bench.there('c').controller().eeprom().image()[std::size_t{2} * sii_word::product] = std::byte{0x77};
    bench.network.set_power(bench.there('c'), true);
}

}  // namespace

Chapter lost_in_operation() {
    return {"Lost in operation",
            "One alarm, as soon as it is known who. Who stands behind it is not accused.",
            {{.name = "The last slave loses its power",
              .staged = "switched off in OP",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { bench.network.set_power(bench.there('c'), false); },
              .id = "slave_lost",
              .place = "slave 2 'c'",
              .cause = "The slave fell silent",
              .remedy = "check its power and cable",
              .named = "bc"},
             {.name = "A slave in the middle loses its power",
              .staged = "switched off in OP: those behind it are gone, too",
              .teller = Teller::alarm,
              .configured = "ststt",
              .strikes = [](Bench& bench) { bench.network.set_power(bench.there('c'), false); },
              .id = "cable_broken",
              .place = "between slave 1 'b' (dio8) port 1 and slave 2 'c'",
              .cause = "3 slaves behind one cable fell silent",
              .remedy = "check cable and power at the place named",
              .named = "bc"},
             {.name = "A cable between two slaves out",
              .staged = "pulled in OP",
              .teller = Teller::alarm,
              .configured = "ststt",
              .strikes = [](Bench& bench) { bench.network.set_cable(3, false); },
              .id = "cable_broken",
              .place = "between slave 2 'c' (sv33-e) port 1 and slave 3 'd'",
              .cause = "2 slaves behind one cable fell silent",
              .remedy = "check cable and power at the place named",
              .named = "cd"},
             {.name = "The cable at the master out",
              .staged = "no carrier any more",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { bench.transport.faults.link_down = true; },
              .id = "link_down",
              .place = "bus",
              .cause = "No link on the EtherCAT port",
              .remedy = "check the cable between the controller and the first slave"},
             {.name = "No frame comes back, with a link",
              .staged = "the cable behind a media converter is out",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { bench.network.set_cable(0, false); },
              .id = "frames_lost",
              .place = "bus",
              .cause = "bus cycles in a row without an answer",
              .remedy = "check cables"},
             {.name = "Five frames lost in a row",
              .staged = "they never reach the slaves",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { bench.transport.faults.drop_requests = 5; },
              .id = "frames_lost",
              .place = "bus",
              .cause = "bus cycles in a row without an answer",
              .remedy = "check cables"},
             {.name = "Watchdogs shorter than what the machine bears",
              .staged = "150 frames lost, 300 are allowed, the slaves' watchdogs are 100 ms",
              .teller = Teller::alarm,
              .before = patient_machine,
              .strikes = [](Bench& bench) { bench.transport.faults.drop_requests = 150; },
              .id = "frames_lost",
              .place = "3 slaves fell by it",
              .cause = "bus cycles in a row without an answer",
              .remedy = "check cables"},
             {.name = "A slave restarts by itself",
              .staged = "its power is away for a millisecond",
              .teller = Teller::alarm,
              .strikes = restart,
              .id = "slave_lost",
              .place = "slave 2 'c'",
              .cause = "its controller was reset",
              .remedy = "check its power and cable",
              .named = "bc"},
             {.name = "The computer stalls",
              .staged = "it sends nothing for 20 ms",
              .teller = Teller::alarm,
              .strikes = stall,
              .id = "starved_slave_left_op",
              .place = "bus",
              .cause = "this computer was late, not the slaves",
              .remedy = "see late_wakeups",
              .named = "abc",
              .culprit = Culprit::this_computer},
             {.name = "A ring broken",
              .staged = "the cable between the second and the third slave is pulled in OP",
              .teller = Teller::alarm,
              .before = make_ring_of,
              .strikes = [](Bench& bench) { bench.set_ring_cable(2, false); },
              .id = "ring_broken",
              .place = "between slave 1 'b' (dio8) port 1 and slave 2 'c' (sv33-e) port 0",
              .cause = "2 slaves are reached from one end, 1 from the other",
              .remedy = "mend the cable at the place named",
              .named = "bc"},
             {.name = "Another device put in a slave's place",
              .staged = "it comes back from a power cycle with another product code",
              .teller = Teller::alarm,
              .strikes = replaced,
              .id = "other_device",
              .place = "slave 2 'c'",
              .cause = "Another device stands in the slave's place",
              .remedy = "put the right device there",
              .named = "bc"},
             {.name = "The last slave of a shared sync unit loses its power",
              .staged = "all three are exchanged with one working counter; the third is switched off",
              .teller = Teller::alarm,
              .before = share_one_sync_unit,
              .strikes = [](Bench& bench) { bench.network.set_power(bench.there('c'), false); },
              .id = "slave_lost",
              .place = "slave 2 'c'",
              .cause = "The slave fell silent",
              .remedy = "check its power and cable",
              .named = "bc"}}};
}

}  // namespace taktwerk::troubles
