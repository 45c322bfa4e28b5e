// What goes through the mailbox while the bus comes up: start-up values, PDOs, modules.

#include "ecat/wire/sdo.hpp"
#include "tests/troubles/bench.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

void map_by_hand(Bench& bench) { bench.file('b').rx.assigned = {{0x1600, false, {{0x6060, 0, 8}, {0x6040, 0, 16}, {0x607A, 0, 32}}, {}}}; }

template <std::uint16_t index, std::uint8_t sub, std::uint32_t code>
void abort_of(Bench& bench) {
    bench.there('b').abort_object(index, sub, code);
}

}  // namespace

Chapter refused_mailboxes() {
    return {"Start-up values, PDOs and modules",
            "Each message says which object, what the slave answered, and where in the file it was asked for.",
            {{.name = "A start-up object that is not there",
              .staged = "2FFFh in the start-up list",
              .configured = "sst",
              .before = [](Bench& bench) { bench.write_startup('b', 0x2FFF, 1); },
              .id = "sdo.abort",
              .place = "slave 1 'b'",
              .cause = "writing 2FFFh:00 was refused: abort 06020000h object does not exist (start-up list, machine.yaml:12:9)",
              .remedy = "this firmware does not have the object",
              .named = "b"},
             {.name = "A start-up value out of range",
              .staged = "2,000,000 for an object that ends at 1,000,000",
              .configured = "sst",
              .before = [](Bench& bench) { bench.write_startup('b', 0x6085, 2'000'000); },
              .id = "sdo.abort",
              .place = "slave 1 'b'",
              .cause = "writing 6085h:00 was refused: abort 06090031h",
              .remedy = "choose a value within the range the manual gives",
              .named = "b"},
             {.name = "A start-up value that does not stay",
              .staged = "the drive takes 5000 and keeps 1000",
              .configured = "slt",
              .before = [](Bench& bench) { bench.write_startup('b', 0x6085, 5000); },
              .id = "bus.startup_verify",
              .place = "slave 1 'b'",
              .cause = "6085h:00 reads back 000003E8h after 00001388h was written",
              .remedy = "write what it can hold",
              .named = "b"},
             {.name = "PDO mapping refused",
              .staged = "the firmware does not let the first entry of 1600h be mapped",
              .configured = "sst",
              .before = [](Bench& bench) { map_by_hand(bench), abort_of<0x1600, 1, sdo_abort::not_mappable>(bench); },
              .id = "sdo.abort",
              .place = "slave 1 'b'",
              .cause = "writing 1600h:01 was refused: abort 06040041h",
              .remedy = "the drive does not accept this PDO mapping",
              .named = "b"},
             {.name = "PDO assignment refused",
              .staged = "the firmware does not let 1C12h be written",
              .configured = "sst",
              .before = [](Bench& bench) { map_by_hand(bench), abort_of<0x1C12, 1, sdo_abort::pdo_length>(bench); },
              .id = "sdo.abort",
              .place = "slave 1 'b'",
              .cause = "writing 1C12h:01 was refused: abort 06040042h",
              .remedy = "map fewer or other objects",
              .named = "b"},
             {.name = "A PDO with other entries in the firmware",
              .staged = "1702h has six bytes in the slave and seven in its profile",
              .configured = "sst",
              .there = "sft",
              .before =
                  [](Bench& bench) {
                      bench.file('b').rx.assigned = {{0x1702, true, {}, {}}};
                  },
              .id = "bus.pdo_mismatch",
              .place = "slave 1 'b'",
              .cause = "entry 2 of 1702h is 607Ah:00/32 in the slave, configured is 6060h:00/8; configured are 7 bytes, the slave has 6",
              .remedy = "correct the PDO in the profile to what the slave reports",
              .named = "b"},
             {.name = "A module missing",
              .staged = "slot 1 is empty, the file says csp",
              .configured = "smt",
              .before = [](Bench& bench) { bench.there('b').dictionary().find(0xF050, 2)->set(0); },
              .id = "bus.module_mismatch",
              .place = "slave 1 'b'",
              .cause = "slot 1 holds no module, configured is 'csp' (00000011h)",
              .remedy = "plug the configured module",
              .named = "b"},
             {.name = "A module swapped",
              .staged = "slot 1 holds pp, the file says csp",
              .configured = "smt",
              .before = [](Bench& bench) { bench.there('b').dictionary().find(0xF050, 2)->set(0x22); },
              .id = "bus.module_mismatch",
              .place = "slave 1 'b'",
              .cause = "slot 1 holds 'pp' (00000022h), configured is 'csp' (00000011h)",
              .remedy = "choose the one that is there under `modules`",
              .named = "b"},
             {.name = "Complete access refused",
              .staged = "the profile promises it, the firmware aborts it; it comes up all the same",
              .configured = "smt",
              .before = [](Bench& bench) { bench.described('b').mailbox->complete_access = true; },
              .id = "note",
              .place = "slave 1 'b'",
              .cause = "its firmware refuses complete access",
              .remedy = "set `complete_access: false` in its profile",
              .named = "b"},
             {.name = "Toggle bit that stands",
              .staged = "the segments of an object of 300 bytes all carry the same toggle bit",
              .configured = "sst",
              .before =
                  [](Bench& bench) {
                      bench.file('b').asked.push_back({0x2000, 1}), bench.there('b').never_toggle();
                  },
              .id = "sdo.protocol",
              .place = "slave 1 'b'",
              .cause = "reading 2000h:01: a segment came twice or was skipped (toggle bit)",
              .remedy = "the slave's firmware is defective",
              .named = "b"},
             {.name = "Mailbox that stays full",
              .staged = "the slave takes nothing out of it",
              .configured = "sst",
              .before = [](Bench& bench) { bench.write_startup('b', 0x6085, 5000), bench.there('b').stick_mailbox(true); },
              .id = "sdo.timeout",
              .place = "slave 1 'b'",
              .cause = "the request still lies in its mailbox, which stays full",
              .remedy = "power-cycle it",
              .named = "b",
              .patience = 2s},
             {.name = "Mailbox without an answer",
              .staged = "the slave takes each request and answers none",
              .configured = "sst",
              .before = [](Bench& bench) { bench.write_startup('b', 0x6085, 5000), bench.there('b').answer_after(10s); },
              .id = "sdo.timeout",
              .place = "slave 1 'b'",
              .cause = "no answer within 2000 ms",
              .remedy = "try again, then power-cycle it",
              .named = "b",
              .patience = 2s}}};
}

}  // namespace taktwerk::troubles
