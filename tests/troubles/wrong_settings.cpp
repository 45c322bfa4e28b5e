// The file asks for what cannot be: said before anybody is on the bus.

#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

void select_pdo(Bench& bench, std::uint16_t index) { bench.file('a').rx.assigned = {{index, true, {}, {}}}; }

/// 60 servos with 24 entries each way do not fit into 250 us.
void crowd(Bench& bench) {
    bench.config.cycle = 250us;
    const auto first = bench.config.slaves.front();
    for (std::uint16_t i = 3; i < 250; ++i) {
        auto more = first;
        more.name = "x" + std::to_string(i);
        more.position = i;
        bench.config.slaves.push_back(more);
    }
}

}  // namespace

Chapter wrong_settings() {
    return {"Settings that cannot be",
            "`taktwerk check` reads the file alone, and `run` refuses it with the same words.",
            {{.name = "Watchdog shorter than the cycle",
              .staged = "`sm_watchdog: 500 us` on a bus of 1 ms",
              .teller = Teller::check,
              .before = [](Bench& bench) { bench.file('b').sm_watchdog = 500us; },
              .id = "bus.sm_watchdog",
              .place = "slave 'b'",
              .cause = "a watchdog of 500 us trips at the first lost frame: it is exchanged every 1000 us",
              .remedy = "choose at least 3000 us",
              .named = "b"},
             {.name = "SYNC0 before the outputs",
              .staged = "`sync0_shift: 5 us`, and the frames need more to be through",
              .teller = Teller::check,
              .before = [](Bench& bench) { bench.file('a').sync0_shift = 5us; },
              .id = "bus.sync0_budget",
              .place = "slave 'a'",
              .cause = "SYNC0 comes 5 us after the start of the cycle, but the frames alone need",
              .remedy = "choose a later SYNC0 (sync0_shift) or a longer cycle",
              .named = "a"},
             {.name = "SYNC0 too late for the cycle",
              .staged = "`sync0_shift: 1.2 ms` on a bus of 1 ms",
              .teller = Teller::check,
              .before = [](Bench& bench) { bench.file('a').sync0_shift = 1200us; },
              .id = "bus.sync0_shift",
              .place = "slave 'a'",
              .cause = "a SYNC0 shift of 1200 us is not inside the cycle of 1000 us",
              .remedy = "leave it out for half a cycle",
              .named = "a"},
             {.name = "Distributed clock asked of a slave that has none",
              .staged = "`dc: true` at a terminal",
              .teller = Teller::check,
              .before = [](Bench& bench) { bench.file('b').dc = true; },
              .id = "bus.dc_unsupported",
              .place = "slave 'b'",
              .cause = "has no distributed clock",
              .remedy = "set dc: false",
              .named = "b"},
             {.name = "A servo that works by SYNC0 alone without it",
              .staged = "`dc: false` at a servo whose manual says DC only",
              .teller = Teller::check,
              .before = [](Bench& bench) { bench.file('a').dc = false; },
              .id = "bus.dc_required",
              .place = "slave 'a'",
              .cause = "works with SYNC0 only",
              .remedy = "set dc: true",
              .named = "a"},
             {.name = "A cycle that a drive does not know",
              .staged = "1100 us, where the servo wants a multiple of 125 us",
              .teller = Teller::check,
              .configured = "st",
              .before = [](Bench& bench) { bench.config.cycle = 1100us; },
              .id = "bus.cycle_multiple",
              .place = "slave 'a'",
              .cause = "needs a multiple of 125 us, it is exchanged every 1100 us",
              .remedy = "choose another bus cycle",
              .named = "a"},
             {.name = "A cycle too short for the frames",
              .staged = "250 slaves at 250 us",
              .teller = Teller::check,
              .configured = "ttt",
              .before = crowd,
              .id = "bus.cycle_too_short_for_frames",
              .place = "bus",
              .cause = "at 100 Mbit/s",
              .remedy = "choose a cycle of at least"},
             {.name = "A PDO that the drive does not have",
              .staged = "1777h selected",
              .teller = Teller::check,
              .before = [](Bench& bench) { select_pdo(bench, 0x1777); },
              .id = "bus.pdo_unknown",
              .place = "slave 'a'",
              .cause = "has no RxPDO 1777h",
              .remedy = "select one that its profile lists",
              .named = "a"},
             {.name = "A start-up value for a read-only object",
              .staged = "6064h in the start-up list",
              .teller = Teller::check,
              .before = [](Bench& bench) { bench.write_startup('a', 0x6064, 1); },
              .id = "bus.startup_read_only",
              .place = "machine.yaml:12:9",
              .cause = "6064h:00 'Position actual value' is read-only",
              .remedy = "remove it from the start-up list"},
             {.name = "Two slaves at one position",
              .staged = "both say 0",
              .teller = Teller::check,
              .configured = "st",
              .before = [](Bench& bench) { bench.file('b').position = 0; },
              .id = "bus.duplicate_position",
              .place = "slave 'b'",
              .cause = "position 0 is taken by another slave",
              .remedy = "positions count from 0 along the cable",
              .named = "b"}}};
}

}  // namespace taktwerk::troubles
