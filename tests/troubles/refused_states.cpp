// A slave does not take a state: what it says by its AL status code, and what can be seen of the reason.

#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

template <std::uint16_t code>
void refuses_safeop(Bench& bench) {
    bench.there('b').refuse_state(sim::EsmState::safeop, code);
}

void late_answers(Bench& bench) {
    bench.transport.faults.delay_answers = 1'000'000;
    bench.transport.faults.delay = 1500us;
}

Trouble told_by_code(std::string_view name, std::string_view staged, void (*before)(Bench&), std::string_view cause,
                     std::string_view remedy) {
    return {.name = name,
            .staged = staged,
            .configured = "sst",
            .before = before,
            .id = "bus.refused_state",
            .place = "slave 1 'b'",
            .cause = cause,
            .remedy = remedy,
            .named = "b"};
}

}  // namespace

Chapter refused_states() {
    return {"A state is refused",
            "The AL status code alone is one of the standard's phrases. Where registers, EEPROM and clock show more, that is said.",
            {{.name = "Mailbox of another size",
              .staged = "the profile says 128 bytes, the slave has 256",
              .configured = "sst",
              .there = "sxt",
              .id = "bus.refused_state",
              .place = "slave 1 'b'",
              .cause = "the mailbox in SM0 was set to 128 bytes, its EEPROM says 256",
              .remedy = "take the mailbox sizes of the EEPROM into the slave's profile",
              .named = "b"},
             {.name = "SYNC0 not configured",
              .staged = "the file runs it without, and the servo wants it",
              .configured = "sst",
              .before = [](Bench& bench) { bench.file('b').dc = false; },
              .id = "bus.refused_state",
              .place = "slave 1 'b'",
              .cause = "the slave wants SYNC0, and the configuration runs it without",
              .remedy = "set `dc: true` for this slave",
              .named = "b"},
             {.name = "SYNC0 started in the wrong state",
              .staged = "the file starts it in SAFEOP, the servo wants it before",
              .configured = "sst",
              .before = [](Bench& bench) { bench.file('b').sync_start = SyncStart::in_safeop; },
              .id = "bus.refused_state",
              .place = "slave 1 'b'",
              .cause = "SYNC0 was not started yet",
              .remedy = "sync_start",
              .named = "b"},
             {.name = "A cycle that the firmware does not take",
              .staged = "it knows 2 ms only, and nobody has written that into its profile",
              .configured = "sst",
              .there = "syt",
              .id = "bus.refused_state",
              .place = "slave 1 'b'",
              .cause = "does not accept a SYNC0 cycle of 1000 us",
              .remedy = "choose a bus cycle that its manual lists",
              .named = "b"},
             {.name = "A controller without a clock",
              .staged = "the profile says DC, the controller of this variant has none",
              .configured = "sst",
              .there = "snt",
              .id = "bus.no_clock",
              .place = "slave 1 'b'",
              .cause = "its controller has no distributed clock",
              .remedy = "set dc: false",
              .named = "b"},
             {.name = "A reference clock with a wrong quartz",
              .staged = "the first servo's clock runs 2 % fast",
              .before = [](Bench& bench) { bench.there('a').controller().set_clock_drift(20'000, bench.now); },
              .id = "bus.dc_not_locked",
              .place = "slave 0 'a'",
              .cause = "its clock, the reference of the bus, runs fast by 500 ppm and more",
              .remedy = "replace it",
              .named = "a"},
             {.name = "Frames back too late for the cycle",
              .staged = "every answer comes 1.5 ms after it was asked for, in a cycle of 1 ms",
              .configured = "ttt",
              .before = late_answers,
              .id = "bus.no_frame",
              .place = "bus",
              .cause = "process data does not come back within the cycle of 1000 us",
              .remedy = "this computer sends or receives too late",
              .culprit = Culprit::this_computer,
              .patience = 3s},
             {.name = "Firmware that hangs",
              .staged = "its application stands before it comes up; the controller answers",
              .configured = "sst",
              .before = [](Bench& bench) { bench.there('b').hang(true); },
              .id = "bus.state_timeout",
              .place = "slave 1 'b'",
              .cause = "the slave neither takes the state nor says why",
              .remedy = "power-cycle the slave",
              .named = "b",
              .patience = 3s},
             told_by_code("Hardware set-up refused", "it refuses SAFEOP with 0003h", &refuses_safeop<0x0003>, "0003h invalid device setup",
                          "check the device's hardware set-up"),
             told_by_code("No valid inputs", "it refuses SAFEOP with 0018h", &refuses_safeop<0x0018>, "0018h no valid inputs available",
                          "check its sensors and supply"),
             told_by_code("Cold start needed", "it refuses SAFEOP with 0020h", &refuses_safeop<0x0020>, "0020h slave needs cold start",
                          "switch the slave's control supply off and on"),
             told_by_code("Power stage not ready", "it refuses SAFEOP with 0052h", &refuses_safeop<0x0052>,
                          "0052h external hardware not ready", "check its supply"),
             told_by_code("Modules refused by the slave itself", "it refuses SAFEOP with 0070h", &refuses_safeop<0x0070>,
                          "0070h detected modules do not match", "configured and plugged modules differ"),
             told_by_code("Supply voltage too low", "it refuses SAFEOP with 0080h", &refuses_safeop<0x0080>, "0080h supply voltage too low",
                          "check the supply"),
             told_by_code("A code of the vendor", "it refuses SAFEOP with 8123h", &refuses_safeop<0x8123>,
                          "8123h code not in the standard's table", "look it up in the device's manual")}};
}

}  // namespace taktwerk::troubles
