// Everybody is there, and something is wrong all the same: clocks, cables that damage frames, slaves with errors of their own, somebody else.

#include "core/bytes.hpp"
#include "ecat/wire/registers.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

/// A controller that is not ours: its datagram reaches the slaves, and its frame is heard by our port.
void somebody_writes(Bench& bench, Address address, std::uint16_t value) {
    std::array<std::byte, min_frame_size> buffer{};
    FrameBuilder builder{buffer, MacAddress{0x00, 0x11, 0x22, 0x33, 0x44, 0x55}};
    store_le(builder.add(Command::APWR, 0x40, address, 2), 0, value);
    (void)builder.finish();
    (void)bench.network.process(buffer, bench.now);
    bench.transport.inject(buffer, bench.now);
}

void somebody_sends(Bench& bench) {
    bench.on_cycle = [&bench, n = 0]() mutable {
        if (++n % 10 == 0) somebody_writes(bench, Address::position(0, 0x0F80), 0);
    };
}

void noise(Bench& bench) {
    bench.on_cycle = [&bench, n = 0]() mutable {
        if (++n % 100 == 0) bench.network.disturb(bench.there('c'), 1);
    };
}

void loose_plug(Bench& bench) {
    for (int i = 0; i < 3; ++i) {
        bench.network.set_cable(2, false);
        bench.network.set_cable(2, true);
        bench.run_for(50ms);
    }
}

void exchange_together(Bench& bench) {
    for (auto& slave : bench.config.slaves) slave.sync_unit = "together";
}

template <std::uint16_t code>
void falls(Bench& bench) {
    bench.there('c').leave_op(code, bench.now);
}

Trouble leaves_op(std::string_view name, std::string_view staged, void (*strikes)(Bench&), std::string_view place) {
    return {.name = name,
            .staged = staged,
            .teller = Teller::alarm,
            .strikes = strikes,
            .id = "slave_left_op",
            .place = place,
            .cause = "The slave left OP",
            .remedy = "read the text behind the code",
            .named = "c"};
}

void clock_jumps(Bench& bench) { bench.there('c').controller().step_clock(400us, bench.now); }

}  // namespace

Chapter unwell_in_operation() {
    return {"Unwell in operation",
            "Everybody answers, and still something is wrong.",
            {{.name = "A cable that damages frames",
              .staged = "one frame in a hundred is disturbed between the second and the third slave",
              .teller = Teller::alarm,
              .strikes = noise,
              .id = "cable_errors",
              .place = "the cable between slave 1 'b' (dio8) port 1 and slave 2 'c'",
              .cause = "frames were damaged on the cable",
              .remedy = "replace the cable that is named",
              .named = "bc"},
             {.name = "A plug that is loose",
              .staged = "the link between the second and the third slave goes three times, for less than a frame",
              .teller = Teller::alarm,
              .strikes = loose_plug,
              .id = "cable_loses_link",
              .place = "the cable between slave 1 'b' (dio8) port 1 and slave 2 'c'",
              .cause = "lost its link",
              .remedy = "look at the plugs and the cable that is named",
              .named = "bc"},
             {.name = "A clock that jumps",
              .staged = "that of the third slave, by 400 us",
              .teller = Teller::alarm,
              .strikes = clock_jumps,
              .id = "dc_out_of_sync",
              .place = "most of all slave 2 'c' (sv33-e) from slave 0 'a'",
              .cause = "Distributed clocks differ by",
              .remedy = "power-cycle the slave that is named",
              .named = "ac"},
             {.name = "A clock that drifts away",
              .staged = "the quartz of the third slave runs 0.2 % fast from now on",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { bench.there('c').controller().set_clock_drift(2000, bench.now); },
              .id = "dc_out_of_sync",
              .place = "most of all slave 2 'c' (sv33-e) from slave 0 'a'",
              .cause = "Distributed clocks differ by",
              .remedy = "power-cycle the slave that is named",
              .named = "ac"},
             {.name = "A reference clock that stands",
              .staged = "every reading gives the same time",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { bench.cable.freeze_reference_time = true; },
              .id = "reference_clock_lost",
              .place = "slave 0 'a'",
              .cause = "the reference clock stands still",
              .remedy = "power-cycle the first slave with distributed clocks",
              .named = "a"},
             {.name = "A slave with settings that somebody changed",
              .staged = "the FMMU of its outputs maps nothing any more",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { somebody_writes(bench, Address::position(1, reg::fmmu_at(0) + 4), 0); },
              .id = "working_counter_wrong",
              .place = "slave 1 'b' (dio8): FMMU0 is not as it was written: something wrote to it",
              .cause = "Process data of the slave was not exchanged",
              .remedy = "it is set up again by itself; when it comes again power-cycle the slave",
              .named = "b"},
             {.name = "A station address lost",
              .staged = "somebody has written 0 to it",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { somebody_writes(bench, Address::position(1, reg::station_address), 0); },
              .id = "station_address_lost",
              .place = "slave 1 'b'",
              .cause = "lost its station address",
              .remedy = "the address is given back by itself",
              .named = "b",
              .culprit = Culprit::other_master},
             {.name = "A second master that sends",
              .staged = "a hundred frames a second of another source",
              .teller = Teller::alarm,
              .strikes = somebody_sends,
              .id = "foreign_master",
              .place = "its network address is 02:11:22:33:44:55",
              .cause = "Frames of another EtherCAT master are on the cable",
              .remedy = "connect the bus to this controller only",
              .culprit = Culprit::other_master},
             {.name = "A second master that takes a slave away",
              .staged = "it sends the second slave to PREOP",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { somebody_writes(bench, Address::position(1, reg::al_control), 2); },
              .id = "foreign_command",
              .place = "its network address is 02:11:22:33:44:55",
              .cause = "Somebody else took slaves out of OP (1)",
              .remedy = "connect the bus to this controller only",
              .named = "b",
              .culprit = Culprit::other_master},
             {.name = "A slave of a shared sync unit leaves OP",
              .staged = "all three are exchanged with one working counter; the second leaves OP with 001Dh",
              .teller = Teller::alarm,
              .before = exchange_together,
              .strikes = [](Bench& bench) { bench.there('b').leave_op(0x001D, bench.now); },
              .id = "slave_left_op",
              .place = "slave 1 'b' (dio8): AL status code 001Dh invalid output configuration",
              .cause = "The slave left OP",
              .remedy = "read the text behind the code",
              .named = "b"},
             {.name = "A slave of a shared sync unit with settings that somebody changed",
              .staged = "all three are exchanged with one working counter; the FMMU of the second one's outputs maps nothing any more",
              .teller = Teller::alarm,
              .before = exchange_together,
              .strikes = [](Bench& bench) { somebody_writes(bench, Address::position(1, reg::fmmu_at(0) + 4), 0); },
              .id = "working_counter_wrong",
              .place = "slave 1 'b' (dio8): FMMU0 is not as it was written: something wrote to it",
              .cause = "Process data of the slave was not exchanged",
              .remedy = "it is set up again by itself; when it comes again power-cycle the slave",
              .named = "b"},
             {.name = "A working counter of a shared sync unit that nobody explains",
              .staged = "something on the cable counts one less; all three are in OP with their settings",
              .teller = Teller::alarm,
              .before = exchange_together,
              .strikes = [](Bench& bench) { bench.cable.working_counter_offset = -1; },
              .id = "sync_unit_not_exchanged",
              .place = "bus: sync unit 'together': slave 0 'a' (sv33-e), slave 1 'b' (dio8), slave 2 'c' (sv33-e)",
              .cause = "Process data of 3 slaves that share a sync unit was not exchanged",
              .remedy = "take `sync_unit` away from the slaves that are named",
              .named = "abc"},
             leaves_op("Synchronisation error of one slave", "it leaves OP with 001Ah, and no frame was lost", &falls<0x001A>,
                       "AL status code 001Ah synchronization error"),
             leaves_op("Process data watchdog of one slave", "it leaves OP with 001Bh, and no frame was lost", &falls<0x001B>,
                       "AL status code 001Bh sync manager watchdog"),
             leaves_op("An error of the vendor's own", "it leaves OP with 8123h", &falls<0x8123>, "AL status code 8123h"),
             {.name = "A mailbox that falls silent",
              .staged = "its application stands; process data goes on",
              .teller = Teller::alarm,
              .strikes = [](Bench& bench) { bench.there('c').stick_mailbox(true); },
              .id = "mailbox_silent",
              .place = "slave 2 'c'",
              .cause = "The slave does not answer in its mailbox",
              .remedy = "power-cycle the slave when the machine stands",
              .named = "c",
              .patience = 7s},
             {.name = "An emergency message",
              .staged = "the servo reports 4310h, too hot",
              .teller = Teller::alarm,
              .strikes =
                  [](Bench& bench) {
                      bench.servo(2).raise(Emergency{0x4310, 0x08, {}});
                  },
              .id = "slave_emergency",
              .place = "slave 2 'c'",
              .cause = "The slave sent emergency 4310h",
              .remedy = "look the code up in the device's manual",
              .named = "c"}}};
}

}  // namespace taktwerk::troubles
